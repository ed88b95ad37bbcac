// on_maps.h - the operations on maps (relume/material/maps.h)
#ifndef EDIT_ON_MAPS_H
#define EDIT_ON_MAPS_H

#include <relume/material/edit.h>

relume_status maps_emboss(struct relume_maps *maps, const struct relume_edit *edit, int threads,
                          const struct relume_log *log);
relume_status maps_engrave(struct relume_maps *maps, const struct relume_edit *edit, int threads,
                           const struct relume_log *log);
relume_status maps_roughness(struct relume_maps *maps, const struct relume_edit *edit, int threads,
                             const struct relume_log *log);
relume_status maps_tint(struct relume_maps *maps, const struct relume_edit *edit, int threads,
                        const struct relume_log *log);
relume_status maps_channels(struct relume_maps *maps, const struct relume_edit *edit, int threads,
                            const struct relume_log *log);
relume_status maps_add_material(struct relume_maps *maps, const struct relume_edit *edit,
                                int threads, const struct relume_log *log);

#endif

// between_programs.h - programs of light between a panorama and objects
#ifndef VIEWER_BETWEEN_PROGRAMS_H
#define VIEWER_BETWEEN_PROGRAMS_H

#include "draw/draw.h"

struct between_programs {
    struct program back, front, lamps, mean, shown, gather, smooth, returned, scene, picture;
};

// For panoramas of that geometry. RELUME_ESYSTEM.
relume_status between_programs_create(struct between_programs *p, const struct gl *gl,
                                      const struct relume_geometry *geometry,
                                      const struct relume_log *log);
void between_programs_destroy(struct between_programs *p, const struct gl *gl);

#endif

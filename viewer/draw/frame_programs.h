// frame_programs.h - programs that a renderer draws frames with, but for slabs and objects
#ifndef VIEWER_FRAME_PROGRAMS_H
#define VIEWER_FRAME_PROGRAMS_H

#include "draw/draw.h"

struct frame_programs {
    struct program picture, panorama, ball, source, present, apart;  // each for draw_NAME
};

// `panorama` stays empty where the views with that geometry are no panoramas. RELUME_ESYSTEM.
relume_status frame_programs_create(struct frame_programs *p, const struct gl *gl,
                                    const struct relume_geometry *geometry,
                                    const struct relume_log *log);
void frame_programs_destroy(struct frame_programs *p, const struct gl *gl);

#endif

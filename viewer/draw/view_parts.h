// view_parts.h - parts of a slab's views, where all that an eye needs is too much for the graphics
// memory
#ifndef VIEWER_VIEW_PARTS_H
#define VIEWER_VIEW_PARTS_H

#include "draw/file_views.h"

struct view_parts {
    struct relume_rect *rect;  // [views]: what is here of each
    bool in_use;               // by the present frame
    int size[2];               // of views, pixels; 0: they are not read by parts
    size_t view_bytes;         // graphics memory of a whole view
    bool display;              // codes are of the display domain: environments are refitted
};

// RELUME_ENOMEM.
relume_status view_parts_create(struct view_parts *p, int views);
void view_parts_destroy(struct view_parts *p);
// The file's views can be read by parts.
void view_parts_use(struct view_parts *p, const struct relume_pack_info *info);
// Whether parts are needed for the frame, and possible: they show light alone that falls from afar
// and is not refitted.
bool view_parts_suit(const struct view_parts *p, const struct file_views *v,
                     const struct gl_relighter *relighter, const struct frame_request *q);
// Relights the parts that the frame needs, into v->relit. Errors of gl_relighter_part.
relume_status view_parts_relight(struct view_parts *p, struct file_views *v,
                                 struct gl_relighter *relighter, const struct frame_request *q);

#endif

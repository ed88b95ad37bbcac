// levels.h - objects that have fewer triangles from afar
#ifndef OBJECT_LEVELS_H
#define OBJECT_LEVELS_H

#include <relume/relight/viewport.h>
#include <relume/world/object.h>

// The states of a progressive mesh that an object is shown in.
struct object_levels;
void object_levels_free(struct object_levels **levels);

// The level of a part that an eye sees, and how far it is on its way to the next.
struct level_choice {
    int level, moved;
};

// As relume_objects_shown, in these levels: [parts], each below objects_levels of it.
// RELUME_ENOMEM.
relume_status objects_show(relume_objects **shown, const relume_objects *o,
                           const struct level_choice *choice, bool rays);
int objects_levels(const relume_objects *o, int part);

// An object is to be shown in levels whose error is seen within so many pixels. RELUME_ENOMEM.
struct wanted_levels {
    int object;
    double pixels;
};
relume_status objects_want_levels(relume_objects *o, int object, double pixels);
// They are made when the objects are finished. RELUME_ENOMEM, errors of relume_mesh_simplify.
relume_status objects_make_levels(relume_objects *o, const struct relume_log *log);

// How large a pixel is at a distance of 1; 0 where that does not depend on the distance.
double objects_pixel_of_window(const struct relume_window *window, int width, int height);
double objects_pixel_of_viewport(const struct relume_viewport *viewport);

// What is shown where relume_objects_shown leaves `shown`.
static inline const relume_objects *objects_or(const relume_objects *shown, const relume_objects *o)
{
    return shown ? shown : o;
}

#endif

// object_parts.h - the parts of objects as triangles of a material each, drawn by programs of
// btf_surface.vert
#ifndef VIEWER_OBJECT_PARTS_H
#define VIEWER_OBJECT_PARTS_H

#include "draw/object_mesh.h"
#include "draw/object_skins.h"

// What is drawn; all of it is borrowed.
struct object_parts {
    const relume_objects *objects;
    const struct object_mesh *mesh;
    const struct object_skins *skins;
    int only;  // material of all parts; -1: their own
};

enum {
    SURFACE_CLIP,
    SURFACE_PART,
    SURFACE_FIRST,
    SURFACE_SKIN,
    SURFACE_COVER,
    SURFACE_CUTOFF,
    SURFACE_SENDS,
    SURFACE_COUNT
};
// RELUME_ESYSTEM.
relume_status object_parts_program(struct program *program, const struct gl *gl,
                                   const char *fragment, const struct relume_log *log);
// The material that a part is drawn in.
int object_parts_material(const struct object_parts *p, int part);
// Draws every part with its skin, with the program and the array in use.
void object_parts_draw(const struct object_parts *p, const struct program *program);
// Draws triangles without skins, likewise.
void object_parts_draw_whole(const struct object_parts *p);

#endif

// mesh_tasks.h - `relume mesh`: its tasks, and what they share
#ifndef MESHES_MESH_TASKS_H
#define MESHES_MESH_TASKS_H

#include "cli/cli.h"

// Seconds since some moment.
double mesh_clock(void);

// What a command has made: a line of people's text, or a JSON object without its braces.
struct mesh_made {
    const char *output;
    const struct relume_mesh *mesh;
    double seconds;                                 // that it took, without reading and writing
    const struct relume_isosurface_report *report;  // of an isosurface, or NULL
    int block;
};
// The name of the picture that belongs to a mesh: "cow.obj": "cow.png". The caller frees it; NULL
// when memory is short.
char *mesh_picture_name(const char *output);
// The picture first, then the mesh, which needs it and says its name; of both or neither. `mesh` is
// left as it was.
relume_status mesh_write_both(struct relume_mesh *mesh, const char *output,
                              const struct relume_image *picture, char *png,
                              const struct relume_log *log);
void mesh_put_made(struct jwriter *w, const struct mesh_made *m);
void mesh_say(const struct args *args, const struct mesh_made *m);

extern const struct command mesh_task_simplify, mesh_task_billboards;

#endif

// mesh_made.c - what `relume mesh` and its tasks say of a mesh
#include "cli/meshes/mesh_tasks.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

double mesh_clock(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

char *mesh_picture_name(const char *output)
{
    const char *dot = strrchr(output, '.');
    const size_t base = dot ? (size_t)(dot - output) : strlen(output);
    char *name = malloc(base + 5);
    if (name)
        snprintf(name, base + 5, "%.*s.png", (int)base, output);
    return name;
}

relume_status mesh_write_both(struct relume_mesh *mesh, const char *output,
                              const struct relume_image *picture, char *png,
                              const struct relume_log *log)
{
    char *before = mesh->picture;
    relume_status status = relume_image_save(picture, png, relume_image_params(.log = log));
    if (status)
        return status;
    mesh->picture = png;
    status = relume_mesh_write(mesh, output, relume_mesh_params(.log = log));
    mesh->picture = before;
    if (status)
        remove(png);
    return status;
}

void mesh_put_made(struct jwriter *w, const struct mesh_made *m)
{
    jput_text(w, "output", m->output);
    jput_integer(w, "triangles", (long long)m->mesh->triangle_count);
    jput_integer(w, "vertices", (long long)m->mesh->vertex_count);
    jput_fixed(w, "seconds", m->seconds, 6);
    if (m->report) {
        jput_integer(w, "block", m->block);
        jput_integer(w, "boxes", (long long)m->report->boxes);
        jput_integer(w, "ambiguous", (long long)m->report->ambiguous);
    }
}

void mesh_say(const struct args *args, const struct mesh_made *m)
{
    announce(args, RELUME_NOTE, "%s: %zu triangles, %zu vertices, %.2f s", m->output,
             m->mesh->triangle_count, m->mesh->vertex_count, m->seconds);
}

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

void mesh_print_json(const struct mesh_made *m)
{
    printf("\"output\": ");
    json_text(stdout, m->output);
    printf(", \"triangles\": %zu, \"vertices\": %zu, \"seconds\": %.6f", m->mesh->triangle_count,
           m->mesh->vertex_count, m->seconds);
    if (m->report)
        printf(", \"block\": %d, \"boxes\": %zu, \"ambiguous\": %zu", m->block, m->report->boxes,
               m->report->ambiguous);
}

void mesh_say(const struct args *args, const struct mesh_made *m)
{
    announce(args, RELUME_NOTE, "%s: %zu triangles, %zu vertices, %.2f s", m->output,
             m->mesh->triangle_count, m->mesh->vertex_count, m->seconds);
}

// mesh_made.c - what `relume mesh` and its tasks say of a mesh
#include "meshes/mesh_tasks.h"

#include <time.h>

double mesh_clock(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
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

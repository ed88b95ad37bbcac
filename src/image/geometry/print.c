// print.c - a geometry as members of a JSON object
#include "image/geometry/print.h"

void geometry_print_planes(FILE *f, const struct relume_geometry *g)
{
    fprintf(f,
            "{\"uv_plane_z\": %.9g, \"st_plane_z\": %.9g, \"st_min\": [%.9g, %.9g], "
            "\"st_max\": [%.9g, %.9g]",
            g->uv_z, g->st_z, g->st_min[0], g->st_min[1], g->st_max[0], g->st_max[1]);
}

void geometry_print_projection(FILE *f, const struct relume_geometry *g)
{
    fprintf(f, "  \"projection\": \"%s\",\n", relume_projection_name(g->projection));
}

void geometry_print(FILE *f, const struct relume_geometry *g)
{
    geometry_print_projection(f, g);
    if (g->projection == RELUME_PLANAR) {
        fprintf(f,
                "  \"window\": {\"min\": [%.9g, %.9g], \"max\": [%.9g, %.9g], \"camera\": \"%s\", "
                "\"camera_z\": %.9g},\n",
                g->window_min[0], g->window_min[1], g->window_max[0], g->window_max[1],
                g->perspective ? "perspective" : "orthographic", g->camera_z);
    } else if (g->projection == RELUME_SLAB) {
        fputs("  \"slab\": ", f);
        geometry_print_planes(f, g);
        fputs("},\n", f);
    } else {
        fprintf(f, "  \"panorama\": {\"v_min\": %.9g, \"v_max\": %.9g, ", g->v_min, g->v_max);
        if (g->disc)
            fprintf(f, "\"discs\": %d, ", g->disc);
        fprintf(f, "\"center\": [%.9g, %.9g, %.9g]},\n", g->center.x, g->center.y, g->center.z);
    }
}

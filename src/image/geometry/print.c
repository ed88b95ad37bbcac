// print.c - a geometry as members of a JSON object
#include "image/geometry/print.h"

void geometry_put_planes(struct jwriter *w, const struct relume_geometry *g)
{
    jput_number(w, "uv_plane_z", g->uv_z, 9);
    jput_number(w, "st_plane_z", g->st_z, 9);
    jput_numbers(w, "st_min", g->st_min, 2, 9);
    jput_numbers(w, "st_max", g->st_max, 2, 9);
}

void geometry_put_projection(struct jwriter *w, const struct relume_geometry *g)
{
    jgap(w, "\n  ");
    jput_text(w, "projection", relume_projection_name(g->projection));
}

static void put_window(struct jwriter *w, const struct relume_geometry *g)
{
    jopen_object(w, "window");
    jput_numbers(w, "min", g->window_min, 2, 9);
    jput_numbers(w, "max", g->window_max, 2, 9);
    jput_text(w, "camera", g->perspective ? "perspective" : "orthographic");
    jput_number(w, "camera_z", g->camera_z, 9);
    jclose(w);
}

static void put_panorama(struct jwriter *w, const struct relume_geometry *g)
{
    jopen_object(w, "panorama");
    jput_number(w, "v_min", g->v_min, 9);
    jput_number(w, "v_max", g->v_max, 9);
    if (g->disc)
        jput_integer(w, "discs", g->disc);
    jput_vector(w, "center", g->center, 9);
    jclose(w);
}

void geometry_put(struct jwriter *w, const struct relume_geometry *g)
{
    geometry_put_projection(w, g);
    jgap(w, "\n  ");
    if (g->projection == RELUME_PLANAR) {
        put_window(w, g);
    } else if (g->projection == RELUME_SLAB) {
        jopen_object(w, "slab");
        geometry_put_planes(w, g);
        jclose(w);
    } else {
        put_panorama(w, g);
    }
}

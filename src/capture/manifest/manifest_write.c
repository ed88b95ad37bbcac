// manifest_write.c - capture.json, written
#include "capture/manifest/manifest.h"

#include "core/base/json_write.h"
#include "core/base/log.h"
#include "image/geometry/print.h"

#include <stdio.h>
#include <stdlib.h>

// Ends the array as each of its items began: on a line of its own.
static void close_lines(struct jwriter *w, const char *space)
{
    jgap(w, space);
    jclose(w);
}

static void put_vectors(struct jwriter *w, const char *key, const struct relume_vec3 *v, int n)
{
    jgap(w, "\n    ");
    jopen_array(w, key);
    for (int i = 0; i < n; i++) {
        jgap(w, "\n      ");
        jput_vector(w, NULL, v[i], 9);
    }
    close_lines(w, "\n    ");
}

static void put_intensities(struct jwriter *w, const struct relume_manifest *m)
{
    jgap(w, "\n    ");
    jopen_array(w, "intensities");
    for (int i = 0; i < m->lights; i++) {
        jgap(w, "\n      ");
        jput_floats(w, NULL, m->intensities[i], 3, 9);
    }
    close_lines(w, "\n    ");
}

static void put_lights(struct jwriter *w, const struct relume_manifest *m)
{
    jgap(w, "\n  ");
    jopen_object(w, "lights");
    put_vectors(w, "directions", m->directions, m->lights);
    if (m->intensities)
        put_intensities(w, m);
    if (m->positions)
        put_vectors(w, "positions", m->positions, m->lights);
    if (m->positions && m->no_falloff) {
        jgap(w, "\n    ");
        jput_text(w, "falloff", "none");
    }
    if (m->positions && !m->no_falloff && m->intensities_at_origin) {
        jgap(w, "\n    ");
        jput_text(w, "intensities_at", "origin");
    }
    close_lines(w, "\n  ");
}

static void put_slabs(struct jwriter *w, const struct relume_manifest *m)
{
    jgap(w, "\n  ");
    jopen_array(w, "slabs");
    for (int i = 0; i < m->slabs; i++) {
        const struct relume_pose *pose = &m->slab[i].pose;
        jgap(w, "\n    ");
        jopen_object(w, NULL);
        geometry_put_planes(w, &m->slab[i]);
        jgap(w, "\n     ");
        jput_vector(w, "origin", pose->origin, 9);
        jopen_array(w, "axes");
        for (int a = 0; a < 3; a++)
            jput_vector(w, NULL, pose->axis[a], 9);
        jclose_levels(w, 2);
    }
    close_lines(w, "\n  ");
}

static void put_geometry(struct jwriter *w, const struct relume_manifest *m)
{
    if (!m->slabs) {
        geometry_put(w, &m->geometry);
        return;
    }
    geometry_put_projection(w, &m->geometry);
    put_slabs(w, m);
}

static void put_view(struct jwriter *w, const struct relume_manifest *m,
                     const struct relume_manifest_view *v)
{
    jgap(w, "\n    ");
    jopen_object(w, NULL);
    if (m->geometry.projection == RELUME_SLAB)
        jput_numbers(w, "uv", v->uv, 2, 9);
    if (m->slabs)
        jput_integer(w, "slab", v->slab);
    if (v->depth)
        jput_text(w, "depth", v->depth);
    if (v->mask)
        jput_text(w, "mask", v->mask);
    jput_texts(w, "images", (const char *const *)v->images, (size_t)m->lights);
    jclose(w);
}

static void put_head(struct jwriter *w, const struct relume_manifest *m)
{
    jgap(w, "\n  ");
    jput_text(w, "format", "relume-capture");
    jgap(w, "\n  ");
    jput_integer(w, "version", MANIFEST_VERSION);
    if (m->transfer.curve != RELUME_CURVE_AUTO) {
        char transfer[32];
        relume_transfer_text(m->transfer, transfer, sizeof transfer);
        jgap(w, "\n  ");
        jput_text(w, "transfer", transfer);
    }
    if (m->display_coded) {
        jgap(w, "\n  ");
        jput_text(w, "photographs", "display");
    }
    if (m->provenance) {
        jgap(w, "\n  ");
        jput_raw(w, "provenance", m->provenance);
    }
}

static void put_manifest(struct jwriter *w, const struct relume_manifest *m)
{
    jopen_object(w, NULL);
    put_head(w, m);
    put_geometry(w, m);
    put_lights(w, m);
    jgap(w, "\n  ");
    jopen_array(w, "views");
    for (int i = 0; i < m->views; i++)
        put_view(w, m, &m->view[i]);
    close_lines(w, "\n  ");
    jgap(w, "\n");
}

relume_status relume_manifest_write(const struct relume_manifest *manifest, const char *path,
                                    const struct relume_log *log)
{
    if (manifest->transfer.curve == RELUME_CURVE_RESPONSE)
        return log_fail(log, RELUME_EINVAL,
                        "%s: a response curve lives in a file of its own; expected linear pictures",
                        path);
    struct jwriter w = {0};
    put_manifest(&w, manifest);
    return jsave(&w, path, log);
}

char *manifest_text(const struct relume_manifest *manifest)
{
    struct jwriter w = {0};
    put_manifest(&w, manifest);
    return jtake(&w, NULL);
}

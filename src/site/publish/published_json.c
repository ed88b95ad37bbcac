// published_json.c - scene.json: what the tiles mean
#include "site/publish/published.h"

#include "core/math/base64.h"
#include "image/geometry/print.h"
#include "site/publish/guide.h"

#include <relume/format/coder.h>
#include <string.h>

// Little-endian on every machine that the library runs on.
static void put_floats(struct jwriter *w, const char *key, const float *v, size_t n)
{
    jgap(w, "\n  ");
    base64_put(w, key, v, n * sizeof *v);
}

static void put_details(struct jwriter *w, const struct published *f)
{
    text_put_details(w, f->name, &f->details);
    if (f->mm_per_pixel > 0.0) {
        jgap(w, "\n  ");
        jput_number(w, "mm_per_pixel", f->mm_per_pixel, 9);
    }
    if (f->notes) {
        jgap(w, "\n  ");
        jput_truth(w, "notes", true);
    }
}

static void put_basis(struct jwriter *w, const struct common *c)
{
    const struct relume_coder_info *info = relume_coder_info(c->raw);
    jgap(w, "\n  ");
    jopen_object(w, "basis");
    jput_text(w, "name", info->basis->name);
    if (info->interpolant) {
        jput_text(w, "interpolant", info->interpolant->name);
        jput_numbers(w, "parameter", info->parameter, 4, 9);
    }
    jput_integer(w, "coefficients", info->coefficients);
    jput_truth(w, "hemispherical", info->hemispherical);
    jput_text(w, "pole", info->pole_y ? "y" : "z");
    jgap(w, "\n    ");
    jopen_array(w, "lights");
    for (int i = 0; i < info->lights; i++) {
        jput_number(w, NULL, info->directions[i].x, 9);
        jput_number(w, NULL, info->directions[i].y, 9);
        jput_number(w, NULL, info->directions[i].z, 9);
    }
    jclose_levels(w, 2);
}

static void put_planes(struct jwriter *w, const struct published *f)
{
    const struct common *c = &f->common;
    const size_t functions = (size_t)c->functions, planes = (size_t)f->levels.planes;
    jgap(w, "\n  ");
    jput_integer(w, "functions", c->functions);
    jput_integer(w, "planes", f->levels.planes);
    put_floats(w, "transform", c->transform, 3 * planes * functions);
    put_floats(w, "mean", c->mean, 3 * functions);
    jgap(w, "\n  ");
    jput_floats(w, "scale", f->levels.scale, planes, 9);
    jgap(w, "\n  ");
    jput_floats(w, "offset", f->levels.offset, planes, 9);
}

static void put_levels(struct jwriter *w, const struct published *f)
{
    const struct relume_pack_info *info = relume_pack_info(f->pack);
    int width = info->width, height = info->height;
    jgap(w, "\n  ");
    jput_integer(w, "tile", LEVELS_TILE);
    jopen_array(w, "levels");
    for (int i = 0; i < f->levels.count; i++) {
        jopen_object(w, NULL);
        jput_integer(w, "width", width);
        jput_integer(w, "height", height);
        jclose(w);
        width = (width + 1) / 2;
        height = (height + 1) / 2;
    }
    jclose(w);
    jgap(w, "\n  ");
    jput_integer(w, "first_level", f->first_level);
}

static void put_view(struct jwriter *w, const struct published *f, int i)
{
    const struct relume_pack_info *info = relume_pack_info(f->pack);
    char name[16];
    snprintf(name, sizeof name, "v%d", i);
    jgap(w, "\n    ");
    jopen_object(w, NULL);
    jput_text(w, "name", name);
    if (info->geometry.projection == RELUME_SLAB)
        jput_numbers(w, "uv", info->uv[i], 2, 9);
    if (f->layers[i].depth) {
        jput_truth(w, "depth", true);
        jput_number(w, "depth_min", f->layers[i].depth_min, 9);
        jput_number(w, "depth_step", f->layers[i].depth_step, 9);
    }
    if (f->moving[i].there) {
        jopen_object(w, "moving");
        jput_floats(w, "scale", f->moving[i].scale, MOVING_NUMBERS, 9);
        jput_floats(w, "offset", f->moving[i].offset, MOVING_NUMBERS, 9);
        jclose(w);
    }
    if (f->layers[i].mask)
        jput_truth(w, "mask", true);
    jclose(w);
}

static void put_views(struct jwriter *w, const struct published *f)
{
    jgap(w, "\n  ");
    jopen_array(w, "views");
    for (int i = 0; i < relume_pack_info(f->pack)->views; i++)
        put_view(w, f, i);
    jgap(w, "\n  ");
    jclose(w);
}

// Whether planes are coded while the file blends the pictures of neighbouring lights in linear
// light.
static bool is_linear_between(const struct published *f)
{
    const struct relume_coder_info *info = relume_coder_info(f->common.raw);
    return relume_pack_info(f->pack)->domain == RELUME_DOMAIN_LINEAR &&
           f->common.source.coding.curve != RELUME_CURVE_LINEAR && info->interpolant &&
           !strcmp(info->interpolant->name, "delaunay");
}

static void put_light(struct jwriter *w, const struct published *f)
{
    const struct common *c = &f->common;
    char transfer[32];
    relume_transfer_text(c->source.coding, transfer, sizeof transfer);
    jgap(w, "\n  ");
    jput_text(w, "transfer", transfer);
    if (is_linear_between(f)) {
        jgap(w, "\n  ");
        jput_text(w, "between", "linear");
    }
    put_basis(w, c);
    put_planes(w, f);
    if (c->guided) {
        jgap(w, "\n  ");
        jput_number(w, "knee", (double)GUIDE_KNEE, 6);
    }
    if (f->levels.layers != RELUME_PUBLISH_JPEG) {
        jgap(w, "\n  ");
        jput_text(w, "pictures", f->levels.layers == RELUME_PUBLISH_AVIF ? "avif" : "both");
    }
    if (f->metered) {
        jgap(w, "\n  ");
        jput_number(w, "exposure", f->exposure, 6);
    }
}

static void put_relief(struct jwriter *w, const struct relume_relief *relief)
{
    if (!relief->count)
        return;
    jgap(w, "\n  ");
    jopen_array(w, "relief");
    for (int i = 0; i < relief->count; i++)
        jput_integer(w, NULL, relief->light[i]);
    jclose(w);
}

void published_put_json(struct jwriter *w, const struct published *f)
{
    const struct relume_pack_info *info = relume_pack_info(f->pack);
    const bool newer = f->common.guided || f->levels.layers == RELUME_PUBLISH_AVIF;
    jopen_object(w, NULL);
    jgap(w, "\n  ");
    jput_text(w, "format", "relume-web");
    jput_integer(w, "version", newer ? 2 : 1);
    put_details(w, f);
    jgap(w, "\n  ");
    jput_integer(w, "width", info->width);
    jput_integer(w, "height", info->height);
    geometry_put(w, &info->geometry);
    put_light(w, f);
    put_relief(w, &f->relief);
    put_levels(w, f);
    if (info->has_shadow || info->has_gloss) {
        jgap(w, "\n  ");
        jput_text(w, "moves", info->has_shadow ? "shadows" : "highlights");
    }
    put_views(w, f);
    jgap(w, "\n");
}

relume_status published_write_json(const struct published *f)
{
    struct jwriter w = {.style = JSON_MARKUP};
    published_put_json(&w, f);
    return site_save_json(f->site, f->name, "scene.json", true, &w);
}

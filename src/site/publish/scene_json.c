// scene_json.c - scene.json: what the tiles mean
#include "site/publish/scene.h"

#include "core/math/base64.h"
#include "image/geometry/print.h"
#include "site/publish/guide.h"

#include <relume/format/coder.h>
#include <string.h>

// Little-endian on every machine that the library runs on.
static void put_floats(FILE *f, const char *key, const float *v, size_t n)
{
    fprintf(f, "  \"%s\": \"", key);
    base64_print(f, (const uint8_t *)v, n * sizeof *v);
    fputs("\",\n", f);
}

static void put_numbers(FILE *f, const char *key, const float *v, int n)
{
    fprintf(f, "  \"%s\": [", key);
    for (int i = 0; i < n; i++)
        fprintf(f, "%s%.9g", i ? ", " : "", (double)v[i]);
    fputs("],\n", f);
}

static void put_details(FILE *f, const struct scene *s)
{
    text_details(f, s->name, &s->details);
    if (s->mm_per_pixel > 0.0)
        fprintf(f, "  \"mm_per_pixel\": %.9g,\n", s->mm_per_pixel);
    if (s->notes)
        fputs("  \"notes\": true,\n", f);
}

static void put_basis(FILE *f, const struct common *c)
{
    const struct relume_coder_info *info = relume_coder_info(c->raw);
    fprintf(f, "  \"basis\": {\"name\": \"%s\", ", info->basis->name);
    if (info->interpolant)
        fprintf(f, "\"interpolant\": \"%s\", \"parameter\": [%.9g, %.9g, %.9g, %.9g], ",
                info->interpolant->name, info->parameter[0], info->parameter[1], info->parameter[2],
                info->parameter[3]);
    fprintf(f, "\"coefficients\": %d, \"hemispherical\": %s, \"pole\": \"%s\",\n    \"lights\": [",
            info->coefficients, info->hemispherical ? "true" : "false", info->pole_y ? "y" : "z");
    for (int i = 0; i < info->lights; i++)
        fprintf(f, "%s%.9g, %.9g, %.9g", i ? ", " : "", info->directions[i].x,
                info->directions[i].y, info->directions[i].z);
    fputs("]},\n", f);
}

static void put_levels(FILE *f, const struct scene *s)
{
    const struct relume_pack_info *info = relume_pack_info(s->pack);
    int width = info->width, height = info->height;
    const int n = s->levels.count;
    fprintf(f, "  \"tile\": %d, \"levels\": [", LEVELS_TILE);
    for (int i = 0; i < n; i++) {
        fprintf(f, "%s{\"width\": %d, \"height\": %d}", i ? ", " : "", width, height);
        width = (width + 1) / 2;
        height = (height + 1) / 2;
    }
    fprintf(f, "],\n  \"first_level\": %d,\n", s->first_level);
}

static void put_moving(FILE *f, const struct moving *m)
{
    fputs(", \"moving\": {\"scale\": [", f);
    for (int i = 0; i < MOVING_NUMBERS; i++)
        fprintf(f, "%s%.9g", i ? ", " : "", (double)m->scale[i]);
    fputs("], \"offset\": [", f);
    for (int i = 0; i < MOVING_NUMBERS; i++)
        fprintf(f, "%s%.9g", i ? ", " : "", (double)m->offset[i]);
    fputs("]}", f);
}

static void put_views(FILE *f, const struct scene *s)
{
    const struct relume_pack_info *info = relume_pack_info(s->pack);
    fputs("  \"views\": [", f);
    for (int i = 0; i < info->views; i++) {
        fprintf(f, "%s{\"name\": \"v%d\"", i ? ",\n    " : "\n    ", i);
        if (info->geometry.projection == RELUME_SLAB)
            fprintf(f, ", \"uv\": [%.9g, %.9g]", info->uv[i][0], info->uv[i][1]);
        if (s->layers[i].depth)
            fprintf(f, ", \"depth\": true, \"depth_min\": %.9g, \"depth_step\": %.9g",
                    s->layers[i].depth_min, s->layers[i].depth_step);
        if (s->moving[i].there)
            put_moving(f, &s->moving[i]);
        fprintf(f, "%s}", s->layers[i].mask ? ", \"mask\": true" : "");
    }
    fputs("\n  ]\n", f);
}

// Whether planes are coded while the file blends the pictures of neighbouring lights in linear
// light.
static bool is_linear_between(const struct scene *s)
{
    const struct relume_coder_info *info = relume_coder_info(s->common.raw);
    return relume_pack_info(s->pack)->domain == RELUME_DOMAIN_LINEAR &&
           s->common.source.coding.curve != RELUME_CURVE_LINEAR && info->interpolant &&
           !strcmp(info->interpolant->name, "delaunay");
}

void scene_print_json(FILE *f, const struct scene *s)
{
    const struct relume_pack_info *info = relume_pack_info(s->pack);
    const struct common *c = &s->common;
    const size_t functions = (size_t)c->functions;
    char transfer[32];
    fprintf(f, "{\n  \"format\": \"relume-web\", \"version\": %d,\n",
            c->guided || s->levels.layers == RELUME_PUBLISH_AVIF ? 2 : 1);
    put_details(f, s);
    fprintf(f, "  \"width\": %d, \"height\": %d,\n", info->width, info->height);
    geometry_print(f, &info->geometry);
    relume_transfer_text(c->source.coding, transfer, sizeof transfer);
    fprintf(f, "  \"transfer\": \"%s\",\n", transfer);
    if (is_linear_between(s))
        fputs("  \"between\": \"linear\",\n", f);
    put_basis(f, c);
    fprintf(f, "  \"functions\": %d, \"planes\": %d,\n", c->functions, s->levels.planes);
    put_floats(f, "transform", c->transform, 3 * (size_t)s->levels.planes * functions);
    put_floats(f, "mean", c->mean, 3 * functions);
    put_numbers(f, "scale", s->levels.scale, s->levels.planes);
    put_numbers(f, "offset", s->levels.offset, s->levels.planes);
    if (c->guided)
        fprintf(f, "  \"knee\": %g,\n", (double)GUIDE_KNEE);
    if (s->levels.layers != RELUME_PUBLISH_JPEG)
        fprintf(f, "  \"pictures\": \"%s\",\n",
                s->levels.layers == RELUME_PUBLISH_AVIF ? "avif" : "both");
    if (s->metered)
        fprintf(f, "  \"exposure\": %g,\n", s->exposure);
    put_levels(f, s);
    if (info->has_shadow || info->has_gloss)
        fprintf(f, "  \"moves\": \"%s\",\n", info->has_shadow ? "shadows" : "highlights");
    put_views(f, s);
    fputs("}\n", f);
}

relume_status scene_write_json(const struct scene *s)
{
    char name[128];
    struct text t;
    const relume_status status = text_open(&t);
    if (status)
        return status;
    scene_print_json(t.file, s);
    snprintf(name, sizeof name, "%s/scene.json", s->name);
    return site_save_text(s->site, name, true, &t);
}

// write.c - a folder of maps (docs/maps.md)
#include "material/maps/write.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/outdir.h"
#include "core/base/outfile.h"
#include "core/base/params.h"
#include "material/maps/folder.h"
#include "material/maps/ggx.h"

#include <math.h>

relume_status write_bytes(const struct writing *w, const char *name, const void *bytes, size_t size)
{
    char *path = mem_format("%s/%s", w->folder, name);
    const relume_status status =
        path ? outfile_save(path, bytes, size, w->params->log) : RELUME_ENOMEM;
    mem_free(path);
    return status;
}

relume_status write_text(const struct writing *w, const char *name,
                         void (*put)(const void *w, FILE *f))
{
    return folder_print(w->folder, name, put, w, w->params->log);
}

static relume_status save(const struct writing *w, const struct relume_image *image,
                          const char *name)
{
    return folder_save(w->folder, name, image, w->params->threads, w->params->log);
}

// ---------------------------------------------------------------- pictures for other programs

static bool is_known(const struct relume_maps *m, size_t at)
{
    const float *n = m->normal.data + 3 * at;
    return n[0] != 0.0f || n[1] != 0.0f || n[2] != 0.0f;
}

// Pictures are saved coded by sRGB; what is no colour is turned the other way before.
static float uncoded(float value)
{
    return relume_transfer_decode((struct relume_transfer){.curve = RELUME_CURVE_SRGB}, value);
}

static void fill_normal(float *out, const struct writing *w, size_t at, float green)
{
    const float *n = w->maps->normal.data + 3 * at;
    const bool known = is_known(w->maps, at);
    out[0] = uncoded(0.5f + 0.5f * n[0]);
    out[1] = uncoded(0.5f + 0.5f * green * n[1]);
    out[2] = uncoded(known ? 0.5f + 0.5f * n[2] : 1.0f);
}

static void fill_upward(float *out, const struct writing *w, size_t at)
{
    fill_normal(out, w, at, 1.0f);
}

static void fill_downward(float *out, const struct writing *w, size_t at)
{
    fill_normal(out, w, at, -1.0f);
}

static void fill_colour(float *out, const struct writing *w, size_t at)
{
    for (size_t c = 0; c < 3; c++)
        out[c] = w->maps->base_color.data[3 * at + c];
    out[3] = is_known(w->maps, at) ? 1.0f : 0.0f;
}

static void fill_packed(float *out, const struct writing *w, size_t at)
{
    const bool known = is_known(w->maps, at);
    out[0] = uncoded(known ? w->maps->occlusion.data[at] : 1.0f);
    out[1] = uncoded(known ? w->maps->roughness.data[at] : 1.0f);
    out[2] = uncoded(w->maps->metallic.data[at]);
}

static void fill_specular(float *out, const struct writing *w, size_t at)
{
    const float *specular = w->maps->specular.data + 3 * at;
    const bool metal = w->maps->metallic.data[at] > 0.5f;
    float most = 0.0f;
    for (int c = 0; c < 3; c++)
        most = fmaxf(most, specular[c]);
    const float weight = metal ? 1.0f : gloss_f90(most);
    for (int c = 0; c < 3; c++)
        out[c] = metal || weight < 1.0f
                     ? (float)(1.0 / w->specular_most)
                     : specular[c] / (float)(w->specular_most * (double)GGX_COMMON_F0);
    out[3] = weight;
}

static relume_status save_made(const struct writing *w, const char *name, int channels,
                               void (*fill)(float *out, const struct writing *w, size_t at))
{
    struct relume_image image;
    relume_status status = relume_image_create(&image, w->maps->width, w->maps->height, channels);
    const size_t pixels = (size_t)w->maps->width * (size_t)w->maps->height;
    for (size_t i = 0; !status && i < pixels; i++) {
        float out[4];
        fill(out, w, i);
        for (int c = 0; c < channels; c++)
            image.data[(size_t)channels * i + (size_t)c] = out[c];
    }
    if (!status)
        status = save(w, &image, name);
    relume_image_destroy(&image);
    return status;
}

// Heights in the unit that maps.json names.
static relume_status save_height(const struct writing *w)
{
    const double unit = w->params->width_mm > 0.0 ? 1000.0 * w->metres : 1.0;
    struct relume_image image;
    relume_status status = relume_image_create(&image, w->maps->width, w->maps->height, 1);
    const size_t pixels = (size_t)w->maps->width * (size_t)w->maps->height;
    for (size_t i = 0; !status && i < pixels; i++)
        image.data[i] = (float)(unit * (double)w->maps->height_map.data[i]);
    if (!status)
        status = save(w, &image, "height.exr");
    relume_image_destroy(&image);
    return status;
}

static relume_status save_values(const struct writing *w)
{
    const struct relume_maps *m = w->maps;
    const struct {
        const struct relume_image *image;
        const char *name;
    } files[] = {
        {&m->normal, "normal.exr"},         {&m->base_color, "basecolor.exr"},
        {&m->roughness, "roughness.exr"},   {&m->metallic, "metallic.exr"},
        {&m->specular, "specular.exr"},     {&m->occlusion, "occlusion.exr"},
        {&m->confidence, "confidence.exr"},
    };
    relume_status status = save_height(w);
    for (size_t i = 0; !status && i < sizeof files / sizeof *files; i++)
        status = save(w, files[i].image, files[i].name);
    return status;
}

static relume_status save_pictures(const struct writing *w)
{
    relume_status status =
        save_made(w, "normal.png", 3, w->params->directx ? fill_downward : fill_upward);
    if (!status && w->params->directx)
        status = save_made(w, w->gl_normal, 3, fill_upward);
    if (!status)
        status = save_made(w, "basecolor.png", w->masked ? 4 : 3, fill_colour);
    if (!status)
        status = save_made(w, "orm.png", 3, fill_packed);
    if (!status)
        status = save_made(w, "specular.png", 4, fill_specular);
    return status;
}

// ---------------------------------------------------------------- maps.json

static void put_number(FILE *f, const char *name, double value)
{
    if (isfinite(value))
        fprintf(f, ", \"%s\": %.6g", name, value);
    else
        fprintf(f, ", \"%s\": null", name);
}

static void put_quality(FILE *f, const char *name, const struct relume_maps_quality *q)
{
    fprintf(f, ",\n\"%s\": {\"lights\": %d", name, q->lights);
    put_number(f, "psnr_db", q->psnr_db);
    put_number(f, "ssim", q->ssim);
    put_number(f, "delta_e", q->delta_e);
    put_number(f, "off", q->off);
    put_number(f, "shadowed", q->shadowed);
    put_number(f, "brighter", q->brighter);
    fputs("}", f);
}

static void put_description(const void *context, FILE *f)
{
    const struct writing *w = context;
    const struct relume_maps *m = w->maps;
    const double mm = w->params->width_mm;
    fprintf(f, "{\n\"format\": \"relume-maps\", \"version\": 1,\n\"width\": %d, \"height\": %d",
            m->width, m->height);
    put_number(f, "width_mm", mm > 0.0 ? mm : NAN);
    put_number(f, "width_world", m->pixel * m->width);
    fprintf(f, ",\n\"height_unit\": \"%s\", \"normal_green\": \"%s\"", mm > 0.0 ? "mm" : "world",
            w->params->directx ? "down" : "up");
    put_number(f, "gain", m->gain);
    put_number(f, "specular_factor", w->specular_most);
    fprintf(f, ",\n\"gloss\": %s, \"fitted_lights\": %d, \"materials\": [",
            m->matte_only ? "false" : "true", m->lights);
    for (int i = 0; i < m->materials; i++) {
        const struct relume_maps_material *k = &m->material[i];
        fprintf(f, "%s\n    {\"metal\": %s", i ? "," : "", k->metal ? "true" : "false");
        put_number(f, "f0", k->metal ? NAN : k->f0);
        put_number(f, "roughness", k->roughness);
        put_number(f, "share", k->share);
        fputs("}", f);
    }
    fputs("]", f);
    put_quality(f, "held_out", &m->held_out);
    put_quality(f, "fitted", &m->fitted);
    fputs("\n}\n", f);
}

// ---------------------------------------------------------------- the folder

static void look_over(struct writing *w)
{
    const struct relume_maps *m = w->maps;
    const size_t pixels = (size_t)m->width * (size_t)m->height;
    float most = GGX_COMMON_F0;
    for (size_t i = 0; i < pixels; i++) {
        w->masked |= !is_known(m, i);
        for (size_t c = 0; c < 3 && !(m->metallic.data[i] > 0.5f); c++)
            most = fmaxf(most, m->specular.data[3 * i + c]);
    }
    w->specular_most = (double)(most / GGX_COMMON_F0);
}

relume_status relume_maps_write(const struct relume_maps *maps, const char *path,
                                const struct relume_maps_write_params *params)
{
    struct relume_maps_write_params p = PARAMS_WORK(relume_maps_write_params, params);
    const double width = maps->pixel * maps->width;
    p.width_mm = p.width_mm != 0.0 ? p.width_mm : maps->width_mm;
    p.directx |= maps->directx;
    struct writing w = {
        .maps = maps,
        .params = &p,
        .gl_normal = p.directx ? "normal-gl.png" : "normal.png",
        .metres = p.width_mm > 0.0 ? p.width_mm / 1000.0 / width : 1.0,
    };
    if (p.mesh < 0 || p.mesh > 1024 || !(p.width_mm >= 0.0) || isinf(p.width_mm))
        return log_fail(p.log, RELUME_EINVAL,
                        "%s: a mesh has 1 to 1024 columns, a picture a width above 0 mm", path);
    outdir *dir;
    relume_status status = outdir_open(&dir, path, p.force, p.log);
    if (status)
        return status;
    w.folder = outdir_path(dir);
    look_over(&w);
    status = save_values(&w);
    if (!status)
        status = save_pictures(&w);
    if (!status)
        status = write_gltf(&w);
    if (!status)
        status = write_materialx(&w);
    if (!status)
        status = write_text(&w, "maps.json", put_description);
    return outdir_end(&dir, status);
}

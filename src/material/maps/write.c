// write.c - a folder of maps (docs/maps.md)
#include "material/maps/write.h"

#include "core/base/json_write.h"
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

static void put_quality(struct jwriter *w, const char *name, const struct relume_maps_quality *q)
{
    jgap(w, "\n");
    jopen_object(w, name);
    jput_integer(w, "lights", q->lights);
    jput_number(w, "psnr_db", q->psnr_db, 6);
    jput_number(w, "ssim", q->ssim, 6);
    jput_number(w, "delta_e", q->delta_e, 6);
    jput_number(w, "off", q->off, 6);
    jput_number(w, "shadowed", q->shadowed, 6);
    jput_number(w, "brighter", q->brighter, 6);
    jclose(w);
}

static void put_material(struct jwriter *w, const struct relume_maps_material *k)
{
    jgap(w, "\n    ");
    jopen_object(w, NULL);
    jput_truth(w, "metal", k->metal);
    jput_number(w, "f0", k->metal ? (double)NAN : k->f0, 6);
    jput_number(w, "roughness", k->roughness, 6);
    jput_number(w, "share", k->share, 6);
    jclose(w);
}

static void put_size(struct jwriter *w, const struct writing *writing)
{
    const struct relume_maps *m = writing->maps;
    const double mm = writing->params->width_mm;
    jgap(w, "\n");
    jput_integer(w, "width", m->width);
    jput_integer(w, "height", m->height);
    jput_number(w, "width_mm", mm > 0.0 ? mm : (double)NAN, 6);
    jput_number(w, "width_world", m->pixel * m->width, 6);
    jgap(w, "\n");
    jput_text(w, "height_unit", mm > 0.0 ? "mm" : "world");
}

static relume_status write_description(const struct writing *writing)
{
    const struct relume_maps *m = writing->maps;
    struct jwriter w = {0};
    jopen_object(&w, NULL);
    jgap(&w, "\n");
    jput_text(&w, "format", "relume-maps");
    jput_integer(&w, "version", 1);
    put_size(&w, writing);
    jput_text(&w, "normal_green", writing->params->directx ? "down" : "up");
    jput_number(&w, "gain", m->gain, 6);
    jput_number(&w, "specular_factor", writing->specular_most, 6);
    jgap(&w, "\n");
    jput_truth(&w, "gloss", !m->matte_only);
    jput_integer(&w, "fitted_lights", m->lights);
    jopen_array(&w, "materials");
    for (int i = 0; i < m->materials; i++)
        put_material(&w, &m->material[i]);
    jclose(&w);
    put_quality(&w, "held_out", &m->held_out);
    put_quality(&w, "fitted", &m->fitted);
    jgap(&w, "\n");
    return jsave_in(&w, writing->folder, "maps.json", writing->params->log);
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
        status = write_description(&w);
    return outdir_end(&dir, status);
}

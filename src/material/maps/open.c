// open.c - a folder of maps read back (docs/maps.md)
#include "core/base/infile.h"
#include "core/base/json.h"
#include "core/base/log.h"
#include "core/base/memory.h"

#include <relume/material/maps.h>

#include <math.h>
#include <string.h>

enum { VERSION = 1 };

struct reader {
    const char *json;
    const struct relume_log *log;
};

// A number above 0, or null.
static bool read_width(double *out, const jvalue *value)
{
    *out = 0.0;
    return jvalue_is_null(value) || (jvalue_number(value, out) && *out > 0.0);
}

static relume_status read_materials(struct relume_maps *m, const jvalue *list,
                                    const struct reader *r)
{
    if (!jvalue_is_array(list) || jvalue_count(list) > RELUME_MAPS_MOST_MATERIALS)
        return log_wrong(r->log, r->json, "materials", "a list of at most 16");
    m->materials = (int)jvalue_count(list);
    for (int i = 0; i < m->materials; i++) {
        const jvalue *item = jvalue_item(list, (size_t)i);
        struct relume_maps_material *k = &m->material[i];
        if (!jvalue_truth(jvalue_member(item, "metal"), &k->metal) ||
            !jvalue_number(jvalue_member(item, "roughness"), &k->roughness) ||
            !jvalue_number(jvalue_member(item, "share"), &k->share) ||
            (!k->metal && !jvalue_number(jvalue_member(item, "f0"), &k->f0)))
            return log_wrong(r->log, r->json, "materials",
                             "metal, f0, roughness and share of each");
    }
    return RELUME_OK;
}

static relume_status read_description(struct relume_maps *m, const struct reader *r,
                                      const jvalue *root)
{
    const char *green = jvalue_text(jvalue_member(root, "normal_green"));
    double width = 0.0;
    bool gloss = true;
    relume_status status = jvalue_check_format(root, r->json, "relume-maps", VERSION, r->log);
    if (status)
        return status;
    if (!jvalue_whole(jvalue_member(root, "width"), 1, 1 << 20, &m->width) ||
        !jvalue_whole(jvalue_member(root, "height"), 1, 1 << 20, &m->height))
        return log_wrong(r->log, r->json, "width, height", "pixels");
    if (!jvalue_number(jvalue_member(root, "width_world"), &width) || !(width > 0.0) ||
        !read_width(&m->width_mm, jvalue_member(root, "width_mm")))
        return log_wrong(r->log, r->json, "width_world, width_mm", "widths above 0");
    if (!green || (strcmp(green, "up") && strcmp(green, "down")))
        return log_wrong(r->log, r->json, "normal_green", "up or down");
    if (!jvalue_truth(jvalue_member(root, "gloss"), &gloss) ||
        !jvalue_number(jvalue_member(root, "gain"), &m->gain) ||
        !jvalue_whole(jvalue_member(root, "fitted_lights"), 0, 1 << 20, &m->lights))
        return log_wrong(r->log, r->json, "gloss, gain, fitted_lights", "what relume writes");
    m->pixel = width / m->width;
    m->directx = !strcmp(green, "down");
    m->matte_only = !gloss;
    return read_materials(m, jvalue_member(root, "materials"), r);
}

static relume_status read_picture(struct relume_image *out, const struct relume_maps *m,
                                  const char *folder, const char *name, int channels,
                                  const struct relume_log *log)
{
    char *path = mem_format("%s/%s", folder, name);
    relume_status status =
        path ? relume_image_load(out, path, relume_image_params(.log = log, .channels = channels))
             : RELUME_ENOMEM;
    if (!status && (out->width != m->width || out->height != m->height))
        status = log_fail(log, RELUME_EUNFIT, "%s: expected %d x %d pixels; found %d x %d", path,
                          m->width, m->height, out->width, out->height);
    for (size_t i = 0; !status && i < (size_t)m->width * (size_t)m->height * (size_t)channels; i++)
        if (!isfinite(out->data[i]))
            status =
                log_fail(log, RELUME_EDAMAGED, "%s: NaN or infinity; expected finite values", path);
    mem_free(path);
    return status;
}

static relume_status read_pictures(struct relume_maps *m, const char *folder,
                                   const struct relume_log *log)
{
    const struct {
        struct relume_image *image;
        const char *name;
        int channels;
    } files[] = {
        {&m->normal, "normal.exr", 3},         {&m->base_color, "basecolor.exr", 3},
        {&m->roughness, "roughness.exr", 1},   {&m->metallic, "metallic.exr", 1},
        {&m->specular, "specular.exr", 3},     {&m->occlusion, "occlusion.exr", 1},
        {&m->confidence, "confidence.exr", 1}, {&m->height_map, "height.exr", 1},
    };
    relume_status status = RELUME_OK;
    for (size_t i = 0; !status && i < sizeof files / sizeof *files; i++)
        status = read_picture(files[i].image, m, folder, files[i].name, files[i].channels, log);
    // heights are in the unit that maps.json names
    const double unit = m->width_mm > 0.0 ? m->pixel * m->width / m->width_mm : 1.0;
    for (size_t i = 0; !status && i < (size_t)m->width * (size_t)m->height; i++)
        m->height_map.data[i] = (float)((double)m->height_map.data[i] * unit);
    return status;
}

relume_status relume_maps_open(struct relume_maps *out, const char *path,
                               const struct relume_log *log)
{
    const struct relume_maps_quality unknown = {0,           (double)NAN, (double)NAN, (double)NAN,
                                                (double)NAN, (double)NAN, (double)NAN};
    char *json = mem_format("%s/maps.json", path);
    const struct reader r = {json, log};
    jvalue *root = NULL;
    *out = (struct relume_maps){.fitted = unknown, .held_out = unknown};
    relume_status status = json ? RELUME_OK : RELUME_ENOMEM;
    if (json && !input_exists(json, log))
        status = log_fail(log, RELUME_ENOTFOUND,
                          "%s: no such file; expected a folder as relume maps makes it", json);
    if (!status)
        status = jvalue_load(&root, json, log);
    if (!status)
        status = read_description(out, &r, root);
    if (!status)
        status = read_pictures(out, path, log);
    jvalue_free(&root);
    mem_free(json);
    if (status)
        relume_maps_destroy(out);
    return status;
}

// write.c - the folder of a comparison: pictures, what was measured, and a page that shows both
#include "material/change/report.h"

#include "core/base/outdir.h"
#include "core/base/params.h"
#include "core/math/scalar.h"
#include "core/math/vec.h"
#include "material/maps/folder.h"

#include <math.h>

static const struct relume_vec3 lamp = {-0.62, 0.62, 0.48};  // raking, from the upper left
static const float ambient = 0.06f;

static relume_status save(const struct writing *w, const struct relume_image *image,
                          const char *name)
{
    return folder_save(w->folder, name, image, w->params->threads, w->params->log);
}

static relume_status save_made(const struct writing *w, const char *name,
                               void (*pixel)(float rgb[3], const struct writing *w, size_t at))
{
    const struct relume_change *c = w->change;
    struct relume_image image;
    relume_status status = relume_image_create(&image, c->width, c->height, 3);
    for (size_t i = 0; !status && i < (size_t)c->width * (size_t)c->height; i++)
        pixel(image.data + 3 * i, w, i);
    if (!status)
        status = save(w, &image, name);
    relume_image_destroy(&image);
    return status;
}

// ---------------------------------------------------------------- pixels

static bool is_known(const struct relume_change *c, size_t at)
{
    const float *n = c->normal[0].data + 3 * at;
    return n[0] != 0.0f || n[1] != 0.0f || n[2] != 0.0f;
}

static float lit(const struct relume_image *normal, size_t at)
{
    const double cosine = vec3_dot(vec3_floats(normal->data + 3 * at), vec3_unit(lamp));
    return 1.3f * (ambient + fmaxf((float)cosine, 0.0f));
}

static void put_lit(float rgb[3], const struct writing *w, size_t at, int which)
{
    const struct relume_change *c = w->change;
    for (size_t k = 0; k < 3; k++)
        rgb[k] =
            is_known(c, at) ? c->albedo[which].data[3 * at + k] * lit(&c->normal[which], at) : 0.0f;
}

static void put_before(float rgb[3], const struct writing *w, size_t at)
{
    put_lit(rgb, w, at, 0);
}

static void put_after(float rgb[3], const struct writing *w, size_t at)
{
    put_lit(rgb, w, at, 1);
}

// Black, purple, red, yellow, white: display values of five steps.
static void put_ramp(float rgb[3], double t)
{
    static const float step[5][3] = {{0.0f, 0.0f, 0.02f},
                                     {0.34f, 0.06f, 0.43f},
                                     {0.73f, 0.21f, 0.33f},
                                     {0.98f, 0.55f, 0.04f},
                                     {0.99f, 1.0f, 0.75f}};
    const double at = 4.0 * fmin(fmax(t, 0.0), 1.0);
    const int i = smaller_of((int)at, 3);
    const float part = (float)(at - i);
    for (int c = 0; c < 3; c++)
        rgb[c] = relume_transfer_decode((struct relume_transfer){.curve = RELUME_CURVE_SRGB},
                                        step[i][c] + part * (step[i + 1][c] - step[i][c]));
}

static void put_degrees(float rgb[3], const struct writing *w, size_t at)
{
    put_ramp(rgb, (double)w->change->degrees.data[at] / RAMP_DEGREES);
}

static void put_delta_e(float rgb[3], const struct writing *w, size_t at)
{
    put_ramp(rgb, (double)w->change->delta_e.data[at] / RAMP_DELTA_E);
}

static void put_gloss(float rgb[3], const struct writing *w, size_t at)
{
    put_ramp(rgb, fabs((double)w->change->gloss.data[at]) / RAMP_GLOSS);
}

static void put_significance(float rgb[3], const struct writing *w, size_t at)
{
    const float *s = w->change->significance.data + 3 * at;
    put_ramp(rgb, (double)fmaxf(fmaxf(s[0], s[1]), s[2]) / RAMP_SIGNIFICANCE);
}

// The first capture in grey; orange where the shape has changed, blue the colour, pink both, green
// the gloss alone.
static void put_changed(float rgb[3], const struct writing *w, size_t at)
{
    const float *c = w->change->changed.data + 3 * at;
    float own[3];
    put_before(own, w, at);
    const float grey = 0.6f * (own[0] + own[1] + own[2]) / 3.0f;
    const bool shape = c[0] > 0.5f, colour = c[1] > 0.5f;
    if (!shape && !colour && c[2] > 0.5f) {
        rgb[0] = 0.05f, rgb[1] = 0.6f, rgb[2] = 0.1f;
        return;
    }
    rgb[0] = shape ? 1.0f : colour ? 0.02f : grey;
    rgb[1] = shape ? colour ? 0.05f : 0.25f : colour ? 0.3f : grey;
    rgb[2] = shape ? colour ? 0.6f : 0.0f : colour ? 1.0f : grey;
}

static relume_status save_all(const struct writing *w)
{
    static const struct {
        const char *name;
        void (*pixel)(float rgb[3], const struct writing *w, size_t at);
    } made[] = {{"before.png", put_before},
                {"after.png", put_after},
                {"changed.png", put_changed},
                {"shape.png", put_degrees},
                {"colour.png", put_delta_e},
                {"gloss.png", put_gloss},
                {"significance.png", put_significance}};
    relume_status status = RELUME_OK;
    for (size_t i = 0; !status && i < sizeof made / sizeof *made; i++)
        status = save_made(w, made[i].name, made[i].pixel);
    if (!status)
        status = save(w, &w->change->degrees, "degrees.exr");
    if (!status)
        status = save(w, &w->change->delta_e, "delta_e.exr");
    if (!status)
        status = save(w, &w->change->gloss, "gloss.exr");
    if (!status)
        status = save(w, &w->change->significance, "significance.exr");
    return status;
}

relume_status relume_change_write(const struct relume_change *change, const char *path,
                                  const struct relume_change_write_params *params)
{
    struct relume_change_write_params p = PARAMS_WORK(relume_change_write_params, params);
    struct writing w = {.change = change, .params = &p};
    outdir *dir;
    p.places = p.places ? p.places : 20;
    p.name[0] = p.name[0] ? p.name[0] : "before";
    p.name[1] = p.name[1] ? p.name[1] : "after";
    if (!change->degrees.data)
        return RELUME_EINVAL;
    relume_status status = outdir_open(&dir, path, p.force, p.log);
    if (!status) {
        w.folder = outdir_path(dir);
        status = save_all(&w);
    }
    if (!status)
        status = report_write(&w);
    return outdir_end(&dir, status);
}

// photos.c - the photographs of a view, pixel by pixel
#include "material/maps/photos.h"

#include "capture/manifest/reflectance_table.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/thread.h"

static const size_t band_bytes = (size_t)64 << 20;  // of samples
static const float clipped = 0.995f;                // of the largest value

void photos_look_from(struct look *k, const struct near_view *view, vec3 point)
{
    const struct relume_geometry *g = &view->geometry;
    const bool slab = g->projection == RELUME_SLAB;
    const vec3 eye = slab ? relume_pose_world(&g->pose, vec3_of(view->uv[0], view->uv[1], g->uv_z))
                          : vec3_of(0.0, 0.0, g->camera_z);
    const vec3 to =
        slab || g->perspective ? vec3_unit(vec3_sub(eye, point)) : vec3_of(0.0, 0.0, 1.0);
    k->view[0] = (float)to.x, k->view[1] = (float)to.y, k->view[2] = (float)to.z;
}

relume_status photos_open(struct photos *out, const relume_capture *capture, int view,
                          const int *light, int lights, int threads, const struct relume_log *log)
{
    *out = (struct photos){
        .capture = capture,
        .log = log,
        .view = view,
        .threads = thread_count(threads),
        .width = relume_capture_width(capture),
        .height = relume_capture_height(capture),
        .lights = lights,
        .light = light,
        .gain = 1.0f,
        .is_near = near_view_applies(capture, view),
    };
    const size_t all = (size_t)relume_capture_manifest(capture)->lights;
    const size_t row_bytes = (size_t)out->width * all * 3 * sizeof(float);
    const size_t fitting = band_bytes / row_bytes;
    out->rows = fitting < 1 ? 1 : fitting < (size_t)out->height ? (int)fitting : out->height;
    out->white = mem_array((size_t)lights, sizeof *out->white);
    out->memory = mem_array((size_t)out->threads * look_size(lights), sizeof *out->memory);
    out->samples =
        mem_array(3 * all * (size_t)out->rows * (size_t)out->width, sizeof *out->samples);
    relume_status status = out->white && out->memory && out->samples ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < lights; i++)
        relume_capture_white(capture, light[i], out->white[i]);
    if (!status)
        status = near_view_open(&out->near, capture, view, log);
    if (!status)
        status = relume_capture_mask(&out->known, capture, view, log);
    const size_t pixels = (size_t)out->width * (size_t)out->height;
    if (!status && !out->known.data &&
        !(status = relume_image_create(&out->known, out->width, out->height, 1)))
        for (size_t i = 0; i < pixels; i++)
            out->known.data[i] = 1.0f;
    if (status)
        photos_close(out);
    return status;
}

void photos_close(struct photos *p)
{
    mem_free(p->white);
    mem_free(p->memory);
    mem_free(p->samples);
    near_view_close(&p->near);
    relume_image_destroy(&p->known);
    *p = (struct photos){0};
}

struct band {
    void (*row)(void *context, size_t y, int worker);
    void *context;
    size_t first;
};

static void do_row(void *context, size_t item, int worker)
{
    const struct band *b = context;
    b->row(b->context, b->first + item, worker);
}

relume_status photos_each(struct photos *p, const char *what,
                          void (*row)(void *context, size_t y, int worker), void *context)
{
    relume_table *table;
    const int most = p->rows;
    relume_status status = relume_table_open(
        &table, p->capture, p->view,
        relume_table_params(.keep_near = true, .log = p->log, .threads = p->threads));
    for (p->row = 0; !status && p->row < p->height; p->row += p->rows) {
        p->rows = p->height - p->row < most ? p->height - p->row : most;
        status = relume_table_read(table, p->rows, p->samples);
        struct band band = {row, context, (size_t)p->row};
        if (!status)
            thread_for(p->threads, (size_t)p->rows, do_row, &band);
        if (!status && !log_progress(p->log, what, (p->row + p->rows) / (double)p->height))
            status = RELUME_ECANCEL;
    }
    p->rows = most;
    relume_table_destroy(&table);
    return status;
}

static void find_lights(struct look *k, const struct photos *p, int x, int y, float *bright)
{
    const struct relume_vec3 *distant = relume_capture_manifest(p->capture)->directions;
    const vec3 point = near_view_pixel(&p->near, x, y);
    photos_look_from(k, &p->near, point);
    for (int i = 0; i < k->known; i++) {
        double gain = 1.0;
        const vec3 l = p->is_near ? near_view_direction(&gain, &p->near, p->light[i], point)
                                  : distant[p->light[i]];
        k->towards[0][i] = (float)l.x, k->towards[1][i] = (float)l.y, k->towards[2][i] = (float)l.z;
        bright[i] = (float)gain;
    }
    look_halve(k);
}

void photos_look_into(struct look *k, const struct photos *p, int x, int y, float *memory)
{
    const size_t plane = 3 * (size_t)p->rows * (size_t)p->width;
    const size_t at = 3 * ((size_t)(y - p->row) * (size_t)p->width + (size_t)x);
    look_place(k, memory, p->lights);
    find_lights(k, p, x, y, k->clipped);
    for (int i = 0; i < k->known; i++) {
        const float *rgb = p->samples + (size_t)p->light[i] * plane + at, *white = p->white[i];
        const float most = clipped * k->clipped[i];
        k->clipped[i] =
            rgb[0] >= most * white[0] || rgb[1] >= most * white[1] || rgb[2] >= most * white[2]
                ? 1.0f
                : 0.0f;
        for (int c = 0; c < 3; c++) {
            k->value[c][i] = p->gain * rgb[c];
            k->coded[c][i] = code_of(k->value[c][i]);
        }
    }
}

void photos_look(struct look *k, const struct photos *p, int x, int y, int worker)
{
    photos_look_into(k, p, x, y, p->memory + (size_t)worker * look_size(p->lights));
}

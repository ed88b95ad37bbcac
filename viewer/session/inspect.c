// inspect.c - the reflectance function of the pixel under the cursor, as a disc of directions
#include "session/inspect.h"

#include "app/orbit.h"
#include "format/coder/coding.h"
#include "relight/view/slab_set.h"
#include "relight/view/view.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double most_bytes = 512e6;  // of photographs in memory

// ---------------------------------------------------------------- directions of the disc

// A place on the disc, x right and y up in [-1, 1], as a direction; false outside.
static bool disc_direction(struct relume_vec3 *out, double x, double y, bool pole_y)
{
    const double up = 1 - x * x - y * y;
    if (up < 0)
        return false;
    *out = pole_y ? (struct relume_vec3){x, sqrt(up), -y} : (struct relume_vec3){x, y, sqrt(up)};
    return true;
}

// The inverse; false below the horizon.
static bool direction_place(double place[2], struct relume_vec3 d, bool pole_y)
{
    const double length = sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    place[0] = d.x / length;
    place[1] = (pole_y ? -d.z : d.y) / length;
    return (pole_y ? d.y : d.z) >= 0;
}

// In pixels of the plot; false where that does not show it.
static bool disc_place(int at[2], const struct inspector *in, struct relume_vec3 d, bool pole_y)
{
    double place[2];
    if (!direction_place(place, d, pole_y))
        return false;
    const double x = in->zoom * (place[0] - in->at[0]), y = in->zoom * (place[1] - in->at[1]);
    at[0] = relume_whole(0.5 * INSPECT_SIDE * (1 + x));
    at[1] = relume_whole(0.5 * INSPECT_SIDE * (1 - y));
    return fabs(x) <= 1 && fabs(y) <= 1;
}

// The direction in the middle of a cell of the plot; false outside the disc.
static bool cell_direction(struct relume_vec3 *out, const struct inspector *in, int cell,
                           bool pole_y)
{
    const double x = 2 * (cell % INSPECT_GRID + 0.5) / INSPECT_GRID - 1;
    const double y = 1 - 2 * (cell / INSPECT_GRID + 0.5) / INSPECT_GRID;
    return disc_direction(out, in->at[0] + x / in->zoom, in->at[1] + y / in->zoom, pole_y);
}

// ---------------------------------------------------------------- making

static void make_weights(struct inspector *in, const relume_coder *coder)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    const size_t size = 3 * (size_t)info->coefficients;
    for (int i = 0; i < INSPECT_GRID * INSPECT_GRID; i++) {
        struct relume_vec3 d;
        if (cell_direction(&d, in, i, info->pole_y)) {
            in->share[i] = (float)relume_coder_clamp(&d, coder, d);
            relume_coder_weights(coder, d, in->weights + (size_t)i * size, in->constant[i]);
        }
    }
}

static bool fits(const relume_capture *capture, const struct relume_pack_info *info)
{
    const double bytes = 12.0 * relume_capture_width(capture) * relume_capture_height(capture) *
                         relume_capture_manifest(capture)->lights;
    return relume_capture_width(capture) == info->width &&
           relume_capture_height(capture) == info->height && bytes <= most_bytes;
}

relume_status inspect_create(struct inspector *in, const struct relume_pack_info *info,
                             const struct code_source *source, const relume_slab *grid,
                             const relume_capture *capture)
{
    const relume_coder *coder = info->coder;
    const size_t size = 3 * (size_t)relume_coder_info(coder)->coefficients;
    const size_t places = (size_t)INSPECT_GRID * INSPECT_GRID;
    *in = (struct inspector){
        .info = info, .source = *source, .grid = grid, .view = -1, .measured_view = -1, .zoom = 1};
    in->capture = capture && fits(capture, info) ? capture : NULL;
    in->weights = calloc(places * size, sizeof *in->weights);
    in->constant = calloc(places, sizeof *in->constant);
    in->share = calloc(places, sizeof *in->share);
    in->coefficient = calloc(size, sizeof *in->coefficient);
    relume_status status = RELUME_ENOMEM;
    if (in->weights && in->constant && in->share && in->coefficient)
        status = relume_image_create(&in->plot, INSPECT_SIDE, INSPECT_SIDE, 3);
    if (status)
        inspect_destroy(in);
    else
        make_weights(in, coder);
    return status;
}

static void drop_codes(struct inspector *in)
{
    if (in->codes && in->source.drop)
        in->source.drop(in->source.user, in->view);
    in->codes = NULL;
}

void inspect_destroy(struct inspector *in)
{
    drop_codes(in);
    free(in->weights);
    free(in->constant);
    free(in->share);
    free(in->coefficient);
    free(in->measured);
    relume_image_destroy(&in->plot);
    *in = (struct inspector){.view = -1};
}

// ---------------------------------------------------------------- picking

static int clamp_to(double x, int n)
{
    const int i = relume_whole(x);
    return i < 0 ? 0 : i < n ? i : n - 1;
}

static bool pick_look(int pixel[2], const struct app *app, double x, double y)
{
    double xy[2];
    const struct relume_vec3 ray =
        relume_pan_tilt_ray(app->now.camera.look, app->width, app->height, x, y);
    if (!relume_panorama_pixel(xy, &app->file.geometry, app->file.width, app->file.height, ray))
        return false;
    pixel[0] = clamp_to(xy[0], app->file.width);
    pixel[1] = clamp_to(xy[1], app->file.height);
    return true;
}

static bool pick_picture(int pixel[2], const struct app *app, double x, double y)
{
    const struct app_rectangle r = app_picture(app);
    if (x < r.left || x >= r.right || y < r.top || y >= r.bottom)
        return false;
    pixel[0] = clamp_to((x - r.left) / (r.right - r.left) * app->file.width, app->file.width);
    pixel[1] = clamp_to((y - r.top) / (r.bottom - r.top) * app->file.height, app->file.height);
    return true;
}

static bool pick_camera(int *view, const struct app *app, const relume_slab *grid,
                        const int pixel[2])
{
    const struct relume_geometry *g = &app->file.geometry;
    const double s =
        g->st_min[0] + (pixel[0] + 0.5) / app->file.width * (g->st_max[0] - g->st_min[0]);
    const double t =
        g->st_max[1] - (pixel[1] + 0.5) / app->file.height * (g->st_max[1] - g->st_min[1]);
    double uv[2], weight[4];
    int views[4], best = 0;
    if (!grid || !relume_slab_uv(uv, grid, app->now.camera.eye, s, t))
        return false;
    const int n = relume_slab_blend(views, weight, grid, uv, NULL);
    for (int i = 1; i < n; i++)
        best = weight[i] > weight[best] ? i : best;
    *view = n ? views[best] : -1;
    return n > 0;
}

static bool pick_around(int *view, int pixel[2], const struct app *app, double x, double y)
{
    const struct relume_vec3 way = orbit_ray(app, x, y);
    double place[2];
    if (!relume_slab_set_nearest(view, place, app->file.around, app->now.camera.eye, way))
        return false;
    pixel[0] = clamp_to(place[0] * app->file.width, app->file.width);
    pixel[1] = clamp_to(place[1] * app->file.height, app->file.height);
    return true;
}

bool inspect_pick(int *view, int pixel[2], const struct app *app, const relume_slab *grid, double x,
                  double y)
{
    *view = app->now.camera.framing == RELUME_FRAME_VIEW ? app->now.camera.view : 0;
    if (app->now.camera.framing == RELUME_FRAME_LOOK)
        return pick_look(pixel, app, x, y);
    if (!pick_picture(pixel, app, x, y))
        return false;
    if (orbit_is(app))
        return pick_around(view, pixel, app, x, y);
    return app->now.camera.framing != RELUME_FRAME_EYE || pick_camera(view, app, grid, pixel);
}

// ---------------------------------------------------------------- one pixel

void inspect_coefficients(float *coefficient, float colour[3], const struct relume_codes *codes,
                          int x, int y)
{
    const struct relume_coder_info *info = relume_coder_info(codes->coder);
    const size_t at = (size_t)y * (size_t)codes->width + (size_t)x;
    const int k = info->coefficients;
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < k; i++)
            relume_codes_plane(codes, relume_coder_plane(info, i, c), at, 1,
                               &coefficient[c * k + i]);
        colour[c] = 1;
        if (info->luminance)
            relume_codes_plane(codes, k + c, at, 1, &colour[c]);
    }
}

void inspect_value(float rgb[3], const struct relume_codes *codes, const float *coefficient,
                   const float colour[3], const float *weights, const float constant[3])
{
    const int k = relume_coder_info(codes->coder)->coefficients;
    for (int c = 0; c < 3; c++) {
        float sum = constant[c];
        for (int i = 0; i < k; i++)
            sum += weights[c * k + i] * coefficient[c * k + i];
        rgb[c] = sum * colour[c];
        if (codes->domain == RELUME_DOMAIN_DISPLAY)
            rgb[c] = relume_transfer_decode(codes->display, rgb[c]);
    }
}

// ---------------------------------------------------------------- plot

static float *plot_pixel(struct inspector *in, int x, int y)
{
    return in->plot.data + 3 * ((size_t)y * INSPECT_SIDE + (size_t)x);
}

static void fill_cell(struct inspector *in, int cell, const float rgb[3])
{
    const int side = INSPECT_SIDE / INSPECT_GRID;
    for (int j = 0; j < side; j++)
        for (int i = 0; i < side; i++)
            memcpy(plot_pixel(in, cell % INSPECT_GRID * side + i, cell / INSPECT_GRID * side + j),
                   rgb, 3 * sizeof *rgb);
}

static void fill_disc(struct inspector *in, const struct app *app, const struct relume_codes *codes)
{
    static const float outside[3] = {0.09f, 0.09f, 0.1f};
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    const size_t size = 3 * (size_t)relume_coder_info(codes->coder)->coefficients;
    const float gain = exp2f((float)app_exposure_ev(app));
    float colour[3];
    inspect_coefficients(in->coefficient, colour, codes, in->x, in->y);
    for (int i = 0; i < INSPECT_GRID * INSPECT_GRID; i++) {
        struct relume_vec3 ignored;
        float rgb[3];
        if (!cell_direction(&ignored, in, i, false)) {
            fill_cell(in, i, outside);
            continue;
        }
        inspect_value(rgb, codes, in->coefficient, colour, in->weights + (size_t)i * size,
                      in->constant[i]);
        for (int c = 0; c < 3; c++)
            rgb[c] *= in->share[i];
        for (int c = 0; c < 3; c++)
            rgb[c] = fminf(fmaxf(relume_transfer_encode(srgb, gain * rgb[c]), 0), 1);
        fill_cell(in, i, rgb);
    }
}

// Arms of `reach` pixels: a dot, or a cross with 3.
static void mark(struct inspector *in, struct relume_vec3 d, bool pole_y, int reach,
                 const float rgb[3])
{
    int at[2];
    if (!disc_place(at, in, d, pole_y))
        return;
    for (int k = -reach; k <= reach; k++) {
        memcpy(plot_pixel(in, clamp_to(at[0] + k, INSPECT_SIDE), clamp_to(at[1], INSPECT_SIDE)),
               rgb, 3 * sizeof *rgb);
        memcpy(plot_pixel(in, clamp_to(at[0], INSPECT_SIDE), clamp_to(at[1] + k, INSPECT_SIDE)),
               rgb, 3 * sizeof *rgb);
    }
}

static void mark_directions(struct inspector *in, const struct app *app,
                            const struct relume_coder_info *info)
{
    static const float dot[3] = {0.2f, 0.9f, 0.9f};
    static const float cross[3] = {1, 0.85f, 0.2f};
    for (int i = 0; !in->capture && i < info->lights; i++)
        mark(in, info->directions[i], info->pole_y, 0, dot);
    for (int i = 0; i < app->now.lights; i++)
        if (app->now.light[i].kind == RELUME_LIGHT_DIRECTIONAL)
            mark(in, app->now.light[i].direction, info->pole_y, 3, cross);
}

// ---------------------------------------------------------------- photographs

static int view_in_capture(const struct inspector *in, int view)
{
    const struct relume_pack_info *info = in->info;
    const struct relume_manifest *m = relume_capture_manifest(in->capture);
    int best = 0;
    double least = INFINITY;
    for (int i = 0; info->uv && i < m->views; i++) {
        const double far =
            hypot(m->view[i].uv[0] - info->uv[view][0], m->view[i].uv[1] - info->uv[view][1]);
        if (info->slabs && m->view[i].slab != info->slab_of[view])
            continue;
        best = far < least ? i : best;
        least = fmin(far, least);
    }
    return best;
}

static relume_status read_photographs(struct inspector *in, int view)
{
    const struct relume_manifest *m = relume_capture_manifest(in->capture);
    const size_t size =
        3 * (size_t)relume_capture_width(in->capture) * (size_t)relume_capture_height(in->capture);
    if (!in->measured)
        in->measured = malloc((size_t)m->lights * size * sizeof *in->measured);
    relume_status status = in->measured ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < m->lights; i++) {
        struct relume_image image;
        status = relume_capture_image(&image, in->capture, view_in_capture(in, view), i, NULL);
        if (!status)
            memcpy(in->measured + (size_t)i * size, image.data, size * sizeof *image.data);
        relume_image_destroy(&image);
    }
    in->measured_view = status ? -1 : view;
    return status;
}

// A filled square in a dark frame.
static void mark_measured(struct inspector *in, const int at[2], const float rgb[3])
{
    static const float frame[3] = {0.05f, 0.05f, 0.05f};
    for (int j = -2; j <= 2; j++)
        for (int i = -2; i <= 2; i++)
            memcpy(plot_pixel(in, clamp_to(at[0] + i, INSPECT_SIDE),
                              clamp_to(at[1] + j, INSPECT_SIDE)),
                   abs(i) == 2 || abs(j) == 2 ? frame : rgb, 3 * sizeof *rgb);
}

static void mark_photographs(struct inspector *in, const struct app *app, bool pole_y)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    const struct relume_manifest *m = relume_capture_manifest(in->capture);
    const size_t width = (size_t)relume_capture_width(in->capture);
    const size_t height = (size_t)relume_capture_height(in->capture);
    const float gain = exp2f((float)app_exposure_ev(app));
    for (int i = 0; i < m->lights; i++) {
        const float *pixel =
            in->measured + 3 * (((size_t)i * height + (size_t)in->y) * width + (size_t)in->x);
        float rgb[3];
        int at[2];
        for (int c = 0; c < 3; c++)
            rgb[c] = fminf(fmaxf(relume_transfer_encode(srgb, gain * pixel[c]), 0), 1);
        if (disc_place(at, in, m->directions[i], pole_y))
            mark_measured(in, at, rgb);
    }
}

static relume_status hold_codes(struct inspector *in, int view)
{
    if (in->codes && in->view == view)
        return RELUME_OK;
    drop_codes(in);
    in->view = view;
    const relume_status status = in->source.codes(&in->codes, in->source.user, view);
    if (status)
        in->codes = NULL;
    return status;
}

// Around the selected light where that is distant and above the horizon, else around the middle;
// all of the plot lies within the disc's square.
static void magnify(struct inspector *in, const struct app *app)
{
    const bool pole_y = relume_coder_info(in->info->coder)->pole_y;
    const struct relume_light *light = &app->now.light[app->now.selected];
    const double zoom = app->inspect_zoom > 1 ? app->inspect_zoom : 1, most = 1 - 1 / zoom;
    if (zoom == in->zoom)
        return;
    in->zoom = zoom;
    if (light->kind != RELUME_LIGHT_DIRECTIONAL ||
        !direction_place(in->at, light->direction, pole_y))
        in->at[0] = in->at[1] = 0;
    for (int i = 0; i < 2; i++)
        in->at[i] = fmin(fmax(in->at[i], -most), most);
    make_weights(in, in->info->coder);
}

relume_status inspect_update(struct inspector *in, const struct app *app, bool *shown)
{
    int view, pixel[2];
    *shown = inspect_pick(&view, pixel, app, in->grid, app->cursor[0], app->cursor[1]);
    if (!*shown)
        return RELUME_OK;
    relume_status status = hold_codes(in, view);
    if (!status && in->capture && in->measured_view != view)
        status = read_photographs(in, view);
    if (status)
        return status;
    in->x = pixel[0];
    in->y = pixel[1];
    magnify(in, app);
    fill_disc(in, app, in->codes);
    if (in->capture)
        mark_photographs(in, app, relume_coder_info(in->codes->coder)->pole_y);
    mark_directions(in, app, relume_coder_info(in->codes->coder));
    const int n = snprintf(in->text, sizeof in->text, "view %d, pixel %d, %d", view, in->x, in->y);
    if (in->zoom > 1)
        snprintf(in->text + n, sizeof in->text - (size_t)n, ", x %g", in->zoom);
    return RELUME_OK;
}

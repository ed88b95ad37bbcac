// frame.c - what a camera sees of the views: whole, scaled, looked at, from an eye
#include "core/base/log.h"
#include "core/base/params.h"
#include "core/base/thread.h"
#include "image/image/rgba8.h"
#include "relight/frame/relighter.h"
#include "relight/frame/renderer.h"
#include "relight/frame/renderer_views.h"

#include <string.h>

// Positions have no mean: the nearest texel's.
struct relume_scale_params frame_scaling(const relume_renderer *r)
{
    const struct relume_geometry *g = &r->info->geometry;
    const bool round = g->projection == RELUME_CYLINDRICAL || g->projection == RELUME_SPHERICAL;
    return (struct relume_scale_params){.struct_size = sizeof(struct relume_scale_params),
                                        .threads = r->params.threads,
                                        .filter = r->shown == SHOWN_PLACES ? RELUME_FILTER_NEAREST
                                                                           : r->params.filter,
                                        .wrap = round && !g->disc,
                                        .tiles = g->projection == RELUME_CUBE ? 6 : 1};
}

static relume_status scale_view(const relume_renderer *r, const struct relume_camera *camera,
                                const struct relume_image *view, struct relume_image *out)
{
    const struct relume_scale_params params = frame_scaling(r);
    return relume_image_scale(out, view, camera->width, camera->height, &params);
}

static relume_status check_view(const relume_renderer *r, const struct relume_camera *camera)
{
    if (camera->view >= 0 && camera->view < r->info->views)
        return RELUME_OK;
    return log_fail(r->params.log, RELUME_EINVAL, "view %d does not exist; expected 0 to %d",
                    camera->view, r->info->views - 1);
}

static bool is_whole_view(const relume_renderer *r, const struct relume_camera *camera)
{
    const bool slab = r->info->geometry.projection == RELUME_SLAB;
    const bool view =
        camera->framing == RELUME_FRAME_VIEW || (camera->framing == RELUME_FRAME_DEFAULT && !slab);
    return view && camera->width == r->info->width && camera->height == r->info->height;
}

static relume_status render_view(relume_renderer *r, const struct relume_camera *camera,
                                 struct relume_image *out)
{
    if (check_view(r, camera))
        return RELUME_EINVAL;
    const struct relume_image *view = &r->image[r->shown][camera->view];
    const bool whole = is_whole_view(r, camera);
    if (whole && r->shown == SHOWN_LIGHT)
        return frame_bands_suit(r) ? frame_bands(out, r, camera->view)
                                   : renderer_relight(r, camera->view, out);
    const struct relume_rect all = {0, 0, r->info->width, r->info->height};
    if (frame_detail_suits(r, &all, camera->width, camera->height))
        return frame_detail(out, r, camera->view, &all, camera->width, camera->height);
    const relume_status status = renderer_need(r, camera->view);
    if (status || !whole)
        return status ? status : scale_view(r, camera, view, out);
    const relume_status made = relume_image_create(out, view->width, view->height, 3);
    if (!made)
        memcpy(out->data, view->data,
               3 * (size_t)view->width * (size_t)view->height * sizeof *out->data);
    return made;
}

static relume_status render_look(relume_renderer *r, const struct relume_camera *camera,
                                 struct relume_image *out)
{
    if (r->info->geometry.projection < RELUME_CYLINDRICAL)
        return log_fail(r->params.log, RELUME_EINVAL,
                        "pan, tilt and zoom need a panorama; this file is %s",
                        relume_projection_name(r->info->geometry.projection));
    relume_status status = check_view(r, camera);
    if (!status)
        status = renderer_need(r, camera->view);
    if (!status)
        status = relume_image_create(out, camera->width, camera->height, 3);
    return status
               ? status
               : relume_panorama_frame(out, &r->info->geometry, &r->image[r->shown][camera->view],
                                       camera->look, &r->view);
}

static relume_status check_size(const relume_renderer *r, const int frame[2])
{
    if (frame[0] >= 1 && frame[1] >= 1 && (int64_t)frame[0] * frame[1] <= 1 << 30)
        return RELUME_OK;
    return log_fail(r->params.log, RELUME_EINVAL,
                    "a picture of %d x %d pixels is too large; expected at most 2^30", frame[0],
                    frame[1]);
}

static relume_status render(relume_renderer *r, const struct relume_camera *camera,
                            struct relume_image *out)
{
    switch (camera->framing) {
    case RELUME_FRAME_DEFAULT:
        return r->info->geometry.projection == RELUME_SLAB ? frame_eye(r, camera, out)
                                                           : render_view(r, camera, out);
    case RELUME_FRAME_VIEW: return render_view(r, camera, out);
    case RELUME_FRAME_EYE: return frame_eye(r, camera, out);
    case RELUME_FRAME_LOOK: return render_look(r, camera, out);
    }
    return RELUME_EINVAL;
}

// The picture alone, without what lies beside it; `place` says where it belongs in `frame`.
static relume_status draw_picture(struct relume_image *out, struct relume_rect *place, int frame[2],
                                  relume_renderer *r, const struct relume_camera *camera,
                                  enum shown shown)
{
    struct relume_camera within = *camera;
    *out = (struct relume_image){0};
    *place = relume_camera_rect(frame, r->info, camera);
    within.width = place->width;
    within.height = place->height;
    relume_status status = check_size(r, frame);
    renderer_begin(r, shown);
    if (!status)
        status = render(r, &within, out);
    if (status)
        relume_image_destroy(out);
    if (!status && shown == SHOWN_LIGHT && (place->width < frame[0] || place->height < frame[1]))
        renderer_note(
            r, NOTE_BORDERS,
            "the picture does not have the proportions %d x %d: it fills %d x %d, with black "
            "borders; give the width alone to avoid them",
            frame[0], frame[1], place->width, place->height);
    return status;
}

// ---------------------------------------------------------------- frames

static relume_status draw_frame(struct relume_image *out, relume_renderer *r,
                                const struct relume_camera *camera, enum shown shown)
{
    struct relume_rect place;
    struct relume_image picture;
    int frame[2];
    relume_status status = draw_picture(&picture, &place, frame, r, camera, shown);
    *out = picture;
    if (status || (place.width == frame[0] && place.height == frame[1]))
        return status;
    status = relume_image_create(out, frame[0], frame[1], 3);
    const size_t row = 3 * (size_t)frame[0], samples = row * (size_t)frame[1];
    for (size_t i = 0; !status && shown == SHOWN_PLACES && i < samples; i++)
        out->data[i] = r->view.nothing;
    for (int y = 0; !status && y < place.height; y++)
        memcpy(out->data + row * (size_t)(place.top + y) + 3 * (size_t)place.left,
               picture.data + 3 * (size_t)place.width * (size_t)y,
               3 * (size_t)place.width * sizeof *out->data);
    relume_image_destroy(&picture);
    return status;
}

relume_status renderer_bare_frame(struct relume_image *out, relume_renderer *r,
                                  const struct relume_camera *camera)
{
    return draw_frame(out, r, camera, SHOWN_LIGHT);
}

relume_status relume_renderer_frame(struct relume_image *out, relume_renderer *r,
                                    const struct relume_camera *camera)
{
    return (r->draw_over ? r->draw_over : renderer_bare_frame)(out, r, camera);
}

relume_status relume_renderer_places(struct relume_image *out, relume_renderer *r,
                                     const struct relume_camera *camera)
{
    return draw_frame(out, r, camera, SHOWN_PLACES);
}

// Blackens pixels of a captured view outside of its mask, where nothing is known of them.
static relume_status blacken_masked(struct relume_image *frame, const relume_renderer *r,
                                    const struct relume_camera *camera)
{
    struct relume_camera sized = *camera;
    struct relume_image mask;
    sized.width = frame->width;
    sized.height = frame->height;
    if (!is_whole_view(r, &sized))
        return RELUME_OK;
    const relume_status status = relume_pack_mask(&mask, r->pack, camera->view);
    const size_t pixels = (size_t)frame->width * (size_t)frame->height;
    for (size_t i = 0; !status && mask.data && i < 3 * pixels; i++)
        frame->data[i] *= mask.data[i / 3] > 0.5f ? 1.0f : 0.0f;
    relume_image_destroy(&mask);
    return status;
}

relume_status relume_frame(struct relume_image *out, relume_pack *pack,
                           const struct relume_camera *camera, const struct relume_light *lights,
                           int n, const struct relume_frame_params *params)
{
    struct relume_frame_params once = PARAMS(relume_frame_params, params);
    relume_renderer *r;
    *out = (struct relume_image){0};
    once.struct_size = sizeof once;
    once.once = true;
    relume_status status = relume_renderer_create(&r, pack, &once);
    if (!status)
        status = relume_renderer_set_lights(r, lights, n);
    if (!status)
        status = relume_renderer_frame(out, r, camera);
    if (!status && once.masked)
        status = blacken_masked(out, r, camera);
    relume_renderer_destroy(&r);
    return status;
}

// ---------------------------------------------------------------- targets

static size_t pixel_bytes(enum relume_target_format format)
{
    return format == RELUME_TARGET_RGB    ? 3 * sizeof(float)
           : format == RELUME_TARGET_RGBA ? 4 * sizeof(float)
                                          : 4;
}

static ptrdiff_t stride_of(const struct relume_target *t)
{
    return t->stride ? t->stride : (ptrdiff_t)((size_t)t->width * pixel_bytes(t->format));
}

static bool is_packed(const struct relume_target *t)
{
    return stride_of(t) == (ptrdiff_t)((size_t)t->width * pixel_bytes(t->format));
}

// A whole view without a pass, from the codes into memory without gaps.
static relume_status draw_straight(relume_renderer *r, const struct relume_camera *camera,
                                   const struct relume_target *t)
{
    struct relume_relit relit;
    struct relume_image image = {t->width, t->height, 3, .data = t->data};
    renderer_begin(r, SHOWN_LIGHT);
    relume_status status = check_view(r, camera);
    if (!status)
        status = renderer_relit(&relit, r, camera->view);
    if (status)
        return status;
    status = t->format == RELUME_TARGET_RGB
                 ? relume_relighter_relight(&image, r->relighter, &relit)
                 : relume_relighter_rgba8(t->data, r->relighter, &relit, (double)t->exposure_ev);
    r->said |= !status;
    return status;
}

struct putting {
    const struct relume_target *target;
    const struct relume_image *picture;
    struct relume_rect place;
    struct byte_coder coder;
};

static void put_row(void *context, size_t y, int worker)
{
    (void)worker;
    const struct putting *p = context;
    const struct relume_target *t = p->target;
    const size_t pixel = pixel_bytes(t->format), n = (size_t)p->place.width;
    const ptrdiff_t in = (ptrdiff_t)y - p->place.top;
    char *row = (char *)t->data + (ptrdiff_t)y * stride_of(t);
    memset(row, 0, (size_t)t->width * pixel);
    if (in < 0 || in >= p->place.height)
        return;
    const float *from = p->picture->data + 3 * n * (size_t)in;
    void *to = row + pixel * (size_t)p->place.left;
    float *rgba = to;
    if (t->format == RELUME_TARGET_RGB)
        memcpy(to, from, n * pixel);
    if (t->format == RELUME_TARGET_RGBA8)
        byte_code(to, from, n, &p->coder);
    for (size_t x = 0; t->format == RELUME_TARGET_RGBA && x < n; x++) {
        memcpy(rgba + 4 * x, from + 3 * x, 3 * sizeof *rgba);
        rgba[4 * x + 3] = 1.0f;
    }
}

relume_status relume_renderer_draw(relume_renderer *r, const struct relume_camera *camera,
                                   const struct relume_target *target)
{
    struct relume_camera sized = *camera;
    struct relume_image picture;
    struct putting putting = {
        .target = target, .picture = &picture, .place = {0, 0, target->width, target->height}};
    int frame[2];
    if (!target->data || target->width < 1 || target->height < 1)
        return log_fail(r->params.log, RELUME_EINVAL, "the target has no memory or no size");
    sized.width = target->width;
    sized.height = target->height;
    if (is_whole_view(r, &sized) && r->params.pass == RELUME_PASS_COLOUR && is_packed(target) &&
        !r->draw_over && target->format != RELUME_TARGET_RGBA)
        return draw_straight(r, &sized, target);
    const relume_status status =
        r->draw_over ? r->draw_over(&picture, r, &sized)
                     : draw_picture(&picture, &putting.place, frame, r, &sized, SHOWN_LIGHT);
    if (status)
        return status;
    byte_coder_init(&putting.coder, exp2f(target->exposure_ev));
    thread_for(r->params.threads, (size_t)target->height, put_row, &putting);
    relume_image_destroy(&picture);
    return RELUME_OK;
}

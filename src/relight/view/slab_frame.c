// slab_frame.c - a frame of a light slab: the quadralinear basis, four cameras times four texels
//
// A pixel fixes (s, t); its ray crosses the uv plane in (u, v). Since u depends on s alone and v on
// t alone, every weight of a frame is the product of one factor per column and one per row. A pixel
// that covers several texels is the mean of several such rays (footprint.h). Frames by depth and
// through an aperture are in slab_depth.c and slab_lens.c.
#include "relight/view/slab.h"

#include "core/base/memory.h"
#include "core/base/thread.h"
#include "core/math/bilinear.h"
#include "relight/view/view.h"

// One factor of a ray's weights: up to two camera lines times up to two texels of the view.
struct taps {
    int count;
    int line[4];
    int texel[4];
    float weight[4];
};

// Place `x` of `pixels` lies there between the texel centres of a view of `texels`; a frame of the
// view's own size hits them exactly.
static struct neighbours texel_neighbours(double x, int pixels, int texels)
{
    const double at = 2.0 * x * texels / (2.0 * pixels) - 0.5;
    if (at <= 0.0)
        return one_neighbour(0);
    if (at >= texels - 1)
        return one_neighbour(texels - 1);
    const int low = relume_whole(at);
    if (at == low)
        return one_neighbour(low);
    return (struct neighbours){2, {low, low + 1}, {1.0 - (at - low), at - low}};
}

static struct taps combine(struct neighbours lines, struct neighbours texels)
{
    struct taps taps = {0};
    for (int i = 0; i < lines.count; i++)
        for (int k = 0; k < texels.count; k++) {
            const int n = taps.count++;
            taps.line[n] = lines.index[i];
            taps.texel[n] = texels.index[k];
            taps.weight[n] = (float)(lines.weight[i] * texels.weight[k]);
        }
    return taps;
}

struct frame {
    const struct slab_frame *of;
    struct footprint wide, high;  // of a pixel
    struct taps *across;          // [width][wide.count]
    struct taps *down;            // [height][high.count]
};

static const float *texel(const struct slab_frame *f, const struct taps *across, int i,
                          const struct taps *down, int j)
{
    const int columns = f->slab->columns;
    const int view =
        f->slab->view[(size_t)down->line[j] * (size_t)columns + (size_t)across->line[i]];
    const struct relume_image *image = &f->views[view];
    const struct relume_rect part = slab_part(f, view);
    const int x = index_clamped(across->texel[i] - part.left, image->width);
    const int y = index_clamped(down->texel[j] - part.top, image->height);
    return image->data + 3 * ((size_t)y * (size_t)image->width + (size_t)x);
}

static void add_ray(float *rgb, const struct slab_frame *f, const struct taps *across,
                    const struct taps *down)
{
    for (int j = 0; j < down->count; j++)
        for (int i = 0; i < across->count; i++) {
            const float w = down->weight[j] * across->weight[i];
            const float *from = texel(f, across, i, down, j);
            for (int c = 0; c < 3; c++)
                rgb[c] += w * from[c];
        }
}

static void draw_pixel(float *rgb, const struct frame *f, const struct taps *across,
                       const struct taps *down)
{
    // -0 + x is x for every x, 0 included: a single texel of weight 1 arrives bit by bit.
    rgb[0] = rgb[1] = rgb[2] = -0.0f;
    for (int j = 0; j < f->high.count; j++)
        for (int i = 0; i < f->wide.count; i++)
            add_ray(rgb, f->of, &across[i], &down[j]);
}

static void draw_row(void *context, size_t row, int worker)
{
    const struct frame *f = context;
    (void)worker;
    const struct relume_image *out = f->of->out;
    const struct taps *down = &f->down[row * (size_t)f->high.count];
    float *rgb = out->data + 3 * row * (size_t)out->width;
    for (int x = 0; x < out->width; x++, rgb += 3)
        draw_pixel(rgb, f, &f->across[(size_t)x * (size_t)f->wide.count], down);
}

static struct taps share(struct taps taps, int rays)
{
    for (int i = 0; rays > 1 && i < taps.count; i++)
        taps.weight[i] /= (float)rays;
    return taps;
}

// Column c looks at s = st_min + (c+.5)/W * extent; row 0 is at the top, where t is largest.
static void prepare_taps(struct frame *frame, bool constant)
{
    const struct slab_frame *f = frame->of;
    const relume_slab *slab = f->slab;
    const int across = frame->wide.count, down = frame->high.count;
    for (int i = 0; i < f->out->width * across; i++) {
        const double x = i / across + 0.5 + footprint_place(frame->wide, i % across);
        const double u = slab_hit(f->eye.x, slab_s(f, x), f->reach);
        frame->across[i] =
            share(combine(slab_columns_at(slab, constant, slab_nearest(slab->u, slab->columns, u)),
                          texel_neighbours(x, f->out->width, f->width)),
                  across);
    }
    for (int i = 0; i < f->out->height * down; i++) {
        const double y = i / down + 0.5 + footprint_place(frame->high, i % down);
        const double v = slab_hit(f->eye.y, slab_t(f, y), f->reach);
        frame->down[i] =
            share(combine(slab_rows_at(slab, constant, slab_nearest(slab->v, slab->rows, v)),
                          texel_neighbours(y, f->out->height, f->height)),
                  down);
    }
}

static relume_status draw_linear(const struct slab_frame *f, bool constant)
{
    struct frame frame = {
        .of = f,
        .wide = slab_footprint(&f->params, (double)f->width / f->out->width),
        .high = slab_footprint(&f->params, (double)f->height / f->out->height),
    };
    frame.across =
        mem_array((size_t)f->out->width * (size_t)frame.wide.count, sizeof *frame.across);
    frame.down = mem_array((size_t)f->out->height * (size_t)frame.high.count, sizeof *frame.down);
    const relume_status status = frame.across && frame.down ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        prepare_taps(&frame, constant);
        thread_for(f->params.threads, (size_t)f->out->height, draw_row, &frame);
    }
    mem_free(frame.across);
    mem_free(frame.down);
    return status;
}

// ---------------------------------------------------------------- public

// Whether an eye stands at a camera: its view is the frame, whatever the depth.
static bool is_camera(const struct slab_frame *f)
{
    return f->reach == 0.0 && slab_columns_at(f->slab, false, f->eye.x).count == 1 &&
           slab_rows_at(f->slab, false, f->eye.y).count == 1;
}

static relume_status draw(const struct slab_frame *f)
{
    const struct relume_view_params *p = &f->params;
    if (slab_is_lens(p))
        return p->part ? RELUME_EINVAL : slab_frame_lens(f);
    switch (p->interpolation) {
    case RELUME_INTERPOLATE_CONSTANT: return draw_linear(f, true);
    case RELUME_INTERPOLATE_LINEAR: return draw_linear(f, false);
    case RELUME_INTERPOLATE_DEFAULT:
    case RELUME_INTERPOLATE_DEPTH: break;
    }
    if (!p->disparity && p->interpolation == RELUME_INTERPOLATE_DEPTH)
        return RELUME_EINVAL;
    return p->disparity && !is_camera(f) ? slab_frame_depth(f) : draw_linear(f, false);
}

static bool is_image(const struct relume_image *image, int width, int height, int channels)
{
    return image->data && image->channels == channels && image->width == width &&
           image->height == height;
}

static bool lies_within(struct relume_rect part, int width, int height)
{
    return part.left >= 0 && part.top >= 0 && part.width <= width - part.left &&
           part.height <= height - part.top;
}

bool slab_views_fit(struct slab_frame *f, const struct relume_image *disparity)
{
    if (f->params.part) {
        f->width = f->params.size[0];
        f->height = f->params.size[1];
    }
    for (int i = 0; i < f->slab->views; i++) {
        if (!f->needed[i])
            continue;
        if (f->width == 0) {
            f->width = f->views[i].width;
            f->height = f->views[i].height;
        }
        const struct relume_rect part = slab_part(f, i);
        if (f->params.part && part.width == 0)
            continue;
        if (!lies_within(part, f->width, f->height) ||
            !is_image(&f->views[i], part.width, part.height, 3) ||
            (disparity && !is_image(&disparity[i], part.width, part.height, 1)))
            return false;
    }
    return f->width > 0;
}

relume_status relume_slab_frame(struct relume_image *out, const relume_slab *slab,
                                struct relume_vec3 eye, const struct relume_image *views,
                                const struct relume_view_params *params)
{
    struct slab_frame frame = {.slab = slab, .out = out, .views = views, .eye = eye};
    if (params)
        frame.params = *params;
    if (!out->data || out->channels != 3 || !slab_reach(&frame.reach, slab, eye))
        return RELUME_EINVAL;
    bool *needed = mem_zeroed((size_t)slab->views, sizeof *needed);
    if (!needed)
        return RELUME_ENOMEM;
    relume_status status = RELUME_EINVAL;
    frame.needed = needed;
    if (relume_slab_needs(needed, slab, eye, params) && slab_views_fit(&frame, NULL))
        status = draw(&frame);
    mem_free(needed);
    return status;
}

relume_status relume_slab_value(float rgb[3], const relume_slab *slab, struct relume_vec3 eye,
                                const double st[2], const struct relume_image *views,
                                const struct relume_view_params *params)
{
    struct slab_frame frame = {.slab = slab, .views = views, .eye = eye};
    double uv[2], weight[4];
    int around[4];
    if (!params || !params->disparity || !slab_reach(&frame.reach, slab, eye) ||
        !relume_slab_uv(uv, slab, eye, st[0], st[1]))
        return RELUME_EINVAL;
    bool *needed = mem_zeroed((size_t)slab->views, sizeof *needed);
    if (!needed)
        return RELUME_ENOMEM;
    const int count = relume_slab_blend(around, weight, slab, uv, NULL);
    for (int i = 0; i < count; i++)
        needed[around[i]] = true;
    relume_status status = RELUME_EINVAL;
    frame.params = *params;
    frame.needed = needed;
    if (slab_views_fit(&frame, NULL))
        status = slab_value_depth(rgb, &frame, st);
    mem_free(needed);
    return status;
}

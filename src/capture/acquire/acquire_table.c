// acquire_table.c - mirror balls that stand on a table are outlined by what they show of it
#include "capture/acquire/acquire.h"

#include "capture/acquire/ball.h"

enum { PHOTOS = 6, LARGEST = 100 };  // photographs; radius in them, pixels
static const double FAINT = 2e-4;    // about one code of 8 bits in the dark

// Light in boxes of `step` pixels.
static relume_status shrink(struct relume_image *out, const struct relume_image *image, int step)
{
    const int w = image->width / step, h = image->height / step;
    const relume_status status = relume_image_create(out, w, h, 1);
    for (int y = 0; !status && y < h; y++)
        for (int x = 0; x < w; x++) {
            float sum = 0.0f;
            for (int k = 0; k < step * step; k++)
                sum += ball_grey(image, x * step + k % step, y * step + k / step);
            out->data[(size_t)y * (size_t)w + (size_t)x] = fmaxf(sum / (float)(step * step), 0.0f);
        }
    return status;
}

// Light v to v / (v + middle): the logarithm around the middle, bounded, so that neither lamps nor
// noise in the dark weigh more than a shadow does.
static void compress(struct relume_image *image)
{
    const size_t n = (size_t)image->width * (size_t)image->height;
    double sum = 0.0;
    for (size_t i = 0; i < n; i++)
        sum += log((double)image->data[i] + FAINT);
    const float middle = (float)exp(sum / (double)n);
    for (size_t i = 0; i < n; i++)
        image->data[i] /= image->data[i] + middle;
}

static relume_status load_photos(struct relume_image *out, const struct acquisition *s, int photos,
                                 int step)
{
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < photos; i++) {
        struct relume_image image;
        status = acquire_load_balls(&image, s, i * s->shots / photos);
        if (!status)
            status = shrink(&out[i], &image, step);
        if (!status)
            compress(&out[i]);
        relume_image_destroy(&image);
    }
    return status;
}

// The outline in a picture smaller by `step`, and back.
static struct relume_ball scaled(struct relume_ball ball, double by)
{
    ball.x *= by;
    ball.y *= by;
    ball.radius *= by;
    ball.sigma *= by;
    return ball;
}

relume_status acquire_seek_tables(struct acquisition *s)
{
    struct relume_image photo[PHOTOS] = {{0}};
    const int photos = s->shots < PHOTOS ? s->shots : PHOTOS;
    double largest = LARGEST;
    for (int b = 0; b < s->out->balls; b++)
        largest = fmax(largest, s->out->ball[b].radius);
    const int step = relume_whole(largest / LARGEST);
    const struct relume_ball_camera camera = {s->camera.width / step, s->camera.height / step,
                                              s->camera.focal_px / step};
    relume_status status = load_photos(photo, s, photos, step);
    for (int b = 0; !status && b < s->out->balls; b++) {
        struct relume_ball ball = scaled(s->out->ball[b], 1.0 / step);
        bool is;
        status = ball_on_table(&ball, &is, &camera, photo, photos);
        if (!status && is)
            s->out->ball[b] = scaled(ball, step);
    }
    for (int i = 0; i < photos; i++)
        relume_image_destroy(&photo[i]);
    return status;
}

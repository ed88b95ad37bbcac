// smooth.c - means of neighbouring pixels that show one surface
#include "core/base/memory.h"
#include "core/base/thread.h"
#include "shape/mesh/places.h"
#include "world/transport/transport.h"

struct smoothing {
    const struct relume_image *from, *places, *normals;
    struct relume_image *to;
    vec3 eye;
    int size;
};

bool transport_same(vec3 place, vec3 normal, vec3 other, vec3 other_normal, double distance)
{
    const double FACING = 0.9, PLANE = 0.02;
    const vec3 step = vec3_sub(other, place);
    return vec3_dot(normal, other_normal) > FACING &&
           fabs(vec3_dot(step, normal)) < PLANE * distance;
}

static void smooth_row(void *context, size_t row, int worker)
{
    (void)worker;
    const struct smoothing *s = context;
    const int width = s->from->width, height = s->from->height, before = s->size / 2;
    const int y = (int)row;
    for (int x = 0; x < width; x++) {
        const size_t at = 3 * (row * (size_t)width + (size_t)x);
        const vec3 place = places_at_xy(s->places, x, y), normal = places_at_xy(s->normals, x, y);
        const double distance = vec3_length(vec3_sub(place, s->eye));
        double sum[3] = {0.0, 0.0, 0.0};
        int n = 0;
        for (int j = y - before; j < y - before + s->size; j++)
            for (int i = x - before; i < x - before + s->size; i++) {
                if (i < 0 || j < 0 || i >= width || j >= height ||
                    !transport_same(place, normal, places_at_xy(s->places, i, j),
                                    places_at_xy(s->normals, i, j), distance))
                    continue;
                const float *v = s->from->data + 3 * ((size_t)j * (size_t)width + (size_t)i);
                for (int c = 0; c < 3; c++)
                    sum[c] += (double)v[c];
                n++;
            }
        for (size_t c = 0; c < 3; c++)
            s->to->data[at + c] = n ? (float)(sum[c] / n) : s->from->data[at + c];
    }
}

relume_status transport_smooth(struct relume_image *const *images, int count,
                               const struct relume_image *places,
                               const struct relume_image *normals, vec3 eye, int size, int threads)
{
    relume_status status = RELUME_OK;
    for (int k = 0; k < count && size > 1 && !status; k++) {
        struct relume_image to;
        status = relume_image_create(&to, places->width, places->height, 3);
        struct smoothing s = {images[k], places, normals, &to, eye, size};
        if (status)
            break;
        thread_for(threads, (size_t)places->height, smooth_row, &s);
        relume_image_destroy(images[k]);
        *images[k] = to;
    }
    return status;
}

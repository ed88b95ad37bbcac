// between.c - pixels between those that have gathered light
#include "world/transport/transport.h"

#include "shape/mesh/places.h"

bool transport_gathers(int spacing, int x, int y)
{
    return x % spacing == spacing / 2 && y % spacing == spacing / 2;
}

void transport_between(struct between_pixels *out, int spacing, int x, int y,
                       const struct relume_image *places, const struct relume_image *normals,
                       vec3 eye)
{
    const double TOO_FEW = 0.05;
    const size_t width = (size_t)places->width, at = (size_t)y * width + (size_t)x;
    const vec3 place = places_at(places, at), normal = places_at(normals, at);
    const double distance = vec3_length(vec3_sub(place, eye));
    // of the one to the upper left
    const int left = (x + spacing - spacing / 2) / spacing * spacing + spacing / 2 - spacing;
    const int top = (y + spacing - spacing / 2) / spacing * spacing + spacing / 2 - spacing;
    double sum = 0.0;
    out->count = 0;
    for (int i = 0; i < 4; i++) {
        const int u = left + (i & 1) * spacing, v = top + (i >> 1) * spacing;
        const double weight =
            (1.0 - fabs((double)(u - x)) / spacing) * (1.0 - fabs((double)(v - y)) / spacing);
        if (u < 0 || v < 0 || u >= places->width || v >= places->height || !(weight > 0.0))
            continue;
        const size_t pixel = (size_t)v * width + (size_t)u;
        if (!transport_same(place, normal, places_at(places, pixel), places_at(normals, pixel),
                            distance))
            continue;
        out->pixel[out->count] = pixel;
        out->weight[out->count++] = weight;
        sum += weight;
    }
    if (sum < TOO_FEW)
        out->count = 0;
    for (int i = 0; i < out->count; i++)
        out->weight[i] /= sum;
}

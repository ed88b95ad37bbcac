// measure.c - lengths, areas, angles, and the surface along a line
#include "exchange/notes/list.h"

#include "core/base/memory.h"

#include <math.h>

// Of a place on an object the third coordinate too.
static void place_of(double out[3], const struct relume_note *note, int i)
{
    out[0] = note->place[i][0];
    out[1] = note->place[i][1];
    out[2] = note->z ? note->z[i] : 0.0;
}

static void minus(double out[3], const double a[3], const double b[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = a[c] - b[c];
}

static void cross(double out[3], const double a[3], const double b[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
}

static double length_of(const double a[3])
{
    return hypot(hypot(a[0], a[1]), a[2]);
}

static double distance(const double a[2], const double b[2])
{
    return hypot(b[0] - a[0], b[1] - a[1]);
}

// In the middle of three, between the directions to the others; atan2 stays exact where they are
// nearly parallel.
static double angle(const struct relume_note *note)
{
    double p[3][3], u[3], v[3], w[3];
    for (int i = 0; i < 3; i++)
        place_of(p[i], note, i);
    minus(u, p[0], p[1]);
    minus(v, p[2], p[1]);
    cross(w, u, v);
    return atan2(length_of(w), u[0] * v[0] + u[1] * v[1] + u[2] * v[2]) * (180.0 / M_PI);
}

struct relume_note_measures relume_note_measure(const struct relume_note *note)
{
    struct relume_note_measures m = {(double)NAN, (double)NAN, (double)NAN};
    const int n = note->places;
    const bool closed = note->kind == RELUME_NOTE_POLYGON;
    if (note->kind != RELUME_NOTE_LINE && !closed)
        return m;
    double length = 0.0, twice[3] = {0.0, 0.0, 0.0}, first[3], here[3], next[3], step[3];
    place_of(first, note, 0);
    for (int i = 0; i < n; i++) {
        place_of(here, note, i);
        place_of(next, note, (i + 1) % n);
        minus(step, next, here);
        length += i + 1 < n || closed ? length_of(step) : 0.0;
        // about the first place, so that far coordinates cost no digits
        minus(here, here, first);
        minus(next, next, first);
        cross(step, here, next);
        for (int c = 0; c < 3; c++)
            twice[c] += step[c];
    }
    m.length = length;
    if (closed)
        m.area = 0.5 * length_of(twice);
    else if (n == 3)
        m.degrees = angle(note);
    return m;
}

// ---------------------------------------------------------------- profiles

static relume_status lay_out(struct relume_profile *out, const double (*place)[2], int places)
{
    double length = 0.0;
    *out = (struct relume_profile){.count = 0};
    if (places < 2)
        return RELUME_EINVAL;
    for (int i = 0; i + 1 < places; i++)
        length += distance(place[i], place[i + 1]);
    if (!(length <= 1e7))
        return RELUME_ELIMIT;
    const int n = (int)ceil(length) + 1;
    out->along = mem_array((size_t)n, sizeof *out->along);
    out->place = mem_array((size_t)n, sizeof *out->place);
    out->height = mem_array((size_t)n, sizeof *out->height);
    if (!out->along || !out->place || !out->height) {
        relume_profile_destroy(out);
        return RELUME_ENOMEM;
    }
    out->count = n;
    int leg = 0;
    double before = 0.0, leg_length = distance(place[0], place[1]);
    for (int k = 0; k < n; k++) {
        const double at = k < n - 1 ? k : length;
        while (leg + 2 < places && at > before + leg_length) {
            before += leg_length;
            leg++;
            leg_length = distance(place[leg], place[leg + 1]);
        }
        const double t = leg_length > 0.0 ? fmin((at - before) / leg_length, 1.0) : 0.0;
        out->along[k] = at;
        for (int c = 0; c < 2; c++)
            out->place[k][c] = (1.0 - t) * place[leg][c] + t * place[leg + 1][c];
    }
    return RELUME_OK;
}

// Bilinear between the pixels around a place that are known; false where none is.
static bool sample(double *out, const struct relume_image *image, const double place[2],
                   bool (*known)(const float *pixel))
{
    const double x = place[0] - 0.5, y = place[1] - 0.5;
    const int left = (int)floor(x), top = (int)floor(y);
    double share = 0.0;
    for (int c = 0; c < image->channels; c++)
        out[c] = 0.0;
    for (int k = 0; k < 4; k++) {
        const int column = left + (k & 1), row = top + (k >> 1);
        const double weight = (1.0 - fabs(x - column)) * (1.0 - fabs(y - row));
        if (column < 0 || row < 0 || column >= image->width || row >= image->height ||
            weight <= 0.0)
            continue;
        const float *pixel =
            image->data +
            (size_t)image->channels * ((size_t)row * (size_t)image->width + (size_t)column);
        if (!known(pixel))
            continue;
        share += weight;
        for (int c = 0; c < image->channels; c++)
            out[c] += weight * (double)pixel[c];
    }
    for (int c = 0; c < image->channels; c++)
        out[c] /= share > 0.0 ? share : 1.0;
    return share > 0.0;
}

static bool faces(const float *normal)
{
    return normal[2] > 0.0f;
}

static bool is_height(const float *height)
{
    return !isnan(*height);
}

// How much higher the surface is a pixel further in a direction of the picture, whose y runs down.
static bool slope(double *out, const struct relume_image *normals, const double place[2],
                  const double direction[2])
{
    double n[4];
    if (!sample(n, normals, place, faces))
        return false;
    *out = (-n[0] * direction[0] + n[1] * direction[1]) / n[2];
    return true;
}

relume_status relume_profile_of_normals(struct relume_profile *out,
                                        const struct relume_image *normals,
                                        const double (*place)[2], int places)
{
    const relume_status status = lay_out(out, place, places);
    double height = 0.0;
    bool begun = false;
    for (int k = 0; !status && k < out->count; k++) {
        double here = 0.0, next = 0.0, direction[2] = {0.0, 0.0}, length = 0.0;
        const int to = k + 1 < out->count ? k + 1 : k;
        const int from = to - 1;
        length = distance(out->place[from], out->place[to]);
        for (int c = 0; length > 0.0 && c < 2; c++)
            direction[c] = (out->place[to][c] - out->place[from][c]) / length;
        const bool first = slope(&here, normals, out->place[k], direction);
        begun = begun || first;
        out->height[k] = begun ? height : (double)NAN;
        if (k + 1 < out->count && first && slope(&next, normals, out->place[k + 1], direction))
            height += 0.5 * (here + next) * length;
    }
    return status;
}

relume_status relume_profile_of_heights(struct relume_profile *out,
                                        const struct relume_image *heights,
                                        const double (*place)[2], int places)
{
    const relume_status status = lay_out(out, place, places);
    double first = (double)NAN;
    for (int k = 0; !status && k < out->count; k++) {
        double height[4];
        out->height[k] =
            sample(height, heights, out->place[k], is_height) ? height[0] : (double)NAN;
        if (isnan(first))
            first = out->height[k];
        out->height[k] -= first;
    }
    return status;
}

void relume_profile_destroy(struct relume_profile *profile)
{
    mem_free(profile->along);
    mem_free(profile->place);
    mem_free(profile->height);
    *profile = (struct relume_profile){.count = 0};
}

// acquire_relief.c - the slopes of the surface tell which axis of a list of lights is mirrored
//
// Lights that are turned or mirrored about the axis of view turn or mirror the slopes (p, q) alike.
// The curl dp/dy - dq/dx of a surface of heights vanishes only as it is (as in integrable.h;
// Belhumeur, Kriegman, Yuille 1999). A half turn only changes the sign of the curl: the relief is
// inverted, and nothing in the photographs says so.
//
// Slopes follow from plain least squares over all photographs. Gloss and shadows bend these normals
// towards the lights or away from them, but alike on all sides, which leaves no curl. Where slopes
// change most they count, each by the logarithm of its share of curl, so that no edge outweighs the
// rest.
#include "capture/acquire/acquire.h"

#include "core/base/memory.h"
#include "core/math/lsq.h"
#include "core/math/sort.h"

#include <stdio.h>
#include <string.h>

// With five lights shadows alone bend the slopes of a small sphere as a wrong axis would.
enum {
    LEAST_LIGHTS = 6,
    LEAST_CROSSINGS = 400,
    MOST_CROSSINGS = 20000,
    DERIVATIVES = 4,
    STEPS = 36
};
static const double UPRIGHT = 0.5;  // z of normals: steeper ones end in occlusions
static const float DARK = 0.05f;    // albedo, of the brightest tenth: noise rules
static const double FLAT = 0.8;     // share of the crossings that change least: left out
static const double RELIEF = 0.05;  // change of slopes over two pixels: 0.066 and more on
                                    // paintings, 0.04 and less on printed boards. Smooth relief
                                    // reaches it in smaller pictures, where noise falls.
static const double FLOOR = 0.01;   // of the curl's square: errors of the normals
// Geometric mean of the curl's square, relative to the list as it is. It is 1.0 and more on 43
// sound captures. Where an axis of the same captures is mirrored, it is 0.70 and less.
static const double CLEAR = 0.75;
static const double SURELY = 0.35;  // the same, of relief that does not stand out: 0.46 and more on
                                    // printed boards
static const double LEAST_TURN = 20.0;   // degrees: other errors make smaller turns
static const double MOST_NOISE = 250.0;  // variance of a normal over a sample's

struct relief {
    struct acquisition *s;
    int width, height;
    float *g;  // [height][width][3]: albedo x normal
    float least;
    double (*d)[DERIVATIVES];  // dp/dx, dp/dy, dq/dx, dq/dy
    double *size;
    int n;
};

// ---------------------------------------------------------------- normals

static vec3 direction_of(const struct shot *shot, bool near)
{
    return vec3_unit(near ? shot->position : shot->direction);
}

static bool counts(const struct shot *shot, vec3 direction)
{
    return !shot->misfit && !shot->strange && direction.z > 0.0;
}

// Inverts the sum of l l^T over the lights; false where they hardly span space.
static bool invert_lights(const struct acquisition *s, double m[9])
{
    int n = 0;
    memset(m, 0, 9 * sizeof *m);
    for (int i = 0; i < s->shots; i++) {
        const vec3 l = direction_of(&s->shot[i], s->p.near);
        const double v[3] = {l.x, l.y, l.z};
        if (!counts(&s->shot[i], l))
            continue;
        for (int k = 0; k < 9; k++)
            m[k] += v[k / 3] * v[k % 3];
        n++;
    }
    return n >= LEAST_LIGHTS && !lsq_invert(m, 3) && n * fmax(fmax(m[0], m[4]), m[8]) < MOST_NOISE;
}

// A photograph as it is compared, linear, one channel. Aligned photographs are kept small alone.
static relume_status make_photo(struct relume_image *out, const struct acquisition *s,
                                const struct shot *shot)
{
    const struct relume_image *from = s->p.align ? &shot->small : &shot->luma;
    const size_t n = (size_t)from->width * (size_t)from->height;
    const double scale = (double)s->width / from->width;
    const double shift[2] = {shot->shift[0] / scale, shot->shift[1] / scale};
    float power = 1.0f;
    for (int c = 0; c < 3 && s->has_intensities; c++)
        power += (shot->intensity[c] - 1.0f) / 3.0f;
    const relume_status status = relume_image_create(out, from->width, from->height, 1);
    for (size_t k = 0; !status && k < n; k++) {
        const float *p = from->data + k * (size_t)from->channels;
        out->data[k] =
            (from->channels == 3 ? (p[0] + p[1] + p[2]) / 3.0f : p[0] * p[0]) / fmaxf(power, 1e-6f);
    }
    return status || s->p.align ? status : acquire_move_back(out, shift);
}

static relume_status add_photo(struct relief *r, const struct shot *shot, const double inverse[9])
{
    struct relume_image photo;
    const vec3 l = direction_of(shot, r->s->p.near);
    const double v[3] = {l.x, l.y, l.z};
    float weight[3];
    if (!counts(shot, l))
        return RELUME_OK;
    for (int k = 0; k < 3; k++)
        weight[k] =
            (float)(inverse[3 * k] * v[0] + inverse[3 * k + 1] * v[1] + inverse[3 * k + 2] * v[2]);
    const relume_status status = make_photo(&photo, r->s, shot);
    for (size_t k = 0; !status && k < (size_t)r->width * (size_t)r->height; k++)
        for (int c = 0; c < 3; c++)
            r->g[3 * k + (size_t)c] += weight[c] * photo.data[k];
    relume_image_destroy(&photo);
    return status;
}

// Blackens what the mask hides.
static relume_status apply_mask(struct relief *r)
{
    struct relume_image mask;
    const relume_status status = acquire_load_mask(&mask, r->s);
    if (status || !mask.data)
        return status;
    for (int y = 0; y < r->height; y++)
        for (int x = 0; x < r->width; x++) {
            const int row = (2 * y + 1) * mask.height / (2 * r->height);
            const int column = (2 * x + 1) * mask.width / (2 * r->width);
            if (!(mask.data[(size_t)row * (size_t)mask.width + (size_t)column] > 0.5f))
                memset(r->g + 3 * ((size_t)y * (size_t)r->width + (size_t)x), 0, 3 * sizeof *r->g);
        }
    relume_image_destroy(&mask);
    return RELUME_OK;
}

static float size_of(const float *g)
{
    return sqrtf(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
}

static relume_status find_least(struct relief *r)
{
    const size_t all = (size_t)r->width * (size_t)r->height, step = all / MOST_CROSSINGS + 1;
    const size_t n = (all + step - 1) / step;
    float *some = mem_array(n, sizeof *some);
    if (!some)
        return RELUME_ENOMEM;
    for (size_t k = 0; k < n; k++)
        some[k] = size_of(r->g + 3 * k * step);
    sort_floats(some, n);
    r->least = fmaxf(DARK * some[n * 9 / 10], 1e-6f);
    mem_free(some);
    return RELUME_OK;
}

// ---------------------------------------------------------------- curl

static bool slopes_at(const struct relief *r, int x, int y, double pq[2])
{
    const float *g = r->g + 3 * ((size_t)y * (size_t)r->width + (size_t)x);
    const float size = size_of(g);
    if (!(size > r->least) || !((double)g[2] > UPRIGHT * (double)size))
        return false;
    pq[0] = -(double)g[0] / (double)g[2];
    pq[1] = -(double)g[1] / (double)g[2];
    return true;
}

// Smooth relief rises above noise in smaller pictures.
static void halve(struct relief *r)
{
    const int width = r->width / 2, height = r->height / 2;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 3; c++) {
                const float *from = r->g + 3 * (2 * ((size_t)y * (size_t)r->width + (size_t)x)) + c;
                r->g[3 * ((size_t)y * (size_t)width + (size_t)x) + (size_t)c] =
                    0.25f * (from[0] + from[3] + from[3 * r->width] + from[3 * r->width + 3]);
            }
    r->width = width;
    r->height = height;
}

static void gather(struct relief *r)
{
    r->n = 0;
    for (int y = 1; y + 1 < r->height; y++)
        for (int x = 1; x + 1 < r->width; x++) {
            double left[2], right[2], up[2], down[2];
            if (!slopes_at(r, x - 1, y, left) || !slopes_at(r, x + 1, y, right) ||
                !slopes_at(r, x, y - 1, up) || !slopes_at(r, x, y + 1, down))
                continue;
            double *d = r->d[r->n];
            d[0] = right[0] - left[0];
            d[1] = up[0] - down[0];
            d[2] = right[1] - left[1];
            d[3] = up[1] - down[1];
            r->size[r->n++] = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2] + d[3] * d[3]);
        }
}

// Keeps crossings where slopes change most, at most MOST_CROSSINGS of them, as unit vectors.
static relume_status keep_steep(struct relief *r, bool *stands_out)
{
    double *sorted = mem_copy(r->size, (size_t)r->n, sizeof *sorted);
    if (!sorted)
        return RELUME_ENOMEM;
    sort_doubles(sorted, (size_t)r->n);
    const double least = fmax(sorted[(size_t)(FLAT * r->n)], 1e-9);
    const int step = (int)((1.0 - FLAT) * r->n) / MOST_CROSSINGS + 1;
    int found = 0, kept = 0;
    mem_free(sorted);
    for (int i = 0; i < r->n; i++) {
        if (r->size[i] < least || found++ % step)
            continue;
        for (int k = 0; k < DERIVATIVES; k++)
            r->d[kept][k] = r->d[i][k] / r->size[i];
        kept++;
    }
    r->n = kept;
    *stands_out = least > RELIEF;
    return RELUME_OK;
}

// Geometric mean of the curl's square of slopes that are mirrored in y, where `mirrored`, and then
// turned.
static double curl_of(const struct relief *r, double degrees, bool mirrored)
{
    const double c = cos(degrees * M_PI / 180.0), s = sin(degrees * M_PI / 180.0);
    const double f = mirrored ? -1.0 : 1.0;
    // d(p')/dy - d(q')/dx
    const double v[DERIVATIVES] = {-s, c, -c * f, -s * f};
    double sum = 0.0;
    for (int i = 0; i < r->n; i++) {
        double curl = 0.0;
        for (int k = 0; k < DERIVATIVES; k++)
            curl += v[k] * r->d[i][k];
        sum += log(curl * curl + FLOOR);
    }
    return exp(sum / r->n);
}

static void name_turn(char *out, size_t size, double degrees, bool mirrored)
{
    if (mirrored && (degrees < 20.0 || degrees > 160.0))
        snprintf(out, size, "x or y is negated");
    else if (mirrored && fabs(degrees - 90.0) < 20.0)
        snprintf(out, size, "x and y are exchanged");
    else
        snprintf(out, size, "%sit is turned by %.0f or %.0f degrees counter-clockwise",
                 mirrored ? "y is negated and " : "", degrees, degrees + 180.0);
}

// The list that leaves least curl.
struct better {
    double left;  // of the curl under the list as it is
    double degrees;
    bool mirrored;
};

static struct better find_better(const struct relief *r)
{
    struct better b = {.left = INFINITY};
    for (int k = 0; k < 2 * STEPS; k++) {
        const double degrees = 180.0 / STEPS * (k / 2), curl = curl_of(r, degrees, k % 2 == 1);
        const bool is_near = k % 2 == 0 && (degrees < LEAST_TURN || degrees > 180.0 - LEAST_TURN);
        if (!is_near && curl < b.left)
            b = (struct better){curl, degrees, k % 2 == 1};
    }
    b.left /= curl_of(r, 0.0, false);
    return b;
}

static relume_status say(struct acquisition *s, const struct better *b)
{
    char mend[128];
    name_turn(mend, sizeof mend, b->degrees, b->mirrored);
    return acquire_warn(s,
                        "%s: no surface looks like the photographs under these lights: its slopes "
                        "have curl, of which %.0f %% is left if %s; check the list's axes",
                        s->p.lights, 100.0 * b->left, mend);
}

// Doubts the list where the picture as it is surely does, or it and the first in which relief
// stands out.
static relume_status compare(struct relief *r)
{
    struct better first = {0};
    bool stands_out = false;
    for (int level = 0; !stands_out; level++, halve(r)) {
        gather(r);
        if (r->n < LEAST_CROSSINGS)
            return RELUME_OK;
        const relume_status status = keep_steep(r, &stands_out);
        if (status)
            return status;
        if (level > 0 && !stands_out)
            continue;
        const struct better b = find_better(r);
        if (b.left > CLEAR)
            return RELUME_OK;
        first = level == 0 ? b : first;
        stands_out |= level == 0 && b.left < SURELY;
    }
    return say(r->s, &first);
}

static relume_status judge(struct relief *r, const double inverse[9])
{
    struct acquisition *s = r->s;
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < s->shots; i++)
        status = add_photo(r, &s->shot[i], inverse);
    if (!status)
        status = apply_mask(r);
    if (!status)
        status = find_least(r);
    return status ? status : compare(r);
}

relume_status acquire_check_relief(struct acquisition *s)
{
    const struct relume_image *like = s->p.align ? &s->shot[0].small : &s->shot[0].luma;
    const size_t pixels = (size_t)like->width * (size_t)like->height;
    struct relief r = {.s = s, .width = like->width, .height = like->height};
    double inverse[9];
    if (!s->p.lights || s->witnessed || !like->data || !invert_lights(s, inverse))
        return RELUME_OK;
    r.g = mem_zeroed(3 * pixels, sizeof *r.g);
    r.d = mem_array(pixels, sizeof *r.d);
    r.size = mem_array(pixels, sizeof *r.size);
    const relume_status status = r.g && r.d && r.size ? judge(&r, inverse) : RELUME_ENOMEM;
    mem_free(r.g);
    mem_free(r.d);
    mem_free(r.size);
    return status;
}

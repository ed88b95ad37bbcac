// acquire_relief.c - the slopes of the surface tell which axis of a list of lights is mirrored
//
// Lights that are turned or mirrored about the axis of view turn or mirror the slopes (p, q) alike.
// The curl dp/dy - dq/dx of a surface of heights vanishes only as it is (as in integrable.h;
// Belhumeur, Kriegman, Yuille 1999). A half turn only changes the sign of the curl: the relief is
// inverted, and nothing in the photographs says so.
#include "capture/acquire/acquire.h"

#include "core/base/memory.h"
#include "core/math/sort.h"

#include <stdio.h>

enum { LEAST_CROSSINGS = 400, DERIVATIVES = 4, STEPS = 36 };
static const double UPRIGHT = 0.5;  // z of normals: steeper ones end in occlusions
static const double KEPT = 0.9;     // share of the crossings: the sharpest are edges
// Curl over that of derivatives in no order: 0.01 to 0.5 on sound captures, 0.9 to 1.6 where an
// axis of the same captures is mirrored.
static const double CURLED = 0.7;
static const double CLEAR = 0.55;  // curl of what the list should be, over that of the list

struct relief {
    int width, height;
    const float *normal;
    double (*d)[DERIVATIVES];  // dp/dx, dp/dy, dq/dx, dq/dy
    double *size;
    int n;
};

static bool slopes_at(const struct relief *r, int x, int y, double pq[2])
{
    const float *n = r->normal + 3 * ((size_t)y * (size_t)r->width + (size_t)x);
    if (!((double)n[2] > UPRIGHT))
        return false;
    pq[0] = -(double)n[0] / (double)n[2];
    pq[1] = -(double)n[1] / (double)n[2];
    return true;
}

static void gather(struct relief *r)
{
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

static void sum_products(const struct relief *r, double most, double gram[16])
{
    for (int i = 0; i < 16; i++)
        gram[i] = 0.0;
    for (int i = 0; i < r->n; i++) {
        const double *d = r->d[i];
        const double size = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2] + d[3] * d[3]);
        for (int k = 0; size < most && k < 16; k++)
            gram[k] += d[k / 4] * d[k % 4];
    }
}

// Sum of the squared curl of slopes that are mirrored in y, where `mirrored`, and then turned.
static double curl_of(const double gram[16], double degrees, bool mirrored)
{
    const double c = cos(degrees * M_PI / 180.0), s = sin(degrees * M_PI / 180.0);
    const double f = mirrored ? -1.0 : 1.0;
    // d(p')/dy - d(q')/dx
    const double v[4] = {-s, c, -c * f, -s * f};
    double sum = 0.0;
    for (int k = 0; k < 16; k++)
        sum += v[k / 4] * gram[k] * v[k % 4];
    return sum;
}

static void name_turn(char *out, size_t size, double degrees, bool mirrored)
{
    if (mirrored && (degrees == 0.0 || fabs(degrees) == 180.0))
        snprintf(out, size, "x or y is negated");
    else if (mirrored && fabs(degrees) == 90.0)
        snprintf(out, size, "x and y are exchanged");
    else
        snprintf(out, size, "%sit is turned by %.0f or %.0f degrees counter-clockwise",
                 mirrored ? "y is negated and " : "", degrees, degrees + 180.0);
}

static relume_status compare(struct acquisition *s, const double gram[16])
{
    const double trace = gram[0] + gram[5] + gram[10] + gram[15];
    if (!(trace > 0.0))  // all of it is flat
        return RELUME_OK;
    const double as_given = curl_of(gram, 0.0, false) / (0.5 * trace);
    double least = INFINITY, at = 0.0;
    bool mirrored = false;
    for (int k = 0; k < 2 * STEPS; k++) {
        const double degrees = 180.0 / STEPS * (k / 2);
        const double curl = curl_of(gram, degrees, k % 2 == 1) / (0.5 * trace);
        if (curl < least) {
            least = curl;
            at = degrees;
            mirrored = k % 2 == 1;
        }
    }
    if (as_given < CURLED || least > CLEAR * as_given)
        return RELUME_OK;
    char mend[128];
    name_turn(mend, sizeof mend, at, mirrored);
    return acquire_warn(s,
                        "%s: no surface looks like the photographs under these lights: its curl is "
                        "%.2f of what chance gives, %.2f if %s; check the list's axes",
                        s->p.lights, as_given, least, mend);
}

relume_status acquire_check_relief(struct acquisition *s)
{
    const struct relume_image *normal = &s->out->photometric.normal;
    const size_t most = (size_t)normal->width * (size_t)normal->height;
    struct relief r = {.width = normal->width, .height = normal->height, .normal = normal->data};
    if (!normal->data || s->witnessed)
        return RELUME_OK;
    r.d = mem_array(most, sizeof *r.d);
    r.size = mem_array(most, sizeof *r.size);
    relume_status status = r.d && r.size ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        gather(&r);
    if (!status && r.n >= LEAST_CROSSINGS) {
        double gram[16];
        sort_doubles(r.size, (size_t)r.n);
        sum_products(&r, r.size[(size_t)(KEPT * r.n)], gram);
        status = compare(s, gram);
    }
    mem_free(r.d);
    mem_free(r.size);
    return status;
}

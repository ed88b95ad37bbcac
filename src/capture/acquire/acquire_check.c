// acquire_check.c - warns of faults of the photographs and lights before anybody looks at the
// result
#include "capture/acquire/acquire.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/lsq.h"
#include "core/math/sort.h"

#include <relume/capture/align.h>
#include <stdio.h>

enum { PAIRS = 5, GRID = 1500 };
static const double SIMILAR = 0.35, UNLIKE = 0.5;  // similarity: of one scene; share of the usual
static const float BLURRED = 0.35f;                // of the usual fine detail
static const double LEAST_DETAIL = 2e-3;           // mean square of the logarithm's differences
static const float SATURATED = 0.02f, DARK = 0.999f;
static const double FLAT = 0.004;   // least eigenvalue of the directions' mean square
static const double LOWEST = 0.26;  // sine of the elevation from which light is wanted: 15 degrees
static const double WIDE_GAP = 40.0;  // degrees

static double median(double *v, int n)
{
    if (n == 0)
        return (double)NAN;
    sort_doubles(v, (size_t)n);
    return v[n / 2];
}

float acquire_similarity(const struct acquisition *s, int i)
{
    double found[PAIRS];
    int n = 0;
    if (isfinite(s->shot[i].similarity))
        return s->shot[i].similarity;
    const int step = s->shots > PAIRS ? (s->shots - 1) / PAIRS : 1;
    for (int k = 1; k < s->shots && n < PAIRS; k += step) {
        const double like =
            relume_edge_correlation(&s->shot[i].small, &s->shot[(i + k) % s->shots].small);
        if (isfinite(like))
            found[n++] = like;
    }
    return (float)median(found, n);
}

// Few photographs are enough where they are judged by their lights. A report of a folder has all.
static void measure_similarity(struct acquisition *s)
{
    const int step = s->dir || !acquire_can_judge(s) ? 1 : ACQUIRE_SIMILAR;
    for (int i = 0; i < s->shots; i += step)
        s->shot[i].similarity = acquire_similarity(s, i);
}

relume_status acquire_name_scenes(struct acquisition *s)
{
    double *all = mem_array((size_t)s->shots, sizeof *all);
    if (!all)
        return RELUME_ENOMEM;
    int known = 0;  // of others nothing can be said: pictures without edges, numbers too large
    for (int i = 0; i < s->shots; i++)
        s->shot[i].similarity = acquire_similarity(s, i);
    for (int i = 0; i < s->shots; i++)
        if (isfinite(s->shot[i].similarity))
            all[known++] = (double)s->shot[i].similarity;
    const double usual = median(all, known);
    mem_free(all);
    relume_status status = RELUME_OK;
    for (int i = 0; !status && usual > SIMILAR && i < s->shots;) {
        const double like = (double)s->shot[i].similarity;
        if (!(like < UNLIKE * usual) || s->shot[i].black > DARK) {
            i++;
            continue;
        }
        if (s->p.skip_bad) {
            status = acquire_drop(s, i, true,
                                  "shows another scene: similarity %.2f, the others have %.2f",
                                  like, usual);
            continue;
        }
        status = acquire_warn_alike(s, ALIKE_SCENE, -like,
                                    "%s: seems to show another scene: similarity %.2f, the others "
                                    "have %.2f",
                                    s->shot[i].path, like, usual);
        i++;
    }
    return status;
}

static relume_status check_focus(struct acquisition *s)
{
    double *all = mem_array((size_t)s->shots, sizeof *all);
    if (!all)
        return RELUME_ENOMEM;
    int known = 0;
    for (int i = 0; i < s->shots; i++) {
        const struct shot *shot = &s->shot[i];
        if (shot->coarse > LEAST_DETAIL && shot->fine > 0.0)
            all[known++] = shot->fine / shot->coarse;
    }
    const double usual = median(all, known);
    mem_free(all);
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < s->shots; i++) {
        struct shot *shot = &s->shot[i];
        shot->sharpness = shot->coarse > LEAST_DETAIL && known > 2
                              ? (float)(shot->fine / shot->coarse / usual)
                              : (float)NAN;
        if (shot->sharpness < BLURRED)
            status = acquire_warn_alike(
                s, ALIKE_BLURRED, -(double)shot->sharpness,
                "%s: less sharp than the others: %.0f %% of their fine detail; focus moved, or the "
                "camera shook?",
                shot->path, 100.0 * (double)shot->sharpness);
    }
    return status;
}

static void say_outside(const struct acquisition *s)
{
    const struct shot *most = &s->shot[0];
    for (int i = 1; i < s->shots; i++)
        most = s->shot[i].outside > most->outside ? &s->shot[i] : most;
    if (most->outside > 0.0f)
        log_line(s->p.log, RELUME_NOTE,
                 "%s: by its colour profile %.2g %% of the pixels lie outside sRGB, of no "
                 "photograph more; they are kept, and .exr pictures show them",
                 most->path, 100.0 * (double)most->outside);
}

relume_status acquire_check_pictures(struct acquisition *s)
{
    measure_similarity(s);
    relume_status status = RELUME_OK;
    if (!acquire_can_judge(s))
        status = acquire_name_scenes(s);
    if (!status && !acquire_can_judge(s))
        status = check_focus(s);
    int full = 0;
    say_outside(s);
    for (int i = 0; !status && i < s->shots; i++) {
        const struct shot *shot = &s->shot[i];
        full += shot->saturated > 0.9f;
        if (shot->saturated > SATURATED)
            status = acquire_warn_alike(s, ALIKE_SATURATED, (double)shot->saturated,
                                        "%s: %.1f %% of the pixels are overexposed", shot->path,
                                        100.0 * (double)shot->saturated);
    }
    if (!status && full == s->shots)
        status = log_fail(s->p.log, RELUME_EUNFIT,
                          "all %d photographs are overexposed; expected shorter exposures", full);
    return status;
}

// ---------------------------------------------------------------- lights

relume_status acquire_leave_black_out(struct acquisition *s)
{
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < s->shots;) {
        const struct shot *shot = &s->shot[i];
        const vec3 d = vec3_unit(s->p.near ? shot->position : shot->direction);
        if (shot->black > DARK && d.z > LOWEST && !shot->notes.floats)
            status = acquire_drop(s, i, true, "black; did its lamp fail?");
        else
            i++;
    }
    return status;
}

// The direction farthest from all lights and from the `n` already proposed.
static double find_gap(const struct relume_acquisition *out, const vec3 *proposed, int n, vec3 *gap)
{
    double widest = 0.0;
    for (int k = 0; k < GRID; k++) {
        const double z = LOWEST + (1.0 - LOWEST) * (k + 0.5) / GRID, r = sqrt(1.0 - z * z);
        const double phi = k * (M_PI * (3.0 - sqrt(5.0)));
        const vec3 d = vec3_of(r * cos(phi), r * sin(phi), z);
        double nearest = M_PI;
        for (int i = 0; i < out->lights; i++)
            nearest = fmin(nearest, vec3_angle(d, out->direction[i]));
        for (int i = 0; i < n; i++)
            nearest = fmin(nearest, vec3_angle(d, proposed[i]));
        if (nearest > widest) {
            widest = nearest;
            *gap = d;
        }
    }
    return widest * 180.0 / M_PI;
}

static double azimuth(vec3 d)
{
    const double a = atan2(d.y, d.x) * 180.0 / M_PI;
    return a < 0.0 ? a + 360.0 : a;
}

// "lower left, 16 degrees above the table (230 degrees counter-clockwise from the right)"
static size_t put_place(char *out, size_t capacity, const char *before, vec3 d)
{
    static const char *const sides[] = {"right", "upper right", "top",    "upper left",
                                        "left",  "lower left",  "bottom", "lower right"};
    const double a = azimuth(d);
    const int n =
        snprintf(out, capacity,
                 "%s%s, %.0f degrees above the table (%.0f degrees counter-clockwise from "
                 "the right)",
                 before, sides[(int)floor(a / 45.0 + 0.5) % 8], asin(d.z) * 180.0 / M_PI, a);
    return n < 0 ? 0 : (size_t)n < capacity ? (size_t)n : capacity - 1;
}

static relume_status check_coverage(struct acquisition *s)
{
    enum { SAID = 2 };  // more than a line holds are in the report
    struct relume_acquisition *out = s->out;
    char places[512] = "";
    size_t at = 0;
    int n = 0;
    out->gap_deg = find_gap(out, NULL, 0, &out->gap);
    while (n < RELUME_ACQUIRE_SUGGESTIONS &&
           find_gap(out, out->wanted, n, &out->wanted[n]) > WIDE_GAP)
        n++;
    out->wanted_count = n;
    for (int i = 0; i < n && i < SAID; i++)
        at += put_place(places + at, sizeof places - at, i ? "; " : "", out->wanted[i]);
    if (!n)
        return RELUME_OK;
    return acquire_warn(s, "uneven light: the widest gap is %.0f degrees; add lamps: %s%s",
                        out->gap_deg, places, n > SAID ? "; and more, see report.html" : "");
}

relume_status acquire_check_lights(struct acquisition *s)
{
    const struct relume_acquisition *out = s->out;
    double m[9] = {0.0}, values[3];
    for (int i = 0; i < out->lights; i++) {
        const vec3 d = out->direction[i];
        const double v[3] = {d.x, d.y, d.z};
        for (int j = 0; j < 9; j++)
            m[j] += v[j / 3] * v[j % 3] / out->lights;
    }
    if (!lsq_eigenvalues(m, 3, values))
        return RELUME_ENOMEM;
    s->coplanar = values[0] < FLAT;
    if (!s->dir)  // who encodes photographs cannot add lamps, and wants no normals
        return RELUME_OK;
    relume_status status = RELUME_OK;
    if (s->coplanar)
        status = acquire_warn(s,
                              "the light directions lie nearly in one plane (%.1f degrees off it): "
                              "normals cannot be computed",
                              asin(sqrt(fmax(values[0], 0.0))) * 180.0 / M_PI);
    return status ? status : check_coverage(s);
}

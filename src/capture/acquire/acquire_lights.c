// acquire_lights.c - where the lights of the photographs were
#include "core/base/tree.h"
#include "capture/acquire/acquire.h"

#include "capture/acquire/ball.h"
#include "capture/acquire/ramp.h"
#include "capture/acquire/rays.h"
#include "capture/manifest/loaded_lights.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "image/image/photograph.h"

#include <stdio.h>
#include <string.h>

enum { MOST_FOUND = 6 };               // balls that are looked for unless a number is given
static const double SMALLEST = 0.4;    // of the largest ball's radius: smaller ones are left out
static const double TOO_WIDE = 12.0;   // degrees: what is that wide is no lamp in a mirror
static const double DISAGREE = 3.0;    // degrees between balls: lights are near
static const double RAMP_ERROR = 0.1;  // of a distance that brightness shows
static const double UNEVEN = 0.03;     // error of a lamp's middle, of its width
static const double STATED = 4.0;      // photographs with two balls that outweigh what balls state
static const double BELOW = -0.05;     // z of a direction: the lamp stood behind the ball

// ---------------------------------------------------------------- balls

static relume_status load_mask(const struct acquisition *s, struct relume_image *out)
{
    *out = (struct relume_image){0};
    if (!s->p.ball_mask)
        return RELUME_OK;
    relume_status status =
        relume_image_load(out, s->p.ball_mask, relume_image_params(.log = s->p.log, .channels = 1));
    if (!status && (out->width != s->camera.width || out->height != s->camera.height)) {
        status =
            log_fail(s->p.log, RELUME_EUNFIT, "%s: %d x %d pixels; expected %d x %d",
                     s->p.ball_mask, out->width, out->height, s->camera.width, s->camera.height);
        relume_image_destroy(out);
    }
    return status;
}

static relume_status outline_given(struct acquisition *s)
{
    struct relume_acquisition *out = s->out;
    for (int b = 0; b < out->balls; b++) {
        const double *c = s->p.ball[b];
        out->ball[b] = relume_ball_outlined(c[0], c[1], c[2], &s->camera);
        if (!(c[2] > 2.0) || !(out->ball[b].radius > 0.0) || c[2] > 4.0 * s->camera.width ||
            !(c[0] > 0.0 && c[0] < s->camera.width && c[1] > 0.0 && c[1] < s->camera.height))
            return log_fail(s->p.log, RELUME_EINVAL,
                            "ball %g,%g,%g: expected a circle of more than 2 pixels with its "
                            "middle in the picture of %d x %d",
                            c[0], c[1], c[2], s->camera.width, s->camera.height);
    }
    return RELUME_OK;
}

static const char *ball_photo(const struct shot *shot)
{
    return shot->ball_path ? shot->ball_path : shot->path;
}

relume_status acquire_load_balls(struct relume_image *out, const struct acquisition *s, int i)
{
    const bool own = s->shot[i].ball_path && s->p.ball_transfer.curve != RELUME_CURVE_AUTO;
    struct relume_exif notes;
    relume_status status = acquire_load(out, &notes, s, ball_photo(&s->shot[i]),
                                        own ? s->p.ball_transfer : s->p.transfer);
    if (status)
        return status;
    acquire_correct(s, out, notes.floats);
    if (!s->shot[i].ball_path)
        status = acquire_move_back(out, s->shot[i].shift);
    if (status)
        relume_image_destroy(out);
    return status;
}

// What is wrong with how ball `b` shows the light; NULL when nothing is.
static const char *objection(const struct relume_ball_light *l, bool matte)
{
    if (l->finding == RELUME_BALL_DARK || l->finding == RELUME_BALL_FULL)
        return relume_ball_finding_text(l->finding);
    return !matte && l->spread_deg > TOO_WIDE ? "highlight too large for a lamp; is the photograph "
                                                "of the ball linear (--ball-transfer)?"
                                              : NULL;
}

static relume_status look(struct relume_ball_light *out, const struct acquisition *s,
                          const struct relume_ball *ball, const struct relume_image *photograph)
{
    return s->p.matte
               ? relume_ball_matte(out, ball, &s->camera, photograph)
               : relume_ball_mirror(out, ball, &s->camera, photograph, s->still ? &s->mean : NULL);
}

enum { CANDIDATES = 16, TRIALS = 6 };
static const double DOUBTFUL = 3.0;  // degrees of error: a matte ball with more may not be one
static const double NO_LAMP = 90.0;  // degrees that count where a matte ball shows no light

// How badly candidates show the lamp, in a few photographs spread over all: mirrors 0, or 1 where
// most show none (a round stone does in few of them); matte ones the error in degrees of the
// direction they show, which is large where something round is shaded as no white ball is.
static relume_status try_candidates(double *bad, const struct acquisition *s,
                                    const struct relume_ball *ball, int n)
{
    const int trials = s->shots < TRIALS ? s->shots : TRIALS;
    const bool matte = s->p.matte;
    int seen[MOST_BALLS + CANDIDATES] = {0};
    double error[MOST_BALLS + CANDIDATES] = {0.0};
    for (int i = 0; i < trials; i++) {
        struct relume_image image;
        relume_status status = acquire_load_balls(&image, s, i * s->shots / trials);
        for (int b = 0; !status && b < n; b++) {
            struct relume_ball_light light = {0};
            status = look(&light, s, &ball[b], &image);
            const bool sees = !objection(&light, matte);
            seen[b] += sees;
            error[b] += sees ? light.sigma_deg : NO_LAMP;
        }
        relume_image_destroy(&image);
        if (status)
            return status;
    }
    for (int b = 0; b < n; b++)
        bad[b] = matte ? error[b] / trials : 2 * seen[b] <= trials;
    return RELUME_OK;
}

struct candidates {
    int n;
    struct relume_ball ball[MOST_BALLS + 2 * CANDIDATES];
    double bad[MOST_BALLS + 2 * CANDIDATES];
};

// Takes the candidates that show the lamp best and do not overlap, the first of equals. Returns how
// badly the last of them shows it, infinity where there are too few.
static double take_best(struct relume_acquisition *out, const struct candidates *t)
{
    double worst = 0.0;
    bool used[MOST_BALLS + 2 * CANDIDATES] = {false};
    for (int kept = 0; kept < out->balls; kept++) {
        int best = -1;
        for (int b = 0; b < t->n; b++)
            if (!used[b] && (best < 0 || t->bad[b] < t->bad[best]))
                best = b;
        if (best < 0)
            return INFINITY;
        out->ball[kept] = t->ball[best];
        worst = t->bad[best];
        for (int b = 0; b < t->n; b++)
            used[b] |= hypot(t->ball[b].x - t->ball[best].x, t->ball[b].y - t->ball[best].y) <
                       fmax(t->ball[b].radius, t->ball[best].radius);
    }
    return worst;
}

// Adds the other candidates that show the lamp and do not overlap, where no number is given.
static void take_more(struct acquisition *s, const struct candidates *t)
{
    struct relume_acquisition *out = s->out;
    for (int k = 0; !s->p.balls && !s->p.matte && k < t->n && out->balls < MOST_FOUND; k++) {
        const struct relume_ball *new = &t->ball[k];
        bool apart = !(t->bad[k] > 0.0);
        for (int b = 0; apart && b < out->balls; b++)
            apart = hypot(new->x - out->ball[b].x, new->y - out->ball[b].y) >
                    new->radius + out->ball[b].radius;
        if (apart)
            out->ball[out->balls++] = *new;
    }
}

static relume_status add_candidates(struct candidates *t, const struct acquisition *s,
                                    const struct relume_image *picture, int most,
                                    const struct relume_ball_params *params)
{
    int found;
    relume_status status =
        relume_ball_candidates(t->ball + t->n, most, &found, picture, &s->camera, params);
    if (!status)
        status = try_candidates(t->bad + t->n, s, t->ball + t->n, found);
    t->n += found;
    return status;
}

// Outlines instead of horizons of tables, which are smaller, so that lamps look wider by them;
// *bad: how badly they show the lamp then.
static relume_status seek_tables(struct acquisition *s, double *bad)
{
    double each[MOST_BALLS];
    if (s->p.matte || isinf(*bad))
        return RELUME_OK;
    relume_status status = acquire_seek_tables(s);
    if (!status && *bad > 0.0) {
        status = try_candidates(each, s, s->out->ball, s->out->balls);
        *bad = 0.0;
        for (int b = 0; !status && b < s->out->balls; b++)
            *bad = fmax(*bad, each[b]);
    }
    return status;
}

// The circles that show the lamp best. Where a patterned table hides outlines, look at how light
// changes from photograph to photograph: there the pattern drops out. Where too few show the lamp
// at all, take others, so that the message can name what is wrong with them.
static relume_status find_best(struct acquisition *s, const struct relume_ball_params *params)
{
    struct relume_acquisition *out = s->out;
    struct candidates t = {0};
    const int wanted = out->balls;
    relume_status status = add_candidates(&t, s, &s->mean, wanted + CANDIDATES, params);
    double bad = take_best(out, &t);
    if (!status)
        status = seek_tables(s, &bad);
    if (!status && bad > (s->p.matte ? DOUBTFUL : 0.0)) {
        status = add_candidates(&t, s, &s->change, CANDIDATES, params);
        bad = take_best(out, &t);
        if (!status)
            status = seek_tables(s, &bad);
    }
    if (!status && !(bad > 0.0))
        take_more(s, &t);
    if (!status && isinf(bad))
        return RELUME_EUNFIT;
    ball_sort(out->ball, out->balls);
    return status;
}

static relume_status no_ball(const struct acquisition *s)
{
    const int n = s->out->balls;
    char what[48] = "no";
    if (n > 1)
        snprintf(what, sizeof what, "fewer than %d", n);
    return log_fail(s->p.log, RELUME_EUNFIT,
                    "%s: %s %s ball%s found; give --lights %s, or --ball x,y,r where one is%s",
                    ball_photo(&s->shot[0]), what, s->p.matte ? "matte" : "mirror",
                    relume_plural(n), *s->likely_lights ? s->likely_lights : "FILE",
                    s->p.matte ? "" : ", or --matte for a white ball");
}

static relume_status find_balls(struct acquisition *s)
{
    struct relume_acquisition *out = s->out;
    out->balls = s->p.balls > 0 ? s->p.balls : 1;
    if (out->balls > MOST_BALLS)
        return log_fail(s->p.log, RELUME_EINVAL, "%d balls; expected at most %d", out->balls,
                        (int)MOST_BALLS);
    out->ball = mem_zeroed(MOST_BALLS, sizeof *out->ball);
    if (!out->ball)
        return RELUME_ENOMEM;
    if (s->p.ball)
        return outline_given(s);
    struct relume_image mask;
    const relume_status loaded = load_mask(s, &mask);
    if (loaded)
        return loaded;
    const struct relume_ball_params p = {.mask = mask.data ? &mask : NULL,
                                         .peak = s->p.matte ? NULL : &s->peak};
    relume_status status = mask.data
                               ? relume_ball_find(out->ball, out->balls, &s->mean, &s->camera, &p)
                               : find_best(s, &p);
    if (status == RELUME_EUNFIT)
        status = no_ball(s);
    relume_image_destroy(&mask);
    return status;
}

static relume_status warn_cut_off(struct acquisition *s)
{
    relume_status status = RELUME_OK;
    for (int b = 0; !status && b < s->out->balls; b++) {
        const struct relume_ball *ball = &s->out->ball[b];
        const double beside = fmax(fmax(ball->radius - ball->x, ball->radius - ball->y),
                                   fmax(ball->x + ball->radius - s->camera.width,
                                        ball->y + ball->radius - s->camera.height));
        if (beside > 0.02 * ball->radius)
            status = acquire_warn(s, "ball at %.0f,%.0f: cut off by the picture's border", ball->x,
                                  ball->y);
    }
    return status;
}

// The middle of a ball and its radius in the world.
static double place_ball(const struct acquisition *s, const struct relume_ball *ball, vec3 *middle)
{
    const double width = s->camera.width, z = s->p.ball_z;
    if (!(s->camera.focal_px > 0.0)) {
        *middle =
            vec3_of(2.0 * ball->x / width - 1.0, (s->camera.height - 2.0 * ball->y) / width, z);
        return 2.0 * ball->radius / width;
    }
    const double eye = 2.0 * s->camera.focal_px / width;
    const double along = (eye - z) / -ball->axis.z;
    *middle = vec3_along(vec3_of(0.0, 0.0, eye), ball->axis, along);
    return along * sin(ball->half_angle_rad);
}

struct ball_lights {
    struct relume_ball_light light[MOST_BALLS];  // [rays.n]
    struct ball_rays rays;
};

// What every ball shows of every lamp: light[shots][balls].
static relume_status look_all(const struct acquisition *s, struct relume_ball_light *light)
{
    const int balls = s->out->balls;
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < s->shots; i++) {
        struct relume_image image;
        status = acquire_load_balls(&image, s, i);
        for (int b = 0; !status && b < balls; b++)
            status =
                look(&light[(size_t)i * (size_t)balls + (size_t)b], s, &s->out->ball[b], &image);
        relume_image_destroy(&image);
    }
    return status;
}

static void add_ray(struct ball_rays *rays, const struct acquisition *s, int ball,
                    const struct relume_ball_light *light)
{
    vec3 middle;
    const double radius = place_ball(s, &s->out->ball[ball], &middle);
    rays->origin[rays->n] = vec3_along(middle, light->origin, radius);
    rays->direction[rays->n++] = light->direction;
}

// The directions in which balls show the lamp of one photograph; returns why the last one that
// shows none does not, or NULL.
static const char *gather(const struct acquisition *s, const struct relume_ball_light *light,
                          struct ball_lights *to)
{
    const char *why = NULL;
    struct ball_rays *rays = &to->rays;
    rays->n = 0;
    for (int b = 0; b < s->out->balls; b++) {
        const struct relume_ball_light *l = &light[b];
        const char *objects = objection(l, s->p.matte);
        why = objects ? objects : why;
        if (objects)
            continue;
        to->light[rays->n] = *l;
        add_ray(rays, s, b, l);
    }
    return why;
}

static relume_status warn_highlights(struct acquisition *s, int i,
                                     const struct relume_ball_light *light)
{
    relume_status status = RELUME_OK;
    for (int b = 0; !status && b < s->out->balls; b++) {
        const struct relume_ball_light *l = &light[b];
        if (objection(l, s->p.matte))
            continue;
        if (l->finding == RELUME_BALL_RIM || l->finding == RELUME_BALL_TWO)
            status = acquire_warn_alike(
                s, l->finding == RELUME_BALL_RIM ? ALIKE_RIM : ALIKE_TWO, 0.0,
                "%s: %s of the ball at %.0f,%.0f", ball_photo(&s->shot[i]),
                relume_ball_finding_text(l->finding), s->out->ball[b].x, s->out->ball[b].y);
    }
    return status;
}

// The mean direction and its error by the balls' own.
static void average(struct shot *shot, const struct ball_lights *seen)
{
    vec3 sum = vec3_of(0.0, 0.0, 0.0);
    double formal = 0.0;
    for (int b = 0; b < seen->rays.n; b++)
        sum = vec3_add(sum, seen->rays.direction[b]);
    shot->direction = vec3_unit(sum);
    for (int b = 0; b < seen->rays.n; b++)
        formal += seen->light[b].sigma_deg * seen->light[b].sigma_deg;
    shot->sigma_deg = sqrt(formal) / seen->rays.n;
    shot->light = seen->light[0];
    for (int c = 0; c < 3; c++)
        shot->intensity[c] = seen->light[0].intensity[c];
}

// Converts the brightness that a matte ball shows to power (relume_manifest.intensities).
static void find_power(struct acquisition *s)
{
    vec3 middle;
    double square = 0.0;
    (void)place_ball(s, &s->out->ball[0], &middle);
    for (int i = 0; i < s->shots; i++)
        square += vec3_dot(s->shot[i].position, s->shot[i].position) / s->shots;
    for (int i = 0; i < s->shots; i++) {
        const vec3 apart = vec3_sub(s->shot[i].position, middle);
        for (int c = 0; c < 3; c++)
            s->shot[i].intensity[c] *= (float)(vec3_dot(apart, apart) / square);
    }
}

// A mirror's outline that is too small turns lights away from the axis of view, some behind the
// ball: a mirror on a table shows the table's horizon as a circle, 0.71 of its outline.
static relume_status warn_below(struct acquisition *s)
{
    int below = 0;
    for (int i = 0; i < s->shots; i++)
        below += s->shot[i].direction.z < BELOW;
    if (!below || s->p.matte)
        return RELUME_OK;
    const struct relume_ball *b = &s->out->ball[0];
    return acquire_warn(s,
                        "ball at %.0f,%.0f with radius %.0f: this outline puts %d of the lights "
                        "behind it; is it the "
                        "outline of the ball, or a circle that the ball reflects (--ball x,y,r)?",
                        b->x, b->y, b->radius, below);
}

// What a ball that was searched for must show: in nearly every photograph one small highlight,
// alone in most, and not always in the same place. In light domes round things that are no mirrors
// (heads, coins, bears) show one in at most 3 of 4 photographs, and alone in at most 2 of 5; balls
// in all.
static const double SHOWN = 0.8, ALONE = 0.5;  // shares of the photographs
static const double MOVES = 2.0;               // degrees

static bool is_mirror(const struct acquisition *s, const struct relume_ball_light *light, int b)
{
    int shown = 0, alone = 0;
    double moves = 0.0;
    const vec3 *first = NULL;
    for (int i = 0; i < s->shots; i++) {
        const struct relume_ball_light *l = &light[(size_t)i * (size_t)s->out->balls + (size_t)b];
        if (objection(l, false))
            continue;
        first = first ? first : &l->direction;
        moves = fmax(moves, vec3_angle(*first, l->direction) * 180.0 / M_PI);
        shown++;
        alone += l->finding != RELUME_BALL_TWO;
    }
    return s->shots - shown <= fmax((1.0 - SHOWN) * s->shots, 1.0) && alone >= ALONE * s->shots &&
           moves > MOVES;
}

// Leaves out balls for which `keep` is false: light[shots][balls] becomes narrower.
static void keep_balls(struct acquisition *s, struct relume_ball_light *light, const bool *keep)
{
    struct relume_acquisition *out = s->out;
    const int balls = out->balls;
    int kept = 0;
    for (int k = 0, to = 0; k < s->shots * balls; k++)
        if (keep[k % balls])
            light[to++] = light[k];
    for (int b = 0; b < balls; b++)
        if (keep[b])
            out->ball[kept++] = out->ball[b];
    out->balls = kept;
}

// Fits the rays of two balls alone.
static relume_status compare_pair(struct rays_fit *fit, const struct acquisition *s,
                                  const struct relume_ball_light *light, int a, int b)
{
    struct ball_rays *rays = mem_zeroed((size_t)s->shots, sizeof *rays);
    if (!rays)
        return RELUME_ENOMEM;
    for (int i = 0; i < s->shots; i++) {
        const int both[] = {a, b};
        for (int k = 0; k < 2; k++) {
            const struct relume_ball_light *l =
                &light[(size_t)i * (size_t)s->out->balls + (size_t)both[k]];
            if (!objection(l, s->p.matte))
                add_ray(&rays[i], s, both[k], l);
        }
    }
    *fit = rays_compare(rays, s->shots);
    mem_free(rays);
    return RELUME_OK;
}

// Checks that all balls that were searched for are mirrors. Where no number was given, it keeps
// mirrors that are not much smaller than the largest and agree with its rays.
static relume_status check_mirrors(struct acquisition *s, struct relume_ball_light *light)
{
    const struct relume_acquisition *out = s->out;
    bool keep[MOST_BALLS];
    int first = -1, mirrors = 0;
    relume_status status = RELUME_OK;
    if (s->p.matte || s->p.ball || s->p.ball_mask)
        return RELUME_OK;
    for (int b = 0; b < out->balls; b++) {
        keep[b] = is_mirror(s, light, b);
        mirrors += keep[b];
        if (keep[b] && (first < 0 || out->ball[b].radius > out->ball[first].radius))
            first = b;
    }
    if (s->p.balls ? mirrors < out->balls : !mirrors)
        return no_ball(s);
    for (int b = 0; !s->p.balls && !status && b < out->balls; b++) {
        struct rays_fit fit = {0};
        if (b != first && keep[b])
            status = compare_pair(&fit, s, light, first, b);
        keep[b] &= out->ball[b].radius >= SMALLEST * out->ball[first].radius &&
                   fit.near * 180.0 / M_PI < DISAGREE;
    }
    if (!status)
        keep_balls(s, light, keep);
    return status;
}

static const double LEAST_LEFT = 0.4;  // share of the photographs that show the lamp

// Photographs whose balls show no lamp are left out; that many must show one.
static relume_status check_enough(const struct acquisition *s,
                                  const struct relume_ball_light *light)
{
    const int balls = s->out->balls;
    const struct relume_ball *ball = &s->out->ball[0];
    const char *why = NULL;
    int good = 0, first = 0;
    for (int i = 0; i < s->shots; i++) {
        const char *objects = NULL;
        for (int b = 0; b < balls && (!b || objects); b++)
            objects = objection(&light[(size_t)i * (size_t)balls + (size_t)b], s->p.matte);
        good += !objects;
        if (objects && !why) {
            why = objects;
            first = i;
        }
    }
    if (!why || (good >= 3 && good >= LEAST_LEFT * s->shots))
        return RELUME_OK;
    return log_fail(s->p.log, RELUME_EUNFIT,
                    "%s: %s on the ball at %.0f,%.0f with radius %.0f; %d of %d photographs show "
                    "the lamp there, expected at least 3 and %.0f %%; give --ball x,y,r, or "
                    "--lights FILE",
                    ball_photo(&s->shot[first]), why, ball->x, ball->y, ball->radius, good,
                    s->shots, 100.0 * LEAST_LEFT);
}

// A window or a lamp of the room shows in all photographs: then most show two highlights, and the
// one that stays is left out.
static relume_status leave_still_out(struct acquisition *s, struct relume_ball_light *light)
{
    const int balls = s->out->balls;
    bool often = false;
    for (int b = 0; b < balls; b++) {
        int twice = 0;
        for (int i = 0; i < s->shots; i++)
            twice += light[i * balls + b].finding == RELUME_BALL_TWO;
        often |= 2 * twice > s->shots;
    }
    if (s->p.matte || !often)
        return RELUME_OK;
    s->still = true;
    return look_all(s, light);
}

// ---------------------------------------------------------------- one ball

static relume_status measure_ramp(double *distance, const struct acquisition *s, vec3 origin)
{
    const struct relume_image **small = mem_array((size_t)s->shots, sizeof *small);
    vec3 *direction = mem_array((size_t)s->shots, sizeof *direction);
    relume_status status = small && direction ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < s->shots; i++) {
        small[i] = &s->shot[i].small;
        direction[i] = s->shot[i].direction;
    }
    const struct relume_ball *ball;
    const int balls = acquire_balls_inside(&ball, s);
    const struct ramp_search search = {.small = small,
                                       .direction = direction,
                                       .origin = origin,
                                       .count = s->shots,
                                       .step = acquire_small_step(s->width, s->height),
                                       .ball = ball,
                                       .balls = balls};
    *distance = 0.0;
    if (!status)
        status = ramp_find(distance, &search);
    mem_free(small);
    mem_free(direction);
    return status;
}

// Returns how far a plane under lamps at that distance bends at its border, degrees, if they count
// as distant. The slope there is the ramp over the light from the side.
static double bend_of(const struct acquisition *s, double distance)
{
    double height = 0.0;
    for (int i = 0; i < s->shots; i++)
        height += fmax(s->shot[i].direction.z, 0.0) / s->shots;
    return atan(3.0 * height / distance) * 180.0 / M_PI;
}

static relume_status warn_ramp(struct acquisition *s, vec3 origin, const char *mend)
{
    double distance = 0.0;
    relume_status status = RELUME_OK;
    if (!s->p.distant && !s->p.near)
        status = measure_ramp(&distance, s, origin);
    if (status || !(distance > 0.0))
        return status;
    return acquire_warn(
        s,
        "brightness falls across the photographs as under lamps about %.1f widths of "
        "the picture away: taken as distant, a plane bends by about %.0f degrees at "
        "its border; %s",
        0.5 * distance, bend_of(s, distance), mend);
}

// Places all lamps at one distance.
static relume_status place_by_ramp(struct acquisition *s, const struct ball_rays *rays)
{
    double distance;
    const relume_status status = measure_ramp(&distance, s, rays[0].origin[0]);
    if (status)
        return status;
    if (!(distance > 0.0))
        return log_fail(
            s->p.log, RELUME_EUNFIT,
            "positions of near lights need two balls or more, or one ball on a flat matte "
            "surface over which the brightness shows how far they are; found 1 ball");
    for (int i = 0; i < s->shots; i++) {
        s->shot[i].position = ramp_place(rays[i].origin[0], rays[i].direction[0], distance);
        s->shot[i].position_sigma = RAMP_ERROR * distance;
    }
    log_line(
        s->p.log, RELUME_NOTE,
        "the lamps stand about %.1f widths of the picture away, by how brightness falls across "
        "it: all at this distance, which a second ball would measure for each",
        0.5 * distance);
    return RELUME_OK;
}

// Lamps so near that the balls see them in different directions get positions.
static relume_status decide_near(struct acquisition *s, const struct ball_rays *rays)
{
    const struct rays_fit fit = rays_compare(rays, s->shots);
    const double disagree = 2.0 * fit.distant * 180.0 / M_PI;
    if (s->p.near)
        return RELUME_OK;
    if (s->out->balls == 1)
        return warn_ramp(s, rays[0].origin[0],
                         "--near places all lamps at that distance, a second ball each of them");
    if (!rays_show_near(&fit))
        return disagree > DISAGREE
                   ? acquire_warn(s,
                                  "the balls disagree by %.1f degrees, and not as near lights do",
                                  disagree)
                   : RELUME_OK;
    if (s->p.distant || s->p.refine_lights)
        return acquire_warn(s,
                            "the lamps stand near, about %.1f widths of the picture away: %s takes "
                            "them as distant",
                            0.5 * fit.distance, s->p.distant ? "--distant" : "--refine-lights");
    s->p.near = true;
    log_line(s->p.log, RELUME_NOTE,
             "the lamps stand near, about %.1f widths of the picture away, by %d balls: positions "
             "(--distant makes directions)",
             0.5 * fit.distance, s->out->balls);
    return RELUME_OK;
}

// Scales the errors by how much the balls disagree. The balls' own estimates count as STATED
// photographs. All balls share one more error: lamps are brightest beside their middle.
static void judge_errors(struct acquisition *s, const struct ball_rays *rays)
{
    const struct rays_fit fit = rays_compare(rays, s->shots);
    const double found = (s->p.near ? fit.near : fit.distant) * sqrt(2.0) * 180.0 / M_PI;
    double stated = 0.0;
    int several = 0;
    for (int i = 0; i < s->shots; i++)
        if (rays[i].n > 1) {
            stated += s->shot[i].sigma_deg * s->shot[i].sigma_deg * rays[i].n;
            several++;
        }
    const double own = fmax(stated / fmax(several, 1.0), 1e-12);
    const double ratio = several ? found * found / own : 1.0;
    const double scale = sqrt((several * ratio + STATED) / (several + STATED));
    for (int i = 0; i < s->shots; i++)
        s->shot[i].sigma_deg =
            hypot(scale * s->shot[i].sigma_deg, UNEVEN * s->shot[i].light.spread_deg);
}

static relume_status place_lamps(struct acquisition *s, const struct ball_rays *rays)
{
    vec3 *position = mem_array((size_t)s->shots, sizeof *position);
    double *sigma = mem_array((size_t)s->shots, sizeof *sigma), squares = 0.0;
    relume_status status = position && sigma ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; i < s->shots; i++)
        squares += s->shot[i].sigma_deg * s->shot[i].sigma_deg * rays[i].n / s->shots;
    const double error = sqrt(squares / 2.0) * M_PI / 180.0;  // of one ray along one axis
    if (!status && !rays_place(position, sigma, rays, s->shots, error))
        status = log_fail(s->p.log, RELUME_EUNFIT,
                          "%s: the directions from %d balls do not cross at a lamp; expected two "
                          "balls or more that show it, and a lamp near enough to measure",
                          s->shot[0].path, s->out->balls);
    for (int i = 0; !status && i < s->shots; i++) {
        s->shot[i].position = position[i];
        s->shot[i].position_sigma = sigma[i];
    }
    mem_free(position);
    mem_free(sigma);
    return status;
}

static relume_status locate_all(struct acquisition *s, const struct relume_ball_light *light)
{
    const int shots = s->shots, balls = s->out->balls;
    const struct relume_ball *ball = &s->out->ball[0];
    struct ball_rays *rays = mem_array((size_t)shots, sizeof *rays);
    relume_status status = rays ? RELUME_OK : RELUME_ENOMEM;
    for (int k = 0, i = 0; !status && k < shots; k++) {
        struct ball_lights seen;
        const struct relume_ball_light *of = light + (size_t)k * (size_t)balls;
        const char *why = gather(s, of, &seen);
        if (!seen.rays.n) {
            status =
                acquire_drop(s, i, true, "%s on the ball at %.0f,%.0f with radius %.0f%s%s", why,
                             ball->x, ball->y, ball->radius, s->shot[i].ball_path ? " in " : "",
                             s->shot[i].ball_path ? s->shot[i].ball_path : "");
            continue;
        }
        status = warn_highlights(s, i, of);
        average(&s->shot[i], &seen);
        rays[i++] = seen.rays;
    }
    if (!status)
        status = decide_near(s, rays);
    if (!status)
        judge_errors(s, rays);
    if (!status && s->p.near)
        status = s->out->balls > 1 ? place_lamps(s, rays) : place_by_ramp(s, rays);
    if (!status && s->p.near && s->p.matte)
        find_power(s);
    mem_free(rays);
    return status ? status : warn_below(s);
}

static relume_status lights_from_balls(struct acquisition *s)
{
    relume_status status = find_balls(s);
    if (status)
        return status;
    struct relume_ball_light *light =
        mem_zeroed((size_t)s->shots * (size_t)s->out->balls, sizeof *light);
    status = light ? look_all(s, light) : RELUME_ENOMEM;
    if (!status)
        status = leave_still_out(s, light);
    if (!status)
        status = check_mirrors(s, light);
    if (!status)
        status = check_enough(s, light);
    if (!status && s->still)
        log_line(s->p.log, RELUME_NOTE,
                 "the ball shows a second reflection; one that never moves is left out");
    if (!status)
        status = warn_cut_off(s);
    if (!status)
        status = locate_all(s, light);
    s->has_intensities = s->p.matte;
    mem_free(light);
    return status;
}

// ---------------------------------------------------------------- a file

static bool is_lp(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && !strcasecmp(dot, ".lp");
}

// A list without names gives its lights to photographs in the order of their names, or in the order
// of the command line. order[photographs].
static void take_places(const struct acquisition *s, int *order)
{
    const int n = s->photographs.count;
    const char *first = "", *last = "";
    for (int i = 0; i < n; i++) {
        order[i] = s->given_index ? s->given_index[i] : i;
        first = order[i] == 0 ? path_name(s->photographs.path[i]) : first;
        last = order[i] == n - 1 ? path_name(s->photographs.path[i]) : last;
    }
    if (s->named_singly)
        log_line(s->p.log, RELUME_NOTE,
                 "%s: its lights are taken in the order %s: light 1 is that of '%.60s', light %d, "
                 "the last, that of '%.60s'",
                 s->p.lights,
                 s->given_index ? "in which photographs were given" : "of the photographs' names",
                 first, n, last);
}

// order[photographs] = light of the list, by name where the list has names; -1: none.
static relume_status pair_photographs(const struct acquisition *s, const struct loaded_lights *list,
                                      int *order, bool *by_name)
{
    const struct light_names names = loaded_lights_names(list, s->p.lights);
    const char *const *photographs = (const char *const *)s->photographs.path;
    const int n = s->photographs.count;
    int matched;
    const relume_status status =
        light_names_pair_all(order, &matched, &names, photographs, n, s->p.log);
    *by_name = matched > 0;
    if (!status && !matched)
        take_places(s, order);
    if (!status && matched && matched < n && !s->p.skip_bad)
        return light_names_refuse(&names, order, photographs, n,
                                  "--skip-bad leaves out photographs without a light", s->p.log);
    return status;
}

static void take_light(struct shot *shot, const struct relume_captured_lights *list, int k)
{
    shot->direction = list->direction[k];
    shot->position = list->position ? list->position[k] : list->direction[k];
    for (int c = 0; c < 3; c++)
        shot->intensity[c] = list->intensity ? list->intensity[k][c] : 1.0f;
}

// order[photographs] says which light of the list belongs to a photograph.
static relume_status take_lights(struct acquisition *s, const struct relume_captured_lights *list,
                                 const int *order)
{
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < s->shots;) {
        const int k = order[s->shot[i].number];
        if (k >= 0)
            take_light(&s->shot[i++], list, k);
        else
            status = acquire_drop(s, i, s->p.skip_bad, "%s names no light for it", s->p.lights);
    }
    s->has_intensities = list->intensity != NULL;
    return status;
}

void acquire_turn_lights(struct acquisition *s, int orientation)
{
    for (int i = 0; i < s->shots; i++) {
        struct shot *shot = &s->shot[i];
        double d[] = {shot->direction.x, shot->direction.y};
        double p[] = {shot->position.x, shot->position.y};
        photograph_turn_vector(d, orientation);
        photograph_turn_vector(p, orientation);
        shot->direction = vec3_of(d[0], d[1], shot->direction.z);
        shot->position = vec3_of(p[0], p[1], shot->position.z);
    }
}

// Directions that came with the files of the photographs are those of the picture as it lies there.
static void turn_listed(struct acquisition *s)
{
    if (s->orientation <= 1)
        return;
    acquire_turn_lights(s, s->orientation);
    s->turned = true;
    log_line(s->p.log, RELUME_NOTE,
             "%s: its lights are turned with the photographs (EXIF orientation %d)", s->p.lights,
             s->orientation);
}

// Positions look like directions that are not of unit length.
static void mention_near(const struct acquisition *s, const struct loaded_lights *list)
{
    if (!s->p.near && (!list->unit || strcasestr(path_name(s->p.lights), "position")))
        log_line(s->p.log, RELUME_NOTE,
                 "%s: is read as light directions; add --near where it holds the positions of "
                 "lamps",
                 s->p.lights);
}

// A list that has been read already, whose lights are in the order of the photographs.
static void take_listed(struct acquisition *s)
{
    for (int i = 0; i < s->shots; i++) {
        s->shot[i].direction = s->shot[i].position = s->listed->direction[s->shot[i].number];
        for (int c = 0; c < 3; c++)
            s->shot[i].intensity[c] = 1.0f;
    }
    if (s->listed->turns)
        turn_listed(s);
}

static relume_status lights_from_file(struct acquisition *s)
{
    if (s->listed) {
        take_listed(s);
        return RELUME_OK;
    }
    struct loaded_lights list = {0};
    bool by_name = false;
    int *order = mem_array((size_t)s->photographs.count, sizeof *order);
    relume_status status =
        order ? loaded_lights_load(&list, s->p.lights, s->p.near, s->p.log) : RELUME_ENOMEM;
    if (!status)
        status = pair_photographs(s, &list, order, &by_name);
    if (!status)
        status = take_lights(s, &list.lights, order);
    if (!status && by_name && is_lp(s->p.lights))
        turn_listed(s);
    if (!status)
        mention_near(s, &list);
    mem_free(order);
    loaded_lights_free(&list);
    return status;
}

// ---------------------------------------------------------------- both

// Photographs of other exposures show their lights brighter or darker; the brightness that a matte
// ball measures includes that.
static relume_status weigh_exposures(struct acquisition *s)
{
    double least = INFINITY, most = 0.0, sum = 0.0;
    for (int i = 0; i < s->shots; i++) {
        const double e = relume_exif_exposure(&s->shot[i].notes);
        least = fmin(least, e);
        most = fmax(most, e);
        sum += e;
    }
    if ((s->p.matte && !s->p.lights) || !(least > 0.0) || most < 1.02 * least)
        return RELUME_OK;
    for (int i = 0; i < s->shots; i++)
        for (int c = 0; c < 3; c++) {
            const float e = (float)(relume_exif_exposure(&s->shot[i].notes) * s->shots / sum);
            s->shot[i].intensity[c] = (s->has_intensities ? s->shot[i].intensity[c] : 1.0f) * e;
        }
    s->has_intensities = true;
    return acquire_warn(s,
                        "the photographs are exposed differently, by up to a factor of %.2f; "
                        "brightness is divided by what the camera noted",
                        most / least);
}

relume_status acquire_find_lights(struct acquisition *s)
{
    relume_status status = !s->p.lights                     ? lights_from_balls(s)
                           : acquire_has_poses(s->p.lights) ? acquire_lights_from_poses(s)
                                                            : lights_from_file(s);
    if (!status && s->p.lights && !acquire_has_poses(s->p.lights))
        status = acquire_ask_balls(s);
    if (!status && s->p.lights)
        status = warn_ramp(s, vec3_of(0.0, 0.0, 0.0), "--near takes positions from the list");
    return status ? status : weigh_exposures(s);
}

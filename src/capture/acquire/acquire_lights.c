// acquire_lights.c - where the lights of the photographs were
#include "core/base/tree.h"
#include "capture/acquire/acquire.h"

#include "capture/acquire/ball.h"
#include "capture/manifest/loaded_lights.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "image/image/photograph.h"

#include <stdio.h>
#include <string.h>

enum { MOST_BALLS = 16 };
static const double TOO_WIDE = 12.0;  // degrees: what is that wide is no lamp in a mirror
static const double DISAGREE = 3.0;   // degrees between balls: lights are near
static const double BELOW = -0.05;    // z of a direction: the lamp stood behind the ball

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

// Take the candidates that show the lamp best and do not overlap, the first of equals; returns how
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
    relume_status status = add_candidates(&t, s, &s->mean, out->balls + CANDIDATES, params);
    double bad = take_best(out, &t);
    if (!status)
        status = seek_tables(s, &bad);
    if (!status && bad > (s->p.matte ? DOUBTFUL : 0.0)) {
        status = add_candidates(&t, s, &s->change, CANDIDATES, params);
        bad = take_best(out, &t);
        if (!status)
            status = seek_tables(s, &bad);
    }
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
    out->ball = mem_zeroed((size_t)out->balls, sizeof *out->ball);
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
    int n;
    struct relume_ball_light light[MOST_BALLS];
    vec3 origin[MOST_BALLS], direction[MOST_BALLS];
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

// The directions in which the balls show the lamp of photograph `i`; `why` the last one shows none.
static relume_status gather(struct acquisition *s, int i, const struct relume_ball_light *light,
                            struct ball_lights *to, const char **why)
{
    relume_status status = RELUME_OK;
    to->n = 0;
    *why = NULL;
    for (int b = 0; !status && b < s->out->balls; b++) {
        const struct relume_ball_light *l = &light[b];
        const char *objects = objection(l, s->p.matte);
        if (objects) {
            *why = objects;
            continue;
        }
        vec3 middle;
        const double radius = place_ball(s, &s->out->ball[b], &middle);
        to->light[to->n] = *l;
        to->origin[to->n] = vec3_along(middle, l->origin, radius);
        to->direction[to->n++] = l->direction;
        if (l->finding == RELUME_BALL_RIM || l->finding == RELUME_BALL_TWO)
            status = acquire_warn_alike(
                s, l->finding == RELUME_BALL_RIM ? ALIKE_RIM : ALIKE_TWO, 0.0,
                "%s: %s of the ball at %.0f,%.0f", ball_photo(&s->shot[i]),
                relume_ball_finding_text(l->finding), s->out->ball[b].x, s->out->ball[b].y);
    }
    return status;
}

// The mean direction; its error is how far several balls disagree.
static void average(struct shot *shot, const struct ball_lights *seen)
{
    vec3 sum = vec3_of(0.0, 0.0, 0.0);
    double squares = 0.0, formal = 0.0;
    for (int b = 0; b < seen->n; b++)
        sum = vec3_add(sum, seen->direction[b]);
    shot->direction = vec3_unit(sum);
    for (int b = 0; b < seen->n; b++) {
        const double off = vec3_angle(seen->direction[b], shot->direction) * 180.0 / M_PI;
        squares += off * off;
        formal += seen->light[b].sigma_deg * seen->light[b].sigma_deg;
    }
    const double n = seen->n;
    shot->sigma_deg = fmax(sqrt(formal) / n, n > 1 ? sqrt(squares / (n * (n - 1))) : 0.0);
    shot->light = seen->light[0];
    for (int c = 0; c < 3; c++)
        shot->intensity[c] = seen->light[0].intensity[c];
}

static relume_status locate(struct acquisition *s, int i, const struct ball_lights *seen,
                            double *disagree)
{
    struct shot *shot = &s->shot[i];
    average(shot, seen);
    for (int b = 0; b < seen->n; b++)
        *disagree = fmax(*disagree, vec3_angle(seen->direction[b], shot->direction) * 360.0 / M_PI);
    if (!s->p.near)
        return RELUME_OK;
    if (relume_light_triangulate(&shot->position, &shot->position_sigma, seen->origin,
                                 seen->direction, seen->n))
        return log_fail(s->p.log, RELUME_EUNFIT,
                        "%s: the directions from %d balls do not cross at a lamp; expected two "
                        "balls or more that show it, and a lamp near enough to measure",
                        shot->path, seen->n);
    return RELUME_OK;
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

// Where the balls' outlines were given, they are what somebody says they are.
static relume_status check_mirrors(const struct acquisition *s,
                                   const struct relume_ball_light *light)
{
    if (s->p.matte || s->p.ball || s->p.ball_mask)
        return RELUME_OK;
    for (int b = 0; b < s->out->balls; b++)
        if (!is_mirror(s, light, b))
            return no_ball(s);
    return RELUME_OK;
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
    int twice = 0;
    for (int i = 0; i < s->shots * balls; i++)
        twice += light[i].finding == RELUME_BALL_TWO;
    if (s->p.matte || 2 * twice <= s->shots * balls)
        return RELUME_OK;
    s->still = true;
    return look_all(s, light);
}

static relume_status locate_all(struct acquisition *s, const struct relume_ball_light *light)
{
    const int shots = s->shots;
    double disagree = 0.0;
    relume_status status = RELUME_OK;
    for (int k = 0, i = 0; !status && k < shots; k++) {
        struct ball_lights seen;
        const char *why;
        const struct relume_ball *ball = &s->out->ball[0];
        status = gather(s, i, light + (size_t)k * (size_t)s->out->balls, &seen, &why);
        if (!status && !seen.n)
            status =
                acquire_drop(s, i, true, "%s on the ball at %.0f,%.0f with radius %.0f%s%s", why,
                             ball->x, ball->y, ball->radius, s->shot[i].ball_path ? " in " : "",
                             s->shot[i].ball_path ? s->shot[i].ball_path : "");
        else if (!status)
            status = locate(s, i++, &seen, &disagree);
    }
    if (!status)
        status = warn_below(s);
    if (!status && !s->p.near && disagree > DISAGREE)
        status = acquire_warn(s,
                              "the balls disagree by up to %.1f degrees; near lights? --near "
                              "makes positions",
                              disagree);
    return status;
}

static relume_status lights_from_balls(struct acquisition *s)
{
    if (s->p.near && (s->p.ball || s->p.balls ? s->p.balls : 1) < 2)
        return log_fail(s->p.log, RELUME_EINVAL,
                        "positions of near lights need two balls or more; found %d",
                        s->p.balls > 0 ? s->p.balls : 1);
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

// Directions that came with the files of the photographs are those of the picture as it lies there.
static void turn_lights(struct acquisition *s)
{
    for (int i = 0; i < s->shots; i++) {
        struct shot *shot = &s->shot[i];
        double d[] = {shot->direction.x, shot->direction.y};
        double p[] = {shot->position.x, shot->position.y};
        photograph_turn_vector(d, s->orientation);
        photograph_turn_vector(p, s->orientation);
        shot->direction = vec3_of(d[0], d[1], shot->direction.z);
        shot->position = vec3_of(p[0], p[1], shot->position.z);
    }
    if (s->orientation > 1)
        log_line(s->p.log, RELUME_NOTE,
                 "%s: its lights are turned with the photographs (EXIF orientation %d)",
                 s->p.lights, s->orientation);
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

static relume_status lights_from_file(struct acquisition *s)
{
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
        turn_lights(s);
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
    for (int i = 0; i < s->shots; i++)
        relume_image_destroy(&s->shot[i].luma);
    return status ? status : weigh_exposures(s);
}

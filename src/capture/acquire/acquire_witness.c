// acquire_witness.c - a ball in the photographs tells whether a list of lights is theirs
//
// Where lights come from a list, round things are looked for in the small pictures that
// registration keeps. One that shows a moving highlight in most photographs, in directions that
// fit the list (light_match.h), is a ball; others are left alone.
#include "capture/acquire/acquire.h"

#include "capture/acquire/light_match.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/tree.h"
#include "core/math/sort.h"

#include <stdio.h>

enum { CANDIDATES = 16, MOST_SEEN = 2 * CANDIDATES, TRIALS = 6, LEAST_SHOTS = 4 };
static const double SHOWN = 0.6;      // share of the photographs that show the lamp
static const double MOVES = 5.0;      // degrees
static const double TOO_WIDE = 20.0;  // degrees: no lamp in a small picture of a mirror
static const double HORIZON = 1.41;   // outline of a ball over the horizon of a table in it
static const float FAINT = 2e-4f;     // about one code of 8 bits in the dark
static const double DEVIATES = 8.0;   // degrees: a light that differs from its list
static const double OUTLIER = 5.0;    // times what lights usually differ
static const double SURELY = 20.0;    // degrees: so far off in the median, a list is refused
static const double UNSURE = 6.0;     // degrees: matte things that show lights worse are no balls

static const double FAVOUR = 3.0;  // degrees by which a right list is believed rather

struct witness {
    struct acquisition *s;
    struct relume_image *photo;  // [shots], linear, one channel
    struct relume_image mean, change, peak;
    struct relume_ball_camera camera;
    double scale;                 // pixels of a photograph over those of `photo`
    vec3 *list, *seen;            // [shots]
    double *angle, *best_angle;   // [shots]
    int *partner, *best_partner;  // [shots]
    struct light_match best;
    struct relume_ball ball;  // that match was found by
    bool matte;
};

static relume_status make_photo(struct witness *w, int i)
{
    const struct shot *shot = &w->s->shot[i];
    const double shift[2] = {shot->shift[0] / w->scale, shot->shift[1] / w->scale};
    struct relume_image *photo = &w->photo[i];
    const size_t n = (size_t)shot->luma.width * (size_t)shot->luma.height;
    relume_status status = relume_image_create(photo, shot->luma.width, shot->luma.height, 1);
    for (size_t k = 0; !status && k < n; k++)
        photo->data[k] = shot->luma.data[k] * shot->luma.data[k];
    return status ? status : acquire_move_back(photo, shift);
}

// Mean and RMS change of the logarithm, and the peak, as balls are looked for in them.
static relume_status sum_photos(struct witness *w)
{
    const int width = w->camera.width, height = w->camera.height, shots = w->s->shots;
    relume_status status = relume_image_create(&w->mean, width, height, 1);
    if (!status)
        status = relume_image_create(&w->change, width, height, 1);
    if (!status)
        status = relume_image_create(&w->peak, width, height, 1);
    for (size_t k = 0; !status && k < (size_t)width * (size_t)height; k++) {
        float sum = 0.0f, squares = 0.0f, peak = 0.0f;
        for (int i = 0; i < shots; i++) {
            const float v = w->photo[i].data[k], l = logf(v + FAINT);
            sum += l;
            squares += l * l;
            peak = fmaxf(peak, v);
        }
        const float mean = sum / (float)shots;
        w->mean.data[k] = expf(mean);
        w->change.data[k] = sqrtf(fmaxf(squares / (float)shots - mean * mean, 0.0f));
        w->peak.data[k] = peak;
    }
    return status;
}

static relume_status create(struct witness *w)
{
    struct acquisition *s = w->s;
    const size_t n = (size_t)s->shots;
    const struct relume_image *luma = &s->shot[0].luma;
    w->camera = (struct relume_ball_camera){.width = luma->width, .height = luma->height};
    w->scale = (double)s->width / luma->width;
    if (s->p.fov_deg > 0.0)
        w->camera.focal_px = 0.5 * luma->width / tan(s->p.fov_deg * M_PI / 360.0);
    w->photo = mem_zeroed(n, sizeof *w->photo);
    w->list = mem_array(n, sizeof *w->list);
    w->seen = mem_array(n, sizeof *w->seen);
    w->angle = mem_array(n, sizeof *w->angle);
    w->best_angle = mem_array(n, sizeof *w->best_angle);
    w->partner = mem_array(n, sizeof *w->partner);
    w->best_partner = mem_array(n, sizeof *w->best_partner);
    if (!w->photo || !w->list || !w->seen || !w->angle || !w->best_angle || !w->partner ||
        !w->best_partner)
        return RELUME_ENOMEM;
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < s->shots; i++)
        status = make_photo(w, i);
    return status ? status : sum_photos(w);
}

static void destroy(struct witness *w)
{
    for (int i = 0; w->photo && i < w->s->shots; i++)
        relume_image_destroy(&w->photo[i]);
    relume_image_destroy(&w->mean);
    relume_image_destroy(&w->change);
    relume_image_destroy(&w->peak);
    mem_free(w->photo);
    mem_free(w->list);
    mem_free(w->seen);
    mem_free(w->angle);
    mem_free(w->best_angle);
    mem_free(w->partner);
    mem_free(w->best_partner);
}

// ---------------------------------------------------------------- one round thing

static relume_status look(struct relume_ball_light *light, const struct witness *w, int i,
                          const struct relume_ball *ball, bool matte)
{
    return matte ? relume_ball_matte(light, ball, &w->camera, &w->photo[i])
                 : relume_ball_mirror(light, ball, &w->camera, &w->photo[i], NULL);
}

static bool shows_lamp(const struct relume_ball_light *l, bool matte)
{
    return l->finding != RELUME_BALL_DARK && l->finding != RELUME_BALL_FULL &&
           l->finding != RELUME_BALL_RIM &&
           (matte ? l->sigma_deg < UNSURE : l->spread_deg < TOO_WIDE);
}

// Most round things show no lamp in the first photographs; these are skipped.
static relume_status promises(bool *out, const struct witness *w, const struct relume_ball *ball,
                              bool matte)
{
    const int shots = w->s->shots, trials = shots < TRIALS ? shots : TRIALS;
    relume_status status = RELUME_OK;
    int shown = 0;
    for (int i = 0; !status && i < trials; i++) {
        struct relume_ball_light light;
        status = look(&light, w, i * shots / trials, ball, matte);
        shown += !status && shows_lamp(&light, matte);
    }
    *out = 2 * shown >= trials;
    return status;
}

// Fills w->seen; returns the usual error of the directions, negative where the thing shows too few
// lamps or always the same direction.
static relume_status watch(struct witness *w, const struct relume_ball *ball, bool matte,
                           double *sigma)
{
    relume_status status = RELUME_OK;
    int shown = 0;
    double moves = 0.0;
    const vec3 *first = NULL;
    *sigma = 0.0;
    for (int i = 0; !status && i < w->s->shots; i++) {
        struct relume_ball_light light;
        w->seen[i] = vec3_of(0, 0, 0);
        status = look(&light, w, i, ball, matte);
        if (status || !shows_lamp(&light, matte))
            continue;
        w->seen[i] = light.direction;
        first = first ? first : &w->seen[i];
        moves = fmax(moves, vec3_angle(*first, w->seen[i]) * 180.0 / M_PI);
        *sigma += light.sigma_deg;
        shown++;
    }
    *sigma = shown >= SHOWN * w->s->shots && moves > MOVES ? *sigma / shown : -1.0;
    return status;
}

// Positions and directions as a ball at z = 0 sees them.
static vec3 place_of(const struct witness *w, const struct relume_ball *ball)
{
    return vec3_of(2.0 * ball->x / w->camera.width - 1.0,
                   (w->camera.height - 2.0 * ball->y) / w->camera.width, w->s->p.ball_z);
}

static bool is_better(const struct light_match *a, const struct light_match *b)
{
    if (a->kind == LIGHT_MATCH_NONE || b->kind == LIGHT_MATCH_NONE)
        return a->kind != LIGHT_MATCH_NONE;
    return a->left - (a->kind == LIGHT_MATCH_SAME ? FAVOUR : 0.0) <
           b->left - (b->kind == LIGHT_MATCH_SAME ? FAVOUR : 0.0);
}

static relume_status ask(struct witness *w, struct relume_ball ball, bool matte)
{
    bool is;
    double sigma = -1.0;
    relume_status status = promises(&is, w, &ball, matte);
    if (!status && is)
        status = watch(w, &ball, matte, &sigma);
    if (status || sigma < 0.0)
        return status;
    struct light_match match;
    const vec3 place = place_of(w, &ball);
    light_match(&match, w->angle, w->partner, w->list, w->seen, w->s->shots, sigma,
                w->s->p.near ? &place : NULL);
    if (!is_better(&match, &w->best))
        return RELUME_OK;
    w->best = match;
    w->ball = ball;
    w->matte = matte;
    double *angle = w->angle;
    int *partner = w->partner;
    w->angle = w->best_angle;
    w->partner = w->best_partner;
    w->best_angle = angle;
    w->best_partner = partner;
    return RELUME_OK;
}

static relume_status ask_given(struct witness *w)
{
    relume_status status = RELUME_OK;
    for (int b = 0; !status && b < w->s->p.balls; b++) {
        const double *c = w->s->p.ball[b];
        status = ask(
            w, relume_ball_outlined(c[0] / w->scale, c[1] / w->scale, c[2] / w->scale, &w->camera),
            w->s->p.matte);
    }
    return status;
}

static relume_status ask_found(struct witness *w, const struct relume_image *picture, bool matte)
{
    struct relume_ball ball[CANDIDATES];
    int found;
    const struct relume_ball_params p = {.peak = matte ? NULL : &w->peak};
    relume_status status =
        relume_ball_candidates(ball, CANDIDATES, &found, picture, &w->camera, &p);
    for (int b = 0; !status && b < found; b++) {
        status = ask(w, ball[b], matte);
        if (!status && !matte && !w->camera.focal_px)
            status = ask(
                w, relume_ball_outlined(ball[b].x, ball[b].y, HORIZON * ball[b].radius, &w->camera),
                false);
    }
    return status;
}

static relume_status ask_all(struct witness *w)
{
    if (w->s->p.ball)
        return ask_given(w);
    relume_status status = ask_found(w, &w->mean, w->s->p.matte);
    if (!status && w->best.kind == LIGHT_MATCH_NONE)
        status = ask_found(w, &w->change, w->s->p.matte);
    if (!status && w->best.kind == LIGHT_MATCH_NONE && !w->s->p.matte)
        status = ask_found(w, &w->mean, true);
    return status;
}

// ---------------------------------------------------------------- the verdict

static double usual_angle(const struct witness *w)
{
    double *sorted = w->angle;  // of another round thing, not needed any more
    int n = 0;
    for (int i = 0; i < w->s->shots; i++)
        if (!isnan(w->best_angle[i]))
            sorted[n++] = w->best_angle[i];
    sort_doubles(sorted, (size_t)n);
    return n ? sorted[n / 2] : 0.0;
}

static relume_status name_strays(struct witness *w)
{
    struct acquisition *s = w->s;
    const double most = fmax(DEVIATES, OUTLIER * usual_angle(w));
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < s->shots; i++) {
        char fits[512] = "";
        if (!(w->best_angle[i] > most))
            continue;
        s->shot[i].misfit = s->shot[i].stray = true;
        const int k = w->best_partner[i];
        if (k >= 0 && k != i)
            snprintf(fits, sizeof fits, "; it shows the light that the list gives to %.400s",
                     path_name(s->shot[k].path));
        status =
            acquire_warn_alike(s, ALIKE_STRAY, w->best_angle[i],
                               "%s: the ball shows its light %.0f degrees from where %s has "
                               "it%s",
                               s->shot[i].path, w->best_angle[i], path_name(s->p.lights), fits);
    }
    return status;
}

// Names one exchange of lights, as an example.
static void name_exchange(const struct witness *w, char *out, size_t size)
{
    *out = 0;
    for (int i = 0; i < w->s->shots; i++) {
        const int k = w->best_partner[i];
        if (k >= 0 && k != i) {
            snprintf(out, size, ": %.200s has the light that belongs to %.200s, and so on",
                     path_name(w->s->shot[k].path), path_name(w->s->shot[i].path));
            return;
        }
    }
}

static relume_status refuse(const struct witness *w)
{
    const struct light_match *m = &w->best;
    const char *path = w->s->p.lights;
    const double x = w->scale * w->ball.x, y = w->scale * w->ball.y;
    char example[512] = "";
    if (m->kind == LIGHT_MATCH_ORDER)
        name_exchange(w, example, sizeof example);
    if (m->half_turn || (m->kind != LIGHT_MATCH_UNIT && m->off < SURELY))
        return acquire_warn(w->s,
                            "%s: the ball at %.0f,%.0f shows lights %.0f degrees elsewhere; the "
                            "list fits to %.1f degrees if %s%s",
                            path, x, y, m->off, m->left, m->mend,
                            m->half_turn ? ", or that round thing is hollow" : "");
    return log_fail(w->s->p.log, RELUME_EUNFIT,
                    "%s: the ball at %.0f,%.0f shows lights %.0f degrees elsewhere; the list fits "
                    "to %.1f degrees if %s%s; mend the list, or take the lights from the ball: "
                    "%s--ball %.0f,%.0f,%.0f without --lights",
                    path, x, y, m->off, m->left, m->mend, example, w->matte ? "--matte " : "", x, y,
                    w->scale * w->ball.radius);
}

static relume_status judge(struct witness *w)
{
    const struct light_match *m = &w->best;
    struct acquisition *s = w->s;
    s->witnessed = m->kind == LIGHT_MATCH_SAME;
    if (m->kind == LIGHT_MATCH_NONE)
        return RELUME_OK;
    if (m->kind != LIGHT_MATCH_SAME)
        return refuse(w);
    s->witness = (struct relume_ball){
        .x = w->scale * w->ball.x, .y = w->scale * w->ball.y, .radius = w->scale * w->ball.radius};
    log_line(s->p.log, RELUME_NOTE, "%s: agrees with the ball at %.0f,%.0f to %.1f degrees",
             s->p.lights, w->scale * w->ball.x, w->scale * w->ball.y, m->left);
    return name_strays(w);
}

static relume_status compare(struct witness *w)
{
    const struct acquisition *s = w->s;
    w->best = (struct light_match){.kind = LIGHT_MATCH_NONE};
    for (int i = 0; i < s->shots; i++)
        w->list[i] = s->p.near ? s->shot[i].position : s->shot[i].direction;
    return ask_all(w);
}

// Some programs turn photographs before they look for lights: their lists fit as they are.
static relume_status try_upright(struct witness *w)
{
    static const int back[] = {1, 1, 2, 3, 4, 5, 8, 7, 6};  // of EXIF orientations
    struct acquisition *s = w->s;
    acquire_turn_lights(s, back[s->orientation]);
    const relume_status status = compare(w);
    if (!status && w->best.kind == LIGHT_MATCH_SAME) {
        log_line(s->p.log, RELUME_NOTE,
                 "%s: by the ball its lights are those of the upright photographs; not turned",
                 s->p.lights);
        return RELUME_OK;
    }
    acquire_turn_lights(s, s->orientation);
    return status ? status : compare(w);
}

relume_status acquire_ask_balls(struct acquisition *s)
{
    struct witness w = {.s = s};
    if (s->shots < LEAST_SHOTS || !s->shot[0].luma.data || s->p.align)
        return RELUME_OK;
    relume_status status = create(&w);
    if (!status)
        status = compare(&w);
    if (!status && s->turned && w.best.kind != LIGHT_MATCH_SAME)
        status = try_upright(&w);
    if (!status)
        status = judge(&w);
    destroy(&w);
    return status;
}

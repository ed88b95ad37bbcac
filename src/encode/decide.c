// decide.c - principal components, or the pictures themselves: what takes fewer bytes with loss
#include <relume/pack.h>

#include "base/memory.h"
#include "base/params.h"
#include "coder/basis.h"
#include "coder/codes.h"
#include "coder/coefficients.h"
#include "encode/rate.h"
#include "math/scalar.h"
#include "team/gather.h"

#include <math.h>
#include <string.h>

// Truncation is to cost little beside coding, which makes more components than these nearly free
// but for their functions in the header; and a usual target where bytes are asked for.
enum { LEAST_COMPONENTS = 27, NUGGET = 2 };
static const double SPARE_DB = 3.0, LEAST_SPARE_DB = 0.5, USUAL_DB = 40.0;

// What pictures must be better by at the same size, since components predict unseen lights better
// from planes that are as good.
static const double WORTH_IT_DB = 0.5;

// Where components are so few that they should win, a window of one view is looked at first, and
// all of it only when pictures are not worse there by more than this. It is smaller where there are
// more planes than that.
enum { WINDOW = 256, MANY_PLANES = 320, MOST_PLANES = 1200 };
static const double PLAUSIBLE_DB = 1.0;

// Of a number of the functions, as text in the header, twelve bits each.
enum { BYTES_EACH = 2 };

static double wanted(const struct relume_pack_encode_params *p)
{
    return p->psnr_db > 0.0 ? p->psnr_db : USUAL_DB;
}

// What is asked for, of the planes of one view.
static struct rate_target target_of_view(const relume_capture *capture,
                                         const struct relume_pack_encode_params *p)
{
    const double pixels =
        (double)relume_capture_width(capture) * (double)relume_capture_height(capture);
    return (struct rate_target){.psnr_db = p->psnr_db, .bytes = p->bytes_per_pixel * pixels};
}

// A view's share of the functions.
static double header_bytes(const relume_coder *coder, int views)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    return info->basis->learned ? 3.0 * info->coefficients * info->functions * BYTES_EACH / views
                                : 0.0;
}

// ---------------------------------------------------------------- a window

// The middle of a view, as a coder's codes before and after loss.
struct look {
    relume_coefficients *coefficients;
    struct captured captured;
    uint16_t *before, *after;  // [planes][height][width]
    size_t bytes;
};

static void look_away(struct look *l)
{
    relume_coefficients_destroy(&l->coefficients);
    captured_destroy(&l->captured);
    mem_free(l->before);
    mem_free(l->after);
}

static struct relume_rect window_of(const relume_capture *capture, int planes)
{
    const int width = relume_capture_width(capture), height = relume_capture_height(capture);
    const int side = planes > MANY_PLANES ? WINDOW / 2 : WINDOW;
    struct relume_rect w = {.width = smaller_of(side, width), .height = smaller_of(side, height)};
    w.left = (width - w.width) / 2;
    w.top = (height - w.height) / 2 / BAND_ROWS * BAND_ROWS;
    return w;
}

static relume_status look_at(struct look *l, const relume_coder *coder,
                             const relume_capture *capture, const struct relume_rect *at,
                             const struct relume_encode_params *encode)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    const size_t size = (size_t)coder->info.planes * (size_t)at->width * (size_t)at->height;
    const struct av1_effort effort = {RATE_FIRST_GUESS, AV1_FAST};
    relume_status status = encode_some_rows(&l->coefficients, coder, capture, m->views / 2, at->top,
                                            at->height, encode);
    if (!status)
        status = coefficients_share_steps(&l->coefficients, 1, false, RELUME_STEP_COMMON);
    if (!status)
        status = captured_create(&l->captured, coder, m->directions, m->lights);
    l->before = mem_array(size, sizeof *l->before);
    l->after = mem_array(size, sizeof *l->after);
    if (!status)
        status = l->before && l->after ? lossy_try(l->before, l->after, &l->bytes, l->coefficients,
                                                   at, &effort, encode->threads, encode->log)
                                       : RELUME_ENOMEM;
    return status;
}

// A row of a window, a channel of it under all lights: shown[light][x], display values.
static void show(float *shown, float *planes, const struct look *l, const uint16_t *codes,
                 const struct relume_rect *at, int row, int channel)
{
    const struct relume_coefficients_info *info = relume_coefficients_info(l->coefficients);
    const size_t width = (size_t)at->width, size = width * (size_t)at->height;
    for (size_t k = 0; k < (size_t)info->planes; k++)
        codes_restore(planes + k * width, RELUME_STORE_12, codes, k * size + (size_t)row * width,
                      width, info->scale[k], info->offset[k]);
    captured_predict(&l->captured, info->coder, channel, planes, width, width, shown);
}

// The PSNR of what `l` shows of a window; `truth` has the pictures.
static relume_status judge_look(double *psnr_db, const struct look *l, const struct look *truth,
                                const struct relume_rect *at)
{
    const size_t n = (size_t)l->captured.lights * (size_t)at->width;
    const int planes = relume_coefficients_info(truth->coefficients)->planes;
    float *work = mem_array((size_t)planes, (size_t)at->width * sizeof *work);
    float *want = mem_array(n, sizeof *want), *got = mem_array(n, sizeof *got);
    const bool good = work && want && got;
    double square = 0.0;
    for (int i = 0; good && i < 3 * at->height; i++) {
        show(want, work, truth, truth->before, at, i / 3, i % 3);
        show(got, work, l, l->after, at, i / 3, i % 3);
        for (size_t k = 0; k < n; k++) {
            const double d = (double)fminf(fmaxf(want[k], 0.0f), 1.0f) -
                             (double)fminf(fmaxf(got[k], 0.0f), 1.0f);
            square += d * d;
        }
    }
    *psnr_db = decibels(square / (3.0 * (double)n * at->height));
    mem_free(work);
    mem_free(want);
    mem_free(got);
    return good ? RELUME_OK : RELUME_ENOMEM;
}

// Components and pictures, of which the first member of a team looks at a window.
struct looking {
    const relume_coder *components, *pictures;
    const relume_capture *capture;
    const struct relume_pack_encode_params *p;
    const struct relume_encode_params *encode;
    unsigned char plausible;
};

static relume_status compare_looks(struct looking *w)
{
    const struct relume_rect at = window_of(w->capture, relume_coder_info(w->pictures)->planes);
    const double share = (double)relume_capture_width(w->capture) *
                         relume_capture_height(w->capture) / ((double)at.width * at.height);
    const struct rate_target target = target_of_view(w->capture, w->p);
    const int views = relume_capture_manifest(w->capture)->views;
    struct look ours = {0}, theirs = {0};
    double own = 0.0, their = 0.0;
    relume_status status = look_at(&theirs, w->pictures, w->capture, &at, w->encode);
    if (!status)
        status = look_at(&ours, w->components, w->capture, &at, w->encode);
    if (!status)
        status = judge_look(&own, &ours, &theirs, &at);
    if (!status)
        status = judge_look(&their, &theirs, &theirs, &at);
    own =
        rate_merit_of(own, share * (double)ours.bytes, &target, header_bytes(w->components, views));
    their = rate_merit_of(their, share * (double)theirs.bytes, &target, 0.0);
    w->plausible = their > own - PLAUSIBLE_DB;
    look_away(&ours);
    look_away(&theirs);
    return status;
}

static relume_status make_look(void *context, int member, struct relume_buffer *out)
{
    struct looking *w = context;
    const struct relume_writer writer = relume_buffer_writer(out);
    const relume_status status = member ? RELUME_OK : compare_looks(w);
    return status || writer.write(writer.user, &w->plausible, 1, 0) ? status : RELUME_ENOMEM;
}

static relume_status take_look(void *context, int member, const struct relume_buffer *piece)
{
    struct looking *w = context;
    if (piece->size != 1)
        return RELUME_EDAMAGED;
    w->plausible = member ? w->plausible : (unsigned char)piece->data[0];
    return RELUME_OK;
}

// ---------------------------------------------------------------- all of one view

static relume_status merit_of(double *merit, const relume_coder *coder,
                              const relume_capture *capture,
                              const struct relume_pack_encode_params *p,
                              const struct relume_encode_params *encode)
{
    const int views = relume_capture_manifest(capture)->views;
    const struct rate_target target = target_of_view(capture, p);
    relume_coefficients *c;
    relume_status status = relume_encode(&c, coder, capture, views / 2, encode);
    if (!status)
        status =
            rate_merit(merit, c, views / 2, capture, &target, header_bytes(coder, views), encode);
    relume_coefficients_destroy(&c);
    return status;
}

// Components and pictures, judged by two members of a team.
struct choice {
    const relume_coder *coder[2];
    const relume_capture *capture;
    const struct relume_pack_encode_params *p;
    const struct relume_encode_params *encode;
    double merit[2];
};

static bool is_his(const struct choice *c, int member, int which)
{
    return which % (c->p->team ? c->p->team->members : 1) == member;
}

// A number for each, which is 0 where it is another's to say.
static relume_status make_merits(void *context, int member, struct relume_buffer *out)
{
    const struct choice *c = context;
    const struct relume_writer writer = relume_buffer_writer(out);
    double merit[2] = {0.0, 0.0};
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < 2; i++)
        if (is_his(c, member, i))
            status = merit_of(&merit[i], c->coder[i], c->capture, c->p, c->encode);
    if (!status && !writer.write(writer.user, merit, sizeof merit, 0))
        status = RELUME_ENOMEM;
    return status;
}

static relume_status take_merits(void *context, int member, const struct relume_buffer *piece)
{
    struct choice *c = context;
    double merit[2];
    if (piece->size != sizeof merit)
        return RELUME_EDAMAGED;
    memcpy(merit, piece->data, sizeof merit);
    for (int i = 0; i < 2; i++)
        c->merit[i] = is_his(c, member, i) ? merit[i] : c->merit[i];
    return RELUME_OK;
}

// Components in *out or pictures, whichever are better, in *out; the others are destroyed, on
// failure both.
static relume_status keep_better(relume_coder **out, relume_coder *pictures,
                                 const relume_capture *capture,
                                 const struct relume_pack_encode_params *p,
                                 const struct relume_encode_params *encode)
{
    const double least = p->psnr_db > 0.0 ? 0.0 : WORTH_IT_DB;
    struct choice c = {{*out, pictures}, capture, p, encode, {0.0, 0.0}};
    const relume_status status =
        team_gather(p->team, "merits", make_merits, take_merits, &c, p->log);
    if (!status && c.merit[1] > c.merit[0] + least) {
        relume_coder *const components = *out;
        *out = pictures;
        pictures = components;
    }
    relume_coder_destroy(&pictures);
    if (status)
        relume_coder_destroy(out);
    return status;
}

// The pictures, with the interpolant of the components; one that smooths would cost quality before
// coding does.
static relume_status learn_pictures(relume_coder **out, const relume_coder *components,
                                    const relume_capture *capture,
                                    const struct relume_coder_params *coder,
                                    const struct relume_encode_params *encode)
{
    const struct relume_coder_info *info = relume_coder_info(components);
    struct relume_coder_params all = *coder;
    all.coefficients = 0;
    all.choose = false;
    all.interpolant = info->interpolant;
    memcpy(all.parameter, info->parameter, sizeof all.parameter);
    if (coder->choose)
        all.parameter[NUGGET] = 0.0;
    return relume_coder_learn(out, &relume_basis_table, capture, &all, encode);
}

relume_status relume_pack_decide(relume_coder **out, const relume_capture *capture,
                                 const struct relume_coder_params *coder,
                                 const struct relume_pack_encode_params *params)
{
    const struct relume_pack_encode_params p = PARAMS_WORK(relume_pack_encode_params, params);
    const struct relume_encode_params encode = {.log = p.log,
                                                .domain = RELUME_DOMAIN_DISPLAY,
                                                .storage = RELUME_STORE_12,
                                                .step = RELUME_STEP_COMMON,
                                                .threads = p.threads,
                                                .team = p.team};
    const int lights = relume_capture_manifest(capture)->lights;
    struct relume_decision decision;
    relume_coder *pictures = NULL;
    relume_status status =
        relume_coder_decide(out, &decision, capture, wanted(&p) + SPARE_DB, coder, &encode);
    int components = status ? 0 : relume_coder_info(*out)->coefficients;
    if (!status && !coder->coefficients && components < LEAST_COMPONENTS && components < lights) {
        struct relume_coder_params more = *coder;
        more.coefficients = components = lights < LEAST_COMPONENTS ? lights : LEAST_COMPONENTS;
        relume_coder_destroy(out);
        status = relume_coder_learn(out, &relume_basis_pca, capture, &more, &encode);
    }
    const struct relume_coder_info *info = status ? NULL : relume_coder_info(*out);
    if (status || !info->basis->learned || 3 * lights > MOST_PLANES)
        return status;
    status = learn_pictures(&pictures, *out, capture, coder, &encode);
    if (!status && p.psnr_db > 0.0 && decision.psnr_db < p.psnr_db + LEAST_SPARE_DB) {
        relume_coder_destroy(out);
        *out = pictures;
        return RELUME_OK;
    }
    struct looking look = {*out, pictures, capture, &p, &encode, true};
    if (!status && 3 * components <= 2 * lights)
        status = team_gather(p.team, "look", make_look, take_look, &look, p.log);
    if (!status && look.plausible)
        return keep_better(out, pictures, capture, &p, &encode);
    relume_coder_destroy(&pictures);
    if (status)
        relume_coder_destroy(out);
    return status;
}

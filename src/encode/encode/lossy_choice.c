// lossy_choice.c - principal components, or the pictures themselves: what takes fewer bytes with
// loss
#include <relume/encode/pack_encode.h>

#include "core/base/params.h"
#include "encode/encode/windows.h"
#include "encode/encode/rate.h"
#include "format/team/gather.h"

#include <math.h>
#include <string.h>

// Truncation is to cost little beside coding, which makes more components than these nearly free
// but for their functions in the header; and a usual target where bytes are asked for.
enum { LEAST_COMPONENTS = 27, NUGGET = 2 };
static const double SPARE_DB = 3.0, LEAST_SPARE_DB = 0.5, USUAL_DB = 40.0;

// What pictures must be better by at the same size where it is not known how lights left out are
// shown: mostly components predict unseen lights better from planes that are as good.
static const double WORTH_IT_DB = 0.5;

// Windows of one view are looked at first. Of a view with more pixels than these that is all; else
// the whole of it is coded both ways where one is not better there by more than this.
enum { MANY_PIXELS = 512 * 512, MOST_PLANES = 1200 };
static const double CLEARLY_DB = 1.5;

// Bytes are asked for to be relit from: a decibel of lights left out then counts as so many of the
// captured ones, unless one of the two is ahead there by more than these.
static const double LEFT_OUT_COUNTS = 8.0, FAR_DB = 6.0;

// Of a number of the functions, as text in the header (format/pack/functions.h), about six bits
// each.
static const double BYTES_EACH = 0.75;

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
    return info->basis->joint ? 3.0 * info->coefficients * info->functions * BYTES_EACH / views
                              : 0.0;
}

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

// Components and pictures, judged by members of a team.
struct choice {
    const relume_coder *coder[2];
    const relume_capture *capture;
    const struct relume_pack_encode_params *p;
    const struct relume_encode_params *encode;
    bool by_windows;  // by one member, else one each by two
    double merit[2], left_out[2];
};

static bool is_his(const struct choice *c, int member, int which)
{
    const int members = c->p->team && !c->by_windows ? c->p->team->members : 1;
    return which % members == member;
}

static relume_status look(double merit[2], double left_out[2], const struct choice *c)
{
    const struct rate_target target = target_of_view(c->capture, c->p);
    const int views = relume_capture_manifest(c->capture)->views;
    const double header[2] = {header_bytes(c->coder[0], views), header_bytes(c->coder[1], views)};
    return look_compare(merit, left_out, c->coder, c->capture, &target, header,
                        c->p->psnr_db > 0.0 ? CLEARLY_DB : FAR_DB, c->encode);
}

// Two numbers for each, which are 0 where they are another's to say; of whole views the merits
// alone.
static relume_status make_merits(void *context, int member, struct relume_buffer *out)
{
    const struct choice *c = context;
    const struct relume_writer writer = relume_buffer_writer(out);
    double number[4] = {0.0, 0.0, 0.0, 0.0};
    relume_status status =
        c->by_windows && is_his(c, member, 0) ? look(number, number + 2, c) : RELUME_OK;
    for (int i = 0; !status && i < 2; i++)
        if (is_his(c, member, i) && !c->by_windows)
            status = merit_of(&number[i], c->coder[i], c->capture, c->p, c->encode);
    if (!status && !writer.write(writer.user, number, sizeof number, 0))
        status = RELUME_ENOMEM;
    return status;
}

static relume_status take_merits(void *context, int member, const struct relume_buffer *piece)
{
    struct choice *c = context;
    double number[4];
    if (piece->size != sizeof number)
        return RELUME_EDAMAGED;
    memcpy(number, piece->data, sizeof number);
    for (int i = 0; i < 2; i++) {
        if (!is_his(c, member, i))
            continue;
        c->merit[i] = number[i];
        c->left_out[i] = c->by_windows ? number[2 + i] : c->left_out[i];
    }
    return RELUME_OK;
}

// How much better pictures are, by the captured lights and by those that were left out.
static double ahead(const struct choice *c)
{
    const double counts = c->p->psnr_db > 0.0 ? 1.0 : LEFT_OUT_COUNTS;
    return c->merit[1] - c->merit[0] + counts * (c->left_out[1] - c->left_out[0]);
}

// Components in *out or pictures, whichever are better, in *out; the others are destroyed, on
// failure both.
static relume_status keep_better(relume_coder **out, relume_coder *pictures,
                                 const relume_capture *capture,
                                 const struct relume_pack_encode_params *p,
                                 const struct relume_encode_params *encode)
{
    const bool are_many =
        relume_capture_width(capture) > MANY_PIXELS / relume_capture_height(capture);
    struct choice c = {{*out, pictures}, capture, p, encode, true, {0.0, 0.0}, {0.0, 0.0}};
    relume_status status = team_gather(p->team, "look", make_merits, take_merits, &c, p->log);
    c.by_windows = false;
    if (!status && !are_many && fabs(ahead(&c)) < CLEARLY_DB)
        status = team_gather(p->team, "merits", make_merits, take_merits, &c, p->log);
    const bool known = c.left_out[0] > 0.0 && c.left_out[1] > 0.0;
    if (!status && ahead(&c) > (p->psnr_db > 0.0 || known ? 0.0 : WORTH_IT_DB)) {
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
    const int components = status ? 0 : relume_coder_info(*out)->coefficients;
    if (!status && !coder->coefficients && components < LEAST_COMPONENTS && components < lights) {
        struct relume_coder_params more = *coder;
        more.coefficients = lights < LEAST_COMPONENTS ? lights : LEAST_COMPONENTS;
        relume_coder_destroy(out);
        status = relume_coder_learn(out, &relume_basis_pca, capture, &more, &encode);
    }
    const struct relume_coder_info *info = status ? NULL : relume_coder_info(*out);
    if (status || coder->coefficients || !info->basis->joint || 3 * lights > MOST_PLANES)
        return status;
    status = learn_pictures(&pictures, *out, capture, coder, &encode);
    if (!status && p.psnr_db > 0.0 && decision.psnr_db < p.psnr_db + LEAST_SPARE_DB) {
        relume_coder_destroy(out);
        *out = pictures;
        return RELUME_OK;
    }
    if (!status)
        return keep_better(out, pictures, capture, &p, &encode);
    relume_coder_destroy(out);
    return status;
}

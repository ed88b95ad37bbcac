// contest.c - components against pictures: windows of a view first, then whole views
#include "encode/encode/contest.h"

#include "encode/encode/rate.h"
#include "encode/encode/windows.h"
#include "format/coder/coding.h"
#include "format/team/array.h"

#include <math.h>

// What pictures must be better by at the same size where it is not known how lights left out are
// shown: mostly components predict unseen lights better from planes that are as good.
static const double WORTH_IT_DB = 0.5;

// Windows of one view are looked at first. Of a view with more pixels than these that is all; else
// the whole of it is coded both ways where one is not better there by more than this.
enum { MANY_PIXELS = 512 * 512 };
static const double CLEARLY_DB = 1.5;

// The weight of a decibel of unseen lights against one of captured lights. It is the same for a
// quality and for bytes, so that both lead to the same file. Windows are coded at two steps for a
// number of bytes, unless one of the two is ahead by more than FAR_DB.
static const double LEFT_OUT_COUNTS = 1.0, FAR_DB = 6.0;

// Of a number of the functions, as text in the header (format/pack/functions.h), about six bits
// each.
static const double BYTES_EACH = 0.75;

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
                              const struct relume_project_params *encode)
{
    const int views = relume_capture_manifest(capture)->views;
    const struct rate_target target = target_of_view(capture, p);
    relume_coefficients *c;
    relume_status status = relume_project(&c, coder, capture, views / 2, encode);
    if (!status)
        status =
            rate_merit(merit, c, views / 2, capture, &target, header_bytes(coder, views), encode);
    relume_coefficients_destroy(&c);
    return status;
}

// Components and pictures, each as good as the target allows.
struct merits {
    double merit[2], left_out[2];
};
struct contest {
    const relume_coder *coder[2];
    const relume_capture *capture;
    const struct relume_pack_encode_params *p;
    const struct relume_project_params *encode;
    bool by_windows;  // of both by one member, else by whole views, one each by two members
    struct merits known;
    int member;            // whose share is in progress
    struct merits judged;  // in it
};

static bool is_judged_by(const struct contest *c, int member, int which)
{
    return which % (c->by_windows ? 1 : team_members(c->p->team)) == member;
}

static relume_status judge_windows(struct merits *out, const struct contest *c)
{
    const struct rate_target target = target_of_view(c->capture, c->p);
    const int views = relume_capture_manifest(c->capture)->views;
    const double header[2] = {header_bytes(c->coder[0], views), header_bytes(c->coder[1], views)};
    return windows_compare(out->merit, out->left_out, c->coder, c->capture, &target, header,
                           c->p->psnr_db > 0.0 ? CLEARLY_DB : FAR_DB, c->encode);
}

static relume_status begin_share(void *context, int member)
{
    struct contest *c = context;
    c->member = member;
    c->judged = (struct merits){{0.0, 0.0}, {0.0, 0.0}};
    return RELUME_OK;
}

static relume_status judge_share(void *context)
{
    struct contest *c = context;
    relume_status status = RELUME_OK;
    if (c->by_windows)
        return is_judged_by(c, c->member, 0) ? judge_windows(&c->judged, c) : RELUME_OK;
    for (int i = 0; !status && i < 2; i++)
        if (is_judged_by(c, c->member, i))
            status = merit_of(&c->judged.merit[i], c->coder[i], c->capture, c->p, c->encode);
    return status;
}

// Lights that are left out are known of windows alone.
static relume_status add_share(void *context)
{
    struct contest *c = context;
    for (int i = 0; i < 2; i++) {
        if (!is_judged_by(c, c->member, i))
            continue;
        c->known.merit[i] = c->judged.merit[i];
        if (c->by_windows)
            c->known.left_out[i] = c->judged.left_out[i];
    }
    return RELUME_OK;
}

static relume_status share_contest(struct contest *c, bool by_windows)
{
    struct team_array judged = {&c->judged, sizeof c->judged};
    static const struct team_work work = {begin_share, judge_share, add_share};
    c->by_windows = by_windows;
    return team_share(c->p->team, by_windows ? "look" : "merits", &work, c, &team_array_bytes,
                      &judged, c->p->log);
}

// How much better pictures are, by the captured lights and by those that were left out.
static double ahead(const struct contest *c)
{
    const struct merits *k = &c->known;
    return k->merit[1] - k->merit[0] + LEFT_OUT_COUNTS * (k->left_out[1] - k->left_out[0]);
}

relume_status contest_keep_better(relume_coder **out, relume_coder *pictures,
                                  const relume_capture *capture,
                                  const struct relume_pack_encode_params *p,
                                  const struct relume_project_params *encode)
{
    const bool are_many =
        relume_capture_width(capture) > MANY_PIXELS / relume_capture_height(capture);
    struct contest c = {.coder = {*out, pictures}, .capture = capture, .p = p, .encode = encode};
    relume_status status = share_contest(&c, true);
    if (!status && !are_many && fabs(ahead(&c)) < CLEARLY_DB)
        status = share_contest(&c, false);
    const bool known = c.known.left_out[0] > 0.0 && c.known.left_out[1] > 0.0;
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

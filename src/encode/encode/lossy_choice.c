// lossy_choice.c - principal components, or the pictures themselves: what takes fewer bytes with
// loss
#include <relume/encode/pack_encode.h>

#include "core/base/params.h"
#include "encode/encode/contest.h"
#include "encode/encode/lossy_choice.h"
#include "format/coder/coding.h"

#include <math.h>
#include <string.h>

// Truncation is to cost little beside coding; and a usual target where bytes are asked for.
static const double SPARE_DB = 3.0, USUAL_DB = 40.0;

enum { USUAL = 27, NUGGET = 2 };

// Of more planes than these the pictures are not considered, nor where so few components for each
// light are enough.
enum { MOST_PLANES = 1200, COLOURS = 3, FEW_LIGHTS = 2 };

// Nothing smooths between pictures, which may cost unseen lights this much.
static const double LEAST_UNSEEN_DB = 0.2;

static double wanted(const struct relume_pack_encode_params *p)
{
    return p->psnr_db > 0.0 ? p->psnr_db : USUAL_DB;
}

// The pictures, with the interpolant of the components; one that smooths would cost quality before
// coding does.
static relume_status learn_pictures(relume_coder **out, const relume_coder *components,
                                    const relume_capture *capture,
                                    const struct relume_coder_params *coder,
                                    const struct relume_project_params *encode)
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

// Pictures are considered where components do not reach the quality, or are so many that pictures
// may take fewer bytes and show unseen lights alike.
static bool may_be_pictures(const relume_coder *components, const struct relume_decision *decision,
                            const struct relume_pack_encode_params *p)
{
    const struct relume_coder_info *info = relume_coder_info(components);
    const bool enough = decision->psnr_db >= wanted(p) + SPARE_DB;
    if (!info->basis->joint || COLOURS * info->lights > MOST_PLANES)
        return false;
    return !enough ||
           ((info->coefficients > USUAL || FEW_LIGHTS * info->coefficients > info->lights) &&
            decision->sharp_db > decision->unseen_db - LEAST_UNSEEN_DB);
}

static struct relume_project_params lossy_params(const struct relume_pack_encode_params *p)
{
    return (struct relume_project_params){.log = p->log,
                                          .domain = RELUME_DOMAIN_DISPLAY,
                                          .storage = RELUME_STORE_12,
                                          .step = RELUME_STEP_HALVED,
                                          .threads = p->threads,
                                          .team = p->team};
}

relume_status lossy_decide(relume_coder **out, struct relume_decision *decision,
                           const relume_capture *capture, const struct relume_coder_params *coder,
                           const struct relume_pack_encode_params *params)
{
    const struct relume_pack_encode_params p = PARAMS_WORK(relume_pack_encode_params, params);
    const bool is_open = p.least_db > 0.0;
    const struct relume_project_params lossy = lossy_params(&p);
    struct relume_project_params look = lossy;
    relume_coder *pictures = NULL;
    if (is_open) {
        look.domain = p.domain;
        look.storage = RELUME_STORE_DEFAULT;
        look.step = RELUME_STEP_DEFAULT;
    }
    relume_status status = relume_coder_decide(
        out, decision, capture, is_open ? 0.0 : wanted(&p) + SPARE_DB, is_open, coder, &look);
    if (status || is_open || coder->coefficients || !may_be_pictures(*out, decision, &p))
        return status;
    status = learn_pictures(&pictures, *out, capture, coder, &lossy);
    if (!status)
        return contest_keep_better(out, pictures, pow(10.0, -0.1 * decision->pooled_db), capture,
                                   &p, &lossy);
    relume_coder_destroy(out);
    return status;
}

relume_status lossy_foretell(double *bytes, const relume_coder *coder, double pooled_db,
                             const relume_capture *capture, const char *scratch,
                             const struct relume_pack_encode_params *p)
{
    struct relume_project_params lossy = lossy_params(p);
    lossy.scratch = scratch;
    return contest_foretell(bytes, coder, pow(10.0, -0.1 * pooled_db), capture, p, &lossy);
}

relume_status relume_pack_decide(relume_coder **out, const relume_capture *capture,
                                 const struct relume_coder_params *coder,
                                 const struct relume_pack_encode_params *params)
{
    struct relume_decision decision;
    return lossy_decide(out, &decision, capture, coder, params);
}

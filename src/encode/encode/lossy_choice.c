// lossy_choice.c - principal components, or the pictures themselves: what takes fewer bytes with
// loss
#include <relume/encode/pack_encode.h>

#include "core/base/params.h"
#include "encode/encode/contest.h"
#include "format/coder/coding.h"

#include <string.h>

// Truncation is to cost little beside coding, which makes more components than these nearly free
// but for their functions in the header; and a usual target where bytes are asked for.
enum { LEAST_COMPONENTS = 27, NUGGET = 2 };
static const double SPARE_DB = 3.0, LEAST_SPARE_DB = 0.5, USUAL_DB = 40.0;

// Of more planes than these the pictures are not considered.
enum { MOST_PLANES = 1200 };

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

relume_status relume_pack_decide(relume_coder **out, const relume_capture *capture,
                                 const struct relume_coder_params *coder,
                                 const struct relume_pack_encode_params *params)
{
    const struct relume_pack_encode_params p = PARAMS_WORK(relume_pack_encode_params, params);
    const struct relume_project_params encode = {.log = p.log,
                                                 .domain = RELUME_DOMAIN_DISPLAY,
                                                 .storage = RELUME_STORE_12,
                                                 .step = RELUME_STEP_HALVED,
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
        return contest_keep_better(out, pictures, capture, &p, &encode);
    relume_coder_destroy(out);
    return status;
}

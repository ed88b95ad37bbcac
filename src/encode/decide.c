// decide.c - principal components, or the pictures themselves: what takes fewer bytes with loss
#include <relume/pack.h>

#include "base/params.h"
#include "encode/rate.h"

// Truncation is to cost little beside coding, which makes more components than these nearly free
// but for their functions in the header; and a usual target where bytes are asked for.
enum { LEAST_COMPONENTS = 27 };
static const double SPARE_DB = 3.0, LEAST_SPARE_DB = 0.5, USUAL_DB = 40.0;

static double wanted(const struct relume_pack_encode_params *p)
{
    return p->psnr_db > 0.0 ? p->psnr_db : USUAL_DB;
}

static relume_status bytes_with(double *bytes, const relume_coder *coder,
                                const relume_capture *capture,
                                const struct relume_pack_encode_params *p,
                                const struct relume_encode_params *encode)
{
    relume_coefficients *c;
    relume_status status =
        relume_encode(&c, coder, capture, relume_capture_manifest(capture)->views / 2, encode);
    if (!status)
        status = rate_estimate(bytes, c, relume_capture_manifest(capture)->views / 2, capture,
                               wanted(p), encode);
    relume_coefficients_destroy(&c);
    return status;
}

// The better of the two, in *out; the other one is destroyed.
static relume_status keep_smaller(relume_coder **out, relume_coder *other,
                                  const relume_capture *capture,
                                  const struct relume_pack_encode_params *p,
                                  const struct relume_encode_params *encode)
{
    double ours = 0.0, theirs = 0.0;
    relume_status status = bytes_with(&ours, *out, capture, p, encode);
    if (!status)
        status = bytes_with(&theirs, other, capture, p, encode);
    if (!status && theirs < ours) {
        relume_coder *const worse = *out;
        *out = other;
        other = worse;
    }
    relume_coder_destroy(&other);
    return status;
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
                                                .threads = p.threads};
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
    if (status || 3 * components <= 2 * lights || !relume_coder_info(*out)->basis->learned)
        return status;
    struct relume_coder_params all = *coder;
    all.coefficients = 0;
    all.choose = false;  // an interpolant that smooths would cost quality before coding does
    status = relume_coder_learn(&pictures, &relume_basis_table, capture, &all, &encode);
    if (!status && decision.psnr_db < wanted(&p) + LEAST_SPARE_DB) {
        relume_coder_destroy(out);
        *out = pictures;
    } else if (!status) {
        status = keep_smaller(out, pictures, capture, &p, &encode);
    }
    if (status)
        relume_coder_destroy(out);
    return status;
}

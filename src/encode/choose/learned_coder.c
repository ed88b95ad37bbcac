// learned_coder.c - a coder that learns from pixels of the capture, where its basis wants any
#include "core/base/params.h"
#include "encode/choose/samples.h"
#include "format/coder/basis.h"
#include "format/coder/coding.h"

relume_status relume_coder_learn(relume_coder **out, const struct relume_basis *basis,
                                 const relume_capture *capture,
                                 const struct relume_coder_params *coder,
                                 const struct relume_project_params *encode)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    struct relume_coder_params p = PARAMS_WORK(relume_coder_params, coder);
    struct relume_samples samples = {0};
    p.hemispherical = relume_capture_hemispherical(capture);
    p.pole_y = relume_capture_pole_y(capture);
    p.threads = encode ? encode->threads : 0;
    relume_status status = RELUME_OK;
    *out = NULL;
    if (basis->learned || p.choose) {
        status = relume_samples_read(&samples, capture, samples_enough(m->lights), encode);
        p.samples = &samples;
    }
    if (!status)
        status = relume_coder_create(out, basis, m->directions, m->lights, &p);
    relume_samples_destroy(&samples);
    return status;
}

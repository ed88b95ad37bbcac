// glare_options.c - what `glare` and `relight --pass glare` share: an eye, its pattern, a frame
// seen
#include "glare_options.h"

relume_status open_viewer_eye(struct viewer_eye *out, const struct args *args,
                              const struct eye_options *o, double luminance,
                              const struct relume_psf_params *psf)
{
    struct relume_subject subject = relume_subject_default();
    *out = (struct viewer_eye){
        .luminance = luminance,
        .params = {.log = args->log,
                   .threads = args->threads,
                   .magnify = o->magnify,
                   .mode = o->mode,
                   .border = o->border},
    };
    relume_status status =
        o->subject ? relume_subject_load(&subject, o->subject, args->log) : RELUME_OK;
    if (!status)
        status = relume_eye_create(&out->eye, &subject, luminance);
    if (!status)
        status = relume_eye_advance(out->eye, o->time, luminance);
    if (!status)
        status = relume_psf_create(&out->psf, psf);
    if (!status)
        status = relume_glare_create(&out->glare);
    if (status)
        close_viewer_eye(out);
    return status;
}

void close_viewer_eye(struct viewer_eye *e)
{
    relume_glare_destroy(&e->glare);
    relume_psf_destroy(&e->psf);
    relume_eye_destroy(&e->eye);
}

relume_status see(struct relume_image *out, struct viewer_eye *e, const struct relume_image *frame,
                  bool same)
{
    const relume_status status = relume_psf_update(e->psf, e->eye);
    return status ? status : relume_glare_apply(out, e->glare, frame, same, e->psf, &e->params);
}

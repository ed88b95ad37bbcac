// glare_options.c - what `glare` and `relight --pass glare` share: an eye, its pattern, a frame
// seen
#include "glare_options.h"

static relume_status parse_names(struct relume_glare_params *p, const struct eye_options *o)
{
    const char *const mode = o->mode ? o->mode : relume_glare_mode_names()[0];
    const char *const border = o->border ? o->border : relume_glare_border_names()[0];
    if (relume_glare_mode_parse(&p->mode, mode))
        return unknown_name("--mode", mode, relume_glare_mode_names());
    if (relume_glare_border_parse(&p->border, border))
        return unknown_name("--border", border, relume_glare_border_names());
    return RELUME_OK;
}

relume_status open_viewer_eye(struct viewer_eye *out, const struct args *args,
                              const struct eye_options *o, double luminance,
                              const struct relume_psf_params *psf)
{
    struct relume_subject subject = relume_subject_default();
    *out = (struct viewer_eye){
        .luminance = luminance,
        .params = {.log = args->log, .threads = args->threads, .magnify = o->magnify},
    };
    relume_status status = parse_names(&out->params, o);
    if (!status && o->subject)
        status = relume_subject_load(&subject, o->subject, args->log);
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

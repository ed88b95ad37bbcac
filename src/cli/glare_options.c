// glare_options.c - what `glare` and `relight --pass glare` share: an eye, its pattern, a frame
// seen
#include "glare_options.h"

static relume_status parse_names(struct relume_glare_params *p, const struct args *args)
{
    const char *const mode = args_text(args, "--mode", relume_glare_mode_names()[0]);
    const char *const border = args_text(args, "--border", relume_glare_border_names()[0]);
    if (relume_glare_mode_parse(&p->mode, mode))
        return unknown_name("--mode", mode, relume_glare_mode_names());
    if (relume_glare_border_parse(&p->border, border))
        return unknown_name("--border", border, relume_glare_border_names());
    return RELUME_OK;
}

relume_status open_viewer_eye(struct viewer_eye *out, const struct args *args, double luminance,
                              const struct relume_psf_params *psf)
{
    const char *const path = args_text(args, "--subject", NULL);
    struct relume_subject subject = relume_subject_default();
    *out = (struct viewer_eye){
        .luminance = luminance,
        .params = {.log = args_log(args),
                   .threads = args_threads(args),
                   .magnify = args_number(args, "--magnify", 0.0)},
    };
    relume_status status = parse_names(&out->params, args);
    if (!status && path)
        status = relume_subject_load(&subject, path, args_log(args));
    if (!status)
        status = relume_eye_create(&out->eye, &subject, luminance);
    if (!status)
        status = relume_eye_advance(out->eye, args_number(args, "--time", 1.0), luminance);
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

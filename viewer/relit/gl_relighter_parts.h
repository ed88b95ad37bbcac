// gl_relighter_parts.h - what the files of the relighter know of each other
#ifndef VIEWER_GL_RELIGHTER_PARTS_H
#define VIEWER_GL_RELIGHTER_PARTS_H

#include "relit/gl_relighter_state.h"

// How GL stores the codes of each kind; `unit` turns its normalised values back into codes.
struct code_format {
    GLint internal;
    GLenum type;
    size_t bytes;
    double unit;
};
const struct code_format *code_format_of(const struct relume_codes *codes);

// Graphics memory of a view's codes.
size_t codes_bytes(const struct relume_codes *codes);
// The codes become textures of `view`, which keeps what describes them. RELUME_ENOMEM,
// RELUME_ESYSTEM; the view is released then.
relume_status codes_upload(struct gl_relighter *r, struct relit_view *view,
                           const struct relume_codes *codes);

bool gl_relighter_has_kind(const struct gl_relighter *r, bool (*is)(enum relume_light_kind));
static inline bool gl_relighter_is_environment(enum relume_light_kind kind)
{
    return kind == RELUME_LIGHT_ENVIRONMENT;
}
static inline bool gl_relighter_is_distant(enum relume_light_kind kind)
{
    return !relume_light_is_near(kind);
}

// Passes add to what the target in use holds, once this was called.
void draws_begin(const struct gl_relighter *r);
relume_status draws_create(struct gl_relighter *r);
void draws_destroy(struct gl_relighter *r);
// Everything distant but environments on codes of the display domain.
relume_status draws_distant(struct gl_relighter *r, struct relit_view *view);
// A target as large as the view, and r->coded.
relume_status draws_fit(const struct gl_relighter *r, struct target *target,
                        const struct relit_view *view);
relume_status draws_scratch(struct gl_relighter *r, const struct relit_view *view);
// `coded` decoded by `display`, times `rgb`, into the view.
void draws_develop(const struct gl_relighter *r, const struct relit_view *view,
                   const struct target *coded, struct relume_transfer display, const float rgb[3]);

// `picture`, linear, without what is below 0 (keep_above_zero), into the view or another target in
// use of its size.
void draws_guarded(const struct gl_relighter *r, const struct relit_view *view,
                   const struct target *picture);
// What an environment shows, alone, in r->coded, with what is below 0: of linear codes.
relume_status draws_environment(struct gl_relighter *r, struct relit_view *view,
                                const struct relume_light *light);

// Environments on codes of the display domain, by their linear copy: a picture, which holds until
// the next one, ...
relume_status linear_copy_picture(const struct target **out, struct gl_relighter *r,
                                  const struct relit_view *view,
                                  const struct relume_light *environments, int n);
// ... and all of those in use, into the view.
relume_status linear_copy_relight(struct gl_relighter *r, struct relit_view *view);
void linear_copy_destroy(struct gl_relighter *r);

// The environments, where the view has shadows or highlights that move.
relume_status bright_sources_relight(struct gl_relighter *r, struct relit_view *view);
void bright_sources_destroy(struct gl_relighter *r);

#endif

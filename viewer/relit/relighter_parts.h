// relighter_parts.h - what the files of the relighter know of each other
#ifndef VIEWER_RELIGHTER_PARTS_H
#define VIEWER_RELIGHTER_PARTS_H

#include "relit/relighter_state.h"

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
relume_status codes_upload(struct relighter *r, struct relit_view *view,
                           const struct relume_codes *codes);

bool relighter_has_kind(const struct relighter *r, bool (*is)(enum relume_light_kind));
static inline bool relighter_is_environment(enum relume_light_kind kind)
{
    return kind == RELUME_LIGHT_ENVIRONMENT;
}
static inline bool relighter_is_distant(enum relume_light_kind kind)
{
    return !relume_light_is_near(kind);
}

// Passes add to what the target in use holds, once this was called.
void passes_begin(const struct relighter *r);
relume_status passes_create(struct relighter *r);
void passes_destroy(struct relighter *r);
// Everything distant but environments on codes of the display domain.
relume_status passes_distant(struct relighter *r, struct relit_view *view);
// r->coded as large as the view.
relume_status passes_scratch(struct relighter *r, const struct relit_view *view);
// `coded` decoded by `display`, times `rgb`, into the view.
void passes_develop(const struct relighter *r, const struct relit_view *view,
                    const struct target *coded, struct relume_transfer display, const float rgb[3]);

// The environments on codes of the display domain, by their linear copy.
relume_status linear_copy_relight(struct relighter *r, struct relit_view *view);
void linear_copy_destroy(struct relighter *r);

#endif

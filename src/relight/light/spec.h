// spec.h - a light in words
#ifndef RELIGHT_SPEC_H
#define RELIGHT_SPEC_H

#include <relume/light.h>

// What the words of a SPEC say; the file is still to be opened.
struct spec {
    struct relume_light light;
    char *file;  // of slide, env, ies, gonio, as it was written; else NULL. To be freed
};

// Words of the contract (rig.h). RELUME_EINVAL with a sentence, RELUME_ENOMEM.
relume_status spec_parse(struct spec *out, const char *text, const struct relume_log *log);

// The words for `light` without rgb, to be freed; NULL when memory is short. `file` in quotes where
// it holds blanks.
char *spec_text(const struct relume_light *light, const char *file);

#endif

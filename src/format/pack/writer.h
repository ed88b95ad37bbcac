// writer.h - the parts of a relume file as they come together, shared by the files that make them
#ifndef PACK_WRITER_H
#define PACK_WRITER_H

#include "core/base/arena.h"
#include "format/codebook/books.h"
#include "format/coder/coding.h"
#include "format/pack/pack_write.h"
#include "image/image/exr.h"

#include <relume/format/pack_write.h>

struct writer {
    struct arena arena;
    const struct relume_pack_contents *contents;
    const struct relume_coder_info *coder;
    enum exr_codec codec;
    struct exr_part *parts;
    int count;
    const char **channels;  // [planes], as the file sorts them
    char display[32];       // the curve, as text
    bool failed;            // memory is short: what was made is not to be used
};

// The next part of the file, of the writer's codec and without channels. `name` NULL: it failed.
struct exr_part *writer_part(struct writer *w, const char *name, int width, int height);
// Whether planes are coded; a part may hold none of them.
bool writer_is_coded(const struct relume_pack_contents *contents);
// Attributes. Texts and floats must live as long as the writer; floats that are NULL fail.
void writer_int(struct exr_part *part, const char *name, int value);
void writer_text(struct exr_part *part, const char *name, const char *text);
void writer_floats(struct writer *w, struct exr_part *part, const char *name, const float *floats,
                   int count);
// As single precision, copied.
void writer_doubles(struct writer *w, struct exr_part *part, const char *name, const double *from,
                    int count);

// The first part: the preview, and what all of the file is (write_header.c).
void writer_add_header(struct writer *w);
// The parts of a view: its planes unless they are coded, or indices into codebooks and these unless
// they are `shared`; its reduced levels, unless they are coded; its mask, and its depth unless that
// is coded (write_view.c).
void writer_add_view(struct writer *w, int view, bool shared);
// The reduced levels of a view, and their masks.
void writer_add_levels(struct writer *w, int view);
// A report as join needs it, to the last digit.
const char *writer_measured(struct writer *w, const struct relume_fidelity *report);
// What the first part shows of a view: its coefficients, or those of a reduced level.
const struct relume_coefficients_info *writer_shown(const struct relume_pack_view *view);
// What its shadows are traced with, or its highlights wander by. Errors of learnt_encode.
relume_status writer_add_learnt(struct writer *w, int index, const struct relume_pack_params *p);
// The parts of all views whose planes are coded, and of their depth (write_coded.c).
void writer_add_groups(struct writer *w);
// Words as the rows of a part; they must live as long as the writer.
void writer_fill_words(struct writer *w, struct exr_part *part, const uint32_t *word, size_t count);
// The parts of the codebooks of a view, or of all of them (-1); and the indices into them.
void writer_add_books(struct writer *w, const relume_books *books, int view);
void writer_fill_indices(struct exr_part *part, const struct relume_pack_view *view);

#endif

// reader.h - the inside of an open relume file, shared by the files that read it
#ifndef PACK_READER_H
#define PACK_READER_H

#include "core/base/arena.h"
#include "format/codebook/books.h"
#include "format/coder/coding.h"
#include "format/pack/learnt.h"
#include "format/pack/views.h"
#include "image/image/exr.h"

#include <relume/format/codebook.h>
#include <relume/pack.h>

// Some of the words of a part.
struct word_range {
    size_t first, count;
};

struct view_parts {
    int codes, depth, mask, shadow;  // part numbers, -1 when absent
    int anchor;                      // coded: the view from which it is predicted, -1: from none
    struct word_range words, depth_words;  // coded: of `codes`, and where there are any of `depth`
    float depth_step;
    int level[RELUME_MOST_LEVELS], share[RELUME_MOST_LEVELS];  // reduced; as `codes` and `mask`
};

// The codebooks of one view, or those of all.
struct read_books {
    int part[RELUME_MOST_BOOKS];
    struct relume_book book[RELUME_MOST_BOOKS];  // without numbers
    int codes[RELUME_MOST_BOOKS];                // with that of nothing, behind those of the file
    float *vectors[RELUME_MOST_BOOKS];           // NULL until they are needed
};

struct relume_pack {
    struct relume_pack_info info;
    struct arena arena;
    exr_file *file;
    char *path;
    int width, height;         // of each view in the file
    struct relume_rect shown;  // the part of them that `info` describes
    relume_coder *coder;
    struct view_parts *parts;                      // [views]
    struct relume_codes_part *loaded;              // [views]
    struct read_books *books;                      // [views]; shared ones in the first
    int gloss;                                     // the part, where info.has_gloss; -1: lost
    bool part;                                     // the header of a part of several (part.h)
    bool coded;                                    // planes with loss, ...
    bool keep_going;                               // ... of which tiles may be damaged;
    const struct relume_pack_check_params *check;  // who gets the list of them; NULL: a warning
    int threads;
    const struct relume_log *log;
    struct relume_limits limits;
};

// "PATH: what; expected ..." as an input status.
relume_status reader_bad(const relume_pack *p, const char *what, const char *expected);
// Finite numbers of an attribute, *count of them; or NULL. And as many as expected.
const float *reader_any_floats(const relume_pack *p, int part, const char *name, int *count);
const float *reader_floats(const relume_pack *p, int part, const char *name, int count);

// Everything of the first part, into the info and the coder (read_header.c); then which part is
// which (read_parts.c).
relume_status reader_read_header(relume_pack *p);
relume_status reader_find_parts(relume_pack *p);

// The size of the file's views at a level. Crops an image of a whole view to the part.
void reader_level_size(int *width, int *height, const relume_pack *p, int level);
relume_status reader_crop(struct relume_image *image, const relume_pack *p);

// Numbers of the file's storage: data[planes][rows][columns] of a rectangle of the part, checked.
// They are the planes from `first` on, in the order in which the file sorts them, or in that of
// `data` where it is negative (read_view.c).
relume_status reader_load(relume_pack *p, int part, const struct relume_rect *rect, void *data,
                          int planes, int first);
// The codes of a rectangle of a view, or of a reduced level of it, from the file; `like` is what is
// known of them.
relume_status reader_load_planes(struct relume_codes_part *to, relume_pack *p, int view, int level,
                                 const struct relume_rect *rect, const struct relume_codes *like);
relume_status reader_load_indices(struct relume_codes_part *to, relume_pack *p, int view,
                                  const struct relume_rect *rect, const struct relume_codes *like);
// Of depth or of a mask; empty where there is no such part.
relume_status reader_load_plane(struct relume_image *out, relume_pack *p, int part,
                                const struct relume_rect *rect);

// Of files that are coded with loss (read_coded.c): the groups of views that begin at *part, which
// moves behind them; the planes of a rectangle of a view; its depth, where that has words.
relume_status reader_find_groups(relume_pack *p, int *part);
relume_status reader_load_coded(relume_pack *p, int view, int level, const struct relume_rect *rect,
                                const struct relume_codes *codes, uint16_t *data);
// Of the first reduced level, which is not kept: of all planes of `like`.
relume_status reader_load_halved(relume_pack *p, int view, const struct relume_rect *rect,
                                 const struct relume_codes *like, uint16_t *data);
// The side of their tiles, 0 where it cannot be read.
int reader_coded_tile(const relume_pack *p);
relume_status reader_load_coded_depth(struct relume_image *out, relume_pack *p, int view);
// A model of the pixels of a view, into a new image of the views' size.
relume_status reader_load_learnt(struct relume_image *out, relume_pack *p, int part,
                                 enum learnt_kind kind);

// What a mask leaves out is black, whatever the file's constant is (read_mask.c): the plane of the
// mean, 1 inside and 0 outside, of a reduced level what of each pixel is inside (in the display
// domain: 1 where any is); and the code vectors of nothing.
relume_status reader_mask_plane(relume_pack *p, int view, int level, const struct relume_rect *rect,
                                void *plane);
// Codes of coefficients that are 0 where the mask leaves out, into planes that were coded with
// loss.
relume_status reader_mask_codes(relume_pack *p, int view, int level, const struct relume_rect *rect,
                                const struct relume_codes *codes, uint16_t *data);
bool reader_has_nothing(const relume_pack *p, int codes);
relume_status reader_mask_indices(relume_pack *p, int view, const struct relume_rect *rect,
                                  uint16_t *index);

// Into info.geometry and info.slab; and, once parts are known, which slab each view is of.
relume_status reader_read_slabs(relume_pack *p);
relume_status reader_read_members(relume_pack *p);

// The codebooks that begin at *part, which moves behind them: those of `view`, or of all (-1),
// which may be absent.
relume_status reader_find_books(relume_pack *p, int view, int *part);
void reader_drop_books(struct read_books *books);

#endif

// reader.h - the inside of an open relume file, shared by the files that read it
#ifndef PACK_READER_H
#define PACK_READER_H

#include "base/arena.h"
#include "image/exr.h"

#include <relume/codebook.h>
#include <relume/pack.h>
#include <stdatomic.h>

struct loaded {
    struct relume_codes codes;
    const void **plane;  // [planes], or [books]
    void *data;          // [planes][height][width], with codebooks uint16_t [books][height][width]
    float *steps;        // scale and offset of each plane
};

struct view_parts {
    int codes, depth, mask;  // part numbers, -1 when absent
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
    relume_coder *coder;
    struct view_parts *parts;  // [views]
    struct loaded *loaded;     // [views]
    struct read_books *books;  // [views]; shared ones in the first
    uint16_t *code_of_half;    // [65536], NOT_A_CODE where a half is no code
    int threads;
    const struct relume_log *log;
    struct relume_limits limits;
};

// A part of numbers on its way into memory.
struct loading {
    const relume_pack *pack;
    const size_t *place;  // [planes]: which plane each channel is
    void *data;           // [planes][height][width]
    size_t width, height, planes;
    atomic_bool wrong;
};

// "PATH: what; expected ..." as an input status.
relume_status reader_bad(const relume_pack *p, const char *what, const char *expected);
// `count` finite numbers of an attribute, or NULL.
const float *reader_floats(const relume_pack *p, int part, const char *name, int count);
// The type in which the file's numbers are stored.
enum exr_sample reader_sample(const relume_pack *p);
// The plane of a channel, in the order in which the file sorts all of them.
size_t reader_plane(const struct relume_coder_info *info, size_t channel);
// Numbers of the file's storage: data[planes][height][width], checked.
relume_status reader_load(relume_pack *p, int part, void *data, size_t planes, const size_t *place);

// What a mask leaves out is black, whatever the file's constant is (read_mask.c): the plane of the
// mean, 1 inside and 0 outside; and the code vectors of nothing.
relume_status reader_mask_plane(relume_pack *p, int view, void *plane);
bool reader_has_nothing(const relume_pack *p, int codes);
relume_status reader_mask_indices(relume_pack *p, int view, uint16_t *index);

// Into info.geometry and info.slab; and, once parts are known, which slab each view is of.
relume_status reader_read_slabs(relume_pack *p);
relume_status reader_read_members(relume_pack *p);

// The codebooks that begin at *part, which moves behind them: those of `view`, or of all (-1),
// which may be absent.
relume_status reader_find_books(relume_pack *p, int view, int *part);
relume_status reader_load_indices(relume_pack *p, int view);
void reader_drop_books(struct read_books *books);

#endif

// lossy.h - the 12-bit codes of a view as tiles of video: the smallest a relume file gets
//
// A view is cut into tiles of up to 512 x 512 pixels, each of which is decoded alone. A tile is one
// AV1 sequence, its pictures the coefficients one after the other: grey planes, or where red, green
// and blue have planes of their own pictures in colour. Views side by side are coded as a group:
// the first, the anchor, alone, every other one predicted from the anchor, so that no view takes
// more than two to decode. How the words lie: docs/format.md.
#ifndef LOSSY_LOSSY_H
#define LOSSY_LOSSY_H

#include "format/coder/coding.h"
#include "format/lossy/av1.h"

#include <relume/format/coder.h>

// What is coded: `planes` of codes 0 .. 4095, of three colours each where `colour` is set (plane
// 3 k + c), the pictures one after the other in `order` (NULL: as they are numbered).
struct lossy_shape {
    int width, height, planes;
    bool colour;
    const int *order;             // [planes], [planes / 3] in colour
    const unsigned char *halved;  // [planes], or NULL: as in struct av1_shape
};

// Whether `planes` of a coder are in colour; and a good order for its pictures where it matters,
// which is that of neighbouring lights: from malloc, NULL also when memory is short.
bool lossy_in_colour(const relume_coder *coder);
int *lossy_order(const relume_coder *coder);

struct lossy_words {
    uint32_t *word;  // [count], from malloc
    size_t count;
};
// Bytes as words of which the first byte is the lowest: words are what every machine keeps.
void lossy_put_bytes(uint32_t *word, const unsigned char *bytes, size_t size);
void lossy_take_bytes(unsigned char *bytes, const uint32_t *word, size_t size);

// How many views of such a coder can be one group.
int lossy_most_views(const relume_coder *coder);
// The codes of from[views], a group, whose storage is RELUME_STORE_12 and whose steps are the same;
// the first is the anchor. `effort` as av1.h. Words do not depend on `threads`. RELUME_ENOMEM,
// RELUME_EIO, RELUME_ESYSTEM, RELUME_ECANCEL.
relume_status lossy_encode(struct lossy_words *out, relume_coefficients *const *from, int views,
                           const struct av1_effort *effort, int threads,
                           const struct relume_log *log);

// The tiles of each view of a group, which are numbered row by row: their side, a multiple of 128,
// how many stand in a row, and how many there are.
struct lossy_cut {
    int side, across, count;
};
struct lossy_cut lossy_cut_of(const relume_coder *coder, int width, int height, int views);
// The tiles `first` .. `end` alone, of coefficients that need no other rows than theirs:
// sequence[end - first][views], of which the caller frees the bytes. As lossy_encode.
relume_status lossy_encode_tiles(struct av1_bytes *sequence, relume_coefficients *const *from,
                                 int views, int first, int end, const struct av1_effort *effort,
                                 int threads, const struct relume_log *log);
// The words of a view of these sequences, `stride` from tile to tile; those without bytes are
// missing, and nothing else of the view can be decoded. RELUME_ENOMEM.
relume_status lossy_join(struct lossy_words *out, const struct lossy_cut *cut,
                         const struct av1_bytes *sequence, size_t stride);
// Words without tiles, and what a sequence adds to them.
size_t lossy_words_of(const struct lossy_cut *cut);
size_t lossy_words_for(size_t bytes);
// Which tiles words have, from the first to behind the last with bytes, of how many; the words and
// the side of a tile. None of it is believed: RELUME_EDAMAGED where the head, of lossy_head(word)
// words, cannot be, or where tiles between them are missing.
struct lossy_held {
    int first, end, count, side;
    size_t words;
};
relume_status lossy_look(struct lossy_held *out, const uint32_t *head, size_t words);
// The head of one that misses tiles gets those of another, of the same view.
void lossy_add_tiles(uint32_t *head, const uint32_t *other, const struct lossy_held *held);
// Words with the tiles `first` .. `end` of `words` alone. RELUME_ENOMEM.
relume_status lossy_keep_tiles(struct lossy_words *out, const struct lossy_words *words, int first,
                               int end);

// Codes[planes][height][width] as the words of a view that is an anchor. `order` of the shape is
// NULL. Errors as above, without RELUME_EIO.
relume_status lossy_encode_codes(struct lossy_words *out, const uint16_t *codes,
                                 const struct lossy_shape *shape, const struct av1_effort *effort,
                                 int threads, const struct relume_log *log);

// A rectangle of a view coded by itself: its codes before[planes][height][width], those after it
// was decoded again, and the bytes it took. Errors as above.
relume_status lossy_try(uint16_t *before, uint16_t *after, size_t *bytes, relume_coefficients *from,
                        const struct relume_rect *at, const struct av1_effort *effort, int threads,
                        const struct relume_log *log);

// Called with what a tile that cannot be decoded has of the rectangle; its codes are 0.
struct lossy_lost {
    void (*tile)(void *user, const struct relume_rect *at);
    void *user;
};
// What of a view's words a rectangle of it needs, for those who have only the head: `need` is
// called with the first word and how many. The head is so many words, of which the first three say
// how many there are: 0 where they cannot.
size_t lossy_head(const uint32_t word[3]);
enum { LOSSY_HEAD = 3 };
relume_status lossy_needs(const struct lossy_shape *shape, const struct relume_rect *rect,
                          const struct lossy_words *words,
                          relume_status (*need)(void *user, size_t first, size_t count),
                          void *user);
// A rectangle of a view into codes[planes][rect.height][rect.width]; no tile beside it is decoded.
// `anchor` where the view is not one itself, else NULL. RELUME_EDAMAGED when words are no such
// tiles, or a tile cannot be decoded and `lost` is NULL. RELUME_ENOMEM.
relume_status lossy_decode(uint16_t *codes, const struct lossy_shape *shape,
                           const struct relume_rect *rect, const struct lossy_words *words,
                           const struct lossy_words *anchor, int threads,
                           const struct lossy_lost *lost);
// The side of the tiles; 0 where it cannot be. Of `words` only the first LOSSY_HEAD count.
int lossy_side(const struct lossy_words *words);

#endif

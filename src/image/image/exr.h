// exr.h - multi-part OpenEXR files, of scanlines and of tiles: the container under relume files and
// EXR images
//
// Samples travel in the file's own order, [row][channel][x] with channels sorted by name, so that
// nothing is shuffled on the way.
#ifndef IMAGE_EXR_H
#define IMAGE_EXR_H

#include "core/base/arena.h"

#include <relume/image.h>

// An open file. Thread-safety: reading is safe.
typedef struct exr_file exr_file;

enum exr_sample { EXR_SAMPLE_UINT, EXR_SAMPLE_HALF, EXR_SAMPLE_FLOAT };  // as in the format
enum exr_codec { EXR_CODEC_NONE, EXR_CODEC_RLE, EXR_CODEC_ZIP, EXR_CODEC_PIZ };

size_t exr_sample_bytes(enum exr_sample sample);
// `n` samples as numbers, and numbers that are such samples back.
void exr_to_floats(float *out, enum exr_sample sample, const void *samples, size_t n);
void exr_from_floats(void *samples, enum exr_sample sample, const float *numbers, size_t n);

struct exr_attribute {
    const char *name;  // at most 31 characters
    enum { EXR_INT, EXR_TEXT, EXR_FLOATS } kind;
    int integer;
    const char *text;
    const float *floats;
    int count;  // of floats
};

struct exr_part {
    const char *name;
    int width, height;
    enum exr_sample sample;  // of every channel
    enum exr_codec codec;
    int tile;  // side of the tiles in which it is packed; 0: in runs of rows
    int channels;
    const char *const *channel;  // [channels], sorted by strcmp
    int attributes;
    const struct exr_attribute *attribute;
    // Fill samples[row][channel][x] for `rows` rows from `row` on. Called from several threads.
    relume_status (*rows)(void *context, int row, int rows, void *samples);
    void *context;
    // In place of `rows`: the blocks of a part of another file, packed as they are there.
    const exr_file *from;
    int from_part;
    // Or of several: from `row` of the whole on those that begin at `from_row` of each, rows of
    // whole blocks of scanlines. They follow one another.
    int sources;
    const struct exr_copied *source;  // [sources]
};
struct exr_copied {
    const exr_file *from;
    int from_part, row, from_row;
};

// Rows of a block of scanlines.
int exr_block_rows(enum exr_codec codec);

// Write all parts into `path`, or `writer` (outfile.h), whole or not at all; with `sums` one more
// behind them that holds their check sums (exr_sums.h). RELUME_EIO, RELUME_ENOMEM, RELUME_ECANCEL
// or what a `rows` function returned.
relume_status exr_write(const char *path, const struct relume_writer *writer,
                        const struct exr_part *parts, int count, bool sums, int threads,
                        const struct relume_log *log);

// Bytes of the file that exr_write would make of the parts with check sums. Parts that nothing
// compresses are not asked for rows. Errors as above.
relume_status exr_size(uint64_t *bytes, const struct exr_part *parts, int count, int threads,
                       const struct relume_log *log);

// The file `path`, or what `from` reads (infile.h). An input status with a sentence when it is not
// a readable EXR of scanlines, or of tiles without reduced levels, within the limits.
relume_status exr_open(exr_file **out, const char *path, const struct relume_reader *from,
                       const struct relume_limits *limits, const struct relume_log *log);
// The same for those who look for damage: blocks may be missing.
relume_status exr_open_damaged(exr_file **out, const char *path, const struct relume_reader *from,
                               const struct relume_limits *limits, const struct relume_log *log);
void exr_close(exr_file **file);
uint64_t exr_bytes(const exr_file *file);
int exr_part_count(const exr_file *file);  // without that of check sums

// Whether the file has check sums; and compare what it holds with them: the headers and the tables
// of blocks now, each block when it is read from now on (what differs is damaged). Not while others
// read. RELUME_ENOMEM.
bool exr_has_sums(const exr_file *file);
enum exr_sums_found {
    EXR_SUMS_NONE,
    EXR_SUMS_WHOLE,
    EXR_SUMS_HEAD_CHANGED,
    EXR_SUMS_DAMAGED,  // the sums themselves: nothing is compared with them
};
relume_status exr_use_sums(exr_file *file, enum exr_sums_found *found);

struct exr_part_info {
    const char *name;  // "" when the part has none
    int width, height;
    int x, y;                // where the data window begins
    enum exr_sample sample;  // of the first channel
    bool uniform;            // all channels have that type and full resolution
    bool subsampled;         // some have less
    int channels;
    const char *codec;
    int tile;  // side of its tiles, 0: scanlines
};
struct exr_part_info exr_part_info(const exr_file *file, int part);
const char *exr_channel_name(const exr_file *file, int part, int channel);
// A channel has a sample at every so manieth pixel and row, counted from 0; 0: these differ.
int exr_channel_step(const exr_file *file, int part, int channel);
// Whether a part has no attributes but those that all have.
bool exr_is_plain(const exr_file *file, int part);

// Attributes of a part; false or NULL when absent or of another type.
bool exr_get_int(const exr_file *file, int part, const char *name, int *value);
const char *exr_get_text(const exr_file *file, int part, const char *name);
// x and y of red, green, blue and white; false when they are absent or make no colours.
bool exr_get_chromaticities(const exr_file *file, int part, float xy[8]);
const float *exr_get_floats(const exr_file *file, int part, const char *name, int *count);

// A part as it would be written once more, its blocks copied; its arrays lie in `arena`. Of its
// attributes those that EXR itself asks for and those of other kinds are left out. RELUME_EDAMAGED
// without a sentence when it is not of the kind that exr_write makes, RELUME_ENOMEM.
relume_status exr_part_again(struct exr_part *out, const exr_file *file, int part,
                             struct arena *arena);

// Hand the blocks of a part that hold any of `rect` to `sink` (from several threads, any order):
// `at` is what a block covers, a run of whole rows or a tile; others are not looked at. NULL: all.
// An input status when the file is truncated or broken.
relume_status exr_read(const exr_file *file, int part, const struct relume_rect *rect, int threads,
                       void (*sink)(void *context, const struct relume_rect *at,
                                    const void *samples),
                       void *context, const struct relume_log *log);
// The same of samples that are converted before `sink` gets them: codes[row][channel][x]. `convert`
// depends on the sample alone: where few values occur it is called once for each. *wrong
// where it refused some, which `sink` does not get.
struct piz_conversion;
relume_status exr_read_codes(const exr_file *file, int part, const struct relume_rect *rect,
                             int threads, const struct piz_conversion *to, bool *wrong,
                             void (*sink)(void *context, const struct relume_rect *at,
                                          const void *codes),
                             void *context, const struct relume_log *log);
// What of `at` lies within `rect`; nothing has no rows.
struct relume_rect exr_overlap(const struct relume_rect *at, const struct relume_rect *rect);

// Where the samples of a channel in row `y` of `some` lie, which is within a block at `at`.
static inline const void *exr_samples(const void *samples, const struct relume_rect *at,
                                      const struct relume_rect *some, int y, int channels,
                                      int channel, size_t sample_bytes)
{
    const size_t row = (size_t)(y - at->top) * (size_t)channels + (size_t)channel;
    return (const char *)samples +
           (row * (size_t)at->width + (size_t)(some->left - at->left)) * sample_bytes;
}

// Decode every block of a part and call `found` for each run of rows that cannot be, or each tile,
// from the top down. RELUME_ENOMEM, RELUME_ECANCEL.
relume_status exr_find_damage(const exr_file *file, int part, int threads,
                              void (*found)(void *context, const struct relume_rect *at),
                              void *context, const struct relume_log *log);

// The blocks of a part of scanlines as they are asked for. Thread-safety: one thread at a time.
typedef struct exr_blocks exr_blocks;
// `file` must outlive it. RELUME_ENOMEM.
relume_status exr_blocks_open(exr_blocks **out, const exr_file *file, int part);
// samples[channel][x] of a row, until the next call. An input status where the file is truncated or
// damaged, RELUME_ENOMEM.
relume_status exr_blocks_row(exr_blocks *blocks, int row, const void **samples);
// The samples of one channel in a row, in parts whose channels differ in type or step: one for each
// of its pixels, none in rows that it leaves out. The same.
relume_status exr_blocks_channel(exr_blocks *blocks, int row, int channel, float *out);
void exr_blocks_close(exr_blocks **blocks);

#endif

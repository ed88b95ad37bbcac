// bytes.h - a file in memory, read from the front: text lines, then binary
#ifndef EXCHANGE_BYTES_H
#define EXCHANGE_BYTES_H

#include <relume/base.h>

struct bytes {
    uint8_t *data;
    size_t size, at;
};

// The whole file. An input status with a sentence when it cannot be read.
relume_status bytes_load(struct bytes *out, const char *path, const struct relume_log *log);
void bytes_free(struct bytes *b);

// The next word of at most `capacity` - 1 characters; blanks and line ends before it are skipped.
bool bytes_word(struct bytes *b, char *word, size_t capacity);
// The next word as a whole number or as a finite number, nothing else in it.
bool bytes_integer(struct bytes *b, long *out);
bool bytes_number(struct bytes *b, double *out);
// The rest of the line and its one end: LF, CR LF or CR. False when the file ends first or when
// anything but blanks is left on the line.
bool bytes_line_end(struct bytes *b);
// Skip lines that begin with `mark`.
void bytes_skip_comments(struct bytes *b, char mark);
// The next `size` bytes, or NULL when the file is shorter.
const uint8_t *bytes_take(struct bytes *b, size_t size);
// A little-endian single precision number.
bool bytes_float(struct bytes *b, float *out);

#endif

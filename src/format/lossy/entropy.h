// entropy.h - bits at the cost of how surprising they are: a range coder (Martin 1979) whose
// chances adapt
#ifndef LOSSY_ENTROPY_H
#define LOSSY_ENTROPY_H

#include <relume/base.h>
#include <stdint.h>

// The chance of a 0 in 1 / 65536, and how often it was asked for. Begin with ENTROPY_EVEN.
struct entropy_chance {
    uint16_t zero, seen;
};
#define ENTROPY_EVEN ((struct entropy_chance){32768, 0})

struct entropy_writer {
    unsigned char *byte;  // [size], mem_free
    size_t size, capacity;
    uint64_t low;
    uint32_t range;
    bool failed;  // memory is short
};
struct entropy_writer entropy_write(void);
void entropy_put(struct entropy_writer *w, struct entropy_chance *chance, int bit);
void entropy_end(struct entropy_writer *w);

// Behind the last byte all are 0.
struct entropy_reader {
    const unsigned char *byte;
    size_t size, at;
    uint32_t code, range;
};
struct entropy_reader entropy_read(const unsigned char *byte, size_t size);
int entropy_get(struct entropy_reader *r, struct entropy_chance *chance);

// A number that is mostly small: whether it is 0, its sign, then how many bits its size has, by the
// chances of each, and these as they are. Sizes below 2^(ENTROPY_BITS + 1).
enum { ENTROPY_BITS = 16 };
struct entropy_whole {
    struct entropy_chance *any, *sign, *more;  // more[ENTROPY_BITS + 1]
};
void entropy_put_whole(struct entropy_writer *w, const struct entropy_whole *by, int number);
int entropy_get_whole(struct entropy_reader *r, const struct entropy_whole *by);

#endif

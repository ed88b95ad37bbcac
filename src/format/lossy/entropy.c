// entropy.c - a binary range coder: 32 bits of range, whole bytes out, carries into what is out
// already
#include "format/lossy/entropy.h"

#include "core/base/memory.h"

// A chance is the mean of what was seen, of late where that is much; never certain.
enum { ONE = 65536, MEMORY = 60, LEAST = 32 };

static const uint32_t FULL = 0xffffffffu, BYTE_OUT = 1u << 24;

static void learn(struct entropy_chance *c, int bit)
{
    const int goal = bit ? LEAST : ONE - LEAST;
    c->zero = (uint16_t)(c->zero + (goal - c->zero) / (c->seen + 2));
    c->seen += c->seen < MEMORY;
}

// The part of the range that a 0 has.
static uint32_t share(uint32_t range, const struct entropy_chance *c)
{
    return (uint32_t)((uint64_t)range * c->zero / ONE);
}

struct entropy_writer entropy_write(void)
{
    return (struct entropy_writer){.range = FULL};
}

static void carry(struct entropy_writer *w)
{
    size_t at = w->size;
    while (at > 0 && ++w->byte[--at] == 0)
        continue;
}

static void put_byte(struct entropy_writer *w, unsigned char byte)
{
    if (w->size == w->capacity) {
        unsigned char *more = mem_resize(w->byte, 2 * w->capacity + 64, 1);
        if (!more) {
            w->failed = true;
            return;
        }
        w->byte = more;
        w->capacity = 2 * w->capacity + 64;
    }
    w->byte[w->size++] = byte;
}

static void put_low(struct entropy_writer *w)
{
    if (w->low >> 32)
        carry(w);
    put_byte(w, (unsigned char)(w->low >> 24));
    w->low = (w->low & (BYTE_OUT - 1)) << 8;
}

void entropy_put(struct entropy_writer *w, struct entropy_chance *chance, int bit)
{
    const uint32_t zero = share(w->range, chance);
    w->low += bit ? zero : 0;
    w->range = bit ? w->range - zero : zero;
    learn(chance, bit);
    for (; w->range < BYTE_OUT; w->range <<= 8)
        put_low(w);
}

void entropy_end(struct entropy_writer *w)
{
    for (int i = 0; i < 4; i++)
        put_low(w);
}

static uint32_t next_byte(struct entropy_reader *r)
{
    return r->at < r->size ? r->byte[r->at++] : 0;
}

struct entropy_reader entropy_read(const unsigned char *byte, size_t size)
{
    struct entropy_reader r = {.byte = byte, .size = size, .range = FULL};
    for (int i = 0; i < 4; i++)
        r.code = r.code << 8 | next_byte(&r);
    return r;
}

int entropy_get(struct entropy_reader *r, struct entropy_chance *chance)
{
    const uint32_t zero = share(r->range, chance);
    const int bit = r->code >= zero;
    r->code -= bit ? zero : 0;
    r->range = bit ? r->range - zero : zero;
    learn(chance, bit);
    for (; r->range < BYTE_OUT; r->range <<= 8)
        r->code = r->code << 8 | next_byte(r);
    return bit;
}

// ---------------------------------------------------------------- whole numbers

static void put_plain(struct entropy_writer *w, unsigned value, int bits)
{
    for (int i = bits; i-- > 0;) {
        struct entropy_chance even = ENTROPY_EVEN;
        entropy_put(w, &even, (int)(value >> i & 1));
    }
}

static unsigned get_plain(struct entropy_reader *r, int bits)
{
    unsigned value = 0;
    for (int i = 0; i < bits; i++) {
        struct entropy_chance even = ENTROPY_EVEN;
        value = 2 * value + (unsigned)entropy_get(r, &even);
    }
    return value;
}

void entropy_put_whole(struct entropy_writer *w, const struct entropy_whole *by, int number)
{
    entropy_put(w, by->any, number != 0);
    if (!number)
        return;
    entropy_put(w, by->sign, number < 0);
    const unsigned size = (unsigned)(number < 0 ? -number : number);
    int exponent = 0;
    for (; size >> (exponent + 1); exponent++)
        entropy_put(w, &by->more[exponent], 1);
    entropy_put(w, &by->more[exponent], 0);
    put_plain(w, size & ((1u << exponent) - 1), exponent);
}

int entropy_get_whole(struct entropy_reader *r, const struct entropy_whole *by)
{
    if (!entropy_get(r, by->any))
        return 0;
    const bool negative = entropy_get(r, by->sign);
    int exponent = 0;
    while (exponent < ENTROPY_BITS && entropy_get(r, &by->more[exponent]))
        exponent++;
    const int size = (int)(1u << exponent | get_plain(r, exponent));
    return negative ? -size : size;
}

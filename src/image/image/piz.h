// piz.h - OpenEXR's PIZ compression, byte for byte, several times as fast as its library
#ifndef IMAGE_PIZ_H
#define IMAGE_PIZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// What one thread works with, kept from block to block. NULL: no memory.
typedef struct piz piz;
piz *piz_create(void);
void piz_destroy(piz **p);

// Largest size of a block of so many bytes, whatever is in it.
size_t piz_bound(size_t bytes);
// Compress a block of 16-bit samples, words[row][channel][x], to at most piz_bound bytes; `work`
// has as many words. 0: not one for this code, with more than 2^14 different values.
size_t piz_compress(piz *p, uint8_t *out, uint16_t *work, const uint16_t *words, int width,
                    int rows, int channels);

// The same for decoding.
typedef struct piz_decoder piz_decoder;
piz_decoder *piz_decoder_create(void);
void piz_decoder_destroy(piz_decoder **d);

// Room for blocks of so many samples of `words` (1 or 2) words in a channel. False: no memory.
bool piz_decoder_reserve(piz_decoder *d, size_t samples, int words);

// Makes codes[n] of `bytes` each, 1 or 2, of samples. False: some have no code.
struct piz_conversion {
    bool (*convert)(void *context, void *codes, const void *samples, size_t n);
    void *context;
    size_t bytes;
};

// Samples of `words` words each, for which there is room, out[row][channel][x][words], of the
// `size` bytes of a block; or with a conversion its codes, out[row][channel][x]. False: not one
// that this code knows, damaged or not; `out` may hold anything then.
bool piz_decompress(piz_decoder *d, void *out, const uint8_t *packed, size_t size, int width,
                    int rows, int channels, int words, const struct piz_conversion *to);

#endif

// jpeg.h - planes of 8-bit codes as JPEG files, without any colour management: numbers, not
// pictures
#ifndef IMAGE_JPEG_H
#define IMAGE_JPEG_H

#include <relume/base.h>

// Codes as they are stored: components of grey and RGB files untouched, YCbCr turned into RGB.
struct jpeg_codes {
    int width, height;
    int planes;     // 1 or 3
    uint8_t *data;  // [planes][height][width], from malloc
};

// An input status with a sentence about `name` when it is no whole JPEG file within the limits.
relume_status jpeg_read(struct jpeg_codes *out, const char *path,
                        const struct relume_limits *limits, const struct relume_log *log);
relume_status jpeg_decode(struct jpeg_codes *out, const void *bytes, size_t size, const char *name,
                          const struct relume_limits *limits, const struct relume_log *log);
void jpeg_codes_free(struct jpeg_codes *codes);

// What libjpeg writes at most.
enum { JPEG_MOST_SIDE = 65500 };

enum jpeg_colour {
    JPEG_PLANES,  // 1 component, or 3 as RGB (Adobe marker, transform 0, no JFIF)
    JPEG_YCBCR,   // 3 components, JFIF
};

// Quantised DCT coefficients, 4:4:4. Blocks cover the picture row by row.
struct jpeg_picture {
    int width, height;
    int planes;  // 1 or 3
    enum jpeg_colour colour;
    bool baseline;                   // sequential, with a JFIF header: for decoders of any age
    int step[3];                     // one flat step per plane, [1, 255]
    const int16_t *coefficients[3];  // [blocks][64] in zigzag order, DC first
};

// The smallest of a few progressive scripts, or baseline, with Huffman tables made for it. `*out`
// is from malloc.
relume_status jpeg_encode(uint8_t **out, size_t *size, const struct jpeg_picture *picture);

#endif

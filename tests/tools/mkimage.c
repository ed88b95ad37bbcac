// mkimage.c - images that no ordinary program writes, for tests of bad and odd input
//
//   mkimage png  DEPTH CHANNELS DIR IN...  PNG of 8 or 16 bits; 1 grey, 2 + alpha, 3 RGB, 4 + alpha
//   mkimage tiff DEPTH CHANNELS DIR IN...  TIFF of 8, 16 or 32 (float) bits; 1, 3 or 4 channels;
//                                          both write DIR/NAME under each input's own name
//   mkimage pages OUT IN...               TIFF of a page for each, 16 bits RGB
//   mkimage poke IN OUT X Y VALUE          all channels of a pixel, float EXR ("nan", "inf", ...)
//   mkimage gain IN OUT FACTOR             every value times FACTOR, as float EXR
//   mkimage plane IN OUT VALUE             one channel of VALUE of the size of IN, as float EXR
//   mkimage bigpng OUT W H                 a few bytes that claim a size; bigexr likewise
//   mkimage cmyk OUT W H C M Y K           CMYK JPEG of one colour, inks 0 to 255, as Adobe's
//   mkimage read IMAGE X Y                 the linear value of a pixel
//   mkimage size IMAGE                     its width and height
//   mkimage maxdiff A B                    the largest difference, linear
//   mkimage codediff A B                   the mean difference of 8-bit sRGB codes, without alpha
//   mkimage sum OUT A B                    A + B, as float EXR
//   mkimage shift IN OUT N                 IN moved N columns to the right, its left column
//   repeated
#include "png_crc.h"

#include <relume/extensions.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct buffer {
    uint8_t *data;
    size_t size;
};

static void put(struct buffer *b, const void *bytes, size_t n)
{
    b->data = realloc(b->data, b->size + n);
    if (!b->data)
        exit(3);
    memcpy(b->data + b->size, bytes, n);
    b->size += n;
}

static void put_byte(struct buffer *b, unsigned v)
{
    const uint8_t byte = (uint8_t)v;
    put(b, &byte, 1);
}

static void put_big(struct buffer *b, uint32_t v, int bytes)
{
    for (int i = bytes - 1; i >= 0; i--)
        put_byte(b, v >> (8 * i) & 255);
}

static void put_little(struct buffer *b, uint32_t v, int bytes)
{
    for (int i = 0; i < bytes; i++)
        put_byte(b, v >> (8 * i) & 255);
}

static void save(const struct buffer *b, const char *path)
{
    FILE *f = fopen(path, "wb");
    if (!f || fwrite(b->data, 1, b->size, f) != b->size || fclose(f)) {
        perror(path);
        exit(3);
    }
    free(b->data);
}

static struct relume_image load(const char *path)
{
    struct relume_image image;
    if (relume_image_load(&image, path, NULL)) {
        fprintf(stderr, "mkimage: %s cannot be read\n", path);
        exit(1);
    }
    return image;
}

static void save_float(const struct relume_image *image, const char *path)
{
    if (relume_image_save(image, path, NULL))
        exit(3);
}

// sRGB code of channel c of a pixel; alpha runs over the image, so that using it would show.
static unsigned code(const struct relume_image *image, size_t pixel, int c, int channels,
                     unsigned top)
{
    const bool alpha = channels == 2 ? c == 1 : c == 3;
    if (alpha)
        return (unsigned)(pixel * 37 % 200) * (top / 255) + top / 8;
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    const float v = relume_transfer_encode(srgb, image->data[3 * pixel + (size_t)c]);
    // 8-bit codes in 16 bits, so that both depths mean the same picture
    const unsigned byte = (unsigned)(fminf(fmaxf(v, 0.0f), 1.0f) * 255.0f + 0.5f);
    return byte * (top / 255);
}

// ---------------------------------------------------------------- PNG (stored, not deflated)

static void put_chunk(struct buffer *b, const char *type, const struct buffer *body)
{
    put_big(b, (uint32_t)body->size, 4);
    const size_t from = b->size;
    put(b, type, 4);
    put(b, body->data, body->size);
    put_big(b, png_crc(b->data + from, b->size - from), 4);
}

static void deflate_stored(struct buffer *out, const struct buffer *raw)
{
    uint32_t a = 1, c = 0;
    put_big(out, 0x7801, 2);
    for (size_t at = 0; at < raw->size;) {
        const size_t n = raw->size - at < 65535 ? raw->size - at : 65535;
        put_byte(out, at + n == raw->size);
        put_little(out, (uint32_t)n, 2);
        put_little(out, ~(uint32_t)n & 0xffff, 2);
        put(out, raw->data + at, n);
        at += n;
    }
    for (size_t i = 0; i < raw->size; i++) {
        a = (a + raw->data[i]) % 65521;
        c = (c + a) % 65521;
    }
    put_big(out, c << 16 | a, 4);
}

static void put_png(struct buffer *b, uint32_t width, uint32_t height, int depth, int channels,
                    const struct buffer *raw)
{
    static const uint8_t colour_type[] = {0, 0, 4, 2, 6};
    struct buffer header = {0}, data = {0}, none = {0};
    put(b, "\x89PNG\r\n\x1a\n", 8);
    put_big(&header, width, 4);
    put_big(&header, height, 4);
    put_byte(&header, (unsigned)depth);
    put_byte(&header, colour_type[channels]);
    put(&header, "\0\0\0", 3);
    put_chunk(b, "IHDR", &header);
    deflate_stored(&data, raw);
    put_chunk(b, "IDAT", &data);
    put(&none, "", 0);
    put_chunk(b, "IEND", &none);
    free(header.data);
    free(data.data);
    free(none.data);
}

static void write_png(const char *from, const char *to, int depth, int channels)
{
    struct relume_image image = load(from);
    struct buffer raw = {0}, file = {0};
    for (size_t p = 0; p < (size_t)image.width * (size_t)image.height; p++) {
        if (p % (size_t)image.width == 0)
            put_byte(&raw, 0);
        for (int c = 0; c < channels; c++)
            put_big(&raw, code(&image, p, c, channels, depth == 8 ? 255 : 65535), depth / 8);
    }
    put_png(&file, (uint32_t)image.width, (uint32_t)image.height, depth, channels, &raw);
    free(raw.data);
    save(&file, to);
    relume_image_destroy(&image);
}

// ---------------------------------------------------------------- TIFF (uncompressed)

// Appends a page and writes its place at `link`. Returns where the place of the next one belongs.
static size_t put_page(struct buffer *file, size_t link, const char *from, int depth, int channels)
{
    struct relume_image image = load(from);
    const uint32_t base = (uint32_t)file->size;
    const uint32_t width = (uint32_t)image.width, height = (uint32_t)image.height;
    const uint32_t bytes = width * height * (uint32_t)(channels * depth / 8);
    struct buffer b = {0};
    for (size_t p = 0; p < (size_t)width * height; p++)
        for (int c = 0; c < channels; c++)
            if (depth == 32)
                put(&b, &image.data[3 * p + (size_t)c], 4);
            else
                put_little(&b, code(&image, p, c, channels, depth == 8 ? 255 : 65535), depth / 8);
    for (int c = 0; c < 4; c++)  // bits of each sample
        put_little(&b, (uint32_t)depth, 2);
    const uint32_t entries[][4] = {
        {256, 4, 1, width},
        {257, 4, 1, height},
        {258, 3, (uint32_t)channels, channels > 2 ? base + bytes : (uint32_t)depth},
        {259, 3, 1, 1},
        {262, 3, 1, channels < 3 ? 1 : 2},
        {273, 4, 1, base},
        {277, 3, 1, (uint32_t)channels},
        {278, 4, 1, height},
        {279, 4, 1, bytes},
        {338, 3, 1, 2},  // alpha, unassociated
        {339, 3, 1, depth == 32 ? 3 : 1},
    };
    const int count = (int)(sizeof entries / sizeof *entries);
    const bool alpha = channels == 4 || channels == 2;
    put_little(&b, (uint32_t)(alpha ? count : count - 1), 2);
    for (int i = 0; i < count; i++) {
        if (entries[i][0] == 338 && !alpha)
            continue;
        put_little(&b, entries[i][0], 2);
        put_little(&b, entries[i][1], 2);
        put_little(&b, entries[i][2], 4);
        put_little(&b, entries[i][3], 4);
    }
    put_little(&b, 0, 4);
    const uint32_t directory = base + bytes + 8;
    for (int i = 0; i < 4; i++)
        file->data[link + (size_t)i] = (uint8_t)(directory >> (8 * i));
    put(file, b.data, b.size);
    free(b.data);
    relume_image_destroy(&image);
    return file->size - 4;
}

static void write_tiff(const char *from, const char *to, int depth, int channels)
{
    struct buffer b = {0};
    put(&b, "II*\0\0\0\0\0", 8);
    put_page(&b, 4, from, depth, channels);
    save(&b, to);
}

static void write_pages(const char *to, int count, char **from)
{
    struct buffer b = {0};
    size_t link = 4;
    put(&b, "II*\0\0\0\0\0", 8);
    for (int i = 0; i < count; i++)
        link = put_page(&b, link, from[i], 16, 3);
    save(&b, to);
}

// ---------------------------------------------------------------- headers that promise too much

static void write_big_png(const char *to, uint32_t width, uint32_t height)
{
    struct buffer raw = {0}, file = {0};
    put_byte(&raw, 0);
    put_png(&file, width, height, 8, 3, &raw);
    free(raw.data);
    save(&file, to);
}

static void attribute(struct buffer *b, const char *name, const char *type, uint32_t size)
{
    put(b, name, strlen(name) + 1);
    put(b, type, strlen(type) + 1);
    put_little(b, size, 4);
}

static void write_big_exr(const char *to, uint32_t width, uint32_t height)
{
    struct buffer b = {0};
    const float one = 1.0f;
    put_little(&b, 20000630, 4);
    put_little(&b, 2, 4);
    attribute(&b, "channels", "chlist", 3 * 18 + 1);
    for (int c = 0; c < 3; c++) {
        put_byte(&b, (unsigned)"BGR"[c]);
        put_byte(&b, 0);
        put_little(&b, 1, 4);
        put_little(&b, 0, 4);
        put_little(&b, 1, 4);
        put_little(&b, 1, 4);
    }
    put_byte(&b, 0);
    attribute(&b, "compression", "compression", 1);
    put_byte(&b, 0);
    for (int i = 0; i < 2; i++) {
        attribute(&b, i ? "displayWindow" : "dataWindow", "box2i", 16);
        put_little(&b, 0, 4);
        put_little(&b, 0, 4);
        put_little(&b, width - 1, 4);
        put_little(&b, height - 1, 4);
    }
    attribute(&b, "lineOrder", "lineOrder", 1);
    put_byte(&b, 0);
    attribute(&b, "pixelAspectRatio", "float", 4);
    put(&b, &one, 4);
    attribute(&b, "screenWindowCenter", "v2f", 8);
    put_little(&b, 0, 4);
    put_little(&b, 0, 4);
    attribute(&b, "screenWindowWidth", "float", 4);
    put(&b, &one, 4);
    put_byte(&b, 0);
    save(&b, to);
}

// ---------------------------------------------------------------- CMYK JPEG
// Baseline, four components, no coefficients but DC: code of category n is n in 4 bits, "end of
// block" is one bit 0.

struct bits {
    struct buffer *out;
    uint32_t held;
    int count;
};

static void put_bits(struct bits *b, uint32_t value, int count)
{
    for (int i = count - 1; i >= 0; i--) {
        b->held = b->held << 1 | (value >> i & 1);
        if (++b->count == 8) {
            put_byte(b->out, b->held & 255);
            if ((b->held & 255) == 255)
                put_byte(b->out, 0);
            b->count = 0;
        }
    }
}

static void put_block(struct bits *b, int difference)
{
    int category = 0;
    for (int v = abs(difference); v; v >>= 1)
        category++;
    put_bits(b, (uint32_t)category, 4);
    const int code = difference < 0 ? difference + (1 << category) - 1 : difference;
    put_bits(b, (uint32_t)code, category);
    put_bits(b, 0, 1);
}

static void write_cmyk(const char *to, int width, int height, char **inks)
{
    struct buffer b = {0};
    put(&b,
        "\xff\xd8\xff\xee\0\x0e"
        "Adobe\0\x64\0\0\0\0\0",
        18);
    put(&b, "\xff\xdb\0\x43\0", 5);
    for (int i = 0; i < 64; i++)
        put_byte(&b, 8);  // DC is 8 times the mean
    put(&b, "\xff\xc0\0\x14\x08", 5);
    put_big(&b, (uint32_t)height, 2);
    put_big(&b, (uint32_t)width, 2);
    put(&b, "\x04\x01\x11\0\x02\x11\0\x03\x11\0\x04\x11\0", 13);
    put(&b, "\xff\xc4\0\x1c\0\0\0\0\x09\0\0\0\0\0\0\0\0\0\0\0\0", 21);
    for (int i = 0; i < 9; i++)
        put_byte(&b, (unsigned)i);
    put(&b, "\xff\xc4\0\x14\x10\x01\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 22);
    put(&b, "\xff\xda\0\x0e\x04\x01\0\x02\0\x03\0\x04\0\0\x3f\0", 16);
    struct bits bits = {.out = &b};
    for (int block = 0; block < (width + 7) / 8 * ((height + 7) / 8); block++)
        for (int c = 0; c < 4; c++)  // inks are stored inverted
            put_block(&bits, block ? 0 : 255 - atoi(inks[c]) - 128);
    put_bits(&bits, 0x7f, 7);  // fill the last byte
    put(&b, "\xff\xd9", 2);
    save(&b, to);
}

// ---------------------------------------------------------------- values

static size_t samples(const struct relume_image *image)
{
    return (size_t)image->width * (size_t)image->height * (size_t)image->channels;
}

static void poke(const char *from, const char *to, int x, int y, float value)
{
    struct relume_image image = load(from);
    for (int c = 0; c < 3; c++)
        image.data[3 * ((size_t)y * (size_t)image.width + (size_t)x) + (size_t)c] = value;
    save_float(&image, to);
    relume_image_destroy(&image);
}

static void gain(const char *from, const char *to, float factor)
{
    struct relume_image image = load(from);
    for (size_t i = 0; i < samples(&image); i++)
        image.data[i] *= factor;
    save_float(&image, to);
    relume_image_destroy(&image);
}

static void plane(const char *from, const char *to, float value)
{
    struct relume_image image = load(from);
    image.channels = 1;
    for (size_t i = 0; i < samples(&image); i++)
        image.data[i] = value;
    save_float(&image, to);
    relume_image_destroy(&image);
}

static int max_difference(const char *a, const char *b)
{
    struct relume_image x = load(a), y = load(b);
    double most = x.width == y.width && x.height == y.height ? 0.0 : 1e30;
    for (size_t i = 0; most < 1e30 && i < samples(&x); i++) {
        const double d = fabs((double)x.data[i] - (double)y.data[i]);
        most = d <= most ? most : d;
    }
    printf("%.9g\n", most);
    relume_image_destroy(&x);
    relume_image_destroy(&y);
    return 0;
}

static double code_of(float linear)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    return rint(255.0 * (double)relume_transfer_encode(srgb, fminf(fmaxf(linear, 0.0f), 1.0f)));
}

static void code_difference(const char *a, const char *b)
{
    struct relume_image x = load(a), y = load(b);
    const size_t pixels = (size_t)x.width * (size_t)x.height;
    const bool alike =
        x.width == y.width && x.height == y.height && x.channels >= 3 && y.channels >= 3;
    double all = 0.0;
    for (size_t i = 0; alike && i < 3 * pixels; i++)
        all += fabs(code_of(x.data[i / 3 * (size_t)x.channels + i % 3]) -
                    code_of(y.data[i / 3 * (size_t)y.channels + i % 3]));
    printf("%.4f\n", alike ? all / (double)(3 * pixels) : 255.0);
    relume_image_destroy(&x);
    relume_image_destroy(&y);
}

static void sum(const char *to, const char *a, const char *b)
{
    struct relume_image x = load(a), y = load(b);
    for (size_t i = 0; i < samples(&x); i++)
        x.data[i] += y.data[i];
    save_float(&x, to);
    relume_image_destroy(&x);
    relume_image_destroy(&y);
}

static void shift(const char *from, const char *to, int columns)
{
    struct relume_image in = load(from);
    const size_t c = (size_t)in.channels;
    for (int y = 0; y < in.height; y++)
        for (int x = in.width - 1; x > 0; x--) {
            float *row = in.data + (size_t)y * (size_t)in.width * c;
            const int left = x > columns ? x - columns : 0;
            memcpy(row + (size_t)x * c, row + (size_t)left * c, c * sizeof *row);
        }
    if (relume_image_save(&in, to, NULL))
        exit(3);
    relume_image_destroy(&in);
}

static void print_pixel(const char *path, int x, int y)
{
    struct relume_image image = load(path);
    const float *p = image.data + 3 * ((size_t)y * (size_t)image.width + (size_t)x);
    printf("%.9g %.9g %.9g\n", (double)p[0], (double)p[1], (double)p[2]);
    relume_image_destroy(&image);
}

static void print_size(const char *path)
{
    struct relume_image image = load(path);
    printf("%d %d\n", image.width, image.height);
    relume_image_destroy(&image);
}

static void convert(void (*write)(const char *, const char *, int, int), int argc, char **argv)
{
    for (int i = 5; i < argc; i++) {
        char to[4096];
        const char *slash = strrchr(argv[i], '/');
        snprintf(to, sizeof to, "%s/%s", argv[4], slash ? slash + 1 : argv[i]);
        write(argv[i], to, atoi(argv[2]), atoi(argv[3]));
    }
}

int main(int argc, char **argv)
{
    const char *what = argc > 1 ? argv[1] : "";
    if ((!strcmp(what, "png") || !strcmp(what, "tiff")) && argc > 5)
        convert(what[0] == 'p' ? write_png : write_tiff, argc, argv);
    else if (!strcmp(what, "pages") && argc > 3)
        write_pages(argv[2], argc - 3, argv + 3);
    else if (!strcmp(what, "poke") && argc == 7)
        poke(argv[2], argv[3], atoi(argv[4]), atoi(argv[5]), strtof(argv[6], NULL));
    else if (!strcmp(what, "gain") && argc == 5)
        gain(argv[2], argv[3], strtof(argv[4], NULL));
    else if (!strcmp(what, "plane") && argc == 5)
        plane(argv[2], argv[3], strtof(argv[4], NULL));
    else if (!strcmp(what, "bigpng") && argc == 5)
        write_big_png(argv[2], (uint32_t)atol(argv[3]), (uint32_t)atol(argv[4]));
    else if (!strcmp(what, "bigexr") && argc == 5)
        write_big_exr(argv[2], (uint32_t)atol(argv[3]), (uint32_t)atol(argv[4]));
    else if (!strcmp(what, "cmyk") && argc == 9)
        write_cmyk(argv[2], atoi(argv[3]), atoi(argv[4]), argv + 5);
    else if (!strcmp(what, "read") && argc == 5)
        print_pixel(argv[2], atoi(argv[3]), atoi(argv[4]));
    else if (!strcmp(what, "size") && argc == 3)
        print_size(argv[2]);
    else if (!strcmp(what, "maxdiff") && argc == 4)
        return max_difference(argv[2], argv[3]);
    else if (!strcmp(what, "codediff") && argc == 4)
        code_difference(argv[2], argv[3]);
    else if (!strcmp(what, "sum") && argc == 5)
        sum(argv[2], argv[3], argv[4]);
    else if (!strcmp(what, "shift") && argc == 5)
        shift(argv[2], argv[3], atoi(argv[4]));
    else
        return fprintf(stderr, "mkimage: see the head of tests/tools/mkimage.c\n"), 2;
    return 0;
}

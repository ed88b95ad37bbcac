// fuzz_picture.c - JPEG, plain EXR and PNG pictures made of noise, by our own readers; check sums
// of every second PNG are made right, so that what they guard is reached
#include "fuzz.h"
#include "made_exr.h"
#include "png_crc.h"

#include "image/image/jpeg.h"
#include "image/image/picture.h"
#include "image/image/picture_format.h"

static const struct relume_limits limits = {.max_side = 256, .max_pixels = 1 << 14};
static const char *const words[] = {
    "IHDR",       "IDAT",      "IEND", "sRGB",    "gAMA", "tEXt", "oFFs",           "channels",
    "dataWindow", "lineOrder", "type", "version", "RY",   "BY",   "chromaticities", NULL};

static uint32_t big_endian(const uint8_t *b)
{
    return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3];
}

static void mend(struct bytes b)
{
    for (size_t at = 8; at + 12 <= b.size;) {
        const uint32_t size = big_endian(b.data + at);
        if (size > b.size - at - 12)
            return;
        const uint32_t sum = png_crc(b.data + at + 4, 4 + size);
        for (int i = 0; i < 4; i++)
            b.data[at + 8 + size + (size_t)i] = (uint8_t)(sum >> (24 - 8 * i));
        at += 12 + size;
    }
}

static bool read_all(picture_reader *r)
{
    const struct picture_info *i = picture_info_of(r);
    const size_t row = (size_t)i->width * (size_t)i->channels;
    float *out = malloc(row * sizeof *out);
    relume_status status = out ? RELUME_OK : RELUME_ENOMEM;
    for (int y = 0; y < i->height && !status; y++)
        status = i->bytes ? picture_read_bytes(r, y, 1, (uint8_t *)out)
                          : picture_read_floats(r, y, 1, out);
    free(out);
    picture_close(&r);
    return !status;
}

static bool one(struct fuzz *f, struct bytes b)
{
    picture_reader *r;
    if (b.size % 2)
        mend(b);
    fuzz_store(f->path, b);
    if (!png_picture_open(&r, f->path, NULL, &limits, NULL) && r)
        return read_all(r);
    if (!jpeg_picture_open(&r, f->path, NULL, &limits, NULL))
        return read_all(r);
    return !exr_picture_open(&r, f->path, NULL, &limits, NULL) && r && read_all(r);
}

static void add(struct fuzz *f, int channels, bool half, const char *name)
{
    struct relume_image image;
    char path[96];
    snprintf(path, sizeof path, "%s/%s", f->folder, name);
    fixture_must(relume_image_create(&image, 13, 37, channels), "image");
    for (int i = 0; i < 13 * 37 * channels; i++)
        image.data[i] = (float)(i * 7 % 64) / 64.0f;
    fixture_must(relume_image_save(&image, path, relume_image_params(.half = half)), path);
    relume_image_destroy(&image);
    fuzz_add(f, fuzz_load(path));
}

static void add_jpeg(struct fuzz *f, int planes, bool baseline)
{
    static const int16_t blocks[2 * 5][64] = {{40, 3, -7}, {-20}, {0, 0, 0, 0, 9}};
    const struct jpeg_picture picture = {.width = 13,
                                         .height = 37,
                                         .planes = planes,
                                         .colour = JPEG_PLANES,
                                         .baseline = baseline,
                                         .step = {3, 4, 5},
                                         .coefficients = {blocks[0], blocks[0], blocks[0]}};
    struct bytes b;
    fixture_must(jpeg_encode(&b.data, &b.size, &picture), "jpeg");
    fuzz_add(f, b);
}

static float spot(char channel, int x, int y)
{
    return channel == 'Y' ? (float)(x * y % 7) : x == y ? 1.5f : -0.5f;
}

static void add_coarse(struct fuzz *f, bool alpha)
{
    static const float xy[8] = {0.7f, 0.3f, 0.2f, 0.8f, 0.1f, 0.05f, 0.31f, 0.33f};
    const struct made_exr m = {2, -2, 12, 36, alpha, alpha ? xy : NULL, spot};
    char path[96];
    snprintf(path, sizeof path, "%s/coarse.exr", f->folder);
    made_exr_write(path, &m);
    fuzz_add(f, fuzz_load(path));
}

int main(int argc, char **argv)
{
    struct fuzz f = {.words = words};
    fuzz_begin(&f, "fuzz_picture", argc, argv);
    add(&f, 1, false, "grey.png");
    add(&f, 3, false, "colour.png");
    add_jpeg(&f, 1, true);
    add_jpeg(&f, 3, false);
#ifndef NO_MODULES
    add(&f, 1, false, "grey.jpg");
    add(&f, 3, false, "colour.jpg");
#endif
    add(&f, 1, false, "grey.exr");
    add(&f, 3, true, "colour.exr");
    add_coarse(&f, false);
    add_coarse(&f, true);
    return fuzz_run(&f, argc, argv, one);
}

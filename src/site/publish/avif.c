// avif.c - a sheet of planes as an AVIF picture
//
// The container is that of MIAF, ISO/IEC 23000-22, with one item (AVIF 1.1): what it is, where it
// lies, its size, bits, coder and colours.
#include "site/publish/avif.h"

#include "core/base/memory.h"
#include "core/math/scalar.h"
#include "core/math/target_search.h"
#include "format/lossy/av1.h"
#include "image/image/jpeg.h"

#include <math.h>
#include <string.h>

enum { BOXES = 512, LEVEL = 31 };
enum { TRIAL_SIDE = 96 };
enum { LEAST = AV1_FINEST / AV1_STEPS, MOST = AV1_COARSEST / AV1_STEPS };

// ---------------------------------------------------------------- the container

struct boxes {
    uint8_t byte[BOXES];
    size_t size;
};

static void put(struct boxes *b, const void *from, size_t n)
{
    memcpy(b->byte + b->size, from, n);
    b->size += n;
}

static void put_number(struct boxes *b, size_t v, int bytes)
{
    for (int i = bytes - 1; i >= 0; i--)
        b->byte[b->size++] = (uint8_t)(v >> (8 * i));
}

// Where a box begins; its size is written when it ends.
static size_t begin(struct boxes *b, const char *kind)
{
    const size_t at = b->size;
    put_number(b, 0, 4);
    put(b, kind, 4);
    return at;
}

// A box that says its version and flags.
static size_t begin_full(struct boxes *b, const char *kind, size_t version)
{
    const size_t at = begin(b, kind);
    put_number(b, version << 24, 4);
    return at;
}

static void end(struct boxes *b, size_t at)
{
    const size_t size = b->size;
    b->size = at;
    put_number(b, size - at, 4);
    b->size = size;
}

static void put_properties(struct boxes *b, int width, int height)
{
    const size_t all = begin(b, "iprp"), list = begin(b, "ipco");
    size_t at = begin_full(b, "ispe", 0);
    put_number(b, (size_t)width, 4);
    put_number(b, (size_t)height, 4);
    end(b, at);
    at = begin_full(b, "pixi", 0);
    put(b, "\3\14\14\14", 4);  // three channels of 12 bits
    end(b, at);
    at = begin(b, "av1C");
    put_number(b, 0x81, 1);
    put_number(b, 2 << 5 | LEVEL, 1);  // professional profile
    put_number(b, 0x6000, 2);          // 12 bits, three planes at full resolution
    end(b, at);
    at = begin(b, "colr");
    put(b, "nclx\0\1\0\15\0\0\200", 11);  // sRGB; no matrix, full range
    end(b, at);
    end(b, list);
    at = begin_full(b, "ipma", 0);
    put_number(b, 1, 4);
    put_number(b, 1, 2);
    put(b, "\4\1\2\203\4", 5);  // four properties, the coder being essential
    end(b, at);
    end(b, all);
}

// All before the picture's own bytes, of which there are `size`.
static void put_boxes(struct boxes *b, int width, int height, size_t size)
{
    size_t at = begin(b, "ftyp");
    put(b, "avif\0\0\0\0avifmif1miaf", 20);
    end(b, at);
    const size_t meta = begin_full(b, "meta", 0);
    at = begin_full(b, "hdlr", 0);
    put(b, "\0\0\0\0pict\0\0\0\0\0\0\0\0\0\0\0\0", 21);
    end(b, at);
    at = begin_full(b, "pitm", 0);
    put_number(b, 1, 2);
    end(b, at);
    at = begin_full(b, "iloc", 0);
    put(b, "\104\0\0\1\0\1\0\0\0\1", 10);  // offsets and lengths of 4 bytes; one item in one piece
    const size_t place = b->size;
    put_number(b, 0, 4);
    put_number(b, size, 4);
    end(b, at);
    at = begin_full(b, "iinf", 0);
    put_number(b, 1, 2);
    const size_t entry = begin_full(b, "infe", 2);
    put(b, "\0\1\0\0av01", 9);
    end(b, entry);
    end(b, at);
    put_properties(b, width, height);
    end(b, meta);
    put_number(b, size + 8, 4);
    put(b, "mdat", 4);
    const size_t whole = b->size;
    b->size = place;
    put_number(b, whole, 4);
    b->size = whole;
}

// ---------------------------------------------------------------- the picture

// A picture on its way, or the middle of one.
struct sheet_picture {
    int width, height, planes;
    size_t n;
    const double *scale;  // of the sheet's coding
    const struct relume_log *log;
    float *wanted;      // [3][n], codes
    uint16_t *samples;  // [3][n]; AV1 has green, blue and red in this order
    uint16_t *decoded;  // likewise
};

static const size_t component[SHEET_PLANES] = {2, 0, 1};

static relume_status create_picture(struct sheet_picture *w, int width, int height)
{
    w->width = width;
    w->height = height;
    w->n = (size_t)width * (size_t)height;
    w->wanted = mem_array(SHEET_PLANES * w->n, sizeof *w->wanted);
    w->samples = mem_array(SHEET_PLANES * w->n, sizeof *w->samples);
    w->decoded = mem_array(SHEET_PLANES * w->n, sizeof *w->decoded);
    return w->wanted && w->samples && w->decoded ? RELUME_OK : RELUME_ENOMEM;
}

static void destroy_picture(struct sheet_picture *w)
{
    mem_free(w->wanted);
    mem_free(w->samples);
    mem_free(w->decoded);
}

static void fill_picture(struct sheet_picture *w, const struct sheet *sheet,
                         const struct sheet_result *jpeg)
{
    for (int p = 0; p < SHEET_PLANES; p++) {
        const double unit = 255.0 / jpeg->scale[p], zero = 255.0 * jpeg->bias[p];
        float *wanted = w->wanted + (size_t)p * w->n;
        for (size_t i = 0; i < w->n; i++) {
            const double v = p < w->planes ? (double)sheet->plane[p][i] * unit + zero : 128.0;
            wanted[i] = (float)fmin(fmax(v, 0.0), 255.0);
            w->samples[component[p] * w->n + i] =
                (uint16_t)rint((double)wanted[i] * AV1_TOP / 255.0);
        }
    }
}

// The middle of a picture, and of what its JPEG shows of it.
static void cut_middle(struct sheet_picture *to, uint8_t *codes, const struct sheet_picture *from,
                       const uint8_t *all)
{
    const size_t left = (size_t)(from->width - to->width) / 2;
    const size_t top = (size_t)(from->height - to->height) / 2, width = (size_t)to->width;
    for (size_t p = 0; p < SHEET_PLANES; p++)
        for (size_t y = 0; y < (size_t)to->height; y++) {
            const size_t at = p * from->n + (top + y) * (size_t)from->width + left;
            const size_t here = p * to->n + y * width;
            memcpy(to->wanted + here, from->wanted + at, width * sizeof *to->wanted);
            memcpy(to->samples + here, from->samples + at, width * sizeof *to->samples);
            memcpy(codes + here, all + at, width);
        }
}

static uint8_t code_of(uint16_t sample)
{
    return (uint8_t)((255 * (unsigned)sample + AV1_TOP / 2) / AV1_TOP);
}

// Squared error of the planes in their own units; a browser makes 8 bits of 12.
static double error_of(const struct sheet_picture *w, const uint8_t *codes)
{
    double sum = 0.0;
    for (size_t p = 0; p < (size_t)w->planes; p++) {
        double square = 0.0;
        for (size_t i = p * w->n; i < (p + 1) * w->n; i++) {
            const double d = (double)codes[i] - (double)w->wanted[i];
            square += d * d;
        }
        sum += square * w->scale[p] * w->scale[p];
    }
    return sum;
}

static relume_status encode(struct sheet_picture *w, int step, struct av1_bytes *bytes,
                            uint8_t *codes)
{
    const struct av1_shape shape = {w->width, w->height, SHEET_PLANES, 1, NULL};
    const struct av1_effort effort = {step * AV1_STEPS, AV1_GOOD_6_SCREEN};
    const uint16_t *samples = w->samples;
    mem_free(bytes->byte);
    *bytes = (struct av1_bytes){0};
    relume_status status = av1_encode(bytes, &samples, 1, &shape, &effort, 1, w->log);
    if (!status)
        status = av1_decode(w->decoded, &shape, bytes, NULL);
    for (size_t p = 0; !status && p < SHEET_PLANES; p++)
        for (size_t i = 0; i < w->n; i++)
            codes[p * w->n + i] = code_of(w->decoded[component[p] * w->n + i]);
    return status;
}

// Trials of one picture.
struct step_trials {
    struct sheet_picture *picture;
    struct av1_bytes bytes;
    uint8_t *codes;  // what its JPEG shows, and then what the last trial does
};

static relume_status try_step(void *context, double step, double *error)
{
    struct step_trials *t = context;
    const relume_status status = encode(t->picture, (int)step, &t->bytes, t->codes);
    *error = error_of(t->picture, t->codes);
    return status;
}

// The middle, or outwards by ever longer strides while an end is not known.
static double next_step(void *context, const struct target_bracket *b)
{
    const double stride = ldexp(1.0, b->trials);
    const bool has_low = b->low >= LEAST, has_high = b->high <= MOST;
    const double at = has_low && has_high ? floor((b->low + b->high) / 2.0)
                      : has_low           ? b->low + stride
                                          : b->high - stride;
    (void)context;
    return fmin(fmax(at, LEAST), MOST);
}

// The coarsest step whose error is at most `allowed`, near a guess.
static relume_status search_step(struct sheet_picture *picture, double allowed, int *step,
                                 uint8_t *codes)
{
    struct step_trials trials = {.picture = picture, .codes = codes};
    struct target_bracket b = {.low = LEAST - 1, .high = MOST + 1, .at = *step};
    const relume_status status =
        target_search(&b, &(const struct target_search){.target = allowed,
                                                        .may_equal = true,
                                                        .narrow = 1.0,
                                                        .measure = try_step,
                                                        .guess = next_step,
                                                        .context = &trials});
    *step = b.low < LEAST ? LEAST : (int)b.low;
    mem_free(trials.bytes.byte);
    return status;
}

static relume_status join(struct sheet_result *out, const struct sheet_picture *w,
                          const struct av1_bytes *bytes)
{
    struct boxes boxes = {.size = 0};
    put_boxes(&boxes, w->width, w->height, bytes->size);
    out->size = boxes.size + bytes->size;
    out->bytes = mem_array(out->size, 1);
    if (!out->bytes)
        return RELUME_ENOMEM;
    memcpy(out->bytes, boxes.byte, boxes.size);
    memcpy(out->bytes + boxes.size, bytes->byte, bytes->size);
    return RELUME_OK;
}

// By the middle of the picture: of all of it trials would take minutes.
static relume_status find_step(int *step, const struct sheet_picture *w,
                               const struct sheet_result *jpeg)
{
    struct sheet_picture trial = *w;
    struct jpeg_codes before = {0};
    relume_status status =
        create_picture(&trial, smaller_of(w->width, TRIAL_SIDE), smaller_of(w->height, TRIAL_SIDE));
    uint8_t *codes = mem_array(SHEET_PLANES * trial.n, 1);
    if (!status && !codes)
        status = RELUME_ENOMEM;
    if (!status)
        status = jpeg_decode(&before, jpeg->bytes, jpeg->size, "tile", NULL, NULL);
    if (!status) {
        cut_middle(&trial, codes, w, before.data);
        status = search_step(&trial, error_of(&trial, codes), step, codes);
    }
    jpeg_codes_free(&before);
    mem_free(codes);
    destroy_picture(&trial);
    return status;
}

relume_status avif_encode(struct sheet_result *out, uint8_t *codes, const struct sheet *sheet,
                          const struct sheet_result *jpeg, int *quantiser,
                          const struct relume_log *log)
{
    struct sheet_picture w = {.planes = sheet->planes, .scale = jpeg->scale, .log = log};
    struct av1_bytes bytes = {0};
    *out = (struct sheet_result){0};
    relume_status status = create_picture(&w, sheet->width, sheet->height);
    if (!status) {
        fill_picture(&w, sheet, jpeg);
        status = find_step(quantiser, &w, jpeg);
    }
    if (!status)
        status = encode(&w, *quantiser, &bytes, codes);
    if (!status)
        status = join(out, &w, &bytes);
    mem_free(bytes.byte);
    destroy_picture(&w);
    return status;
}

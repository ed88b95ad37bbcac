// export_blocks.c - eigenimages as compressed textures, their weights as cube maps
//
// Menzel 2011, 4.3 to 4.5: each coefficient is a picture in three colours, each colour of it scaled
// from its own range to 0 .. 255, or to half floats, and coded in blocks; its weight is one number
// a direction, in 8 bits on a cube map. What a shader does with them is written beside them. Any
// basis fits whose coefficients are in three colours: what is missing below, the range, stands in
// the JSON.
#include "exchange/formats/export.h"

#include "core/base/half.h"
#include "core/base/json_write.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/outdir.h"
#include "core/base/outfile.h"
#include "core/base/thread.h"
#include "core/math/scalar.h"
#include "format/coder/coding.h"
#include "image/block/dds.h"

#include <math.h>
#include <relume/relight/relight.h>
#include <stdio.h>
#include <string.h>

enum { FACES = 6, JUDGED = 16 };

// Half floats are the finer, the nearer to 0: where the least of a range is put, its greatest being
// 1. That which costs least on some rows of blocks is taken.
static const float feet[] = {0.5f, 0.25f, 0.0625f, 0.0f};
enum { FEET = sizeof feet / sizeof *feet, TRIED = 8 };

struct blocks {
    const struct export *e;
    const struct relume_codes *codes;
    const struct block_format *format;
    int terms, side;
    size_t texel;         // bytes of a colour that is coded
    float *least, *most;  // [planes]: what the texels 0 and 1 mean
    uint8_t **plane;      // [planes]: texels as a graphics card sees them
    float *low, *high;    // [terms]: of the weights
    uint8_t *coded;       // of one term
    float *value;         // likewise, [pixels][3]: 0 to 1
    uint8_t *rgb;         // likewise, [pixels][3]: what is coded
    int term;
    int step;  // of the rows of blocks that are coded
};

// ---------------------------------------------------------------- pictures

static size_t pixels_of(const struct blocks *b)
{
    return (size_t)b->codes->width * (size_t)b->codes->height;
}

static relume_status read_term(struct blocks *b, int term)
{
    const size_t n = pixels_of(b);
    float *value = mem_array(n, sizeof *value);
    for (size_t c = 0; value && c < 3; c++) {
        const size_t p = 3 * (size_t)term + c;
        relume_codes_plane(b->codes, (int)p, 0, n, value);
        b->least[p] = b->most[p] = value[0];
        for (size_t i = 1; i < n; i++) {
            b->least[p] = fminf(b->least[p], value[i]);
            b->most[p] = fmaxf(b->most[p], value[i]);
        }
        const float range = b->most[p] - b->least[p];
        for (size_t i = 0; i < n; i++)
            b->value[3 * i + c] = range > 0.0f ? (value[i] - b->least[p]) / range : 0.0f;
    }
    mem_free(value);
    b->term = term;
    return value ? RELUME_OK : RELUME_ENOMEM;
}

union texels {
    uint8_t byte[BLOCK_PIXELS][3];
    uint16_t half[BLOCK_PIXELS][3];
};

// Through a block and back.
static void code_block(const struct block_format *f, uint8_t *out, union texels *t)
{
    if (f->encode) {
        f->encode(out, (const uint8_t(*)[3])t->byte);
        f->decode(t->byte, out);
    } else {
        f->encode_halves(out, (const uint16_t(*)[3])t->half);
        f->decode_halves(t->half, out);
    }
}

// A row of blocks, coded and looked at; at the end of a side the last pixel is repeated.
static void code_row(void *context, size_t item, int worker)
{
    (void)worker;
    struct blocks *b = context;
    const int width = b->codes->width, height = b->codes->height;
    const int across = (width + 3) / BLOCK_SIDE, block = (int)item * b->step;
    const int top = block * BLOCK_SIDE;
    const size_t texel = b->texel;
    for (int x = 0; x < across; x++) {
        union texels rgb;
        uint8_t *bytes = rgb.byte[0];
        uint8_t *out = b->coded + ((size_t)block * (size_t)across + (size_t)x) * b->format->bytes;
        for (int i = 0; i < BLOCK_PIXELS; i++) {
            const int column = x * BLOCK_SIDE + i % BLOCK_SIDE, row = top + i / BLOCK_SIDE;
            const size_t at = (size_t)(row < height ? row : height - 1) * (size_t)width +
                              (size_t)(column < width ? column : width - 1);
            memcpy(bytes + 3 * texel * (size_t)i, b->rgb + 3 * texel * at, 3 * texel);
        }
        code_block(b->format, out, &rgb);
        for (int i = 0; i < BLOCK_PIXELS; i++) {
            const int column = x * BLOCK_SIDE + i % BLOCK_SIDE, row = top + i / BLOCK_SIDE;
            const size_t at = (size_t)row * (size_t)width + (size_t)column;
            for (size_t c = 0; c < 3 && column < width && row < height; c++)
                memcpy(b->plane[3 * (size_t)b->term + c] + texel * at,
                       bytes + texel * (3 * (size_t)i + c), texel);
        }
    }
}

// Every `step`th row of blocks.
static void code_rows(struct blocks *b, int step)
{
    const int rows = (b->codes->height + 3) / BLOCK_SIDE;
    b->step = step;
    thread_for(b->e->params->threads, (size_t)((rows + step - 1) / step), code_row, b);
}

static void round_bytes(struct blocks *b)
{
    for (size_t i = 0; i < 3 * pixels_of(b); i++)
        b->rgb[i] = (uint8_t)(255.0f * b->value[i] + 0.5f);
}

static void round_halves(struct blocks *b, float foot)
{
    uint16_t *half = (void *)b->rgb;
    for (size_t i = 0; i < 3 * pixels_of(b); i++)
        half[i] = half_from_float(foot + (1.0f - foot) * b->value[i]);
}

static double missed(const struct blocks *b, float foot, int step)
{
    const size_t width = (size_t)b->codes->width;
    double sum = 0.0;
    for (int y = 0; y < b->codes->height; y++)
        for (size_t x = 0; y / BLOCK_SIDE % step == 0 && x < width; x++)
            for (size_t c = 0; c < 3; c++) {
                const size_t at = (size_t)y * width + x;
                const uint16_t *plane = (void *)b->plane[3 * (size_t)b->term + c];
                const double seen = (double)((float_from_half(plane[at]) - foot) / (1.0f - foot));
                sum +=
                    (seen - (double)b->value[3 * at + c]) * (seen - (double)b->value[3 * at + c]);
            }
    return sum;
}

static float choose_foot(struct blocks *b)
{
    const int rows = (b->codes->height + 3) / BLOCK_SIDE, step = rows > TRIED ? rows / TRIED : 1;
    float best = feet[0];
    double least = INFINITY;
    for (int i = 0; i < FEET; i++) {
        round_halves(b, feet[i]);
        code_rows(b, step);
        const double miss = missed(b, feet[i], step);
        if (miss < least)
            best = feet[i];
        least = fmin(least, miss);
    }
    return best;
}

static void code_term(struct blocks *b)
{
    if (b->format->encode) {
        round_bytes(b);
    } else {
        const float foot = choose_foot(b);
        for (size_t p = 3 * (size_t)b->term; p < 3 * (size_t)b->term + 3; p++)
            b->least[p] -= (b->most[p] - b->least[p]) * foot / (1.0f - foot);
        round_halves(b, foot);
    }
    code_rows(b, 1);
}

static relume_status save(const struct blocks *b, const outdir *dir, const char *name,
                          const uint8_t *head, const uint8_t *data, size_t n)
{
    char path[4096];
    uint8_t *all = mem_array(DDS_HEAD + n, 1);
    if (!all)
        return RELUME_ENOMEM;
    snprintf(path, sizeof path, "%s/%s%02d.dds", outdir_path(dir), name, b->term);
    memcpy(all, head, DDS_HEAD);
    memcpy(all + DDS_HEAD, data, n);
    const relume_status status = outfile_save(path, all, DDS_HEAD + n, b->e->log);
    mem_free(all);
    return status;
}

static relume_status write_term(struct blocks *b, const outdir *dir, int term)
{
    const int width = b->codes->width, height = b->codes->height;
    uint8_t head[DDS_HEAD];
    relume_status status = read_term(b, term);
    if (status)
        return status;
    code_term(b);
    dds_head(head, width, height, b->format);
    return save(b, dir, "eigenimage", head, b->coded, block_bytes(width, height, b->format));
}

// ---------------------------------------------------------------- weights

// Of a texel, as graphics cards lay out cubes.
static struct relume_vec3 cube_direction(int face, double s, double t)
{
    const struct relume_vec3 faces[FACES] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t},
                                             {s, -1, -t}, {s, -t, 1},  {-s, -t, -1}};
    const struct relume_vec3 d = faces[face];
    const double length = sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    return (struct relume_vec3){d.x / length, d.y / length, d.z / length};
}

struct baking {
    const struct blocks *b;
    float *weight;  // [texels][terms]
};

static void bake_row(void *context, size_t item, int worker)
{
    (void)worker;
    const struct baking *k = context;
    const int side = k->b->side, face = (int)item / side, row = (int)item % side;
    float weights[3 * RELUME_MOST_COEFFICIENTS], constant[3];
    for (int x = 0; x < side; x++) {
        struct relume_vec3 from;
        const struct relume_vec3 d =
            cube_direction(face, 2.0 * (x + 0.5) / side - 1.0, 2.0 * (row + 0.5) / side - 1.0);
        (void)relume_coder_clamp(&from, k->b->codes->coder, d);
        relume_coder_weights(k->b->codes->coder, from, weights, constant);
        memcpy(k->weight + (item * (size_t)side + (size_t)x) * (size_t)k->b->terms, weights,
               (size_t)k->b->terms * sizeof *weights);
    }
}

static relume_status write_weights(struct blocks *b, const outdir *dir)
{
    const size_t texels = FACES * (size_t)b->side * (size_t)b->side, terms = (size_t)b->terms;
    struct baking k = {b, mem_array(texels, terms * sizeof *k.weight)};
    uint8_t *bytes = mem_array(texels, 1), head[DDS_HEAD];
    relume_status status = k.weight && bytes ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        thread_for(b->e->params->threads, FACES * (size_t)b->side, bake_row, &k);
    dds_cube_head(head, b->side);
    for (b->term = 0; !status && b->term < b->terms; b->term++) {
        float *low = &b->low[b->term], *high = &b->high[b->term];
        const float *w = k.weight + b->term;
        *low = *high = w[0];
        for (size_t i = 1; i < texels; i++) {
            *low = fminf(*low, w[i * terms]);
            *high = fmaxf(*high, w[i * terms]);
        }
        for (size_t i = 0; i < texels; i++)
            bytes[i] =
                (uint8_t)(*high > *low ? 255.0f * (w[i * terms] - *low) / (*high - *low) + 0.5f
                                       : 0.0f);
        status = save(b, dir, "weight", head, bytes, texels);
    }
    mem_free(k.weight);
    mem_free(bytes);
    return status;
}

// ---------------------------------------------------------------- what a shader needs

static const char *curve_words(const struct blocks *b, char text[32])
{
    if (b->codes->domain == RELUME_DOMAIN_LINEAR)
        return "linear";
    relume_transfer_text(b->codes->display, text, 32);
    return text;
}

static void put_term(struct jwriter *w, const struct blocks *b, int k)
{
    char image[32], weight[32];
    snprintf(image, sizeof image, "eigenimage%02d.dds", k);
    snprintf(weight, sizeof weight, "weight%02d.dds", k);
    jgap(w, "\n    ");
    jopen_object(w, NULL);
    jgap(w, " ");
    jput_text(w, "image", image);
    jput_floats(w, "min", b->least + 3 * k, 3, 9);
    jput_floats(w, "max", b->most + 3 * k, 3, 9);
    jgap(w, "\n      ");
    jput_text(w, "weight", weight);
    jput_number(w, "weight_min", (double)b->low[k], 9);
    jput_number(w, "weight_max", (double)b->high[k], 9);
    jgap(w, " ");
    jclose(w);
}

static relume_status write_description(const struct blocks *b, const outdir *dir)
{
    char curve[32];
    struct jwriter w = {0};
    jopen_object(&w, NULL);
    jgap(&w, " ");
    jput_text(&w, "format", "relume-eigenimages");
    jput_integer(&w, "version", 1);
    jgap(&w, "\n  ");
    jput_integer(&w, "width", b->codes->width);
    jput_integer(&w, "height", b->codes->height);
    jput_text(&w, "blocks", b->format->name);
    jput_text(&w, "curve", curve_words(b, curve));
    jgap(&w, "\n  ");
    jopen_array(&w, "terms");
    for (int k = 0; k < b->terms; k++)
        put_term(&w, b, k);
    jgap(&w, " ");
    jclose(&w);
    jgap(&w, " ");
    return jsave_in(&w, outdir_path(dir), "eigenimages.json", b->e->log);
}

static void print_shader(const void *context, FILE *out)
{
    const struct blocks *b = context;
    static const char head[] =
        "// Relights eigenimages: include this in a fragment shader. `light` is the direction\n"
        "// towards the lamp: x right, y up, z towards the viewer. Add lamps after this, as "
        "light.\n";
    fprintf(out,
            "%sconst int TERMS = %d;\nuniform sampler2DArray eigenimages;    // one layer a term\n"
            "uniform samplerCubeArray weights;      // one cube a term\n"
            "uniform vec3 least[TERMS], most[TERMS];   // \"min\", \"max\" of eigenimages.json\n"
            "uniform vec2 weight_range[TERMS];         // \"weight_min\", \"weight_max\"\n\n"
            "vec3 relit(vec2 uv, vec3 light)\n{\n    vec3 code = vec3(0.0);\n"
            "    for (int k = 0; k < TERMS; k++) {\n"
            "        float w = mix(weight_range[k].x, weight_range[k].y,\n"
            "                      texture(weights, vec4(light, float(k))).r);\n"
            "        code += w * mix(least[k], most[k], texture(eigenimages, vec3(uv, k)).rgb);\n"
            "    }\n",
            head, b->terms);
    const struct relume_transfer curve = b->codes->display;
    if (b->codes->domain == RELUME_DOMAIN_LINEAR)
        fputs("    return code;\n}\n", out);
    else if (curve.curve == RELUME_CURVE_LOG)
        fprintf(out, "    return %.9g * (exp(%.9g * code) - 1.0);\n}\n", (double)curve.gamma,
                log(1.0 + 1.0 / (double)curve.gamma));
    else if (curve.curve == RELUME_CURVE_GAMMA)
        fprintf(out, "    return pow(max(code, 0.0), vec3(%.9g));\n}\n", (double)curve.gamma);
    else
        fputs("    return mix(code / 12.92, pow(max((code + 0.055) / 1.055, 0.0), vec3(2.4)),\n"
              "               greaterThan(code, vec3(0.04045)));\n}\n",
              out);
}

static relume_status write_text(const struct blocks *b, const outdir *dir, const char *name,
                                void (*print)(const void *, FILE *))
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", outdir_path(dir), name);
    return relume_file_print(path, print, b, b->e->log);
}

// ---------------------------------------------------------------- how good, how small

static double squared_difference(const struct relume_image *a, const struct relume_image *b)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    const size_t n = 3 * (size_t)a->width * (size_t)a->height;
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        const float x = relume_transfer_encode(srgb, fminf(fmaxf(a->data[i], 0.0f), 1.0f));
        const float y = relume_transfer_encode(srgb, fminf(fmaxf(b->data[i], 0.0f), 1.0f));
        const double d = (double)rintf(255.0f * x) - (double)rintf(255.0f * y);
        sum += d * d;
    }
    return sum / (65025.0 * (double)n);
}

// Under some of the lights, against the file itself: what ranges and blocks cost.
static relume_status judge(double *psnr_db, const struct blocks *b, const float *step)
{
    const struct relume_coder_info *info = relume_coder_info(b->codes->coder);
    struct relume_codes seen = *b->codes;
    struct relume_image file = {0}, blocks = {0};
    const int n = info->lights < JUDGED ? info->lights : JUDGED;
    relume_status status = RELUME_OK;
    seen.storage = b->texel == 1 ? RELUME_STORE_8 : RELUME_STORE_HALF;
    seen.plane = (const void *const *)b->plane;
    seen.scale = step;
    seen.offset = b->least;
    *psnr_db = 0.0;
    for (int i = 0; !status && i < n; i++) {
        const struct relume_light light = {.direction = info->directions[i * info->lights / n],
                                           .rgb = {1.0f, 1.0f, 1.0f}};
        const struct relume_relight_params *p =
            relume_relight_params(.threads = b->e->params->threads);
        status = relume_relight(&file, b->codes, &light, 1, p);
        if (!status)
            status = relume_relight(&blocks, &seen, &light, 1, p);
        if (!status)
            *psnr_db += decibels(squared_difference(&file, &blocks)) / n;
    }
    relume_image_destroy(&file);
    relume_image_destroy(&blocks);
    return status;
}

static void say_sizes(const struct blocks *b)
{
    const double mib = 1048576.0, pixels = (double)pixels_of(b);
    const double each = (double)block_bytes(b->codes->width, b->codes->height, b->format);
    const double photographs = 6.0 * pixels * relume_coder_info(b->codes->coder)->lights;
    log_line(
        b->e->log, RELUME_NOTE,
        "%d eigenimage%s of %.4g MiB, %.4g MiB as half floats (%.3g:1); the photographs as half "
        "floats %.4g MiB (%.4g:1)",
        b->terms, relume_plural(b->terms), each / mib, 6.0 * pixels / mib, 6.0 * pixels / each,
        photographs / mib, photographs / (b->terms * each));
}

// ---------------------------------------------------------------- all of it

static relume_status create(struct blocks *b)
{
    const size_t planes = 3 * (size_t)b->terms, n = pixels_of(b);
    b->least = mem_array(planes, sizeof *b->least);
    b->most = mem_array(planes, sizeof *b->most);
    b->low = mem_array((size_t)b->terms, sizeof *b->low);
    b->high = mem_array((size_t)b->terms, sizeof *b->high);
    b->plane = mem_zeroed(planes, sizeof *b->plane);
    b->value = mem_array(n, 3 * sizeof *b->value);
    b->rgb = mem_array(n, 3 * b->texel);
    b->coded = mem_array(block_bytes(b->codes->width, b->codes->height, b->format), 1);
    bool good =
        b->least && b->most && b->low && b->high && b->plane && b->value && b->rgb && b->coded;
    for (size_t p = 0; good && p < planes; p++)
        good = (b->plane[p] = mem_array(n, b->texel)) != NULL;
    return good ? RELUME_OK : RELUME_ENOMEM;
}

static void destroy(struct blocks *b)
{
    for (int p = 0; b->plane && p < 3 * b->terms; p++)
        mem_free(b->plane[p]);
    mem_free(b->plane);
    mem_free(b->least);
    mem_free(b->most);
    mem_free(b->low);
    mem_free(b->high);
    mem_free(b->value);
    mem_free(b->rgb);
    mem_free(b->coded);
}

static relume_status write_all(struct blocks *b, const char *path)
{
    outdir *dir = NULL;
    relume_status status = outdir_open(&dir, path, b->e->params->force, b->e->params->log);
    for (int k = 0; !status && k < b->terms; k++) {
        status = write_term(b, dir, k);
        if (!status && !log_progress(b->e->params->log, "exporting", (k + 1.0) / b->terms))
            status = RELUME_ECANCEL;
    }
    if (!status)
        status = write_weights(b, dir);
    if (!status)
        status = write_description(b, dir);
    if (!status)
        status = write_text(b, dir, "relit.glsl", print_shader);
    return outdir_end(&dir, status);
}

static relume_status report_on(const struct blocks *b, struct relume_export_report *report)
{
    const size_t planes = 3 * (size_t)b->terms;
    float *step = mem_array(planes, sizeof *step);
    if (!step)
        return RELUME_ENOMEM;
    for (size_t p = 0; p < planes; p++)
        step[p] = (b->most[p] - b->least[p]) / (b->texel == 1 ? 255.0f : 1.0f);
    *report = (struct relume_export_report){
        .planes = (int)planes,
        .bytes_per_pixel = (double)b->terms *
                           (double)block_bytes(b->codes->width, b->codes->height, b->format) /
                           (double)pixels_of(b),
    };
    const relume_status status = judge(&report->psnr_db, b, step);
    mem_free(step);
    if (!status)
        say_sizes(b);
    return status;
}

relume_status export_blocks(const struct export *e, const char *path, enum relume_exchange format,
                            struct relume_export_report *report)
{
    enum { SIDE = 32 };
    const struct relume_codes *codes = e->source->codes;
    const struct relume_coder_info *info = relume_coder_info(codes->coder);
    if (info->joint || codes->books)
        return log_fail(e->log, RELUME_EUNFIT,
                        "%s; expected coefficients in three colours: encode with --basis eigen",
                        codes->books      ? "codebooks cannot be textures"
                        : info->luminance ? "coefficients of the luminance cannot be textures"
                                          : "components of the three colours together cannot be "
                                            "textures");
    struct blocks b = {.e = e,
                       .codes = codes,
                       .format = format == RELUME_EXCHANGE_BC1   ? &block_bc1
                                 : format == RELUME_EXCHANGE_BC7 ? &block_bc7
                                                                 : &block_bc6h,
                       .terms = info->coefficients,
                       .side = SIDE};
    b.texel = b.format->encode ? 1 : sizeof(uint16_t);
    relume_status status = create(&b);
    if (!status)
        status = write_all(&b, path);
    if (!status)
        status = report_on(&b, report);
    destroy(&b);
    return status;
}

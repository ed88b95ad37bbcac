// writer.c - coefficients become a relume file
#include <relume/pack.h>

#include "base/arena.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/names.h"
#include "base/params.h"
#include "image/curve.h"
#include "image/exr.h"
#include "image/half.h"
#include "pack/format.h"

#include <math.h>
#include <string.h>

enum { MOST_ATTRIBUTES = 24, MOST_WEIGHTS = 3 * 4096, HALF_CODES = 1024 };

relume_status relume_compression_parse(enum relume_compression *out, const char *name)
{
    static const char *const names[] = {[RELUME_COMPRESS_NONE] = "none",
                                        [RELUME_COMPRESS_RLE] = "rle",
                                        [RELUME_COMPRESS_ZIP] = "zip",
                                        [RELUME_COMPRESS_PIZ] = "piz"};
    const int i = name_find(name, names, sizeof names / sizeof *names);
    *out = (enum relume_compression)(i < 0 ? 0 : i);
    return i < 0 ? RELUME_EINVAL : RELUME_OK;
}

static enum exr_codec codec_of(enum relume_compression compression)
{
    switch (compression) {
    case RELUME_COMPRESS_NONE: return EXR_CODEC_NONE;
    case RELUME_COMPRESS_RLE: return EXR_CODEC_RLE;
    case RELUME_COMPRESS_ZIP: return EXR_CODEC_ZIP;
    case RELUME_COMPRESS_PIZ:
    case RELUME_COMPRESS_DEFAULT: break;
    }
    return EXR_CODEC_PIZ;
}

// ---------------------------------------------------------------- sample sources

// Channels sort by name, so B, G, R within a coefficient: the reverse of plane order.
static int file_channel(const struct relume_coder_info *info, int plane)
{
    if (info->luminance && plane >= info->coefficients)
        return 2 * info->coefficients + 2 - plane;
    return info->joint ? plane : plane / 3 * 3 + 2 - plane % 3;
}

// Codes beyond halves' whole numbers are UINT.
static bool is_wide(enum relume_storage storage)
{
    return storage == RELUME_STORE_FLOAT || relume_storage_top(storage) > 2047;
}

static enum exr_sample sample_of(enum relume_storage storage)
{
    return storage == RELUME_STORE_FLOAT ? EXR_SAMPLE_FLOAT
           : is_wide(storage)            ? EXR_SAMPLE_UINT
                                         : EXR_SAMPLE_HALF;
}

struct view_source {
    const relume_coefficients *coefficients;
    const uint16_t *half_of_code;  // [HALF_CODES]
};

static void store_row(enum relume_storage storage, const uint16_t *half_of_code, const void *codes,
                      size_t width, void *samples)
{
    const uint8_t *bytes = codes;
    const uint16_t *words = codes;
    uint16_t *halves = samples;
    uint32_t *uints = samples;
    if (storage == RELUME_STORE_HALF || storage == RELUME_STORE_FLOAT)
        memcpy(samples, codes, width * relume_storage_bytes(storage));
    else if (is_wide(storage))
        for (size_t x = 0; x < width; x++)
            uints[x] = words[x];
    else
        for (size_t x = 0; x < width; x++)
            halves[x] = half_of_code[storage == RELUME_STORE_8 ? bytes[x] : words[x]];
}

static relume_status view_rows(void *context, int row, int rows, void *samples)
{
    const struct view_source *source = context;
    const struct relume_coefficients_info *info = relume_coefficients_info(source->coefficients);
    const size_t width = (size_t)info->width, planes = (size_t)info->planes;
    const size_t code = relume_storage_bytes(info->storage);
    const size_t sample = is_wide(info->storage) ? 4 : 2;
    char *codes = mem_array(planes * width, code);  // a row stays in the cache
    relume_status status = codes ? RELUME_OK : RELUME_ENOMEM;
    for (size_t y = 0; !status && y < (size_t)rows; y++) {
        status = relume_coefficients_read(source->coefficients, row + (int)y, 1, codes);
        for (size_t p = 0; !status && p < planes; p++) {
            const size_t channel = (size_t)file_channel(relume_coder_info(info->coder), (int)p);
            store_row(info->storage, source->half_of_code, codes + p * width * code, width,
                      (char *)samples + (y * planes + channel) * width * sample);
        }
    }
    free(codes);
    return status;
}

static relume_status index_rows(void *context, int row, int rows, void *samples)
{
    const struct relume_pack_view *view = context;
    const size_t width = (size_t)relume_coefficients_info(view->coefficients)->width;
    const int books = relume_books_info(view->books)->books;
    uint32_t *out = samples;
    for (size_t y = (size_t)row; y < (size_t)(row + rows); y++)
        for (int b = 0; b < books; b++)
            for (size_t x = 0; x < width; x++)
                *out++ = view->index[b][y * width + x];
    return RELUME_OK;
}

struct book_source {
    const struct relume_book *book;
    const struct relume_coder_info *coder;
    const uint16_t *half_of_code;  // [HALF_CODES]
};

static relume_status book_row(void *context, int row, int rows, void *samples)
{
    const struct book_source *s = context;
    const struct relume_book *b = s->book;
    const size_t codes = (size_t)b->codes;
    (void)row, (void)rows;
    for (int d = 0; d < b->dim; d++) {
        const int channel =
            b->kind == RELUME_BOOK_PLANES ? file_channel(s->coder, b->first + d) - b->first : d;
        const size_t number = relume_storage_bytes(b->storage);
        store_row(b->storage, s->half_of_code,
                  (const char *)b->numbers + (size_t)d * codes * number, codes,
                  (char *)samples + (size_t)channel * codes * (is_wide(b->storage) ? 4 : 2));
    }
    return RELUME_OK;
}

struct preview {
    const relume_coefficients *coefficients;
    const struct relume_pack_view *view;
    float **relit;       // [books] -> [codes][3]: with codebooks, what their vectors add
    struct curve curve;  // of the coefficients
    float weights[MOST_WEIGHTS], constant[3];
};

// sum[x] += weight * coefficient
static void add_plane(const struct relume_coefficients_info *info, const void *codes, size_t at,
                      int plane, float weight, float *sum)
{
    const uint8_t *bytes = (const uint8_t *)codes + at;
    const uint16_t *words = (const uint16_t *)codes + at;
    const float *floats = (const float *)codes + at;
    const size_t width = (size_t)info->width;
    const float step = weight * info->scale[plane], base = weight * info->offset[plane];
    for (size_t x = 0; x < width; x++)
        sum[x] += info->storage == RELUME_STORE_8       ? step * (float)bytes[x] + base
                  : info->storage == RELUME_STORE_FLOAT ? weight * floats[x]
                  : info->storage == RELUME_STORE_HALF  ? step * float_from_half(words[x])
                                                        : step * (float)words[x] + base;
}

// sum[x] *= the pixel's colour
static void multiply_colour(const struct relume_coefficients_info *info, const void *codes,
                            size_t at, int plane, float *colour, float *sum)
{
    const size_t width = (size_t)info->width;
    memset(colour, 0, width * sizeof *colour);
    add_plane(info, codes, at, plane, 1.0f, colour);
    for (size_t x = 0; x < width; x++)
        sum[x] *= colour[x];
}

// `sum` has room for two rows.
static void preview_row(const struct preview *p, const void *codes, size_t row, float *sum,
                        uint16_t *out)
{
    const struct relume_coefficients_info *info = relume_coefficients_info(p->coefficients);
    const struct relume_coder_info *coder = relume_coder_info(info->coder);
    const size_t width = (size_t)info->width;
    for (int c = 0; c < 3; c++) {
        for (size_t x = 0; x < width; x++)
            sum[x] = p->constant[c];
        for (int k = 0; k < coder->coefficients; k++) {
            const float w = p->weights[c * coder->coefficients + k];
            const int plane = relume_coder_plane(coder, k, c);
            if (w != 0.0f)
                add_plane(info, codes, (row * (size_t)info->planes + (size_t)plane) * width, plane,
                          w, sum);
        }
        const int colour = coder->coefficients + c;
        if (coder->luminance)
            multiply_colour(info, codes, (row * (size_t)info->planes + (size_t)colour) * width,
                            colour, sum + width, sum);
        for (size_t x = 0; x < width; x++)
            out[(size_t)(2 - c) * width + x] =
                half_from_float(fminf(curve_decode(&p->curve, sum[x]), 65504.0f));
    }
}

static relume_status preview_indices(const struct preview *p, int row, int rows, void *samples)
{
    uint16_t *out = samples;
    const struct relume_coefficients_info *info = relume_coefficients_info(p->coefficients);
    const size_t width = (size_t)info->width;
    const int books = relume_books_info(p->view->books)->books;
    for (size_t y = 0; y < (size_t)rows; y++)
        for (size_t c = 0; c < 3; c++, out += width)
            for (size_t x = 0; x < width; x++) {
                const size_t pixel = ((size_t)row + y) * width + x;
                float sum = 0.0f;
                for (int b = 0; b < books; b++)
                    sum += p->relit[b][3 * (size_t)p->view->index[b][pixel] + 2 - c];
                out[x] = half_from_float(fminf(curve_decode(&p->curve, sum), 65504.0f));
            }
    return RELUME_OK;
}

static void blacken(const struct preview *p, int row, int rows, uint16_t *out)
{
    const struct relume_image *mask = p->view->mask;
    const size_t width = (size_t)relume_coefficients_info(p->coefficients)->width;
    for (size_t i = 0; mask && i < (size_t)rows * width; i++)
        if (!(mask->data[(size_t)row * width + i] > 0.5f))
            for (size_t c = 0; c < 3; c++)
                out[(i / width * 3 + c) * width + i % width] = 0;
}

static relume_status preview_planes(const struct preview *p, int row, int rows, void *samples)
{
    const struct relume_coefficients_info *info = relume_coefficients_info(p->coefficients);
    const size_t width = (size_t)info->width;
    void *codes =
        mem_array((size_t)rows * (size_t)info->planes * width, relume_storage_bytes(info->storage));
    float *sum = mem_array(2 * width, sizeof *sum);
    relume_status status = codes && sum ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status = relume_coefficients_read(p->coefficients, row, rows, codes);
    for (int y = 0; !status && y < rows; y++)
        preview_row(p, codes, (size_t)y, sum, (uint16_t *)samples + (size_t)y * 3 * width);
    free(codes);
    free(sum);
    return status;
}

static relume_status preview_rows(void *context, int row, int rows, void *samples)
{
    const struct preview *p = context;
    const relume_status status =
        (p->relit ? preview_indices : preview_planes)(p, row, rows, samples);
    if (!status)
        blacken(p, row, rows, samples);
    return status;
}

static relume_status plane_rows(void *context, int row, int rows, void *samples)
{
    const struct relume_image *image = context;
    const size_t width = (size_t)image->width;
    memcpy(samples, image->data + (size_t)row * width, (size_t)rows * width * sizeof(float));
    return RELUME_OK;
}

static relume_status mask_rows(void *context, int row, int rows, void *samples)
{
    const struct relume_image *image = context;
    const size_t width = (size_t)image->width;
    uint16_t *halves = samples;
    for (size_t i = 0; i < (size_t)rows * width; i++)
        halves[i] = half_from_float(image->data[(size_t)row * width + i] > 0.5f ? 1.0f : 0.0f);
    return RELUME_OK;
}

// ---------------------------------------------------------------- parts

struct builder {
    struct arena arena;
    struct exr_part *parts;
    int count;
    const struct relume_coder_info *coder;
    const char **channels;   // [planes], as the file sorts them
    uint16_t *half_of_code;  // [HALF_CODES]
};

static void add_int(struct exr_part *part, struct exr_attribute *list, const char *name, int value)
{
    list[part->attributes++] =
        (struct exr_attribute){.name = name, .kind = EXR_INT, .integer = value};
}

static void add_text(struct exr_part *part, struct exr_attribute *list, const char *name,
                     const char *text)
{
    list[part->attributes++] = (struct exr_attribute){.name = name, .kind = EXR_TEXT, .text = text};
}

static void add_floats(struct exr_part *part, struct exr_attribute *list, const char *name,
                       const float *floats, int count)
{
    list[part->attributes++] =
        (struct exr_attribute){.name = name, .kind = EXR_FLOATS, .floats = floats, .count = count};
}

static float *copy_doubles(struct arena *arena, const double *from, size_t n)
{
    float *to = arena_array(arena, n, sizeof *to);
    for (size_t i = 0; to && i < n; i++)
        to[i] = (float)from[i];
    return to;
}

static void put_planes(float to[6], const struct relume_geometry *g)
{
    const double slab[] = {g->uv_z,      g->st_z,      g->st_min[0],
                           g->st_min[1], g->st_max[0], g->st_max[1]};
    for (int i = 0; i < 6; i++)
        to[i] = (float)slab[i];
}

static void put_pose(float to[12], const struct relume_pose *pose)
{
    const struct relume_vec3 v[] = {pose->origin, pose->axis[0], pose->axis[1], pose->axis[2]};
    for (int i = 0; i < 4; i++) {
        to[3 * i] = (float)v[i].x;
        to[3 * i + 1] = (float)v[i].y;
        to[3 * i + 2] = (float)v[i].z;
    }
}

static bool describe_slabs(struct builder *b, struct exr_part *part, struct exr_attribute *list,
                           const struct relume_pack_contents *c)
{
    const int slabs = c->slabs ? c->slabs : 1;
    float *planes = arena_array(&b->arena, 6 * (size_t)slabs, sizeof *planes);
    float *pose = arena_array(&b->arena, 12 * (size_t)slabs, sizeof *pose);
    float *uv = arena_array(&b->arena, 2 * (size_t)c->views, sizeof *uv);
    if (!planes || !pose || !uv)
        return false;
    for (int i = 0; i < slabs; i++)
        put_planes(planes + 6 * i, c->slabs ? &c->slab[i] : &c->geometry);
    for (int i = 0; i < c->slabs; i++)
        put_pose(pose + 12 * i, &c->slab[i].pose);
    for (int i = 0; i < 2 * c->views; i++)
        uv[i] = (float)c->view[i / 2].uv[i % 2];
    add_floats(part, list, ATTR_SLAB, planes, 6 * slabs);
    if (c->slabs)
        add_floats(part, list, ATTR_POSE, pose, 12 * slabs);
    add_floats(part, list, ATTR_UV, uv, 2 * c->views);
    return true;
}

static bool describe_geometry(struct builder *b, struct exr_part *part, struct exr_attribute *list,
                              const struct relume_pack_contents *c)
{
    const struct relume_geometry *g = &c->geometry;
    add_text(part, list, ATTR_PROJECTION, relume_projection_name(g->projection));
    float *v;
    if (g->projection == RELUME_PLANAR) {
        const double window[] = {g->window_min[0], g->window_min[1], g->window_max[0],
                                 g->window_max[1], g->camera_z};
        v = copy_doubles(&b->arena, window, 5);
        add_floats(part, list, ATTR_WINDOW, v, 5);
        add_text(part, list, ATTR_CAMERA, g->perspective ? "perspective" : "orthographic");
    } else if (g->projection == RELUME_SLAB) {
        return describe_slabs(b, part, list, c);
    } else {
        const double panorama[] = {g->v_min,    g->v_max,    g->center.x,
                                   g->center.y, g->center.z, g->disc};
        const int count = g->disc ? 6 : 5;
        v = copy_doubles(&b->arena, panorama, (size_t)count);
        add_floats(part, list, ATTR_PANORAMA, v, count);
    }
    return v != NULL;
}

static bool describe_coder(struct builder *b, struct exr_part *part, struct exr_attribute *list,
                           const relume_coder *coder)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    const size_t n = (size_t)info->lights;
    float *lights = arena_array(&b->arena, 3 * n, sizeof *lights);
    float *ridge = arena_array(&b->arena, 1, sizeof *ridge);
    if (!lights || !ridge)
        return false;
    *ridge = (float)info->ridge;
    for (size_t i = 0; i < n; i++) {
        lights[3 * i] = (float)info->directions[i].x;
        lights[3 * i + 1] = (float)info->directions[i].y;
        lights[3 * i + 2] = (float)info->directions[i].z;
    }
    add_text(part, list, ATTR_BASIS, info->basis->name);
    add_int(part, list, ATTR_COEFFICIENTS, info->coefficients);
    add_text(part, list, ATTR_POLE, info->pole_y ? "y" : "z");
    add_int(part, list, ATTR_HEMISPHERICAL, info->hemispherical);
    add_floats(part, list, ATTR_RIDGE, ridge, 1);
    add_floats(part, list, ATTR_LIGHTS, lights, 3 * info->lights);
    if (info->transform)
        add_floats(part, list, ATTR_TRANSFORM, info->transform,
                   (info->basis->learned ? 3 : 1) * info->coefficients * info->functions);
    if (info->mean)
        add_floats(part, list, ATTR_MEAN, info->mean, 3 * info->functions);
    if (info->luminance)
        add_text(part, list, ATTR_COLOUR, "luminance");
    if (info->interpolant) {
        float *parameter = copy_doubles(&b->arena, info->parameter, 4);
        if (!parameter)
            return false;
        add_text(part, list, ATTR_INTERPOLANT, info->interpolant->name);
        add_floats(part, list, ATTR_PARAMETER, parameter, 4);
    }
    return true;
}

// What every code vector says for the preview's light.
static bool relight_books(struct builder *b, struct preview *p, const relume_books *books)
{
    const struct relume_books_info *info = relume_books_info(books);
    const struct relume_coder_info *coder =
        relume_coder_info(relume_coefficients_info(p->coefficients)->coder);
    p->relit = arena_array(&b->arena, (size_t)info->books, sizeof *p->relit);
    for (int i = 0; p->relit && i < info->books; i++) {
        p->relit[i] = arena_array(&b->arena, (size_t)info->codes[i], 3 * sizeof(float));
        for (int v = 0; p->relit[i] && v < 3 * info->codes[i]; v++) {
            const float *vector = info->vectors[i] + (size_t)(v / 3) * (size_t)info->planes;
            const int c = v % 3, k = coder->coefficients;
            float sum = i ? 0.0f : p->constant[c];
            for (int j = 0; j < k; j++)
                sum += p->weights[c * k + j] * vector[relume_coder_plane(coder, j, c)];
            p->relit[i][v] = coder->luminance ? sum * vector[k + c] : sum;
        }
        if (!p->relit[i])
            return false;
    }
    return p->relit != NULL;
}

// The middle view under a light from the viewer, panoramas from above.
static bool add_preview(struct builder *b, const struct relume_pack_contents *c,
                        enum exr_codec codec)
{
    static const char *const channels[] = {"B", "G", "R"};
    const relume_coefficients *middle = c->view[c->views / 2].coefficients;
    const struct relume_coefficients_info *info = relume_coefficients_info(middle);
    struct exr_part *part = &b->parts[b->count++];
    struct exr_attribute *list = arena_array(&b->arena, MOST_ATTRIBUTES, sizeof *list);
    struct preview *p = arena_array(&b->arena, 1, sizeof *p);
    char *display = arena_array(&b->arena, 32, 1);
    float *report = arena_array(&b->arena, 2, sizeof *report);
    if (!list || !p || !display || !report)
        return false;
    const bool pole_y = relume_coder_info(c->coder)->pole_y;
    const int slab = c->view[c->views / 2].slab;
    const struct relume_vec3 front =
        c->slabs ? c->slab[slab].pose.axis[2] : (struct relume_vec3){0.0, pole_y, !pole_y};
    const bool is_display = c->domain == RELUME_DOMAIN_DISPLAY;
    p->coefficients = middle;
    curve_init(&p->curve,
               is_display ? c->display : (struct relume_transfer){.curve = RELUME_CURVE_LINEAR});
    relume_coder_weights(c->coder, front, p->weights, p->constant);
    p->view = &c->view[c->views / 2];
    if (p->view->books && !relight_books(b, p, p->view->books))
        return false;
    relume_transfer_text(c->display, display, 32);
    *part = (struct exr_part){
        .name = "preview",
        .width = info->width,
        .height = info->height,
        .sample = EXR_SAMPLE_HALF,
        .codec = codec,
        .channels = 3,
        .channel = channels,
        .attribute = list,
        .rows = preview_rows,
        .context = p,
    };
    add_text(part, list, ATTR_FORMAT, FORMAT_NAME);
    add_int(part, list, ATTR_VERSION,
            c->slabs           ? FORMAT_SLABS
            : c->geometry.disc ? FORMAT_DISCS
                               : FORMAT_PLAIN);
    add_text(part, list, ATTR_CREATOR, "relume " RELUME_VERSION);
    add_text(part, list, ATTR_DOMAIN, is_display ? "display" : "linear");
    add_text(part, list, ATTR_DISPLAY, display);
    add_text(part, list, ATTR_STORAGE, relume_storage_name(info->storage));
    add_int(part, list, ATTR_VIEWS, c->views);
    report[0] = (float)c->report.fit_rms;
    report[1] = (float)c->report.store_rms;
    if (isfinite(report[0]) && isfinite(report[1]))
        add_floats(part, list, ATTR_REPORT, report, 2);
    if (p->view->books)
        add_int(part, list, ATTR_BOOKS, relume_books_info(p->view->books)->books);
    return describe_coder(b, part, list, c->coder) && describe_geometry(b, part, list, c);
}

// "c007.R" and so on, in the order in which the file sorts them.
static const char **channel_names(struct builder *b, const struct relume_coder_info *info)
{
    const char **names = arena_array(&b->arena, (size_t)info->planes, sizeof *names);
    for (int p = 0; names && p < info->planes; p++) {
        const bool colour = info->luminance && p >= info->coefficients;
        const char *name = colour
                               ? arena_format(&b->arena, "colour.%c", "RGB"[p - info->coefficients])
                           : info->joint ? arena_format(&b->arena, "c%04d", p)
                                         : arena_format(&b->arena, "c%04d.%c", p / 3, "RGB"[p % 3]);
        if (!name)
            return NULL;
        names[file_channel(info, p)] = name;
    }
    return names;
}

static bool fill_with_planes(struct builder *b, struct exr_part *part, struct exr_attribute *list,
                             const struct relume_pack_view *view)
{
    const struct relume_coefficients_info *info = relume_coefficients_info(view->coefficients);
    struct view_source *source = arena_array(&b->arena, 1, sizeof *source);
    if (!source)
        return false;
    *source = (struct view_source){view->coefficients, b->half_of_code};
    part->sample = sample_of(info->storage);
    part->channels = info->planes;
    part->channel = b->channels;
    part->rows = view_rows;
    part->context = source;
    add_floats(part, list, ATTR_SCALE, info->scale, info->planes);
    add_floats(part, list, ATTR_OFFSET, info->offset, info->planes);
    return true;
}

static bool fill_with_indices(struct exr_part *part, const struct relume_pack_view *view)
{
    static const char *const names[RELUME_MOST_BOOKS] = {"i0", "i1", "i2", "i3",
                                                         "i4", "i5", "i6", "i7"};
    part->sample = EXR_SAMPLE_UINT;
    part->channels = relume_books_info(view->books)->books;
    part->channel = names;
    part->rows = index_rows;
    part->context = (void *)(uintptr_t)view;
    return true;
}

// Channels of a codebook: those of its planes, or c0000.Y, or c0000.U, c0000.V, ...
static const char *const *book_channels(struct builder *b, const struct relume_book *book)
{
    if (book->kind == RELUME_BOOK_PLANES)
        return b->channels + book->first;
    const char **names = arena_array(&b->arena, (size_t)book->dim, sizeof *names);
    const bool luma = book->kind == RELUME_BOOK_LUMA;
    for (int d = 0; names && d < book->dim; d++) {
        names[d] = arena_format(&b->arena, "c%04d.%c", book->first / 3 + (luma ? d : d / 2),
                                luma ? 'Y' : "UV"[d % 2]);
        if (!names[d])
            return NULL;
    }
    return names;
}

static bool add_book(struct builder *b, const char *name, const struct relume_coder_info *coder,
                     const struct relume_book *book, enum exr_codec codec)
{
    static const char *const kinds[] = {"planes", "luma", "chroma"};
    struct exr_attribute *list = arena_array(&b->arena, 5, sizeof *list);
    struct book_source *source = arena_array(&b->arena, 1, sizeof *source);
    const char *const *channels = book_channels(b, book);
    if (!name || !list || !source || !channels)
        return false;
    *source = (struct book_source){book, coder, b->half_of_code};
    struct exr_part *part = &b->parts[b->count++];
    *part = (struct exr_part){
        .name = name,
        .width = book->codes,
        .height = 1,
        .sample = sample_of(book->storage),
        .codec = codec,
        .channels = book->dim,
        .channel = channels,
        .attribute = list,
        .rows = book_row,
        .context = source,
    };
    add_text(part, list, ATTR_BOOK, kinds[book->kind]);
    add_int(part, list, ATTR_FIRST, book->first);
    add_int(part, list, ATTR_LAST, book->last);
    add_floats(part, list, ATTR_SCALE, book->scale, book->dim);
    add_floats(part, list, ATTR_OFFSET, book->offset, book->dim);
    return true;
}

// The codebooks of a view, or of all of them (-1).
static bool add_books(struct builder *b, const relume_books *books, int view, enum exr_codec codec)
{
    const struct relume_books_info *info = relume_books_info(books);
    for (int i = 0; i < info->books; i++) {
        const char *name = view < 0 ? arena_format(&b->arena, "book%d", i)
                                    : arena_format(&b->arena, "view%04d.book%d", view, i);
        if (!add_book(b, name, b->coder, &info->book[i], codec))
            return false;
    }
    return true;
}

static bool shares_books(const struct relume_pack_contents *c)
{
    for (int i = 0; i < c->views; i++)
        if (!c->view[i].books || c->view[i].books != c->view[0].books)
            return false;
    return true;
}

static bool add_view(struct builder *b, const struct relume_pack_contents *c, int index,
                     enum exr_codec codec)
{
    static const char *const depth_channel[] = {"Z"}, *const mask_channel[] = {"A"};
    const struct relume_pack_view *view = &c->view[index];
    const struct relume_coefficients_info *info = relume_coefficients_info(view->coefficients);
    struct exr_attribute *list = arena_array(&b->arena, 4, sizeof *list);
    const char *name = arena_format(&b->arena, "view%04d", index);
    const char *depth = arena_format(&b->arena, "view%04d.depth", index);
    const char *mask = arena_format(&b->arena, "view%04d.mask", index);
    if (!list || !name || !depth || !mask)
        return false;
    struct exr_part *part = &b->parts[b->count++];
    *part = (struct exr_part){
        .name = name,
        .width = info->width,
        .height = info->height,
        .codec = codec,
        .attribute = list,
    };
    add_int(part, list, ATTR_VIEW, index);
    if (c->slabs)
        add_int(part, list, ATTR_MEMBER, view->slab);
    if (!(view->books ? fill_with_indices(part, view) : fill_with_planes(b, part, list, view)))
        return false;
    if (view->books && !shares_books(c) && !add_books(b, view->books, index, codec))
        return false;
    struct exr_part plane = {
        .width = info->width, .height = info->height, .codec = EXR_CODEC_ZIP, .channels = 1};
    if (view->depth) {
        plane.name = depth;
        plane.sample = EXR_SAMPLE_FLOAT;
        plane.channel = depth_channel;
        plane.rows = plane_rows;
        plane.context = (void *)(uintptr_t)view->depth;
        b->parts[b->count++] = plane;
    }
    if (view->mask) {
        plane.name = mask;
        plane.sample = EXR_SAMPLE_HALF;
        plane.channel = mask_channel;
        plane.rows = mask_rows;
        plane.context = (void *)(uintptr_t)view->mask;
        b->parts[b->count++] = plane;
    }
    return true;
}

relume_status relume_pack_write(const struct relume_pack_contents *contents, const char *path,
                                const struct relume_pack_params *params)
{
    const struct relume_pack_params p = PARAMS(relume_pack_params, params);
    struct builder b = {0};
    const size_t most_parts = 1 + (3 + RELUME_MOST_BOOKS) * (size_t)contents->views;
    if (!path && !p.writer)
        return RELUME_EINVAL;
    b.coder = relume_coder_info(contents->coder);
    b.parts = arena_array(&b.arena, most_parts, sizeof *b.parts);
    b.channels = channel_names(&b, b.coder);
    b.half_of_code = arena_array(&b.arena, HALF_CODES, sizeof *b.half_of_code);
    for (int i = 0; b.half_of_code && i < HALF_CODES; i++)
        b.half_of_code[i] = half_from_float((float)i);
    const enum exr_codec codec = codec_of(p.compression);
    bool good = b.parts && b.channels && b.half_of_code && add_preview(&b, contents, codec);
    if (good && shares_books(contents))
        good = add_books(&b, contents->view[0].books, -1, codec);
    for (int i = 0; good && i < contents->views; i++)
        good = add_view(&b, contents, i, codec);
    const relume_status status =
        good ? exr_write(path, p.writer, b.parts, b.count, p.threads, p.log) : RELUME_ENOMEM;
    arena_free(&b.arena);
    return status;
}

// object.c - a baked object in the site
//
// A texel shows its cluster's mean and components times its weights (bake.h). Here weights are
// bytes: over each cluster they fill 0 to 255, and what that shifts and stretches goes into mean
// and components, which stay halves. The page multiplies these by the light's weights, and adds.
#include "site/publish/object.h"

#include "core/base/tree.h"
#include "core/base/half.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/base64.h"
#include "image/image/exr.h"
#include "site/publish/annotations.h"
#include "site/publish/iiif.h"
#include "site/publish/model.h"
#include "site/publish/names.h"
#include "site/publish/turn.h"
#include "world/baked/baked.h"

#include <math.h>
#include <string.h>

enum { MOST_CODE = 65535 };
// What browsers take: a texture's side, colours under a light, all numbers.
enum { MOST_SIDE = 4096, MOST_VECTORS = 1 << 22, MOST_BYTES = 1 << 28 };

// ---------------------------------------------------------------- the arrays of object.bin

// In this order, each at a multiple of four bytes.
struct arrays {
    size_t corners, vertices, layers;
    uint32_t *index;          // [corners]
    uint16_t *value;          // [vectors][kept][3], halves
    uint16_t (*position)[4];  // [vertices]: of the box around them
    uint16_t (*place)[2];     // [vertices]: of the atlas
    uint16_t *cluster;        // [height][width]
    uint8_t (*weight)[4];     // [layers][height][width]
    int8_t (*frame)[4];       // [2][height][width]: normals, tangents; none of one view
    float box[2][3];
};

struct corner_code {
    uint16_t at[5];  // position, place
    uint32_t number;
};

static int compare_corners(const void *a, const void *b)
{
    const struct corner_code *x = a, *y = b;
    const int order = memcmp(x->at, y->at, sizeof x->at);
    return order ? order : x->number < y->number ? -1 : 1;
}

static uint16_t code_of(float value, float low, float high)
{
    const double share =
        high > low ? ((double)value - (double)low) / ((double)high - (double)low) : 0.0;
    return (uint16_t)lrint(fmin(fmax(share, 0.0), 1.0) * MOST_CODE);
}

// The corners in the order of their codes, for mem_free; equal ones are one vertex.
static struct corner_code *find_vertices(struct arrays *a, const relume_baked *b)
{
    struct corner_code *code = mem_array(a->corners, sizeof *code);
    for (size_t i = 0; code && i < a->corners; i++) {
        const struct atlas_corner *corner = &b->triangle[i / 3][i % 3];
        code[i].number = (uint32_t)i;
        for (int c = 0; c < 3; c++)
            code[i].at[c] = code_of(corner->position[c], a->box[0][c], a->box[1][c]);
        for (int c = 0; c < 2; c++)
            code[i].at[3 + c] = code_of(corner->place[c], 0.0f, 1.0f);
    }
    if (!code)
        return NULL;
    qsort(code, a->corners, sizeof *code, compare_corners);
    a->vertices = 0;
    for (size_t i = 0; i < a->corners; i++)
        a->vertices += !i || memcmp(code[i].at, code[i - 1].at, sizeof code->at) != 0;
    return code;
}

static void fill_mesh(struct arrays *a, const struct corner_code *code)
{
    size_t vertex = 0;
    for (size_t i = 0; i < a->corners; i++) {
        vertex += i && memcmp(code[i].at, code[i - 1].at, sizeof code->at) != 0;
        memcpy(a->position[vertex], code[i].at, 3 * sizeof *code->at);
        memcpy(a->place[vertex], code[i].at + 3, 2 * sizeof *code->at);
        a->index[code[i].number] = (uint32_t)vertex;
    }
}

// ---------------------------------------------------------------- weights as bytes

// The least and the largest weight of each component in each cluster, [clusters][components][2].
static void find_ranges(float *range, const relume_baked *b)
{
    const size_t n = (size_t)b->info.components,
                 texels = (size_t)b->info.width * (size_t)b->info.height;
    for (size_t i = 0; i < (size_t)b->info.clusters * n; i++) {
        range[2 * i] = INFINITY;
        range[2 * i + 1] = -INFINITY;
    }
    for (size_t i = 0; i < texels; i++)
        for (size_t k = 0; k < n && b->cluster[i] != BAKED_NONE; k++) {
            float *of = range + 2 * (b->cluster[i] * n + k);
            of[0] = fminf(of[0], b->weight[i * n + k]);
            of[1] = fmaxf(of[1], b->weight[i * n + k]);
        }
    for (size_t i = 0; i < (size_t)b->info.clusters * n; i++)
        if (!(range[2 * i] <= range[2 * i + 1]))
            range[2 * i] = range[2 * i + 1] = 0.0f;
}

static void fill_weights(struct arrays *a, const relume_baked *b, const float *range)
{
    const size_t n = (size_t)b->info.components,
                 texels = (size_t)b->info.width * (size_t)b->info.height;
    for (size_t i = 0; i < texels; i++) {
        a->cluster[i] = b->cluster[i];
        for (size_t k = 0; k < n && b->cluster[i] != BAKED_NONE; k++) {
            const float *of = range + 2 * (b->cluster[i] * n + k), width = of[1] - of[0];
            const float share = width > 0.0f ? (b->weight[i * n + k] - of[0]) / width : 0.0f;
            a->weight[k / 4 * texels + i][k % 4] = (uint8_t)lrintf(255.0f * share);
        }
    }
}

static void fill_values(struct arrays *a, const relume_baked *b, const float *range)
{
    const size_t n = (size_t)b->info.components, one = 3 * (size_t)b->views * (size_t)b->kept;
    for (size_t c = 0; c < (size_t)b->info.clusters; c++) {
        const float *mean = b->value + c * (1 + n) * one;
        uint16_t *to = a->value + c * (1 + n) * one;
        for (size_t i = 0; i < one; i++) {
            float sum = mean[i];
            for (size_t k = 0; k < n; k++) {
                const float *of = range + 2 * (c * n + k), value = mean[(1 + k) * one + i];
                sum += of[0] * value;
                to[(1 + k) * one + i] = half_from_float((of[1] - of[0]) * value);
            }
            to[i] = half_from_float(sum);
        }
    }
}

static void fill_frames(struct arrays *a, const relume_baked *b)
{
    const size_t texels = (size_t)b->info.width * (size_t)b->info.height;
    for (size_t i = 0; a->frame && i < texels; i++)
        for (int c = 0; c < 3; c++) {
            a->frame[i][c] = (int8_t)lrintf(127.0f * fminf(fmaxf(b->frame[i][c], -1.0f), 1.0f));
            a->frame[texels + i][c] =
                (int8_t)lrintf(127.0f * fminf(fmaxf(b->frame[i][3 + c], -1.0f), 1.0f));
        }
}

// ---------------------------------------------------------------- object.bin

// Memory for an array behind the others, or its size alone while there is no memory.
static void *take_array(char *memory, size_t *used, size_t count, size_t bytes)
{
    char *at = memory ? memory + *used : NULL;
    *used += (count * bytes + 3) / 4 * 4;
    return at;
}

static size_t lay_out(struct arrays *a, const relume_baked *b, char *memory)
{
    const size_t texels = (size_t)b->info.width * (size_t)b->info.height;
    size_t used = 0;
    a->index = take_array(memory, &used, a->corners, sizeof *a->index);
    a->value = take_array(memory, &used, 3 * b->vectors * (size_t)b->kept, sizeof *a->value);
    a->position = take_array(memory, &used, a->vertices, sizeof *a->position);
    a->place = take_array(memory, &used, a->vertices, sizeof *a->place);
    a->cluster = take_array(memory, &used, texels, sizeof *a->cluster);
    a->weight = take_array(memory, &used, a->layers * texels, sizeof *a->weight);
    a->frame = b->info.side > 1 ? take_array(memory, &used, 2 * texels, sizeof *a->frame) : NULL;
    return used;
}

static relume_status check(const relume_baked *b, const char *path, const struct relume_log *log)
{
    const struct relume_baked_info *i = &b->info;
    const uint64_t texel = 2 + 4 * (((uint64_t)i->components + 3) / 4) + (i->side > 1 ? 8 : 0);
    const uint64_t bytes = 6 * (uint64_t)b->vectors * (uint64_t)b->kept +
                           texel * (uint64_t)i->width * (uint64_t)i->height +
                           48 * (uint64_t)i->triangles;
    if (i->cube || i->per_view)
        return log_fail(log, RELUME_EUNSUPPORTED,
                        "%s: baked with %s, which no page shows; expected an object of 'relume "
                        "bake' without that",
                        path, i->cube ? "--haar" : "--per-view");
    if (i->width > MOST_SIDE || i->height > MOST_SIDE || b->vectors > MOST_VECTORS ||
        bytes > MOST_BYTES)
        return log_fail(
            log, RELUME_EUNSUPPORTED,
            "%s: an atlas of %d x %d and %.0f MB in all, too large for a page; expected at most %d "
            "a "
            "side and %d MB: bake it with a smaller --size, or fewer --views or --clusters",
            path, i->width, i->height, (double)bytes / 1e6, MOST_SIDE, MOST_BYTES / 1000000);
    return RELUME_OK;
}

static relume_status write_numbers(struct arrays *a, size_t *bytes, const struct site *site,
                                   const char *name, const relume_baked *b)
{
    *a = (struct arrays){.corners = 3 * b->info.triangles,
                         .layers = ((size_t)b->info.components + 3) / 4};
    relume_baked_box(a->box, b);
    struct corner_code *code = find_vertices(a, b);
    float *range =
        mem_array(2 * (size_t)b->info.clusters * (size_t)b->info.components, sizeof *range);
    char *memory = NULL, *file = mem_format("%s/object.bin", name);
    if (code)
        memory = mem_zeroed(*bytes = lay_out(a, b, NULL), 1);
    relume_status status = code && range && memory && file ? RELUME_OK : RELUME_ENOMEM;
    if (!status) {
        lay_out(a, b, memory);
        fill_mesh(a, code);
        find_ranges(range, b);
        fill_weights(a, b, range);
        fill_values(a, b, range);
        fill_frames(a, b);
        status = site_save_data(site, file, memory, *bytes);
    }
    mem_free(code);
    mem_free(range);
    mem_free(memory);
    mem_free(file);
    return status;
}

// ---------------------------------------------------------------- object.json

// Functions of the light by name and lights; the basis is `transform` times these, where it has
// one.
static void put_basis(struct jwriter *w, const struct baked_basis *b)
{
    const struct relume_coder_info *info = relume_coder_info(b->coder);
    const size_t n = (size_t)b->count * (size_t)info->functions;
    jgap(w, "\n  ");
    jopen_object(w, "basis");
    jput_text(w, "name", info->basis->name);
    jput_integer(w, "coefficients", b->count);
    jput_text(w, "pole", "y");
    if (info->transform) {
        jgap(w, "\n    ");
        base64_put(w, "transform", info->transform, n * sizeof *info->transform);
    }
    jgap(w, "\n    ");
    jopen_array(w, "lights");
    for (int i = 0; i < b->directions; i++) {
        const vec3 d = b->direction[i];
        jput_number(w, NULL, d.x, 9);
        jput_number(w, NULL, d.y, 9);
        jput_number(w, NULL, d.z, 9);
    }
    jclose(w);
    jput_integer(w, "functions", info->functions);
    jclose(w);
}

static void put_sizes(struct jwriter *w, const struct relume_baked_info *i, const struct arrays *a,
                      size_t bytes)
{
    jgap(w, "\n  ");
    jput_integer(w, "width", i->width);
    jput_integer(w, "height", i->height);
    jput_integer(w, "side", i->side);
    jput_integer(w, "clusters", i->clusters);
    jput_integer(w, "components", i->components);
    jgap(w, "\n  ");
    jput_integer(w, "triangles", (long long)i->triangles);
    jput_integer(w, "vertices", (long long)a->vertices);
    jgap(w, "\n  ");
    jput_floats(w, "min", a->box[0], 3, 9);
    jput_floats(w, "max", a->box[1], 3, 9);
    jgap(w, "\n  ");
    jput_integer(w, "bytes", (long long)bytes);
}

static relume_status write_json(const struct site *site, const struct page *page,
                                const relume_baked *b, const struct arrays *a, size_t bytes,
                                const relume_notes *notes)
{
    const struct relume_baked_info *i = &b->info;
    struct jwriter w = {.style = JSON_MARKUP};
    jopen_object(&w, NULL);
    jgap(&w, "\n  ");
    jput_text(&w, "format", "relume-web-object");
    jput_integer(&w, "version", 1);
    text_put_details(&w, page->name, &page->details);
    if (relume_notes_scale(notes) > 0.0) {
        jgap(&w, "\n  ");
        jput_number(&w, "mm_per_unit", relume_notes_scale(notes), 9);
    }
    if (relume_notes_count(notes)) {
        jgap(&w, "\n  ");
        jput_truth(&w, "notes", true);
    }
    if (!i->fixed)
        put_basis(&w, &b->basis);
    jgap(&w, "\n  ");
    jput_truth(&w, "fixed", i->fixed);
    jput_integer(&w, "coefficients", b->kept);
    put_sizes(&w, i, a, bytes);
    jgap(&w, "\n");
    return site_save_json(site, page->name, "object.json", true, &w);
}

// ---------------------------------------------------------------- notes

static relume_status open_notes(relume_notes **notes, const struct site *site, const char *path,
                                const struct arrays *a)
{
    struct relume_notes_file file = {.name = path_name(path), .solid = true};
    for (int k = 0; k < 2; k++)
        for (int c = 0; c < 3; c++)
            file.box[k][c] = (double)a->box[k][c];
    return relume_notes_open(notes, path, &file, site->log);
}

// ---------------------------------------------------------------- the whole

relume_status object_write(const struct site *site, struct page *page, const char *path,
                           struct relume_publish_report *report)
{
    relume_baked *b = NULL;
    relume_notes *notes = NULL;
    struct arrays a;
    size_t bytes = 0;
    relume_status status = relume_baked_open(&b, path, site->params->limits, site->log);
    if (!status)
        status = check(b, path, site->log);
    if (!status)
        status = write_numbers(&a, &bytes, site, page->name, b);
    if (!status)
        status = open_notes(&notes, site, path, &a);
    if (!status)
        status = write_json(site, page, b, &a, bytes, notes);
    if (!status)
        status = turn_write(site, page, path);
    if (!status)
        status = model_write(site, page, b);
    const bool noted = !status && relume_notes_count(notes) > 0;
    if (!status)
        status = iiif_write_object(site, page, noted);
    if (noted && !status)
        status = annotations_write(site, notes, path, NULL, page, false);
    relume_notes_destroy(&notes);
    report->bytes = report->first_bytes = bytes;
    relume_baked_destroy(&b);
    return status;
}

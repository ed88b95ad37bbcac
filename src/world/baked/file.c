// file.c - a baked object as an OpenEXR file (docs/baking.md): a part for each of its arrays
#include "world/baked/baked.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "image/image/exr.h"

#include <math.h>
#include <string.h>

enum { VERSION = 1, ACROSS = 64, SIDE_MOST = 65536 };
enum { ATLAS, WEIGHTS, FRAMES, COMPONENTS, MESH, PLACES, PARTS };

static size_t texels(const relume_baked *b)
{
    return (size_t)b->info.width * (size_t)b->info.height;
}

// ---------------------------------------------------------------- where a value lies

// Blocks lie side by side: clusters of texels ...
static uint16_t *cluster_at(const relume_baked *b, int x, int y)
{
    const int width = b->info.width;
    return b->cluster + (size_t)(x / width) * texels(b) + (size_t)y * (size_t)width +
           (size_t)(x % width);
}

// ... and their weights, one component below the other.
static float *weight_at(const relume_baked *b, int x, int y)
{
    const int height = b->info.height, n = b->info.components;
    return b->weight + (size_t)(cluster_at(b, x, y % height) - b->cluster) * (size_t)n +
           (size_t)(y / height);
}

// A row is a mean or a component of a cluster, with all views of all blocks.
static size_t number_at(const relume_baked *b, int x, int y)
{
    const int all = x / b->kept, rows = 1 + b->info.components;
    const size_t vector = baked_vector(b, all / b->views, y / rows) +
                          (size_t)(y % rows) * (size_t)b->views + (size_t)(all % b->views);
    return vector * (size_t)b->kept + (size_t)(x % b->kept);
}

static struct atlas_corner *corner_at(const relume_baked *b, int x, int y)
{
    const size_t triangle = (size_t)y * ACROSS + (size_t)(x / 3);
    return triangle < b->info.triangles ? &b->triangle[triangle][x % 3] : NULL;
}

static float get_atlas(const relume_baked *b, int x, int y, int c)
{
    (void)c;
    return *cluster_at(b, x, y);
}

static float get_weights(const relume_baked *b, int x, int y, int c)
{
    (void)c;
    return *weight_at(b, x, y);
}

static float get_frames(const relume_baked *b, int x, int y, int c)
{
    return b->frame[(size_t)y * (size_t)b->info.width + (size_t)x][c];
}

static float get_components(const relume_baked *b, int x, int y, int c)
{
    return b->value[3 * number_at(b, x, y) + (size_t)(2 - c)];
}

static float get_places(const relume_baked *b, int x, int y, int c)
{
    (void)c;
    return b->place[number_at(b, x, y)];
}

// In the order of the channels' names.
static float *mesh_value(struct atlas_corner *corner, int c)
{
    return c < 3 ? &corner->normal[c] : c < 5 ? &corner->place[c - 3] : &corner->position[c - 5];
}

static float get_mesh(const relume_baked *b, int x, int y, int c)
{
    struct atlas_corner *corner = corner_at(b, x, y);
    return corner ? *mesh_value(corner, c) : 0.0f;
}

// What is read is believed where these say true.
static bool set_atlas(const relume_baked *b, int x, int y, int c, float value)
{
    (void)c;
    const bool good = value == BAKED_NONE || (value >= 0.0f && value < (float)b->info.clusters);
    *cluster_at(b, x, y) = good ? (uint16_t)value : BAKED_NONE;
    return good;
}

static bool set_weights(const relume_baked *b, int x, int y, int c, float value)
{
    (void)c;
    *weight_at(b, x, y) = value;
    return isfinite(value);
}

static bool set_frames(const relume_baked *b, int x, int y, int c, float value)
{
    b->frame[(size_t)y * (size_t)b->info.width + (size_t)x][c] = value;
    return fabsf(value) <= 1.01f;
}

static bool set_components(const relume_baked *b, int x, int y, int c, float value)
{
    b->value[3 * number_at(b, x, y) + (size_t)(2 - c)] = value;
    return isfinite(value);
}

static bool set_places(const relume_baked *b, int x, int y, int c, float value)
{
    (void)c;
    const bool good = value >= 0.0f && value < (float)b->basis.count;
    b->place[number_at(b, x, y)] = good ? (uint16_t)value : 0;
    return good;
}

static bool set_mesh(const relume_baked *b, int x, int y, int c, float value)
{
    const float MOST = 1e15f;  // squares of lengths still are finite
    struct atlas_corner *corner = corner_at(b, x, y);
    if (corner)
        *mesh_value(corner, c) = value;
    return fabsf(value) < MOST;
}

static const char *const gray[] = {"Y"}, *const colour[] = {"B", "G", "R"};
static const char *const axes[] = {"nx", "ny", "nz", "tx", "ty", "tz"};
static const char *const corners[] = {"nx", "ny", "nz", "u", "v", "x", "y", "z"};

static const struct {
    const char *name;
    enum exr_sample sample;
    int channels;
    const char *const *channel;
    float (*get)(const relume_baked *b, int x, int y, int channel);
    bool (*set)(const relume_baked *b, int x, int y, int channel, float value);
} parts[PARTS] = {
    [ATLAS] = {"atlas", EXR_SAMPLE_UINT, 1, gray, get_atlas, set_atlas},
    [WEIGHTS] = {"weights", EXR_SAMPLE_HALF, 1, gray, get_weights, set_weights},
    [FRAMES] = {"frames", EXR_SAMPLE_HALF, 6, axes, get_frames, set_frames},
    [COMPONENTS] = {"components", EXR_SAMPLE_HALF, 3, colour, get_components, set_components},
    [MESH] = {"mesh", EXR_SAMPLE_FLOAT, 8, corners, get_mesh, set_mesh},
    [PLACES] = {"places", EXR_SAMPLE_UINT, 1, gray, get_places, set_places},
};

static void size_of(int64_t size[2], const relume_baked *b, int part)
{
    const struct relume_baked_info *i = &b->info;
    const int64_t across = (int64_t)i->width * b->blocks,
                  rows = (int64_t)i->clusters * (1 + i->components);
    const int64_t row = (int64_t)b->blocks * b->views * b->kept;
    const int64_t sizes[PARTS][2] = {
        [ATLAS] = {across, i->height},
        [WEIGHTS] = {across, (int64_t)i->height * i->components},
        [FRAMES] = {i->width, i->height},
        [COMPONENTS] = {row, rows},
        [MESH] = {3 * ACROSS, (int64_t)((i->triangles + ACROSS - 1) / ACROSS)},
        [PLACES] = {row, rows},
    };
    memcpy(size, sizes[part], sizeof sizes[part]);
}

static bool has_part(const relume_baked *b, int part)
{
    return part == PLACES ? b->info.cube > 0 : part == FRAMES ? b->info.side > 1 : true;
}

// ---------------------------------------------------------------- writing

struct source {
    const relume_baked *b;
    int part, width;
};

static relume_status fill_rows(void *context, int row, int rows, void *samples)
{
    const struct source *s = context;
    const int channels = parts[s->part].channels;
    const size_t bytes = exr_sample_bytes(parts[s->part].sample);
    float *line = mem_array((size_t)s->width, sizeof *line);
    char *to = samples;
    if (!line)
        return RELUME_ENOMEM;
    for (int y = row; y < row + rows; y++)
        for (int c = 0; c < channels; c++, to += bytes * (size_t)s->width) {
            for (int x = 0; x < s->width; x++)
                line[x] = parts[s->part].get(s->b, x, y, c);
            exr_from_floats(to, parts[s->part].sample, line, (size_t)s->width);
        }
    mem_free(line);
    return RELUME_OK;
}

relume_status baked_check_file(const relume_baked *b, const struct relume_log *log)
{
    for (int k = 0; k < PARTS; k++) {
        int64_t size[2];
        size_of(size, b, k);
        if (has_part(b, k) && (size[0] > SIDE_MOST || size[1] > SIDE_MOST))
            return log_fail(
                log, RELUME_ELIMIT,
                "the baked object: part '%s' of its file would have %lld x %lld values; "
                "expected at most %d a side: a smaller atlas or mesh, or fewer "
                "components, clusters or views",
                parts[k].name, (long long)size[0], (long long)size[1], SIDE_MOST);
    }
    return RELUME_OK;
}

relume_status relume_baked_save(const relume_baked *b, const char *path,
                                const struct relume_log *log)
{
    const struct relume_baked_info *i = &b->info;
    const float error = (float)i->error;
    const struct exr_attribute about[] = {
        {.name = "bakedVersion", .kind = EXR_INT, .integer = VERSION},
        {.name = "basis",
         .kind = EXR_TEXT,
         .text = i->fixed  ? "fixed"
                 : i->cube ? "haar"
                           : i->basis->name},
        {.name = "coefficients", .kind = EXR_INT, .integer = i->cube ? i->cube : i->coefficients},
        {.name = "lightDirections", .kind = EXR_INT, .integer = b->basis.directions},
        {.name = "kept", .kind = EXR_INT, .integer = i->kept},
        {.name = "viewSide", .kind = EXR_INT, .integer = i->side},
        {.name = "clusters", .kind = EXR_INT, .integer = i->clusters},
        {.name = "components", .kind = EXR_INT, .integer = i->components},
        {.name = "perView", .kind = EXR_INT, .integer = i->per_view},
        {.name = "bounces", .kind = EXR_INT, .integer = i->bounces},
        {.name = "triangles", .kind = EXR_INT, .integer = (int)i->triangles},
        {.name = "compressionError", .kind = EXR_FLOATS, .floats = &error, .count = 1},
    };
    struct source source[PARTS];
    struct exr_part part[PARTS];
    int n = 0;
    const relume_status status = baked_check_file(b, log);
    if (status)
        return status;
    for (int k = 0; k < PARTS; k++) {
        int64_t size[2];
        if (!has_part(b, k))
            continue;
        size_of(size, b, k);
        source[n] = (struct source){b, k, (int)size[0]};
        part[n] = (struct exr_part){
            .name = parts[k].name,
            .width = (int)size[0],
            .height = (int)size[1],
            .sample = parts[k].sample,
            .codec = EXR_CODEC_ZIP,
            .channels = parts[k].channels,
            .channel = parts[k].channel,
            .attributes = n ? 0 : (int)(sizeof about / sizeof *about),
            .attribute = about,
            .rows = fill_rows,
            .context = &source[n],
        };
        n++;
    }
    return exr_write(path, NULL, part, n, false, 0, log);
}

// ---------------------------------------------------------------- reading

struct reader {
    const char *path;
    exr_file *file;
    struct relume_limits limits;
    const struct relume_log *log;
};

static int find_part(const struct reader *r, int part)
{
    for (int k = 0; k < exr_part_count(r->file); k++)
        if (!strcmp(exr_part_info(r->file, k).name, parts[part].name))
            return k;
    return -1;
}

static relume_status read_number(int *out, const struct reader *r, const char *name, int low,
                                 int high)
{
    if (!exr_get_int(r->file, 0, name, out))
        return log_fail(r->log, RELUME_EFORMAT,
                        "%s: lacks the attribute '%s'; expected a file that relume bake has made",
                        r->path, name);
    return *out >= low && *out <= high
               ? RELUME_OK
               : log_fail(r->log, RELUME_EFORMAT, "%s: its attribute '%s' is %d; expected %d to %d",
                          r->path, name, *out, low, high);
}

static relume_status read_basis(relume_baked *b, const struct reader *r)
{
    struct relume_baked_info *i = &b->info;
    const char *name = exr_get_text(r->file, 0, "basis");
    int directions = 0;
    relume_status status =
        read_number(&i->coefficients, r, "coefficients", 1, RELUME_MOST_COEFFICIENTS);
    if (!status)
        status = read_number(&directions, r, "lightDirections", 0, r->limits.max_lights);
    if (!status)
        status =
            read_number(&i->kept, r, "kept", 0, RELUME_BAKED_MOST_CUBE * RELUME_BAKED_MOST_CUBE);
    if (status)
        return status;
    i->fixed = name && !strcmp(name, "fixed");
    i->cube = name && !strcmp(name, "haar") ? i->coefficients : 0;
    i->basis = name && !i->fixed && !i->cube ? relume_basis_find(name) : NULL;
    if (i->fixed && i->coefficients == 1) {
        b->basis.count = 1;
    } else if (i->cube) {
        const bool good = i->cube >= 2 && i->cube <= RELUME_BAKED_MOST_CUBE &&
                          !(i->cube & (i->cube - 1)) && i->kept >= 1 &&
                          i->kept <= i->cube * i->cube;
        status = good ? basis_make(&b->basis, NULL, 0, i->cube, 0, r->log)
                      : log_wrong(r->log, r->path,
                                  "its attributes 'coefficients' and 'kept' fit no cube of lights",
                                  "2, 4, 8, 16 or 32, and from 1 to its square");
    } else if (i->basis && !i->basis->learned && !i->basis->upper_only && !i->basis->joint &&
               i->basis->has_count(i->coefficients) && directions >= i->coefficients) {
        status = basis_make(&b->basis, i->basis, i->coefficients, 0, directions, r->log);
    } else {
        status = log_wrong(r->log, r->path,
                           "its basis of light is unknown, or has another number of coefficients",
                           "fixed, haar, or one for light from all sides");
    }
    i->coefficients = b->basis.count;
    b->kept = i->cube ? 6 * i->kept : i->coefficients;
    return status;
}

static relume_status read_about(relume_baked *b, const struct reader *r)
{
    struct relume_baked_info *i = &b->info;
    int version = 0, per_view = 0, triangles = 0, n = 0;
    if (!exr_get_int(r->file, 0, "bakedVersion", &version) || version != VERSION)
        return log_wrong(r->log, r->path, "its attribute 'bakedVersion' is not 1",
                         "an object that relume bake has made, by no newer version");
    relume_status status = read_basis(b, r);
    if (!status)
        status = read_number(&i->side, r, "viewSide", 1, RELUME_BAKED_MOST_SIDE);
    if (!status)
        status = read_number(&i->clusters, r, "clusters", 1, RELUME_BAKED_MOST_CLUSTERS);
    if (!status)
        status = read_number(&i->components, r, "components", 1, RELUME_BAKED_MOST_COMPONENTS);
    if (!status)
        status = read_number(&per_view, r, "perView", 0, 1);
    if (!status)
        status = read_number(&i->bounces, r, "bounces", 0, 64);
    if (!status)
        status = read_number(&triangles, r, "triangles", 1, ACROSS * SIDE_MOST);
    if (status)
        return status;
    i->per_view = per_view;
    i->triangles = (size_t)triangles;
    b->blocks = per_view ? i->side * i->side : 1;
    b->views = i->side * i->side / b->blocks;
    const float *error = exr_get_floats(r->file, 0, "compressionError", &n);
    i->error = error && n == 1 && isfinite(*error) ? (double)*error : 0.0;
    return RELUME_OK;
}

// The atlas says how large all is.
static relume_status check_sizes(relume_baked *b, const struct reader *r)
{
    for (int k = 0; k < PARTS; k++) {
        int64_t size[2];
        if (!has_part(b, k))
            continue;
        const int at = find_part(r, k);
        if (at < 0)
            return log_fail(r->log, RELUME_EFORMAT,
                            "%s: lacks the part '%s'; expected an object that relume bake has made",
                            r->path, parts[k].name);
        const struct exr_part_info info = exr_part_info(r->file, at);
        if (k == ATLAS) {
            b->info.width = info.width / b->blocks;
            b->info.height = info.height;
        }
        size_of(size, b, k);
        if (size[0] < 1 || info.width != size[0] || info.height != size[1] || info.subsampled ||
            info.tile || info.channels != parts[k].channels)
            return log_fail(r->log, RELUME_EFORMAT,
                            "%s: its part '%s' has %d x %d values in %d channels; expected %lld x "
                            "%lld in %d, in scanlines",
                            r->path, parts[k].name, info.width, info.height, info.channels,
                            (long long)size[0], (long long)size[1], parts[k].channels);
        for (int c = 0; c < info.channels; c++)
            if (strcmp(exr_channel_name(r->file, at, c), parts[k].channel[c]))
                return log_fail(r->log, RELUME_EFORMAT,
                                "%s: its part '%s' has a channel '%.40s'; expected '%s'", r->path,
                                parts[k].name, exr_channel_name(r->file, at, c),
                                parts[k].channel[c]);
    }
    return RELUME_OK;
}

static relume_status read_part(relume_baked *b, int part, const struct reader *r)
{
    exr_blocks *blocks = NULL;
    int64_t size[2];
    bool good = true;
    size_of(size, b, part);
    float *row = mem_array((size_t)size[0], sizeof *row);
    relume_status status = exr_blocks_open(&blocks, r->file, find_part(r, part));
    if (!status && !row)
        status = RELUME_ENOMEM;
    for (int y = 0; !status && y < size[1]; y++)
        for (int c = 0; !status && c < parts[part].channels; c++) {
            status = exr_blocks_channel(blocks, y, c, row);
            for (int x = 0; !status && x < size[0]; x++)
                good = parts[part].set(b, x, y, c, row[x]) && good;
        }
    exr_blocks_close(&blocks);
    mem_free(row);
    if (status == RELUME_EDAMAGED)
        return log_fail(r->log, status, "%s: truncated or damaged in part '%s'", r->path,
                        parts[part].name);
    return status || good ? status
                          : log_fail(r->log, RELUME_EDAMAGED,
                                     "%s: a value of its part '%s' is out of range or no number",
                                     r->path, parts[part].name);
}

// A normal and a tangent that are about as long as halves can be of 1.
static bool good_frame(const float frame[6])
{
    for (int k = 0; k < 6; k += 3) {
        const float *v = frame + k, squared = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        if (!(fabsf(squared - 1.0f) < 0.02f))
            return false;
    }
    return true;
}

// A texel holds something in all blocks, or in none; where it does it has a frame.
static relume_status check_texels(relume_baked *b, const struct reader *r)
{
    const size_t n = texels(b);
    b->info.texels = 0;
    for (size_t i = 0; i < n; i++) {
        const bool none = b->cluster[i] == BAKED_NONE;
        b->info.texels += !none;
        if (!none && has_part(b, FRAMES) && !good_frame(b->frame[i]))
            return log_wrong(r->log, r->path, "its part 'frames' has a vector of another length",
                             "normals and tangents of length 1");
        for (int k = 1; k < b->blocks; k++)
            if ((b->cluster[(size_t)k * n + i] == BAKED_NONE) != none)
                return log_wrong(r->log, r->path, "a texel has clusters for some views only",
                                 "for all views, or for none");
    }
    return RELUME_OK;
}

relume_status relume_baked_open(relume_baked **out, const char *path,
                                const struct relume_limits *limits, const struct relume_log *log)
{
    struct reader r = {
        .path = path, .limits = limits_or_default(limits_of(limits, log)), .log = log};
    relume_baked *b = mem_zeroed(1, sizeof *b);
    relume_status status = b ? exr_open(&r.file, path, NULL, &r.limits, log) : RELUME_ENOMEM;
    if (!status)
        status = read_about(b, &r);
    if (!status)
        status = check_sizes(b, &r);
    if (!status)
        status = baked_make(b, &r.limits, log);
    if (!status) {
        b->triangle = mem_zeroed(b->info.triangles, sizeof *b->triangle);
        status = b->triangle ? RELUME_OK : RELUME_ENOMEM;
    }
    for (int k = 0; k < PARTS && !status; k++)
        if (has_part(b, k))
            status = read_part(b, k, &r);
    if (!status)
        status = check_texels(b, &r);
    exr_close(&r.file);
    if (status)
        relume_baked_destroy(&b);
    *out = b;
    return status;
}

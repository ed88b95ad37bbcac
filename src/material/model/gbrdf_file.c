// gbrdf_file.c - a g-BRDF as one EXR file: a part for each map, which image editors show
#include "material/model/gbrdf_file.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "image/image/exr.h"
#include "material/model/model_gbrdf.h"

#include <string.h>
#include <strings.h>

enum { VERSION = 1, PARTS = 6, NDF_PART = PARTS - 1 };

static const char *const gray[] = {"Y"}, *const color[] = {"B", "G", "R"};

// The parts in the order of the model's arrays.
static const struct {
    const char *name;
    int channels;
    enum exr_sample sample;
} parts[PARTS] = {
    {"depth", 1, EXR_SAMPLE_FLOAT},  {"rotation", 1, EXR_SAMPLE_HALF},
    {"diffuse", 3, EXR_SAMPLE_HALF}, {"r0", 1, EXR_SAMPLE_HALF},
    {"label", 1, EXR_SAMPLE_UINT},   {"ndf", 3, EXR_SAMPLE_HALF},
};

bool gbrdf_file_named(const char *path)
{
    const size_t n = strlen(path);
    return n > 4 && !strcasecmp(path + n - 4, ".exr");
}

// Where a value of a map lies: distributions stand side by side in their part.
static size_t texel_offset(const relume_btf_fitted *m, int part, int x, int y)
{
    return part == NDF_PART
               ? ((size_t)(x / NDF_SIDE) * NDF_SIDE + (size_t)y) * NDF_SIDE + (size_t)(x % NDF_SIDE)
               : (size_t)y * (size_t)m->width + (size_t)x;
}

static int part_width(const relume_btf_fitted *m, int part)
{
    return part == NDF_PART ? m->clusters * NDF_SIDE : m->width;
}

static int part_height(const relume_btf_fitted *m, int part)
{
    return part == NDF_PART ? NDF_SIDE : m->height;
}

// ---------------------------------------------------------------- writing

struct source {
    const relume_btf_fitted *m;
    int part;
};

static relume_status fill_rows(void *context, int row, int rows, void *samples)
{
    const struct source *s = context;
    const int width = part_width(s->m, s->part), channels = parts[s->part].channels;
    const size_t bytes = exr_sample_bytes(parts[s->part].sample);
    const struct model_array *a = &s->m->array[s->part];
    char *to = samples;
    for (int y = row; y < row + rows; y++)
        for (int c = channels - 1; c >= 0; c--)
            for (int x = 0; x < width; x++, to += bytes) {
                const size_t at = texel_offset(s->m, s->part, x, y);
                if (parts[s->part].sample == EXR_SAMPLE_UINT)
                    *(uint32_t *)to = ((const uint8_t *)a->data)[at];
                else
                    memcpy(to, (const char *)a->data + bytes * ((size_t)channels * at + (size_t)c),
                           bytes);
            }
    return RELUME_OK;
}

static float *floats_of(const vec3 *d, int n)
{
    float *f = mem_array(3 * (size_t)n, sizeof *f);
    for (int i = 0; f && i < n; i++) {
        f[3 * i] = (float)d[i].x;
        f[3 * i + 1] = (float)d[i].y;
        f[3 * i + 2] = (float)d[i].z;
    }
    return f;
}

static relume_status refuse(const relume_btf_fitted *m, const char *path,
                            const struct relume_log *log)
{
    if (m->model != &model_gbrdf)
        return log_fail(log, RELUME_EINVAL,
                        "%s: model %s has no .exr form, only gbrdf has; give a folder", path,
                        m->model->name);
    return m->half ? log_fail(log, RELUME_EINVAL,
                              "%s: an .exr file holds one level of detail; found %d: give a folder",
                              path, m->info.levels)
                   : RELUME_OK;
}

relume_status gbrdf_file_save(const relume_btf_fitted *m, const char *path,
                              const struct relume_log *log)
{
    struct source source[PARTS];
    struct exr_part part[PARTS];
    relume_status status = refuse(m, path, log);
    if (status)
        return status;
    float *view = floats_of(m->view, m->views), *light = floats_of(m->light, m->lights);
    const struct exr_attribute about[] = {
        {.name = "gbrdfVersion", .kind = EXR_INT, .integer = VERSION},
        {.name = "includesCosine", .kind = EXR_INT, .integer = !m->without_cosine},
        {.name = "light", .kind = EXR_FLOATS, .floats = model_floats(m, PARTS), .count = 1},
        {.name = "viewDirections", .kind = EXR_FLOATS, .floats = view, .count = 3 * m->views},
        {.name = "lightDirections", .kind = EXR_FLOATS, .floats = light, .count = 3 * m->lights},
    };
    for (int i = 0; i < PARTS; i++) {
        source[i] = (struct source){m, i};
        part[i] = (struct exr_part){
            .name = parts[i].name,
            .width = part_width(m, i),
            .height = part_height(m, i),
            .sample = parts[i].sample,
            .codec = EXR_CODEC_ZIP,
            .channels = parts[i].channels,
            .channel = parts[i].channels == 1 ? gray : color,
            .attributes = i ? 0 : (int)(sizeof about / sizeof *about),
            .attribute = about,
            .rows = fill_rows,
            .context = &source[i],
        };
    }
    status = view && light ? exr_write(path, NULL, part, PARTS, false, 1, log) : RELUME_ENOMEM;
    mem_free(view);
    mem_free(light);
    return status;
}

// ---------------------------------------------------------------- reading

struct reader {
    const char *path;
    exr_file *file;
    int part[PARTS];
    struct relume_limits limits;
    const struct relume_log *log;
};

static relume_status find_parts(struct reader *r)
{
    for (int i = 0; i < PARTS; i++) {
        r->part[i] = -1;
        for (int k = 0; k < exr_part_count(r->file); k++)
            if (!strcmp(exr_part_info(r->file, k).name, parts[i].name))
                r->part[i] = k;
        if (r->part[i] < 0)
            return log_fail(r->log, RELUME_EFORMAT,
                            "%s: no g-BRDF; expected a part named '%s' (docs/gbrdf.md)", r->path,
                            parts[i].name);
        const struct exr_part_info info = exr_part_info(r->file, r->part[i]);
        if (info.subsampled || info.tile || info.channels != parts[i].channels)
            return log_fail(r->log, RELUME_EFORMAT,
                            "%s: part '%s'; expected %d channel%s of full resolution in scanlines",
                            r->path, info.name, parts[i].channels,
                            parts[i].channels > 1 ? "s, R, G and B," : "");
        for (int c = 0; parts[i].channels == 3 && c < 3; c++)
            if (strcmp(exr_channel_name(r->file, r->part[i], c), color[c]))
                return log_wrong(r->log, r->path, "channels of another name", "R, G and B");
    }
    return RELUME_OK;
}

static relume_status read_sizes(relume_btf_fitted *m, const struct reader *r)
{
    const struct exr_part_info depth = exr_part_info(r->file, r->part[0]);
    const struct exr_part_info ndf = exr_part_info(r->file, r->part[NDF_PART]);
    m->width = depth.width, m->height = depth.height;
    m->texels = (size_t)m->width * (size_t)m->height;
    if (!limits_allow(&r->limits, m->width, m->height))
        return log_wrong(r->log, r->path, "depth", "a size within the limits");
    m->clusters = ndf.width / NDF_SIDE;
    if (ndf.height != NDF_SIDE || ndf.width % NDF_SIDE || m->clusters > model_gbrdf.most_clusters)
        return log_wrong(r->log, r->path, "part 'ndf'", "1 to 64 squares of 32 x 32 side by side");
    for (int i = 0; i < NDF_PART; i++) {
        const struct exr_part_info info = exr_part_info(r->file, r->part[i]);
        if (info.width != m->width || info.height != m->height)
            return log_wrong(r->log, r->path, parts[i].name, "a map as large as the depth");
    }
    return RELUME_OK;
}

static relume_status read_directions(vec3 **out, int *count, const struct reader *r,
                                     const char *name)
{
    int n = 0;
    const float *f = exr_get_floats(r->file, r->part[0], name, &n);
    const int most = r->limits.max_views;
    if (!f || n < 9 || n % 3 || n / 3 > most)
        return log_wrong(r->log, r->path, name, "at least 3 directions within the limits");
    *count = n / 3;
    *out = mem_array((size_t)*count, sizeof **out);
    if (!*out)
        return RELUME_ENOMEM;
    for (int i = 0; i < *count; i++) {
        const vec3 d = vec3_of((double)f[3 * i], (double)f[3 * i + 1], (double)f[3 * i + 2]);
        const double length = vec3_length(d);
        if (!(fabs(length - 1.0) < 1e-3) || !(d.z > 0.0))
            return log_wrong(r->log, r->path, name, "unit vectors with z > 0");
        (*out)[i] = vec3_scale(d, 1.0 / length);
    }
    return RELUME_OK;
}

static relume_status read_all_directions(relume_btf_fitted *m, const struct reader *r)
{
    relume_status status = read_directions(&m->view, &m->views, r, "viewDirections");
    if (!status)
        status = read_directions(&m->light, &m->lights, r, "lightDirections");
    if (!status)
        status = btf_make_mesh(&m->view_mesh, m->view, m->views, r->path, "view", r->log);
    return status ? status
                  : btf_make_mesh(&m->light_mesh, m->light, m->lights, r->path, "light", r->log);
}

static void store_row(const relume_btf_fitted *m, int part, int y, int channel, const float *row)
{
    const struct model_array *a = &m->array[part];
    const size_t channels = (size_t)parts[part].channels;
    for (int x = 0; x < part_width(m, part); x++) {
        const size_t at = texel_offset(m, part, x, y);
        // labels that no byte holds must not become others
        if (parts[part].sample == EXR_SAMPLE_UINT)
            ((uint8_t *)a->data)[at] = row[x] >= 0.0f && row[x] < 255.0f ? (uint8_t)row[x] : 255;
        else if (parts[part].sample == EXR_SAMPLE_FLOAT)
            ((float *)a->data)[at] = row[x];
        else
            ((uint16_t *)a->data)[at * channels + channels - 1 - (size_t)channel] =
                half_from_float(row[x]);
    }
}

static relume_status read_map(const relume_btf_fitted *m, int part, const struct reader *r)
{
    exr_blocks *blocks;
    float *row = mem_array((size_t)part_width(m, part), sizeof *row);
    relume_status status = exr_blocks_open(&blocks, r->file, r->part[part]);
    if (!status && !row)
        status = RELUME_ENOMEM;
    for (int y = 0; !status && y < part_height(m, part); y++)
        for (int c = 0; !status && c < parts[part].channels; c++) {
            status = exr_blocks_channel(blocks, y, c, row);
            if (!status)
                store_row(m, part, y, c, row);
        }
    exr_blocks_close(&blocks);
    mem_free(row);
    return status == RELUME_EDAMAGED
               ? log_fail(r->log, status, "%s: truncated or damaged in part '%s'", r->path,
                          parts[part].name)
               : status;
}

static relume_status read_maps(relume_btf_fitted *m, const struct reader *r)
{
    relume_status status = model_make_arrays(m);
    for (int i = 0; i < PARTS && !status; i++)
        status = read_map(m, i, r);
    int n = 0;
    const float *light = exr_get_floats(r->file, r->part[0], "light", &n);
    if (!status && (!light || n != 1))
        return log_wrong(r->log, r->path, "light", "one number");
    if (!status)
        *model_floats(m, PARTS) = *light;
    const char *fault = status ? NULL : model_gbrdf.fault(m);
    return fault ? log_wrong(r->log, r->path, "a map is out of range", fault) : status;
}

static relume_status read_about(relume_btf_fitted *m, const struct reader *r)
{
    int version = 0, cosine = 0;
    if (!exr_get_int(r->file, r->part[0], "gbrdfVersion", &version) || version != VERSION)
        return log_wrong(r->log, r->path, "gbrdfVersion",
                         "1: made by a newer relume, or no g-BRDF");
    if (!exr_get_int(r->file, r->part[0], "includesCosine", &cosine))
        return log_wrong(r->log, r->path, "includesCosine", "0 or 1");
    m->model = &model_gbrdf;
    m->without_cosine = !cosine;
    return read_sizes(m, r);
}

relume_status gbrdf_file_open(relume_btf_fitted **out, const char *path,
                              const struct relume_btf_params *params)
{
    struct reader r = {
        .path = path,
        .limits = limits_or_default(params ? limits_of(params->limits, params->log) : NULL),
        .log = params ? params->log : NULL};
    relume_btf_fitted *m = mem_zeroed(1, sizeof *m);
    relume_status status = m ? exr_open(&r.file, path, NULL, &r.limits, r.log) : RELUME_ENOMEM;
    if (!status)
        status = find_parts(&r);
    if (!status)
        status = read_about(m, &r);
    if (!status)
        status = read_all_directions(m, &r);
    if (!status)
        status = read_maps(m, &r);
    if (!status)
        status = model_gbrdf.prepare(m);
    exr_close(&r.file);
    if (status)
        relume_btf_fitted_destroy(&m);
    *out = m;
    return status;
}

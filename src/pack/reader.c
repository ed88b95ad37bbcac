// reader.c - a relume file, of which nothing is believed before it has been checked
#include <relume/pack.h>

#include "base/arena.h"
#include "base/infile.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/params.h"
#include "image/half.h"
#include "pack/format.h"
#include "pack/reader.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum { NOT_A_CODE = 0xffff };

relume_status reader_bad(const relume_pack *p, const char *what, const char *expected)
{
    return log_fail(p->log, RELUME_EDAMAGED, "%s: %s; expected %s", p->path, what, expected);
}

static bool all_finite(const float *v, int n)
{
    for (int i = 0; i < n; i++)
        if (!isfinite(v[i]))
            return false;
    return true;
}

const float *reader_floats(const relume_pack *p, int part, const char *name, int count)
{
    int found;
    const float *v = exr_get_floats(p->file, part, name, &found);
    return v && found == count && all_finite(v, count) ? v : NULL;
}

// `*out` is NULL when there is no such attribute; false when it is not `count` finite numbers.
static bool optional_floats(const relume_pack *p, const char *name, long long count,
                            const float **out)
{
    int found;
    *out = exr_get_floats(p->file, 0, name, &found);
    return !*out || (found == count && all_finite(*out, found));
}

// ---------------------------------------------------------------- header

static relume_status check_format(relume_pack *p)
{
    const char *format = exr_get_text(p->file, 0, ATTR_FORMAT);
    if (!format || strcmp(format, FORMAT_NAME))
        return log_fail(p->log, RELUME_EFORMAT,
                        "%s: an OpenEXR file, but not a relume file; expected one made by 'relume "
                        "encode'",
                        p->path);
    if (!exr_get_int(p->file, 0, ATTR_VERSION, &p->info.version) || p->info.version < 1)
        return reader_bad(p, "no version", "1");
    if (p->info.version > FORMAT_VERSION)
        return log_fail(p->log, RELUME_EUNSUPPORTED,
                        "%s: version %d of the format is newer than this program, which reads up "
                        "to %d; update relume",
                        p->path, p->info.version, FORMAT_VERSION);
    return RELUME_OK;
}

static relume_status read_kinds(relume_pack *p)
{
    const char *domain = exr_get_text(p->file, 0, ATTR_DOMAIN);
    const char *display = exr_get_text(p->file, 0, ATTR_DISPLAY);
    const char *storage = exr_get_text(p->file, 0, ATTR_STORAGE);
    if (!domain || (strcmp(domain, "linear") && strcmp(domain, "display")))
        return reader_bad(p, ATTR_DOMAIN, "linear or display");
    if (!display || relume_transfer_parse(&p->info.display, display))
        return reader_bad(p, ATTR_DISPLAY, "srgb or gamma:NUMBER");
    p->info.domain = strcmp(domain, "linear") ? RELUME_DOMAIN_DISPLAY : RELUME_DOMAIN_LINEAR;
    if (!storage || relume_storage_parse(&p->info.storage, storage) ||
        p->info.storage == RELUME_STORE_LOG)
        return reader_bad(p, ATTR_STORAGE, "8, 10, 12, 16, half or float");
    return RELUME_OK;
}

static relume_status read_book_count(relume_pack *p)
{
    if (!exr_get_int(p->file, 0, ATTR_BOOKS, &p->info.books))
        p->info.books = 0;
    if (p->info.books < 0 || p->info.books > RELUME_MOST_BOOKS)
        return reader_bad(p, ATTR_BOOKS, "0 to 8");
    return RELUME_OK;
}

// How well the file was encoded: for people, so a file without it is as good.
static void read_report(relume_pack *p)
{
    const float *v = reader_floats(p, 0, ATTR_REPORT, 2);
    p->info.report = (struct relume_encode_report){
        .fit_rms = v ? (double)v[0] : (double)NAN,
        .store_rms = v ? (double)v[1] : (double)NAN,
    };
}

static relume_status read_uv(relume_pack *p)
{
    const int n = p->info.views;
    double(*uv)[2] = arena_array(&p->arena, (size_t)n, sizeof *uv);
    if (!uv)
        return RELUME_ENOMEM;
    p->info.uv = (const double(*)[2])uv;
    if (p->info.geometry.projection != RELUME_SLAB)
        return RELUME_OK;
    const float *v = reader_floats(p, 0, ATTR_UV, 2 * n);
    if (!v)
        return reader_bad(p, ATTR_UV, "two finite numbers for every view");
    for (int i = 0; i < n; i++) {
        uv[i][0] = (double)v[2 * i];
        uv[i][1] = (double)v[2 * i + 1];
    }
    return RELUME_OK;
}

static relume_status read_geometry(relume_pack *p)
{
    struct relume_geometry *g = &p->info.geometry;
    const char *name = exr_get_text(p->file, 0, ATTR_PROJECTION);
    enum relume_projection projection;
    if (!name || relume_projection_parse(&projection, name))
        return reader_bad(p, ATTR_PROJECTION, "planar, slab, cylindrical, spherical or cube");
    const struct exr_part_info part = exr_part_info(p->file, 0);
    *g = relume_geometry_default(projection, part.width, part.height);
    if (projection == RELUME_PLANAR) {
        const float *v = reader_floats(p, 0, ATTR_WINDOW, 5);
        const char *camera = exr_get_text(p->file, 0, ATTR_CAMERA);
        if (!v || !(v[0] < v[2] && v[1] < v[3]))
            return reader_bad(p, ATTR_WINDOW, "min x y, max x y, camera z");
        if (!camera || (strcmp(camera, "orthographic") && strcmp(camera, "perspective")))
            return reader_bad(p, ATTR_CAMERA, "orthographic or perspective");
        for (int i = 0; i < 2; i++) {
            g->window_min[i] = (double)v[i];
            g->window_max[i] = (double)v[2 + i];
        }
        g->camera_z = (double)v[4];
        g->perspective = !strcmp(camera, "perspective");
    } else if (projection == RELUME_SLAB) {
        const relume_status status = reader_read_slabs(p);
        if (status)
            return status;
    } else {
        const float *v = reader_floats(p, 0, ATTR_PANORAMA, 6);
        const float disc = v ? v[5] : 0.0f;
        v = v ? v : reader_floats(p, 0, ATTR_PANORAMA, 5);
        if (!v || !(v[0] < v[1]))
            return reader_bad(p, ATTR_PANORAMA, "v min, v max, center");
        g->v_min = (double)v[0];
        g->v_max = (double)v[1];
        g->center = (struct relume_vec3){(double)v[2], (double)v[3], (double)v[4]};
        g->disc = disc >= 0.0f && disc <= (float)part.height ? (int)disc : -1;
        if ((float)g->disc != disc || !relume_geometry_fits(g, part.width, part.height))
            return reader_bad(p, ATTR_PANORAMA, "discs of a cylinder that fit");
        if (projection == RELUME_CUBE && part.width != 6 * part.height)
            return reader_bad(p, "size", "six square faces side by side");
    }
    return read_uv(p);
}

static relume_status read_coder(relume_pack *p)
{
    const char *name = exr_get_text(p->file, 0, ATTR_BASIS);
    const char *pole = exr_get_text(p->file, 0, ATTR_POLE);
    const struct relume_basis *basis = name ? relume_basis_find(name) : NULL;
    int k, hemispherical, n = 0;
    if (!basis)
        return log_fail(p->log, RELUME_EUNSUPPORTED,
                        "%s: unknown basis '%.40s'; expected one of this "
                        "program's",
                        p->path, name ? name : "");
    if (!exr_get_int(p->file, 0, ATTR_COEFFICIENTS, &k) || !basis->has_count(k))
        return reader_bad(p, ATTR_COEFFICIENTS, "a number that the basis has");
    if (!exr_get_int(p->file, 0, ATTR_HEMISPHERICAL, &hemispherical) || !pole ||
        (strcmp(pole, "y") && strcmp(pole, "z")))
        return reader_bad(p, ATTR_POLE, "y or z, with " ATTR_HEMISPHERICAL);
    const float *lights = exr_get_floats(p->file, 0, ATTR_LIGHTS, &n);
    if (!lights || n < 3 || n % 3 || n / 3 > p->limits.max_lights || !all_finite(lights, n))
        return reader_bad(p, ATTR_LIGHTS, "x y z of every light, within the limits");
    const int raw = basis->interpolates ? n / 3 : k;
    const float *transform, *mean;
    if (!optional_floats(p, ATTR_TRANSFORM, (basis->learned ? 3LL : 1LL) * k * raw, &transform))
        return reader_bad(p, ATTR_TRANSFORM, "coefficients x functions finite numbers");
    if (!optional_floats(p, ATTR_MEAN, 3LL * raw, &mean))
        return reader_bad(p, ATTR_MEAN, "a finite number for every colour and light");
    const char *colour = exr_get_text(p->file, 0, ATTR_COLOUR);
    if (colour && strcmp(colour, "luminance"))
        return reader_bad(p, ATTR_COLOUR, "luminance or nothing");
    const char *interpolant = exr_get_text(p->file, 0, ATTR_INTERPOLANT);
    if (interpolant && !relume_interpolant_find(interpolant))
        return reader_bad(p, ATTR_INTERPOLANT, "an interpolant of this program");
    const float *parameter = reader_floats(p, 0, ATTR_PARAMETER, 4);
    const float *ridge = reader_floats(p, 0, ATTR_RIDGE, 1);

    struct relume_vec3 *directions = arena_array(&p->arena, (size_t)n / 3, sizeof *directions);
    if (!directions)
        return RELUME_ENOMEM;
    for (int i = 0; i < n / 3; i++) {
        const double x = (double)lights[3 * i], y = (double)lights[3 * i + 1],
                     z = (double)lights[3 * i + 2];
        const double length = sqrt(x * x + y * y + z * z);
        if (!(fabs(length - 1.0) < 1e-3))
            return reader_bad(p, ATTR_LIGHTS, "unit vectors");
        directions[i] = (struct relume_vec3){x / length, y / length, z / length};
    }
    struct relume_coder_params params = {
        .log = p->log,
        .coefficients = k,
        .decode = true,
        .force = true,
        .hemispherical = hemispherical != 0,
        .pole_y = pole[0] == 'y',
        .ridge = ridge && *ridge >= 0.0f && *ridge <= 1.0f ? (double)*ridge : 0.0,
        .luminance = colour != NULL,
        .interpolant = interpolant ? relume_interpolant_find(interpolant) : NULL,
        .transform = transform,
        .mean = mean,
    };
    for (int i = 0; parameter && i < 4; i++)
        params.parameter[i] = (double)parameter[i];
    const relume_status status = relume_coder_create(&p->coder, basis, directions, n / 3, &params);
    p->info.coder = p->coder;
    p->info.coefficients = k;
    p->info.planes = status ? 0 : relume_coder_info(p->coder)->planes;
    return status == RELUME_EINVAL ? RELUME_EDAMAGED : status;
}

// ---------------------------------------------------------------- parts

static relume_status check_view_part(relume_pack *p, int part, int view)
{
    const struct exr_part_info i = exr_part_info(p->file, part);
    const int planes = relume_coder_info(p->coder)->planes;
    char where[32];
    snprintf(where, sizeof where, "view %d", view);
    if (i.width != p->info.width || i.height != p->info.height)
        return reader_bad(p, where, "the size of the other parts");
    if (p->info.books) {
        if (i.channels != p->info.books || !i.uniform || i.sample != EXR_SAMPLE_UINT)
            return reader_bad(p, where, "one channel of whole numbers for every codebook");
        return RELUME_OK;
    }
    if (i.channels != planes || !i.uniform || i.sample != reader_sample(p))
        return reader_bad(p, where, "one channel of the stored type for every plane");
    if (!reader_floats(p, part, ATTR_SCALE, planes) || !reader_floats(p, part, ATTR_OFFSET, planes))
        return reader_bad(p, where, "a finite scale and offset for every plane");
    return RELUME_OK;
}

static bool is_plane(const relume_pack *p, int part, enum exr_sample sample)
{
    const struct exr_part_info i = exr_part_info(p->file, part);
    return i.width == p->info.width && i.height == p->info.height && i.channels == 1 && i.uniform &&
           i.sample == sample;
}

static relume_status find_parts(relume_pack *p)
{
    const int count = exr_part_count(p->file);
    int part = 1;
    relume_status found = reader_find_books(p, -1, &part);
    if (found)
        return found;
    for (int v = 0; v < p->info.views; v++) {
        char name[48];
        struct view_parts *parts = &p->parts[v];
        *parts = (struct view_parts){-1, -1, -1};
        snprintf(name, sizeof name, "view%04d", v);
        if (part >= count || strcmp(exr_part_info(p->file, part).name, name))
            return reader_bad(p, name, "a part of that name");
        const relume_status status = check_view_part(p, part, v);
        if (status)
            return status;
        parts->codes = part++;
        if (!p->info.shared && (found = reader_find_books(p, v, &part)))
            return found;
        snprintf(name, sizeof name, "view%04d.depth", v);
        if (part < count && !strcmp(exr_part_info(p->file, part).name, name)) {
            if (!is_plane(p, part, EXR_SAMPLE_FLOAT))
                return reader_bad(p, name, "one float channel of the views' size");
            parts->depth = part++;
            p->info.has_depth = true;
        }
        snprintf(name, sizeof name, "view%04d.mask", v);
        if (part < count && !strcmp(exr_part_info(p->file, part).name, name)) {
            if (!is_plane(p, part, EXR_SAMPLE_HALF))
                return reader_bad(p, name, "one half channel of the views' size");
            parts->mask = part++;
            p->info.has_mask = true;
        }
    }
    p->info.compression = exr_part_info(p->file, p->parts[0].codes).codec;
    return RELUME_OK;
}

static relume_status make_code_table(relume_pack *p)
{
    p->code_of_half = arena_array(&p->arena, 65536, sizeof *p->code_of_half);
    if (!p->code_of_half)
        return RELUME_ENOMEM;
    for (int h = 0; h < 65536; h++)
        p->code_of_half[h] = NOT_A_CODE;
    for (int code = 0; code < 1024; code++)
        p->code_of_half[half_from_float((float)code)] = (uint16_t)code;
    return RELUME_OK;
}

static relume_status read_header(relume_pack *p)
{
    relume_status status = check_format(p);
    if (!status)
        status = read_kinds(p);
    if (!status)
        status = read_book_count(p);
    if (status)
        return status;
    const struct exr_part_info first = exr_part_info(p->file, 0);
    read_report(p);
    p->info.width = first.width;
    p->info.height = first.height;
    if (!exr_get_int(p->file, 0, ATTR_VIEWS, &p->info.views) || p->info.views < 1 ||
        p->info.views > p->limits.max_views || p->info.views >= exr_part_count(p->file))
        return reader_bad(p, ATTR_VIEWS, "a part for every view, within the limits");
    p->parts = arena_array(&p->arena, (size_t)p->info.views, sizeof *p->parts);
    p->loaded = arena_array(&p->arena, (size_t)p->info.views, sizeof *p->loaded);
    p->books = arena_array(&p->arena, (size_t)p->info.views, sizeof *p->books);
    if (!p->parts || !p->loaded || !p->books)
        return RELUME_ENOMEM;
    status = read_geometry(p);
    if (!status)
        status = read_coder(p);
    if (!status)
        status = find_parts(p);
    if (!status)
        status = reader_read_members(p);
    if (!status && p->info.has_mask)
        status = relume_coder_append_mean(p->coder);
    if (!status)
        status = make_code_table(p);
    return status;
}

relume_status relume_pack_open(relume_pack **out, const char *path,
                               const struct relume_pack_params *params)
{
    const struct relume_pack_params params_ = PARAMS(relume_pack_params, params);
    *out = NULL;
    if (!path && !params_.reader)
        return RELUME_EINVAL;
    relume_pack *p = mem_zeroed(1, sizeof *p);
    if (!p)
        return RELUME_ENOMEM;
    p->log = params_.log;
    p->threads = params_.threads;
    p->limits = limits_or_default(limits_of(params_.limits, params_.log));
    p->path = mem_text(infile_name(path));
    relume_status status = p->path ? RELUME_OK : RELUME_ENOMEM;
    struct stat s;
    if (!status && !params_.reader && stat(path, &s))
        status =
            log_fail(p->log, RELUME_ENOTFOUND, "%s: no such file; expected a relume file", path);
    else if (!status && !params_.reader && !S_ISREG(s.st_mode))
        status = log_fail(p->log, RELUME_EFORMAT, "%s: not a file; expected a relume file", path);
    if (!status)
        status = exr_open(&p->file, path, params_.reader, &p->limits, p->log);
    if (!status) {
        p->info.file_bytes = exr_bytes(p->file);
        status = read_header(p);
    }
    if (status)
        relume_pack_destroy(&p);
    *out = p;
    return status;
}

void relume_pack_destroy(relume_pack **pack)
{
    relume_pack *p = *pack;
    *pack = NULL;
    if (!p)
        return;
    for (int v = 0; p->loaded && v < p->info.views; v++)
        relume_pack_drop(p, v);
    if (p->books && p->info.shared)
        reader_drop_books(&p->books[0]);
    relume_coder_destroy(&p->coder);
    exr_close(&p->file);
    arena_free(&p->arena);
    free(p->path);
    free(p);
}

const struct relume_pack_info *relume_pack_info(const relume_pack *pack)
{
    return &pack->info;
}

const struct relume_geometry *relume_pack_geometry(const relume_pack *pack, int view)
{
    const struct relume_pack_info *info = &pack->info;
    return info->slabs ? &info->slab[info->slab_of[view]] : &info->geometry;
}

// ---------------------------------------------------------------- samples

// Plane order is R, G, B; the file sorts B, G, R.
size_t reader_plane(const struct relume_coder_info *info, size_t channel)
{
    if (info->luminance && channel >= (size_t)info->coefficients)
        return 2 * (size_t)info->coefficients + 2 - channel;
    return info->joint ? channel : channel / 3 * 3 + 2 - channel % 3;
}

static bool load_row(const struct loading *l, const void *samples, size_t i, void *to, size_t at)
{
    const enum relume_storage storage = l->pack->info.storage;
    const uint16_t *halves = (const uint16_t *)samples + i;
    const uint32_t *uints = (const uint32_t *)samples + i;
    uint8_t *bytes = (uint8_t *)to + at;
    uint16_t *words = (uint16_t *)to + at;
    float *floats = (float *)to + at;
    const uint16_t top = (uint16_t)relume_storage_top(storage);
    unsigned wrong = 0;
    for (size_t x = 0; x < l->width; x++)
        switch (storage) {
        case RELUME_STORE_12:
        case RELUME_STORE_16:
            words[x] = (uint16_t)uints[x];
            wrong |= uints[x] > top;
            break;
        case RELUME_STORE_HALF:
            words[x] = halves[x];
            wrong |= (halves[x] & 0x7c00) == 0x7c00;
            break;
        case RELUME_STORE_FLOAT:
            floats[x] = ((const float *)samples)[i + x];
            wrong |= !isfinite(floats[x]);
            break;
        case RELUME_STORE_10:
            words[x] = l->pack->code_of_half[halves[x]];
            wrong |= words[x] > top;
            break;
        default: {
            const uint16_t code = l->pack->code_of_half[halves[x]];
            bytes[x] = (uint8_t)code;
            wrong |= code > top;
        }
        }
    return !wrong;
}

static void load_rows(void *context, int row, int rows, const void *samples)
{
    struct loading *l = context;
    for (size_t y = 0; y < (size_t)rows; y++)
        for (size_t c = 0; c < l->planes; c++) {
            const size_t at = (l->place[c] * l->height + (size_t)row + y) * l->width;
            if (!load_row(l, samples, (y * l->planes + c) * l->width, l->data, at))
                atomic_store(&l->wrong, true);
        }
}

relume_status reader_load(relume_pack *p, int part, void *data, size_t planes, const size_t *place)
{
    const struct exr_part_info info = exr_part_info(p->file, part);
    struct loading l = {
        .pack = p,
        .place = place,
        .data = data,
        .width = (size_t)info.width,
        .height = (size_t)info.height,
        .planes = planes,
    };
    const relume_status status = exr_read(p->file, part, p->threads, load_rows, &l, p->log);
    if (!status && atomic_load(&l.wrong))
        return reader_bad(p, "stored codes", "finite codes of the stated type");
    return status;
}

// Steps of the planes, and of the one of the mask, whose codes are 0 and 1.
static relume_status load_steps(struct loaded *to, const relume_pack *p, int part, size_t planes)
{
    const size_t stored = (size_t)p->info.planes;
    const float *scale = reader_floats(p, part, ATTR_SCALE, p->info.planes);
    const float *offset = reader_floats(p, part, ATTR_OFFSET, p->info.planes);
    to->steps = mem_array(2 * planes, sizeof *to->steps);
    if (!to->steps)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < planes; i++) {
        to->steps[i] = i < stored ? scale[i] : 1.0f;
        to->steps[planes + i] = i < stored ? offset[i] : 0.0f;
    }
    to->codes.scale = to->steps;
    to->codes.offset = to->steps + planes;
    return RELUME_OK;
}

static relume_status load_planes(relume_pack *p, int view)
{
    struct loaded *to = &p->loaded[view];
    const struct relume_coder_info *coder = relume_coder_info(p->coder);
    const size_t planes = (size_t)coder->planes, stored = (size_t)p->info.planes;
    const size_t plane_bytes =
        (size_t)p->info.width * (size_t)p->info.height * relume_storage_bytes(p->info.storage);
    const int part = p->parts[view].codes;
    size_t *place = mem_array(planes, sizeof *place);
    to->plane = mem_array(planes, sizeof *to->plane);
    to->data = mem_array(planes, plane_bytes);
    relume_status status = place && to->plane && to->data ? RELUME_OK : RELUME_ENOMEM;
    for (size_t i = 0; !status && i < planes; i++) {
        to->plane[i] = (const char *)to->data + i * plane_bytes;
        place[i] = reader_plane(coder, i);
    }
    if (!status)
        status = reader_load(p, part, to->data, stored, place);
    if (!status && planes > stored)
        status = reader_mask_plane(p, view, (char *)to->data + stored * plane_bytes);
    free(place);
    to->codes.storage = p->info.storage;
    to->codes.plane = to->plane;
    return status ? status : load_steps(to, p, part, planes);
}

relume_status relume_pack_codes(const struct relume_codes **out, relume_pack *pack, int view)
{
    *out = NULL;
    if (view < 0 || view >= pack->info.views)
        return RELUME_EINVAL;
    struct loaded *to = &pack->loaded[view];
    if (!to->data) {
        to->codes = (struct relume_codes){
            .coder = pack->coder,
            .domain = pack->info.domain,
            .display = pack->info.display,
            .width = pack->info.width,
            .height = pack->info.height,
            .planes = relume_coder_info(pack->coder)->planes,
        };
        const relume_status status =
            pack->info.books ? reader_load_indices(pack, view) : load_planes(pack, view);
        if (status) {
            relume_pack_drop(pack, view);
            return status;
        }
    }
    *out = &to->codes;
    return RELUME_OK;
}

void relume_pack_drop(relume_pack *pack, int view)
{
    struct loaded *l = &pack->loaded[view];
    free(l->plane);
    free(l->data);
    free(l->steps);
    *l = (struct loaded){0};
    if (pack->books && !pack->info.shared)
        reader_drop_books(&pack->books[view]);
}

struct plane_sink {
    struct relume_image *image;
    bool half;
};

static void plane_rows(void *context, int row, int rows, const void *samples)
{
    const struct plane_sink *s = context;
    const size_t n = (size_t)rows * (size_t)s->image->width;
    float *out = s->image->data + (size_t)row * (size_t)s->image->width;
    for (size_t i = 0; i < n; i++)
        out[i] =
            s->half ? float_from_half(((const uint16_t *)samples)[i]) : ((const float *)samples)[i];
}

static relume_status read_plane(struct relume_image *out, relume_pack *pack, int part, bool half)
{
    *out = (struct relume_image){0};
    if (part < 0)
        return RELUME_OK;
    relume_status status = relume_image_create(out, pack->info.width, pack->info.height, 1);
    if (status)
        return status;
    struct plane_sink sink = {out, half};
    status = exr_read(pack->file, part, pack->threads, plane_rows, &sink, pack->log);
    const size_t n = (size_t)out->width * (size_t)out->height;
    for (size_t i = 0; !status && i < n; i++)
        if (!(out->data[i] >= 0.0f))
            status = reader_bad(pack, "depth or mask", "values of 0 or more");
    if (status)
        relume_image_destroy(out);
    return status;
}

relume_status relume_pack_depth(struct relume_image *out, relume_pack *pack, int view)
{
    *out = (struct relume_image){0};
    if (view < 0 || view >= pack->info.views)
        return RELUME_EINVAL;
    return read_plane(out, pack, pack->parts[view].depth, false);
}

relume_status relume_pack_mask(struct relume_image *out, relume_pack *pack, int view)
{
    *out = (struct relume_image){0};
    if (view < 0 || view >= pack->info.views)
        return RELUME_EINVAL;
    return read_plane(out, pack, pack->parts[view].mask, true);
}

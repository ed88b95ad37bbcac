// read_header.c - what all of a relume file is, out of the attributes of its first part
#include "core/base/log.h"
#include "core/base/memory.h"
#include "format/pack/format.h"
#include "format/pack/functions.h"
#include "format/pack/reader.h"
#include "image/geometry/geometry.h"

#include <math.h>
#include <string.h>

// `*out` is NULL when there is no such attribute; false when it is not `count` finite numbers.
static bool optional_floats(const relume_pack *p, const char *name, long long count,
                            const float **out)
{
    int found;
    *out = reader_any_floats(p, 0, name, &found);
    return *out ? found == count : !exr_get_floats(p->file, 0, name, &found);
}

static relume_status check_format(relume_pack *p)
{
    const char *format = exr_get_text(p->file, 0, ATTR_FORMAT);
    if (!p->part && format && !strcmp(format, FORMAT_PART))
        return log_fail(
            p->log, RELUME_EFORMAT,
            "%s: a part of a relume file; expected the file that 'relume join' makes of "
            "all parts",
            p->path);
    if (!format || (!p->part && strcmp(format, FORMAT_NAME)))
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
    const char *coding = exr_get_text(p->file, 0, ATTR_CODING);
    const char *domain = exr_get_text(p->file, 0, ATTR_DOMAIN);
    const char *display = exr_get_text(p->file, 0, ATTR_DISPLAY);
    const char *storage = exr_get_text(p->file, 0, ATTR_STORAGE);
    if (!domain || (strcmp(domain, "linear") && strcmp(domain, "display")))
        return reader_bad(p, ATTR_DOMAIN, "linear or display");
    if (!display || relume_transfer_parse(&p->info.display, display))
        return reader_bad(p, ATTR_DISPLAY, "srgb, gamma:NUMBER or log:NUMBER");
    p->info.domain = strcmp(domain, "linear") ? RELUME_DOMAIN_DISPLAY : RELUME_DOMAIN_LINEAR;
    if (!storage || relume_storage_parse(&p->info.storage, storage) ||
        p->info.storage == RELUME_STORE_LOG)
        return reader_bad(p, ATTR_STORAGE, "8, 10, 12, 16, half or float");
    p->coded = coding != NULL;
    if (coding && (strcmp(coding, CODING_AV1) || p->info.storage != RELUME_STORE_12))
        return reader_bad(p, ATTR_CODING, "av1, of 12 bits");
    return RELUME_OK;
}

// How well the file was encoded: for people, so a file without it is as good.
static void read_report(relume_pack *p)
{
    const float *v = reader_floats(p, 0, ATTR_REPORT, 2);
    p->info.report = (struct relume_fidelity){
        .fit_rms = v ? (double)v[0] : (double)NAN,
        .store_rms = v ? (double)v[1] : (double)NAN,
    };
}

// Of the views: that of the first picture, but where that is smaller.
static relume_status read_size(relume_pack *p)
{
    const struct exr_part_info first = exr_part_info(p->file, 0);
    p->info.width = first.width;
    p->info.height = first.height;
    const bool other = exr_get_int(p->file, 0, ATTR_WIDTH, &p->info.width);
    if ((p->coded || other) &&
        (!other || !exr_get_int(p->file, 0, ATTR_HEIGHT, &p->info.height) || p->info.width < 1 ||
         p->info.height < 1 || p->info.width > 65536 || p->info.height > 65536 ||
         !limits_allow(&p->limits, p->info.width, p->info.height)))
        return reader_bad(p, ATTR_WIDTH " and " ATTR_HEIGHT,
                          "1 to 65536 pixels a side, within the limits");
    return RELUME_OK;
}

static relume_status read_counts(relume_pack *p)
{
    if (!exr_get_int(p->file, 0, ATTR_BOOKS, &p->info.books))
        p->info.books = 0;
    if (p->info.books < 0 || p->info.books > RELUME_MOST_BOOKS)
        return reader_bad(p, ATTR_BOOKS, "0 to 8");
    if (!exr_get_int(p->file, 0, ATTR_VIEWS, &p->info.views) || p->info.views < 1 ||
        p->info.views > p->limits.max_views ||
        (!p->coded && !p->part && p->info.views >= exr_part_count(p->file)))
        return reader_bad(p, ATTR_VIEWS, "a part for every view, within the limits");
    return RELUME_OK;
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
    *g = relume_geometry_default(projection, p->info.width, p->info.height);
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
        g->disc = disc >= 0.0f && disc <= (float)p->info.height ? (int)disc : -1;
        if ((float)g->disc != disc || !relume_geometry_fits(g, p->info.width, p->info.height))
            return reader_bad(p, ATTR_PANORAMA, "discs of a cylinder that fit");
        if (projection == RELUME_CUBE && p->info.width != 6 * p->info.height)
            return reader_bad(p, "size", "six square faces side by side");
    }
    return read_uv(p);
}

// As text; of files of earlier states of this version digit by digit.
static relume_status read_text(float *numbers, const relume_pack *p, int rows, int each)
{
    const char *stepped = exr_get_text(p->file, 0, ATTR_STEPPED);
    if (stepped) {
        const relume_status status =
            rows % 3 ? RELUME_EDAMAGED : functions_of_text(numbers, stepped, rows / 3, each);
        return status == RELUME_EDAMAGED
                   ? reader_bad(p, ATTR_STEPPED,
                                "digits A-Z a-z 0-9 + /, one for every coefficient")
                   : status;
    }
    const char *text = exr_get_text(p->file, 0, ATTR_FUNCTIONS);
    const float *most = reader_floats(p, 0, ATTR_MOST, rows);
    if (!most || strlen(text) != 2 * (size_t)rows * (size_t)each)
        return reader_bad(p, ATTR_FUNCTIONS, "two digits for every number, and " ATTR_MOST);
    return functions_of_digits(numbers, text, most, rows, each)
               ? RELUME_OK
               : reader_bad(p, ATTR_FUNCTIONS, "digits A-Z a-z 0-9 + /");
}

// What decodes the coefficients, [rows][each]; NULL where there is none.
static relume_status read_functions(const float **out, relume_pack *p, int rows, int each)
{
    if (!exr_get_text(p->file, 0, ATTR_STEPPED) && !exr_get_text(p->file, 0, ATTR_FUNCTIONS))
        return optional_floats(p, ATTR_TRANSFORM, (long long)rows * each, out)
                   ? RELUME_OK
                   : reader_bad(p, ATTR_TRANSFORM, "coefficients x functions finite numbers");
    float *numbers = arena_array(&p->arena, (size_t)rows * (size_t)each, sizeof *numbers);
    *out = numbers;
    return numbers ? read_text(numbers, p, rows, each) : RELUME_ENOMEM;
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
    const float *lights = reader_any_floats(p, 0, ATTR_LIGHTS, &n);
    if (!lights || n < 3 || n % 3 || n / 3 > p->limits.max_lights)
        return reader_bad(p, ATTR_LIGHTS, "x y z of every light, within the limits");
    const int raw = basis->interpolates ? n / 3 : k;
    const float *transform = NULL, *mean;
    const relume_status functions = read_functions(&transform, p, (basis->joint ? 3 : 1) * k, raw);
    if (functions)
        return functions;
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

relume_status reader_read_header(relume_pack *p)
{
    relume_status status = check_format(p);
    if (!status)
        status = read_kinds(p);
    if (!status)
        status = read_size(p);
    if (!status)
        status = read_counts(p);
    if (!status)
        status = read_geometry(p);
    read_report(p);
    p->info.provenance = exr_get_text(p->file, 0, ATTR_PROVENANCE);
    p->info.notes = exr_get_text(p->file, 0, ATTR_NOTES);
    return status ? status : read_coder(p);
}

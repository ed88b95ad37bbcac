// web_read.c - a folder with info.json becomes planes with a meaning
#include "exchange/formats/web.h"

#include "core/base/json.h"
#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/tree.h"
#include "exchange/formats/bytes.h"
#include "exchange/formats/tiles.h"
#include "image/image/jpeg.h"
#include "core/math/vec.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum space { SPACE_RGB, SPACE_LRGB, SPACE_YCC, SPACE_MRGB, SPACE_MYCC, SPACES };

static const char *const space_names[SPACES] = {"rgb", "lrgb", "ycc", "mrgb", "mycc"};
static const char *const kind_names[] = {"ptm", "hsh", "sh", "rbf", "bilinear"};

struct folder {
    struct foreign *f;
    char *info, *at;  // path of info.json, path of the folder
    jvalue *root;
    const jvalue *material;
    enum space space;
    int planes;
    int luminance, chroma;  // mycc: planes of Y, of each chroma
    double *scale, *bias, *range;
    double *basis;  // [planes + 1][functions][3], 0..255
    int listed;     // functions in the file; those of lights that are no numbers are left out
    int *column;    // [functions.count] of the file's, where some are left out; NULL: all
    const struct relume_limits *limits;
    const struct relume_log *log;
};

static relume_status refuse(const struct folder *w, relume_status status, const char *what,
                            const char *expected)
{
    return log_fail(w->log, status, "%s: %s; expected %s", w->info, what, expected);
}

static bool find_name(const char *name, const char *const *names, int count, int *index)
{
    for (int i = 0; name && i < count; i++)
        if (!strcmp(name, names[i])) {
            *index = i;
            return true;
        }
    return false;
}

static relume_status read_kinds(struct folder *w)
{
    int kind = 0, space = 0;
    const char *format = jvalue_text(jvalue_member(w->root, "format"));
    if (!find_name(jvalue_text(jvalue_member(w->root, "type")), kind_names, 5, &kind))
        return refuse(w, RELUME_EUNSUPPORTED, "type", "ptm, hsh, sh, rbf or bilinear");
    if (!find_name(jvalue_text(jvalue_member(w->root, "colorspace")), space_names, SPACES, &space))
        return refuse(w, RELUME_EUNSUPPORTED, "colorspace", "rgb, lrgb, ycc, mrgb or mycc");
    if (format && strcmp(format, "jpg"))
        return refuse(w, RELUME_EUNSUPPORTED, "format", "jpg");
    w->f->functions.kind = (enum function_kind)kind;
    w->space = (enum space)space;
    if ((kind == FUNCTIONS_GAUSS || kind == FUNCTIONS_GRID) != (space >= SPACE_MRGB))
        return log_wrong(w->log, w->info, "colorspace",
                         "mrgb or mycc for rbf and bilinear, others for the rest");
    return RELUME_OK;
}

static relume_status read_profile(struct folder *w)
{
    const char *profile = jvalue_text(jvalue_member(w->root, "colorprofile"));
    if (!profile || !strcmp(profile, "sRGB"))
        return RELUME_OK;
    if (!strcmp(profile, "P3")) {
        log_line(
            w->log, RELUME_WARNING,
            "%s: colours are in Display P3; they are treated as sRGB, so saturated ones look paler",
            w->info);
        return RELUME_OK;
    }
    w->f->linear = !strcmp(profile, "RGB");
    return w->f->linear ? RELUME_OK
                        : refuse(w, RELUME_EUNSUPPORTED, "colorprofile", "RGB, sRGB or P3");
}

// ---------------------------------------------------------------- functions

static relume_status read_lights(struct folder *w)
{
    const jvalue *lights = jvalue_member(w->root, "lights");
    const struct relume_limits limits = limits_or_default(w->limits);
    const size_t n = jvalue_count(lights) / 3;
    if (n < 1 || jvalue_count(lights) % 3)
        return log_wrong(w->log, w->info, "lights", "x y z of every light");
    if (n > (size_t)limits.max_lights || n > FUNCTIONS_MOST)
        return refuse(w, RELUME_ELIMIT, "lights", "a number within the limits");
    struct relume_vec3 *light = mem_array(n, sizeof *light);
    if (!light)
        return RELUME_ENOMEM;
    w->f->functions.lights = light;
    w->column = mem_array(n, sizeof *w->column);
    if (!w->column)
        return RELUME_ENOMEM;
    w->listed = (int)n;
    int kept = 0;
    for (size_t i = 0; i < n; i++) {
        double v[3];
        bool known = true;
        for (size_t c = 0; c < 3; c++) {
            const jvalue *number = jvalue_item(lights, 3 * i + c);
            known &= !jvalue_text(number);  // blanked
            if (known && !jvalue_number(number, &v[c]))
                return refuse(w, RELUME_EDAMAGED, "lights", "finite numbers");
        }
        if (!known)
            continue;
        light[kept] = vec3_of(v[0], v[1], v[2]);
        const double length = vec3_length(light[kept]);
        if (!(length > 1e-4) || !isfinite(length))
            return refuse(w, RELUME_EDAMAGED, "lights",
                          "directions; found a vector without length");
        light[kept] = vec3_unit(light[kept]);
        w->column[kept++] = (int)i;
    }
    if (!kept)
        return refuse(w, RELUME_EDAMAGED, "lights", "finite numbers");
    w->f->functions.count = kept;
    if (!jvalue_number(jvalue_member(w->root, "sigma"), &w->f->functions.sigma) ||
        !(w->f->functions.sigma > 1e-4 && w->f->functions.sigma < 1e4))
        return log_wrong(w->log, w->info, "sigma", "a number above 0");
    return RELUME_OK;
}

static relume_status read_functions(struct folder *w)
{
    struct functions *f = &w->f->functions;
    if (f->kind == FUNCTIONS_GAUSS)
        return read_lights(w);
    if (f->kind == FUNCTIONS_GRID) {
        if (!jvalue_whole(jvalue_member(w->root, "resolution"), 2, 64, &f->resolution))
            return log_wrong(w->log, w->info, "resolution", "a whole number from 2 to 64");
        f->count = f->resolution * f->resolution;
    }
    return RELUME_OK;
}

static relume_status read_plane_count(struct folder *w)
{
    const jvalue *split = jvalue_member(w->root, "yccplanes");
    if (w->space == SPACE_MYCC) {
        int b;
        if (jvalue_count(split) != 3 ||
            !jvalue_whole(jvalue_item(split, 0), 1, FOREIGN_MOST_PLANES / 3, &w->luminance) ||
            !jvalue_whole(jvalue_item(split, 1), 0, FOREIGN_MOST_PLANES / 3, &w->chroma) ||
            !jvalue_whole(jvalue_item(split, 2), 0, FOREIGN_MOST_PLANES / 3, &b) ||
            b != w->chroma || w->chroma > w->luminance)
            return log_wrong(w->log, w->info, "yccplanes", "[Y, C, C] with C at most Y");
        w->planes = w->luminance + 2 * w->chroma;
        return RELUME_OK;
    }
    if (!jvalue_whole(jvalue_member(w->root, "nplanes"), 1, FOREIGN_MOST_PLANES, &w->planes))
        return log_wrong(w->log, w->info, "nplanes", "a whole number from 1 to 1024");
    return RELUME_OK;
}

// Planes of a form that is not joint decide how many functions there are.
static relume_status count_terms(struct folder *w)
{
    struct foreign *f = w->f;
    if (w->space >= SPACE_MRGB) {
        f->form = FOREIGN_JOINT;
        f->terms = w->planes;
        return RELUME_OK;
    }
    const int n = w->space == SPACE_LRGB ? w->planes - 3 : w->planes / 3;
    if ((w->space != SPACE_LRGB && w->planes % 3) || !web_has_count(f->functions.kind, n))
        return log_wrong(w->log, w->info, "nplanes",
                         "a number that the type has in this colour space");
    f->functions.count = n;
    f->terms = n;
    f->form = w->space == SPACE_LRGB ? FOREIGN_LUMINANCE : FOREIGN_CHANNELS;
    if (w->space == SPACE_YCC) {
        f->form = FOREIGN_JOINT;
        f->terms = n + 2;
    }
    return RELUME_OK;
}

// ---------------------------------------------------------------- numbers

static relume_status get_column(struct folder *w, const char *key, double **out)
{
    *out = mem_array((size_t)w->planes, sizeof **out);
    if (!*out)
        return RELUME_ENOMEM;
    if (jvalue_numbers(jvalue_member(w->material, key), *out, (size_t)w->planes))
        return RELUME_OK;
    return log_wrong(w->log, w->info, key, "a finite number for every plane");
}

static relume_status read_material(struct folder *w)
{
    const jvalue *materials = jvalue_member(w->root, "materials");
    if (jvalue_count(materials) != 1)
        return log_wrong(w->log, w->info, "materials", "an array of one object");
    w->material = jvalue_item(materials, 0);
    relume_status status = get_column(w, "scale", &w->scale);
    if (!status)
        status = get_column(w, "bias", &w->bias);
    if (!status && w->space >= SPACE_MRGB)
        status = get_column(w, "range", &w->range);
    for (int p = 0; !status && p < w->planes; p++)
        if (fabs(w->scale[p]) > 1e6 || fabs(w->bias[p]) > 1e6 ||
            (w->range && !(fabs(w->range[p]) > 1e-6 && fabs(w->range[p]) < 1e12)))
            status = log_wrong(w->log, w->info, "materials", "scale, bias and range within reason");
    return status;
}

// Folders of 2019 keep the basis as bytes in a file of its own.
static relume_status read_basis_file(struct folder *w, size_t size)
{
    char *path = mem_format("%s/materials.bin", w->at);
    struct bytes b = {0};
    if (!path)
        return RELUME_ENOMEM;
    relume_status status = RELUME_OK;
    if (!input_exists(path, w->log))
        status = log_wrong(w->log, w->info, "no basis", "a member 'basis' or a file materials.bin");
    if (!status)
        status = bytes_load(&b, path, w->log);
    if (!status && b.size != size)
        status =
            log_fail(w->log, RELUME_EDAMAGED, "%s: %zu bytes; expected %zu", path, b.size, size);
    for (size_t i = 0; !status && i < size; i++)
        w->basis[i] = b.data[i];
    bytes_free(&b);
    mem_free(path);
    return status;
}

// Moves the columns of the lights that are kept to the front, plane by plane.
static void keep_columns(struct folder *w)
{
    double *to = w->basis;
    for (int p = 0; w->column && p <= w->planes; p++)
        for (int j = 0; j < w->f->functions.count; j++, to += 3)
            memmove(to, w->basis + 3 * (p * w->listed + w->column[j]), 3 * sizeof *to);
}

static relume_status read_basis(struct folder *w)
{
    const int listed = w->listed ? w->listed : w->f->functions.count;
    const size_t size = ((size_t)w->planes + 1) * (size_t)listed * 3;
    const jvalue *basis = jvalue_member(w->root, "basis");
    const bool counted = !basis || jvalue_count(basis) == size;
    w->basis = counted ? mem_array(size, sizeof *w->basis) : NULL;
    if (counted && !w->basis)
        return RELUME_ENOMEM;
    if (!basis) {
        const relume_status status = read_basis_file(w, size);
        if (!status)
            keep_columns(w);
        return status;
    }
    if (!counted || !jvalue_numbers(basis, w->basis, size))
        return log_fail(w->log, RELUME_EDAMAGED, "%s: basis; expected %zu numbers, found %zu",
                        w->info, size, jvalue_count(basis));
    for (size_t i = 0; i < size; i++)
        if (w->basis[i] < 0.0 || w->basis[i] > 255.0)
            return refuse(w, RELUME_EDAMAGED, "basis", "numbers from 0 to 255");
    keep_columns(w);
    return RELUME_OK;
}

// ---------------------------------------------------------------- meaning

// (Y, a, b) -> RGB: t = Y - b/2, G = b + t, B = t - a/2, R = B + a
static const double rgb_of_yab[3][3] = {{1.0, 0.5, -0.5}, {1.0, 0.0, 0.5}, {1.0, -0.5, -0.5}};

// Which of (Y, a, b) the plane adds to; -1: to all, which are R, G, B.
static int component_of(const struct folder *w, int plane)
{
    if (w->space == SPACE_MRGB)
        return -1;
    return plane < 3 * w->chroma ? plane % 3 : 0;
}

static void fill_joint(const struct folder *w)
{
    struct foreign *f = w->f;
    const int n = f->functions.count;
    const bool ycc = w->space == SPACE_MYCC;
    for (int j = 0; j < n; j++) {
        const double *mean = w->basis + 3 * j;
        for (int c = 0; c < 3; c++) {
            f->mean[c * n + j] = ycc ? 0.0 : mean[c] / 255.0;
            for (int i = 0; ycc && i < 3; i++)
                f->mean[c * n + j] += rgb_of_yab[c][i] * mean[i] / 255.0;
        }
    }
    for (int p = 0; p < f->terms; p++)
        for (int j = 0; j < n; j++) {
            const double *b = w->basis + ((size_t)(p + 1) * (size_t)n + (size_t)j) * 3;
            const int i = component_of(w, p);
            for (int c = 0; c < 3; c++)
                f->transform[(c * f->terms + p) * n + j] =
                    (i < 0 ? b[c] - 127.0 : rgb_of_yab[c][i] * (b[i] - 127.0)) / w->range[p];
        }
}

// Planes: Y_0, Cb, Cr, Y_1, ... of which Cb and Cr do not depend on the light.
static void fill_ycc(const struct folder *w)
{
    struct foreign *f = w->f;
    const int n = f->functions.count;
    // The constant function as a sum of the type's functions: only the first is a constant.
    double values[FUNCTIONS_MOST_OWN];
    functions_at(&f->functions, vec3_of(0.0, 0.0, 1.0), values);
    const double one = 1.0 / values[0];
    for (int c = 0; c < 3; c++) {
        double *t = f->transform + c * f->terms * n;
        f->mean[c * n] = -0.5 * one * (foreign_rgb_of_ycc[c][1] + foreign_rgb_of_ycc[c][2]);
        t[0] = 1.0;
        t[n] = one * foreign_rgb_of_ycc[c][1];
        t[2 * n] = one * foreign_rgb_of_ycc[c][2];
        for (int k = 1; k < n; k++)
            t[(k + 2) * n + k] = 1.0;
    }
}

static relume_status give_meaning(const struct folder *w)
{
    struct foreign *f = w->f;
    const size_t n = (size_t)f->functions.count, k = (size_t)f->terms;
    if (f->form != FOREIGN_JOINT)
        return RELUME_OK;
    f->transform = mem_zeroed(3 * k * n, sizeof *f->transform);
    f->mean = mem_zeroed(3 * n, sizeof *f->mean);
    if (!f->transform || !f->mean)
        return RELUME_ENOMEM;
    if (w->space == SPACE_YCC)
        fill_ycc(w);
    else
        fill_joint(w);
    return RELUME_OK;
}

// ---------------------------------------------------------------- planes

// Our plane for plane `p` of the folder; -1: unused.
static int plane_of(const struct folder *w, int p)
{
    if (w->space == SPACE_LRGB)
        return p < 3 ? w->f->terms + p : p - 3;
    if (w->space == SPACE_YCC)
        return p < 3 ? p : p % 3 == 0 ? p / 3 + 2 : -1;
    return p;
}

// Planes are pictures, or DeepZoom pyramids.
static bool is_tiled(const struct folder *w, int image)
{
    char *path = mem_format("%s/plane_%d.dzi", w->at, image);
    const bool tiled = path && input_exists(path, w->log);
    mem_free(path);
    return tiled;
}

static relume_status read_jpeg(struct folder *w, int image, struct jpeg_codes *codes)
{
    char *path = mem_format("%s/plane_%d.jpg", w->at, image);
    *codes = (struct jpeg_codes){0};
    if (!path)
        return RELUME_ENOMEM;
    relume_status status = is_tiled(w, image) ? tiles_read(codes, w->at, image, w->limits, w->log)
                                              : jpeg_read(codes, path, w->limits, w->log);
    if (!status &&
        (codes->width != w->f->width || codes->height != w->f->height || codes->planes != 3))
        status = log_fail(w->log, RELUME_EDAMAGED,
                          "%s: %d x %d pixels, %d components; expected %d x %d and 3", path,
                          codes->width, codes->height, codes->planes, w->f->width, w->f->height);
    mem_free(path);
    return status;
}

static void place_jpeg(const struct folder *w, int image, const struct jpeg_codes *codes)
{
    const size_t pixels = foreign_pixels(w->f);
    for (int c = 0; c < 3 && 3 * image + c < w->planes; c++) {
        const int to = plane_of(w, 3 * image + c);
        if (to >= 0)
            memcpy(w->f->codes + (size_t)to * pixels, codes->data + (size_t)c * pixels, pixels);
    }
}

static void set_quantisers(const struct folder *w)
{
    for (int p = 0; p < w->planes; p++) {
        const int to = plane_of(w, p);
        const bool base = w->space == SPACE_LRGB && p < 3;  // the colour as it is
        if (to < 0)
            continue;
        w->f->scale[to] = (float)((base ? 1.0 : w->scale[p]) / 255.0);
        w->f->offset[to] = base ? 0.0f : (float)(-w->bias[p] * w->scale[p]);
    }
}

static relume_status read_planes(struct folder *w)
{
    struct foreign *f = w->f;
    struct jpeg_codes codes;
    if (!jvalue_whole(jvalue_member(w->root, "width"), 1, 1 << 30, &f->width) ||
        !jvalue_whole(jvalue_member(w->root, "height"), 1, 1 << 30, &f->height))
        return log_wrong(w->log, w->info, "size", "width and height, whole numbers from 1");
    // the first picture proves the size before memory is allocated for all
    relume_status status = read_jpeg(w, 0, &codes);
    if (!status)
        status = foreign_create(f, w->info, f->width, f->height,
                                f->form == FOREIGN_CHANNELS    ? 3 * f->terms
                                : f->form == FOREIGN_LUMINANCE ? f->terms + 3
                                                               : f->terms,
                                w->limits, w->log);
    if (!status)
        set_quantisers(w);
    for (int i = 0; !status; i++) {
        place_jpeg(w, i, &codes);
        jpeg_codes_free(&codes);
        if (3 * (i + 1) >= w->planes)
            break;
        status = read_jpeg(w, i + 1, &codes);
    }
    jpeg_codes_free(&codes);
    return status;
}

static relume_status find_folder(struct folder *w, const char *path)
{
    const bool is_folder = input_kind(path, w->log) == INPUT_FOLDER;
    const char *slash = strrchr(path, '/');
    w->at = is_folder ? mem_text(path)
            : slash   ? mem_format("%.*s", (int)(slash - path), path)
                      : mem_text(".");
    w->info = is_folder ? mem_format("%s/info.json", path) : mem_text(path);
    return w->at && w->info ? RELUME_OK : RELUME_ENOMEM;
}

// Turns bare nan and inf into "", in place; returns how many there were.
static int blank_not_numbers(char *text)
{
    static const char *const words[] = {"-nan", "nan", "-inf", "inf"};
    int found = 0;
    bool quoted = false;
    for (char *at = text; *at; at++) {
        if (*at == '\\' && at[1])
            at++;
        else if (*at == '"')
            quoted = !quoted;
        for (size_t i = 0; !quoted && i < sizeof words / sizeof *words; i++) {
            const size_t n = strlen(words[i]);
            if (strncmp(at, words[i], n))
                continue;
            memset(at, ' ', n);
            at[0] = at[1] = '"';
            at += n - 1;
            found++;
            break;
        }
    }
    return found;
}

// relight writes nan for lights that its list gives no direction.
static relume_status load_info(struct folder *w)
{
    char *text;
    size_t size;
    relume_status status = input_load(&text, &size, w->info, UINT64_MAX, "a file", w->log);
    if (status)
        return status;
    if (blank_not_numbers(text)) {
        log_line(w->log, RELUME_WARNING,
                 "%s: holds nan, which is no number; lights without a direction are left out",
                 w->info);
        status = jvalue_parse(&w->root, text, w->log);
    } else {
        status = jvalue_load(&w->root, w->info, w->log);
    }
    mem_free(text);
    return status;
}

relume_status web_read(struct foreign *out, const char *path, const struct relume_limits *limits,
                       const struct relume_log *log)
{
    static relume_status (*const steps[])(struct folder *) = {
        read_kinds,  read_profile,  read_functions, read_plane_count,
        count_terms, read_material, read_planes,
    };
    struct folder w = {.f = out, .limits = limits, .log = log};
    *out = (struct foreign){0};
    relume_status status = find_folder(&w, path);
    if (!status)
        status = load_info(&w);
    for (size_t i = 0; !status && i < sizeof steps / sizeof *steps; i++)
        status = steps[i](&w);
    if (!status && w.space >= SPACE_MRGB)
        status = read_basis(&w);
    if (!status)
        status = give_meaning(&w);
    if (w.root)
        jvalue_free(&w.root);
    mem_free(w.at);
    mem_free(w.info);
    mem_free(w.scale);
    mem_free(w.bias);
    mem_free(w.range);
    mem_free(w.basis);
    mem_free(w.column);
    if (status)
        foreign_free(out);
    return status;
}

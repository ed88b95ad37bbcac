// ubo.c - .btf files of the University of Bonn's data base (UBO2014): what they hold, and where
//
// Bonn has published no description; docs/btf-bonn.md says what is known, from which programs, and
// what is assumed. Little endian throughout, nothing is aligned.
#include "material/btf/ubo.h"

#include "core/base/tree.h"
#include "core/base/context.h"
#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

static const double LOWEST = 1e-3;  // z of a direction, as of other readers
static const double ALIKE = 1e-3;   // radians between directions that are the same

// ---------------------------------------------------------------- bytes

// What follows finds u->status set.
__attribute__((format(printf, 3, 4))) static void fail(struct ubo *u, relume_status status,
                                                       const char *format, ...)
{
    char text[256];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    u->status = log_fail(u->log, status, "%s", text);
}

// The next `n` bytes; NULL when the file ends before.
static const uint8_t *take(struct ubo *u, uint64_t n, const char *what)
{
    if (u->status)
        return NULL;
    if (n > u->size - u->at) {
        fail(u, RELUME_EDAMAGED, "ends within %s; expected %llu bytes more; found %zu", what,
             (unsigned long long)n, u->size - u->at);
        return NULL;
    }
    const uint8_t *bytes = u->bytes + u->at;
    u->at += (size_t)n;
    return bytes;
}

static uint32_t word_at(const uint8_t *b)
{
    return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static uint32_t word(struct ubo *u, const char *what)
{
    const uint8_t *b = take(u, 4, what);
    return b ? word_at(b) : 0;
}

static float number(struct ubo *u, const char *what)
{
    const uint32_t bits = word(u, what);
    float f;
    memcpy(&f, &bits, sizeof f);
    return f;
}

// ---------------------------------------------------------------- the head

static const struct signature {
    const char *text;
    char kind;
    bool extended;
    const char *refused;
} signatures[] = {
    {"!DFMF08FC", 'D', false, NULL},
    {"!FMF12FCE", 'F', true, NULL},
    {"!FMF06FC", 'F', false, NULL},
    {"!PVF06FC", 0, false, "views factored each by itself (PVF)"},
    {"!BDIF", 0, false, "values that are not factored (BDI)"},
};

enum { VERSIONS = 4 };

// An 'R' behind the signature says that rotations follow. A header without it may begin with the
// same byte: then its version decides.
static bool has_rotations(const struct ubo *u)
{
    if (u->size - u->at < 9 || u->bytes[u->at] != 'R')
        return u->size > u->at && u->bytes[u->at] == 'R';
    const uint32_t version = word_at(u->bytes + u->at + 5);
    return version >= 1 && version <= VERSIONS;
}

static void read_signature(struct ubo *u)
{
    for (size_t i = 0; i < sizeof signatures / sizeof *signatures; i++) {
        const struct signature *s = &signatures[i];
        const size_t n = strlen(s->text);
        if (u->size < n || memcmp(u->bytes, s->text, n))
            continue;
        u->at = n;
        u->kind = s->kind;
        u->extended = s->extended;
        u->rotated = has_rotations(u);
        u->at += u->rotated;
        if (s->refused)
            fail(u, RELUME_EUNSUPPORTED,
                 "%s are not read; expected !DFMF08FCR, !FMF12FCER or !FMF06FC", s->refused);
        return;
    }
    fail(u, RELUME_EFORMAT,
         "not a BTF of Bonn; expected a folder, or a file that begins with !DFMF08FCR, "
         "!FMF12FCER or !FMF06FC");
}

// Names and the measurement's own description are passed over.
static void read_head(struct ubo *u)
{
    const size_t start = u->at;
    const uint32_t size = word(u, "its header"), version = word(u, "its header");
    if (!u->status && (version < 1 || version > VERSIONS))
        fail(u, RELUME_EUNSUPPORTED, "header of version %u; expected 1 to %d", version, VERSIONS);
    take(u, 3 * 80 + 4 * 4, "its header");  // set-up, sensor, lamp; pixels a mm, scale of colours
    u->cosine = version > 1 && word(u, "its header");
    if (version > 2)
        take(u, word(u, "its header"), "its description");
    const uint32_t colours = version > 3 ? word(u, "its header") : UBO_COLOURS;
    if (!u->status && colours != UBO_COLOURS)
        fail(u, RELUME_EUNSUPPORTED, "expected 3 colours; found %u", colours);
    for (int i = 0; version > 3 && i < UBO_COLOURS && !u->status; i++)
        take(u, word(u, "the names of its colours"), "the names of its colours");
    if (!u->status && u->at - start != size)
        fail(u, RELUME_EDAMAGED, "header of %u bytes; what its version %u has takes %zu", size,
             version, u->at - start);
}

// ---------------------------------------------------------------- directions

// Of a view, or with `light` from 0 on of one of its lights.
static vec3 direction(struct ubo *u, int view, int light)
{
    const double theta = number(u, "its directions"), phi = number(u, "its directions");
    const vec3 d = vec3_of(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
    char name[64];
    const int n = snprintf(name, sizeof name, "view %d", view);
    if (light >= 0)
        snprintf(name + n, sizeof name - (size_t)n, ", light %d", light);
    if (u->status)
        return d;
    if (!(fabs(theta) <= M_PI) || !(fabs(phi) <= 7.0))
        fail(u, RELUME_EDAMAGED, "%s: expected radians; found %g, %g", name, theta, phi);
    else if (!(d.z >= LOWEST))
        fail(u, RELUME_EDAMAGED, "%s: %g degrees from the pole; expected less than 90", name,
             theta * 180.0 / M_PI);
    return d;
}

static void count_lights(struct ubo *u, int view)
{
    const uint32_t n = word(u, "its lights");
    if (u->status)
        return;
    if (view && n != (uint32_t)u->lights)
        fail(u, RELUME_EDAMAGED, "view %d has %u lights; expected %d as of view 0", view, n,
             u->lights);
    else if (!view && (n < 3 || n > (uint32_t)u->limits.max_lights || n > u->size / 8))
        fail(u, n < 3 ? RELUME_EDAMAGED : RELUME_ELIMIT, "expected 3 to %d lights; found %u",
             u->limits.max_lights, n);
    else if (!view && !(u->light = mem_array(n, sizeof *u->light)))
        u->status = RELUME_ENOMEM;
    u->lights = (int)n;
}

static void read_lights(struct ubo *u, int view)
{
    for (int l = 0; l < u->lights && !u->status; l++) {
        const vec3 d = direction(u, view, l);
        if (!view)
            u->light[l] = d;
        else if (u->odd_view < 0 && !(vec3_angle(u->light[l], d) <= ALIKE))
            u->odd_view = view, u->odd_light = l;
    }
}

static void check_lights(struct ubo *u)
{
    if (u->status || u->odd_view < 0)
        return;
    if (u->params && u->params->fill)
        log_line(u->log, RELUME_WARNING,
                 "light %d of view %d is not that of view 0; the lights of view 0 are used for "
                 "all",
                 u->odd_light, u->odd_view);
    else
        fail(u, RELUME_EUNFIT,
             "light %d of view %d is not that of view 0; expected the same for all (or fill, which "
             "takes these)",
             u->odd_light, u->odd_view);
}

static void read_directions(struct ubo *u)
{
    const uint32_t n = word(u, "its views");
    u->odd_view = -1;
    if (!u->status && (n < 3 || n > (uint32_t)u->limits.max_views || n > u->size / 12))
        fail(u, n < 3 ? RELUME_EDAMAGED : RELUME_ELIMIT, "expected 3 to %d views; found %u",
             u->limits.max_views, n);
    if (!u->status && !(u->view = mem_array(n, sizeof *u->view)))
        u->status = RELUME_ENOMEM;
    u->views = (int)n;
    for (int v = 0; v < u->views && !u->status; v++) {
        u->view[v] = direction(u, v, -1);
        count_lights(u, v);
        read_lights(u, v);
    }
    check_lights(u);
}

// ---------------------------------------------------------------- texels

static void choose_crop(struct ubo *u)
{
    const int *c = u->params ? u->params->crop : NULL;
    u->crop[2] = u->width, u->crop[3] = u->height;
    if (!c || !(c[0] | c[1] | c[2] | c[3]))
        return;
    if (c[0] < 0 || c[1] < 0 || c[2] < 1 || c[3] < 1 || c[2] > u->width - c[0] ||
        c[3] > u->height - c[1])
        u->status = log_fail(u->log, RELUME_EINVAL,
                             "a part of %d x %d texels at %d, %d; expected one of %d x %d", c[2],
                             c[3], c[0], c[1], u->width, u->height);
    memcpy(u->crop, c, sizeof u->crop);
}

static void read_texels(struct ubo *u)
{
    const uint32_t width = word(u, "its size"), height = word(u, "its size");
    if (!u->status && !limits_allow(&u->limits, width, height))
        fail(u, RELUME_ELIMIT, "%u x %u texels; expected 1 to %d a side, %llu in all", width,
             height, u->limits.max_side, (unsigned long long)u->limits.max_pixels);
    if (u->status)
        return;
    u->width = (int)width, u->height = (int)height;
    choose_crop(u);
    if (u->rotated)
        take(u, (uint64_t)word(u, "its rotations") * 9 * 4, "its rotations");
}

// ---------------------------------------------------------------- factors

// A matrix of `rows` by the rank of the plane.
static const uint8_t *factor(struct ubo *u, const struct ubo_plane *p, uint64_t rows)
{
    return take(u, rows * (uint64_t)p->rank * (uint64_t)p->scalar, "its values");
}

// The two factors of one plane: the first has `each` rows for a pair or a texel, the second one.
static void read_factors(struct ubo *u, struct ubo_plane *p, size_t each)
{
    const uint8_t *scalar = take(u, 1, "its values");
    p->scalar = scalar ? *scalar : 2;
    const uint32_t rank = word(u, "its values"), left = word(u, "its values"),
                   right = word(u, "its values");
    const size_t pairs = (size_t)u->views * (size_t)u->lights,
                 texels = (size_t)u->width * (size_t)u->height;
    if (u->status)
        return;
    const bool by_pair = left == each * pairs && right == texels;
    if (p->scalar != 2 && p->scalar != 4 && p->scalar != 8)
        fail(u, RELUME_EUNSUPPORTED, "numbers of %d bytes; expected 2, 4 or 8", p->scalar);
    else if (rank < 1 || rank > UBO_MOST_RANK)
        fail(u, RELUME_EUNSUPPORTED, "%u components; expected 1 to %d", rank, UBO_MOST_RANK);
    else if (!by_pair && !(left == each * texels && right == pairs))
        fail(u, RELUME_EDAMAGED, "factors of %u and %u rows; expected %zu and %zu or %zu and %zu",
             left, right, each * pairs, texels, each * texels, pairs);
    if (u->status)
        return;
    p->rank = (int)rank;
    factor(u, p, 1);  // singular values, which the second factor holds
    const size_t row = (size_t)p->rank * (size_t)p->scalar;
    const uint8_t *first = factor(u, p, left), *second = factor(u, p, right);
    p->pair = by_pair ? first : second, p->texel = by_pair ? second : first;
    p->pair_step = by_pair ? each * row : row, p->texel_step = by_pair ? row : each * row;
}

// Each colour a plane of its own, decorrelated.
static void read_decorrelated(struct ubo *u)
{
    word(u, "its colours");  // the most components of any plane
    const int32_t colours = (int32_t)word(u, "its colours");
    for (int i = 0; i < 3; i++)
        u->mean[i] = number(u, "its colours");
    for (int i = 0; i < 9; i++)
        u->matrix[i] = number(u, "its colours");
    u->colours = ubo_colours_find(colours);
    if (!u->status && !u->colours)
        fail(u, RELUME_EUNSUPPORTED, "colours of kind %d; expected 0, 1, 3, 4 or 9 to 12", colours);
    for (int c = 0; c < UBO_COLOURS && !u->status; c++)
        read_factors(u, &u->plane[c], 1);
}

// Versions 1 and 2 of the extended head: logarithms, and a map of heights, which is passed over.
static bool read_extension(struct ubo *u)
{
    const uint8_t *version = take(u, 1, "its extension");
    if (version && *version > 2)
        fail(u, RELUME_EUNSUPPORTED, "extension of version %d; expected 0 to 2", *version);
    if (u->status)
        return false;
    const bool logarithm = *version > 0 && word(u, "its extension");
    if (*version > 1) {
        const uint64_t width = word(u, "its extension"), height = word(u, "its extension");
        take(u, width && height > UINT64_MAX / 2 / width ? UINT64_MAX : 2 * width * height,
             "its map of heights");
    }
    return logarithm;
}

// All colours in one matrix: those of a pair are neighbours among its rows.
static void read_together(struct ubo *u)
{
    const bool logarithm = u->extended && read_extension(u);
    word(u, "its values");  // components, which the file holds twice
    u->colours = ubo_colours_find(logarithm ? UBO_LOG_RGB : UBO_RGB);
    struct ubo_plane *p = u->plane;
    read_factors(u, p, UBO_COLOURS);
    if (u->status)
        return;
    const size_t row = (size_t)p->rank * (size_t)p->scalar;
    for (int c = 1; c < UBO_COLOURS; c++) {
        p[c] = p[0];
        if (p->pair_step > row)
            p[c].pair += (size_t)c * row;
        else
            p[c].texel += (size_t)c * row;
    }
}

// ---------------------------------------------------------------- the file

static relume_status read_all(struct ubo *u)
{
    read_signature(u);
    if (!u->status)
        read_head(u);
    if (!u->status)
        read_directions(u);
    if (!u->status)
        read_texels(u);
    if (!u->status && u->kind == 'D')
        read_decorrelated(u);
    else if (!u->status)
        read_together(u);
    if (!u->status && u->at != u->size)
        fail(u, RELUME_EDAMAGED, "expected its end after %zu bytes; found %zu more", u->at,
             u->size - u->at);
    return u->status;
}

static relume_status map_file(struct ubo *u)
{
    const int fd = input_descriptor(u->path, u->log);
    struct stat info;
    if (fd < 0 || fstat(fd, &info)) {
        const int error = errno;
        if (fd >= 0)
            close(fd);
        return relume_input_fail(u->params ? u->params->log : NULL, u->path, "cannot be read",
                                 error);
    }
    u->size = S_ISREG(info.st_mode) ? (size_t)info.st_size : 0;
    void *map = u->size ? mmap(NULL, u->size, PROT_READ, MAP_SHARED, fd, 0) : MAP_FAILED;
    close(fd);
    if (map == MAP_FAILED)
        return log_fail(u->log, RELUME_EFORMAT, "cannot be read; expected a BTF of Bonn; found %s",
                        u->size ? "it cannot be mapped into memory" : "an empty file");
    u->bytes = map;
    return RELUME_OK;
}

// The file's name without its folder and ".btf", to be freed.
static char *name_of(const char *path)
{
    char *name = mem_text(path_name(path));
    char *dot = name ? strrchr(name, '.') : NULL;
    if (dot && dot > name && !strcmp(dot, ".btf"))
        *dot = '\0';
    return name;
}

static relume_status make_btf(relume_btf **out, const struct ubo *u)
{
    char *name = name_of(u->path);
    const struct relume_btf_info info = {
        .name = name,
        .width = u->crop[2],
        .height = u->crop[3],
        .views = u->views,
        .lights = u->lights,
        .view = u->view,
        .light = u->light,
        .without_cosine = !u->cosine,
    };
    const struct relume_log *log = u->params ? u->params->log : NULL;
    relume_status status = name ? btf_start(out, &info, u->path, log) : RELUME_ENOMEM;
    mem_free(name);
    if (status || (u->params && u->params->outline))
        return status;
    struct relume_btf_params params = u->params ? *u->params : (struct relume_btf_params){0};
    params.log = u->log;
    status = btf_allocate(*out, &params);
    return status ? status : ubo_store(u, *out);
}

relume_status btf_open_ubo(relume_btf **out, const char *path,
                           const struct relume_btf_params *params)
{
    const struct relume_log *log = params ? params->log : NULL;
    struct relume_context context = context_like(log);
    struct relume_log own = log ? *log : (struct relume_log){0};
    own.context = &context;
    struct log_place place;
    struct ubo u = {.path = path,
                    .params = params,
                    .limits = limits_or_default(limits_of(params ? params->limits : NULL, log)),
                    .log = log_at(&place, &own, "%s: ", path)};
    context.limits = &u.limits;
    *out = NULL;
    relume_status status = map_file(&u);
    if (!status)
        status = read_all(&u);
    if (!status)
        status = make_btf(out, &u);
    if (status)
        relume_btf_destroy(out);
    if (u.bytes)
        munmap((void *)u.bytes, u.size);
    mem_free(u.view);
    mem_free(u.light);
    return status;
}

// manifest.c - capture.json, read
#include "capture/manifest/manifest.h"

#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/vec.h"
#include "image/geometry/geometry.h"
#include "image/image/picture.h"
#include "image/image/picture_kind.h"

#include <ctype.h>
#include <errno.h>
#include <libgen.h>
#include <relume/image/response.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

struct parser {
    struct draft *d;
    const char *path;
    const char *folder;
    struct relume_limits limits;
    const struct relume_log *log;
    bool allow_outside;
};

// An optional member: absent leaves `out` as it is.
static relume_status get_numbers(const struct parser *p, const jvalue *object, const char *key,
                                 double *out, size_t count)
{
    const jvalue *value = jvalue_member(object, key);
    if (!value)
        return RELUME_OK;
    if (count == 1 && jvalue_number(value, out))
        return RELUME_OK;
    char expected[32];
    snprintf(expected, sizeof expected, "%zu number%s", count, relume_plural((int64_t)count));
    return jvalue_numbers(value, out, count) ? RELUME_OK
                                             : log_wrong(p->log, p->path, key, expected);
}

bool leaves_folder(const char *name)
{
    int depth = 0;
    if (*name == '/' || *name == '\\' || (isalpha((unsigned char)*name) && name[1] == ':'))
        return true;
    for (const char *at = name; *at;) {
        const size_t n = strcspn(at, "/\\");
        if (n == 2 && !strncmp(at, "..", 2))
            depth--;
        else if (n && !(n == 1 && *at == '.'))
            depth++;
        if (depth < 0)
            return true;
        at += n + (at[n] != '\0');
    }
    return false;
}

// A file name as a path from the working folder.
static relume_status get_path(const struct parser *p, const jvalue *value, const char *where,
                              const char **out)
{
    const char *text = jvalue_text(value);
    if (!text || !*text)
        return log_wrong(p->log, p->path, where, "a file name");
    if (!p->allow_outside && leaves_folder(text))
        return log_fail(p->log, RELUME_ELIMIT,
                        "%s: %s names '%.200s', outside its folder; expected a file inside; if you "
                        "trust it, --allow-outside",
                        p->path, where, text);
    *out = text[0] == '/' ? arena_text(&p->d->arena, text)
                          : arena_format(&p->d->arena, "%s/%s", p->folder, text);
    return *out ? RELUME_OK : RELUME_ENOMEM;
}

// The same for a member that may be absent or null.
static relume_status get_plane(const struct parser *p, const jvalue *object, const char *key,
                               const char **out)
{
    const jvalue *value = jvalue_member(object, key);
    return !value || jvalue_is_null(value) ? RELUME_OK : get_path(p, value, key, out);
}

static relume_status read_vectors(const struct parser *p, const jvalue *array, const char *what,
                                  struct relume_vec3 **out, int *count)
{
    char where[64];
    const size_t n = jvalue_count(array);
    if (n < 1 || n > (size_t)p->limits.max_lights)
        return log_wrong(p->log, p->path, what,
                         "an array of [x, y, z], not empty and within the limits");
    struct relume_vec3 *v = arena_array(&p->d->arena, n, sizeof *v);
    if (!v)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < n; i++) {
        double xyz[3];
        snprintf(where, sizeof where, "%s[%zu]", what, i);
        if (!jvalue_numbers(jvalue_item(array, i), xyz, 3))
            return log_wrong(p->log, p->path, where, "three finite numbers");
        v[i] = vec3_of(xyz[0], xyz[1], xyz[2]);
    }
    *out = v;
    *count = (int)n;
    return RELUME_OK;
}

static relume_status read_intensities(const struct parser *p, const jvalue *array, int lights)
{
    if (jvalue_count(array) != (size_t)lights)
        return log_wrong(p->log, p->path, "lights.intensities", "one [r, g, b] for every light");
    struct draft *d = p->d;
    d->intensities = arena_array(&d->arena, (size_t)lights, sizeof *d->intensities);
    if (!d->intensities)
        return RELUME_ENOMEM;
    for (int i = 0; i < lights; i++) {
        double rgb[3];
        if (!jvalue_numbers(jvalue_item(array, (size_t)i), rgb, 3))
            return log_wrong(p->log, p->path, "lights.intensities", MANIFEST_INTENSITIES);
        for (int c = 0; c < 3; c++)
            d->intensities[i][c] = (float)rgb[c];
    }
    return RELUME_OK;
}

static relume_status read_falloff(const struct parser *p, const jvalue *value)
{
    const char *text = jvalue_text(value);
    if (!value || jvalue_is_null(value))
        return RELUME_OK;
    if (!text || (strcmp(text, "inverse-square") && strcmp(text, "none")))
        return log_wrong(p->log, p->path, "lights.falloff", "inverse-square or none");
    p->d->m.no_falloff = !strcmp(text, "none");
    return RELUME_OK;
}

static relume_status read_intensities_at(const struct parser *p, const jvalue *value)
{
    const char *text = jvalue_text(value);
    if (!value || jvalue_is_null(value))
        return RELUME_OK;
    if (!text || (strcmp(text, "lamp") && strcmp(text, "origin")))
        return log_wrong(p->log, p->path, "lights.intensities_at", "lamp or origin");
    p->d->m.intensities_at_origin = !strcmp(text, "origin");
    return RELUME_OK;
}

static relume_status read_lights(const struct parser *p, const jvalue *lights)
{
    struct draft *d = p->d;
    const jvalue *directions = jvalue_member(lights, "directions");
    const jvalue *positions = jvalue_member(lights, "positions");
    if (jvalue_is_null(positions))
        positions = NULL;
    const jvalue *intensities = jvalue_member(lights, "intensities");
    relume_status status = RELUME_OK;
    int n = 0;
    if (!directions && !positions)
        return log_wrong(p->log, p->path, "lights", "directions or positions");
    if (positions)
        status = read_vectors(p, positions, "lights.positions", &d->positions, &n);
    if (!status && directions) {
        int m = 0;
        status = read_vectors(p, directions, "lights.directions", &d->directions, &m);
        if (!status && positions && m != n)
            return log_wrong(p->log, p->path, "lights", "as many positions as directions");
        n = m;
    }
    if (!status && intensities && !jvalue_is_null(intensities))
        status = read_intensities(p, intensities, n);
    if (!status)
        status = read_falloff(p, jvalue_member(lights, "falloff"));
    if (!status)
        status = read_intensities_at(p, jvalue_member(lights, "intensities_at"));
    d->m.lights = n;
    return status ? status : draft_check_lights(d, p->path, p->log);
}

static relume_status read_planes(const struct parser *p, const jvalue *slab,
                                 struct relume_geometry *g)
{
    const struct {
        const char *key;
        double *out;
        size_t count;
    } members[] = {
        {"uv_plane_z", &g->uv_z, 1},
        {"st_plane_z", &g->st_z, 1},
        {"st_min", g->st_min, 2},
        {"st_max", g->st_max, 2},
    };
    relume_status status = RELUME_OK;
    for (size_t i = 0; !status && i < sizeof members / sizeof *members; i++)
        status = get_numbers(p, slab, members[i].key, members[i].out, members[i].count);
    return status;
}

static relume_status read_pose(const struct parser *p, const jvalue *slab, int index,
                               struct relume_pose *pose)
{
    const jvalue *axes = jvalue_member(slab, "axes");
    double v[4][3] = {{0.0}};
    char where[48];
    relume_status status = get_numbers(p, slab, "origin", v[3], 3);
    snprintf(where, sizeof where, "slabs[%d].axes", index);
    if (!status && axes && jvalue_count(axes) != 3)
        status =
            log_wrong(p->log, p->path, where, "three vectors: the slab's x, y and z in the world");
    for (size_t i = 0; !status && axes && i < 3; i++)
        if (!jvalue_numbers(jvalue_item(axes, i), v[i], 3))
            status = log_wrong(p->log, p->path, where,
                               "three vectors: the slab's x, y and z in the world");
    if (status)
        return status;
    pose->origin = vec3_of(v[3][0], v[3][1], v[3][2]);
    for (int i = 0; i < 3; i++)
        pose->axis[i] = vec3_of(v[i][0], v[i][1], v[i][2]);
    return RELUME_OK;
}

static relume_status read_slabs(const struct parser *p, const jvalue *slabs)
{
    struct draft *d = p->d;
    const size_t n = jvalue_count(slabs);
    if (n < 1 || n > RELUME_MOST_SLABS)
        return log_wrong(p->log, p->path, "slabs", "an array of 1 to 64 slabs");
    d->slab = arena_array(&d->arena, n, sizeof *d->slab);
    if (!d->slab)
        return RELUME_ENOMEM;
    relume_status status = RELUME_OK;
    for (size_t i = 0; !status && i < n; i++) {
        const jvalue *slab = jvalue_item(slabs, i);
        d->slab[i] = relume_geometry_default(RELUME_SLAB, 1, 1);
        status = read_planes(p, slab, &d->slab[i]);
        if (!status)
            status = read_pose(p, slab, (int)i, &d->slab[i].pose);
    }
    d->m.slabs = (int)n;
    return status;
}

static relume_status read_slab(const struct parser *p, const jvalue *root)
{
    const jvalue *one = jvalue_member(root, "slab");
    const jvalue *several = jvalue_member(root, "slabs");
    if (one && several)
        return log_wrong(p->log, p->path, "slab and slabs", "one of them");
    if (several)
        return read_slabs(p, several);
    if (!one)
        return log_wrong(p->log, p->path, "slab",
                         "an object with uv_plane_z, st_plane_z, st_min, st_max");
    return read_planes(p, one, &p->d->m.geometry);
}

// Of a cylinder. Whether they fit shows with the first image.
static relume_status read_discs(const struct parser *p, const jvalue *panorama)
{
    struct relume_geometry *g = &p->d->m.geometry;
    const jvalue *value = jvalue_member(panorama, "discs");
    if (!value || jvalue_is_null(value) || jvalue_whole(value, 0, p->limits.max_side, &g->disc))
        return RELUME_OK;
    return log_wrong(p->log, p->path, "panorama.discs",
                     "the side of a disc's square in pixels, or 0");
}

static relume_status read_geometry(const struct parser *p, const jvalue *root)
{
    struct relume_geometry *g = &p->d->m.geometry;
    const char *projection = "planar";
    const jvalue *value = jvalue_member(root, "projection");
    if (value)
        projection = jvalue_text(value);
    enum relume_projection kind;
    if (!projection || relume_projection_parse(&kind, projection))
        return log_wrong(p->log, p->path, "projection",
                         "planar, slab, cylindrical, spherical or cube");
    *g = relume_geometry_default(kind, 1, 1);

    const jvalue *window = jvalue_member(root, "window");
    const jvalue *panorama = jvalue_member(root, "panorama");
    const char *camera = jvalue_text(jvalue_member(window, "camera"));
    if (camera && strcmp(camera, "orthographic") && strcmp(camera, "perspective"))
        return log_wrong(p->log, p->path, "window.camera", "orthographic or perspective");
    g->perspective = camera && !strcmp(camera, "perspective");
    p->d->has_window = jvalue_member(window, "min") && jvalue_member(window, "max");
    if (kind == RELUME_SLAB)
        return read_slab(p, root);

    double center[3] = {0.0, 0.0, 0.0};
    relume_status status = get_numbers(p, window, "min", g->window_min, 2);
    const struct {
        const jvalue *object;
        const char *key;
        double *out;
        size_t count;
    } members[] = {
        {window, "max", g->window_max, 2}, {window, "camera_z", &g->camera_z, 1},
        {panorama, "v_min", &g->v_min, 1}, {panorama, "v_max", &g->v_max, 1},
        {panorama, "center", center, 3},
    };
    for (size_t i = 0; !status && i < sizeof members / sizeof *members; i++)
        status =
            get_numbers(p, members[i].object, members[i].key, members[i].out, members[i].count);
    g->center = vec3_of(center[0], center[1], center[2]);
    return status ? status : read_discs(p, panorama);
}

// Which slab a view is of.
static relume_status read_member(const struct parser *p, const jvalue *object, int index)
{
    const struct draft *d = p->d;
    int *slab = &d->view[index].slab;
    if (d->m.slabs && !jvalue_whole(jvalue_member(object, "slab"), 0, RELUME_MOST_SLABS - 1, slab))
        *slab = -1;
    return RELUME_OK;
}

static relume_status read_view(const struct parser *p, const jvalue *object, int index)
{
    struct draft *d = p->d;
    struct relume_manifest_view *v = &d->view[index];
    char where[48];
    snprintf(where, sizeof where, "views[%d].images", index);
    const jvalue *images = jvalue_member(object, "images");
    if (!jvalue_is_array(images))
        return log_wrong(p->log, p->path, where, "an array of file names");
    if (jvalue_count(images) != (size_t)d->m.lights)
        return log_fail(p->log, RELUME_EFORMAT,
                        "%s: %s; expected %d images for %d lights, found %zu", p->path, where,
                        d->m.lights, d->m.lights, jvalue_count(images));
    v->images = arena_array(&d->arena, (size_t)d->m.lights, sizeof *v->images);
    if (!v->images)
        return RELUME_ENOMEM;
    relume_status status = RELUME_OK;
    for (int i = 0; !status && i < d->m.lights; i++)
        status = get_path(p, jvalue_item(images, (size_t)i), where, &v->images[i]);
    if (!status)
        status = get_plane(p, object, "depth", &v->depth);
    if (!status)
        status = get_plane(p, object, "mask", &v->mask);
    if (!status)
        status = read_member(p, object, index);
    if (status)
        return status;
    if (d->m.geometry.projection == RELUME_SLAB && !jvalue_member(object, "uv"))
        return log_wrong(p->log, p->path, "views[].uv", "two numbers for every view of a slab");
    return get_numbers(p, object, "uv", v->uv, 2);
}

static relume_status read_views(const struct parser *p, const jvalue *views)
{
    struct draft *d = p->d;
    const size_t n = jvalue_count(views);
    if (n < 1 || n > (size_t)p->limits.max_views)
        return log_wrong(p->log, p->path, "views",
                         "an array of views, not empty and within the limits");
    d->view = arena_array(&d->arena, n, sizeof *d->view);
    if (!d->view)
        return RELUME_ENOMEM;
    d->m.views = (int)n;
    relume_status status = RELUME_OK;
    for (size_t i = 0; !status && i < n; i++)
        status = read_view(p, jvalue_item(views, i), (int)i);
    return status ? status : draft_check_views(d, p->path, p->log);
}

// A known curve, or the file of a response.
static relume_status read_transfer(const struct parser *p, const jvalue *value)
{
    struct draft *d = p->d;
    const char *text = jvalue_text(value), *path = NULL;
    if (!value || jvalue_is_null(value) || (text && !relume_transfer_parse(&d->m.transfer, text)))
        return RELUME_OK;
    const relume_status status = text ? get_path(p, value, "transfer", &path) : RELUME_EFORMAT;
    if (status == RELUME_ENOMEM)
        return status;
    if (status || !input_exists(path, p->log))
        return log_wrong(p->log, p->path, "transfer",
                         "linear, srgb, gamma:NUMBER or a response-curve file");
    struct relume_response *response = arena_array(&d->arena, 1, sizeof *response);
    if (!response)
        return RELUME_ENOMEM;
    d->m.transfer = (struct relume_transfer){.curve = RELUME_CURVE_RESPONSE, .response = response};
    return relume_response_load(response, path, p->log);
}

static relume_status read_photographs(const struct parser *p, const jvalue *value)
{
    const char *text = jvalue_text(value);
    p->d->m.display_coded = text && !strcmp(text, "display");
    return !value || jvalue_is_null(value) || text
               ? RELUME_OK
               : log_wrong(p->log, p->path, "photographs", "\"display\", or nothing");
}

static relume_status read_provenance(const struct parser *p, const jvalue *value)
{
    if (!value || jvalue_is_null(value))
        return RELUME_OK;
    if (!jvalue_is_object(value))
        return log_wrong(p->log, p->path, "provenance", "an object");
    char *text = jvalue_print(value);
    p->d->m.provenance = text ? arena_text(&p->d->arena, text) : NULL;
    mem_free(text);
    return p->d->m.provenance ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status read_root(const struct parser *p, const jvalue *root)
{
    const char *format = jvalue_text(jvalue_member(root, "format"));
    if (!format || strcmp(format, "relume-capture"))
        return log_wrong(p->log, p->path, "format", "\"relume-capture\"");
    long long version;
    if (!jvalue_integer(jvalue_member(root, "version"), &version) || version < 1)
        return log_wrong(p->log, p->path, "version", "1");
    if (version > MANIFEST_VERSION)
        return log_fail(p->log, RELUME_EUNSUPPORTED,
                        "%s: version %lld is newer than this program; expected %d", p->path,
                        version, MANIFEST_VERSION);
    struct draft *d = p->d;
    relume_status status = read_transfer(p, jvalue_member(root, "transfer"));
    if (!status)
        status = read_geometry(p, root);
    if (!status)
        status = draft_check_geometry(d, p->path, p->log);
    if (!status)
        status = read_lights(p, jvalue_member(root, "lights"));
    if (!status)
        status = read_views(p, jvalue_member(root, "views"));
    if (!status)
        status = read_photographs(p, jvalue_member(root, "photographs"));
    if (!status)
        status = read_provenance(p, jvalue_member(root, "provenance"));
    draft_publish(d);
    return status;
}

// Somebody gave a photograph where its list belongs, or a file that is encoded already.
static relume_status refuse_picture(const char *path, const struct relume_log *log)
{
    char head[4096] = "";
    struct picture_look look = {0};
    FILE *f = input_open(path, log);
    if (!f)
        return relume_input_fail(log, path, "cannot be opened", errno);
    const size_t n = fread(head, 1, sizeof head - 1, f);
    fclose(f);
    memcpy(look.head, head, sizeof look.head);
    const struct picture_kind *kind = picture_kind_of(&look, path);
    if (picture_head_is_relume(head, n))
        return log_fail(
            log, RELUME_EFORMAT,
            "%s: this is a relume file, encoded already; expected the capture.json, the "
            ".lp file or the folder of its photographs",
            path);
    if (kind->listed)
        return log_fail(log, RELUME_EFORMAT,
                        "%s: this is a photograph; give the .lp file, or use 'relume capture', for "
                        "a panorama 'relume panorama'",
                        path);
    if (kind->what)
        return log_fail(log, RELUME_EFORMAT, "%s: this is %s, no capture; %s", path, kind->what,
                        kind->advice);
    if (!strchr("{[", head[strspn(head, " \t\r\n")]) || !n)
        return log_fail(log, RELUME_EFORMAT,
                        "%s: %s, no capture; expected a capture.json, a .lp file or a folder that "
                        "holds one",
                        path, n ? "not JSON" : "an empty file");
    return RELUME_OK;
}

// Frees `root`; `out` is empty on failure.
static relume_status take_root(struct draft *out, jvalue **root, const char *path,
                               const char *folder, const struct relume_capture_params *params)
{
    const struct parser p = {
        out, path, folder, limits_or_default(params->limits), params->log, params->allow_outside};
    const relume_status status = read_root(&p, *root);
    jvalue_free(root);
    if (status)
        draft_free(out);
    return status;
}

relume_status manifest_read(struct draft *out, const char *path,
                            const struct relume_capture_params *params)
{
    *out = (struct draft){0};
    jvalue *root;
    relume_status status = refuse_picture(path, params->log);
    if (!status)
        status = jvalue_load(&root, path, params->log);
    if (status)
        return status;
    char *copy = mem_text(path);
    status = copy ? take_root(out, &root, path, dirname(copy), params) : RELUME_ENOMEM;
    mem_free(copy);
    jvalue_free(&root);
    return status;
}

relume_status manifest_parse(struct draft *out, const char *text, const char *path,
                             const char *folder, const struct relume_capture_params *params)
{
    jvalue *root;
    *out = (struct draft){0};
    const relume_status status = jvalue_parse(&root, text, params->log);
    return status ? status : take_root(out, &root, path, folder, params);
}

relume_status manifest_lights(struct relume_captured_lights *out, const jvalue *root,
                              const char *path, const struct relume_log *log)
{
    struct draft draft = {0};
    const struct parser p = {&draft, path, ".", limits_or_default(NULL), log, false};
    const jvalue *lights = jvalue_member(root, "lights");
    *out = (struct relume_captured_lights){0};
    // The output of `relume lights --json` has the directions at its top.
    relume_status status = read_lights(&p, lights ? lights : root);
    if (!status)
        status = draft_state_power(&draft);
    if (!status) {
        const size_t n = (size_t)draft.m.lights;
        out->count = draft.m.lights;
        out->direction = mem_copy(draft.directions, n, sizeof *out->direction);
        if (draft.positions)
            out->position = mem_copy(draft.positions, n, sizeof *out->position);
        if (draft.intensities)
            out->intensity = mem_copy(draft.intensities, n, sizeof *out->intensity);
        if (!out->direction || (draft.positions && !out->position) ||
            (draft.intensities && !out->intensity))
            status = RELUME_ENOMEM;
    }
    draft_free(&draft);
    return status;
}

// olat.c - one light at a time: captures as light stages leave them, an EXR with a layer for every
// light, or a folder of pictures beside a list of directions
#include "capture/manifest/capture.h"
#include "capture/manifest/loaded_lights.h"
#include "capture/manifest/reflectance_table.h"
#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/scratch.h"
#include "core/base/tree.h"
#include "image/image/exr.h"
#include "image/image/picture.h"

#include <errno.h>
#include <relume/image/directions.h>
#include <relume/image/photograph.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { LEAST = 3, LAYER = 128 };

// ---------------------------------------------------------------- layers

struct layer {
    char name[LAYER];
    int part, channel[3];  // -1: none
};

struct layers {
    exr_file *file;
    struct layer *layer;
    int count;
    int x, y, width, height;  // the data window
    bool even;                // all parts have that window and plain samples
};

// "light0007.R" of a part, or "R" in a part named light0007: its layer and colour; -1: neither.
static int colour_of(char layer[LAYER], const char *channel, const char *part)
{
    const char *dot = strrchr(channel, '.'), *letter = dot ? dot + 1 : channel;
    const int length = dot ? (int)(dot - channel) : (int)strlen(part);
    if (strlen(letter) != 1 || !length || length >= LAYER)
        return -1;
    snprintf(layer, LAYER, "%.*s", length, dot ? channel : part);
    const char *at = strchr("RGBrgb", *letter);
    return at ? (int)(at - "RGBrgb") % 3 : -1;
}

static struct layer *find_layer(struct layers *l, const char *name, int part)
{
    for (int i = l->count - 1; i >= 0; i--)  // channels of a layer follow each other
        if (l->layer[i].part == part && !strcmp(l->layer[i].name, name))
            return &l->layer[i];
    if (!mem_grow(&l->layer, (size_t)l->count, sizeof *l->layer))
        return NULL;
    struct layer *new = &l->layer[l->count++];
    *new = (struct layer){.part = part, .channel = {-1, -1, -1}};
    snprintf(new->name, sizeof new->name, "%s", name);
    return new;
}

static int by_name(const void *a, const void *b)
{
    const struct layer *one = a, *two = b;
    const int order = strverscmp(one->name, two->name);
    return order ? order : one->part - two->part;
}

static relume_status find_layers(struct layers *l)
{
    const int parts = exr_part_count(l->file);
    l->even = true;
    for (int p = 0; p < parts; p++) {
        const struct exr_part_info info = exr_part_info(l->file, p);
        l->even &= info.uniform && info.sample != EXR_SAMPLE_UINT &&
                   (!p || (info.width == l->width && info.height == l->height && info.x == l->x &&
                           info.y == l->y));
        l->x = info.x;
        l->y = info.y;
        l->width = info.width;
        l->height = info.height;
        for (int c = 0; c < info.channels; c++) {
            char name[LAYER];
            const int colour =
                colour_of(name, exr_channel_name(l->file, p, c), parts > 1 ? info.name : "");
            struct layer *layer = colour < 0 ? NULL : find_layer(l, name, p);
            if (colour >= 0 && !layer)
                return RELUME_ENOMEM;
            if (layer)
                layer->channel[colour] = c;
        }
    }
    int whole = 0;
    for (int i = 0; i < l->count; i++)
        if (l->layer[i].channel[0] >= 0 && l->layer[i].channel[1] >= 0 &&
            l->layer[i].channel[2] >= 0)
            l->layer[whole++] = l->layer[i];
    l->count = whole;
    if (whole)
        qsort(l->layer, (size_t)whole, sizeof *l->layer, by_name);
    return RELUME_OK;
}

static void close_layers(struct layers *l)
{
    mem_free(l->layer);
    exr_close(&l->file);
    *l = (struct layers){0};
}

static bool is_exr(const char *path, const struct relume_log *log)
{
    char head[4] = "";
    FILE *f = input_kind(path, log) == INPUT_FILE ? input_open(path, log) : NULL;
    const bool is = f && fread(head, 1, 4, f) == 4 && !memcmp(head, "\x76\x2f\x31\x01", 4);
    if (f)
        fclose(f);
    return is;
}

typedef relume_status open_exr(exr_file **out, const char *path, const struct relume_reader *from,
                               const struct relume_limits *limits, const struct relume_log *log);

// `opener` is exr_open, or exr_open_damaged where the header is all that is looked at.
static relume_status open_layers(struct layers *l, const char *path, open_exr *opener,
                                 const struct relume_limits *limits, const struct relume_log *log)
{
    *l = (struct layers){0};
    relume_status status = opener(&l->file, path, NULL, limits, log);
    if (!status)
        status = find_layers(l);
    if (status)
        close_layers(l);
    return status;
}

// ---------------------------------------------------------------- lights

// What lists of directions are called, beside the pictures.
static const char *const lists[] = {"light_dirs", "light_directions", "lights", "directions",
                                    "dirs",       "LightDirections"};
static const char *const endings[] = {".txt", ".csv", ".json", ".lp"};
enum { LISTS = sizeof lists / sizeof *lists, ENDINGS = sizeof endings / sizeof *endings };

static bool exists(char **out, char *path, const struct relume_log *log)
{
    if (path && input_exists(path, log)) {
        *out = path;
        return true;
    }
    mem_free(path);
    return false;
}

// "FOLDER/light_dirs.txt" and the like; NULL where there is none.
static char *list_in(const char *folder, const struct relume_log *log)
{
    char *out = NULL;
    const int some = ENDINGS - 1;  // an .lp file names its pictures: lp.c
    for (int i = 0; i < LISTS * some; i++)
        if (exists(&out, mem_format("%s/%s%s", folder, lists[i / some], endings[i % some]), log))
            return out;
    return NULL;
}

// The same of a file's own name, else in its folder.
static char *list_beside(const char *path, const struct relume_log *log)
{
    const char *name = path_name(path), *dot = strrchr(name, '.');
    const int stem = (int)(dot ? dot - path : (ptrdiff_t)strlen(path));
    const int length = (int)(name - path);
    char *out = NULL;
    for (int i = 0; i < ENDINGS; i++)
        if (exists(&out, mem_format("%.*s%s", stem, path, endings[i]), log))
            return out;
    char *folder = length ? mem_format("%.*s", length - 1, path) : mem_text(".");
    out = folder ? list_in(folder, log) : NULL;
    mem_free(folder);
    return out;
}

// Directions in the order of the layers that a list names; the list's own order where it names
// none.
static relume_status order_by_layer(struct relume_captured_lights *out,
                                    const struct loaded_lights *list, const struct layers *l,
                                    const char *path, const struct relume_log *log)
{
    const struct light_names names = loaded_lights_names(list, path);
    const char **name = mem_array((size_t)l->count, sizeof *name);
    int *order = mem_array((size_t)l->count, sizeof *order), matched;
    out->direction = mem_array((size_t)l->count, sizeof *out->direction);
    relume_status status = name && order && out->direction ? RELUME_OK : RELUME_ENOMEM;
    for (int i = 0; !status && i < l->count; i++)
        name[i] = l->layer[i].name;
    if (!status)
        status = light_names_pair_all(order, &matched, &names, name, l->count, log);
    if (!status && matched && matched < l->count)
        status = light_names_refuse(&names, order, name, l->count, "", log);
    for (int i = 0; !status && i < l->count; i++)
        out->direction[i] = list->lights.direction[order[i]];
    out->count = l->count;
    mem_free(name);
    mem_free(order);
    return status;
}

static relume_status directions_of(struct relume_captured_lights *out, const struct layers *l,
                                   const char *path, const struct relume_log *log)
{
    int count;
    const float *own = exr_get_floats(l->file, 0, "olat.directions", &count);
    *out = (struct relume_captured_lights){0};
    if (own && count == 3 * l->count) {
        out->direction = mem_array((size_t)l->count, sizeof *out->direction);
        out->count = l->count;
        for (int i = 0; out->direction && i < l->count; i++)
            out->direction[i] = (struct relume_vec3){(double)own[3 * i], (double)own[3 * i + 1],
                                                     (double)own[3 * i + 2]};
        return out->direction ? RELUME_OK : RELUME_ENOMEM;
    }
    char *list = list_beside(path, log);
    if (!list)
        return log_fail(
            log, RELUME_EFORMAT,
            "%s: %d layers, but no directions of their lights; expected a file beside it "
            "with a line x y z for each, by its own name (.csv, .txt, .lp) or "
            "light_dirs.txt",
            path, l->count);
    struct loaded_lights lights;
    relume_status status = loaded_lights_load(&lights, list, false, log);
    if (!status)
        status = order_by_layer(out, &lights, l, list, log);
    loaded_lights_free(&lights);
    if (status)
        relume_captured_lights_destroy(out);
    mem_free(list);
    return status;
}

// ---------------------------------------------------------------- pictures

struct filling {
    const struct layers *l;
    int part;
    enum exr_sample sample;
    int channels;
    float *data;  // [layers][height][width][3]
};

static void fill(void *context, const struct relume_rect *at, const void *samples)
{
    const struct filling *f = context;
    const struct layers *l = f->l;
    const size_t bytes = exr_sample_bytes(f->sample), width = (size_t)at->width;
    float row[256];
    for (int i = 0; i < l->count; i++)
        for (int c = 0; l->layer[i].part == f->part && c < 3; c++)
            for (int y = at->top; y < at->top + at->height; y++) {
                const char *from =
                    exr_samples(samples, at, at, y, f->channels, l->layer[i].channel[c], bytes);
                float *to =
                    f->data + 3 * (((size_t)i * (size_t)l->height + (size_t)y) * (size_t)l->width +
                                   (size_t)at->left);
                for (size_t x = 0; x < width; x += 256) {
                    const size_t n = width - x < 256 ? width - x : 256;
                    exr_to_floats(row, f->sample, from + x * bytes, n);
                    for (size_t k = 0; k < n; k++)
                        to[3 * (x + k) + (size_t)c] = row[k];
                }
            }
}

static relume_status read_layers(float *data, const struct layers *l, const struct relume_log *log)
{
    relume_status status = RELUME_OK;
    for (int p = 0; !status && p < exr_part_count(l->file); p++) {
        const struct exr_part_info info = exr_part_info(l->file, p);
        struct filling f = {l, p, info.sample, info.channels, data};
        status = exr_read(l->file, p, NULL, 0, fill, &f, log);
    }
    return status;
}

// What messages and lists call them.
static relume_status name_pictures(relume_capture *c, const struct layers *l, const char *path)
{
    for (int i = 0; i < l->count; i++) {
        const char *name = arena_format(&c->draft.arena, "%s: %s", path, l->layer[i].name);
        if (!name)
            return RELUME_ENOMEM;
        c->draft.view[0].images[i] = name;
    }
    return RELUME_OK;
}

// Layers become pictures in a temporary file, and these a capture.
static relume_status capture_layers(relume_capture **out, const struct layers *l, const char *path,
                                    const struct relume_captured_lights *lights,
                                    const struct relume_capture_params *p)
{
    const size_t bytes = (size_t)l->count * (size_t)l->width * (size_t)l->height * 12;
    const struct relume_manifest manifest = {.lights = l->count, .directions = lights->direction};
    float *data = scratch_map(p->scratch, bytes);
    if (!data)
        return errno == ENOMEM
                   ? RELUME_ENOMEM
                   : log_fail(p->log, RELUME_EIO, "%s: no room for %s of its pictures in %s", path,
                              memory_text(bytes, 0).text, scratch_folder());
    const struct relume_pictures pictures = {
        .width = l->width, .height = l->height, .channels = 3, .data = data};
    relume_status status = read_layers(data, l, p->log);
    if (!status)
        status = relume_capture_create(out, &manifest, &pictures, p);
    if (status) {
        scratch_unmap(data, bytes);
        return status;
    }
    (*out)->owned = data;
    (*out)->owned_bytes = bytes;
    return name_pictures(*out, l, path);
}

relume_status olat_open(relume_capture **out, const char *path,
                        const struct relume_capture_params *p)
{
    struct layers l;
    struct relume_captured_lights lights;
    relume_status status = open_layers(&l, path, exr_open, p->limits, p->log);
    if (status)
        return status;
    if (!l.even)
        status = log_fail(
            p->log, RELUME_EUNSUPPORTED,
            "%s: its layers differ in size, data window or type; expected floats of one data "
            "window",
            path);
    if (!status)
        status = directions_of(&lights, &l, path, p->log);
    if (!status) {
        status = capture_layers(out, &l, path, &lights, p);
        if (status)
            relume_capture_destroy(out);
        relume_captured_lights_destroy(&lights);
    }
    close_layers(&l);
    return status;
}

bool olat_is_stage(const char *path, const struct relume_log *log)
{
    struct layers l;
    if (!is_exr(path, log) || picture_is_relume(path, log) ||
        open_layers(&l, path, exr_open_damaged, NULL, NULL))
        return false;
    const bool is = l.count >= LEAST;
    close_layers(&l);
    return is;
}

// ---------------------------------------------------------------- folders

// The pictures of a folder, or of the only one below that is called as stages call it.
static relume_status list_pictures(struct relume_photographs *out, const char *folder,
                                   const struct relume_log *log)
{
    static const char *const below[] = {"", "/olat", "/OLAT", "/images", "/Images"};
    relume_status status = RELUME_EFORMAT;
    *out = (struct relume_photographs){0};
    for (size_t i = 0; status && i < sizeof below / sizeof *below; i++) {
        char *path = mem_format("%s%s", folder, below[i]);
        const char *paths[] = {path};
        if (!path)
            return RELUME_ENOMEM;
        if (input_kind(path, log) == INPUT_FOLDER)
            status = relume_photographs_list(
                out, paths, 1, relume_photographs_params(.quiet = true, .companions = true));
        if (!status && out->count < LEAST) {
            relume_photographs_free(out);
            status = RELUME_EFORMAT;
        }
        mem_free(path);
    }
    return status;
}

static int by_number(const void *a, const void *b)
{
    return strverscmp(*(char *const *)a, *(char *const *)b);
}

bool olat_is_folder(const char *folder, const struct relume_log *log)
{
    struct relume_photographs list;
    char *lights = list_in(folder, log);
    const bool is = lights && !list_pictures(&list, folder, log);
    if (is)
        relume_photographs_free(&list);
    mem_free(lights);
    return is;
}

// order[pictures] is the light of each, -1: none, which leaves it out.
static relume_status draft_of(struct draft *d, const struct relume_photographs *list,
                              const struct relume_captured_lights *lights, const int *order)
{
    const size_t n = (size_t)list->count;
    d->m = (struct relume_manifest){.geometry = relume_geometry_default(RELUME_PLANAR, 1, 1),
                                    .views = 1};
    d->directions = arena_array(&d->arena, n, sizeof *d->directions);
    d->view = arena_array(&d->arena, 1, sizeof *d->view);
    if (!d->directions || !d->view)
        return RELUME_ENOMEM;
    *d->view = (struct relume_manifest_view){.images = arena_array(&d->arena, n, sizeof(char *))};
    for (size_t i = 0; d->view->images && i < n; i++) {
        if (order[i] < 0)
            continue;
        d->directions[d->m.lights] = lights->direction[order[i]];
        if (!(d->view->images[d->m.lights++] = arena_text(&d->arena, list->path[i])))
            return RELUME_ENOMEM;
    }
    d->listed = true;
    if (d->view->images && list->mask)
        d->view->mask = arena_text(&d->arena, list->mask);
    draft_publish(d);
    return d->view->images ? RELUME_OK : RELUME_ENOMEM;
}

// Names decide; without names pictures take the lights in the order of their own names.
static relume_status pair_pictures(int *order, const struct relume_photographs *list,
                                   const struct loaded_lights *lights, const char *path,
                                   const struct relume_capture_params *p)
{
    const struct light_names names = loaded_lights_names(lights, path);
    const char *const *pictures = (const char *const *)list->path;
    int matched;
    const relume_status status =
        light_names_pair_all(order, &matched, &names, pictures, list->count, p->log);
    const int alone = list->count - matched, unused = names.count - matched;
    if (status || !matched || (!alone && !unused))
        return status;
    if (!p->skip_missing)
        return light_names_refuse(&names, order, pictures, list->count,
                                  "--skip-missing continues without these", p->log);
    log_line(p->log, RELUME_WARNING,
             "%s: left out: %d photographs without a light, %d lights without a photograph", path,
             alone, unused);
    return RELUME_OK;
}

relume_status olat_read_folder(struct draft *out, char **path, const char *folder,
                               const struct relume_capture_params *p)
{
    struct relume_photographs list;
    struct loaded_lights lights;
    char *from = list_in(folder, p->log);
    *path = from;
    relume_status status = from ? list_pictures(&list, folder, p->log) : RELUME_ENOMEM;
    if (status)
        return status;
    qsort(list.path, (size_t)list.count, sizeof *list.path, by_number);
    int *order = mem_array((size_t)list.count, sizeof *order);
    status = loaded_lights_load(&lights, from, false, p->log);
    if (!status && !order)
        status = RELUME_ENOMEM;
    if (!status)
        status = pair_pictures(order, &list, &lights, from, p);
    if (!status)
        status = draft_of(out, &list, &lights.lights, order);
    mem_free(order);
    loaded_lights_free(&lights);
    relume_photographs_free(&list);
    return status;
}

bool relume_capture_is_olat(const char *path, const struct relume_log *log)
{
    return input_kind(path, log) == INPUT_FOLDER ? olat_is_folder(path, log)
                                                 : olat_is_stage(path, log);
}

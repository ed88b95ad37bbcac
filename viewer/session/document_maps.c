// document_maps.c - folders of maps (relume/material/maps.h): shown under the lights as they are
// edited, by the library
#include "session/edits_text.h"
#include "session/session.h"

#include "app/light_list.h"
#include "cli/program/say.h"
#include "material/maps/maps.h"
#include "relight/light/environment.h"

#include <relume/exchange.h>
#include <relume/material/edit.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// What a document of this kind owns.
struct edited_maps {
    struct relume_maps maps;
    int threads;
};

static struct edited_maps *maps_of(const struct document *d)
{
    return d->own;
}

static bool is_maps(const char *path, const struct object_set *objects)
{
    (void)objects;
    return path && relume_kind_of(path) == RELUME_KIND_MAPS;
}

// ---------------------------------------------------------------- lights

static relume_status add_light(struct relume_image *sum, const struct edited_maps *m,
                               struct relume_vec3 direction, const float rgb[3])
{
    struct relume_image lit;
    const relume_status status = relume_maps_relight(&lit, &m->maps, direction, m->threads);
    if (status)
        return status;
    const size_t n = 3 * (size_t)lit.width * (size_t)lit.height;
    for (size_t i = 0; i < n; i++)
        sum->data[i] += rgb[i % 3] * lit.data[i];
    relume_image_destroy(&lit);
    return RELUME_OK;
}

static relume_status paint_maps(struct relume_image *out, void *user,
                                const struct relume_light *lights, int n)
{
    enum { OF_SKY = 48 };  // directional lights instead of an environment map
    const struct edited_maps *m = user;
    struct relume_light sky[OF_SKY];
    relume_status status = relume_image_create(out, m->maps.width, m->maps.height, 3);
    for (int i = 0; i < n && !status; i++) {
        const bool environment = lights[i].kind == RELUME_LIGHT_ENVIRONMENT;
        const struct relume_light *from = environment ? sky : &lights[i];
        if (environment)
            status = relume_environment_sample(sky, OF_SKY, &lights[i], 0);
        for (int k = 0; k < (environment ? OF_SKY : 1) && !status; k++)
            status = add_light(out, m, from[k].direction, from[k].rgb);
    }
    if (status)
        relume_image_destroy(out);
    return status;
}

static relume_status check_lights(const struct app_state *start, const struct relume_log *log)
{
    for (int i = 0; i < start->lights; i++)
        if (relume_light_is_near(start->light[i].kind))
            return say(log, RELUME_EUNFIT,
                       "maps are shown under directional lights and environments; found a near "
                       "light");
    return RELUME_OK;
}

// ---------------------------------------------------------------- edits

// The maps of a folder with the edits that are kept with it, changed as `words` say (NULL: not).
static relume_status open_edited(struct relume_maps *out, relume_edits **edits, const char *path,
                                 char *words, int threads, const struct relume_log *log)
{
    *edits = NULL;
    relume_status status = relume_maps_open(out, path, log);
    if (!status)
        status = relume_edits_open(edits, path, relume_maps_fingerprint(out), log);
    if (!status && words)
        status = edits_change(*edits, words, log);
    if (!status)
        status = relume_maps_edit(out, *edits, threads, log);
    if (status) {
        relume_maps_destroy(out);
        relume_edits_destroy(edits);
    }
    return status;
}

static bool can_edit_maps(const struct session *s)
{
    (void)s;
    return true;
}

static void describe_maps(struct session *s)
{
    const struct relume_maps *maps = &maps_of(&s->document)->maps;
    s->document.lines = 0;
    document_add_line(&s->document, "maps, %d x %d", maps->width, maps->height);
    document_add_line(&s->document, "%d light%s were fitted, %d material%s", maps->lights,
                      relume_plural(maps->lights), maps->materials, relume_plural(maps->materials));
}

static relume_status write_maps(const struct edited_maps *m, char *folder,
                                const struct relume_log *log)
{
    return relume_maps_write(
        &m->maps, edits_unquote(folder),
        relume_maps_write_params(.log = log, .threads = m->threads, .directx = m->maps.directx));
}

static void use_painter(struct session *s)
{
    gl_renderer_use_painter(&s->renderer, &(struct view_painter){s->document.own, paint_maps});
}

static void show_edited(struct session *s, const struct relume_maps *maps,
                        const relume_edits *edits)
{
    struct edited_maps *m = maps_of(&s->document);
    relume_maps_destroy(&m->maps);
    m->maps = *maps;
    describe_maps(s);
    document_describe_edits(&s->document, edits);
    use_painter(s);
}

static relume_status edit_maps(struct session *s, const char *words, const struct relume_log *log)
{
    char copy[APP_SPEC];
    struct relume_maps maps;
    relume_edits *edits;
    const char *path = s->document.path;
    snprintf(copy, sizeof copy, "%s", words);
    if (!strncmp(copy, "write ", 6))
        return write_maps(maps_of(&s->document), copy + 6, log);
    relume_status status = open_edited(&maps, &edits, path, copy, s->settings.threads, log);
    if (status)
        return status;
    status = relume_edits_save(edits, path, log);
    if (!status)
        show_edited(s, &maps, edits);
    else
        relume_maps_destroy(&maps);
    relume_edits_destroy(&edits);
    return status;
}

// ---------------------------------------------------------------- opening

// A plane 2 wide, seen from above.
static struct app_file file_of(const struct relume_maps *maps)
{
    const double high = (double)maps->height / maps->width;
    return (struct app_file){
        .geometry = {.projection = RELUME_PLANAR,
                     .camera_z = 4,
                     .window_min = {-1, -high},
                     .window_max = {1, high}},
        .width = maps->width,
        .height = maps->height,
        .views = 1,
        .only_colour = true,
    };
}

static relume_status open_maps(struct opening *out, struct session *s, const char *path,
                               const struct app_state *start, bool look_ahead)
{
    relume_edits *edits;
    (void)look_ahead;
    relume_status status = check_lights(start, s->log);
    struct edited_maps *m = out->document.own = calloc(1, sizeof *m);
    if (!status && !m)
        status = RELUME_ENOMEM;
    if (!status)
        status = open_edited(&m->maps, &edits, path, NULL, s->settings.threads, s->log);
    if (status)
        return status;
    m->threads = s->settings.threads;
    const struct app_file file = file_of(&m->maps);
    status = app_start(&out->app, &file, start, true, s->log);
    if (!status && start->pass != RELUME_PASS_COLOUR)
        status = say(s->log, RELUME_EUNFIT, "--pass: of maps the colour alone is shown");
    document_set_path(&out->document, path);
    document_describe_edits(&out->document, edits);
    relume_edits_destroy(&edits);
    return status;
}

static relume_status make_maps(struct session *s)
{
    const relume_status status = session_make_bare(s);
    if (!status)
        use_painter(s);
    return status;
}

static void close_maps(struct document *d)
{
    struct edited_maps *m = d->own;
    if (m)
        relume_maps_destroy(&m->maps);
    free(m);
}

const struct document_kind document_maps = {
    .is = is_maps,
    .open = open_maps,
    .make = make_maps,
    .describe = describe_maps,
    .can_edit = can_edit_maps,
    .edit = edit_maps,
    .close = close_maps,
    .has_maps = true,
};

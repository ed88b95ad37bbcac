// document_maps.c - folders of maps (relume/material/maps.h): shown under the lights as they are
// edited, by the library
#include "session/session.h"

#include "app/light_list.h"
#include "cli/program/say.h"

#include <relume/material/edit.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

bool session_is_maps(const char *path)
{
    char name[APP_SPEC + 16];
    snprintf(name, sizeof name, "%s/maps.json", path);
    return !access(name, R_OK);
}

// ---------------------------------------------------------------- lights

static relume_status add_light(struct relume_image *sum, const struct session *s,
                               struct relume_vec3 direction, const float rgb[3])
{
    struct relume_image lit;
    const relume_status status = relume_maps_relight(&lit, &s->found, direction, s->threads);
    if (status)
        return status;
    const size_t n = 3 * (size_t)lit.width * (size_t)lit.height;
    for (size_t i = 0; i < n; i++)
        sum->data[i] += rgb[i % 3] * lit.data[i];
    relume_image_destroy(&lit);
    return RELUME_OK;
}

static relume_status paint(struct relume_image *out, void *user, const struct relume_light *lights,
                           int n)
{
    enum { OF_SKY = 48 };  // directional lights that stand for an environment
    const struct session *s = user;
    struct relume_light sky[OF_SKY];
    relume_status status = relume_image_create(out, s->found.width, s->found.height, 3);
    for (int i = 0; i < n && !status; i++) {
        const bool environment = lights[i].kind == RELUME_LIGHT_ENVIRONMENT;
        const struct relume_light *from = environment ? sky : &lights[i];
        if (environment)
            status = relume_environment_sample(sky, OF_SKY, &lights[i], 0);
        for (int k = 0; k < (environment ? OF_SKY : 1) && !status; k++)
            status = add_light(out, s, from[k].direction, from[k].rgb);
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

static void describe(struct session *s, const relume_edits *edits)
{
    snprintf(s->line[0], SESSION_TEXT, "maps, %d x %d", s->found.width, s->found.height);
    snprintf(s->line[1], SESSION_TEXT, "%d light%s were fitted, %d material%s", s->found.lights,
             relume_plural(s->found.lights), s->found.materials, relume_plural(s->found.materials));
    s->lines[0] = s->line[0];
    s->lines[1] = s->line[1];
    s->lines[2] = NULL;
    session_describe_edits(s, edits);
}

// The maps of a folder with the edits that are kept with it, changed as `words` say (NULL: not).
static relume_status open_edited(struct relume_maps *out, relume_edits **edits,
                                 const struct session *s, const char *path, char *words,
                                 const struct relume_log *log)
{
    *edits = NULL;
    relume_status status = relume_maps_open(out, path, log);
    if (!status)
        status = relume_edits_open(edits, path, relume_maps_fingerprint(out), log);
    if (!status && words)
        status = session_change_edits(*edits, words, log);
    if (!status)
        status = relume_maps_edit(out, *edits, s->threads, log);
    if (status) {
        relume_maps_destroy(out);
        relume_edits_destroy(edits);
    }
    return status;
}

relume_status session_edit_maps(struct session *s, const char *words, const struct relume_log *log)
{
    char copy[APP_SPEC];
    struct relume_maps maps;
    relume_edits *edits;
    snprintf(copy, sizeof copy, "%s", words);
    if (!strncmp(copy, "write ", 6))
        return relume_maps_write(&s->found, session_unquote(copy + 6),
                                 relume_maps_write_params(.log = log, .threads = s->threads,
                                                          .directx = s->found.directx));
    relume_status status = open_edited(&maps, &edits, s, s->found_path, copy, log);
    if (status)
        return status;
    status = relume_edits_save(edits, s->found_path, log);
    if (!status) {
        relume_maps_destroy(&s->found);
        s->found = maps;
        describe(s, edits);
        gl_renderer_use_painter(&s->renderer, &(struct view_painter){s, paint});
    } else {
        relume_maps_destroy(&maps);
    }
    relume_edits_destroy(&edits);
    return status;
}

// ---------------------------------------------------------------- opening

relume_status session_open_maps(struct session *s, const char *path, const struct app_state *start)
{
    struct relume_maps maps;
    relume_edits *edits;
    struct app app;
    relume_status status = check_lights(start, s->log);
    if (!status)
        status = open_edited(&maps, &edits, s, path, NULL, s->log);
    if (status)
        return status;
    const double high = (double)maps.height / maps.width;
    const struct app_file file = {
        .geometry = {.projection = RELUME_PLANAR,
                     .camera_z = 4,
                     .window_min = {-1, -high},
                     .window_max = {1, high}},
        .width = maps.width,
        .height = maps.height,
        .views = 1,
        .only_colour = true,
    };
    status = app_start(&app, &file, start, true, s->log);
    if (!status && start->pass != RELUME_PASS_COLOUR)
        status = say(s->log, RELUME_EUNFIT, "--pass: of maps the colour alone is shown");
    if (status) {
        app_release(&app);
        relume_maps_destroy(&maps);
    } else {
        session_close_file(s);
        app_release(&s->app);
        s->app = app;
        s->found = maps;
        snprintf(s->found_path, sizeof s->found_path, "%s", path);
        session_set_name(s, path);
        describe(s, edits);
    }
    relume_edits_destroy(&edits);
    return status;
}

relume_status session_make_maps(struct session *s)
{
    const struct code_source nothing = {.user = NULL};
    const relume_status status =
        gl_renderer_create(&s->renderer, &s->gl, &nothing, &s->app.file.geometry, NULL, 1, s->log);
    if (!status)
        gl_renderer_use_painter(&s->renderer, &(struct view_painter){s, paint});
    return status;
}

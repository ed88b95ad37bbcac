// session_facts.c - facts that the panel shows: histogram, inspector, maps to choose from
#include "session/session.h"

#include "app/handles.h"
#include "cli/program/output_name.h"

#include <relume/relight/tone.h>

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static void count_histogram(float histogram[256][3], const struct gl_renderer *renderer,
                            const struct app_state *now)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    const struct relume_tone_params tone = {.tone = relume_tones[now->tone], .white = now->white};
    struct relume_image frame;
    memset(histogram, 0, 256 * sizeof *histogram);
    if (gl_renderer_read(&frame, renderer))
        return;
    if (relume_tone_apply(&frame, &tone)) {
        relume_image_destroy(&frame);
        return;
    }
    const size_t samples = 3 * (size_t)frame.width * (size_t)frame.height;
    for (size_t i = 0; i < samples; i++) {
        const float code = relume_transfer_encode(srgb, frame.data[i]);
        histogram[(int)fminf(fmaxf(255 * code + 0.5f, 0), 255)][i % 3] += 1;
    }
    relume_image_destroy(&frame);
    // As high as the logarithm of a count in the most frequent one's.
    float most = 1;
    for (int i = 0; i < 3 * 256; i++)
        most = fmaxf(most, histogram[i / 3][i % 3]);
    for (int i = 0; i < 3 * 256; i++)
        histogram[i / 3][i % 3] = log1pf(histogram[i / 3][i % 3]) / log1pf(most);
}

static const char *file_name(const char *path)
{
    return path ? path_name(path) : NULL;
}

static relume_status inspect_pixel(struct session *s, bool *shown)
{
    relume_status status = RELUME_OK;
    const struct code_source source = pack_source_codes(s->document.source);
    if (!s->panel.inspector.weights)
        status = inspect_create(&s->panel.inspector, relume_pack_info(s->document.pack), &source,
                                s->renderer.views.grid, s->capture);
    if (!status)
        status = inspect_update(&s->panel.inspector, &s->app, shown);
    if (!status && *shown)
        draw_panel_plot(&s->panel.drawing, &s->window.gl, &s->panel.inspector.plot);
    return status;
}

// Those beside the map in use, else in the working folder.
static relume_status list_maps(struct session *s)
{
    environment_list_destroy(&s->panel.maps);
    if (!panel_wants_maps(s->panel.panel))
        return RELUME_OK;
    const char *in_use = session_map_in_use(s), *slash = in_use ? strrchr(in_use, '/') : NULL;
    char folder[PATH_MAX];
    snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - in_use) : 1,
             slash ? in_use : ".");
    return environment_list_read(&s->panel.maps, folder);
}

relume_status session_browse(struct session *s, const char *folder)
{
    char path[APP_SPEC];
    const char *from = folder[0]                    ? folder
                       : s->panel.browser.folder[0] ? s->panel.browser.folder
                                                    : s->document.folder;
    snprintf(path, sizeof path, "%s", from[0] ? from : ".");
    return browse_list(&s->panel.browser, path);
}

static const char *describe_eye(char *text, size_t size, const struct glare *glare)
{
    if (!glare->eye)
        return NULL;
    const struct relume_eye_state *eye = relume_eye_state(glare->eye);
    if (glare->loop.cycle)
        snprintf(text, size, "field %.3g cd/m2\na loop of %.3g s, by the library", eye->luminance,
                 glare->loop.seconds);
    else
        snprintf(text, size, "pupil %.2f mm, field %.3g cd/m2\n%.1f s, by %s", eye->pupil_mm,
                 eye->luminance, eye->time_s, glare->by_gpu ? "passes" : "the library");
    return text;
}

// Only those who see the panel need to know.
static void warn_font(struct session_panel *p, const struct relume_log *log)
{
    char text[PATH_MAX + 160];
    if (p->font_warned || panel_has_font(p->panel))
        return;
    p->font_warned = true;
    snprintf(text, sizeof text,
             "%s: the panel needs this TrueType font (package fonts-dejavu-core); it is drawn with "
             "a built-in one without accents",
             p->font);
    log->message(log->user, RELUME_WARNING, text);
}

static void measure_materials(struct session *s)
{
    const struct objects_drawer *drawer = &s->renderer.objects.drawer;
    for (int i = 0; drawer->gl && i < relume_objects_info(s->objects.objects)->materials &&
                    i < OBJECT_MATERIALS;
         i++)
        s->panel.material_bytes[i] = objects_drawer_bytes(drawer, i);
}

relume_status session_build_panel(struct session *s, bool histogram)
{
    const struct document *d = &s->document;
    const struct session_panel *p = &s->panel;
    const char *line[DOCUMENT_LINES + 1] = {NULL};
    char eye[160], reflections[APP_SPEC];
    for (int i = 0; i < d->lines; i++)
        line[i] = d->line[i];
    warn_font(&s->panel, s->log);
    session_name_reflections(reflections, s);
    bool plot = false;
    relume_status status = s->app.inspect && s->document.pack ? inspect_pixel(s, &plot) : RELUME_OK;
    if (!status)
        status = list_maps(s);
    measure_materials(s);
    session_describe_ways(s);
    const struct panel_facts facts = {
        .file = d->name,
        .line = line,
        .message = s->messages.last,
        .histogram = histogram ? (const float(*)[3])p->histogram : NULL,
        .plot = plot ? &p->inspector.plot : NULL,
        .plot_text = p->inspector.text,
        .map_folder = p->maps.folder,
        .map = (const char *const *)p->maps.name,
        .map_in_use = file_name(session_map_in_use(s)),
        .material_bytes = s->objects.objects ? p->material_bytes : NULL,
        .materials = OBJECT_MATERIALS,
        .objects_ms = s->renderer.objects.ms,
        .range = {s->renderer.enhancer.range.low, s->renderer.enhancer.range.high},
        .browser = p->browser.folder[0] ? &p->browser : NULL,
        .recording = session_records(s) ? s->recording.path : NULL,
        .recorded_s = (double)s->recording.frame / RECORD_RATE,
        .round_s = (double)s->recording.frames / RECORD_RATE,
        .reflections =
            s->app.file.objects && handles_mirror(s->app.file.objects) ? reflections : NULL,
        .ways = {p->way[0], p->way[1]},
        .edits_maps = d->kind->has_maps,
        .edits = session_can_edit(s) ? d->edits : NULL,
        .edited_materials = d->edited_materials,
        .eye = describe_eye(eye, sizeof eye, &s->renderer.glare),
    };
    if (!status)
        (void)panel_build(s->panel.panel, &s->app, &facts);
    return status;
}

// Once more, with what comes from the frame that has just been drawn: its histogram, its range.
relume_status session_add_histogram(struct session *s)
{
    const bool histogram = panel_wants_histogram(s->panel.panel);
    if (!panel_shown(&s->app) || !(histogram || s->app.now.pass == RELUME_PASS_FALSE_COLOUR))
        return RELUME_OK;
    if (histogram)
        count_histogram(s->panel.histogram, &s->renderer, &s->app.now);
    return session_build_panel(s, histogram);
}

// session_panel.c - what the panel shows: histogram, inspector, maps to choose from
#include "session/session.h"

#include "app/handles.h"

#include <relume/relight/tone.h>

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static void count_histogram(struct session *s)
{
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    const struct relume_tone_params tone = {.tone = relume_tones[s->app.now.tone],
                                            .white = s->app.now.white};
    struct relume_image frame;
    memset(s->histogram, 0, sizeof s->histogram);
    if (gl_renderer_read(&frame, &s->renderer))
        return;
    if (relume_tone_apply(&frame, &tone)) {
        relume_image_destroy(&frame);
        return;
    }
    const size_t samples = 3 * (size_t)frame.width * (size_t)frame.height;
    for (size_t i = 0; i < samples; i++) {
        const float code = relume_transfer_encode(srgb, frame.data[i]);
        s->histogram[(int)fminf(fmaxf(255 * code + 0.5f, 0), 255)][i % 3] += 1;
    }
    relume_image_destroy(&frame);
    // As high as the logarithm of a count in the most frequent one's.
    float most = 1;
    for (int i = 0; i < 3 * 256; i++)
        most = fmaxf(most, s->histogram[i / 3][i % 3]);
    for (int i = 0; i < 3 * 256; i++)
        s->histogram[i / 3][i % 3] = log1pf(s->histogram[i / 3][i % 3]) / log1pf(most);
}

static const char *file_name(const char *path)
{
    const char *slash = path ? strrchr(path, '/') : NULL;
    return slash ? slash + 1 : path;
}

static relume_status inspect(struct session *s, bool *shown)
{
    relume_status status = RELUME_OK;
    const struct code_source source = pack_source_codes(s->source);
    if (!s->inspector.weights)
        status = inspect_create(&s->inspector, relume_pack_info(s->pack), &source, s->renderer.grid,
                                s->capture);
    if (!status)
        status = inspect_update(&s->inspector, &s->app, shown);
    if (!status && *shown)
        draw_panel_plot(&s->drawing, &s->gl, &s->inspector.plot);
    return status;
}

// Those beside the map in use, else in the working folder.
static relume_status list_maps(struct session *s)
{
    maps_destroy(&s->maps);
    if (!panel_wants_maps(s->panel))
        return RELUME_OK;
    const char *in_use = session_map_in_use(s), *slash = in_use ? strrchr(in_use, '/') : NULL;
    char folder[PATH_MAX];
    snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - in_use) : 1,
             slash ? in_use : ".");
    return maps_list(&s->maps, folder);
}

relume_status session_browse(struct session *s, const char *folder)
{
    char path[APP_SPEC];
    const char *from = folder[0] ? folder : s->browser.folder[0] ? s->browser.folder : s->folder;
    snprintf(path, sizeof path, "%s", from[0] ? from : ".");
    return browse_list(&s->browser, path);
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
                 eye->luminance, eye->time_s, glare->passes ? "passes" : "the library");
    return text;
}

// Only those who see the panel need to know.
static void warn_font(struct session *s)
{
    char text[PATH_MAX + 160];
    if (s->font_warned || panel_has_font(s->panel))
        return;
    s->font_warned = true;
    snprintf(text, sizeof text,
             "%s: the panel needs this TrueType font (package fonts-dejavu-core); it is drawn with "
             "a built-in one without accents",
             s->font);
    s->log->message(s->log->user, RELUME_WARNING, text);
}

relume_status session_build_panel(struct session *s, bool histogram)
{
    char eye[160], reflections[APP_SPEC];
    warn_font(s);
    session_name_reflections(reflections, s);
    bool plot = false;
    relume_status status = s->app.inspect && s->pack ? inspect(s, &plot) : RELUME_OK;
    if (!status)
        status = list_maps(s);
    for (int i = 0; s->renderer.drawer.gl && i < relume_objects_info(s->objects)->materials &&
                    i < SESSION_MATERIALS;
         i++)
        s->material_bytes[i] = objects_drawer_bytes(&s->renderer.drawer, i);
    session_describe_ways(s);
    const struct panel_facts facts = {
        .file = s->name,
        .line = s->lines,
        .message = s->message,
        .histogram = histogram ? (const float(*)[3])s->histogram : NULL,
        .plot = plot ? &s->inspector.plot : NULL,
        .plot_text = s->inspector.text,
        .map_folder = s->maps.folder,
        .map = (const char *const *)s->maps.name,
        .map_in_use = file_name(session_map_in_use(s)),
        .material_bytes = s->objects ? s->material_bytes : NULL,
        .materials = SESSION_MATERIALS,
        .objects_ms = s->renderer.objects_drawer_ms,
        .range = {s->renderer.enhancer.range.low, s->renderer.enhancer.range.high},
        .browser = s->browser.folder[0] ? &s->browser : NULL,
        .recording = session_records(s) ? s->recording.path : NULL,
        .recorded_s = (double)s->recording.frame / RECORD_RATE,
        .round_s = (double)s->recording.frames / RECORD_RATE,
        .reflections =
            s->app.file.objects && handles_mirror(s->app.file.objects) ? reflections : NULL,
        .ways = {s->way[0], s->way[1]},
        .edits_maps = s->found.width > 0,
        .edits = session_can_edit(s) ? s->edits : NULL,
        .edited_materials = s->edited_materials,
        .eye = describe_eye(eye, sizeof eye, &s->renderer.glare),
    };
    if (!status)
        (void)panel_build(s->panel, &s->app, &facts);
    return status;
}

// Once more, with what comes from the frame that has just been drawn: its histogram, its range.
relume_status session_add_histogram(struct session *s)
{
    const bool histogram = panel_wants_histogram(s->panel);
    if (!panel_shown(&s->app) || !(histogram || s->app.now.pass == RELUME_PASS_FALSE_COLOUR))
        return RELUME_OK;
    if (histogram)
        count_histogram(s);
    return session_build_panel(s, histogram);
}

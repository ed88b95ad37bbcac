// panel_picture.cpp - the panel's parts about the picture: exposure, views, glare, objects,
// histogram
#include "panel/panel_parts.h"

extern "C" {
#include "world/object/drawn_objects.h"
}

#include <relume/relight/tone.h>

#include <cstdio>

// The difference comes last, and needs photographs.
static_assert(RELUME_PASS_DIFFERENCE == RELUME_PASSES - 1, "views are counted");
static bool choose_pass(app *app)
{
    int pass = app->now.pass;
    const bool changed = panel_choice(
        "pass", &pass, app_passes(app), [](int i) { return relume_pass_name((relume_pass)i); },
        "what is shown (rendering mode): colours, normals, enhanced detail, ...; also by V");
    app->now.pass = (relume_pass)pass;
    return changed;
}

static int count_tones()
{
    int n = 0;
    while (relume_tones[n])
        n++;
    return n;
}

bool panel_picture(app *app, const panel_facts *facts)
{
    bool changed = panel_slider("exposure", &app->now.exposure_ev, -10, 10, "%+.2f EV",
                                "brightness of the picture: +1 EV doubles it; also by + and -");
    bool automatic = app->now.auto_exposure;
    if (panel_box("automatic exposure", &automatic,
                  "set the exposure by itself, as an eye adapts to what it sees"))
        changed |= keys_press(app, 'e', false);
    changed |= panel_choice(
        "tone", &app->now.tone, count_tones(), [](int i) { return relume_tones[i]->name; },
        "how bright light is fitted to the range of the screen");
    changed |= choose_pass(app);
    changed |= panel_enhancement(app, facts);
    changed |=
        panel_box("ball", &app->now.ball, "a ball in the corner shows the light: drag on it");
    ImGui::SameLine();
    changed |= panel_box("handles", &app->gizmos,
                         "marks of the lights in the picture: drag them to move a light");
    ImGui::SameLine();
    changed |= panel_box("inspector", &app->inspect,
                         "the reflectance of the pixel under the pointer, in every direction");
    static const struct {
        const char *name;
        app_action action;
        const char *what;
    } actions[] = {
        {"PNG", APP_ACTION_PNG, "save the picture as it is shown"},
        {"EXR", APP_ACTION_EXR, "save the picture in linear light"},
        {"sweep", APP_ACTION_SWEEP, "record the light going once around"},
        {"turntable", APP_ACTION_TURNTABLE, "record the eye going once around"},
    };
    for (const auto &w : actions) {
        if (panel_button(w.name, w.what))
            app->action = w.action;
        ImGui::SameLine();
    }
    if (panel_button("reset", "set viewpoint, lights and picture back to the start")) {
        app_reset(app);
        changed = true;
    }
    return changed;
}

static bool parts_row(observer *s)
{
    bool changed = false;
    for (const observer_part *p = observer_parts; p->name; p++) {
        bool on = !(s->parts_off & p->part);
        if (p != observer_parts && p != observer_parts + 3)
            ImGui::SameLine();
        if (panel_box(p->name, &on, p->what)) {
            s->parts_off ^= p->part;
            changed = true;
        }
    }
    return changed;
}

bool panel_glare(app *app, const panel_facts *facts)
{
    observer *s = &app->now.observer;
    double magnify = observer_magnify(s), nits = observer_nits(s);
    int mode = s->mode;
    bool changed = panel_box("glare", &s->on,
                             "the picture as a human eye sees it, with halos around lights; H");
    ImGui::SameLine();
    changed |= panel_box("paused", &s->paused, "the eye's time stands still");
    ImGui::SameLine();
    changed |= panel_box("sources", &s->sources, "lights in view are drawn as small bright points");
    if (panel_slider("magnify", &magnify, 0.1, 20, "%.2f", "size of the halos: 1 is true to scale",
                     ImGuiSliderFlags_Logarithmic)) {
        s->magnify = magnify;
        changed = true;
    }
    if (panel_slider("cd/m2", &nits, 1e-2, 1e5, "%.3g",
                     "luminance of a pixel of value 1: the pupil adapts to it",
                     ImGuiSliderFlags_Logarithmic)) {
        s->nits = nits;
        changed = true;
    }
    changed |= panel_slider("squint", &s->squint, 0, 0.95, "%.2f",
                            "how far the lids are closed: 0 is open");
    bool loop = s->cycle_s > 0;
    if (panel_box("loop of 4 s", &loop, "computed once, then repeated: fast")) {
        s->cycle_s = loop ? 4 : 0;
        changed = true;
    }
    changed |= panel_choice(
        "mode", &mode, OBSERVER_MODES, [](int i) { return observer_mode_name((observer_mode)i); },
        "how light scatters: of every pixel (fft), of bright spots only (billboard), or both "
        "(hybrid)");
    s->mode = (observer_mode)mode;
    changed |= parts_row(s);
    if (facts->eye)
        ImGui::TextUnformatted(facts->eye);
    return changed;
}

static bool choose_material(const char *label, const struct relume_objects_info *info,
                            int *material)
{
    std::string text;
    return panel_choice(
        label, material, info->materials,
        [&](int i) {
            text = std::string(info->material[i].name) + " (" + info->material[i].model + ")";
            return text.c_str();
        },
        "the material that covers it");
}

// What a material takes on disk and of graphics memory, and the time of its last frame.
static void material_cost(const struct relume_objects_info *info, const panel_facts *facts,
                          int material, double ms)
{
    const size_t bytes = material < facts->materials ? facts->material_bytes[material] : 0;
    ImGui::Text("%s: %.2f MB, as drawn %.2f", info->material[material].model,
                (double)info->material[material].bytes * 1e-6, (double)bytes * 1e-6);
    ImGui::Text("  %.1f ms a frame", ms);
}

bool panel_objects(app *app, const panel_facts *facts)
{
    static const char *const splits[APP_SPLITS] = {"one", "side by side", "difference"};
    const struct relume_objects_info *info = relume_objects_info(app->file.objects);
    bool changed = false;
    for (int i = 0; i < info->parts; i++) {
        int material = info->part[i].material;
        ImGui::PushID(i);
        if (choose_material(info->part[i].name, info, &material)) {
            way_let_go(app);
            (void)!relume_objects_choose(app->file.objects, i, material);
            changed = true;
        }
        ImGui::PopID();
    }
    for (int i = 0; i < APP_SPLITS; i++) {
        if (i)
            ImGui::SameLine();
        const bool chosen = ImGui::RadioButton(splits[i], app->now.split == i);
        panel_tip("compare two materials of the first part; also by Q");
        while (chosen && app->now.split != i)
            changed |= keys_press(app, 'q', false);
    }
    if (app->now.split != APP_SPLIT_NONE)
        changed |= choose_material("other", info, &app->now.other);
    if (!facts->material_bytes)
        return changed;
    material_cost(info, facts, info->part[0].material, facts->objects_ms[0]);
    if (app->now.split != APP_SPLIT_NONE)
        material_cost(info, facts, app->now.other, facts->objects_ms[1]);
    return changed;
}

bool panel_ways(app *app, const panel_facts *facts)
{
    static const char *const splits[APP_SPLITS] = {"one", "side by side", "difference"};
    const auto name = [](int i) { return way_name(i); };
    bool changed = panel_choice("way", &app->now.way, way_count(), name,
                                "how light goes between the objects and the scene; also by Ctrl+T");
    for (int i = 0; i < APP_SPLITS; i++) {
        if (i)
            ImGui::SameLine();
        const bool chosen = ImGui::RadioButton(splits[i], app->now.ways == i);
        panel_tip("compare two ways; also by Ctrl+D");
        if (chosen && app->now.ways != i) {
            way_compare(app, (app_split)i);
            changed = true;
        }
    }
    if (app->now.ways != APP_SPLIT_NONE)
        changed |= panel_choice("other", &app->now.other_way, way_count(), name,
                                "the way that it is compared with");
    for (const char *state : facts->ways)
        if (state && state[0])
            ImGui::TextWrapped("%s", state);
    return changed;
}

void panel_histogram(const panel_facts *facts, float scale)
{
    const ImVec2 size(ImGui::GetContentRegionAvail().x, 80 * scale);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImDrawList *draw = ImGui::GetWindowDrawList();
    ImGui::Dummy(size);
    draw->AddRectFilled(corner, ImVec2(corner.x + size.x, corner.y + size.y),
                        IM_COL32(20, 20, 22, 255));
    if (!facts->histogram)
        return;
    static const ImU32 colours[3] = {IM_COL32(255, 70, 70, 200), IM_COL32(80, 220, 80, 200),
                                     IM_COL32(90, 130, 255, 200)};
    for (int c = 0; c < 3; c++) {
        ImVec2 line[256];
        for (int i = 0; i < 256; i++) {
            const float part = facts->histogram[i][c];
            line[i] =
                ImVec2(corner.x + size.x * ((float)i + 0.5f) / 256, corner.y + size.y * (1 - part));
        }
        draw->AddPolyline(line, 256, colours[c], 0, 1);
    }
}

void panel_file(app *app, const panel_facts *facts)
{
    ImGui::TextUnformatted(facts->file ? facts->file : "");
    for (const char *const *line = facts->line; line && *line; line++)
        ImGui::TextUnformatted(*line);
    if (panel_button("open another file",
                     "choose one from a list; also by Ctrl+O, or drop it here"))
        (void)keys_press(app, APP_CONTROL | 'o', false);
    (void)panel_box("keep these lights for it", &app->keep_lights,
                    "otherwise the next file begins with one light from the front");
}

// panel_picture.cpp - the panel's parts about the picture: exposure, views, glare, objects,
// histogram
#include "panel/panel_parts.h"

#include <relume/tone.h>

#include <cstdio>

static bool choose_pass(app *app)
{
    bool changed = false;
    if (!ImGui::BeginCombo("view", relume_pass_name(app->now.pass)))
        return false;
    for (int i = 0; i < RELUME_PASSES; i++) {
        if (i == RELUME_PASS_DIFFERENCE && !app->compared)
            continue;
        if (ImGui::Selectable(relume_pass_name((relume_pass)i), app->now.pass == i)) {
            app->now.pass = (relume_pass)i;
            changed = true;
        }
    }
    ImGui::EndCombo();
    return changed;
}

static bool choose_tone(app *app)
{
    bool changed = false;
    if (!ImGui::BeginCombo("tone", relume_tones[app->now.tone]->name))
        return false;
    for (int i = 0; relume_tones[i]; i++)
        if (ImGui::Selectable(relume_tones[i]->name, app->now.tone == i)) {
            app->now.tone = i;
            changed = true;
        }
    ImGui::EndCombo();
    return changed;
}

bool panel_picture(app *app, const panel_facts *facts)
{
    const double least = -10, most = 10;
    bool changed = ImGui::SliderScalar("exposure", ImGuiDataType_Double, &app->now.exposure_ev,
                                       &least, &most, "%+.2f EV");
    panel_tip("brightness of the picture: +1 EV doubles it; also by + and -");
    bool automatic = app->now.auto_exposure;
    if (ImGui::Checkbox("automatic exposure", &automatic))
        changed |= keys_press(app, 'e', false);
    panel_tip("as an eye adapts to what it sees");
    changed |= choose_tone(app);
    changed |= choose_pass(app);
    changed |= panel_enhancement(app, facts);
    changed |= ImGui::Checkbox("ball", &app->now.ball);
    ImGui::SameLine();
    changed |= ImGui::Checkbox("handles", &app->gizmos);
    ImGui::SameLine();
    changed |= ImGui::Checkbox("inspector", &app->inspect);
    static const struct {
        const char *name;
        app_wish wish;
        const char *what;
    } wishes[] = {
        {"PNG", APP_WISH_PNG, "save the picture as it is shown"},
        {"EXR", APP_WISH_EXR, "save the picture in linear light"},
        {"sweep", APP_WISH_SWEEP, "record the light going once around"},
        {"turntable", APP_WISH_TURNTABLE, "record the eye going once around"},
    };
    for (const auto &w : wishes) {
        if (ImGui::Button(w.name))
            app->wish = w.wish;
        panel_tip(w.what);
        ImGui::SameLine();
    }
    if (ImGui::Button("reset")) {
        app_reset(app);
        changed = true;
    }
    panel_tip("eye, lights and picture as they were at the start");
    return changed;
}

static bool choose_mode(observer *s)
{
    bool changed = false;
    if (!ImGui::BeginCombo("mode", observer_mode_name(s->mode)))
        return false;
    for (int i = 0; i < OBSERVER_MODES; i++)
        if (ImGui::Selectable(observer_mode_name((observer_mode)i), s->mode == i)) {
            s->mode = (observer_mode)i;
            changed = true;
        }
    ImGui::EndCombo();
    return changed;
}

static bool parts_row(observer *s)
{
    bool changed = false;
    for (const observer_part *p = observer_parts; p->name; p++) {
        bool on = !(s->parts_off & p->part);
        if (p != observer_parts && p != observer_parts + 3)
            ImGui::SameLine();
        if (ImGui::Checkbox(p->name, &on)) {
            s->parts_off ^= p->part;
            changed = true;
        }
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip("%s", p->what);
    }
    return changed;
}

bool panel_glare(app *app, const panel_facts *facts)
{
    observer *s = &app->now.observer;
    const double least[] = {0.1, 1e-2, 0}, most[] = {20, 1e5, 0.95};
    double magnify = observer_magnify(s), nits = observer_nits(s);
    bool changed = false;
    if (ImGui::Checkbox("glare", &s->on))
        changed = true;
    ImGui::SameLine();
    changed |= ImGui::Checkbox("paused", &s->paused);
    ImGui::SameLine();
    changed |= ImGui::Checkbox("sources", &s->sources);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("lights in view are drawn as small bright points");
    if (ImGui::SliderScalar("magnify", ImGuiDataType_Double, &magnify, &least[0], &most[0], "%.2f",
                            ImGuiSliderFlags_Logarithmic)) {
        s->magnify = magnify;
        changed = true;
    }
    if (ImGui::SliderScalar("cd/m2", ImGuiDataType_Double, &nits, &least[1], &most[1], "%.3g",
                            ImGuiSliderFlags_Logarithmic)) {
        s->nits = nits;
        changed = true;
    }
    changed |= ImGui::SliderScalar("squint", ImGuiDataType_Double, &s->squint, &least[2], &most[2],
                                   "%.2f");
    bool loop = s->cycle_s > 0;
    if (ImGui::Checkbox("loop of 4 s", &loop)) {
        s->cycle_s = loop ? 4 : 0;
        changed = true;
    }
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("computed once, then repeated: fast");
    changed |= choose_mode(s);
    changed |= parts_row(s);
    if (facts->eye)
        ImGui::TextUnformatted(facts->eye);
    return changed;
}

static bool choose_material(const char *label, const struct relume_objects_info *info,
                            int *material)
{
    char text[128];
    bool changed = false;
    std::snprintf(text, sizeof text, "%s (%s)", info->material[*material].name,
                  info->material[*material].model);
    if (!ImGui::BeginCombo(label, text))
        return false;
    for (int i = 0; i < info->materials; i++) {
        std::snprintf(text, sizeof text, "%s (%s)##%d", info->material[i].name,
                      info->material[i].model, i);
        if (ImGui::Selectable(text, i == *material)) {
            *material = i;
            changed = true;
        }
    }
    ImGui::EndCombo();
    return changed;
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
            (void)!relume_objects_choose(app->file.objects, i, material);
            changed = true;
        }
        ImGui::PopID();
    }
    for (int i = 0; i < APP_SPLITS; i++) {
        if (i)
            ImGui::SameLine();
        const bool chosen = ImGui::RadioButton(splits[i], app->now.split == i);
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
    if (ImGui::Button("open another file"))
        (void)keys_press(app, APP_CONTROL | 'o', false);
    ImGui::Checkbox("keep these lights for it", &app->keep_lights);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("otherwise the next file begins with one light from the front");
}

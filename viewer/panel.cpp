// panel.cpp - the only file that knows Dear ImGui
#include "panel.h"

extern "C" {
#include "gizmo.h"
#include "keys.h"
#include "lamps.h"
}

#include <relume/tone.h>

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <new>
#include <vector>

static const float width_units = 290;  // of the panel
static const float ball_units = 120;

struct panel {
    ImGuiContext *context;
    float scale;
    std::vector<app_event> queue;
    bool held;         // a press belongs to the panel
    bool held_by_app;  // or to the app
    bool histogram;    // is open
    bool maps;         // the list of environment maps is open
    bool changed;      // the picture, by what the user did in this frame
    char spec[APP_SPEC];
    char environment[APP_SPEC];
    std::vector<panel_run> runs;
    int listed;  // the light that the list has scrolled to
};

// ---------------------------------------------------------------- making

static void map_keys(ImGuiIO &io)
{
    io.KeyMap[ImGuiKey_Tab] = APP_KEY_TAB;
    io.KeyMap[ImGuiKey_Backspace] = APP_KEY_BACKSPACE;
    io.KeyMap[ImGuiKey_Delete] = APP_KEY_DELETE;
    io.KeyMap[ImGuiKey_Enter] = APP_KEY_ENTER;
    io.KeyMap[ImGuiKey_Escape] = APP_KEY_ESCAPE;
    io.KeyMap[ImGuiKey_LeftArrow] = APP_KEY_LEFT;
    io.KeyMap[ImGuiKey_RightArrow] = APP_KEY_RIGHT;
    io.KeyMap[ImGuiKey_UpArrow] = APP_KEY_UP_ARROW;
    io.KeyMap[ImGuiKey_DownArrow] = APP_KEY_DOWN_ARROW;
    io.KeyMap[ImGuiKey_Home] = APP_KEY_HOME;
    io.KeyMap[ImGuiKey_End] = APP_KEY_END;
}

static void set_style(float scale)
{
    ImGuiStyle &style = ImGui::GetStyle();
    ImGui::StyleColorsDark();
    style.WindowRounding = 4;
    style.FrameRounding = 3;
    style.GrabRounding = 3;
    style.Colors[ImGuiCol_WindowBg].w = 0.88f;
    style.ScaleAllSizes(scale);
}

extern "C" relume_status panel_create(struct panel **out, double scale)
{
    *out = new (std::nothrow) panel();
    if (!*out)
        return RELUME_ENOMEM;
    panel *p = *out;
    p->scale = (float)std::clamp(scale, 1.0, 4.0);
    p->context = ImGui::CreateContext();
    ImGui::SetCurrentContext(p->context);
    ImGuiIO &io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.MousePos = ImVec2(-FLT_MAX, -FLT_MAX);
    ImFontConfig font;
    font.SizePixels = std::floor(13 * p->scale);
    io.Fonts->AddFontDefault(&font);
    map_keys(io);
    set_style(p->scale);
    (void)panel_font(p);
    return RELUME_OK;
}

extern "C" void panel_destroy(struct panel **panel)
{
    if (!*panel)
        return;
    ImGui::DestroyContext((*panel)->context);
    delete *panel;
    *panel = nullptr;
}

extern "C" struct panel_letters panel_font(const struct panel *panel)
{
    struct panel_letters letters = {};
    unsigned char *alpha = nullptr;
    ImGui::SetCurrentContext(panel->context);
    ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&alpha, &letters.width, &letters.height);
    ImGui::GetIO().Fonts->SetTexID((ImTextureID)(intptr_t)PANEL_LETTERS);
    letters.alpha = alpha;
    return letters;
}

// ---------------------------------------------------------------- events

static bool over_a_window(const panel *panel, double x, double y)
{
    for (const ImGuiWindow *w : panel->context->Windows)
        if (w->WasActive && !(w->Flags & ImGuiWindowFlags_NoMouseInputs) && !w->Hidden &&
            w->OuterRectClipped.Contains(ImVec2((float)x, (float)y)))
            return true;
    return false;
}

extern "C" bool panel_takes(struct panel *panel, const struct app_event *event)
{
    const bool typing = panel->context->IO.WantTextInput;
    bool takes = false;
    switch (event->kind) {
    case APP_PRESS:
        takes = !panel->held_by_app && (panel->held || over_a_window(panel, event->x, event->y));
        panel->held |= takes;
        panel->held_by_app |= !takes;
        break;
    case APP_RELEASE:
        takes = panel->held;
        panel->held = panel->held_by_app = false;
        break;
    case APP_MOVE:
        takes = panel->held;
        if (panel->held_by_app)
            return false;
        break;
    case APP_WHEEL: takes = over_a_window(panel, event->x, event->y); break;
    case APP_KEY_DOWN:
    case APP_TEXT: takes = typing; break;
    case APP_KEY_UP:
    case APP_SIZE: break;
    }
    if (takes || event->kind == APP_MOVE || event->kind == APP_KEY_UP)
        panel->queue.push_back(*event);
    return takes;
}

extern "C" bool panel_shown(const struct app *app)
{
    return app->panel || app->help || app->inspect || app->gizmos;
}

static void tell_imgui(const app_event &e)
{
    ImGuiIO &io = ImGui::GetIO();
    if (e.kind == APP_PRESS || e.kind == APP_RELEASE || e.kind == APP_MOVE || e.kind == APP_WHEEL)
        io.MousePos = ImVec2((float)e.x, (float)e.y);
    if (e.kind == APP_PRESS || e.kind == APP_RELEASE)
        io.MouseDown[e.button] = e.kind == APP_PRESS;
    if (e.kind == APP_WHEEL)
        io.MouseWheel += (float)e.wheel;
    if (e.kind == APP_TEXT)
        io.AddInputCharacter((unsigned)e.key);
    if ((e.kind == APP_KEY_DOWN || e.kind == APP_KEY_UP) && e.key < APP_KEYS)
        io.KeysDown[e.key] = e.kind == APP_KEY_DOWN;
}

// ---------------------------------------------------------------- lights

static ImVec4 colour_of(const relume_light &light)
{
    const float most = std::max({light.rgb[0], light.rgb[1], light.rgb[2], 1e-6f});
    return ImVec4(light.rgb[0] / most, light.rgb[1] / most, light.rgb[2] / most, 1);
}

static bool list_row(app_state *s, int i)
{
    bool changed = false;
    char label[64];
    ImGui::PushID(i);
    bool on = !s->lamp[i].off;
    if (ImGui::Checkbox("##on", &on)) {
        s->lamp[i].off = !on;
        changed = true;
    }
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("on");
    ImGui::SameLine();
    changed |= ImGui::Checkbox("##solo", &s->lamp[i].solo);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("solo: only lights so marked shine");
    ImGui::SameLine();
    ImGui::ColorButton("##colour", colour_of(s->light[i]), ImGuiColorEditFlags_NoTooltip);
    ImGui::SameLine();
    std::snprintf(label, sizeof label, "%d %s", i + 1, lamps_kind_words(s->light[i].kind));
    if (ImGui::Selectable(label, s->selected == i)) {
        s->selected = i;
        changed = true;
    }
    ImGui::PopID();
    return changed;
}

// A long list scrolls, to the selected light when that is another one.
const int rows_most = 8;
static bool list_lights(panel *panel, app_state *s)
{
    bool changed = false;
    if (s->lights <= rows_most) {
        for (int i = 0; i < s->lights; i++)
            changed |= list_row(s, i);
        return changed;
    }
    const float row = ImGui::GetFrameHeightWithSpacing();
    ImGui::BeginChild("##list", ImVec2(0, rows_most * row));
    if (panel->listed != s->selected)
        ImGui::SetScrollY((float)(s->selected - rows_most / 2) * row);
    panel->listed = s->selected;
    ImGuiListClipper clipper;
    clipper.Begin(s->lights, row);
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; i++)
            changed |= list_row(s, i);
    ImGui::EndChild();
    return changed;
}

static ImU32 ball_colour(const relume_light &light, bool behind)
{
    ImVec4 c = colour_of(light);
    c.w = behind ? 0.35f : 1.0f;
    return ImGui::ColorConvertFloat4ToU32(c);
}

// A ball seen from the front: drag a direction to where the light shall come from.
static bool ball(app *app, float side)
{
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 middle(corner.x + 0.5f * side, corner.y + 0.5f * side);
    const float radius = 0.46f * side;
    app_state *s = &app->now;
    ImDrawList *draw = ImGui::GetWindowDrawList();
    ImGui::InvisibleButton("##ball", ImVec2(side, side));
    bool changed = false;
    if (ImGui::IsItemActive()) {
        const ImVec2 at = ImGui::GetIO().MousePos;
        app_point_light(app, s->selected, (at.x - middle.x) / radius, (middle.y - at.y) / radius);
        changed = true;
    }
    draw->AddCircleFilled(middle, radius, IM_COL32(60, 60, 66, 255), 48);
    draw->AddCircle(middle, radius * 0.7071f, IM_COL32(90, 90, 96, 255), 48);
    draw->AddCircle(middle, radius, IM_COL32(130, 130, 138, 255), 48);
    const int first = gizmo_first(app);
    for (int i = first; i < s->lights && i < first + GIZMOS; i++) {
        const relume_vec3 d = app_seen_light(app, i);
        const ImVec2 dot(middle.x + radius * (float)d.x, middle.y - radius * (float)d.y);
        draw->AddCircleFilled(dot, 0.045f * side, ball_colour(s->light[i], d.z < 0));
        if (i == s->selected)
            draw->AddCircle(dot, 0.065f * side, IM_COL32_WHITE, 0, 1.5f);
    }
    return changed;
}

static bool edit_vector(const char *label, relume_vec3 *v)
{
    double values[3] = {v->x, v->y, v->z};
    if (!ImGui::DragScalarN(label, ImGuiDataType_Double, values, 3, 0.01f, nullptr, nullptr,
                            "%.3f"))
        return false;
    if (!std::isfinite(values[0]) || !std::isfinite(values[1]) || !std::isfinite(values[2]))
        return false;
    *v = relume_vec3{values[0], values[1], values[2]};
    return true;
}

static bool flip_side(app *app)
{
    relume_vec3 d = app_seen_light(app, app->now.selected);
    bool behind = d.z < 0;
    if (!ImGui::Checkbox("from behind", &behind))
        return false;
    d.z = -d.z;
    app_aim_light(app, app->now.selected, d);
    return true;
}

// What a kind has beside a direction. A field that makes no light is put back.
static bool edit_geometry(relume_light *light)
{
    const relume_light was = *light;
    const double least = -180, most = 180, narrow = 0.5, wide = 89.5;
    const unsigned fields = lamps_fields(light->kind);
    bool changed = false;
    if (fields & LAMP_TURN)
        changed |= ImGui::SliderScalar("rotation", ImGuiDataType_Double, &light->rotate_deg, &least,
                                       &most, "%.1f deg");
    if (fields & LAMP_PLACE)
        changed |= edit_vector("position", &light->position);
    if (fields & LAMP_AXIS)
        changed |= edit_vector("axis", &light->direction);
    if (fields & LAMP_ANGLE)
        changed |= ImGui::SliderScalar("half angle", ImGuiDataType_Double, &light->half_angle_deg,
                                       &narrow, &wide, "%.1f deg");
    if (fields & LAMP_EDGES) {
        changed |= edit_vector("half edge u", &light->u);
        changed |= edit_vector("half edge v", &light->v);
    }
    if (changed && relume_light_check(light, "light", nullptr))
        *light = was;
    return changed;
}

// Kinds that need no file can become one another.
static bool choose_kind(app *app)
{
    static const relume_light_kind kinds[] = {RELUME_LIGHT_DIRECTIONAL, RELUME_LIGHT_POINT,
                                              RELUME_LIGHT_SPOT, RELUME_LIGHT_AREA};
    app_state *s = &app->now;
    const relume_light_kind now = s->light[s->selected].kind;
    bool changed = false;
    if (!app->near_lights || !(lamps_fields(now) & LAMP_CHANGE) ||
        !ImGui::BeginCombo("kind", lamps_kind_words(now)))
        return false;
    for (const relume_light_kind kind : kinds) {
        if (ImGui::Selectable(lamps_kind_words(kind), kind == now) && kind != now) {
            lamps_change_kind(s, s->selected, kind, app_middle(app), 1.5 * app_reach(app));
            changed = true;
        }
    }
    ImGui::EndCombo();
    return changed;
}

static bool edit_light(panel *panel, app *app)
{
    app_state *s = &app->now;
    relume_light *light = &s->light[s->selected];
    app_lamp *lamp = &s->lamp[s->selected];
    bool changed = ball(app, ball_units * panel->scale);
    ImGui::SameLine();
    ImGui::BeginGroup();
    ImGui::Text("light %d", s->selected + 1);
    ImGui::TextUnformatted(lamps_kind_words(light->kind));
    changed |= flip_side(app);
    changed |= ImGui::ColorEdit3("colour", light->rgb,
                                 ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_Float |
                                     ImGuiColorEditFlags_HDR);
    ImGui::EndGroup();
    const double least = -8, most = 8;
    changed |=
        ImGui::SliderScalar("stops", ImGuiDataType_Double, &lamp->stops, &least, &most, "%+.2f");
    changed |= choose_kind(app);
    return changed | edit_geometry(light);
}

static void wish_light(app *app, const char *spec)
{
    app->wish = APP_WISH_ADD_LIGHT;
    std::snprintf(app->spec, sizeof app->spec, "%s", spec);
}

static bool light_buttons(panel *panel, app *app)
{
    bool changed = false;
    if (ImGui::Button("add"))
        changed |= keys_press(app, 'm', false);
    ImGui::SameLine();
    if (ImGui::Button("remove"))
        changed |= keys_press(app, APP_KEY_DELETE, false);
    ImGui::SameLine();
    if (ImGui::Button("save rig"))
        app->wish = APP_WISH_SAVE_RIG;
    for (const lamp_preset *p = lamp_presets; p->name; p++) {
        if (p != lamp_presets)
            ImGui::SameLine();
        if (ImGui::Button(p->name)) {
            lamps_arrange(&app->now, p, app_pole_y(app));
            changed = true;
        }
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip("%s", p->what);
    }
    if (ImGui::InputTextWithHint("##spec", "spot 0 0 2 0 0 -1 20 rgb 1 .8 .6", panel->spec,
                                 sizeof panel->spec, ImGuiInputTextFlags_EnterReturnsTrue))
        wish_light(app, panel->spec);
    return changed;
}

static bool lights_section(panel *panel, app *app)
{
    bool changed = list_lights(panel, &app->now);
    const int near = lamps_near(&app->now);
    if (app->now.lights > rows_most || near)
        ImGui::Text("%d lights, %d of them near", app->now.lights, near);
    ImGui::Separator();
    changed |= edit_light(panel, app);
    changed |= light_buttons(panel, app);
    return changed;
}

// ---------------------------------------------------------------- other sections

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

static bool picture_section(app *app)
{
    const double least = -10, most = 10;
    bool changed = ImGui::SliderScalar("exposure", ImGuiDataType_Double, &app->now.exposure_ev,
                                       &least, &most, "%+.2f EV");
    bool automatic = app->now.auto_exposure;
    if (ImGui::Checkbox("automatic exposure", &automatic))
        changed |= keys_press(app, 'e', false);
    changed |= choose_tone(app);
    changed |= choose_pass(app);
    changed |= ImGui::Checkbox("ball", &app->now.ball);
    ImGui::SameLine();
    changed |= ImGui::Checkbox("handles", &app->gizmos);
    ImGui::SameLine();
    changed |= ImGui::Checkbox("inspector", &app->inspect);
    static const struct {
        const char *name;
        app_wish wish;
    } wishes[] = {
        {"PNG", APP_WISH_PNG},
        {"EXR", APP_WISH_EXR},
        {"sweep", APP_WISH_SWEEP},
        {"turntable", APP_WISH_TURNTABLE},
    };
    for (const auto &w : wishes) {
        if (ImGui::Button(w.name))
            app->wish = w.wish;
        ImGui::SameLine();
    }
    if (ImGui::Button("reset")) {
        app_reset(app);
        changed = true;
    }
    return changed;
}

static bool choose_mode(gaze *s)
{
    bool changed = false;
    if (!ImGui::BeginCombo("mode", gaze_mode_name(s->mode)))
        return false;
    for (int i = 0; i < GAZE_MODES; i++)
        if (ImGui::Selectable(gaze_mode_name((gaze_mode)i), s->mode == i)) {
            s->mode = (gaze_mode)i;
            changed = true;
        }
    ImGui::EndCombo();
    return changed;
}

static bool parts_row(gaze *s)
{
    bool changed = false;
    for (const gaze_part *p = gaze_parts; p->name; p++) {
        bool on = !(s->parts_off & p->part);
        if (p != gaze_parts && p != gaze_parts + 3)
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

static bool glare_section(app *app, const panel_facts *facts)
{
    gaze *s = &app->now.gaze;
    const double least[] = {0.1, 1e-2, 0}, most[] = {20, 1e5, 0.95};
    double magnify = gaze_magnify(s), nits = gaze_nits(s);
    bool changed = false;
    if (ImGui::Checkbox("glare", &s->on))
        changed = true;
    ImGui::SameLine();
    changed |= ImGui::Checkbox("paused", &s->paused);
    ImGui::SameLine();
    changed |= ImGui::Checkbox("sources", &s->sources);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("lights that are in view are drawn as small sources");
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
        ImGui::SetTooltip("computed once, then shown again and again: cheap");
    changed |= choose_mode(s);
    changed |= parts_row(s);
    if (facts->eye)
        ImGui::TextUnformatted(facts->eye);
    return changed;
}

static void histogram_section(const panel_facts *facts, float scale)
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

static void file_section(const panel_facts *facts)
{
    ImGui::TextUnformatted(facts->file ? facts->file : "");
    for (const char *const *line = facts->line; line && *line; line++)
        ImGui::TextUnformatted(*line);
}

static void wish_map(app *app, const char *folder, const char *name)
{
    app->wish = APP_WISH_MAP;
    std::snprintf(app->spec, sizeof app->spec, "%s%s%s", folder, folder[0] ? "/" : "", name);
}

// A new map takes the place of the selected environment's, else it is one more light.
static void environment_rows(panel *panel, app *app, const panel_facts *facts)
{
    const char *now = facts->map_in_use ? facts->map_in_use : "choose a file";
    panel->maps = ImGui::BeginCombo("environment", now);
    if (panel->maps) {
        for (const char *const *name = facts->map; name && *name; name++)
            if (ImGui::Selectable(*name, !std::strcmp(*name, now)))
                wish_map(app, facts->map_folder, *name);
        ImGui::EndCombo();
    }
    if (ImGui::InputTextWithHint("##environment", "or file.hdr, then Enter", panel->environment,
                                 sizeof panel->environment, ImGuiInputTextFlags_EnterReturnsTrue) &&
        panel->environment[0])
        wish_map(app, "", panel->environment);
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

static bool objects_section(app *app, const panel_facts *facts)
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

// ---------------------------------------------------------------- windows

static bool panel_window(panel *panel, app *app, const panel_facts *facts)
{
    const float margin = 8 * panel->scale;
    const float width = std::min(width_units * panel->scale, (float)app->width - 2 * margin);
    const float height = (float)app->height - 2 * margin;
    if (width < 40 || height < 40)
        return false;
    bool changed = false;
    ImGui::SetNextWindowPos(ImVec2(margin, margin));
    ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0), ImVec2(width, height));
    ImGui::Begin("relume", nullptr,
                 ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoTitleBar |
                     ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::PushItemWidth(0.62f * width);
    if (ImGui::CollapsingHeader("Lights", ImGuiTreeNodeFlags_DefaultOpen)) {
        changed |= lights_section(panel, app);
        environment_rows(panel, app, facts);
    }
    if (app->file.objects && ImGui::CollapsingHeader("Objects", ImGuiTreeNodeFlags_DefaultOpen))
        changed |= objects_section(app, facts);
    if (ImGui::CollapsingHeader("Picture", ImGuiTreeNodeFlags_DefaultOpen))
        changed |= picture_section(app);
    if (ImGui::CollapsingHeader("Glare", app->now.gaze.on ? ImGuiTreeNodeFlags_DefaultOpen : 0))
        changed |= glare_section(app, facts);
    panel->histogram = ImGui::CollapsingHeader("Histogram");
    if (panel->histogram)
        histogram_section(facts, panel->scale);
    if (ImGui::CollapsingHeader("File"))
        file_section(facts);
    if (facts->message && facts->message[0])
        ImGui::TextWrapped("%s", facts->message);
    ImGui::PopItemWidth();
    ImGui::End();
    return changed;
}

static void help_window(const app *app, float scale)
{
    const ImVec2 middle(0.5f * (float)app->width, 0.5f * (float)app->height);
    ImGui::SetNextWindowPos(middle, ImGuiCond_Always, ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0),
                                        ImVec2((float)app->width, (float)app->height));
    ImGui::Begin("keys", nullptr,
                 ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoTitleBar |
                     ImGuiWindowFlags_AlwaysAutoResize);
    for (const key_binding *b = key_bindings; b->key; b++) {
        if (!b->shown)
            continue;
        ImGui::TextColored(ImVec4(1, 0.85f, 0.5f, 1), "%s", b->shown);
        ImGui::SameLine(110 * scale);
        ImGui::TextUnformatted(b->what);
    }
    ImGui::End();
}

static void draw_gizmos(const app *app, float scale)
{
    ImDrawList *draw = ImGui::GetBackgroundDrawList();
    const gizmo_circle disc = gizmo_disc(app);
    draw->AddCircle(ImVec2((float)disc.x, (float)disc.y), (float)disc.radius,
                    IM_COL32(255, 255, 255, 70), 96);
    const int first = gizmo_first(app);
    for (int i = first; i < app->now.lights && i < first + GIZMOS; i++) {
        gizmo g;
        if (!gizmo_of(&g, app, i))
            continue;
        const ImVec2 at((float)g.x, (float)g.y);
        draw->AddCircleFilled(at, 6 * scale, ball_colour(app->now.light[i], g.behind));
        draw->AddCircle(at, 7 * scale, IM_COL32(0, 0, 0, 255), 0, 1.5f);
        if (i == app->now.selected)
            draw->AddCircle(at, 9 * scale, IM_COL32_WHITE, 0, 1.5f);
    }
}

// Beside the cursor, where there is room.
static void inspector_window(const app *app, const panel_facts *facts, float scale)
{
    if (!facts->plot)
        return;
    const float side = (float)facts->plot->width * scale;
    const float x = (float)app->cursor[0], y = (float)app->cursor[1];
    const bool left = x + side + 60 * scale > (float)app->width;
    const bool above = y + side + 80 * scale > (float)app->height;
    const float off = 16 * scale;
    ImGui::SetNextWindowPos(ImVec2(left ? x - off : x + off, above ? y - off : y + off),
                            ImGuiCond_Always, ImVec2(left ? 1.0f : 0.0f, above ? 1.0f : 0.0f));
    ImGui::Begin("inspector", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoMove);
    ImGui::Image((ImTextureID)(intptr_t)PANEL_PLOT, ImVec2(side, side));
    if (facts->plot_text)
        ImGui::TextUnformatted(facts->plot_text);
    ImGui::End();
}

// ---------------------------------------------------------------- frame

static void one_frame(panel *panel, app *app, const panel_facts *facts)
{
    ImGuiIO &io = ImGui::GetIO();
    io.DisplaySize = ImVec2((float)app->width, (float)app->height);
    io.DeltaTime = 1.0f / 60;
    ImGui::NewFrame();
    panel->histogram = false;
    if (app->gizmos)
        draw_gizmos(app, panel->scale);
    if (app->panel)
        panel->changed |= panel_window(panel, app, facts);
    if (app->inspect)
        inspector_window(app, facts, panel->scale);
    if (app->help)
        help_window(app, panel->scale);
    ImGui::Render();
}

static void collect_runs(panel *panel)
{
    const ImDrawData *data = ImGui::GetDrawData();
    static_assert(sizeof(ImDrawVert) == sizeof(panel_vertex), "vertices are taken as they are");
    static_assert(sizeof(ImDrawIdx) == sizeof(unsigned short), "indices are taken as they are");
    panel->runs.clear();
    for (int n = 0; n < data->CmdListsCount; n++) {
        const ImDrawList *list = data->CmdLists[n];
        for (const ImDrawCmd &cmd : list->CmdBuffer) {
            panel_run run = {};
            run.vertex = reinterpret_cast<const panel_vertex *>(list->VtxBuffer.Data);
            run.index = list->IdxBuffer.Data;
            run.vertices = list->VtxBuffer.Size;
            run.indices = list->IdxBuffer.Size;
            run.first = (int)cmd.IdxOffset;
            run.count = (int)cmd.ElemCount;
            std::memcpy(run.clip, &cmd.ClipRect, sizeof run.clip);
            run.texture = (panel_texture)(intptr_t)cmd.GetTexID();
            panel->runs.push_back(run);
        }
    }
}

// A frame for every event, so that a click within one picture is a press and a release, and two
// more: new windows find their size in the first and are seen in the second.
extern "C" bool panel_build(struct panel *panel, struct app *app, const struct panel_facts *facts)
{
    ImGui::SetCurrentContext(panel->context);
    panel->changed = false;
    for (const app_event &e : panel->queue) {
        tell_imgui(e);
        one_frame(panel, app, facts);
    }
    panel->queue.clear();
    one_frame(panel, app, facts);
    one_frame(panel, app, facts);
    collect_runs(panel);
    return panel->changed;
}

extern "C" bool panel_wants_histogram(const struct panel *panel)
{
    return panel->histogram;
}

extern "C" bool panel_wants_maps(const struct panel *panel)
{
    return panel->maps;
}

extern "C" bool panel_run_at(struct panel_run *out, const struct panel *panel, int i)
{
    if (i >= (int)panel->runs.size())
        return false;
    *out = panel->runs[(size_t)i];
    return true;
}

// panel_lights.cpp - the panel's part about lights: list, ball, numbers, environments
#include "panel/panel_parts.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

static const float ball_units = 120;

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
    bool on = !s->light_state[i].off;
    if (panel_box("##on", &on, "whether this light shines")) {
        s->light_state[i].off = !on;
        changed = true;
    }
    ImGui::SameLine();
    changed |=
        panel_box("##solo", &s->light_state[i].solo, "solo: only the lights marked here shine");
    ImGui::SameLine();
    ImGui::ColorButton("##colour", colour_of(s->light[i]), ImGuiColorEditFlags_NoTooltip);
    panel_tip("the colour of this light; select it to change that below");
    ImGui::SameLine();
    std::snprintf(label, sizeof label, "%d %s", i + 1, light_list_kind_words(s->light[i].kind));
    if (ImGui::Selectable(label, s->selected == i)) {
        s->selected = i;
        changed = true;
    }
    panel_tip("select this light to change it below");
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

ImU32 panel_mark_colour(const relume_light &light, bool behind)
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
    panel_tip("a ball seen from the front: drag to where the light comes from");
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
        const relume_vec3 d = app_light_direction(app, i);
        const ImVec2 dot(middle.x + radius * (float)d.x, middle.y - radius * (float)d.y);
        draw->AddCircleFilled(dot, 0.045f * side, panel_mark_colour(s->light[i], d.z < 0));
        if (i == s->selected)
            draw->AddCircle(dot, 0.065f * side, IM_COL32_WHITE, 0, 1.5f);
    }
    return changed;
}

static bool edit_vector(const char *label, relume_vec3 *v, const char *what)
{
    double values[3] = {v->x, v->y, v->z};
    const bool moved =
        ImGui::DragScalarN(label, ImGuiDataType_Double, values, 3, 0.01f, nullptr, nullptr, "%.3f");
    panel_tip(what);
    if (!moved || !std::isfinite(values[0]) || !std::isfinite(values[1]) ||
        !std::isfinite(values[2]))
        return false;
    *v = relume_vec3{values[0], values[1], values[2]};
    return true;
}

static bool flip_side(app *app)
{
    relume_vec3 d = app_light_direction(app, app->now.selected);
    bool behind = d.z < 0;
    if (!panel_box("from behind", &behind, "the half of the ball that cannot be seen"))
        return false;
    d.z = -d.z;
    app_aim_light(app, app->now.selected, d);
    return true;
}

// What a kind has beside a direction. A field that makes no light is put back.
static bool edit_geometry(relume_light *light)
{
    const relume_light was = *light;
    const unsigned fields = light_list_fields(light->kind);
    bool changed = false;
    if (fields & LIGHT_FIELD_TURN)
        changed |= panel_slider("rotation", &light->rotate_deg, -180, 180, "%.1f deg",
                                "turns the surroundings about the vertical axis");
    if (fields & LIGHT_FIELD_PLACE)
        changed |= edit_vector("position", &light->position,
                               "x, y, z in world units: drag sideways, or Ctrl+click and type");
    if (fields & LIGHT_FIELD_AXIS)
        changed |= edit_vector("axis", &light->direction, "x, y, z of where it shines to");
    if (fields & LIGHT_FIELD_ANGLE)
        changed |= panel_slider("half angle", &light->half_angle_deg, 0.5, 89.5, "%.1f deg",
                                "from the axis to the edge of its cone");
    if (fields & LIGHT_FIELD_EDGES) {
        changed |= edit_vector("half edge u", &light->u,
                               "x, y, z from the middle to the middle of one side");
        changed |= edit_vector("half edge v", &light->v,
                               "x, y, z from the middle to the middle of the next side");
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
    if (!app->near_lights || !(light_list_fields(now) & LIGHT_FIELD_CHANGE))
        return false;
    const int was = (int)(std::find(kinds, std::end(kinds), now) - kinds);
    int chosen = was;
    if (!panel_choice(
            "kind", &chosen, (int)std::size(kinds),
            [](int i) { return light_list_kind_words(kinds[i]); },
            "far away, a point, a cone or a glowing rectangle") ||
        chosen == was)
        return false;
    light_list_change_kind(s, s->selected, kinds[chosen], app_middle(app), 1.5 * app_reach(app));
    return true;
}

static bool edit_light(panel *panel, app *app)
{
    app_state *s = &app->now;
    relume_light *light = &s->light[s->selected];
    app_light_state *state = &s->light_state[s->selected];
    bool changed = ball(app, ball_units * panel->scale);
    ImGui::SameLine();
    ImGui::BeginGroup();
    ImGui::Text("light %d", s->selected + 1);
    ImGui::TextUnformatted(light_list_kind_words(light->kind));
    changed |= flip_side(app);
    changed |= ImGui::ColorEdit3("colour", light->rgb,
                                 ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_Float |
                                     ImGuiColorEditFlags_HDR | ImGuiColorEditFlags_NoTooltip);
    panel_tip("the colour of this light: click to choose one");
    ImGui::EndGroup();
    changed |= panel_slider("stops", &state->stops, -8, 8, "%+.2f",
                            "brightness of this light: +1 doubles it, -1 halves it");
    changed |= choose_kind(app);
    return changed | edit_geometry(light);
}

static void ask_light(app *app, const char *spec)
{
    app->action = APP_ACTION_ADD_LIGHT;
    std::snprintf(app->spec, sizeof app->spec, "%s", spec);
}

static bool light_buttons(panel *panel, app *app)
{
    bool changed = false;
    if (panel_button("add", "add a light; also by M"))
        changed |= keys_press(app, 'm', false);
    ImGui::SameLine();
    if (panel_button("remove", "remove the selected light; also by Delete"))
        changed |= keys_press(app, APP_KEY_DELETE, false);
    ImGui::SameLine();
    if (panel_button("save rig", "save these lights as a rig file, which --rig reads"))
        app->action = APP_ACTION_SAVE_RIG;
    for (const light_preset *p = light_presets; p->name; p++) {
        if (p != light_presets)
            ImGui::SameLine();
        if (panel_button(p->name, p->what)) {
            app_arrange_lights(app, p);
            changed = true;
        }
    }
    ImGui::SetNextItemWidth(-1);
    if (ImGui::InputTextWithHint("##spec", "spot 0 0 2 0 0 -1 20 rgb 1 .8 .6", panel->spec,
                                 sizeof panel->spec, ImGuiInputTextFlags_EnterReturnsTrue))
        ask_light(app, panel->spec);
    panel_tip("describe a light in words (docs/lights.md) and press Enter to add it");
    return changed;
}

static void ask_map(app *app, const char *folder, const char *name)
{
    app->action = APP_ACTION_MAP;
    std::snprintf(app->spec, sizeof app->spec, "%s%s%s", folder, folder[0] ? "/" : "", name);
}

// A new map takes the place of the selected environment's, else it is one more light.
static void environment_rows(panel *panel, app *app, const panel_facts *facts)
{
    const char *now = facts->map_in_use ? facts->map_in_use : "choose a file";
    panel->maps = ImGui::BeginCombo("environment", now);
    if (!panel->maps)
        panel_tip("light from all around: a map (.hdr, .exr, .pfm) beside the one in use");
    if (panel->maps) {
        for (const char *const *name = facts->map; name && *name; name++)
            if (ImGui::Selectable(*name, !std::strcmp(*name, now)))
                ask_map(app, facts->map_folder, *name);
        ImGui::EndCombo();
    }
    ImGui::SetNextItemWidth(-1);
    const bool entered =
        ImGui::InputTextWithHint("##environment", "or file.hdr, then Enter", panel->environment,
                                 sizeof panel->environment, ImGuiInputTextFlags_EnterReturnsTrue);
    panel_tip("type the name of a map and press Enter");
    if (entered && panel->environment[0])
        ask_map(app, "", panel->environment);
}

bool panel_lights(panel *panel, app *app, const panel_facts *facts)
{
    bool changed = list_lights(panel, &app->now);
    const int near = light_list_near(&app->now);
    if (app->now.lights > rows_most || near)
        ImGui::Text("%d light%s, %d near", app->now.lights, relume_plural(app->now.lights), near);
    ImGui::Separator();
    changed |= edit_light(panel, app);
    changed |= light_buttons(panel, app);
    environment_rows(panel, app, facts);
    return changed;
}

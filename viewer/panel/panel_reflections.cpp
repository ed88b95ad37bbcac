// panel_reflections.cpp - reflections edited by hand: the section of the panel, and the handles in
// the picture
#include "panel/panel_parts.h"

extern "C" {
#include "app/handles.h"
#include "app/handles_drag.h"
#include "world/reflect/reflection.h"
}

#include <cstdarg>
#include <cstdio>

// ---------------------------------------------------------------- section

__attribute__((format(printf, 2, 3))) static void ask(app *app, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    std::vsnprintf(app->spec, sizeof app->spec, format, args);
    va_end(args);
    app->action = APP_ACTION_REFLECTION;
}

static void tools(app *app)
{
    static const char *const what[HANDLES_TOOLS] = {
        "press on a mirror and drag: what is seen there moves along (red: where it was; green: "
        "where it is)",
        "press on a mirror: edits are seen within a ball about the place",
        "the same within a distance along the surface",
        "paint on a mirror: edits are seen there",
    };
    for (int i = 0; i < HANDLES_TOOLS; i++) {
        if (i)
            ImGui::SameLine();
        if (ImGui::RadioButton(handles_tool_names[i], app->handles->tool == i))
            ask(app, "tool %s", handles_tool_names[i]);
        panel_tip(what[i]);
    }
}

static void row(app *app, handles_kind kind, int object, int number)
{
    static const char *const shapes[] = {"ball", "along the surface", "stroke"};
    const handles *h = app->handles;
    const handles_edit *e = &h->now[object];
    const bool chosen =
        h->chosen.kind == kind && h->chosen.object == object && h->chosen.number == number;
    const char *is = kind == HANDLES_CONSTRAINT ? "constraint" : "region";
    std::string text = is + (" " + std::to_string(number));
    if (kind == HANDLES_REGION)
        text += std::string(", ") + shapes[e->region[number].shape];
    if (h->count > 1)
        text += ", object " + std::to_string(object);
    text += "##" + std::to_string(object);
    if (ImGui::Selectable(text.c_str(), chosen))
        ask(app, "choose %s %d %d", is, number, object);
    panel_tip("choose it: its handles are larger, and Delete removes it");
}

static void list(app *app, float scale)
{
    const handles *h = app->handles;
    int rows = 0;
    for (int o = 0; o < h->count; o++)
        rows += h->now[o].edit.constraints + h->now[o].edit.regions;
    if (!rows) {
        ImGui::TextUnformatted("no edits yet: press on a mirror and drag");
        return;
    }
    ImGui::BeginChild("edits of reflections", ImVec2(0, (float)(rows < 6 ? rows : 6) * 19 * scale));
    for (int o = 0; o < h->count; o++) {
        for (int i = 0; i < h->now[o].edit.constraints; i++)
            row(app, HANDLES_CONSTRAINT, o, i);
        for (int i = 0; i < h->now[o].edit.regions; i++)
            row(app, HANDLES_REGION, o, i);
    }
    ImGui::EndChild();
}

static void sizes(app *app)
{
    const handles *h = app->handles;
    const relume_reflection_region *r = handles_region(h);
    double radius = r ? r->radius : h->radius, border = r ? r->border / r->radius : h->border;
    if (panel_slider("radius", &radius, 1e-3 * h->size, h->size, "%.3g",
                     "of the chosen region and the next one", ImGuiSliderFlags_Logarithmic))
        ask(app, "radius %.6g", radius);
    if (panel_slider("border", &border, 0, 4, "%.2f of the radius",
                     "how far outside the region edits fade away"))
        ask(app, "border %.6g", border);
}

static void switches(app *app)
{
    const struct relume_reflection_edit *e = &app->handles->now[app->handles->chosen.object].edit;
    bool frozen = e->frozen, along = e->geodesic;
    if (panel_box(
            "frozen", &frozen,
            "keep what mirrors show from here, wherever the eye goes, to edit from elsewhere"))
        ask(app, frozen ? "freeze" : "unfreeze");
    ImGui::SameLine();
    if (panel_box("along the surface", &along,
                  "how far constraints reach: along the surface, or straight"))
        ask(app, "distance %s", along ? "geodesic" : "straight");
}

static void buttons(app *app)
{
    const handles *h = app->handles;
    if (panel_button("undo##reflections", "undo the last change (Ctrl+Z)"))
        ask(app, "undo");
    ImGui::SameLine();
    if (panel_button("redo##reflections", "redo what was undone last (Ctrl+Y)"))
        ask(app, "redo");
    ImGui::SameLine();
    if (panel_button("delete##reflections", "remove what is chosen (Delete)"))
        ask(app, "delete");
    if (!handles_constraint(h))
        return;
    ImGui::SameLine();
    if (panel_button("to its view", "the eye goes back to where this constraint was made"))
        ask(app, "view");
}

static void file(panel *panel, app *app, const panel_facts *facts)
{
    ImGui::InputTextWithHint("##list", facts->reflections, panel->reflections,
                             sizeof panel->reflections);
    panel_tip("the file that edits are saved to, for --reflections");
    ImGui::SameLine();
    if (panel_button("save##reflections", "save all edits of reflections"))
        ask(app, "save %.4000s", panel->reflections);
}

void panel_reflections(panel *panel, app *app, const panel_facts *facts)
{
    bool on = app->reflects;
    if (panel_box("handles in the picture", &on, "edit what mirrors reflect, by hand (Ctrl+R)"))
        ask(app, on ? "on" : "off");
    if (!app->handles)
        return;
    tools(app);
    list(app, panel->scale);
    sizes(app);
    switches(app);
    buttons(app);
    file(panel, app, facts);
}

// ---------------------------------------------------------------- handles

static const ImU32 red = IM_COL32(235, 60, 50, 255), green = IM_COL32(60, 210, 80, 255),
                   blue = IM_COL32(80, 150, 255, 255);

static bool is_chosen(const handles *h, const handles_choice &c)
{
    return h->chosen.kind == c.kind && h->chosen.object == c.object && h->chosen.number == c.number;
}

static ImU32 faint(ImU32 colour, bool hidden)
{
    return hidden ? (colour & ~IM_COL32_A_MASK) | (70u << IM_COL32_A_SHIFT) : colour;
}

static void outline(ImDrawList *draw, const app *app, int object, int region, float scale)
{
    const handles *h = app->handles;
    const float width = is_chosen(h, {HANDLES_REGION, object, region}) ? 2.5f : 1.2f;
    const float left = (float)app->beside[0];
    double from[2], to[2];
    for (int i = 0; handles_outline(from, app, object, region, i) &&
                    handles_outline(to, app, object, region, i + 1);
         i++)
        draw->AddLine(ImVec2(left + (float)from[0], (float)from[1]),
                      ImVec2(left + (float)to[0], (float)to[1]), blue, width * scale);
}

static void mark(ImDrawList *draw, ImVec2 at, const handle &h, bool chosen, float scale)
{
    const float radius = (chosen ? 7 : 5) * scale;
    const ImU32 colour = faint(h.grip == HANDLES_RED     ? red
                               : h.grip == HANDLES_GREEN ? green
                                                         : blue,
                               h.hidden);
    if (h.grip == HANDLES_RIM)
        draw->AddRectFilled(ImVec2(at.x - 0.8f * radius, at.y - 0.8f * radius),
                            ImVec2(at.x + 0.8f * radius, at.y + 0.8f * radius), colour);
    else
        draw->AddCircleFilled(at, radius, colour);
    draw->AddCircle(at, radius + scale, IM_COL32(0, 0, 0, h.hidden ? 70 : 255), 0, 1.5f);
}

// The green handle of a constraint follows its red one, if it has one.
void panel_reflection_handles(const app *app, float scale)
{
    static handle all[HANDLES_MOST];
    ImDrawList *draw = ImGui::GetBackgroundDrawList();
    const float left = (float)app->beside[0];
    const int n = handles_of(all, app);
    for (int o = 0; o < app->handles->count; o++)
        for (int i = 0; i < app->handles->now[o].edit.regions; i++)
            outline(draw, app, o, i, scale);
    for (int i = 1; i < n; i++)
        if (all[i].grip == HANDLES_GREEN && all[i - 1].grip == HANDLES_RED &&
            all[i - 1].of.number == all[i].of.number && all[i - 1].of.object == all[i].of.object)
            draw->AddLine(ImVec2(left + (float)all[i - 1].x, (float)all[i - 1].y),
                          ImVec2(left + (float)all[i].x, (float)all[i].y),
                          IM_COL32(255, 255, 255, 170), 1.5f * scale);
    for (int i = 0; i < n; i++)
        mark(draw, ImVec2(left + (float)all[i].x, (float)all[i].y), all[i],
             is_chosen(app->handles, all[i].of), scale);
}

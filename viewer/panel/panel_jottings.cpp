// panel_jottings.cpp - notes and measures: the section of the panel, and what is drawn over the
// picture
#include "panel/panel_parts.h"

extern "C" {
#include "app/notes.h"
#include "app/view_geometry.h"
}

#include <cmath>
#include <cstdio>
#include <cstring>

// ---------------------------------------------------------------- words

static std::string length_text(double length, double mm, const char *unit)
{
    char text[64];
    std::snprintf(text, sizeof text, "%.4g %s", length * (mm > 0 ? mm : 1), mm > 0 ? "mm" : unit);
    return text;
}

static std::string measure_text(const relume_note &note, double mm)
{
    const relume_note_measures m = relume_note_measure(&note);
    const char *unit = note.z ? "units" : "px";
    char text[96] = "";
    if (std::isfinite(m.area))
        std::snprintf(text, sizeof text, "%.4g %s\xc2\xb2", m.area * (mm > 0 ? mm * mm : 1),
                      mm > 0 ? "mm" : unit);
    else if (std::isfinite(m.degrees))
        std::snprintf(text, sizeof text, "%s, %.3g\xc2\xb0",
                      length_text(m.length, mm, unit).c_str(), m.degrees);
    else if (std::isfinite(m.length))
        return length_text(m.length, mm, unit);
    return text;
}

// ---------------------------------------------------------------- section

static void tools(app *app)
{
    static const struct {
        const char *name, *what;
        relume_note_kind kind;
    } all[] = {
        {"choose", "drags move the picture; a press on a note chooses it", RELUME_NOTE_VIEW},
        {"point", "press where something is", RELUME_NOTE_POINT},
        {"line", "press along a line, then Enter: its length, and the angle of three places",
         RELUME_NOTE_LINE},
        {"area", "press around something, then Enter: its area", RELUME_NOTE_POLYGON},
    };
    for (const auto &tool : all) {
        if (&tool != all)
            ImGui::SameLine();
        if (ImGui::RadioButton(tool.name, app->notes->tool == tool.kind) &&
            app->action != APP_ACTION_NOTE) {
            app->notes->tool = tool.kind;
            app->notes->places = 0;
        }
        panel_tip(tool.what);
    }
}

static void list(app *app, float scale)
{
    notes *n = app->notes;
    const int count = relume_notes_count(n->list);
    const double mm = relume_notes_scale(n->list);
    if (!count) {
        ImGui::TextWrapped("no notes yet: choose a tool and press in the picture");
        return;
    }
    ImGui::BeginChild("list of notes", ImVec2(0, (float)(count < 8 ? count : 8) * 19 * scale));
    ImGuiListClipper clipper;
    clipper.Begin(count);
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; i++) {
            const relume_note *note = relume_notes_get(n->list, i);
            const std::string text = std::string(relume_note_kind_name(note->kind)) + "  " +
                                     measure_text(*note, mm) + "  " +
                                     std::string(note->text ? note->text : "") + "##" + note->id;
            if (ImGui::Selectable(text.c_str(), n->chosen == i)) {
                n->chosen = i;
                app->action = APP_ACTION_NOTE_BACK;
            }
            panel_tip("show it in the light that it was made in");
        }
    ImGui::EndChild();
}

// The text field keeps what it is given while a note is chosen; it is saved when it is left.
static void chosen(panel *panel, app *app)
{
    notes *n = app->notes;
    const relume_note *note = relume_notes_get(n->list, n->chosen);
    if (panel->noted != n->chosen) {
        std::snprintf(panel->note, sizeof panel->note, "%s", note->text ? note->text : "");
        panel->noted = n->chosen;
    }
    ImGui::InputTextWithHint("##note", "what is there?", panel->note, sizeof panel->note);
    panel_tip("the text of the chosen note");
    if (ImGui::IsItemDeactivatedAfterEdit() &&
        !relume_notes_rewrite(n->list, n->chosen, panel->note, nullptr))
        app->action = APP_ACTION_NOTE_SAVE;
    ImGui::SameLine();
    if (panel_button("remove##note", "remove the chosen note")) {
        relume_notes_remove(n->list, n->chosen);
        n->chosen = panel->noted = -1;
        app->action = APP_ACTION_NOTE_SAVE;
    }
}

static void scale_row(panel *panel, app *app)
{
    notes *n = app->notes;
    const relume_note *note = n->chosen >= 0 ? relume_notes_get(n->list, n->chosen) : nullptr;
    const double length =
        note && note->kind == RELUME_NOTE_LINE ? relume_note_measure(note).length : 0;
    if (!(length > 0))
        return;
    ImGui::InputDouble("mm long", &panel->ruler_mm, 0, 0, "%.4g");
    panel_tip("how long the chosen line is: the scale of the picture");
    ImGui::SameLine();
    if (panel_button("set the scale", "lengths and areas are in millimetres from now on") &&
        panel->ruler_mm > 0 && !relume_notes_set_scale(n->list, panel->ruler_mm / length))
        app->action = APP_ACTION_NOTE_SAVE;
}

bool panel_jottings(panel *panel, app *app)
{
    notes *n = app->notes;
    tools(app);
    if (!notes_have_places(app))
        ImGui::TextWrapped("from here only views can be kept: notes have places on a whole "
                           "picture (--view 0)");
    list(app, panel->scale);
    if (n->chosen >= 0)
        chosen(panel, app);
    scale_row(panel, app);
    if (panel_button("keep this view", "a note without a place: eye, light and pass")) {
        n->tool = RELUME_NOTE_VIEW;
        n->places = 0;
        app->action = APP_ACTION_NOTE;
    }
    return false;
}

// ---------------------------------------------------------------- over the picture

static const ImU32 ink = IM_COL32(255, 208, 0, 255), halo = IM_COL32(0, 0, 0, 170);

// False: it lies behind the eye.
static bool at(ImVec2 *out, const app *app, const relume_note &note, int i)
{
    double xy[2];
    if (!notes_to_frame(xy, app, note.place[i], note.z ? note.z[i] : 0))
        return false;
    *out = ImVec2((float)(app->beside[0] + xy[0]), (float)xy[1]);
    return true;
}

static void edge(ImDrawList *draw, const app *app, const relume_note &note, int i, ImU32 colour,
                 float wide)
{
    ImVec2 a, b;
    if (at(&a, app, note, i) && at(&b, app, note, (i + 1) % note.places))
        draw->AddLine(a, b, colour, wide);
}

// One of very many: without borders and smooth edges.
static void draw_plain(ImDrawList *draw, const app *app, const relume_note &note, float scale)
{
    const bool closed = note.kind == RELUME_NOTE_POLYGON;
    for (int i = 0; i + 1 < note.places + (int)closed; i++)
        edge(draw, app, note, i, ink, 1);
    ImVec2 p;
    if (note.kind == RELUME_NOTE_POINT && at(&p, app, note, 0))
        draw->AddRectFilled(ImVec2(p.x - 2 * scale, p.y - 2 * scale),
                            ImVec2(p.x + 2 * scale, p.y + 2 * scale), ink);
}

static void draw_note(ImDrawList *draw, const app *app, const relume_note &note, bool strong,
                      float scale)
{
    const float width = (strong ? 2.5f : 1.5f) * scale, radius = (strong ? 5.0f : 3.5f) * scale;
    for (int layer = 0; layer < 2; layer++) {
        const ImU32 colour = layer ? ink : halo;
        const float wide = layer ? width : width + 2 * scale;
        const bool closed = note.kind == RELUME_NOTE_POLYGON && note.places > 2;
        for (int i = 0; i + 1 < note.places + (int)closed; i++)
            edge(draw, app, note, i, colour, wide);
        ImVec2 p;
        for (int i = 0; i < note.places; i++)
            if ((strong || note.kind == RELUME_NOTE_POINT) && at(&p, app, note, i))
                draw->AddCircleFilled(p, radius + (layer ? 0 : scale), colour);
    }
}

static void label(ImDrawList *draw, ImVec2 place, const std::string &text, float scale)
{
    if (text.empty())
        return;
    place = ImVec2(place.x + 8 * scale, place.y - 18 * scale);
    draw->AddText(ImVec2(place.x + scale, place.y + scale), halo, text.c_str());
    draw->AddText(place, ink, text.c_str());
}

static void scale_bar(ImDrawList *draw, const app *app, float scale)
{
    const app_rectangle r = app_picture(app);
    const double pixels = (r.right - r.left) / app->file.width;
    const double mm = notes_scale_bar(app->notes, pixels, 160.0 * (double)scale);
    if (!(mm > 0))
        return;
    const float length = (float)(mm / relume_notes_scale(app->notes->list) * pixels);
    const ImVec2 left((float)(app->beside[0] + app->width) - 24 * scale - length,
                      (float)app->height - 24 * scale);
    draw->AddLine(left, ImVec2(left.x + length, left.y), halo, 6 * scale);
    draw->AddLine(left, ImVec2(left.x + length, left.y), IM_COL32_WHITE, 3 * scale);
    char text[32];
    std::snprintf(text, sizeof text, "%g mm", mm);
    label(draw, ImVec2(left.x - 8 * scale, left.y), text, scale);
}

// What lies outside the frame costs no triangles.
static bool is_near_frame(const app *app, const relume_note &note)
{
    for (int i = 0; i < note.places; i++) {
        ImVec2 p;
        if (at(&p, app, note, i) && p.x > -100 && p.y > -100 &&
            p.x < (float)app_window_width(app) + 100 && p.y < (float)app->height + 100)
            return true;
    }
    return false;
}

void panel_jotted(const app *app, float scale)
{
    const notes *n = app->notes;
    ImDrawList *draw = ImGui::GetBackgroundDrawList();
    const double mm = relume_notes_scale(n->list);
    const int count = notes_have_places(app) ? relume_notes_count(n->list) : 0;
    enum { LABELS = 200 };  // more cannot be read
    const ImDrawListFlags smooth = draw->Flags;
    for (int i = 0, labels = 0; i < count; i++) {
        const relume_note *note = relume_notes_get(n->list, i);
        if (!note->places || !is_near_frame(app, *note))
            continue;
        const bool plain = labels >= LABELS && i != n->chosen;
        draw->Flags = plain ? smooth & ImDrawListFlags_AllowVtxOffset : smooth;
        if (plain)
            draw_plain(draw, app, *note, scale);
        else
            draw_note(draw, app, *note, i == n->chosen, scale);
        if (labels++ >= LABELS && i != n->chosen)
            continue;
        std::string text = note->text ? note->text : "";
        const std::string measure = measure_text(*note, mm);
        text += (text.empty() || measure.empty() ? "" : "  ") + measure;
        ImVec2 place;
        if (at(&place, app, *note, 0))
            label(draw, place, text, scale);
    }
    draw->Flags = smooth;
    if (n->places) {
        const relume_note drawn = notes_drawn(app);
        draw_note(draw, app, drawn, true, scale);
        ImVec2 place;
        if (at(&place, app, drawn, drawn.places - 1))
            label(draw, place, measure_text(drawn, mm), scale);
    }
    if (notes_have_places(app) && app->now.camera.framing != RELUME_FRAME_LOOK && !app->file.around)
        scale_bar(draw, app, scale);
}

// panel_overlay.cpp - what is drawn over the picture: notes, keys, handles of lights, the inspector
#include "panel/panel_parts.h"

extern "C" {
#include "app/events.h"
#include "app/handles.h"
#include "format/coder/coding.h"
}

#include <algorithm>
#include <cstdio>

static const ImGuiWindowFlags fixed =
    ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoTitleBar |
    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize;

ImVec2 panel_frame_point(const app *app, float across, float down)
{
    return ImVec2((float)app->beside[0] + across * (float)app->width, down * (float)app->height);
}

// ---------------------------------------------------------------- notes

// A line that the pointer goes through; `down` is its place in the frame, `alpha` how much of it is
// still there.
static void note(const char *name, const char *text, const app *app, float down, float alpha,
                 float scale)
{
    if (alpha <= 0)
        return;
    const float most = 0.96f * (float)app->width;
    const float pad = 24 * scale;
    const bool wraps = ImGui::CalcTextSize(text).x + pad > most;
    ImGui::PushStyleVar(ImGuiStyleVar_Alpha, alpha);
    ImGui::SetNextWindowPos(panel_frame_point(app, 0.5f, down), ImGuiCond_Always,
                            ImVec2(0.5f, down));
    if (wraps)
        ImGui::SetNextWindowSize(ImVec2(most, 0));
    ImGui::Begin(name, nullptr, fixed | ImGuiWindowFlags_NoInputs);
    if (wraps)
        ImGui::TextWrapped("%s", text);
    else
        ImGui::TextUnformatted(text);
    ImGui::End();
    ImGui::PopStyleVar();
}

static void recording_note(const app *app, const panel_facts *facts)
{
    ImGui::SetNextWindowPos(panel_frame_point(app, 0.5f, 0), ImGuiCond_Always, ImVec2(0.5f, 0));
    ImGui::Begin("recording", nullptr, fixed | ImGuiWindowFlags_NoInputs);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float line = ImGui::GetTextLineHeight();
    ImGui::GetWindowDrawList()->AddCircleFilled(ImVec2(at.x + 0.5f * line, at.y + 0.5f * line),
                                                0.4f * line, IM_COL32(230, 30, 30, 255));
    ImGui::Dummy(ImVec2(line, line));
    ImGui::SameLine();
    ImGui::Text("%.1f of %.1f s  %s  Esc: end here", facts->recorded_s, facts->round_s,
                facts->recording);
    ImGui::End();
}

static const char *hint_of(const app *app)
{
    switch (app->now.camera.framing) {
    case RELUME_FRAME_LOOK:
        return "drag: look around - right drag or the ball: light - wheel: zoom - ?: help - "
               "Ctrl+O: open";
    case RELUME_FRAME_EYE:
        return "drag: turn - right drag or the ball: light - wheel: zoom - ?: help - Ctrl+O: open";
    default:
        return "right drag or the ball: light - drag: move - wheel: zoom - ?: help - Ctrl+O: open";
    }
}

void panel_notes(const app *app, const panel_facts *facts, float scale)
{
    const bool toast = facts->message && facts->message[0];
    if (facts->recording)
        recording_note(app, facts);
    else if (app->picks_focus)
        note("pick", "click on what should be sharp - Esc: cancel", app, 0.02f, 1, scale);
    else if (!app->help && !app->asks && !app->browse && !app->file.empty)
        note("hint", hint_of(app), app, 0.02f, (float)app_note_alpha(app->hint_s), scale);
    if (toast)
        note("toast", facts->message, app, 0.98f, (float)app_note_alpha(app->toast_s), scale);
}

// Enter and Esc are keys of the app.
void panel_question(app *app, float scale)
{
    ImGui::SetNextWindowPos(panel_frame_point(app, 0.5f, 0.5f), ImGuiCond_Always,
                            ImVec2(0.5f, 0.5f));
    ImGui::Begin("quit", nullptr, fixed);
    if (app->handles && app->handles->unsaved)
        ImGui::TextUnformatted("Edits of reflections have not been saved.");
    ImGui::TextUnformatted("Quit the viewer?");
    if (panel_button("quit (Enter)", "close the window"))
        app->quit = true;
    ImGui::SameLine(0, 12 * scale);
    if (panel_button("stay (Esc)", "back to the picture"))
        app->asks = false;
    ImGui::End();
}

// ---------------------------------------------------------------- keys

using help_rows = std::vector<const key_binding *>;
static const float keys_units = 110;  // for the names of keys

// Of rows `from` and on, with a margin behind them.
static float help_width(const help_rows &rows, size_t from, size_t count, float scale)
{
    float widest = 0;
    for (size_t i = from; i < std::min(from + count, rows.size()); i++)
        widest = std::max(widest, ImGui::CalcTextSize(rows[i]->what).x);
    return (keys_units + 16) * scale + widest;
}

static void help_row(const key_binding *b, float left, float scale)
{
    if (left > 0)
        ImGui::SameLine(left);
    ImGui::TextColored(ImVec4(1, 0.85f, 0.5f, 1), "%s", b->shown);
    ImGui::SameLine(left + keys_units * scale);
    ImGui::TextUnformatted(b->what);
}

// In two columns where one is too long for the window, if it is wide enough; else it scrolls.
void panel_help(const app *app, float scale)
{
    const float all = (float)app_window_width(app);
    ImGui::SetNextWindowPos(ImVec2(0.5f * all, 0.5f * (float)app->height), ImGuiCond_Always,
                            ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0), ImVec2(all, (float)app->height));
    ImGui::Begin("keys", nullptr, fixed);
    help_rows shown;
    for (const key_binding *b = key_bindings; b->key; b++)
        if (b->shown)
            shown.push_back(b);
    const bool fits = (float)shown.size() * ImGui::GetTextLineHeightWithSpacing() <
                      (float)app->height - 2 * ImGui::GetStyle().WindowPadding.y;
    const size_t half = (shown.size() + 1) / 2;
    const float column = help_width(shown, 0, half, scale);
    const bool wide = column + help_width(shown, half, half, scale) <= all;
    const size_t rows = fits || !wide ? shown.size() : half;
    for (size_t i = 0; i < rows; i++) {
        help_row(shown[i], 0, scale);
        if (i + rows < shown.size()) {
            ImGui::SameLine();
            help_row(shown[i + rows], column, scale);
        }
    }
    ImGui::End();
}

// Where the light was captured: from beyond, the picture is a guess.
static void draw_border(ImDrawList *draw, const app *app, float scale)
{
    const float left = (float)app->beside[0];
    gizmo from, to;
    for (int i = 0; i < RELUME_CAPTURED_REGION_STEPS && gizmo_border(&from, app, i); i++)
        if (gizmo_border(&to, app, i + 1) && !from.behind && !to.behind)
            draw->AddLine(ImVec2(left + (float)from.x, (float)from.y),
                          ImVec2(left + (float)to.x, (float)to.y), IM_COL32(255, 210, 90, 150),
                          1.5f * scale);
}

void panel_handles(const app *app, float scale)
{
    ImDrawList *draw = ImGui::GetBackgroundDrawList();
    const gizmo_circle disc = gizmo_disc(app);
    const float left = (float)app->beside[0];
    draw->AddCircle(ImVec2(left + (float)disc.x, (float)disc.y), (float)disc.radius,
                    IM_COL32(255, 255, 255, 70), 96);
    draw_border(draw, app, scale);
    const int first = gizmo_first(app);
    for (int i = first; i < app->now.lights && i < first + GIZMOS; i++) {
        gizmo g;
        if (!gizmo_of(&g, app, i))
            continue;
        const ImVec2 at(left + (float)g.x, (float)g.y);
        draw->AddCircleFilled(at, 6 * scale, panel_mark_colour(app->now.light[i], g.behind));
        draw->AddCircle(at, 7 * scale, IM_COL32(0, 0, 0, 255), 0, 1.5f);
        if (i == app->now.selected)
            draw->AddCircle(at, 9 * scale, IM_COL32_WHITE, 0, 1.5f);
    }
}

// Beside the cursor, where there is room.
void panel_inspector(const app *app, const panel_facts *facts, float scale)
{
    if (!facts->plot)
        return;
    const float side = (float)facts->plot->width * scale;
    const float x = (float)app->cursor[0], y = (float)app->cursor[1];
    const bool left = x + side + 60 * scale > (float)app->width;
    const bool above = y + side + 80 * scale > (float)app->height;
    const float off = 16 * scale;
    const float frame = (float)app->beside[0];
    ImGui::SetNextWindowPos(ImVec2(frame + (left ? x - off : x + off), above ? y - off : y + off),
                            ImGuiCond_Always, ImVec2(left ? 1.0f : 0.0f, above ? 1.0f : 0.0f));
    ImGui::Begin("inspector", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoMove);
    ImGui::Image((ImTextureID)(intptr_t)PANEL_PLOT, ImVec2(side, side));
    if (facts->plot_text)
        ImGui::TextUnformatted(facts->plot_text);
    ImGui::End();
}

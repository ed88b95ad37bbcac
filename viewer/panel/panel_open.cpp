// panel_open.cpp - what a user sees before a file is open, and chooses one from
#include "panel/panel_parts.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

static const ImGuiWindowFlags fixed = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                                      ImGuiWindowFlags_NoTitleBar |
                                      ImGuiWindowFlags_NoSavedSettings;

static void place_in_middle(const app *app)
{
    ImGui::SetNextWindowPos(panel_frame_point(app, 0.5f, 0.5f), ImGuiCond_Always,
                            ImVec2(0.5f, 0.5f));
}

void panel_start(app *app, float scale)
{
    static const char *const examples[] = {
        "relume synth bust -o bust --lights 64 --hemisphere",
        "relume encode bust -o bust.exr",
        "relume-view bust.exr",
    };
    const float margin = 16 * scale;
    place_in_middle(app);
    ImGui::SetNextWindowSizeConstraints(
        ImVec2(0, 0), ImVec2(std::max((float)app->width - margin, 1.0f), (float)app->height));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(2 * margin, 1.5f * margin));
    ImGui::Begin("start", nullptr, fixed | ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::TextUnformatted("Look at an object under any light.");
    ImGui::Dummy(ImVec2(1, margin));
    ImGui::TextUnformatted("Drop a file onto this window, or");
    if (panel_button("open a file (Ctrl+O)", "choose one from a list"))
        (void)keys_press(app, APP_CONTROL | 'o', false);
    ImGui::Dummy(ImVec2(1, margin));
    ImGui::TextUnformatted(
        "It can be a relume file (.exr), an RTI (.ptm, .rti, a web folder), a folder of a");
    ImGui::TextUnformatted("capture, an HDR picture (.hdr), or a description of objects (.json).");
    ImGui::TextUnformatted("No file yet? These commands in a terminal make one to try:");
    for (const char *line : examples)
        ImGui::TextColored(ImVec4(1, 0.85f, 0.5f, 1), "    %s", line);
    ImGui::TextUnformatted("How to photograph an object yourself: relume capture --help");
    ImGui::Dummy(ImVec2(1, margin));
    ImGui::TextUnformatted("?: keys    Ctrl+Q: quit");
    ImGui::End();
    ImGui::PopStyleVar();
}

// ---------------------------------------------------------------- choosing a file

static void ask_path(app *app, const browser *b, const char *name)
{
    char path[PATH_MAX];
    if (!name[0] || !browse_path(path, b, name) || std::strlen(path) >= sizeof app->spec)
        return;
    const bool enters = !std::strcmp(name, "..") || !browse_opens_folder(path);
    app->action = browse_is_folder(path) && enters ? APP_ACTION_FOLDER : APP_ACTION_OPEN;
    std::snprintf(app->spec, sizeof app->spec, "%s", path);
}

static void entries(panel *panel, app *app, const browser *b)
{
    char label[300];
    if (ImGui::Selectable(".. (one folder up)", false))
        ask_path(app, b, "..");
    panel_tip("go into the folder that holds this one");
    if (b->trouble)
        ImGui::TextWrapped("This folder cannot be read: %s", b->trouble);
    else if (!b->count)
        ImGui::TextWrapped("Nothing here that the viewer can open.");
    ImGuiListClipper clipper;
    clipper.Begin(b->count);
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; i++) {
            const browse_entry &e = b->entry[i];
            const bool chosen = !std::strcmp(panel->path, e.name);
            std::snprintf(label, sizeof label, "%s%s%s##%d", e.name, e.folder ? "/" : "",
                          e.opens ? " (opens)" : "", i);
            const bool clicked =
                ImGui::Selectable(label, chosen, ImGuiSelectableFlags_AllowDoubleClick);
            panel_tip(e.folder && !e.opens ? "click to go into this folder"
                                           : "double-click to open it");
            if (!clicked)
                continue;
            if ((e.folder && !e.opens) || ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left))
                ask_path(app, b, e.name);
            else
                std::snprintf(panel->path, sizeof panel->path, "%s", e.name);
        }
}

// The line for a path has the keys at once. A folder that is gone into empties it.
static bool path_line(panel *panel, const browser *b)
{
    const bool appears = ImGui::IsWindowAppearing();
    if (panel->browsed != b->folder) {
        panel->browsed = b->folder;
        panel->path[0] = '\0';
    }
    ImGui::SetNextItemWidth(-1);
    if (appears)
        ImGui::SetKeyboardFocusHere();
    const bool entered =
        ImGui::InputTextWithHint("##path", "or type a path, then Enter", panel->path,
                                 sizeof panel->path, ImGuiInputTextFlags_EnterReturnsTrue);
    panel_tip("of a file or a folder; ~ is your own");
    return entered;
}

void panel_browse(panel *panel, app *app, const browser *b)
{
    const float scale = panel->scale;
    const ImVec2 size(std::min(560 * scale, (float)app->width),
                      std::min(460 * scale, (float)app->height));
    if (size.x < 60 || size.y < 60)
        return;
    place_in_middle(app);
    ImGui::SetNextWindowSize(size);
    ImGui::Begin("open", nullptr, fixed);
    ImGui::TextWrapped("Open a file in %s", b->folder);
    const float below = 2 * ImGui::GetFrameHeightWithSpacing();
    ImGui::BeginChild("##files", ImVec2(0, -below), true);
    entries(panel, app, b);
    ImGui::EndChild();
    bool opens = path_line(panel, b);
    if (opens)
        ImGui::SetKeyboardFocusHere(-1);  // what is typed after a mistake corrects it
    opens |= panel_button("open (Enter)", "what the line says");
    ImGui::SameLine();
    if (panel_button("cancel (Esc)", "back to the picture"))
        app->browse = false;
    if (opens)
        ask_path(app, b, panel->path);
    ImGui::End();
}

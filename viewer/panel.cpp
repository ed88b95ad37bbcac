// panel.cpp - Dear ImGui: made, told of events, turned into triangles
#include "panel_parts.h"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>

static const float width_units = 290;  // of the panel

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

// ---------------------------------------------------------------- window

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
        changed |= panel_lights(panel, app, facts);
    }
    if (app->file.objects && ImGui::CollapsingHeader("Objects", ImGuiTreeNodeFlags_DefaultOpen))
        changed |= panel_objects(app, facts);
    if (ImGui::CollapsingHeader("Picture", ImGuiTreeNodeFlags_DefaultOpen))
        changed |= panel_picture(app);
    if (ImGui::CollapsingHeader("Glare", app->now.gaze.on ? ImGuiTreeNodeFlags_DefaultOpen : 0))
        changed |= panel_glare(app, facts);
    panel->histogram = ImGui::CollapsingHeader("Histogram");
    if (panel->histogram)
        panel_histogram(facts, panel->scale);
    if (ImGui::CollapsingHeader("File"))
        panel_file(facts);
    if (facts->message && facts->message[0])
        ImGui::TextWrapped("%s", facts->message);
    ImGui::PopItemWidth();
    ImGui::End();
    return changed;
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
        panel_handles(app, panel->scale);
    if (app->panel)
        panel->changed |= panel_window(panel, app, facts);
    if (app->inspect)
        panel_inspector(app, facts, panel->scale);
    if (app->help)
        panel_help(app, panel->scale);
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

// panel.cpp - Dear ImGui: made, fed with events, turned into triangles
#include "panel/panel.h"

#include "panel/panel_parts.h"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>

static const float width_units = 290;  // of the panel
static const float margin_units = 8;
static const float row_units = 19;

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
    for (int i = 0; i < 6; i++)
        io.KeyMap[ImGuiKey_A + i] = "acvxyz"[i];
}

// Rows are equally high with any font.
static void set_style(float scale, float letters)
{
    ImGuiStyle &style = ImGui::GetStyle();
    ImGui::StyleColorsDark();
    style.WindowPadding = ImVec2(margin_units, margin_units);
    style.FramePadding = ImVec2(5, 0.5f * (row_units - letters));
    style.ItemSpacing = ImVec2(6, 4);
    style.ItemInnerSpacing = ImVec2(5, 4);
    style.WindowRounding = 4;
    style.FrameRounding = 3;
    style.GrabRounding = 3;
    style.Colors[ImGuiCol_WindowBg].w = 0.88f;
    style.ScaleAllSizes(scale);
}

extern "C" relume_status panel_create(struct panel **out, double scale, const char *font)
{
    *out = new (std::nothrow) panel();
    if (!*out)
        return RELUME_ENOMEM;
    panel *p = *out;
    p->scale = (float)std::clamp(scale, PANEL_SCALE_LEAST, PANEL_SCALE_MOST);
    p->context = ImGui::CreateContext();
    ImGui::SetCurrentContext(p->context);
    ImGuiIO &io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;  // as collect_runs has them
    io.MousePos = ImVec2(-FLT_MAX, -FLT_MAX);
    p->has_font = font && panel_add_font(font, p->scale);
    if (!p->has_font)
        panel_add_plain_font(p->scale);
    map_keys(io);
    set_style(p->scale, io.Fonts->ConfigData[0].SizePixels / p->scale);
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

// What scrolls explains itself.
extern "C" bool panel_is_mute(const struct panel *panel)
{
    const ImGuiID id = panel->context->HoveredId;
    ImGui::SetCurrentContext(panel->context);
    for (ImGuiWindow *w : panel->context->Windows)
        if (w->Active && (w->Flags & ImGuiWindowFlags_Tooltip ||
                          id == ImGui::GetWindowScrollbarID(w, ImGuiAxis_Y)))
            return false;
    return id != 0;
}

extern "C" bool panel_has_font(const struct panel *panel)
{
    return panel->has_font;
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

// Keys that are meant for the viewer also while a field is written into.
static bool always_of_app(int key)
{
    return key == APP_KEY_F11 || (key & APP_CONTROL && std::strchr("oqs", key & ~APP_CONTROL));
}

// A list or a colour that is being chosen goes away by Esc.
static bool closes_popup(panel *panel, const app_event *event)
{
    if (event->kind != APP_KEY_DOWN || event->key != APP_KEY_ESCAPE ||
        !panel->context->OpenPopupStack.Size)
        return false;
    ImGui::SetCurrentContext(panel->context);
    ImGui::ClosePopupToLevel(0, false);
    return true;
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
        if (closes_popup(panel, event))
            return true;
        takes = typing && !always_of_app(event->key) &&
                !(panel->browsing && event->key == APP_KEY_ESCAPE);
        break;
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
    return app->panel || app->help || app->inspect || app->gizmos || app->reflects || app->noting ||
           app->asks || app->recording || app->browse || app->file.empty || app->picks_focus ||
           app->toast_s > 0 || app->hint_s > 0;
}

static void feed_imgui(const app_event &e)
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
    if (e.kind == APP_KEY_DOWN)
        io.KeyCtrl = e.key & APP_CONTROL;
    if (e.kind == APP_KEY_DOWN || e.kind == APP_KEY_UP)
        io.KeysDown[e.key & ~APP_CONTROL] = e.kind == APP_KEY_DOWN;
}

// ---------------------------------------------------------------- window

// Over the picture, as high as it needs, or beside the frame; false where there is no room.
static bool place_window(const panel *panel, const app *app)
{
    const float margin = margin_units * panel->scale;
    const float all = (float)app_window_width(app);
    const float width = std::min(width_units * panel->scale, all - 2 * margin);
    const float height = (float)app->height - 2 * margin;
    if (width < 40 || height < 40)
        return false;
    const bool docked = app->beside[0] || app->beside[1];
    const bool right = docked ? app->beside[1] > 0 : app->dock == APP_DOCK_RIGHT;
    ImGui::SetNextWindowPos(ImVec2(right ? all - width - margin : margin, margin));
    ImGui::SetNextWindowSizeConstraints(ImVec2(width, docked ? height : 0), ImVec2(width, height));
    return true;
}

static bool dock_row(app *app)
{
    static const char *const names[APP_DOCKS] = {"over the picture", "left", "right"};
    int dock = app->dock;
    for (int i = 0; i < APP_DOCKS; i++) {
        if (i)
            ImGui::SameLine();
        ImGui::RadioButton(names[i], &dock, i);
        panel_tip("place of this panel");
    }
    const bool changed = dock != app->dock;
    app->dock = (app_dock)dock;
    app_arrange(app);
    return changed;
}

static bool section(const char *name, const char *what, bool open = true)
{
    const bool shown = ImGui::CollapsingHeader(name, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
    panel_tip(what);
    return shown;
}

static bool sections(panel *panel, app *app, const panel_facts *facts)
{
    bool changed = false;
    if (app->noting && section("Notes", "notes and measures on the picture (Ctrl+N)"))
        changed |= panel_jottings(panel, app);
    if (section("Lights", "the lights: direction, place, colour and brightness"))
        changed |= panel_lights(panel, app, facts);
    if (app->file.objects && section("Objects", "the materials of the objects"))
        changed |= panel_objects(app, facts);
    if (way_matters(app) &&
        section("Light between objects and scene", "how light goes from one to the other"))
        changed |= panel_ways(app, facts);
    if (facts->reflections &&
        section("Reflections", "edit what mirrors reflect, by hand", app->reflects))
        panel_reflections(panel, app, facts);
    if (facts->edits && section("Edits", "change the material; the file stays as it is"))
        panel_edits(panel, app, facts);
    if (section("Picture", "exposure, tone, what is shown, saving and recording"))
        changed |= panel_picture(app, facts);
    if (section("Camera", "viewpoint, zoom and focus", false))
        changed |= panel_camera(app);
    if (section("Glare", "the picture as a human eye sees it", app->now.observer.on))
        changed |= panel_glare(app, facts);
    panel->histogram =
        section("Histogram", "how often each brightness occurs in the picture", false);
    if (panel->histogram)
        panel_histogram(facts, panel->scale);
    if (section("File", "what the file holds; open another one", false))
        panel_file(app, facts);
    if (section("Panel", "place of this panel", false))
        changed |= dock_row(app);
    return changed;
}

static bool panel_window(panel *panel, app *app, const panel_facts *facts)
{
    if (!place_window(panel, app))
        return false;
    ImGui::Begin("relume", nullptr,
                 ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoTitleBar |
                     ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::PushItemWidth(-ImGui::CalcTextSize("environment").x -  // the longest label
                         ImGui::GetStyle().ItemInnerSpacing.x);
    const bool changed = sections(panel, app, facts);
    if (facts->message && facts->message[0])
        ImGui::TextWrapped("%s", facts->message);
    ImGui::PopItemWidth();
    ImGui::End();
    return changed;
}

// ---------------------------------------------------------------- frame

// `shown`: it is the one that people see, and not only hears of events.
static void one_frame(panel *panel, app *app, const panel_facts *facts, bool shown)
{
    ImGuiIO &io = ImGui::GetIO();
    io.DisplaySize = ImVec2((float)app_window_width(app), (float)app->height);
    io.DeltaTime = 1.0f / 60;
    ImGui::NewFrame();
    panel->histogram = false;
    if (app->gizmos)
        panel_handles(app, panel->scale);
    if (app->reflects)
        panel_reflection_handles(app, panel->scale);
    if (app->noting && shown)
        panel_jotted(app, panel->scale);
    if (app->file.empty && !app->browse)
        panel_start(app, panel->scale);
    if (app->panel && !app->file.empty)
        panel->changed |= panel_window(panel, app, facts);
    if (app->inspect)
        panel_inspector(app, facts, panel->scale);
    if (app->help)
        panel_help(app, panel->scale);
    panel_notes(app, facts, panel->scale);
    panel->browsing = app->browse && facts->browser;
    if (panel->browsing)
        panel_browse(panel, app, facts->browser);
    if (app->asks)
        panel_question(app, panel->scale);
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
            run.vertex =
                reinterpret_cast<const panel_vertex *>(list->VtxBuffer.Data) + cmd.VtxOffset;
            run.index = list->IdxBuffer.Data;
            run.vertices = list->VtxBuffer.Size - (int)cmd.VtxOffset;
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
// more: new windows find their size in the first and are seen in the second. A field that has just
// got the keys knows it in the third.
extern "C" bool panel_build(struct panel *panel, struct app *app, const struct panel_facts *facts)
{
    ImGui::SetCurrentContext(panel->context);
    const bool browsed = panel->browsing;
    panel->changed = false;
    for (const app_event &e : panel->queue) {
        feed_imgui(e);
        one_frame(panel, app, facts, false);
    }
    panel->queue.clear();
    one_frame(panel, app, facts, false);
    one_frame(panel, app, facts, panel->browsing == browsed);
    if (panel->browsing != browsed)
        one_frame(panel, app, facts, true);
    collect_runs(panel);
    return panel->changed;
}

extern "C" int panel_width(const struct panel *panel)
{
    return (int)std::ceil((width_units + 2 * margin_units) * panel->scale);
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

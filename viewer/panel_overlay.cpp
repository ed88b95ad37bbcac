// panel_overlay.cpp - what is drawn over the picture: keys, handles of lights, the inspector
#include "panel_parts.h"

void panel_help(const app *app, float scale)
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

void panel_handles(const app *app, float scale)
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

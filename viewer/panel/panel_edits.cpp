// panel_edits.cpp - edits of a g-BRDF: gloss, colour, a drawing in its relief, back and forth
#include "panel/panel_parts.h"

#include <cstdarg>
#include <cstdio>

__attribute__((format(printf, 2, 3))) static void wish_edit(app *app, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    std::vsnprintf(app->spec, sizeof app->spec, format, args);
    va_end(args);
    app->wish = APP_WISH_EDIT;
}

static std::string label_of(const panel *panel)
{
    return panel->label ? " label " + std::to_string(panel->label - 1) : "";
}

static void gloss_and_colour(panel *panel, app *app, const panel_facts *facts)
{
    std::string text;
    panel_choice(
        "material", &panel->label, facts->edited_materials + 1,
        [&](int i) {
            text = i ? "material " + std::to_string(i - 1) : "all materials";
            return text.c_str();
        },
        "what gloss and tint are changed of");
    panel_slider("gloss", &panel->roughness, 0.1, 10, "roughness x %.2f",
                 "what the roughness is multiplied by: below 1 it is glossier",
                 ImGuiSliderFlags_Logarithmic);
    ImGui::ColorEdit3("tint", panel->tint,
                      ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_Float |
                          ImGuiColorEditFlags_NoTooltip);
    panel_tip("what the colours are multiplied by");
    ImGui::SameLine();
    if (panel_button("apply gloss", "multiply the roughness"))
        wish_edit(app, "roughness %.4g%s", panel->roughness, label_of(panel).c_str());
    ImGui::SameLine();
    if (panel_button("apply tint", "multiply the colours"))
        wish_edit(app, "tint %.4g,%.4g,%.4g%s", (double)panel->tint[0], (double)panel->tint[1],
                  (double)panel->tint[2], label_of(panel).c_str());
}

static void relief(panel *panel, app *app)
{
    ImGui::InputTextWithHint("##drawing", "drawing.png", panel->drawing, sizeof panel->drawing);
    panel_tip("a grey picture: white is raised or sunk");
    panel_slider("relief", &panel->relief, 0.001, 0.2, "%.3f",
                 "how far white is raised or sunk, in widths of the sample",
                 ImGuiSliderFlags_Logarithmic);
    if (panel_button("emboss", "raise the drawing"))
        wish_edit(app, "emboss \"%.4000s\" height %.4g", panel->drawing, panel->relief);
    ImGui::SameLine();
    if (panel_button("engrave", "sink the drawing"))
        wish_edit(app, "engrave \"%.4000s\" height %.4g", panel->drawing, panel->relief);
    ImGui::SameLine();
}

void panel_edits(panel *panel, app *app, const panel_facts *facts)
{
    gloss_and_colour(panel, app, facts);
    relief(panel, app);
    if (panel_button("undo", "undo the last edit"))
        wish_edit(app, "undo");
    ImGui::SameLine();
    if (panel_button("redo", "redo the last edit that was undone"))
        wish_edit(app, "redo");
    ImGui::TextUnformatted(facts->edits);
}

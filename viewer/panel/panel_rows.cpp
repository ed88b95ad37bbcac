// panel_rows.cpp - the controls that the panel is made of, each with a tip of what it is for
#include "panel/panel_parts.h"

#include <algorithm>
#include <cmath>

// Not in the way of what is being dragged.
void panel_tip(const char *text)
{
    const bool dragged = ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left);
    if (!ImGui::IsItemHovered() || dragged)
        return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(22 * ImGui::GetFontSize());
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

bool panel_button(const char *label, const char *what)
{
    const bool pressed = ImGui::Button(label);
    panel_tip(what);
    return pressed;
}

bool panel_box(const char *label, bool *on, const char *what)
{
    const bool changed = ImGui::Checkbox(label, on);
    panel_tip(what);
    return changed;
}

bool panel_slider(const char *label, double *value, double least, double most, const char *format,
                  const char *what, ImGuiSliderFlags flags)
{
    double now = *value;
    const bool moved =
        ImGui::SliderScalar(label, ImGuiDataType_Double, &now, &least, &most, format, flags);
    panel_tip(what);
    if (!moved || !std::isfinite(now))
        return false;
    *value = std::clamp(now, least, most);  // typed values may lie beyond
    return true;
}

bool panel_choice(const char *label, int *chosen, int count,
                  const std::function<const char *(int)> &name, const char *what)
{
    bool changed = false;
    const bool open = ImGui::BeginCombo(label, name(*chosen));
    if (!open)
        panel_tip(what);
    for (int i = 0; open && i < count; i++) {
        ImGui::PushID(i);
        if (ImGui::Selectable(name(i), i == *chosen)) {
            *chosen = i;
            changed = true;
        }
        ImGui::PopID();
    }
    if (open)
        ImGui::EndCombo();
    return changed;
}

// panel_edits.cpp - edits of a g-BRDF or of maps: an operation, what it takes, back and forth
#include "panel/panel_parts.h"

extern "C" {
#include "material/gbrdf/edit_table.h"

#include <relume/material/edit.h>
}

#include <cstdio>
#include <cstring>

static void ask_edit(app *app, const std::string &words)
{
    std::snprintf(app->spec, sizeof app->spec, "%s", words.c_str());
    app->action = APP_ACTION_EDIT;
}

// ---------------------------------------------------------------- controls

// Each draws what one kind of parameter takes, and says it in words; "": as it is by default.
using taking = std::string(panel_edit *edit, const panel_facts *facts);

static std::string words_of(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

static std::string words_of(const float *value)
{
    return words_of((double)value[0]) + "," + words_of((double)value[1]) + "," +
           words_of((double)value[2]);
}

static std::string take_picture(char *path, size_t size, const char *label, const char *hint,
                                const char *what)
{
    ImGui::InputTextWithHint(label, hint, path, size);
    panel_tip(what);
    return path[0] ? "\"" + std::string(path) + "\"" : "";
}

static std::string take_drawing(panel_edit *edit, const panel_facts *)
{
    return take_picture(edit->drawing, sizeof edit->drawing, "drawing", "drawing.png",
                        "a grey picture: white is raised or sunk");
}

static std::string take_mask(panel_edit *edit, const panel_facts *)
{
    return take_picture(edit->mask, sizeof edit->mask, "mask", "everywhere",
                        "a grey picture, stretched over the material: it is changed where this is "
                        "white");
}

static std::string slide(const char *label, double *value, double least, double most,
                         const char *format, const char *what, ImGuiSliderFlags flags = 0)
{
    (void)panel_slider(label, value, least, most, format, what, flags);
    return words_of(*value);
}

static std::string take_height(panel_edit *edit, const panel_facts *)
{
    return slide("height", &edit->height, 0.001, 0.2, "%.3f",
                 "how far white is raised or sunk, in widths of the material",
                 ImGuiSliderFlags_Logarithmic);
}

static std::string take_place(panel_edit *edit, const panel_facts *)
{
    const std::string across =
        slide("across", &edit->at[0], 0, 1, "%.2f", "the middle of the drawing, from the left");
    return across + "," +
           slide("down", &edit->at[1], 0, 1, "%.2f", "the middle of the drawing, from the top");
}

static std::string take_size(panel_edit *edit, const panel_facts *)
{
    return slide("size", &edit->size, 0.01, 1, "%.2f",
                 "how wide the drawing is, in widths of the material");
}

static std::string take_factor(panel_edit *edit, const panel_facts *)
{
    return slide("gloss", &edit->factor, 0.1, 10, "roughness x %.2f",
                 "what the roughness is multiplied by: below 1 it is glossier",
                 ImGuiSliderFlags_Logarithmic);
}

static std::string take_colour(const char *label, float value[3], const char *what)
{
    ImGui::ColorEdit3(label, value,
                      ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_Float |
                          ImGuiColorEditFlags_NoTooltip);
    panel_tip(what);
    return words_of(value);
}

static std::string take_factors(panel_edit *edit, const panel_facts *)
{
    return take_colour("tint", edit->factors, "what the colours are multiplied by");
}

static std::string take_highlight(panel_edit *edit, const panel_facts *)
{
    return take_colour("highlight", edit->highlight, "the colour of what shines");
}

static std::string take_diffuse(panel_edit *edit, const panel_facts *)
{
    (void)panel_box("own colour", &edit->coloured, "else that of the place stays");
    if (!edit->coloured)
        return "";
    ImGui::SameLine();
    return take_colour("##colour", edit->colour, "the diffuse colour; black for a metal");
}

static std::string take_channels(panel_edit *edit, const panel_facts *)
{
    static const char *const orders[] = {"GBR", "BRG", "RBG", "GRB", "BGR"};
    (void)panel_choice(
        "channels", &edit->order, (int)(sizeof orders / sizeof *orders),
        [](int i) { return orders[i]; }, "red, green and blue become these of the old ones");
    return orders[edit->order];
}

static int choose_label(const char *name, int *label, const panel_facts *facts, bool all,
                        const char *what)
{
    std::string text;
    const int first = all ? 0 : 1;
    int chosen = std::min(*label, facts->edited_materials) - first;
    chosen = std::max(chosen, 0);
    (void)panel_choice(
        name, &chosen, facts->edited_materials + 1 - first,
        [&](int i) {
            text = i + first ? "material " + std::to_string(i + first - 1) : "all materials";
            return text.c_str();
        },
        what);
    *label = chosen + first;
    return *label - 1;
}

static std::string take_label(panel_edit *edit, const panel_facts *facts)
{
    const int label = choose_label("material", &edit->label, facts, true, "what is changed");
    return label < 0 ? "" : std::to_string(label);
}

static std::string take_labels(panel_edit *edit, const panel_facts *facts)
{
    const int a = choose_label("this", &edit->labels[0], facts, false, "takes the other's place");
    const int b = choose_label("and this", &edit->labels[1], facts, false, "takes its place");
    return std::to_string(a) + "," + std::to_string(b);
}

static std::string take_degrees(panel_edit *edit, const panel_facts *)
{
    return slide("turn", &edit->degrees, -180, 180, "%.0f deg", "counter-clockwise");
}

static std::string take_roughness(panel_edit *edit, const panel_facts *)
{
    return slide("roughness", &edit->roughness, 0.1, 1, "%.2f", "of glTF: 1 is matte");
}

static std::string take_r0(panel_edit *edit, const panel_facts *)
{
    return slide("mirror", &edit->r0, 0, 1, "%.2f",
                 "the reflectance where one looks straight at it: 0.04 of plastics, 0.9 of metals");
}

static const struct {
    const char *name;  // as relume_edit_operation_parameter
    taking *take;
} controls[] = {
    {"drawing", take_drawing},     {"mask", take_mask},
    {"height", take_height},       {"at", take_place},
    {"size", take_size},           {"factor", take_factor},
    {"factors", take_factors},     {"degrees", take_degrees},
    {"roughness", take_roughness}, {"r0", take_r0},
    {"colour", take_diffuse},      {"highlight", take_highlight},
    {"channels", take_channels},   {"labels", take_labels},
    {"label", take_label},
};

// ---------------------------------------------------------------- section

static std::string words_of(panel_edit *edit, const panel_facts *facts,
                            const relume_edit_operation *operation)
{
    std::string words = relume_edit_operation_name(operation);
    const char *name;
    for (int i = 0; (name = relume_edit_operation_parameter(operation, i)); i++)
        for (const auto &control : controls) {
            if (std::strcmp(control.name, name) ||
                (facts->edits_maps && control.take == take_label))
                continue;
            const std::string value = control.take(edit, facts);
            if (i == 0)
                words += " " + (value.empty() ? std::string("\"\"") : value);
            else if (!value.empty())
                words += std::string(" ") + name + " " + value;
        }
    return words;
}

void panel_edits(panel *panel, app *app, const panel_facts *facts)
{
    std::vector<const relume_edit_operation *> operations;
    for (int i = 0; relume_edit_operations[i]; i++)
        if (!facts->edits_maps || relume_edit_operation_on_maps(relume_edit_operations[i]))
            operations.push_back(relume_edit_operations[i]);
    panel_edit *edit = &panel->edit;
    edit->operation = std::min(edit->operation, (int)operations.size() - 1);
    (void)panel_choice(
        "edit", &edit->operation, (int)operations.size(),
        [&](int i) { return relume_edit_operation_name(operations[(size_t)i]); },
        relume_edit_operation_summary(operations[(size_t)edit->operation]));
    const std::string words = words_of(edit, facts, operations[(size_t)edit->operation]);
    if (panel_button("apply##edit", "do it; the file stays as it is"))
        ask_edit(app, words);
    ImGui::SameLine();
    if (panel_button("undo##edit", "undo the last edit"))
        ask_edit(app, "undo");
    ImGui::SameLine();
    if (panel_button("redo##edit", "redo the last edit that was undone"))
        ask_edit(app, "redo");
    ImGui::TextWrapped("%s", facts->edits);
    if (!facts->edits_maps)
        return;
    ImGui::InputTextWithHint("##folder", "new folder", edit->folder, sizeof edit->folder);
    panel_tip("the folder that the edited maps are written to, with glTF and MaterialX");
    ImGui::SameLine();
    if (panel_button("write", "write the edited maps; those that are shown stay as they are"))
        ask_edit(app, "write \"" + std::string(edit->folder) + "\"");
}

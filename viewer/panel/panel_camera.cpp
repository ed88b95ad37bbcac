// panel_camera.cpp - the panel's parts with sliders: where the eye is, what is sharp, how strongly
// a view is enhanced
#include "panel/panel_parts.h"

extern "C" {
#include "app/orbit.h"
#include "relight/normals/enhance.h"
}

#include <algorithm>
#include <cmath>
#include <relume/core/vec.h>

static bool float_slider(const char *label, float *value, float usual, float least, float most,
                         const char *format, const char *what)
{
    double now = (double)(*value != 0 ? *value : usual);
    if (!panel_slider(label, &now, (double)least, (double)most, format, what,
                      ImGuiSliderFlags_Logarithmic))
        return false;
    *value = (float)now;
    return true;
}

// ---------------------------------------------------------------- enhancement

static bool range_rows(relume_pass_params *p, const panel_facts *facts)
{
    bool automatic = !(p->top > p->low);
    bool changed = panel_box(
        "range from the picture", &automatic,
        "covers the picture without its darkest and brightest 1 % and without the background");
    if (changed) {
        p->low = automatic ? 0 : facts->range[0];
        p->top = automatic ? 0 : facts->range[1];
    }
    if (automatic) {
        ImGui::Text("blue %.3g, yellow %.3g", (double)facts->range[0], (double)facts->range[1]);
        return changed;
    }
    const float speed = 0.005f * (p->top - p->low);
    float ends[2] = {p->low, p->top};
    if (ImGui::DragFloat2("blue, yellow", ends, speed, 0, 1e6f, "%.4g") && ends[0] < ends[1]) {
        p->low = ends[0];
        p->top = ends[1];
        changed = true;
    }
    panel_tip("linear luminance shown as dark blue, and as yellow");
    return changed;
}

bool panel_enhancement(app *app, const panel_facts *facts)
{
    relume_pass_params *p = &app->now.enhance;
    bool changed = false;
    switch (app->now.pass) {
    case RELUME_PASS_SPECULAR:
        changed |= float_slider(
            "highlight", &p->specular, 0.6f, 0.01f, 10, "%.2f",
            "how bright the highlight is, compared with the brightest parts of the picture");
        changed |= float_slider("exponent", &p->exponent, 40, 1, 1000, "%.0f",
                                "how narrow the highlight is: 1 matt, 1000 like a mirror");
        break;
    case RELUME_PASS_DIFFUSE_GAIN:
        changed |= float_slider("gain", &p->gain, RELUME_PASS_GAIN, 1, 20, "%.1f times",
                                "strengthens the shading of fine relief; 1 changes nothing");
        break;
    case RELUME_PASS_UNSHARP: {
        double radius = p->radius > 0 ? p->radius : 4;
        changed |= float_slider("gain", &p->gain, RELUME_PASS_GAIN, 1, 20, "%.1f times",
                                "strength of the sharpening");
        if (panel_slider("radius", &radius, 1, 64, "%.0f pixels", "sharpens detail finer than this",
                         ImGuiSliderFlags_Logarithmic)) {
            p->radius = (int)std::lround(radius);
            changed = true;
        }
        break;
    }
    case RELUME_PASS_FALSE_COLOUR: changed |= range_rows(p, facts); break;
    default: break;
    }
    return changed;
}

// ---------------------------------------------------------------- the eye

static double distance_of(const app *app)
{
    const relume_vec3 eye = app->now.camera.eye, m = app_middle(app);
    return orbit_is(app) ? relume_vec3_length(relume_vec3_sub(eye, m))
                         : eye.z - app->file.geometry.st_z;
}

static bool distance_row(app *app)
{
    const double now = distance_of(app);
    double wanted = now;
    if (!panel_slider("distance", &wanted, 0.05 * now, 20 * now, "%.3g",
                      "from the eye to the object, world units; also by [ and ]",
                      ImGuiSliderFlags_Logarithmic))
        return false;
    app_dolly(app, wanted / now);
    return true;
}

static bool lens_rows(app *app)
{
    const app_file *f = &app->file;
    app_state *s = &app->now;
    const double extent = std::max(f->uv_max[0] - f->uv_min[0], f->uv_max[1] - f->uv_min[1]);
    const double away = distance_of(app);
    const double plane = orbit_is(app) ? 0 : f->geometry.st_z;
    const double least = plane - 4 * std::fabs(away), most = plane + 0.9 * std::fabs(away);
    bool changed = panel_slider("aperture", &s->aperture, 0, extent > 0 ? extent : away, "%.3g",
                                "width of the lens, world units: 0 is sharp everywhere; also by A");
    changed |= panel_slider("focus", &s->focus_z, least, most, "%.3g",
                            orbit_is(app)
                                ? "distance from the middle to the plane in focus, world units"
                                : "height z of the plane in focus, world units; also by , and .");
    if (panel_button(app->picks_focus ? "now click in the picture" : "focus by a click (F)",
                     "then click on what should be sharp"))
        (void)keys_press(app, 'f', false);
    return changed;
}

static bool slab_rows(app *app)
{
    const app_file *f = &app->file;
    relume_vec3 *eye = &app->now.camera.eye;
    bool changed = false;
    if (!orbit_is(app)) {
        changed |= panel_slider("eye x", &eye->x, f->uv_min[0], f->uv_max[0], "%.3f",
                                "to the right, world units");
        changed |= panel_slider("eye y", &eye->y, f->uv_min[1], f->uv_max[1], "%.3f",
                                "upwards, world units");
    }
    changed |= distance_row(app);
    return changed | lens_rows(app);
}

static bool look_rows(app *app)
{
    relume_pan_tilt *look = &app->now.camera.look;
    double pan = look->pan_deg, tilt = look->tilt_deg;
    bool changed = panel_slider("pan", &pan, -180, 180, "%.1f deg", "to the right");
    changed |= panel_slider("tilt", &tilt, -90, 90, "%.1f deg", "upwards");
    look->pan_deg = pan;
    look->tilt_deg = tilt;
    return changed | panel_slider("zoom", &look->zoom, 0.3, 50, "%.2f times",
                                  "1 shows 90 degrees across; also by the wheel",
                                  ImGuiSliderFlags_Logarithmic);
}

static bool picture_rows(app *app)
{
    app_state *s = &app->now;
    bool changed =
        panel_slider("zoom", &s->zoom, 0.1, 64, "%.2f times",
                     "1 fits the window; also by the wheel", ImGuiSliderFlags_Logarithmic);
    if (panel_button("fit the window", "show the whole picture, in the middle")) {
        s->zoom = 1;
        s->shift[0] = s->shift[1] = 0;
        changed = true;
    }
    return changed;
}

bool panel_camera(app *app)
{
    switch (app->now.camera.framing) {
    case RELUME_FRAME_EYE: return slab_rows(app);
    case RELUME_FRAME_LOOK: return look_rows(app);
    default: return picture_rows(app);
    }
}

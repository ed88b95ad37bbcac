// keys.c - what every key does: one table, for the app and for the list of keys that it shows
#include "app/keys.h"

#include "app/app.h"
#include "app/handles.h"
#include "app/handles_say.h"
#include "app/light_list.h"
#include "app/notes.h"
#include "app/orbit.h"
#include "app/way.h"
#include "relight/view/slab_set.h"
#include "world/object/drawn_objects.h"

#include <relume/relight/tone.h>

#include <math.h>

static const double exposure_step = 0.25;  // EV
static const double dolly_factor = 1.05;   // of the eye's distance
static const double walk_step = 0.05;      // of its distance
static const double focus_factor = 1.02;   // of the distance from the cameras
static const double planet_zoom = 0.5;
static const double stop_step = 0.25;  // of a light's value
static const double turn_step = 3.0;   // degrees of a light

static bool press_quit(struct app *app, int key)
{
    (void)key;
    app->quit = true;
    return false;
}

// Closes what was opened last; with nothing open it asks whether to quit. A recording ends before
// the app hears of the key.
static bool press_escape(struct app *app, int key)
{
    bool *const open[] = {&app->asks,    &app->browse,   &app->help,   &app->picks_focus,
                          &app->inspect, &app->reflects, &app->noting, &app->panel};
    (void)key;
    if (app->noting && app->notes->places) {
        app->notes->places = 0;
        return true;
    }
    for (size_t i = 0; i < sizeof open / sizeof *open; i++)
        if (*open[i]) {
            *open[i] = false;
            return true;
        }
    app->asks = true;
    return true;
}

static bool press_enter(struct app *app, int key)
{
    (void)key;
    app->quit |= app->asks;
    return !app->asks && app->noting && notes_finish(app);
}

static bool press_panel(struct app *app, int key)
{
    (void)key;
    app->panel = !app->panel;
    return true;
}

static bool press_help(struct app *app, int key)
{
    (void)key;
    app->help = !app->help;
    return true;
}

static bool press_reset(struct app *app, int key)
{
    (void)key;
    app_reset(app);
    return true;
}

static bool press_hold_light(struct app *app, int key)
{
    (void)key;
    app->light_key = true;
    return false;
}

static bool press_ball(struct app *app, int key)
{
    (void)key;
    app->now.ball = !app->now.ball;
    return true;
}

static bool press_gizmos(struct app *app, int key)
{
    (void)key;
    app->gizmos = !app->gizmos;
    return true;
}

static bool press_inspect(struct app *app, int key)
{
    (void)key;
    app->inspect = !app->inspect;
    return true;
}

static bool press_magnify(struct app *app, int key)
{
    (void)key;
    if (!app->inspect)
        return false;
    app->inspect_zoom = app->inspect_zoom < 1    ? 2
                        : app->inspect_zoom < 16 ? 2 * app->inspect_zoom
                                                 : 1;
    return true;
}

static bool press_exposure(struct app *app, int key)
{
    app->now.exposure_ev += key == '+' ? exposure_step : -exposure_step;
    return true;
}

static bool press_dolly(struct app *app, int key)
{
    if (app->now.camera.framing != RELUME_FRAME_EYE)
        return false;
    app_dolly(app, key == '[' ? 1 / dolly_factor : dolly_factor);
    return true;
}

static bool press_walk(struct app *app, int key)
{
    const int way = key & ~APP_CONTROL;
    if (!app->file.scene)
        return false;
    if (way == APP_KEY_LEFT || way == APP_KEY_RIGHT)
        orbit_walk(app, way == APP_KEY_RIGHT ? walk_step : -walk_step, 0);
    else
        orbit_walk(app, 0, way == APP_KEY_UP_ARROW ? walk_step : -walk_step);
    return true;
}

static bool press_tone(struct app *app, int key)
{
    (void)key;
    app->now.tone = relume_tones[app->now.tone + 1] ? app->now.tone + 1 : 0;
    return true;
}

static bool press_auto_exposure(struct app *app, int key)
{
    (void)key;
    app->now.auto_exposure = !app->now.auto_exposure;
    app->adapted_ev = app->metered_ev = 0;
    app->metered = true;
    return true;
}

static bool press_planet(struct app *app, int key)
{
    struct relume_pan_tilt *look = &app->now.camera.look;
    (void)key;
    if (app->now.camera.framing != RELUME_FRAME_LOOK)
        return false;
    app_stand_still(app);
    if (look->stereographic) {
        *look = app->before_planet;
        return true;
    }
    app->before_planet = *look;
    *look = (struct relume_pan_tilt){look->pan_deg, -90, planet_zoom, true};
    return true;
}

// By depth or linear, whichever is the default, then linear, then the nearest camera.
static bool press_interpolation(struct app *app, int key)
{
    enum relume_interpolation *i = &app->now.interpolation;
    (void)key;
    if (app->now.camera.framing != RELUME_FRAME_EYE)
        return false;
    *i = *i == RELUME_INTERPOLATE_LINEAR     ? RELUME_INTERPOLATE_CONSTANT
         : *i == RELUME_INTERPOLATE_CONSTANT ? RELUME_INTERPOLATE_DEFAULT
                                             : RELUME_INTERPOLATE_LINEAR;
    return true;
}

// None, then an eighth, a quarter, a half and all of the cameras' extent.
static bool press_aperture(struct app *app, int key)
{
    const struct app_file *f = &app->file;
    const double most = fmax(f->uv_max[0] - f->uv_min[0], f->uv_max[1] - f->uv_min[1]);
    double *a = &app->now.aperture;
    (void)key;
    if (app->now.camera.framing != RELUME_FRAME_EYE)
        return false;
    *a = *a <= 0 ? most / 8 : *a < 0.75 * most ? *a * 2 : 0;
    return true;
}

static bool press_focus(struct app *app, int key)
{
    const struct relume_geometry *g = &app->file.geometry;
    struct relume_window window;
    double *z = &app->now.focus_z;
    if (app->now.camera.framing != RELUME_FRAME_EYE ||
        (app->file.around && !app_window(app, &window)))
        return false;
    const double from = app->file.around ? relume_window_distance(&window) : g->uv_z;
    *z = from + (*z - from) * (key == '.' ? focus_factor : 1 / focus_factor);
    return true;
}

static bool press_pick_focus(struct app *app, int key)
{
    (void)key;
    app->picks_focus = !app->picks_focus && app->now.camera.framing == RELUME_FRAME_EYE;
    return true;
}

static bool press_glare(struct app *app, int key)
{
    (void)key;
    app->now.observer.on = !app->now.observer.on;
    return true;
}

static bool press_next_pass(struct app *app, int key)
{
    (void)key;
    app->now.pass = (enum relume_pass)((app->now.pass + 1) % app_passes(app));
    return true;
}

// ---------------------------------------------------------------- objects

static int next_material(const struct app *app, int material)
{
    return (material + 1) % relume_objects_info(app->file.objects)->materials;
}

// All parts go on to the material after that of the first.
static bool press_material(struct app *app, int key)
{
    (void)key;
    if (!app->file.objects)
        return false;
    const struct relume_objects_info *info = relume_objects_info(app->file.objects);
    const int next = next_material(app, info->part[0].material);
    way_let_go(app);
    for (int i = 0; i < info->parts; i++)
        (void)!relume_objects_choose(app->file.objects, i, next);
    return true;
}

static bool press_other(struct app *app, int key)
{
    (void)key;
    if (!app->file.objects)
        return false;
    app->now.other = next_material(app, app->now.other);
    return true;
}

static bool press_split(struct app *app, int key)
{
    (void)key;
    if (!app->file.objects)
        return false;
    // a material is compared with another one, not with itself
    const int shown = relume_objects_info(app->file.objects)->part[0].material;
    if (app->now.split == APP_SPLIT_NONE && app->now.other == shown)
        app->now.other = next_material(app, shown);
    app->now.split = (enum app_split)((app->now.split + 1) % APP_SPLITS);
    app->now.ways = APP_SPLIT_NONE;
    return true;
}

static bool press_way(struct app *app, int key)
{
    (void)key;
    if (!way_matters(app))
        return false;
    app->now.way = (app->now.way + 1) % way_count();
    return true;
}

static bool press_ways(struct app *app, int key)
{
    (void)key;
    if (!way_matters(app))
        return false;
    way_compare(app, (enum app_split)((app->now.ways + 1) % APP_SPLITS));
    return true;
}

static bool press_reflections(struct app *app, int key)
{
    (void)key;
    return handles_turn_on(app, !app->reflects);
}

static bool press_undo(struct app *app, int key)
{
    return app->reflects &&
           (key == (APP_CONTROL | 'z') ? handles_undo : handles_redo)(app->handles);
}

// ---------------------------------------------------------------- lights

static bool press_next_light(struct app *app, int key)
{
    (void)key;
    app->now.selected = (app->now.selected + 1) % app->now.lights;
    return true;
}

static bool press_add(struct app *app, int key)
{
    (void)key;
    const struct relume_light light = {.direction = app_frame_axes(app).back, .rgb = {1, 1, 1}};
    return light_list_add(&app->now, &light, -1);
}

static bool press_remove(struct app *app, int key)
{
    (void)key;
    if (app->noting && notes_take_back(app))
        return true;
    if (app->reflects && handles_remove(app->handles))
        return true;
    return light_list_remove(&app->now, app->now.selected);
}

static bool press_off(struct app *app, int key)
{
    (void)key;
    struct app_light_state *light = &app->now.light_state[app->now.selected];
    light->off = !light->off;
    return true;
}

static bool press_solo(struct app *app, int key)
{
    (void)key;
    struct app_light_state *light = &app->now.light_state[app->now.selected];
    light->solo = !light->solo;
    return true;
}

static bool press_stops(struct app *app, int key)
{
    app->now.light_state[app->now.selected].stops +=
        key == APP_KEY_PAGE_UP ? stop_step : -stop_step;
    return true;
}

static bool press_turn(struct app *app, int key)
{
    const double dx = (key == APP_KEY_RIGHT) - (key == APP_KEY_LEFT);
    const double dy = (key == APP_KEY_DOWN_ARROW) - (key == APP_KEY_UP_ARROW);
    app_turn_light(app, dx * turn_step, dy * turn_step);
    return true;
}

static bool press_preset(struct app *app, int key)
{
    app_arrange_lights(app, &light_presets[key - '1']);
    return true;
}

// ---------------------------------------------------------------- actions

static bool ask(struct app *app, enum app_action wanted)
{
    app->action = wanted;
    return false;
}

static bool press_png(struct app *app, int key)
{
    (void)key;
    return ask(app, APP_ACTION_PNG);
}

static bool press_exr(struct app *app, int key)
{
    (void)key;
    return ask(app, APP_ACTION_EXR);
}

static bool press_save_rig(struct app *app, int key)
{
    (void)key;
    return ask(app, APP_ACTION_SAVE_RIG);
}

static bool press_notes(struct app *app, int key)
{
    (void)key;
    return ask(app, APP_ACTION_NOTES);
}

static bool press_copy(struct app *app, int key)
{
    (void)key;
    return ask(app, APP_ACTION_COPY);
}

static bool press_sweep(struct app *app, int key)
{
    (void)key;
    return ask(app, APP_ACTION_SWEEP);
}

static bool press_turntable(struct app *app, int key)
{
    (void)key;
    return ask(app, APP_ACTION_TURNTABLE);
}

static bool press_full_screen(struct app *app, int key)
{
    (void)key;
    return ask(app, APP_ACTION_FULL_SCREEN);
}

static bool press_open(struct app *app, int key)
{
    (void)key;
    app->browse = !app->browse;
    app->spec[0] = '\0';
    (void)ask(app, app->browse ? APP_ACTION_FOLDER : APP_ACTION_NONE);
    return true;
}

// ---------------------------------------------------------------- table

const struct key_binding key_bindings[] = {
    {'?', "?", "show this list", press_help, false},
    {'/', NULL, NULL, press_help, false},
    {APP_KEY_TAB, "Tab", "open, close the panel", press_panel, false},
    {'+', "+ -", "brighter, darker (exposure)", press_exposure, true},
    {'-', NULL, NULL, press_exposure, true},
    {'e', "E", "automatic exposure", press_auto_exposure, false},
    {'t', "T", "next tone operator", press_tone, false},
    {'[', "[ ]", "slab: nearer, farther", press_dolly, true},
    {']', NULL, NULL, press_dolly, true},
    {APP_CONTROL | APP_KEY_LEFT, "Ctrl+arrows", "scene file: walk", press_walk, true},
    {APP_CONTROL | APP_KEY_RIGHT, NULL, NULL, press_walk, true},
    {APP_CONTROL | APP_KEY_UP_ARROW, NULL, NULL, press_walk, true},
    {APP_CONTROL | APP_KEY_DOWN_ARROW, NULL, NULL, press_walk, true},
    {'d', "D", "slab: next interpolation", press_interpolation, false},
    {'a', "A", "slab: next aperture", press_aperture, false},
    {',', ", .", "slab: focus nearer, farther", press_focus, true},
    {'.', NULL, NULL, press_focus, true},
    {'f', "F", "slab: focus on what is clicked next", press_pick_focus, false},
    {'o', "O", "panorama: little planet", press_planet, false},
    {'v', "V", "next pass: colour, normals, ...", press_next_pass, false},
    {'h', "H", "glare: halos, as a human eye sees them", press_glare, false},
    {'r', "R", "reset", press_reset, false},
    {'l', "L", "hold and drag: turn the light", press_hold_light, false},
    {APP_KEY_LEFT, "arrows", "turn the light", press_turn, true},
    {APP_KEY_RIGHT, NULL, NULL, press_turn, true},
    {APP_KEY_UP_ARROW, NULL, NULL, press_turn, true},
    {APP_KEY_DOWN_ARROW, NULL, NULL, press_turn, true},
    {APP_KEY_PAGE_UP, "Page up, down", "light: brighter, dimmer", press_stops, true},
    {APP_KEY_PAGE_DOWN, NULL, NULL, press_stops, true},
    {'n', "N", "next light", press_next_light, false},
    {'m', "M", "add a light", press_add, false},
    {APP_KEY_DELETE, "Delete", "remove the light", press_remove, false},
    {APP_KEY_BACKSPACE, NULL, NULL, press_remove, false},
    {'x', "X", "switch the light off, on", press_off, false},
    {'z', "Z", "this light alone (solo)", press_solo, false},
    {'1', "1 2 3", "light presets: raking, double raking, dome", press_preset, false},
    {'2', NULL, NULL, press_preset, false},
    {'3', NULL, NULL, press_preset, false},
    {'c', "C", "objects: next material", press_material, false},
    {'q', "Q", "objects: compare with another material, show the difference", press_split, false},
    {'u', "U", "objects: the next material to compare with", press_other, false},
    {APP_CONTROL | 't', "Ctrl+T", "objects: next way of light between them and the scene",
     press_way, false},
    {APP_CONTROL | 'd', "Ctrl+D", "objects: compare with another way, show the difference",
     press_ways, false},
    {APP_CONTROL | 'r', "Ctrl+R", "objects: edit what mirrors reflect", press_reflections, false},
    {APP_CONTROL | 'z', "Ctrl+Z Ctrl+Y", "undo, redo an edited reflection", press_undo, true},
    {APP_CONTROL | 'y', NULL, NULL, press_undo, true},
    {'b', "B", "show the light as a ball", press_ball, false},
    {'g', "G", "show handles of the lights in the picture", press_gizmos, false},
    {'i', "I", "inspector: the reflectance under the cursor", press_inspect, false},
    {'y', "Y", "inspector: zoom in around the light", press_magnify, false},
    {APP_CONTROL | 'o', "Ctrl+O", "open a file", press_open, false},
    {'s', "S or Ctrl+S", "save the picture, PNG", press_png, false},
    {APP_CONTROL | 's', NULL, NULL, press_png, false},
    {'p', "P", "save the picture, EXR", press_exr, false},
    {'w', "W", "save the lights as a rig file", press_save_rig, false},
    {APP_CONTROL | 'n', "Ctrl+N", "notes and measures on the picture", press_notes, false},
    {APP_CONTROL | 'c', "Ctrl+C", "copy light and eye, for --state and pages", press_copy, false},
    {'k', "K", "record a light sweep", press_sweep, false},
    {'j', "J", "record a turntable", press_turntable, false},
    {APP_KEY_F11, "F11", "full screen, and back", press_full_screen, false},
    {APP_KEY_ESCAPE, "Esc", "close what is open; then ask whether to quit", press_escape, false},
    {APP_KEY_ENTER, NULL, NULL, press_enter, false},
    {APP_CONTROL | 'q', "Ctrl+Q", "quit", press_quit, false},
    {0, NULL, NULL, NULL, false},
};

// Keys that have a meaning before a file is open.
static bool needs_no_file(int key)
{
    static const int keys[] = {
        '?', '/', APP_KEY_ESCAPE, APP_KEY_ENTER, APP_KEY_F11, APP_CONTROL | 'o', APP_CONTROL | 'q'};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (keys[i] == key)
            return true;
    return false;
}

// Whoever does something else stays.
bool keys_press(struct app *app, int key, bool repeat)
{
    const bool answered = app->asks && key != APP_KEY_ESCAPE && key != APP_KEY_ENTER;
    app->asks &= !answered;
    if (app->file.empty && !needs_no_file(key))
        return answered;
    for (const struct key_binding *b = key_bindings; b->key; b++)
        if (b->key == key)
            return ((b->repeats || !repeat) && b->press(app, key)) || answered;
    return answered;
}

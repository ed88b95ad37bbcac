#include "keys.h"

#include "lamps.h"

#include <math.h>

static const double exposure_step = 0.25;  // EV
static const double dolly_factor = 1.05;   // of the eye's distance
static const double stop_step = 0.25;      // of a light's value
static const double turn_step = 3.0;       // degrees of a light

static bool press_quit(struct app *app, int key)
{
    (void)key;
    app->quit = true;
    return false;
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
    app->now = app->start;
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

static bool press_next_pass(struct app *app, int key)
{
    (void)key;
    app->now.pass = (enum app_pass)((app->now.pass + 1) % APP_PASSES);
    return true;
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
    return lamps_add(&app->now, &light, -1);
}

static bool press_remove(struct app *app, int key)
{
    (void)key;
    return lamps_remove(&app->now, app->now.selected);
}

static bool press_off(struct app *app, int key)
{
    (void)key;
    struct app_lamp *lamp = &app->now.lamp[app->now.selected];
    lamp->off = !lamp->off;
    return true;
}

static bool press_solo(struct app *app, int key)
{
    (void)key;
    struct app_lamp *lamp = &app->now.lamp[app->now.selected];
    lamp->solo = !lamp->solo;
    return true;
}

static bool press_stops(struct app *app, int key)
{
    app->now.lamp[app->now.selected].stops += key == '.' ? stop_step : -stop_step;
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
    lamps_arrange(&app->now, &lamp_presets[key - '1'], app_pole_y(app));
    return true;
}

// ---------------------------------------------------------------- wishes

static bool wish(struct app *app, enum app_wish wanted)
{
    app->wish = wanted;
    return false;
}

static bool press_png(struct app *app, int key)
{
    (void)key;
    return wish(app, APP_WISH_PNG);
}

static bool press_exr(struct app *app, int key)
{
    (void)key;
    return wish(app, APP_WISH_EXR);
}

static bool press_save_rig(struct app *app, int key)
{
    (void)key;
    return wish(app, APP_WISH_SAVE_RIG);
}

static bool press_sweep(struct app *app, int key)
{
    (void)key;
    return wish(app, APP_WISH_SWEEP);
}

static bool press_turntable(struct app *app, int key)
{
    (void)key;
    return wish(app, APP_WISH_TURNTABLE);
}

// ---------------------------------------------------------------- table

const struct key_binding key_bindings[] = {
    {'?', "?", "this list", press_help},
    {'/', NULL, NULL, press_help},
    {APP_KEY_TAB, "Tab", "panel", press_panel},
    {'+', "+ -", "exposure", press_exposure},
    {'-', NULL, NULL, press_exposure},
    {'[', "[ ]", "slab: nearer, farther", press_dolly},
    {']', NULL, NULL, press_dolly},
    {'v', "V", "next view: colour, normals, ...", press_next_pass},
    {'r', "R", "reset", press_reset},
    {'l', "L", "hold: drags turn the light", press_hold_light},
    {APP_KEY_LEFT, "arrows", "turn the light", press_turn},
    {APP_KEY_RIGHT, NULL, NULL, press_turn},
    {APP_KEY_UP_ARROW, NULL, NULL, press_turn},
    {APP_KEY_DOWN_ARROW, NULL, NULL, press_turn},
    {',', ", .", "light: dimmer, brighter", press_stops},
    {'.', NULL, NULL, press_stops},
    {'n', "N", "next light", press_next_light},
    {'a', "A", "add a light", press_add},
    {'d', "D", "delete the light", press_remove},
    {'x', "X", "light off, on", press_off},
    {'o', "O", "light alone (solo)", press_solo},
    {'1', "1 2 3", "raking, double raking, dome", press_preset},
    {'2', NULL, NULL, press_preset},
    {'3', NULL, NULL, press_preset},
    {'b', "B", "ball that shows the light", press_ball},
    {'g', "G", "handles of the lights in the picture", press_gizmos},
    {'i', "I", "inspector: the reflectance under the cursor", press_inspect},
    {'s', "S", "save the picture, PNG", press_png},
    {'p', "P", "save the picture, EXR", press_exr},
    {'w', "W", "write the lights, a rig file", press_save_rig},
    {'k', "K", "record a light sweep", press_sweep},
    {'j', "J", "record a turntable", press_turntable},
    {APP_KEY_ESCAPE, "Esc", "quit", press_quit},
    {0, NULL, NULL, NULL},
};

bool keys_press(struct app *app, int key)
{
    for (const struct key_binding *b = key_bindings; b->key; b++)
        if (b->key == key)
            return b->press(app, key);
    return false;
}

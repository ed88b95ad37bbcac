// fuzz_script.c - scripts of the viewer made of noise, played to its state machine; no OpenGL
#include "app/app.h"
#include "app/events.h"
#include "fuzz.h"

#include "app/observer.h"
#include "app/handles_say.h"
#include "app/light_list.h"
#include "app/script.h"

static const char *const words[] = {"press",      "release",
                                    "move",       "drag",
                                    "scroll",     "key",
                                    "left",       "right",
                                    "light",      "add",
                                    "rig",        "open",
                                    "edit",       "glare",
                                    "dock",       "hint",
                                    "set",        "pass",
                                    "wait",       "frame",
                                    "shot",       "quit",
                                    "size",       "Esc",
                                    "dir 0 0 1",  "1e308",
                                    "-1",         "nan",
                                    "3600",       "\n",
                                    "#",          "\t",
                                    "on",         "off",
                                    "pupil",      "reflection",
                                    "tool brush", "choose region",
                                    NULL};

static void host_send(void *user, const struct app_event *event)
{
    app_handle(user, event);
}

static relume_status host_light(void *user, const char *spec, bool replace,
                                const struct relume_log *log)
{
    struct app *app = user;
    relume_rig *rig;
    relume_status status = relume_rig_create(&rig);
    if (!status && !strchr(spec, '/'))
        status = relume_rig_add(rig, spec, NULL, log);
    const struct relume_rig_entry *made = status ? NULL : relume_rig_entry(rig, 0);
    if (made && replace)
        app->now.lights = 0;
    // pictures of a light are gone with the rig
    if (made && made->light.kind < RELUME_LIGHT_SLIDE &&
        !light_list_add(&app->now, &made->light, -1))
        status = RELUME_ENOMEM;
    relume_rig_destroy(&rig);
    return status;
}

static relume_status host_file(void *user, const char *path, const struct relume_log *log)
{
    (void)user, (void)log;
    return path[0] ? RELUME_OK : RELUME_ENOTFOUND;
}

static relume_status host_wait(void *user, double seconds)
{
    for (double left = fmin(seconds, 0.5); left > 0; left -= 1.0 / 60)
        (void)app_advance(user, fmin(left, 1.0 / 60));
    return RELUME_OK;
}

static relume_status host_frame(void *user, const char *path)
{
    (void)user;
    return path[0] ? RELUME_OK : RELUME_ENOTFOUND;
}

static relume_status host_glare(void *user, const char *text, const char **expected)
{
    struct app *app = user;
    return observer_say(&app->now.observer, text, expected) ? RELUME_OK : RELUME_EFORMAT;
}

static relume_status host_reflect(void *user, const char *text, const struct relume_log *log)
{
    return handles_say(user, text, log);
}

// The first byte chooses what is shown.
static bool one(struct fuzz *f, struct bytes b)
{
    const enum relume_projection projection = b.data[0] % 2 ? RELUME_SLAB : RELUME_SPHERICAL;
    const struct app_file file = {.geometry = {.projection = projection, .uv_z = 3},
                                  .width = 400,
                                  .height = 200,
                                  .views = projection == RELUME_SLAB ? 9 : 1,
                                  .uv_min = {-1, -0.5},
                                  .uv_max = {1, 0.5}};
    const struct app_state start = {0};
    struct app app;
    fuzz_store(f->path, (struct bytes){b.data + 1, b.size - 1});
    if (app_start(&app, &file, &start, b.data[0] & 2, NULL))
        return false;
    const struct script_host host = {&app,       &app,      host_send,   host_light, host_file,
                                     host_file,  host_wait, host_frame,  host_frame, NULL,
                                     host_glare, host_file, host_reflect};
    const relume_status status = script_play(f->path, &host);
    app_release(&app);
    return !status;
}

static struct bytes text(const char *t)
{
    return (struct bytes){(uint8_t *)strdup(t), strlen(t)};
}

int main(int argc, char **argv)
{
    struct fuzz f = {.words = words};
    fuzz_begin(&f, "fuzz_script", argc, argv);
    fuzz_add(&f, text("0# a comment\nsize 800 600\ndrag left 100 100 300 100 0.2\nframe a.png\n"
                      "wheel 1\nwait 0.3\nclick 10 20\nset zoom 2\nset gain 2\n"));
    fuzz_add(&f, text("1set gain 3.5\nset range 0.1 0.4\nset exposure -1\nset eye 0.5 0.25 2\n"
                      "set aperture 0.5\nset focus 0.3\nset zoom 2\npass unsharp\nshot a\n"));
    fuzz_add(&f,
             text("2light dir 0 1 1\nadd point 0 0 1 rgb 1 2 3\npress right 5 5\nmove 9 9\n"
                  "release right 9 9\nhold l\ndrag left 0 0 100 0\nlet l\nkey tab\nkey h\nquit\n"));
    fuzz_add(&f, text("3glare on\nglare squint 0.3\nwait 0.2\nglare pause\ndock left\nhint\n"
                      "open a.exr\nrig a.json\nedit undo\ntype abc\nkey right\nkey esc\n"));
    return fuzz_run(&f, argc, argv, one);
}

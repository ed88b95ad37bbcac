#include "options.h"

#include "say.h"

#include <relume/rig.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct option {
    const char *name;
    const char *argument;  // NULL: takes none
    const char *help;
    relume_status (*take)(struct options *o, const char *name, const char *text,
                          const struct relume_log *log);
};

// ---------------------------------------------------------------- values

bool options_numbers(const char *text, double *out, int count)
{
    for (int i = 0; i < count; i++) {
        text += strspn(text, i ? ", \t" : " \t");
        char *end;
        out[i] = strtod(text, &end);
        if (end == text || !isfinite(out[i]))
            return false;
        text = end;
    }
    return text[strspn(text, " \t\r\n")] == '\0';
}

static relume_status take_number(double *out, const char *name, const char *text, double least,
                                 double most, const struct relume_log *log)
{
    if (options_numbers(text, out, 1) && *out >= least && *out <= most)
        return RELUME_OK;
    return say(log, RELUME_EINVAL, "%s: expected a number from %g to %g; found '%s'", name, least,
               most, text);
}

static relume_status take_framing(struct options *o, const char *name, enum relume_framing framing,
                                  const struct relume_log *log)
{
    struct relume_camera *camera = &o->start.camera;
    if (camera->framing != RELUME_FRAME_DEFAULT && camera->framing != framing)
        return say(log, RELUME_EINVAL,
                   "%s: expected one of --view, --eye or --pan/--tilt/--zoom; found two", name);
    camera->framing = framing;
    return RELUME_OK;
}

relume_status options_light(struct relume_light *out, const char *spec,
                            const struct relume_log *log)
{
    relume_rig *rig;
    relume_status status = relume_rig_create(&rig);
    if (!status)
        status = relume_rig_add(rig, spec, NULL, log);
    if (!status)
        *out = relume_rig_entry(rig, 0)->light;
    if (!status && out->kind != RELUME_LIGHT_DIRECTIONAL)
        status = say(log, RELUME_EINVAL, "light '%s': expected \"dir x y z [rgb r g b]\"", spec);
    relume_rig_destroy(&rig);
    return status;
}

static relume_status take_light(struct options *o, const char *name, const char *text,
                                const struct relume_log *log)
{
    (void)name;
    if (o->start.lights == APP_LIGHTS)
        return say(log, RELUME_EINVAL, "--light: expected at most %d lights", APP_LIGHTS);
    return options_light(&o->start.light[o->start.lights++], text, log);
}

static relume_status take_view(struct options *o, const char *name, const char *text,
                               const struct relume_log *log)
{
    double n;
    const relume_status status = take_number(&n, name, text, 0, 65535, log);
    if (status || n != floor(n))
        return status
                   ? status
                   : say(log, RELUME_EINVAL, "--view: expected a whole number; found '%s'", text);
    o->start.camera.view = (int)n;
    return take_framing(o, name, RELUME_FRAME_VIEW, log);
}

static relume_status take_eye(struct options *o, const char *name, const char *text,
                              const struct relume_log *log)
{
    double v[3];
    if (!options_numbers(text, v, 3))
        return say(log, RELUME_EINVAL, "--eye: expected three numbers x,y,z; found '%s'", text);
    o->start.camera.eye = (struct relume_vec3){v[0], v[1], v[2]};
    return take_framing(o, name, RELUME_FRAME_EYE, log);
}

static relume_status take_pan(struct options *o, const char *name, const char *text,
                              const struct relume_log *log)
{
    const relume_status status =
        take_number(&o->start.camera.look.pan_deg, name, text, -36000, 36000, log);
    return status ? status : take_framing(o, name, RELUME_FRAME_LOOK, log);
}

static relume_status take_tilt(struct options *o, const char *name, const char *text,
                               const struct relume_log *log)
{
    const relume_status status =
        take_number(&o->start.camera.look.tilt_deg, name, text, -90, 90, log);
    return status ? status : take_framing(o, name, RELUME_FRAME_LOOK, log);
}

static relume_status take_zoom(struct options *o, const char *name, const char *text,
                               const struct relume_log *log)
{
    const relume_status status =
        take_number(&o->start.camera.look.zoom, name, text, 0.01, 1000, log);
    return status ? status : take_framing(o, name, RELUME_FRAME_LOOK, log);
}

static relume_status take_size(struct options *o, const char *name, const char *text,
                               const struct relume_log *log)
{
    int used = 0;
    struct relume_camera *camera = &o->start.camera;
    (void)name;
    if (sscanf(text, "%5dx%5d%n", &camera->width, &camera->height, &used) != 2 || text[used] ||
        camera->width < 1 || camera->height < 1)
        return say(log, RELUME_EINVAL, "--size: expected WxH, as in 800x600; found '%s'", text);
    o->sized = true;
    return RELUME_OK;
}

static relume_status take_threads(struct options *o, const char *name, const char *text,
                                  const struct relume_log *log)
{
    double n;
    const relume_status status = take_number(&n, name, text, 0, 256, log);
    o->threads = status ? 0 : (int)n;
    return status;
}

static relume_status take_exposure(struct options *o, const char *name, const char *text,
                                   const struct relume_log *log)
{
    return take_number(&o->start.exposure_ev, name, text, -100, 100, log);
}

static relume_status take_offscreen(struct options *o, const char *name, const char *text,
                                    const struct relume_log *log)
{
    (void)name, (void)log;
    o->offscreen = text;
    return RELUME_OK;
}

static relume_status take_script(struct options *o, const char *name, const char *text,
                                 const struct relume_log *log)
{
    (void)name, (void)log;
    o->script = text;
    return RELUME_OK;
}

static relume_status take_ball(struct options *o, const char *name, const char *text,
                               const struct relume_log *log)
{
    (void)name, (void)text, (void)log;
    o->start.ball = true;
    return RELUME_OK;
}

static const struct option options[] = {
    {"--light", "SPEC", "a light, \"dir x y z [rgb r g b]\"; repeat for more; default dir 0 0 1",
     take_light},
    {"--view", "N", "the captured view N itself (panoramas: unfolded)", take_view},
    {"--eye", "x,y,z", "slab: look from there; default the middle of the cameras", take_eye},
    {"--pan", "DEG", "panorama: turn right", take_pan},
    {"--tilt", "DEG", "panorama: look up", take_tilt},
    {"--zoom", "F", "panorama: 1 shows 90 degrees", take_zoom},
    {"--size", "WxH", "pixels of the window or picture", take_size},
    {"--exposure", "EV", "brighter by 2^EV", take_exposure},
    {"--threads", "N", "threads that read files; default: all cores", take_threads},
    {"--offscreen", "OUT", "write the picture (png, exr, ...) without a window or display",
     take_offscreen},
    {"--script", "EVENTS", "play a text file of events without a window", take_script},
    {"--ball", NULL, "offscreen: draw the ball that shows the light, as the window does",
     take_ball},
    {"--help", NULL, "this text", NULL},
};
enum { OPTIONS = sizeof options / sizeof *options };

void options_help(void)
{
    puts("usage: relume-view FILE [OPTION ...]\n\n"
         "Look at a relume file in a window, under any light and from other viewpoints.\n\n"
         "options:");
    for (int i = 0; i < OPTIONS; i++) {
        char left[40];
        snprintf(left, sizeof left, "%s%s%s", options[i].name, options[i].argument ? " " : "",
                 options[i].argument ? options[i].argument : "");
        printf("  %-22s %s\n", left, options[i].help);
    }
    puts("\n"
         "mouse:  drag         slab: turn; panorama: look around; picture: move\n"
         "        wheel        zoom\n"
         "        right drag   turn the light (also: hold L and drag)\n"
         "keys:   + -          exposure          [ ]   slab: nearer, farther\n"
         "        B            light ball        R     reset           Esc   quit\n"
         "        A relume file dropped onto the window is opened.\n\n"
         "A window shows a panorama as a perspective look ahead. --offscreen without a framing "
         "option\n"
         "shows what `relume relight` shows: planar files and panoramas their view 0, slabs the "
         "middle\n"
         "eye. Its picture fills --size; a window keeps the proportions.\n\n"
         "script: one event a line, # begins a comment:\n"
         "        size 800 600             drag left|right x0 y0 x1 y1      wheel STEPS [x y]\n"
         "        key K                    light \"dir 0 0 1\"                frame out.png\n\n"
         "example:\n"
         "  relume-view teapot.exr --eye 0.2,0,3 --light \"dir 1 1 1\" --offscreen teapot.png");
}

// ---------------------------------------------------------------- parsing

static relume_status unknown(const char *given, const struct relume_log *log)
{
    const char *names[OPTIONS + 1] = {NULL};
    for (int i = 0; i < OPTIONS; i++)
        names[i] = options[i].name;
    const char *near = relume_name_nearest(given, names);
    if (near)
        return say(log, RELUME_EINVAL, "unknown option '%s'; did you mean '%s'?", given, near);
    return say(log, RELUME_EINVAL, "unknown option '%s'; see 'relume-view --help'", given);
}

static relume_status take_option(struct options *o, int *i, int argc, char **argv,
                                 const struct relume_log *log)
{
    const char *const given = argv[*i];
    const char *equals = strchr(given, '=');
    const size_t length = equals ? (size_t)(equals - given) : strlen(given);
    for (int k = 0; k < OPTIONS; k++) {
        const struct option *option = &options[k];
        if (strlen(option->name) != length || strncmp(option->name, given, length))
            continue;
        if (!option->argument && equals)
            return say(log, RELUME_EINVAL, "%s: takes no value; found '%s'", option->name,
                       equals + 1);
        if (option->argument && !equals && *i + 1 >= argc)
            return say(log, RELUME_EINVAL, "%s: expected %s; found the end of the line",
                       option->name, option->argument);
        const char *text = !option->argument ? NULL : equals ? equals + 1 : argv[++*i];
        return option->take(o, option->name, text, log);
    }
    return unknown(given, log);
}

static bool asks_for_help(int argc, char **argv)
{
    for (int i = 1; i < argc; i++)
        if (!strcmp(argv[i], "--help") || !strcmp(argv[i], "-h"))
            return true;
    return false;
}

relume_status options_parse(struct options *o, int argc, char **argv, const struct relume_log *log)
{
    *o = (struct options){0};
    if (asks_for_help(argc, argv))
        return RELUME_OK;
    for (int i = 1; i < argc; i++) {
        relume_status status = RELUME_OK;
        if (argv[i][0] == '-' && argv[i][1])
            status = take_option(o, &i, argc, argv, log);
        else if (o->file)
            status =
                say(log, RELUME_EINVAL, "expected one FILE; found '%s' and '%s'", o->file, argv[i]);
        else
            o->file = argv[i];
        if (status)
            return status;
    }
    if (!o->file)
        return say(log, RELUME_EINVAL, "expected 'relume-view FILE'; see 'relume-view --help'");
    return RELUME_OK;
}

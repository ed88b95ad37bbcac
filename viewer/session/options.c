// options.c - the command line of relume-view
#include "session/options.h"

#include "app/keys.h"
#include "app/light_list.h"
#include "app/way.h"
#include "cli/program/options.h"
#include "cli/program/say.h"

#include <relume/exchange.h>
#include <relume/relight/tone.h>
#include <relume/world/tableau.h>
#include <relume/world/transport.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---------------------------------------------------------------- values

static relume_status take_light(void *rig, const struct option *o, const char *text,
                                const struct relume_log *log)
{
    relume_rig **const r = rig;
    (void)o;
    const relume_status status = *r ? RELUME_OK : relume_rig_create(r);
    return status ? status : relume_rig_add(*r, text, NULL, log);
}

static relume_status take_rig(void *rig, const struct option *o, const char *text,
                              const struct relume_log *log)
{
    relume_rig **const r = rig;
    if (*r)
        return say(log, RELUME_EINVAL, "%s: expected it once and before --light", o->name);
    struct relume_log saves = *log;
    saves.leave_unnoted = true;  // lights may be saved where they came from
    return relume_rig_load(r, text, &saves);
}

static relume_status take_subject(void *subject, const struct option *o, const char *text,
                                  const struct relume_log *log)
{
    (void)o;
    return relume_subject_load(subject, text, log);
}

// As a script says it: the option's name without what stands before its last word.
static relume_status take_observer(void *observer, const struct option *o, const char *text,
                                   const struct relume_log *log)
{
    const char *expected;
    char words[80];
    snprintf(words, sizeof words, "%s %.60s", strrchr(o->name, '-') + 1, text);
    if (observer_say(observer, words, &expected))
        return RELUME_OK;
    return say(log, RELUME_EINVAL, "%s: expected %s; found '%s'", o->name, expected, text);
}

static relume_status take_material(void *objects, const struct option *o, const char *text,
                                   const struct relume_log *log)
{
    struct object_options *const w = objects;
    if (w->materials == OBJECT_MATERIALS)
        return say(log, RELUME_EINVAL, "%s: expected at most %d", o->name, OBJECT_MATERIALS);
    w->material[w->materials++] = text;
    return RELUME_OK;
}

static relume_status take_transport(void *place, const struct option *o, const char *text,
                                    const struct relume_log *log)
{
    enum { MOST = 16 };
    const char *names[MOST];
    int n = 0;
    for (; n < MOST - 1 && n < way_count(); n++)
        names[n] = way_name(n);
    names[n] = NULL;
    const struct relume_transport *found = relume_transport_find(text);
    memcpy(place, &found, sizeof found);
    return found ? RELUME_OK : unknown_word(log, o->name, text, names);
}

enum { PERSPECTIVE, STEREOGRAPHIC, PLANET };
static const char *const backends[] = {"auto", "osmesa", "egl", NULL};
#define PLACES "auto", "passes", "library"

#define OPTIONS struct options
static const struct option options[] = {
    TEXT_AS(OPTION_STATE, "--state", state, "LINE",
            "begin as a page or the viewer was when this line or link was copied there"),
    OWN("--rig", rig, "FILE", "lights of a rig (JSON)", take_rig),
    OWN("--light", rig, "SPEC",
        "a light, \"dir x y z [rgb r g b]\"; repeat for more; default: dir 0 0 1", take_light),
    INT("--view", start.camera.view, "N", "the captured view N itself (panoramas: unfolded)", 0,
        65535),
    POINT("--eye", start.camera.eye, "x,y,z",
          "slab, scene file: look from there; default: the middle of the cameras, the file's eye"),
    POINT("--look-at", start.camera.look_at.at, "x,y,z",
          "--eye, scene file: the point looked at; default: the middle of the object"),
    POINT("--up", start.camera.look_at.up, "x,y,z",
          "--eye, scene file: the direction that is up in the picture; default: 0,1,0"),
    NUMBER("--fov", start.camera.look_at.field_of_view_deg, "DEG",
           "--eye, scene file: horizontal field of view; default: the slabs' windows, of objects "
           "alone all of "
           "them",
           0.01, 179),
    NUMBER("--pan", start.camera.look.pan_deg, "DEG", "panorama: degrees to the right", -36000,
           36000),
    NUMBER("--tilt", start.camera.look.tilt_deg, "DEG", "panorama: degrees up", -90, 90),
    NUMBER("--zoom", start.camera.look.zoom, "F", "panorama: 1 shows 90 degrees", 0.01, 1000),
    NAME("--projection", projection, "P", "panorama: perspective, stereographic or planet",
         PERSPECTIVE, "perspective", "stereographic", "planet"),
    NAME("--interpolate", start.interpolation, "I",
         "slab: constant, linear or depth; default: depth if there is any",
         RELUME_INTERPOLATE_CONSTANT, "constant", "linear", "depth"),
    NUMBER("--aperture", start.aperture, "A",
           "slab: diameter of the lens, which blurs what is out of focus; default: 0", 0, 1e9),
    NUMBER("--focus", start.focus_z, "Z",
           "slab: the plane at z = Z is sharp; free camera: distance from the middle to it", -1e9,
           1e9),
    SIZE("--size", size, "WxH",
         "pixels of the window or picture; W or xH alone keeps the proportions", 0, 65536),
    {ROW("--exposure", OPTION_NUMBER, OPTION_AT(double, start.exposure_ev), "EV",
         "brighter by EV stops (times 2^EV), or auto"),
     .min = -100, .max = 100, .names = NAMES("auto")},
    ENTRY("--tone", tone, "T", "linear, reinhard, filmic or gamma; .exr, .hdr and .pfm stay linear",
          relume_tones, NULL),
    NUMBER("--white", start.white, "L", "reinhard: the luminance shown as white; default: 4", 1e-3,
           1e6),
    NAME("--pass", start.pass, "NAME",
         "colour, normals, specular, diffuse-gain, unsharp, luminance, ...", RELUME_PASS_COLOUR,
         "colour", "normals", "specular", "diffuse-gain", "unsharp", "luminance", "false-colour",
         "difference"),
    TEXT("--objects", objects.description, "FILE",
         "objects covered with BTFs (docs/objects.md), in the scene or alone"),
    TEXT("--reflections", objects.reflections, "FILE",
         "what their mirrors shall reflect where (docs/reflections.md)"),
    OWN("--transport", transport, "NAME",
        "--objects, scene files: how light goes between them and the scene: none (default), ssao, "
        "ssdo, path, ... (docs/transport.md)",
        take_transport),
    INT("--bounces", bounces, "N", "--transport: of light off objects; default: 2", 0, 16),
    INT("--samples", samples, "N", "--transport: directions that light is gathered from at a pixel",
        1, 65536),
    TEXT("--mesh", objects.mesh, "FILE",
         "one mesh instead, covered with --material: .obj, .ply, .gltf, .glb, ..."),
    OWN("--material", objects, "DIR",
        "a BTF or a model of one, on --mesh or a cushion; repeat for more to choose from",
        take_material),
    NUMBER("--repeat", objects.repeat, "N",
           "repeat the material N times across the mesh's texture; default: 1", 0.001, 10000),
    TEXT("--capture", capture, "CAPTURE", "the photographs, for --pass difference"),
    INT("--threads", threads, "N", "threads that read files; default: all cores", 0, 256),
    BYTES("--max-memory", limits.max_memory, "SIZE",
          "most memory for one picture, view or model; default: half of the machine's"),
    BYTES("--max-pixels", limits.max_pixels, "N",
          "most pixels in one picture, as 200M; default: 1G"),
    FLAG("--any-format", limits.any_format, "read pictures of every format that OpenImageIO reads"),
    NUMBER("--vram", vram_mb, "MB",
           "graphics memory for views; those not used for longest are dropped; default: 1024", 1,
           1e6),
    NAME("--relight", relight, "BY",
         "where to compute: passes (the graphics card), library (the processor) or auto; default: "
         "auto",
         SESSION_AUTO, PLACES),
    FLAG("--glare", start.observer.on,
         "show the picture as a human eye sees it, with halos around lights"),
    OWN("--subject", subject, "FILE", "--glare: the viewer's eye (JSON, docs/glare.md)",
        take_subject),
    OWN("--glare-magnify", start.observer, "X", "--glare: enlarge the halos; default: 1",
        take_observer),
    OWN("--nits", start.observer, "N", "--glare: cd/m^2 of a pixel of value 1; default: 100",
        take_observer),
    OWN("--squint", start.observer, "S", "--glare: how far the lids are closed, 0 (open) to 0.95",
        take_observer),
    OWN("--glare-cycle", start.observer, "S",
        "--glare: the library computes S seconds of the eye once and shows them in a loop; up to "
        "10",
        take_observer),
    OWN("--glare-mode", start.observer, "M",
        "--glare: auto, fft, billboard or hybrid; default: auto", take_observer),
    INT("--glare-size", glare_size, "N",
        "--glare: texels of the pattern; default: 1536 on the graphics card, 512 by the library",
        128, 4096),
    NAME("--glare-by", glare, "BY",
         "--glare: where to compute, as --relight; passes need OpenGL 4.3", SESSION_AUTO, PLACES),
    FLAG("--sources", start.observer.sources,
         "draw the lights that are in view as small bright points"),
    TEXT_AS(OPTION_PICTURE, "--offscreen", offscreen, "OUT",
            "write the picture (png, exr, ...) without a window or display"),
    TEXT("--script", script, "EVENTS", "play a text file of events without a window"),
    {ROW("--gl", OPTION_NAME, OPTION_WORD(backend), "NAME",
         "offscreen by osmesa, egl, or auto: a graphics card, else osmesa; default: auto"),
     .names = backends},
    NAME("--record", kind, "KIND", "record a light sweep, a turntable or --script without a window",
         RECORD_SWEEP, "sweep", "turntable", "script"),
    TEXT_AS(OPTION_OUTPUT, "-o", output, "OUT",
            "--record: a folder of PNG files, or FILE.mp4 (by ffmpeg)"),
    INT("--frames", frames, "N", "--record: pictures in one full turn; default: 72", 1, 10000),
    FLAG("--no-config", no_config, "do not read or save the window's settings"),
    FLAG("--window", window, "play --script in a window, which then stays open"),
    FLAG("--panel", panel, "start with the panel open; offscreen: draw it as well"),
    FLAG("--keep-lights", keep_lights,
         "start with the last lights, and keep them when another file is opened"),
    {ROW("--dock", OPTION_NAME, OPTION_WORD(dock), "SIDE",
         "start with the panel at the left or right of the picture, or over it"),
     .names = app_dock_names},
    NUMBER("--ui-scale", ui_scale, "F",
           "size of the panel and its letters, 0.5 to 4; default: the desktop's scale",
           PANEL_SCALE_LEAST, PANEL_SCALE_MOST),
    FLAG("--ball", start.ball, "offscreen: draw the ball that shows the light, as the window does"),
    FLAG("--help", help, "this text"),
    {0},
};

void options_help(void)
{
    puts("usage: relume-view [FILE] [OPTION ...]\n\n"
         "Look at a relume file in a window, under any light and from other viewpoints; at a\n"
         "measured material on a mesh or a cushion, a 3D model, a baked object, a scene file, a\n"
         "folder of maps. Without FILE the window says how to open one.\n\n"
         "options:");
    options_print(options, NULL, 22);
    puts("\n"
         "mouse:  drag         slab: turn; panorama: look around; picture: move\n"
         "        wheel        zoom; several slabs: nearer, farther\n"
         "        right drag   turn the light; so does a drag on the ball\n"
         "keys:");
    for (const struct key_binding *b = key_bindings; b->key; b++)
        if (b->shown)
            printf("        %-12s %s\n", b->shown, b->what);
    puts(
        "        A relume file or a description of objects dropped onto the window is opened; a "
        "material\n"
        "        covers the mesh of --mesh, or a cushion.\n\n"
        "A window shows a panorama as a perspective look ahead. --offscreen without a framing "
        "option\n"
        "shows what `relume relight` shows: planar files and panoramas their view 0, slabs the "
        "middle\n"
        "eye. Pictures keep their proportions in any --size, as in a window.\n\n"
        "script: one event a line, # begins a comment:\n"
        "        size W H              wheel STEPS [X Y]\n"
        "        drag left|right X0 Y0 X1 Y1 [S]   S: seconds that it takes\n"
        "        click X Y             press, release left|right X Y    move X Y\n"
        "        key K                 hold K, let K                    type TEXT\n"
        "        light SPEC            add SPEC                         rig FILE\n"
        "        open FILE: another relume file, objects, a scene, maps, or a material\n"
        "        edit OPERATION VALUE ...: materials and maps, as relume btf edit; edit undo|redo\n"
        "        reflection on|off|tool T|choose K N|radius R|border P|delete|undo|redo|freeze\n"
        "        reflection unfreeze|view|distance straight|geodesic, reflection save [FILE]\n"
        "        glare on|off|pause|run, glare magnify|nits|squint|cycle X, glare mode M\n"
        "        glare sources on|off: visible lights\n"
        "        transport WAY|beside WAY|difference WAY|alone: light between objects and scene\n"
        "        glare cornea|fibres|lens|vitreous|lids on|off: parts of the eye\n"
        "        set gain|highlight|exponent|radius|exposure|aperture|focus|pan|tilt|zoom X\n"
        "        set eye X Y Z         set range LOW HIGH               pass NAME\n"
        "        dock over|left|right  hint: what the mouse does        quit\n"
        "        wait [SECONDS]        frame OUT: the picture           shot OUT: with the "
        "panel\n\n"
        "example:\n"
        "  relume-view teapot.exr --eye 0.2,0,3 --light \"dir 1 1 1\" --offscreen teapot.png");
}

// ---------------------------------------------------------------- parsing

static bool asks_for_help(int argc, char **argv)
{
    for (int i = 1; i < argc; i++)
        if (!strcmp(argv[i], "--help") || !strcmp(argv[i], "-h"))
            return true;
    return false;
}

void options_release(struct options *o)
{
    relume_rig_destroy(&o->rig);
    light_list_release(&o->start);
}

// FILE is a scene; or a description of objects; or a material, for --mesh without --material or, by
// itself, for a cushion.
static relume_status choose_objects(struct options *o, const struct relume_log *log)
{
    struct object_options *w = &o->objects;
    const bool scene = o->file && relume_kind_of(o->file) == RELUME_KIND_SCENE;
    if (scene && (w->description || w->mesh || w->materials || w->reflections))
        return say(log, RELUME_EINVAL,
                   "%s: a scene file has objects of its own; leave out --objects, --mesh, "
                   "--material and --reflections",
                   o->file);
    if (o->file && !scene && object_file_is_description(o->file) && !w->description && !w->mesh) {
        w->description = o->file;
        o->file = NULL;
    } else if (o->file && !w->materials && (w->mesh || object_file_is_material(o->file))) {
        w->material[w->materials++] = o->file;
        o->file = NULL;
    }
    if (w->mesh && w->description)
        return say(log, RELUME_EINVAL, "expected one of --objects and --mesh; found both");
    if (w->mesh && !w->materials)
        return say(log, RELUME_EINVAL, "--mesh: expected a material for it; see --material");
    if (w->materials && !w->mesh && (o->file || w->description))
        return say(log, RELUME_EINVAL, "--material: expected --mesh, for an object in a scene");
    if (!w->materials && w->repeat != 0.0)
        return say(log, RELUME_EINVAL, "--repeat: expected a material, as FILE or by --material");
    if (w->reflections && !w->description)
        return say(log, RELUME_EINVAL,
                   "--reflections: expected a description of objects; add --objects FILE");
    o->stage = !o->file && (w->materials || w->description);
    return RELUME_OK;
}

// Light between objects and the scene that they stand in.
static relume_status choose_way(struct options *o, const struct command_line *line,
                                const struct relume_log *log)
{
    const bool bounces = option_given(line, &o->bounces);
    const bool in_scene = o->file && (o->objects.description || o->objects.mesh ||
                                      relume_kind_of(o->file) == RELUME_KIND_SCENE);
    if ((o->transport || bounces || o->samples) && !in_scene)
        return say(log, RELUME_EINVAL,
                   "--transport, --bounces and --samples work only with objects in a scene; open a "
                   "FILE with --objects FILE, or a scene file");
    for (int i = 0; o->transport && i < way_count(); i++)
        o->start.way = relume_transports[i] == o->transport ? i : o->start.way;
    o->start.way_samples = o->samples;
    o->start.bounces = bounces && !o->bounces ? -1 : o->bounces;
    return RELUME_OK;
}

// A window, and a script, can open one later; without a display there is nobody to choose one.
static bool needs_file(const struct options *o)
{
    const bool display = getenv("DISPLAY") || getenv("WAYLAND_DISPLAY");
    return o->offscreen || o->record || (!o->script && !display);
}

// What several options say together.
static relume_status choose_camera(struct options *o, const struct command_line *line,
                                   const struct relume_log *log)
{
    struct relume_camera *const camera = &o->start.camera;
    struct relume_pan_tilt *const look = &camera->look;
    const bool view = option_given(line, &camera->view), eye = option_given(line, &camera->eye);
    const bool projection = option_given(line, &o->projection);
    const bool tilt = option_given(line, &look->tilt_deg), zoom = option_given(line, &look->zoom);
    const bool looks = projection || tilt || zoom || option_given(line, &look->pan_deg);
    if (view + eye + looks > 1)
        return say(log, RELUME_EINVAL,
                   "expected one of --view, --eye or --pan/--tilt/--zoom; found two");
    camera->framing = view    ? RELUME_FRAME_VIEW
                      : eye   ? RELUME_FRAME_EYE
                      : looks ? RELUME_FRAME_LOOK
                              : RELUME_FRAME_DEFAULT;
    camera->look_at.aimed = option_given(line, &camera->look_at.at);
    camera->width = o->size[0];
    camera->height = o->size[1];
    look->stereographic = o->projection != PERSPECTIVE;
    look->tilt_deg = o->projection == PLANET && !tilt ? -90.0 : look->tilt_deg;
    look->zoom = o->projection == PLANET && !zoom ? 0.5 : look->zoom;
    const bool scene =
        line->input[0] && !view && !looks && relume_kind_of(line->input[0]) == RELUME_KIND_SCENE;
    if (relume_look_at_given(&camera->look_at) && !eye && !scene)
        return say(log, RELUME_EINVAL, "--look-at, --up and --fov need --eye, or a scene file");
    return RELUME_OK;
}

static relume_status choose(struct options *o, const struct command_line *line,
                            const struct relume_log *log)
{
    const relume_status status = choose_camera(o, line, log);
    if (status)
        return status;
    o->file = line->input[0];
    o->gl = backends[o->backend];
    o->docked = option_given(line, &o->dock);
    o->panel |= o->docked;
    o->record = option_given(line, &o->kind);
    o->start.focused = option_given(line, &o->start.focus_z);
    o->start.auto_exposure = isnan(o->start.exposure_ev);
    if (o->start.auto_exposure)
        o->start.exposure_ev = 0.0;
    for (int i = 0; o->tone && relume_tones[i]; i++)
        o->start.tone = relume_tones[i] == o->tone ? i : o->start.tone;
    if (line->input_count > 1)
        return say(log, RELUME_EINVAL, "expected one FILE; found '%s' and '%s'", line->input[0],
                   line->input[1]);
    if (o->glare_size % 2)
        return say(log, RELUME_EINVAL, "--glare-size: expected an even number; found '%d'",
                   o->glare_size);
    if (o->record != (o->output != NULL))
        return say(log, RELUME_EINVAL, "expected --record KIND and -o OUT together");
    if (o->record && o->kind == RECORD_SCRIPT && !o->script)
        return say(log, RELUME_EINVAL, "--record script: expected --script EVENTS as well");
    const relume_status objects = choose_objects(o, log);
    return objects ? objects : choose_way(o, line, log);
}

relume_status options_parse(struct options *o, int argc, char **argv, const struct relume_log *log)
{
    *o = (struct options){
        .vram_mb = 1024, .frames = RECORD_FRAMES, .subject = relume_subject_default()};
    o->help = asks_for_help(argc, argv);
    if (o->help)
        return RELUME_OK;
    struct command_line *line = calloc(1, sizeof *line);
    if (!line)
        return RELUME_ENOMEM;
    line->tables[0] = options;
    line->values = o;
    line->log = log;
    relume_status status = command_line_parse(line, argc - 1, argv + 1);
    if (!status)
        status = choose(o, line, log);
    free(line);
    if (!status && !o->stage && !o->file && needs_file(o))
        return say(log, RELUME_EINVAL, "expected 'relume-view FILE'; see 'relume-view --help'");
    return status;
}

// options.c - the command line of relume-view
#include "session/options.h"

#include "app/keys.h"
#include "app/lamps.h"
#include "common/say.h"

#include <relume/tone.h>

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

static relume_status have_rig(struct options *o)
{
    return o->rig ? RELUME_OK : relume_rig_create(&o->rig);
}

static relume_status take_light(struct options *o, const char *name, const char *text,
                                const struct relume_log *log)
{
    (void)name;
    const relume_status status = have_rig(o);
    return status ? status : relume_rig_add(o->rig, text, NULL, log);
}

static relume_status take_rig(struct options *o, const char *name, const char *text,
                              const struct relume_log *log)
{
    if (o->rig)
        return say(log, RELUME_EINVAL, "%s: expected it once and before --light", name);
    struct relume_log saves = *log;
    saves.inputs = NULL;  // lights may be saved where they came from
    return relume_rig_load(&o->rig, text, &saves);
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

static relume_status take_point(struct relume_vec3 *out, const char *name, const char *text,
                                const struct relume_log *log)
{
    double v[3];
    if (!options_numbers(text, v, 3))
        return say(log, RELUME_EINVAL, "%s: expected three numbers x,y,z; found '%s'", name, text);
    *out = (struct relume_vec3){v[0], v[1], v[2]};
    return RELUME_OK;
}

static relume_status take_eye(struct options *o, const char *name, const char *text,
                              const struct relume_log *log)
{
    const relume_status status = take_point(&o->start.camera.eye, name, text, log);
    return status ? status : take_framing(o, name, RELUME_FRAME_EYE, log);
}

static relume_status take_look_at(struct options *o, const char *name, const char *text,
                                  const struct relume_log *log)
{
    o->start.camera.aim.aimed = true;
    return take_point(&o->start.camera.aim.at, name, text, log);
}

static relume_status take_up(struct options *o, const char *name, const char *text,
                             const struct relume_log *log)
{
    return take_point(&o->start.camera.aim.up, name, text, log);
}

static relume_status take_fov(struct options *o, const char *name, const char *text,
                              const struct relume_log *log)
{
    return take_number(&o->start.camera.aim.field_of_view_deg, name, text, 0.01, 179, log);
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

static relume_status take_projection(struct options *o, const char *name, const char *text,
                                     const struct relume_log *log)
{
    struct relume_pan_tilt *look = &o->start.camera.look;
    const bool planet = !strcmp(text, "planet");
    if (strcmp(text, "perspective") && strcmp(text, "stereographic") && !planet)
        return say(log, RELUME_EINVAL,
                   "%s: expected perspective, stereographic or planet; found '%s'", name, text);
    look->stereographic = strcmp(text, "perspective") != 0;
    if (planet && look->tilt_deg == 0.0)
        look->tilt_deg = -90.0;
    if (planet && look->zoom == 0.0)
        look->zoom = 0.5;
    return take_framing(o, name, RELUME_FRAME_LOOK, log);
}

static relume_status take_interpolation(struct options *o, const char *name, const char *text,
                                        const struct relume_log *log)
{
    if (!relume_interpolation_parse(&o->start.interpolation, text))
        return RELUME_OK;
    return say(log, RELUME_EINVAL, "%s: expected constant, linear or depth; found '%s'", name,
               text);
}

static relume_status take_aperture(struct options *o, const char *name, const char *text,
                                   const struct relume_log *log)
{
    return take_number(&o->start.aperture, name, text, 0, 1e9, log);
}

static relume_status take_focus(struct options *o, const char *name, const char *text,
                                const struct relume_log *log)
{
    o->start.focused = true;
    return take_number(&o->start.focus_z, name, text, -1e9, 1e9, log);
}

// 1 to 99999, and moves on; 0 where there is none.
static int take_side(const char **text)
{
    const size_t digits = strspn(*text, "0123456789");
    const int side = digits <= 5 ? atoi(*text) : 0;
    *text += side ? digits : 0;
    return side;
}

static relume_status take_size(struct options *o, const char *name, const char *text,
                               const struct relume_log *log)
{
    const char *rest = text;
    struct relume_camera *camera = &o->start.camera;
    (void)name;
    camera->width = take_side(&rest);
    const bool both = *rest == 'x';
    rest += both;
    camera->height = both ? take_side(&rest) : 0;
    if (*rest || !(camera->width || camera->height))
        return say(log, RELUME_EINVAL, "--size: expected WxH, W or xH, as in 800x600; found '%s'",
                   text);
    o->sized = true;
    return RELUME_OK;
}

static relume_status take_bytes(uint64_t *out, const char *name, const char *text,
                                const struct relume_log *log)
{
    if (!relume_size_parse(out, text))
        return RELUME_OK;
    return say(log, RELUME_EINVAL, "%s: expected a size like 500M or 4G; found '%s'", name, text);
}

static relume_status take_max_memory(struct options *o, const char *name, const char *text,
                                     const struct relume_log *log)
{
    return take_bytes(&o->limits.max_memory, name, text, log);
}

static relume_status take_max_pixels(struct options *o, const char *name, const char *text,
                                     const struct relume_log *log)
{
    return take_bytes(&o->limits.max_pixels, name, text, log);
}

static relume_status take_any_format(struct options *o, const char *name, const char *text,
                                     const struct relume_log *log)
{
    (void)name, (void)text, (void)log;
    o->limits.any_format = true;
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

static relume_status take_vram(struct options *o, const char *name, const char *text,
                               const struct relume_log *log)
{
    return take_number(&o->vram_mb, name, text, 1, 1e6, log);
}

static relume_status take_who(enum session_relight *out, const char *name, const char *text,
                              const struct relume_log *log)
{
    static const char *const names[] = {
        [SESSION_AUTO] = "auto", [SESSION_PASSES] = "passes", [SESSION_LIBRARY] = "library"};
    for (int i = 0; i < (int)(sizeof names / sizeof *names); i++)
        if (!strcmp(names[i], text)) {
            *out = (enum session_relight)i;
            return RELUME_OK;
        }
    return say(log, RELUME_EINVAL, "%s: expected auto, passes or library; found '%s'", name, text);
}

static relume_status take_relight(struct options *o, const char *name, const char *text,
                                  const struct relume_log *log)
{
    return take_who(&o->relight, name, text, log);
}

// ---------------------------------------------------------------- glare

static relume_status take_glare(struct options *o, const char *name, const char *text,
                                const struct relume_log *log)
{
    (void)name, (void)text, (void)log;
    o->start.observer.on = true;
    return RELUME_OK;
}

static relume_status take_sources(struct options *o, const char *name, const char *text,
                                  const struct relume_log *log)
{
    (void)name, (void)text, (void)log;
    o->start.observer.sources = true;
    return RELUME_OK;
}

static relume_status take_subject(struct options *o, const char *name, const char *text,
                                  const struct relume_log *log)
{
    (void)name;
    return relume_subject_load(&o->subject, text, log);
}

static relume_status take_glare_by(struct options *o, const char *name, const char *text,
                                   const struct relume_log *log)
{
    return take_who(&o->glare, name, text, log);
}

static relume_status take_glare_size(struct options *o, const char *name, const char *text,
                                     const struct relume_log *log)
{
    double n;
    const relume_status status = take_number(&n, name, text, 128, 4096, log);
    if (status)
        return status;
    o->glare_size = (int)n;
    if (n != o->glare_size || o->glare_size % 2)
        return say(log, RELUME_EINVAL, "%s: expected an even number from 128 to 4096; found '%s'",
                   name, text);
    return RELUME_OK;
}

// As a script says it: the option's name without what stands before its last word.
static relume_status take_sight(struct options *o, const char *name, const char *text,
                                const struct relume_log *log)
{
    const char *expected;
    char words[80];
    snprintf(words, sizeof words, "%s %.60s", strrchr(name, '-') + 1, text);
    if (observer_say(&o->start.observer, words, &expected))
        return RELUME_OK;
    return say(log, RELUME_EINVAL, "%s: expected %s; found '%s'", name, expected, text);
}

static relume_status take_exposure(struct options *o, const char *name, const char *text,
                                   const struct relume_log *log)
{
    o->start.auto_exposure = !strcmp(text, "auto");
    if (o->start.auto_exposure)
        return RELUME_OK;
    return take_number(&o->start.exposure_ev, name, text, -100, 100, log);
}

static relume_status take_tone(struct options *o, const char *name, const char *text,
                               const struct relume_log *log)
{
    for (int i = 0; relume_tones[i]; i++)
        if (!strcmp(relume_tones[i]->name, text)) {
            o->start.tone = i;
            return RELUME_OK;
        }
    return say(log, RELUME_EINVAL, "%s: expected linear, reinhard, filmic or gamma; found '%s'",
               name, text);
}

static relume_status take_white(struct options *o, const char *name, const char *text,
                                const struct relume_log *log)
{
    return take_number(&o->start.white, name, text, 1e-3, 1e6, log);
}

static relume_status take_offscreen(struct options *o, const char *name, const char *text,
                                    const struct relume_log *log)
{
    o->offscreen = text;
    if (relume_image_can_save(text))
        return RELUME_OK;
    return say(log, RELUME_EINVAL,
               "%s: %s: no picture format for this ending; expected .png, .jpg, .exr, ...", name,
               text);
}

static relume_status take_script(struct options *o, const char *name, const char *text,
                                 const struct relume_log *log)
{
    (void)name, (void)log;
    o->script = text;
    return RELUME_OK;
}

static relume_status take_gl(struct options *o, const char *name, const char *text,
                             const struct relume_log *log)
{
    o->gl = text;
    if (!strcmp(text, "auto") || !strcmp(text, "osmesa") || !strcmp(text, "egl"))
        return RELUME_OK;
    return say(log, RELUME_EINVAL, "%s: expected auto, osmesa or egl; found '%s'", name, text);
}

static relume_status take_capture(struct options *o, const char *name, const char *text,
                                  const struct relume_log *log)
{
    (void)name, (void)log;
    o->capture = text;
    return RELUME_OK;
}

static relume_status take_pass(struct options *o, const char *name, const char *text,
                               const struct relume_log *log)
{
    const char *names[RELUME_PASSES + 1] = {NULL};
    if (!relume_pass_parse(&o->start.pass, text))
        return RELUME_OK;
    for (int i = 0; i < RELUME_PASSES; i++)
        names[i] = relume_pass_name((enum relume_pass)i);
    const char *near = relume_name_nearest(text, names);
    return say(log, RELUME_EINVAL, "%s: expected a view; found '%s'; did you mean '%s'?", name,
               text, near ? near : names[0]);
}

static relume_status take_record(struct options *o, const char *name, const char *text,
                                 const struct relume_log *log)
{
    o->record = true;
    if (!record_parse(&o->kind, text))
        return RELUME_OK;
    return say(log, RELUME_EINVAL, "%s: expected sweep, turntable or script; found '%s'", name,
               text);
}

static relume_status take_output(struct options *o, const char *name, const char *text,
                                 const struct relume_log *log)
{
    (void)name, (void)log;
    o->output = text;
    return RELUME_OK;
}

static relume_status take_frames(struct options *o, const char *name, const char *text,
                                 const struct relume_log *log)
{
    double n;
    const relume_status status = take_number(&n, name, text, 1, 10000, log);
    o->frames = status ? 0 : (int)n;
    return status;
}

static relume_status take_objects(struct options *o, const char *name, const char *text,
                                  const struct relume_log *log)
{
    (void)name, (void)log;
    o->objects.description = text;
    return RELUME_OK;
}

static relume_status take_mesh(struct options *o, const char *name, const char *text,
                               const struct relume_log *log)
{
    (void)name, (void)log;
    o->objects.mesh = text;
    return RELUME_OK;
}

static relume_status take_material(struct options *o, const char *name, const char *text,
                                   const struct relume_log *log)
{
    if (o->objects.materials == SESSION_MATERIALS)
        return say(log, RELUME_EINVAL, "%s: expected at most %d", name, SESSION_MATERIALS);
    o->objects.material[o->objects.materials++] = text;
    return RELUME_OK;
}

static relume_status take_repeat(struct options *o, const char *name, const char *text,
                                 const struct relume_log *log)
{
    return take_number(&o->objects.repeat, name, text, 0.001, 10000, log);
}

static relume_status take_no_config(struct options *o, const char *name, const char *text,
                                    const struct relume_log *log)
{
    (void)name, (void)text, (void)log;
    o->no_config = true;
    return RELUME_OK;
}

static relume_status take_ball(struct options *o, const char *name, const char *text,
                               const struct relume_log *log)
{
    (void)name, (void)text, (void)log;
    o->start.ball = true;
    return RELUME_OK;
}

static relume_status take_panel(struct options *o, const char *name, const char *text,
                                const struct relume_log *log)
{
    (void)name, (void)text, (void)log;
    o->panel = true;
    return RELUME_OK;
}

static relume_status take_keep_lights(struct options *o, const char *name, const char *text,
                                      const struct relume_log *log)
{
    (void)name, (void)text, (void)log;
    o->keep_lights = true;
    return RELUME_OK;
}

static relume_status take_dock(struct options *o, const char *name, const char *text,
                               const struct relume_log *log)
{
    o->docked = o->panel = true;
    for (int i = 0; i < APP_DOCKS; i++)
        if (!strcmp(text, app_dock_names[i])) {
            o->dock = (enum app_dock)i;
            return RELUME_OK;
        }
    return say(log, RELUME_EINVAL, "%s: expected over, left or right; found '%s'", name, text);
}

static relume_status take_ui_scale(struct options *o, const char *name, const char *text,
                                   const struct relume_log *log)
{
    return take_number(&o->ui_scale, name, text, PANEL_SCALE_LEAST, PANEL_SCALE_MOST, log);
}

static relume_status take_window(struct options *o, const char *name, const char *text,
                                 const struct relume_log *log)
{
    (void)name, (void)text, (void)log;
    o->window = true;
    return RELUME_OK;
}

static const struct option options[] = {
    {"--rig", "FILE", "lights of a rig (JSON)", take_rig},
    {"--light", "SPEC", "a light, \"dir x y z [rgb r g b]\"; repeat for more; default dir 0 0 1",
     take_light},
    {"--view", "N", "the captured view N itself (panoramas: unfolded)", take_view},
    {"--eye", "x,y,z", "slab: look from there; default the middle of the cameras", take_eye},
    {"--look-at", "x,y,z", "--eye: where it looks; default the middle of the object", take_look_at},
    {"--up", "x,y,z", "--eye: what is up in the picture; default 0,1,0", take_up},
    {"--fov", "DEG",
     "--eye: horizontal field of view; default the slabs' windows, of objects alone all of them",
     take_fov},
    {"--pan", "DEG", "panorama: turn right", take_pan},
    {"--tilt", "DEG", "panorama: look up", take_tilt},
    {"--zoom", "F", "panorama: 1 shows 90 degrees", take_zoom},
    {"--projection", "P", "panorama: perspective, stereographic or planet", take_projection},
    {"--interpolate", "I", "slab: constant, linear or depth; default: depth if there is any",
     take_interpolation},
    {"--aperture", "A", "slab: diameter of the lens, which blurs what is out of focus; default 0",
     take_aperture},
    {"--focus", "Z",
     "slab: the plane at z = Z is sharp; free camera: distance from the middle to it", take_focus},
    {"--size", "WxH", "pixels of the window or picture; W or xH alone keeps the proportions",
     take_size},
    {"--exposure", "EV", "brighter by 2^EV, or auto", take_exposure},
    {"--tone", "T", "linear, reinhard, filmic or gamma; .exr, .hdr and .pfm stay linear",
     take_tone},
    {"--white", "L", "reinhard: the luminance shown as white; default: 4", take_white},
    {"--pass", "NAME", "colour, normals, specular, diffuse-gain, unsharp, luminance, ...",
     take_pass},
    {"--objects", "FILE", "objects covered with BTFs (docs/objects.md), in the scene or alone",
     take_objects},
    {"--mesh", "FILE", "the same for one mesh: .obj, .ply, .gltf, .glb, ...", take_mesh},
    {"--material", "DIR", "--mesh: a BTF or a model of one; repeat for more to choose from",
     take_material},
    {"--repeat", "N", "--mesh: repeat the material N times across its texture; default 1",
     take_repeat},
    {"--capture", "CAPTURE", "the photographs, for --pass difference", take_capture},
    {"--threads", "N", "threads that read files; default: all cores", take_threads},
    {"--max-memory", "SIZE",
     "most memory for one picture, view or model; default: half of the machine's", take_max_memory},
    {"--max-pixels", "N", "most pixels in one picture, as 200M; default: 1G", take_max_pixels},
    {"--any-format", NULL, "read pictures of every format that OpenImageIO reads", take_any_format},
    {"--vram", "MB",
     "graphics memory for views; those not used for longest are dropped; default: 1024", take_vram},
    {"--relight", "BY",
     "where to compute: passes (the graphics card), library (the processor) or auto; default auto",
     take_relight},
    {"--glare", NULL, "show the picture as a human eye sees it, with halos around lights",
     take_glare},
    {"--subject", "FILE", "--glare: the viewer's eye (JSON, docs/glare.md)", take_subject},
    {"--glare-magnify", "X", "--glare: enlarge the halos; default 1", take_sight},
    {"--nits", "N", "--glare: cd/m^2 of a pixel of value 1; default 100", take_sight},
    {"--squint", "S", "--glare: how far the lids are closed, 0 (open) to 0.95", take_sight},
    {"--glare-cycle", "S",
     "--glare: the library computes S seconds of the eye once and shows them in a loop; up to 10",
     take_sight},
    {"--glare-mode", "M", "--glare: auto, fft, billboard or hybrid; default auto", take_sight},
    {"--glare-size", "N",
     "--glare: texels of the pattern; default 1536 by passes, 512 by the library", take_glare_size},
    {"--glare-by", "BY", "--glare: where to compute, as --relight; passes need OpenGL 4.3",
     take_glare_by},
    {"--sources", NULL, "draw the lights that are in view as small bright points", take_sources},
    {"--offscreen", "OUT", "write the picture (png, exr, ...) without a window or display",
     take_offscreen},
    {"--script", "EVENTS", "play a text file of events without a window", take_script},
    {"--gl", "NAME",
     "offscreen by osmesa, egl, or auto: a graphics card, else osmesa; default auto", take_gl},
    {"--record", "KIND", "record a light sweep, a turntable or --script without a window",
     take_record},
    {"-o", "OUT", "--record: a folder of PNG files, or FILE.mp4 (by ffmpeg)", take_output},
    {"--frames", "N", "--record: pictures in one full turn; default 72", take_frames},
    {"--no-config", NULL, "do not read or save the window's settings", take_no_config},
    {"--window", NULL, "play --script in a window, which then stays open", take_window},
    {"--panel", NULL, "start with the panel open; offscreen: draw it as well", take_panel},
    {"--keep-lights", NULL, "start with the last lights, and keep them when another file is opened",
     take_keep_lights},
    {"--dock", "SIDE", "start with the panel at the left or right of the picture, or over it",
     take_dock},
    {"--ui-scale", "F", "size of the panel and its letters, 0.5 to 4; default: the desktop's scale",
     take_ui_scale},
    {"--ball", NULL, "offscreen: draw the ball that shows the light, as the window does",
     take_ball},
    {"--help", NULL, "this text", NULL},
};
enum { OPTIONS = sizeof options / sizeof *options };

void options_help(void)
{
    puts("usage: relume-view [FILE] [OPTION ...]\n\n"
         "Look at a relume file in a window, under any light and from other viewpoints. Without "
         "FILE\n"
         "the window says how to open one.\n\n"
         "options:");
    for (int i = 0; i < OPTIONS; i++) {
        char left[40];
        snprintf(left, sizeof left, "%s%s%s", options[i].name, options[i].argument ? " " : "",
                 options[i].argument ? options[i].argument : "");
        printf("  %-22s %s\n", left, options[i].help);
    }
    puts("\n"
         "mouse:  drag         slab: turn; panorama: look around; picture: move\n"
         "        wheel        zoom; several slabs: nearer, farther\n"
         "        right drag   turn the light; so does a drag on the ball\n"
         "keys:");
    for (const struct key_binding *b = key_bindings; b->key; b++)
        if (b->shown)
            printf("        %-12s %s\n", b->shown, b->what);
    puts("        A relume file or a description of objects dropped onto the window is opened; a "
         "material\n"
         "        covers the mesh of --mesh.\n\n"
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
         "        open FILE: another relume file, objects, or a material for --mesh\n"
         "        glare on|off|pause|run, glare magnify|nits|squint|cycle X, glare mode M\n"
         "        glare sources on|off: lamps in view\n"
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
            return say(log, RELUME_EINVAL, "%s: expected %s after it; found none", option->name,
                       option->argument);
        const char *text = !option->argument ? NULL : equals ? equals + 1 : argv[++*i];
        if (text && !*text)
            return say(log, RELUME_EINVAL, "%s: expected %s; found an empty one", option->name,
                       option->argument);
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

void options_release(struct options *o)
{
    relume_rig_destroy(&o->rig);
    lamps_release(&o->start);
}

static bool is_description(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && !strcmp(dot, ".json");
}

// FILE is a scene; or a description of objects; or, beside --mesh without --material, a material.
static relume_status choose_objects(struct options *o, const struct relume_log *log)
{
    struct session_objects *w = &o->objects;
    if (o->file && is_description(o->file) && !w->description && !w->mesh) {
        w->description = o->file;
        o->file = NULL;
    } else if (o->file && w->mesh && !w->materials) {
        w->material[w->materials++] = o->file;
        o->file = NULL;
    }
    if (w->mesh && w->description)
        return say(log, RELUME_EINVAL, "expected one of --objects and --mesh; found both");
    if (w->mesh && !w->materials)
        return say(log, RELUME_EINVAL, "--mesh: expected a material for it; see --material");
    if (!w->mesh && (w->materials || w->repeat != 0.0))
        return say(log, RELUME_EINVAL, "--material and --repeat need --mesh");
    o->stage = !o->file && (w->mesh || w->description);
    return RELUME_OK;
}

// A window, and a script, can open one later; without a display there is nobody to choose one.
static bool needs_file(const struct options *o)
{
    const bool display = getenv("DISPLAY") || getenv("WAYLAND_DISPLAY");
    return o->offscreen || o->record || (!o->script && !display);
}

relume_status options_parse(struct options *o, int argc, char **argv, const struct relume_log *log)
{
    *o = (struct options){.gl = "auto", .vram_mb = 1024, .subject = relume_subject_default()};
    if (asks_for_help(argc, argv)) {
        o->help = true;
        return RELUME_OK;
    }
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
    if (relume_look_at_given(&o->start.camera.aim) && o->start.camera.framing != RELUME_FRAME_EYE)
        return say(log, RELUME_EINVAL, "--look-at, --up and --fov need --eye");
    if (o->record != (o->output != NULL))
        return say(log, RELUME_EINVAL, "expected --record KIND and -o OUT together");
    if (o->record && o->kind == RECORD_SCRIPT && !o->script)
        return say(log, RELUME_EINVAL, "--record script: expected --script EVENTS as well");
    if (!o->frames)
        o->frames = RECORD_FRAMES;
    const relume_status status = choose_objects(o, log);
    if (status || o->stage)
        return status;
    if (!o->file && needs_file(o))
        return say(log, RELUME_EINVAL, "expected 'relume-view FILE'; see 'relume-view --help'");
    return RELUME_OK;
}

// cmd_synth.c - relume synth: a built-in scene on the virtual light stage
#include "cli/materials/btf_inputs.h"

#include <stdlib.h>
#include <string.h>

struct synth_options {
    struct args args;
    const char *output, *lights_from, *mesh, *btf, *directions;
    const struct relume_pattern *pattern;
    int size, lights, samples, bounces, seed, extent, views[2];
    enum relume_projection projection;
    enum relume_ring ring;
    double spread, blur, noise, shift, flicker;
    bool hemisphere, discs, force;
    struct points eye, lamp;
};
#define OPTIONS struct synth_options

// A name, no file that would have to be kept.
static relume_status take_material(void *member, const struct option *option, const char *text,
                                   const struct relume_log *log)
{
    (void)option, (void)log;
    *(const char **)member = text;
    return RELUME_OK;
}

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(OPTION_OUTPUT, output, "DIR", "the capture folder to make"),
    FLAG("--force", force, "replace a folder that relume made"),
    GROUP("scene"),
    INT("--size", size, "N",
        "width (planar, slab, cube face) or height (panoramas), pixels; default: 256", 1, 65536),
    TEXT("--mesh", mesh, "FILE", "bust: render this OBJ or PLY model instead"),
    GROUP("camera"),
    SIZE("--views", views, "GxG", "slab: grid of cameras; default: 5x5", 1, 9999),
    NUMBER("--spread", spread, "S",
           "slab: cameras reach from -S to S; default: 0.5, with --slabs wide enough to overlap",
           0.001, 1000),
    NAME("--slabs", ring, "N",
         "slab: number of slabs: 4, 6 or 8 around the object, or cube: 4 and one from above; "
         "default: one",
         RELUME_RING_4, "4", "6", "8", "cube"),
    NAME("--projection", projection, "P",
         "planar, slab, cylindrical, spherical, cube; default: the scene's own", RELUME_PLANAR,
         "planar", "slab", "cylindrical", "spherical", "cube"),
    FLAG("--discs", discs, "cylindrical: add the end discs, so that it sees up and down as well"),
    POINTS("--eye", eye, "x,y,z", "where the eye is; may be repeated for a slab"),
    GROUP("lights"),
    INT("--lights", lights, "N", "number of light directions; default: 100", 1, 65536),
    ENTRY("--pattern", pattern, "P",
          "hammersley (default), grid, random, jittered, poisson, spiral", relume_patterns, NULL),
    FLAG("--hemisphere", hemisphere,
         "lights on the viewer's (panoramas, --slabs: upper) side only"),
    TEXT("--lights-from", lights_from, "FILE",
         "take the directions of a capture.json, a .lp file or a text with lines x y z"),
    POINTS("--lamp", lamp, "x,y,z",
           "a near lamp there, in world units, in place of distant lights; may be repeated"),
    GROUP("rendering"),
    INT("--samples", samples, "N", "camera rays per pixel; default: 16", 1, 65536),
    INT("--bounces", bounces, "N", "bounces of indirect light; default: 0", 0, 64),
    INT("--seed", seed, "S", "seed of random patterns and sampling; default: 0", 0, 2147483647),
    GROUP("material"),
    OWN("--btf", btf, "MATERIAL",
        "measure a built-in material as a BTF instead of a scene; --size is in texels, default: 64",
        take_material),
    INT("--extent", extent, "N",
        "--btf: N times as many stones, threads, ... along a side; default: 1", 1, 16),
    TEXT("--directions", directions, "SET",
         "--btf: directions of views and lights: bonn (default), dome, coarse, or a file of "
         "directions"),
    NUMBER("--blur", blur, "T",
           "--btf: the lens blurs by T texels (standard deviation); default: 0, sharp", 0, 100),
    NUMBER("--noise", noise, "N",
           "--btf: noise of a white surface's light, 0.01 for 1 % (standard deviation); default: 0",
           0, 1),
    NUMBER("--shift", shift, "T",
           "--btf: each photograph is off its place by T texels (standard deviation); default: 0",
           0, 100),
    NUMBER("--flicker", flicker, "F",
           "--btf: the lamp differs by F from photograph to photograph, 0.01 for 1 % (standard "
           "deviation); default: 0",
           0, 1),
    {0},
};

static relume_status choose_scene(const struct relume_scene_kind **out, const char *name,
                                  const struct relume_log *log)
{
    const char *names[16];
    int n = 0;
    for (const struct relume_scene_kind *const *k = relume_scenes; *k && n < 15; k++)
        names[n++] = (*k)->name;
    names[n] = NULL;
    *out = relume_scene_find(name);
    return *out ? RELUME_OK : unknown_word(log, "scene", name, names);
}

// A scene that is planar by itself becomes a slab by being asked for views.
static relume_status choose_views(struct relume_synth_params *p, enum relume_projection own,
                                  const struct synth_options *o)
{
    p->projection = o->projection;
    p->projection_set = given(o, &o->projection);
    p->grid[0] = o->views[0];
    p->grid[1] = o->views[1];
    if (o->views[0] && !p->projection_set && own == RELUME_PLANAR) {
        p->projection = RELUME_SLAB;
        p->projection_set = true;
    }
    if (!o->views[0] || (p->projection_set ? p->projection : own) == RELUME_SLAB)
        return RELUME_OK;
    return usage_error("--views: expected --projection slab, which has views");
}

static relume_status make_lights(struct relume_vec3 **out, int *n, bool pole_y,
                                 const struct synth_options *o)
{
    if (o->lamp.count) {
        *n = o->lamp.count;
        *out = malloc((size_t)*n * sizeof **out);
        if (!*out)
            return RELUME_ENOMEM;
        memcpy(*out, o->lamp.point, (size_t)*n * sizeof **out);
        return RELUME_OK;
    }
    if (o->lights_from)
        return relume_captured_lights_read(out, n, o->lights_from, o->args.log);
    *n = o->lights;
    *out = malloc((size_t)*n * sizeof **out);
    if (!*out)
        return RELUME_ENOMEM;
    return relume_directions_make(
        *out, *n, o->pattern ? o->pattern : relume_patterns[0],
        relume_directions_params(.log = o->args.log, .seed = (uint64_t)o->seed,
                                 .hemisphere = o->hemisphere, .pole_y = pole_y));
}

// ---------------------------------------------------------------- materials

// Directions of a file that a material can be measured from: the file is at fault, not the usage.
static relume_status read_directions(struct relume_vec3 **out, int *n, const char *file,
                                     const struct synth_options *o)
{
    struct prefix_log about;
    relume_direction_mesh *mesh = NULL;
    relume_status status = relume_captured_lights_read(out, n, file, o->args.log);
    if (!status)
        status =
            relume_direction_mesh_create(&mesh, *out, *n, prefix_log(&about, o->args.log, file));
    relume_direction_mesh_destroy(&mesh);
    return status;
}

static relume_status choose_directions(struct relume_vec3 **out, int *n,
                                       const struct synth_options *o)
{
    const struct relume_btf_set *set = relume_btf_set_find(o->directions);
    if (!set)
        return read_directions(out, n, o->directions, o);
    *n = set->count;
    *out = malloc((size_t)*n * sizeof **out);
    if (!*out)
        return RELUME_ENOMEM;
    relume_btf_set_directions(set, *out);
    return RELUME_OK;
}

static relume_status synth_btf(const struct synth_options *o)
{
    const struct relume_btf_material *material;
    struct relume_vec3 *directions = NULL;
    relume_btf *btf = NULL;
    int n = 0;
    relume_status status = btf_find_material(&material, o->btf, o->args.log);
    if (!status)
        status = choose_directions(&directions, &n, o);
    if (!status)
        status = relume_btf_synth(
            &btf, material,
            relume_btf_synth_params(.log = o->args.log, .size = o->size, .extent = o->extent,
                                    .view = directions, .views = n, .light = directions,
                                    .lights = n, .samples = o->samples,
                                    .bounces =
                                        given(o, &o->bounces) && !o->bounces ? -1 : o->bounces,
                                    .seed = (uint64_t)o->seed, .threads = o->args.threads,
                                    .faults = {.blur = o->blur,
                                               .noise = o->noise,
                                               .shift = o->shift,
                                               .flicker = o->flicker}));
    if (!status)
        status = relume_btf_save(btf, o->output,
                                 relume_btf_params(.log = o->args.log, .force = o->force));
    relume_btf_destroy(&btf);
    free(directions);
    return status;
}

// ---------------------------------------------------------------- scenes

static relume_status capture(const struct relume_scene_kind *kind,
                             const struct relume_synth_params *params,
                             const struct synth_options *o)
{
    relume_scene *scene;
    relume_status status =
        relume_scene_create(&scene, kind, relume_scene_params(.log = o->args.log, .mesh = o->mesh));
    if (!status)
        status = relume_scene_capture(scene, o->output, params);
    relume_scene_destroy(&scene);
    return status;
}

// Whether an option is given that scenes do not have.
static bool of_goniometer(const struct synth_options *o)
{
    return given(o, &o->extent) || given(o, &o->directions) || given(o, &o->blur) ||
           given(o, &o->noise) || given(o, &o->shift) || given(o, &o->flicker);
}

static relume_status run_synth(const struct args *args)
{
    const struct synth_options *o = (const void *)args;
    const struct relume_scene_kind *kind;
    struct relume_vec3 *lights = NULL;
    struct relume_synth_params p = {
        .log = o->args.log,
        .size = o->size,
        .samples = o->samples,
        .bounces = o->bounces,
        .spread = o->spread,
        .seed = (uint64_t)o->seed,
        .threads = o->args.threads,
        .ring = o->ring,
        .eyes = o->eye.point,
        .eye_count = o->eye.count,
        .discs = o->discs,
        .near = o->lamp.count > 0,
        .force = o->force,
    };
    const relume_status refused = relume_folder_check(o->output, p.force, p.log);
    if (refused)
        return refused;
    if (o->btf)
        return o->args.inputs ? usage_error("synth: expected a scene or --btf; found both")
                              : synth_btf(o);
    if (!o->args.inputs)
        return usage_error("synth: expected a scene, or --btf MATERIAL");
    if (o->lamp.count && (o->lights_from || o->hemisphere || given(o, &o->lights) || o->pattern))
        return usage_error("--lamp: these are all lights; expected no --lights, --lights-from, "
                           "--pattern or --hemisphere");
    if (of_goniometer(o))
        return usage_error("synth: --extent, --directions, --blur, --noise, --shift and --flicker "
                           "are of --btf MATERIAL; found a scene");
    relume_status status = choose_scene(&kind, o->args.input[0], args->log);
    if (!status)
        status = choose_views(&p, kind->projection, o);
    if (!status)
        status = make_lights(
            &lights, &p.light_count,
            p.ring || (p.projection_set ? p.projection : kind->projection) > RELUME_SLAB, o);
    p.lights = lights;
    if (!status)
        status = capture(kind, &p, o);
    free(lights);
    return status;
}

const struct command command_synth = {
    COMMAND(run_synth, "synth", "SCENE|--btf MATERIAL -o DIR",
            "render a built-in scene (box, teapot, bust, attic, chessboard, colonnade, cornell) "
            "under many lights",
            "relume synth teapot -o teapot --views 5x5 --lights 100", 0, 1),
    .names_built_in = true,
    .defaults = &(const OPTIONS){.lights = 100, .directions = "bonn"},
};

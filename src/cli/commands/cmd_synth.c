// cmd_synth.c - relume synth: a built-in scene on the virtual light stage
#include "commands/btf_inputs.h"
#include "pattern_option.h"

#include <stdlib.h>

struct synth_options {
    struct args args;
    const char *output, *views, *slabs, *lights_from, *projection, *mesh, *btf, *directions;
    int size, lights, samples, bounces, seed, extent;
    double spread;
    bool hemisphere, discs, force;
    struct texts eye;
    const char *pattern;
};
#define OPTIONS struct synth_options

static const struct option options[] = {
    TEXT_AS(OPTION_OUTPUT, "-o", output, "output", "DIR", "the capture folder to make"),
    INT("--size", size, "scene", "N",
        "width (planar, slab, cube face) or height (panoramas); default 256", 1, 65536),
    TEXT("--views", views, "camera", "GxG", "slab: grid of cameras; default 5x5"),
    NUMBER("--spread", spread, "camera", "S",
           "slab: cameras reach from -S to S; default 0.5, with --slabs wide enough to overlap",
           0.001, 1000),
    TEXT("--slabs", slabs, "camera", "N",
         "slab: number of slabs: 4, 6 or 8 around the object, or cube: 4 and one from above; "
         "default: one"),
    INT("--lights", lights, "lights", "N", "number of light directions; default 100", 1, 65536),
    PATTERN_OPTION,
    FLAG("--hemisphere", hemisphere, "lights",
         "lights on the viewer's (panoramas, --slabs: upper) side only"),
    TEXT("--lights-from", lights_from, "lights", "FILE",
         "directions of a capture.json, a .lp file or lines x y z"),
    TEXT("--projection", projection, "camera", "P",
         "planar, slab, cylindrical, spherical, cube; default: the scene's own"),
    FLAG("--discs", discs, "camera",
         "cylindrical: add the end discs, so that it sees up and down as well"),
    TEXTS("--eye", eye, "camera", "x,y,z", "where the eye is; may be repeated for a slab"),
    INT("--samples", samples, "rendering", "N", "camera rays per pixel; default 16", 1, 65536),
    INT("--bounces", bounces, "rendering", "N", "bounces of indirect light; default 0", 0, 64),
    TEXT("--mesh", mesh, "scene", "FILE", "bust: an OBJ or PLY model"),
    INT("--seed", seed, "rendering", "S", "of random patterns and sampling; default 0", 0,
        2147483647),
    TEXT("--btf", btf, "material", "MATERIAL",
         "render a built-in material as a BTF; --size in texels, default 64"),
    INT("--extent", extent, "material", "N",
        "material: N times as many stones, threads, ... along a side", 1, 16),
    TEXT("--directions", directions, "material", "SET",
         "BTF: of views and lights: bonn (default), dome, coarse, or a file of directions"),
    FLAG("--force", force, "output", "replace a folder that relume made"),
    {0},
};

static relume_status choose_scene(const struct relume_scene_kind **out, const char *name)
{
    const char *names[16];
    int n = 0;
    for (const struct relume_scene_kind *const *k = relume_scenes; *k && n < 15; k++)
        names[n++] = (*k)->name;
    names[n] = NULL;
    *out = relume_scene_find(name);
    return *out ? RELUME_OK : unknown_name("scene", name, names);
}

static relume_status choose_projection(struct relume_synth_params *p, const char *name)
{
    static const char *const names[] = {"planar", "slab", "cylindrical", "spherical", "cube", NULL};
    p->projection_set = name != NULL;
    if (!name || !relume_projection_parse(&p->projection, name))
        return RELUME_OK;
    return unknown_name("projection", name, names);
}

// A scene that is planar by itself becomes a slab by being asked for views.
static relume_status choose_views(struct relume_synth_params *p, enum relume_projection own,
                                  const char *text)
{
    char rest;
    if (!text)
        return RELUME_OK;
    if (sscanf(text, "%4dx%4d%c", &p->grid[0], &p->grid[1], &rest) != 2 || p->grid[0] < 1 ||
        p->grid[1] < 1)
        return usage_error("--views: expected a grid like 5x5; found '%s'", text);
    if (!p->projection_set && own == RELUME_PLANAR) {
        p->projection = RELUME_SLAB;
        p->projection_set = true;
    }
    if ((p->projection_set ? p->projection : own) == RELUME_SLAB)
        return RELUME_OK;
    return usage_error("--views: expected --projection slab, which has views");
}

static relume_status choose_ring(struct relume_synth_params *p, const char *name)
{
    static const char *const names[] = {"4", "6", "8", "cube", NULL};
    if (!name || !relume_ring_parse(&p->ring, name))
        return RELUME_OK;
    return unknown_name("--slabs", name, names);
}

static relume_status choose_eyes(struct relume_vec3 **eyes, int *count,
                                 const struct synth_options *o)
{
    relume_status status = RELUME_OK;
    *count = o->eye.count;
    if (!*count)
        return RELUME_OK;
    *eyes = malloc((size_t)*count * sizeof **eyes);
    if (!*eyes)
        return RELUME_ENOMEM;
    for (int i = 0; i < *count && !status; i++)
        status = args_vec3(&(*eyes)[i], "--eye", o->eye.text[i]);
    return status;
}

static bool is_panorama(enum relume_projection projection)
{
    return projection != RELUME_PLANAR && projection != RELUME_SLAB;
}

static relume_status make_lights(struct relume_vec3 **out, int *n, bool pole_y,
                                 const struct synth_options *o)
{
    const char *file = o->lights_from;
    if (file)
        return relume_captured_lights_read(out, n, file, o->args.log);
    const struct relume_pattern *pattern;
    const relume_status status = choose_pattern(&pattern, o->pattern);
    if (status)
        return status;
    *n = o->lights;
    *out = malloc((size_t)*n * sizeof **out);
    if (!*out)
        return RELUME_ENOMEM;
    return relume_directions_make(
        *out, *n, pattern,
        relume_directions_params(.log = o->args.log, .seed = (uint64_t)o->seed,
                                 .hemisphere = o->hemisphere, .pole_y = pole_y));
}

// ---------------------------------------------------------------- materials

// Directions of a file that a material can be measured from: the file is at fault, not the usage.
static relume_status read_directions(struct relume_vec3 **out, int *n, const char *file,
                                     const struct synth_options *o)
{
    struct prefix_log about;
    relume_direction_mesh *dome = NULL;
    relume_status status = relume_captured_lights_read(out, n, file, o->args.log);
    if (!status)
        status =
            relume_direction_mesh_create(&dome, *out, *n, prefix_log(&about, o->args.log, file));
    relume_direction_mesh_destroy(&dome);
    return status;
}

static relume_status choose_directions(struct relume_vec3 **out, int *n,
                                       const struct synth_options *o)
{
    const char *name = o->directions;
    const struct relume_btf_set *set = relume_btf_set_find(name);
    if (!set)
        return read_directions(out, n, name, o);
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
    relume_status status = btf_find_material(&material, o->btf);
    if (!status)
        status = choose_directions(&directions, &n, o);
    if (!status)
        status = relume_btf_synth(
            &btf, material,
            relume_btf_synth_params(.log = o->args.log, .size = o->size, .extent = o->extent,
                                    .view = directions, .views = n, .light = directions,
                                    .lights = n, .samples = o->samples,
                                    .bounces = args_given(&o->args, &o->bounces) && !o->bounces
                                                   ? -1
                                                   : o->bounces,
                                    .seed = (uint64_t)o->seed, .threads = o->args.threads));
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

static relume_status run(const struct args *args)
{
    const struct synth_options *o = (const void *)args;
    const struct relume_scene_kind *kind;
    struct relume_vec3 *lights = NULL, *eyes = NULL;
    struct relume_synth_params p = {
        .log = o->args.log,
        .size = o->size,
        .samples = o->samples,
        .bounces = o->bounces,
        .spread = o->spread,
        .seed = (uint64_t)o->seed,
        .threads = o->args.threads,
        .discs = o->discs,
        .force = o->force,
    };
    if (!o->output)
        return usage_error("synth: expected -o DIR");
    const relume_status refused = relume_folder_check(o->output, p.force, p.log);
    if (refused)
        return refused;
    if (o->btf)
        return o->args.inputs ? usage_error("synth: expected a scene or --btf; found both")
                              : synth_btf(o);
    if (!o->args.inputs)
        return usage_error("synth: expected a scene, or --btf MATERIAL");
    relume_status status = choose_scene(&kind, o->args.input[0]);
    if (!status)
        status = choose_projection(&p, o->projection);
    if (!status)
        status = choose_views(&p, kind->projection, o->views);
    if (!status)
        status = choose_ring(&p, o->slabs);
    if (!status)
        status = choose_eyes(&eyes, &p.eye_count, o);
    if (!status)
        status = make_lights(
            &lights, &p.light_count,
            p.ring || is_panorama(p.projection_set ? p.projection : kind->projection), o);
    p.lights = lights;
    p.eyes = eyes;
    if (!status)
        status = capture(kind, &p, o);
    free(lights);
    free(eyes);
    return status;
}

const struct command command_synth = {
    .name = "synth",
    .usage = "SCENE|--btf MATERIAL -o DIR",
    .summary = "render a built-in scene (box, teapot, bust, attic, chessboard) under many lights",
    .example = "relume synth teapot -o teapot --views 5x5 --lights 100",
    .min_inputs = 0,
    .max_inputs = 1,
    .options = options,
    .size = sizeof(struct synth_options),
    .defaults = &(const struct synth_options){.lights = 100, .directions = "bonn"},
    .run = run,
};

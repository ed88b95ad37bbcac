// cmd_synth.c - relume synth: a built-in scene on the virtual light stage
#include "pattern_option.h"

#include <stdlib.h>

static const struct option options[] = {
    {"-o", OPTION_OUTPUT, "DIR", "the capture folder to make", 0, 0},
    {"--size", OPTION_INT, "N",
     "width (planar, slab, cube face) or height (panoramas); default 256", 1, 65536},
    {"--views", OPTION_TEXT, "GxG", "slab: grid of cameras; default 5x5", 0, 0},
    {"--spread", OPTION_NUMBER, "S",
     "slab: cameras reach from -S to S; default 0.5, with --slabs wide enough to overlap", 0.001,
     1000},
    {"--slabs", OPTION_TEXT, "N",
     "slab: number of slabs: 4, 6 or 8 around the object, or cube: 4 and one from above; default: "
     "one",
     0, 0},
    {"--lights", OPTION_INT, "N", "number of light directions; default 100", 1, 65536},
    PATTERN_OPTION,
    {"--hemisphere", OPTION_FLAG, NULL,
     "lights on the viewer's (panoramas, --slabs: upper) side only", 0, 0},
    {"--lights-from", OPTION_TEXT, "FILE",
     "directions of a capture.json, a .lp file or lines x y z", 0, 0},
    {"--projection", OPTION_TEXT, "P",
     "planar, slab, cylindrical, spherical, cube; default: the scene's own", 0, 0},
    {"--discs", OPTION_FLAG, NULL,
     "cylindrical: add the end discs, so that it sees up and down as well", 0, 0},
    {"--eye", OPTION_TEXT, "x,y,z", "where the eye is; may be repeated for a slab", 0, 0},
    {"--samples", OPTION_INT, "N", "camera rays per pixel; default 16", 1, 65536},
    {"--bounces", OPTION_INT, "N", "bounces of indirect light; default 0", 0, 64},
    {"--mesh", OPTION_TEXT, "FILE", "bust: an OBJ or PLY model", 0, 0},
    {"--seed", OPTION_INT, "S", "of random patterns and sampling; default 0", 0, 2147483647},
    {"--btf", OPTION_TEXT, "MATERIAL",
     "render a built-in material as a BTF; --size in texels, default 64", 0, 0},
    {"--extent", OPTION_INT, "N", "material: N times as many stones, threads, ... along a side", 1,
     16},
    {"--directions", OPTION_TEXT, "SET",
     "BTF: of views and lights: bonn (default), dome, coarse, or a file of directions", 0, 0},
    {"--force", OPTION_FLAG, NULL, "replace a folder that relume made", 0, 0},
    {NULL, OPTION_FLAG, NULL, NULL, 0, 0},
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

static relume_status choose_eyes(struct relume_vec3 **eyes, int *count, const struct args *args)
{
    relume_status status = RELUME_OK;
    *count = args_count(args, "--eye");
    if (!*count)
        return RELUME_OK;
    *eyes = malloc((size_t)*count * sizeof **eyes);
    if (!*eyes)
        return RELUME_ENOMEM;
    for (int i = 0; i < *count && !status; i++)
        status = args_vec3(&(*eyes)[i], "--eye", args_nth(args, "--eye", i));
    return status;
}

static bool is_panorama(enum relume_projection projection)
{
    return projection != RELUME_PLANAR && projection != RELUME_SLAB;
}

static relume_status make_lights(struct relume_vec3 **out, int *n, bool pole_y,
                                 const struct args *args)
{
    const char *file = args_text(args, "--lights-from", NULL);
    if (file)
        return relume_lights_read(out, n, file, args_log(args));
    const struct relume_pattern *pattern;
    const relume_status status = args_pattern(&pattern, args);
    if (status)
        return status;
    *n = args_int(args, "--lights", 100);
    *out = malloc((size_t)*n * sizeof **out);
    if (!*out)
        return RELUME_ENOMEM;
    return relume_lights_make(
        *out, *n, pattern,
        relume_lights_params(.log = args_log(args), .seed = (uint64_t)args_int(args, "--seed", 0),
                             .hemisphere = args_has(args, "--hemisphere"), .pole_y = pole_y));
}

// ---------------------------------------------------------------- materials

static relume_status choose_material(const struct relume_btf_material **out, const char *name)
{
    const char *names[16];
    int n = 0;
    for (const struct relume_btf_material *const *m = relume_btf_materials; *m && n < 15; m++)
        names[n++] = relume_btf_material_name(*m);
    names[n] = NULL;
    *out = relume_btf_material_find(name);
    return *out ? RELUME_OK : unknown_name("material", name, names);
}

// Directions of a file that a material can be measured from: the file is at fault, not the usage.
static relume_status read_directions(struct relume_vec3 **out, int *n, const char *file,
                                     const struct args *args)
{
    struct prefix_log about;
    relume_dome *dome = NULL;
    relume_status status = relume_lights_read(out, n, file, args_log(args));
    if (!status)
        status = relume_dome_create(&dome, *out, *n, prefix_log(&about, args_log(args), file));
    relume_dome_destroy(&dome);
    return status;
}

static relume_status choose_directions(struct relume_vec3 **out, int *n, const struct args *args)
{
    const char *name = args_text(args, "--directions", "bonn");
    const struct relume_btf_set *set = relume_btf_set_find(name);
    if (!set)
        return read_directions(out, n, name, args);
    *n = set->count;
    *out = malloc((size_t)*n * sizeof **out);
    if (!*out)
        return RELUME_ENOMEM;
    relume_btf_set_directions(set, *out);
    return RELUME_OK;
}

static relume_status synth_btf(const struct args *args)
{
    const struct relume_btf_material *material;
    struct relume_vec3 *directions = NULL;
    relume_btf *btf = NULL;
    int n = 0;
    relume_status status = choose_material(&material, args_text(args, "--btf", NULL));
    if (!status)
        status = choose_directions(&directions, &n, args);
    if (!status)
        status = relume_btf_synth(
            &btf, material,
            relume_btf_synth_params(.log = args_log(args), .size = args_int(args, "--size", 0),
                                    .extent = args_int(args, "--extent", 0), .view = directions,
                                    .views = n, .light = directions, .lights = n,
                                    .samples = args_int(args, "--samples", 0),
                                    .bounces = args_has(args, "--bounces") &&
                                                       !args_int(args, "--bounces", 0)
                                                   ? -1
                                                   : args_int(args, "--bounces", 0),
                                    .seed = (uint64_t)args_int(args, "--seed", 0),
                                    .threads = args_threads(args)));
    if (!status)
        status = relume_btf_save(
            btf, args_text(args, "-o", NULL),
            relume_btf_params(.log = args_log(args), .force = args_has(args, "--force")));
    relume_btf_destroy(&btf);
    free(directions);
    return status;
}

// ---------------------------------------------------------------- scenes

static relume_status capture(const struct relume_scene_kind *kind,
                             const struct relume_synth_params *params, const struct args *args)
{
    relume_scene *scene;
    relume_status status = relume_scene_create(
        &scene, kind,
        relume_scene_params(.log = args_log(args), .mesh = args_text(args, "--mesh", NULL)));
    if (!status)
        status = relume_scene_capture(scene, args_text(args, "-o", NULL), params);
    relume_scene_destroy(&scene);
    return status;
}

static relume_status run(const struct args *args)
{
    const struct relume_scene_kind *kind;
    struct relume_vec3 *lights = NULL, *eyes = NULL;
    struct relume_synth_params p = {
        .log = args_log(args),
        .size = args_int(args, "--size", 0),
        .samples = args_int(args, "--samples", 0),
        .bounces = args_int(args, "--bounces", 0),
        .spread = args_number(args, "--spread", 0.0),
        .seed = (uint64_t)args_int(args, "--seed", 0),
        .threads = args_threads(args),
        .discs = args_has(args, "--discs"),
        .force = args_has(args, "--force"),
    };
    if (!args_has(args, "-o"))
        return usage_error("synth: expected -o DIR");
    if (args_has(args, "--btf"))
        return args_inputs(args) ? usage_error("synth: expected a scene or --btf; found both")
                                 : synth_btf(args);
    if (!args_inputs(args))
        return usage_error("synth: expected a scene, or --btf MATERIAL");
    relume_status status = choose_scene(&kind, args_input(args, 0));
    if (!status)
        status = choose_projection(&p, args_text(args, "--projection", NULL));
    if (!status)
        status = choose_views(&p, kind->projection, args_text(args, "--views", NULL));
    if (!status)
        status = choose_ring(&p, args_text(args, "--slabs", NULL));
    if (!status)
        status = choose_eyes(&eyes, &p.eye_count, args);
    if (!status)
        status = make_lights(
            &lights, &p.light_count,
            p.ring || is_panorama(p.projection_set ? p.projection : kind->projection), args);
    p.lights = lights;
    p.eyes = eyes;
    if (!status)
        status = capture(kind, &p, args);
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
    .run = run,
};

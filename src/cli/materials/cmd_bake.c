// cmd_bake.c - relume bake: objects with their light computed beforehand
#include "cli/cli.h"
#include "cli/frame_options.h"

#include <string.h>

struct bake_options {
    struct args args;
    const char *output;
    const struct relume_basis *basis;
    int coefficients, cube, kept, size[2], views, clusters, components, bounces, rays, directions;
    bool per_view, light_by_light, json;
    struct light_options lighting;
};
#define OPTIONS struct bake_options

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(OPTION_OUTPUT, output, "OUT.exr", "baked object to write"),
    FLAG("--json", json, "print what was made as JSON"),
    GROUP("light"),
    TEXTS("--light", lighting.light, "any|fixed|SPEC",
          "any (default): lit later; fixed: by the lights of --rig and of further --light, as "
          "\"env sunset.hdr\", for ever"),
    TEXT("--rig", lighting.rig, "FILE", "fixed: lights of a rig (JSON)"),
    INT("--bounces", bounces, "N", "how often light goes from surface to surface; default: 2", 0,
        64),
    INT("--rays", rays, "N", "rays from each texel for that light; default: 64", 1, 65536),
    FLAG("--light-by-light", light_by_light,
         "fixed: no spherical harmonics between light and materials; exact, hours"),
    GROUP("any light"),
    ENTRY("--basis", basis, "B", "what lights become: sh (default), table, ...; see 'encode'",
          relume_bases, NULL),
    INT("--coefficients", coefficients, "K", "coefficients of the basis; default: 36, table: 256",
        1, RELUME_MOST_COEFFICIENTS),
    INT("-k", coefficients, "K", NULL, 1, RELUME_MOST_COEFFICIENTS),
    INT("--lights", directions, "N",
        "directions that it is sampled from; default: 12 K, at most 1024", 1,
        RELUME_MOST_COEFFICIENTS),
    INT("--haar", cube, "N",
        "in place of a basis: wavelets on a cube of lights, N x N a face: 2, 4, 8, 16 or 32", 2,
        RELUME_BAKED_MOST_CUBE),
    INT("--keep", kept, "N", "--haar: wavelets kept of a face; default: 20", 1, 1024),
    GROUP("size"),
    SIZE("--size", size, "WxH", "texels of the atlas; default: 256x256", 4, 8192),
    INT("--views", views, "N",
        "views of a texel, N x N; default: 1 if all is matte, else 8, of fixed light 16", 1,
        RELUME_BAKED_MOST_SIDE),
    INT("--clusters", clusters, "N", "groups of like texels; default: 128", 1,
        RELUME_BAKED_MOST_CLUSTERS),
    INT("--components", components, "N", "numbers kept of each texel; default: 8, fixed: 4", 1,
        RELUME_BAKED_MOST_COMPONENTS),
    FLAG("--per-view", per_view, "groups and components for each view of its own"),
    {0},
};

// What --light says besides its two words.
struct wanted {
    bool any, fixed;
    int count;
    const char *spec[MOST_ARGUMENTS];
};

static relume_status find_wanted(struct wanted *w, const struct bake_options *o)
{
    for (int i = 0; i < o->lighting.light.count; i++) {
        const char *text = o->lighting.light.text[i];
        if (!strcmp(text, "any"))
            w->any = true;
        else if (!strcmp(text, "fixed"))
            w->fixed = true;
        else
            w->spec[w->count++] = text;
    }
    w->fixed = w->fixed || w->count || o->lighting.rig;
    if (w->any && w->fixed)
        return usage_error("--light any: takes no lights; they are chosen when it is shown");
    if (w->fixed && (o->basis || o->cube || given(o, &o->coefficients) || o->directions))
        return usage_error("--light fixed: has no basis; leave out --basis, -k, --lights, --haar");
    if (o->cube && (o->basis || o->coefficients || o->directions))
        return usage_error("--haar: is a basis of its own; leave out --basis, -k, --lights");
    if (given(o, &o->kept) && !o->cube)
        return usage_error("--keep: works only with --haar");
    return RELUME_OK;
}

static void tell(const struct bake_options *o, const relume_baked *baked)
{
    const struct relume_baked_info *i = relume_baked_info(baked);
    if (o->json)
        print_baked(o->output, baked, true);
    else
        announce(&o->args, RELUME_NOTE,
                 "%s: %zu texels of %d x %d, %d view%s, %d clusters of %d components, %.2f MB; "
                 "error of the compression %.1f %%",
                 o->output, i->texels, i->width, i->height, i->side * i->side,
                 relume_plural(i->side * i->side), i->clusters, i->components,
                 (double)i->bytes * 1e-6, 100.0 * i->error);
}

static const char *basis_of(const struct relume_baked_info *i)
{
    return i->fixed ? "fixed" : i->cube ? "haar" : i->basis->name;
}

static void print_json(const char *file, const struct relume_baked_info *i)
{
    struct jwriter w = json_to(stdout);
    jopen_object(&w, NULL);
    jput_text(&w, "file", file);
    jput_truth(&w, "fixed", i->fixed);
    jput_text(&w, "basis", basis_of(i));
    jput_integer(&w, "coefficients", i->coefficients);
    jput_integer(&w, "width", i->width);
    jput_integer(&w, "height", i->height);
    jput_integer(&w, "texels", (long long)i->texels);
    jput_integer(&w, "views", i->side * i->side);
    jput_integer(&w, "clusters", i->clusters);
    jput_integer(&w, "components", i->components);
    jput_truth(&w, "per_view", i->per_view);
    jput_integer(&w, "bounces", i->bounces);
    jput_integer(&w, "triangles", (long long)i->triangles);
    jput_integer(&w, "bytes", (long long)i->bytes);
    jput_number(&w, "error", i->error, 9);
    jend(&w);
}

void print_baked(const char *file, const relume_baked *baked, bool json)
{
    const struct relume_baked_info *i = relume_baked_info(baked);
    if (json) {
        print_json(file, i);
        return;
    }
    printf("source        baked object, of %zu triangle%s\n", i->triangles,
           relume_plural((int64_t)i->triangles));
    if (i->fixed)
        printf("light         fixed\n");
    else
        printf("light         any; %s, %d coefficient%s\n", basis_of(i), i->coefficients,
               relume_plural(i->coefficients));
    printf("bounces       %d\n", i->bounces);
    printf("texels        %zu of %d x %d\n", i->texels, i->width, i->height);
    printf("views         %d\n", i->side * i->side);
    printf("compression   %d cluster%s of %d component%s; error %.1f %%\n", i->clusters,
           relume_plural(i->clusters), i->components, relume_plural(i->components),
           100.0 * i->error);
    printf("in memory     %.2f MB\n", (double)i->bytes * 1e-6);
}

static relume_status bake(relume_baked **out, const relume_objects *objects,
                          const struct bake_options *o, const struct wanted *w)
{
    struct light_options own = o->lighting;
    relume_rig *rig = NULL;
    const struct relume_light *lights = NULL;
    int count = 0;
    own.light.count = w->count;
    own.light.text = w->spec;
    relume_status status =
        w->fixed ? parse_lights(&o->args, &own, &rig, &lights, &count) : RELUME_OK;
    if (!status)
        status = relume_bake(
            out, objects,
            relume_bake_params(.log = o->args.log, .threads = o->args.threads, .fixed = lights,
                               .fixed_count = count, .basis = o->basis,
                               .coefficients = o->coefficients, .cube = o->cube, .kept = o->kept,
                               .width = o->size[0], .height = o->size[1], .side = o->views,
                               .clusters = o->clusters, .components = o->components,
                               .light_by_light = o->light_by_light, .per_view = o->per_view,
                               .bounces = given(o, &o->bounces) && !o->bounces ? -1 : o->bounces,
                               .rays = o->rays, .lights = o->directions));
    relume_rig_destroy(&rig);
    return status;
}

static relume_status run_bake(const struct args *args)
{
    const struct bake_options *o = (const void *)args;
    struct wanted wanted = {.any = false};
    relume_objects *objects = NULL;
    relume_baked *baked = NULL;
    relume_status status = find_wanted(&wanted, o);
    if (!status)
        status =
            relume_objects_open(&objects, args->input[0],
                                relume_objects_params(.log = args->log, .threads = args->threads));
    if (!status)
        status = bake(&baked, objects, o, &wanted);
    if (!status)
        status = relume_baked_save(baked, o->output, args->log);
    if (!status)
        tell(o, baked);
    relume_baked_destroy(&baked);
    relume_objects_destroy(&objects);
    return status;
}

const struct command command_bake = {
    COMMAND(run_bake, "bake", "OBJECTS.json|MODEL -o OUT.exr [OPTION ...]",
            "compute the light on objects beforehand: shadows, light from surface to surface",
            "relume bake cow.json -o cow.exr --bounces 3", 1, 1),
};

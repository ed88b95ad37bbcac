// btf_synth.c - relume btf synth: more of a texture or a material than there is
#include "cli/materials/btf_inputs.h"
#include "cli/program/clock.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/resource.h>
#include <time.h>

struct synth_options {
    struct btf_options btf;
    int size[2], method, patch, neighbourhood, alike, pyramid;
    double threshold, weight;
    bool tile, plain, waves;
    const char *save_map, *save_mask, *use_map;
};
#define OPTIONS struct synth_options

static const struct option options[] = {
    GROUP("output"),
    OUTPUT(OPTION_OUTPUT, btf.output, "OUT",
           "of a picture: the larger picture; of a material: the folder of the surface; .npy: the "
           "map alone"),
    SIZE("--size", size, "WxH", "size in texels; default: four times the sample", 1, 65536),
    TEXT_AS(OPTION_OUTPUT, "--save-map", save_map, "FILE",
            "also write which texel of the sample lies where: .npy, or .exr with places from 0 to "
            "1 in red and green"),
    TEXT_AS(OPTION_PICTURE, "--save-mask", save_mask, "FILE",
            "also write the regular structure alone, in grey"),
    FLAG("--force", btf.force, "replace a folder that relume made"),
    GROUP("synthesis"),
    NAME("--method", method, "NAME",
         "patch: squares cut where it shows least (default); pixel: texel by texel", 0, "patch",
         "pixel"),
    FLAG("--tile", tile, "the result goes on at its other side, without a seam"),
    INT("--seed", btf.seed, "S", "seed of the random choices; default: 0", 0, 2147483647),
    INT("--patch", patch, "N",
        "side of a square, even; default: two periods, or a third of the sample", 4, 256),
    INT("--neighbourhood", neighbourhood, "N",
        "pixel: side of the surroundings that are compared, odd; default: 5", 3, 9),
    INT("--alike", alike, "K",
        "pixel: texels that look alike and are tried (k-coherence); 1: none; default: 2", 1, 8),
    INT("--layers", pyramid, "N", "pixel: layers from coarse to fine; default: at most 5", 1, 8),
    TEXT("--map", use_map, "FILE",
         "apply this map instead: another picture of the same sample, as its normals"),
    GROUP("regular structure"),
    NUMBER("--threshold", threshold, "T",
           "smallest wave that is looked for, in steps of 1/255; default: 1", 0.1, 255),
    NUMBER("--weight", weight, "W", "of the structure beside the texels; default: 1", 0.01, 100),
    FLAG("--plain", plain, "look for no regular structure"),
    FLAG("--waves", waves, "print the waves of which the structure is made"),
    GROUP("material"),
    INT("--sample", btf.size, "N", "built-in material: width and height of the sample; default: 64",
        8, 1024),
    FLAG("--fill", btf.fill, "interpolate pictures that are missing in a folder"),
    NUMBERS("--crop", btf.crop, "x,y,w,h",
            ".btf file: read only these texels, counted from the upper left", 4),
    GROUP("report"),
    FLAG("--json", btf.json, "one JSON object"),
    {0},
};

struct job {
    const struct synth_options *o;
    bool picture;
    struct relume_image image;
    struct btf_sample sample;
    struct relume_texture texture;
    relume_regular *regular;
    uint32_t *texel;
    int width, height;
    relume_btf_map *map;
    double analysis_s, synthesis_s, synthesis_cpu_s;
};

static const struct args *args_of(const struct job *j)
{
    return &j->o->btf.args;
}

static bool is_numbers(const char *path)
{
    const size_t n = strlen(path);
    return n > 4 && !strcasecmp(path + n - 4, ".npy");
}

static relume_status load(struct job *j)
{
    const struct args *args = args_of(j);
    const char *input = args->input[0];
    relume_status status;
    if (j->picture) {
        status = relume_image_load(&j->image, input,
                                   relume_image_params(.log = args->log, .limits = &args->limits));
        return status ? status : relume_texture_of_image(&j->texture, &j->image, args->log);
    }
    status = btf_open_sample(&j->sample, input, &j->o->btf);
    return status ? status : relume_btf_texture(&j->texture, j->sample.model, args->threads);
}

// ---------------------------------------------------------------- the map

static relume_status use_map(struct job *j)
{
    const struct args *args = args_of(j);
    const relume_status status =
        relume_btf_map_open(&j->map, j->o->use_map, j->texture.width, j->texture.height,
                            relume_btf_params(.log = args->log, .limits = &args->limits));
    if (status)
        return status;
    const struct relume_btf_map_info *m = relume_btf_map_info(j->map);
    const size_t n = (size_t)m->width * (size_t)m->height;
    j->width = m->width;
    j->height = m->height;
    j->texel = malloc(n * sizeof *j->texel);
    if (j->texel)
        memcpy(j->texel, m->texel, n * sizeof *j->texel);
    return j->texel ? RELUME_OK : RELUME_ENOMEM;
}

// Of all threads so far.
static double cpu_s(void)
{
    struct timespec t;
    return clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t)
               ? 0.0
               : (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static relume_status make_map(struct job *j)
{
    const struct synth_options *o = j->o;
    const struct args *args = args_of(j);
    const double start = now_s(), cpu = cpu_s();
    const struct relume_btf_map_info info = {.sample_width = j->texture.width,
                                             .sample_height = j->texture.height,
                                             .tiles = 1,
                                             .width = j->width,
                                             .height = j->height,
                                             .texel = j->texel,
                                             .columns = 1,
                                             .rows = 1,
                                             .matrix = (const uint16_t[]){0}};
    const relume_status status = relume_texture_grow(
        j->texel, j->width, j->height, &j->texture,
        relume_grow_params(.log = args->log, .method = (enum relume_grow_method)o->method,
                           .seed = (uint64_t)o->btf.seed, .tile = o->tile, .regular = j->regular,
                           .weight = o->weight, .threads = args->threads, .patch = o->patch,
                           .neighbourhood = o->neighbourhood, .alike = o->alike,
                           .levels = o->pyramid));
    j->synthesis_s = now_s() - start;
    j->synthesis_cpu_s = cpu_s() - cpu;
    return status ? status : relume_btf_map_create(&j->map, &info, args->log);
}

static relume_status analyse(struct job *j)
{
    const struct args *args = args_of(j);
    const double start = now_s();
    const relume_status status =
        j->o->plain ? RELUME_OK
                    : relume_regular_find(&j->regular, &j->texture,
                                          relume_regular_params(.log = args->log,
                                                                .threshold = j->o->threshold,
                                                                .threads = args->threads));
    j->analysis_s = now_s() - start;
    if (!status && j->regular && !relume_regular_info(j->regular)->regular && !j->o->use_map)
        announce(args, RELUME_NOTE,
                 "nothing repeats in this sample: synthesised without a regular "
                 "structure");
    return status;
}

static relume_status synthesise(struct job *j)
{
    relume_status status = j->o->use_map ? use_map(j) : RELUME_OK;
    if (!status)
        status = analyse(j);
    if (status || j->o->use_map)
        return status;
    j->width = j->o->size[0] ? j->o->size[0] : 4 * j->texture.width;
    j->height = j->o->size[1] ? j->o->size[1] : 4 * j->texture.height;
    j->texel = malloc((size_t)j->width * (size_t)j->height * sizeof *j->texel);
    return j->texel ? make_map(j) : RELUME_ENOMEM;
}

// ---------------------------------------------------------------- results

static relume_status save_mask(const struct job *j)
{
    const struct args *args = args_of(j);
    struct relume_image mask = {0};
    relume_status status =
        relume_regular_mask(&mask, j->regular, j->width, j->height, args->threads);
    struct relume_image grey = {0};
    if (!status)
        status = relume_image_create(&grey, j->width, j->height, 1);
    for (size_t i = 0; !status && i < (size_t)j->width * (size_t)j->height; i++)
        grey.data[i] = relume_transfer_decode((struct relume_transfer){.curve = RELUME_CURVE_SRGB},
                                              mask.data[i * (size_t)mask.channels]);
    if (!status)
        status = relume_image_save(&grey, j->o->save_mask, relume_image_params(.log = args->log));
    relume_image_destroy(&grey);
    relume_image_destroy(&mask);
    return status;
}

static relume_status save_picture(const struct job *j)
{
    const struct args *args = args_of(j);
    struct relume_image out = {0};
    relume_status status =
        relume_texture_apply(&out, j->texel, j->width, j->height, &j->image, args->threads);
    if (!status)
        status = relume_image_save(&out, j->o->btf.output, relume_image_params(.log = args->log));
    relume_image_destroy(&out);
    return status;
}

static relume_status save_surface(const struct job *j)
{
    const struct args *args = args_of(j);
    relume_btf_fitted *own = NULL;
    relume_btf_surface *surface = NULL;
    relume_status status = j->sample.btf ? btf_fit(&own, j->sample.btf, -1, &j->o->btf) : RELUME_OK;
    if (!status)
        status =
            relume_btf_surface_create(&surface, own ? own : j->sample.model, j->map, args->log);
    if (!status)
        status =
            relume_btf_surface_save(surface, j->o->btf.output,
                                    relume_btf_params(.log = args->log, .force = j->o->btf.force));
    relume_btf_surface_destroy(&surface);
    relume_btf_fitted_destroy(&own);
    return status;
}

static relume_status save(const struct job *j)
{
    const struct relume_btf_params *params = relume_btf_params(.log = args_of(j)->log);
    relume_status status =
        j->o->save_map ? relume_btf_map_save(j->map, j->o->save_map, params) : RELUME_OK;
    if (!status && j->o->save_mask)
        status = save_mask(j);
    if (status)
        return status;
    return is_numbers(j->o->btf.output) ? relume_btf_map_save(j->map, j->o->btf.output, params)
           : j->picture                 ? save_picture(j)
                                        : save_surface(j);
}

// ---------------------------------------------------------------- what is said

static double peak_mb(void)
{
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) ? 0.0 : (double)usage.ru_maxrss / 1024.0;
}

static double period(double base, int side)
{
    return base > 0.0 ? side / base : 0.0;
}

// Says the structure, or with `w` writes it as members of an object.
static void say_structure(const struct job *j, struct jwriter *w)
{
    static const struct relume_regular_info none;
    const struct relume_regular_info *i = j->regular ? relume_regular_info(j->regular) : &none;
    const bool regular = i->regular;
    const double x = regular ? period(i->base[0], j->texture.width) : 0.0,
                 y = regular ? period(i->base[1], j->texture.height) : 0.0;
    if (w) {
        jput_truth(w, "regular", regular);
        jput_integer(w, "waves", regular ? i->count : 0);
        jput_integer(w, "waves_found", i->found);
        jput_fixed(w, "share", regular ? i->share : 0.0, 4);
        jput_truth(w, "common", regular && i->common);
        jopen_array(w, "period");
        jput_fixed(w, NULL, x, 4);
        jput_fixed(w, NULL, y, 4);
        jclose(w);
        jput_fixed(w, "rms_found", i->rms_found, 4);
        jput_fixed(w, "rms_fitted", i->rms_fitted, 4);
        jput_fixed(w, "rms", i->rms, 4);
    } else if (!regular) {
        puts("structure   none that repeats");
    } else if (!i->common) {
        printf("structure   %d waves, %.0f %% of the contrast, without a common period\n", i->count,
               100.0 * i->share);
    } else {
        printf("structure   %d waves, %.0f %% of the contrast, repeats every %.2f x %.2f texels "
               "(0: does not change that way)\n",
               i->count, 100.0 * i->share, x, y);
    }
}

static void say_list(const char *what, const relume_regular *regular)
{
    const struct relume_regular_info *i = relume_regular_info(regular);
    printf("%s\nchannel       b_x       b_y        Re        Im   power over surroundings\n", what);
    for (int k = 0; k < i->count; k++) {
        const struct relume_wave *w = &i->wave[k];
        printf("%7d %9.4f %9.4f %9.2f %9.2f   %.0f\n", w->channel, w->x, w->y, w->re, w->im,
               w->above);
    }
}

// All that were found, then those of the structure.
static relume_status say_waves(const struct job *j)
{
    relume_regular *all;
    const relume_status status = relume_regular_find(
        &all, &j->texture,
        relume_regular_params(.log = args_of(j)->log, .threshold = j->o->threshold, .all = true,
                              .threads = args_of(j)->threads));
    if (status)
        return status;
    say_list("waves that were found", all);
    say_list("waves of the structure", j->regular);
    relume_regular_destroy(&all);
    return RELUME_OK;
}

static relume_status print_json(const struct job *j, const struct relume_grow_quality *q)
{
    struct jwriter w = json_to(stdout);
    jopen_object(&w, NULL);
    jput_integer(&w, "width", j->width);
    jput_integer(&w, "height", j->height);
    jput_integer(&w, "sample_width", j->texture.width);
    jput_integer(&w, "sample_height", j->texture.height);
    say_structure(j, &w);
    jput_fixed(&w, "repetition", q->repetition, 4);
    jopen_array(&w, "repetition_at");
    jput_integer(&w, NULL, q->repetition_at[0]);
    jput_integer(&w, NULL, q->repetition_at[1]);
    jclose(&w);
    jput_fixed(&w, "novelty", q->novelty, 4);
    jput_fixed(&w, "worst", q->worst, 4);
    jput_fixed(&w, "coverage", q->coverage, 4);
    jput_fixed(&w, "cuts", q->cuts, 4);
    jput_fixed(&w, "analysis_s", j->analysis_s, 3);
    jput_fixed(&w, "synthesis_s", j->synthesis_s, 3);
    jput_fixed(&w, "synthesis_cpu_s", j->synthesis_cpu_s, 3);
    jput_fixed(&w, "peak_mb", peak_mb(), 1);
    return jend(&w);
}

static relume_status report(const struct job *j)
{
    const struct args *args = args_of(j);
    struct relume_grow_quality q;
    relume_status status =
        relume_grow_judge(&q, j->texel, j->width, j->height, &j->texture,
                          relume_grow_quality_params(.log = args->log, .regular = j->regular,
                                                     .threads = args->threads));
    if (status)
        return status;
    if (j->o->btf.json)
        return print_json(j, &q);
    printf("size        %d x %d texels from %d x %d\n", j->width, j->height, j->texture.width,
           j->texture.height);
    say_structure(j, NULL);
    if (j->o->waves)
        status = say_waves(j);
    printf("repetition  %.2f at %d, %d (1: the sample laid side by side)\n", q.repetition,
           q.repetition_at[0], q.repetition_at[1]);
    printf("likeness    neighbourhoods are %.2f as far from the sample as its own from each other; "
           "the worst %.2f\n",
           q.novelty, q.worst);
    printf("sample      %.0f %% of its texels are used; %.1f %% of neighbouring texels are "
           "separated by a cut\n",
           100.0 * q.coverage, 100.0 * q.cuts);
    printf("time        structure %.2f s, synthesis %.2f s; %.0f MB at most\n", j->analysis_s,
           j->synthesis_s, peak_mb());
    return status;
}

// ---------------------------------------------------------------- the task

static relume_status check(const struct job *j)
{
    const struct synth_options *o = j->o;
    if (o->plain && (o->waves || o->save_mask))
        return usage_error("--plain: looks for no structure; leave out --waves and --save-mask");
    if (o->use_map && (given(o, o->size) || o->tile))
        return usage_error("--map: the size is that of the map; leave out --size and --tile");
    if (is_numbers(o->btf.output))
        return RELUME_OK;
    return j->picture ? picture_name(args_of(j)->log, "-o", o->btf.output)
                      : relume_folder_check(o->btf.output, o->btf.force, args_of(j)->log);
}

static relume_status synth(const struct args *args)
{
    struct job j = {.o = (const void *)args,
                    .picture = relume_kind_of(args->input[0]) == RELUME_KIND_PICTURE};
    relume_status status = check(&j);
    if (!status)
        status = load(&j);
    if (!status)
        status = synthesise(&j);
    if (!status)
        status = save(&j);
    if (!status)
        status = report(&j);
    free(j.texel);
    relume_btf_map_destroy(&j.map);
    relume_regular_destroy(&j.regular);
    relume_texture_destroy(&j.texture);
    relume_image_destroy(&j.image);
    btf_close_sample(&j.sample);
    return status;
}

static const OPTIONS defaults = {.btf = {.model = -1, .size = 64}};

const struct command btf_task_synth = {
    .name = "btf synth",
    .usage = "BTF|MODEL|MATERIAL|IMAGE -o OUT [OPTION ...]",
    .summary = "make a larger piece of a texture or material, without visible repetition",
    .example = "relume btf synth cloth.jpg -o more.png --size 1024x1024",
    .min_inputs = 1,
    .max_inputs = 1,
    .options = options,
    .size = sizeof(OPTIONS),
    .defaults = &defaults,
    .run = synth,
};

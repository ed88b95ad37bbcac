// btf_tile.c - relume btf tile: a large surface from a sample
#include "cli/materials/btf_inputs.h"

// The model that the surface keeps: the one given, or one fitted to the BTF.
static relume_status choose_model(relume_btf_fitted **own, const relume_btf_fitted **model,
                                  const struct btf_sample *sample, const struct btf_options *o)
{
    *own = NULL;
    *model = sample->model;
    if (!sample->btf)
        return RELUME_OK;
    const relume_status status = btf_fit(own, sample->btf, -1, o);
    *model = *own;
    return status;
}

static relume_status make_map(relume_btf_map **out, const relume_btf_fitted *sample,
                              const struct btf_options *o)
{
    const struct relume_btf_fitted_info *info = relume_btf_fitted_info(sample);
    if (o->map)
        return relume_btf_map_open(out, o->map, info->width, info->height,
                                   relume_btf_params(.log = o->args.log));
    return relume_btf_map_tiles(
        out, sample,
        relume_btf_tiles_params(.log = o->args.log, .tiles = o->tiles, .side = o->tile,
                                .columns = o->matrix[0], .rows = o->matrix[1],
                                .seed = (uint64_t)o->seed, .threads = o->args.threads));
}

static void print_surface_json(const struct relume_btf_surface_info *i,
                               const struct relume_btf_seams *s)
{
    struct jwriter w = json_to(stdout);
    jopen_object(&w, NULL);
    jput_integer(&w, "width", i->width);
    jput_integer(&w, "height", i->height);
    jput_integer(&w, "tiles", i->map->tiles);
    jput_integer(&w, "tile_width", i->map->width);
    jput_integer(&w, "tile_height", i->map->height);
    jput_integer(&w, "columns", i->map->columns);
    jput_integer(&w, "rows", i->map->rows);
    jput_text(&w, "model", relume_btf_model_name(relume_btf_fitted_info(i->model)->model));
    jput_integer(&w, "levels", i->levels);
    jput_integer(&w, "bytes", (long long)i->bytes);
    if (s) {
        jput_fixed(&w, "step_inside", s->inside, 6);
        jput_fixed(&w, "step_across", s->across, 6);
        jput_fixed(&w, "step_unrelated", s->unrelated, 6);
        jput_fixed(&w, "seam_share", s->share, 6);
    }
    jend(&w);
}

void btf_say_surface(const struct relume_btf_surface_info *i, const struct relume_btf_seams *s,
                     bool json)
{
    const char *model = relume_btf_model_name(relume_btf_fitted_info(i->model)->model);
    const double whole = (double)i->width * i->height;
    if (json) {
        print_surface_json(i, s);
        return;
    }
    printf("surface  %d x %d texels\ntiles    %d of %d x %d, laid out %d x %d\nmodel    %s, %d "
           "levels of detail\nbytes    %llu, %.4f a texel of the surface\n",
           i->width, i->height, i->map->tiles, i->map->width, i->map->height, i->map->columns,
           i->map->rows, model, i->levels, (unsigned long long)i->bytes, (double)i->bytes / whole);
    if (s && s->inside > 0.0)
        printf("seams    %.1f %% of neighbouring texels; jumps across seams are %.2f times those "
               "inside the sample (random neighbours: %.2f)\n",
               100.0 * s->share, s->across / s->inside, s->unrelated / s->inside);
}

static relume_status save(const relume_btf_fitted *model, const relume_btf_map *map,
                          const struct relume_btf_seams *seams, const struct btf_options *o)
{
    relume_btf_surface *surface;
    relume_status status = relume_btf_surface_create(&surface, model, map, o->args.log);
    if (!status)
        status = relume_btf_surface_save(surface, o->output,
                                         relume_btf_params(.log = o->args.log, .force = o->force));
    if (!status) {
        btf_say_surface(relume_btf_surface_info(surface), seams, o->json);
    }
    relume_btf_surface_destroy(&surface);
    return status;
}

relume_status btf_tile(const struct args *args)
{
    const struct btf_options *o = (const void *)args;
    struct btf_sample sample;
    struct relume_btf_seams seams;
    const relume_btf_fitted *model = NULL;
    relume_btf_fitted *own = NULL;
    relume_btf_map *map = NULL;
    relume_status status = relume_folder_check(o->output, o->force, o->args.log);
    if (status)
        return status;
    status = btf_open_sample(&sample, o->args.input[0], o);
    if (!status)
        status = make_map(&map, sample.model, o);
    if (!status)
        status = relume_btf_map_seams(&seams, map, sample.model, o->args.log);
    if (!status)
        status = choose_model(&own, &model, &sample, o);
    if (!status)
        status = save(model, map, &seams, o);
    relume_btf_fitted_destroy(&own);
    relume_btf_map_destroy(&map);
    btf_close_sample(&sample);
    return status;
}

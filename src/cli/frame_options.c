// frame_options.c - what `relight` and `query` share: lights, depth, kernels
#include "frame_options.h"
#include "raking.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---------------------------------------------------------------- lights

// Raking light has a fixed height until aim_lights knows the file.
static relume_status add_light(relume_rig *rig, const char *spec, bool of_file,
                               const struct relume_log *log)
{
    struct raking raking;
    if (!of_file || !raking_is(spec))
        return relume_rig_add(rig, spec, NULL, log);
    relume_status status = raking_parse(&raking, spec, log);
    if (status)
        return status;
    const struct relume_vec3 d = raking_stand_in(raking.side);
    const size_t size = strlen(raking.rest) + 96;
    char *words = malloc(size);
    if (!words)
        return RELUME_ENOMEM;
    snprintf(words, size, "dir %.17g %.17g %.17g %s", d.x, d.y, d.z, raking.rest);
    status = relume_rig_add(rig, words, NULL, log);
    free(words);
    return status;
}

static relume_status take_lights(const struct args *args, const struct light_options *o,
                                 bool of_file, relume_rig **rig, const struct relume_light **lights,
                                 int *count)
{
    const int n = o->light.count;
    relume_status status =
        o->rig ? relume_rig_load(rig, o->rig, args->log) : relume_rig_create(rig);
    for (int i = 0; !status && i < (n || o->rig ? n : 1); i++)
        status = add_light(*rig, n ? o->light.text[i] : "dir 0 0 1", of_file, args->log);
    if (!status)
        status = relume_rig_lights(lights, count, *rig);
    if (status)
        relume_rig_destroy(rig);
    return status;
}

relume_status parse_lights(const struct args *args, const struct light_options *o, relume_rig **rig,
                           const struct relume_light **lights, int *count)
{
    return take_lights(args, o, false, rig, lights, count);
}

relume_status parse_lights_of_file(const struct args *args, const struct light_options *o,
                                   relume_rig **rig, const struct relume_light **lights, int *count)
{
    return take_lights(args, o, true, rig, lights, count);
}

// ---------------------------------------------------------------- raking light

static double degrees_above(struct relume_vec3 d)
{
    return atan2(d.z, hypot(d.x, d.y)) * 180.0 / M_PI;
}

static relume_status aim_light(const struct args *args, const char *file, const char *spec,
                               const struct relume_relief *relief, relume_rig *rig, int entry)
{
    struct relume_rig_entry e = *relume_rig_entry(rig, entry);
    struct raking raking;
    const relume_status status = raking_parse(&raking, spec, args->log);
    const int found = status ? -1 : relume_relief_lowest(relief, raking.side, -1);
    if (status || found < 0)
        return status;
    e.light.direction = relief->direction[found];
    announce(args, RELUME_NOTE,
             "%s: raking light is captured light %d, from the %s, %.0f degrees above the picture",
             file, relief->light[found], raking_side_name(e.light.direction),
             degrees_above(e.light.direction));
    return relume_rig_set(rig, entry, &e, args->log);
}

static bool has_raking(const struct light_options *o)
{
    bool any = false;
    for (int i = 0; i < o->light.count; i++)
        any |= raking_is(o->light.text[i]);
    return any;
}

static relume_status check_surface(const char *file, const struct relume_pack_info *info)
{
    if (info->geometry.projection <= RELUME_SLAB && !info->slabs)
        return RELUME_OK;
    return refuse(RELUME_EUNFIT,
                  "%s: raking light needs a picture of a surface, seen from the front; expected "
                  "\"dir x y z\" for a panorama or several slabs",
                  file);
}

relume_status aim_lights(const struct args *args, const struct light_options *o, relume_rig *rig,
                         relume_pack *pack, const char *file, const struct relume_light **lights,
                         int *count)
{
    const int first = relume_rig_count(rig) - o->light.count;
    struct relume_relief relief = {.count = 0};
    if (!has_raking(o))
        return RELUME_OK;
    relume_status status = check_surface(file, relume_pack_info(pack));
    if (!status)
        status = relume_relief_find(
            &relief, pack, relume_relief_params(.log = args->log, .threads = args->threads));
    for (int i = 0; !status && i < o->light.count; i++)
        if (raking_is(o->light.text[i]))
            status = aim_light(args, file, o->light.text[i], &relief, rig, first + i);
    relume_relief_destroy(&relief);
    return status ? status : relume_rig_lights(lights, count, rig);
}

// ---------------------------------------------------------------- rigs, frames

relume_status save_lights(const struct args *args, const struct light_options *o,
                          const relume_rig *rig)
{
    return o->save_rig ? relume_rig_save(rig, o->save_rig, args->log) : RELUME_OK;
}

struct relume_frame_params parse_frame(const struct args *args, const struct light_options *o,
                                       int cpu_mask)
{
    return (struct relume_frame_params){
        .cpu_off = ~(unsigned)cpu_mask,
        .threads = args->threads,
        .assume_depth = o->assume_depth,
    };
}

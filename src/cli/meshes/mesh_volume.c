// mesh_volume.c - relume mesh VOLUME: where the samples of a volume take a value
#include "meshes/mesh_volume.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

relume_status take_volume_size(void *size, const struct option *o, const char *text,
                               const struct relume_log *log)
{
    struct volume_size *const s = size;
    char rest;
    if (sscanf(text, "%5dx%5dx%5d%c", &s->side[0], &s->side[1], &s->side[2], &rest) == 3 &&
        s->side[0] >= 2 && s->side[1] >= 2 && s->side[2] >= 2)
        return RELUME_OK;
    return say(log, RELUME_EINVAL,
               "%s: expected XxYxZ, as 256x256x128, at least 2 each; found '%s'", o->name, text);
}

relume_status take_volume_spacing(void *spacing, const struct option *o, const char *text,
                                  const struct relume_log *log)
{
    struct volume_spacing *const s = spacing;
    char rest;
    s->own = !strcmp(text, "file");
    if (s->own ||
        (sscanf(text, "%lf,%lf,%lf%c", &s->step[0], &s->step[1], &s->step[2], &rest) == 3 &&
         s->step[0] > 0.0 && s->step[1] > 0.0 && s->step[2] > 0.0))
        return RELUME_OK;
    return say(log, RELUME_EINVAL,
               "%s: expected X,Y,Z, three numbers above 0, or 'file'; found "
               "'%s'",
               o->name, text);
}

// "head.ply" and 4: "head.4.ply".
static char *level_name(const char *output, int block, bool several)
{
    const char *dot = strrchr(output, '.');
    const size_t size = strlen(output) + 16;
    char *name = malloc(size);
    if (name && several && dot)
        snprintf(name, size, "%.*s.%d%s", (int)(dot - output), output, block, dot);
    else if (name)
        snprintf(name, size, "%s", output);
    return name;
}

// The meshes of one call, and their files.
struct set {
    const struct args *args;
    int count;
    int block[RELUME_ISOSURFACE_LEVELS];
    char *name[RELUME_ISOSURFACE_LEVELS];
    struct relume_mesh mesh[RELUME_ISOSURFACE_LEVELS];
    struct relume_isosurface_report report[RELUME_ISOSURFACE_LEVELS];
};

static relume_status name_levels(struct set *s, const struct ints *blocks, const char *output)
{
    const struct relume_mesh_params *p = relume_mesh_params(.log = s->args->log);
    s->count = blocks->count ? blocks->count : 1;
    if (s->count > RELUME_ISOSURFACE_LEVELS)
        return usage_error("--block: expected at most %d numbers", RELUME_ISOSURFACE_LEVELS);
    relume_status status = RELUME_OK;
    for (int i = 0; i < s->count && !status; i++) {
        s->block[i] = blocks->count ? blocks->item[i] : 1;
        s->name[i] = level_name(output, s->block[i], s->count > 1);
        for (int k = 0; k < i; k++)
            if (s->block[k] == s->block[i])
                return usage_error("--block: %d comes twice", s->block[i]);
        status = s->name[i] ? relume_mesh_check(s->name[i], p) : RELUME_ENOMEM;
    }
    return status;
}

static relume_status extract(struct set *s, const struct volume_options *o)
{
    relume_volume *volume;
    relume_status status = relume_volume_open(
        &volume, s->args->input[0],
        relume_volume_params(.log = s->args->log,
                             .size = {o->size.side[0], o->size.side[1], o->size.side[2]},
                             .type = o->type, .skip = o->skip,
                             .spacing = {o->spacing.step[0], o->spacing.step[1],
                                         o->spacing.step[2]},
                             .own_spacing = o->spacing.own));
    struct relume_isosurface_params p =
        *relume_isosurface_params(.log = s->args->log, .threads = s->args->threads);
    memcpy(p.blocks, s->block, sizeof p.blocks);
    if (!status)
        status = relume_isosurface(s->mesh, s->report, volume, o->threshold, &p);
    relume_volume_destroy(&volume);
    return status;
}

static void print(const struct set *s, bool json)
{
    for (int i = 0; i < s->count; i++) {
        const struct mesh_made m = {.output = s->name[i],
                                    .mesh = &s->mesh[i],
                                    .seconds = s->report[i].seconds,
                                    .report = &s->report[i],
                                    .block = s->block[i]};
        if (!json) {
            mesh_say(s->args, &m);
            continue;
        }
        printf("%s{", i ? ", " : s->count > 1 ? "{\"meshes\": [" : "");
        mesh_print_json(&m);
        printf("}");
    }
    if (json)
        puts(s->count > 1 ? "]}" : "");
}

relume_status mesh_of_volume(const struct args *args, const struct volume_options *o,
                             const struct ints *blocks, const char *output, bool json)
{
    struct set s = {.args = args};
    relume_status status = name_levels(&s, blocks, output);
    if (!status)
        status = extract(&s, o);
    for (int i = 0; i < s.count && !status; i++)
        status = relume_mesh_write(&s.mesh[i], s.name[i], relume_mesh_params(.log = args->log));
    if (!status)
        print(&s, json);
    for (int i = 0; i < RELUME_ISOSURFACE_LEVELS; i++) {
        relume_mesh_free(&s.mesh[i]);
        free(s.name[i]);
    }
    return status;
}

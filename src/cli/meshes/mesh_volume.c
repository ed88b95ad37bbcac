// mesh_volume.c - relume mesh VOLUME: where the samples of a volume take a value
#include "cli/meshes/mesh_volume.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

relume_status take_volume_thresholds(void *thresholds, const struct option *o, const char *text,
                                     const struct relume_log *log)
{
    struct volume_thresholds *const t = thresholds;
    const char *at = text;
    for (t->count = 0; t->count < MOST_THRESHOLDS; at++) {
        char *end;
        const double value = strtod(at, &end);
        if (end == at || (*end && *end != ',') || !(fabs(value) <= 1e38))
            break;
        t->value[t->count++] = value;
        at = end;
        if (!*end)
            return RELUME_OK;
    }
    return say(log, RELUME_EINVAL,
               "%s: expected 1 to %d numbers, as 80 or 80,95.5, up to 1e38; found '%s'", o->name,
               MOST_THRESHOLDS, text);
}

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

// "head.ply" and "4": "head.4.ply".
static char *name_with(const char *output, const char *what)
{
    const char *dot = strrchr(output, '.');
    const int stem = (int)(dot ? dot - output : (ptrdiff_t)strlen(output));
    const size_t size = strlen(output) + strlen(what) + 2;
    char *name = malloc(size);
    if (name)
        snprintf(name, size, "%.*s%s%s%s", stem, output, *what ? "." : "", what, output + stem);
    return name;
}

// The meshes of one threshold, and their files.
struct set {
    const struct args *args;
    double threshold;
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
        char level[16] = "";
        s->block[i] = blocks->count ? blocks->item[i] : 1;
        if (s->count > 1)
            snprintf(level, sizeof level, "%d", s->block[i]);
        s->name[i] = name_with(output, level);
        for (int k = 0; k < i; k++)
            if (s->block[k] == s->block[i])
                return usage_error("--block: %d comes twice", s->block[i]);
        status = s->name[i] ? relume_mesh_check(s->name[i], p) : RELUME_ENOMEM;
    }
    return status;
}

static relume_status name_set(struct set *s, const struct volume_thresholds *t, int i,
                              const struct ints *blocks, const char *output)
{
    char text[32] = "";
    s->threshold = t->value[i];
    for (int k = 0; k < i; k++)
        if (t->value[k] == t->value[i])
            return usage_error("--threshold: %g comes twice", t->value[i]);
    if (t->count > 1)
        snprintf(text, sizeof text, "%.9g", t->value[i]);
    char *name = name_with(output, text);
    const relume_status status = name ? name_levels(s, blocks, name) : RELUME_ENOMEM;
    free(name);
    return status;
}

// Of several thresholds each then looks at the samples near it alone.
static relume_status open_volume(relume_volume **out, const struct args *args,
                                 const struct volume_options *o)
{
    const relume_status status = relume_volume_open(
        out, args->input[0],
        relume_volume_params(.log = args->log,
                             .size = {o->size.side[0], o->size.side[1], o->size.side[2]},
                             .type = o->type, .skip = o->skip,
                             .spacing = {o->spacing.step[0], o->spacing.step[1],
                                         o->spacing.step[2]},
                             .own_spacing = o->spacing.own));
    return status || o->thresholds.count < 2 ? status : relume_volume_index(*out, args->threads);
}

// Where none is given: which, said.
static void choose_threshold(struct volume_thresholds *t, const struct args *args,
                             const relume_volume *volume)
{
    const struct relume_volume_info info = relume_volume_info(volume);
    t->count = 1;
    t->value[0] = relume_volume_threshold(volume);
    announce(args, RELUME_NOTE,
             "%s: samples are %.6g to %.6g and fall into two kinds at %.6g; --threshold takes "
             "another value",
             args->input[0], (double)info.min, (double)info.max, t->value[0]);
}

static relume_status make_set(struct set *s, const relume_volume *volume)
{
    struct relume_isosurface_params p =
        *relume_isosurface_params(.log = s->args->log, .threads = s->args->threads);
    memcpy(p.blocks, s->block, sizeof p.blocks);
    relume_status status = relume_isosurface(s->mesh, s->report, volume, s->threshold, &p);
    for (int i = 0; i < s->count && !status; i++)
        status =
            relume_mesh_write(&s->mesh[i], s->name[i], relume_mesh_params(.log = s->args->log));
    return status;
}

// Says the meshes, or with `w` writes them.
static void print_set(const struct set *s, struct jwriter *w)
{
    for (int i = 0; i < s->count; i++) {
        const struct mesh_made m = {.output = s->name[i],
                                    .mesh = &s->mesh[i],
                                    .seconds = s->report[i].seconds,
                                    .report = &s->report[i],
                                    .block = s->block[i]};
        if (!w) {
            mesh_say(s->args, &m);
            continue;
        }
        jopen_object(w, NULL);
        jput_number(w, "threshold", s->threshold, 9);
        mesh_put_made(w, &m);
        jclose(w);
    }
}

static void begin_meshes(struct jwriter *w, bool list)
{
    if (!list)
        return;
    jopen_object(w, NULL);
    jopen_array(w, "meshes");
}

static void free_set(struct set *s)
{
    for (int i = 0; i < RELUME_ISOSURFACE_LEVELS; i++) {
        relume_mesh_free(&s->mesh[i]);
        free(s->name[i]);
    }
}

relume_status mesh_of_volume(const struct args *args, const struct volume_options *o,
                             const struct ints *blocks, const char *output, bool json)
{
    struct volume_thresholds t = o->thresholds;
    const bool several = t.count > 1 || blocks->count > 1;
    relume_volume *volume = NULL;
    relume_status status = RELUME_OK;
    // Names first: nothing is done for a wrong one.
    for (int i = 0; i < (t.count ? t.count : 1) && !status; i++) {
        struct set s = {.args = args};
        status = name_set(&s, &t, i, blocks, output);
        free_set(&s);
    }
    if (!status)
        status = open_volume(&volume, args, o);
    if (!status && !t.count)
        choose_threshold(&t, args, volume);
    struct jwriter w = json_to(stdout);
    for (int i = 0; i < t.count && !status; i++) {
        struct set s = {.args = args};
        status = name_set(&s, &t, i, blocks, output);
        if (!status)
            status = make_set(&s, volume);
        if (!status)
            begin_meshes(&w, several && !i && json);
        if (!status)
            print_set(&s, json ? &w : NULL);
        free_set(&s);
    }
    if (!status && json)
        status = jend(&w);
    relume_volume_destroy(&volume);
    return status;
}

// subject.c - one person's measures: defaults, ranges and their file
#include <relume/relight/eye.h>

#include "core/base/tree.h"
#include "core/base/infile.h"
#include "core/base/json.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "relight/eye/eye.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Particles are chosen so that the pattern follows the CIE's standard observer (docs/glare.md).
struct relume_subject relume_subject_default(void)
{
    return (struct relume_subject){
        .seed = 1,
        .pupil = {.hippus = 0.08, .adaptation_s = 1.0},
        .cornea = {.count = 16000, .radius_mm = 0.008, .spread = 2.5, .opacity = 1.0},
        .lens = {.particles = {.count = 750, .radius_mm = 0.045, .spread = 3.0, .opacity = 1.0},
                 .radius_mm = 4.5,
                 .thickness_mm = 4.0,
                 .nucleus = 0.8,
                 .travel_mm = 0.2},
        .fibres = {.spokes = 200,
                   .halo_deg = 3.0,
                   .inner_mm = 1.4,
                   .outer_mm = 2.4,
                   .width_mm = 0.003,
                   .opacity = 0.25},
        .vitreous = {.particles = {.count = 400, .radius_mm = 0.055, .spread = 2.5, .opacity = 1.0},
                     .radius_mm = 11.0,
                     .damping = 3.0,
                     .saccades_per_s = 3.0,
                     .kick = 0.08},
        .lids = {.lashes = 80, .lash_width_mm = 0.08, .blink_interval_s = 4.5, .blink_s = 0.28},
        .optics = {.defocus_dpt = 0.25, .age = 35.0, .pigment = 0.5},
    };
}

// ---------------------------------------------------------------- fields

enum kind { NUMBER, WHOLE, SEED, TRUTH, PICTURE };
struct field {
    const char *group, *name;
    enum kind kind;
    size_t offset;
    double least, most;
};

#define AT(member) offsetof(struct relume_subject, member)
#define PARTICLES(group, member)                                                                   \
    {group, "count", WHOLE, AT(member.count), 0, 20000},                                           \
        {group, "radius_mm", NUMBER, AT(member.radius_mm), 0.001, 1},                              \
        {group, "spread", NUMBER, AT(member.spread), 1, 20},                                       \
    {                                                                                              \
        group, "opacity", NUMBER, AT(member.opacity), 0, 1                                         \
    }

static const struct field fields[] = {
    {NULL, "seed", SEED, AT(seed), 0, 9007199254740992.0},
    {"pupil", "moon_spencer", TRUTH, AT(pupil.moon_spencer), 0, 1},
    {"pupil", "hippus", NUMBER, AT(pupil.hippus), 0, 1},
    {"pupil", "adaptation_s", NUMBER, AT(pupil.adaptation_s), 0.01, 60},
    PARTICLES("cornea", cornea),
    PARTICLES("lens", lens.particles),
    {"lens", "lens_radius_mm", NUMBER, AT(lens.radius_mm), 2, 6},
    {"lens", "thickness_mm", NUMBER, AT(lens.thickness_mm), 1, 8},
    {"lens", "nucleus", NUMBER, AT(lens.nucleus), 0.01, 1},
    {"lens", "travel_mm", NUMBER, AT(lens.travel_mm), 0, 0.5},
    {"fibres", "spokes", WHOLE, AT(fibres.spokes), 0, 20000},
    {"fibres", "halo_deg", NUMBER, AT(fibres.halo_deg), 0, 10},
    {"fibres", "inner_mm", NUMBER, AT(fibres.inner_mm), 0, 6},
    {"fibres", "outer_mm", NUMBER, AT(fibres.outer_mm), 0, 6},
    {"fibres", "width_mm", NUMBER, AT(fibres.width_mm), 0.0005, 0.2},
    {"fibres", "opacity", NUMBER, AT(fibres.opacity), 0, 1},
    PARTICLES("vitreous", vitreous.particles),
    {"vitreous", "body_radius_mm", NUMBER, AT(vitreous.radius_mm), 5, 15},
    {"vitreous", "damping", NUMBER, AT(vitreous.damping), 0.1, 100},
    {"vitreous", "saccades_per_s", NUMBER, AT(vitreous.saccades_per_s), 0, 20},
    {"vitreous", "kick", NUMBER, AT(vitreous.kick), 0, 10},
    {"lids", "lashes", WHOLE, AT(lids.lashes), 0, 1000},
    {"lids", "lash_width_mm", NUMBER, AT(lids.lash_width_mm), 0.001, 0.5},
    {"lids", "blink_interval_s", NUMBER, AT(lids.blink_interval_s), 0, 3600},
    {"lids", "blink_s", NUMBER, AT(lids.blink_s), 0.05, 5},
    {"lids", "squint", NUMBER, AT(lids.squint), 0, 0.99},
    {"lids", "lash_image", PICTURE, AT(lids.lash_image), 0, 0},
    {"optics", "defocus_dpt", NUMBER, AT(optics.defocus_dpt), -5, 5},
    {"optics", "age", NUMBER, AT(optics.age), 1, 120},
    {"optics", "pigment", NUMBER, AT(optics.pigment), 0, 1.2},
};
enum { FIELDS = sizeof fields / sizeof *fields };

static double value_of(const struct relume_subject *s, const struct field *f)
{
    const char *const at = (const char *)s + f->offset;
    switch (f->kind) {
    case NUMBER: return *(const double *)(const void *)at;
    case WHOLE: return *(const int *)(const void *)at;
    case TRUTH: return *(const bool *)(const void *)at;
    case SEED:
    case PICTURE: break;
    }
    return 0.0;
}

static void set_value(struct relume_subject *s, const struct field *f, double value)
{
    char *const at = (char *)s + f->offset;
    switch (f->kind) {
    case NUMBER: *(double *)(void *)at = value; break;
    case WHOLE: *(int *)(void *)at = (int)value; break;
    case TRUTH: *(bool *)(void *)at = value != 0.0; break;
    case SEED: *(uint64_t *)(void *)at = (uint64_t)value; break;
    case PICTURE: break;
    }
}

bool subject_valid(const struct relume_subject *subject, char why[160])
{
    for (int i = 0; i < FIELDS; i++) {
        const double value = value_of(subject, &fields[i]);
        if (value >= fields[i].least && value <= fields[i].most)
            continue;
        snprintf(why, 160, "%s.%s; expected %g to %g; found %g", fields[i].group, fields[i].name,
                 fields[i].least, fields[i].most, value);
        return false;
    }
    return true;
}

// ---------------------------------------------------------------- file

struct reading {
    const char *path;
    const struct relume_log *log;
};

// The line of member `name`, after `group` where there is one; 0 when it is not found. Trees do not
// know their lines, so the text is searched once more, and only for a sentence.
static int line_of(const struct reading *r, const char *group, const char *name)
{
    char *text = NULL;
    size_t size = 0;
    int line = 0, found = 0;
    bool inside = !group;
    char wanted[80], outer[80];
    snprintf(wanted, sizeof wanted, "\"%.70s\"", name);
    snprintf(outer, sizeof outer, "\"%.70s\"", group ? group : "");
    FILE *const file = input_open(r->path, r->log);
    while (file && !found && getline(&text, &size, file) >= 0) {
        const char *at = text;
        line++;
        if (!inside && (at = strstr(text, outer)))
            inside = true;
        if (inside && strstr(at, wanted))
            found = line;
    }
    mem_free_libc(text);
    if (file)
        fclose(file);
    return found;
}

__attribute__((format(printf, 4, 5))) static relume_status fail_field(const struct reading *r,
                                                                      const char *group,
                                                                      const char *name,
                                                                      const char *format, ...)
{
    char sentence[300];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(sentence, sizeof sentence, format, arguments);
    va_end(arguments);
    return log_fail(r->log, RELUME_EFORMAT, "%s: line %d; %s%s%s; %s", r->path,
                    line_of(r, group, name), group ? group : "", group ? "." : "", name, sentence);
}

// Named from the subject's folder; read once to see that it can be.
static relume_status take_picture(struct relume_subject *s, const struct reading *r,
                                  const struct field *f, const jvalue *value)
{
    char *const path = (char *)s + f->offset;
    const char *const name = jvalue_text(value);
    const int folder = name && name[0] != '/' ? path_folder(r->path) : 0;
    struct lashes lashes;
    if (!name || !name[0])
        return fail_field(r, f->group, f->name, "expected a file's name");
    if (snprintf(path, RELUME_SUBJECT_PATH, "%.*s%s", folder, r->path, name) >= RELUME_SUBJECT_PATH)
        return fail_field(r, f->group, f->name, "expected a shorter name");
    const relume_status status = lashes_load(&lashes, path, r->log);
    lashes_destroy(&lashes);
    return status;
}

static relume_status take_field(struct relume_subject *s, const struct reading *r,
                                const struct field *f, const jvalue *value)
{
    if (f->kind == PICTURE)
        return take_picture(s, r, f, value);
    double number = 0.0;
    long long whole = 0;
    bool truth = false;
    if (f->kind == TRUTH) {
        if (!jvalue_truth(value, &truth))
            return fail_field(r, f->group, f->name, "expected true or false");
        number = truth;
    } else if (f->kind == NUMBER) {
        if (!jvalue_number(value, &number))
            return fail_field(r, f->group, f->name, "expected a number");
    } else {
        if (!jvalue_integer(value, &whole))
            return fail_field(r, f->group, f->name, "expected a whole number");
        number = (double)whole;
    }
    if (!(number >= f->least && number <= f->most))
        return fail_field(r, f->group, f->name, "expected %g to %g; found %g", f->least, f->most,
                          number);
    set_value(s, f, number);
    return RELUME_OK;
}

static const struct field *find_field(const char *group, const char *name)
{
    for (int i = 0; i < FIELDS; i++)
        if (!strcmp(fields[i].name, name) &&
            (group ? fields[i].group && !strcmp(fields[i].group, group) : !fields[i].group))
            return &fields[i];
    return NULL;
}

// Names of a group's fields, or of groups for NULL; ends with NULL.
static void names_of(const char *names[FIELDS + 3], const char *group)
{
    int n = 0;
    if (!group) {
        names[n++] = "format";
        names[n++] = "version";
    }
    for (int i = 0; i < FIELDS; i++) {
        const char *const own = fields[i].group;
        if (group && own && !strcmp(own, group))
            names[n++] = fields[i].name;
        else if (!group && (!i || !own || !fields[i - 1].group || strcmp(own, fields[i - 1].group)))
            names[n++] = own ? own : fields[i].name;
    }
    names[n] = NULL;
}

static relume_status check_names(const struct reading *r, const jvalue *object, const char *group)
{
    const char *names[FIELDS + 3];
    names_of(names, group);
    const char *const unknown = jvalue_unknown(object, names);
    if (!unknown)
        return RELUME_OK;
    const char *const near = relume_name_nearest(unknown, names);
    return fail_field(r, group, unknown,
                      "unknown%s%s%s; expected one of the fields in docs/glare.md",
                      near ? "; did you mean \"" : "", near ? near : "", near ? "\"" : "");
}

static relume_status take_all(struct relume_subject *s, const struct reading *r, const jvalue *root)
{
    relume_status status = check_names(r, root, NULL);
    for (int i = 0; !status && i < FIELDS; i++) {
        const char *const group = fields[i].group;
        const jvalue *object = root;
        if (group && (object = jvalue_member(root, group))) {
            if (!jvalue_is_object(object))
                return fail_field(r, NULL, group, "expected an object");
            status = check_names(r, object, group);
        }
        const jvalue *const value = jvalue_member(object, fields[i].name);
        if (!status && value)
            status = take_field(s, r, find_field(group, fields[i].name), value);
    }
    if (!status && s->fibres.inner_mm > s->fibres.outer_mm)
        return fail_field(r, "fibres", "inner_mm", "expected at most outer_mm, %g; found %g",
                          s->fibres.outer_mm, s->fibres.inner_mm);
    return status;
}

static relume_status check_head(const struct reading *r, const jvalue *root)
{
    const char *const format = jvalue_text(jvalue_member(root, "format"));
    long long version;
    if (!format || strcmp(format, "relume-subject"))
        return log_fail(r->log, RELUME_EFORMAT,
                        "%s: no subject; expected \"format\": \"relume-subject\"", r->path);
    if (!jvalue_integer(jvalue_member(root, "version"), &version) || version != 1)
        return log_fail(r->log, RELUME_EUNSUPPORTED, "%s: unknown version; expected \"version\": 1",
                        r->path);
    return RELUME_OK;
}

relume_status relume_subject_load(struct relume_subject *out, const char *path,
                                  const struct relume_log *log)
{
    const struct reading r = {path, log};
    jvalue *root;
    *out = relume_subject_default();
    relume_status status = jvalue_load(&root, path, log);
    if (status)
        return status;
    status = check_head(&r, root);
    if (!status)
        status = take_all(out, &r, root);
    jvalue_free(&root);
    return status;
}

// rig_file.c - rigs as JSON
#include <relume/rig.h>

#include "core/base/context.h"
#include "core/base/json.h"
#include "core/base/json_write.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "relight/light/spec.h"

#include <libgen.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// ---------------------------------------------------------------- reading

// Sentences about an entry begin with the file, its place in it and its number.
struct about {
    struct relume_log log;
    const struct relume_log *to;
    const char *path;
    int light;
    const char *member;  // that is being read, or NULL
};

static void say_about(void *user, enum relume_level level, const char *text)
{
    const struct about *a = user;
    int at[2];
    if (jvalue_place(at, a->path, a->to, "lights", (size_t)a->light - 1, a->member))
        log_line(a->to, level, "%s: line %d, column %d; light %d; %s", a->path, at[0], at[1],
                 a->light, text);
    else
        log_line(a->to, level, "%s: light %d; %s", a->path, a->light, text);
}

static relume_status fail_member(struct about *a, const char *member, const char *expected)
{
    a->member = member;
    return log_wrong(&a->log, NULL, member, expected);
}

static relume_status take_truth(struct about *a, const jvalue *object, const char *member,
                                bool *out)
{
    const jvalue *value = jvalue_member(object, member);
    return !value || jvalue_truth(value, out) ? RELUME_OK : fail_member(a, member, "true or false");
}

static relume_status take_values(struct about *a, const jvalue *object, struct relume_rig_entry *e)
{
    const jvalue *colour = jvalue_member(object, "rgb");
    const jvalue *intensity = jvalue_member(object, "intensity");
    const jvalue *name = jvalue_member(object, "name");
    double rgb[3];
    if (name && !(e->name = jvalue_text(name)))
        return fail_member(a, "name", "a text");
    if (intensity && !jvalue_number(intensity, &e->intensity))
        return fail_member(a, "intensity", "a number");
    if (colour && !jvalue_numbers(colour, rgb, 3))
        return fail_member(a, "rgb", "three numbers");
    for (int c = 0; colour && c < 3; c++)
        e->light.rgb[c] = (float)rgb[c];
    const relume_status status = take_truth(a, object, "on", &e->on);
    return status ? status : take_truth(a, object, "solo", &e->solo);
}

static relume_status take_light(relume_rig *rig, const jvalue *object, const char *folder,
                                struct about *a)
{
    static const char *const members[] = {"name", "light", "rgb", "intensity", "on", "solo", NULL};
    if (!jvalue_is_object(object))
        return log_fail(&a->log, RELUME_EFORMAT, "expected an object");
    const char *unknown = jvalue_unknown(object, members);
    if (unknown)
        return fail_member(a, unknown, "name, light, rgb, intensity, on or solo");
    const char *spec = jvalue_text(jvalue_member(object, "light"));
    if (!spec)
        return fail_member(a, "light", "words such as \"dir 0 0 1\"");
    a->member = "light";
    relume_status status = relume_rig_add(rig, spec, folder, &a->log);
    a->member = NULL;
    if (status)
        return status == RELUME_EINVAL ? RELUME_EFORMAT : status;
    const int index = relume_rig_count(rig) - 1;
    struct relume_rig_entry entry = *relume_rig_entry(rig, index);
    status = take_values(a, object, &entry);
    if (!status)
        status = relume_rig_set(rig, index, &entry, &a->log);
    return status == RELUME_EINVAL ? RELUME_EFORMAT : status;
}

// `member` of the file itself, absent ones at its beginning.
static relume_status wrong_head(const char *path, const char *member, const char *expected,
                                const struct relume_log *log)
{
    int at[2] = {1, 1};
    (void)jvalue_place(at, path, log, NULL, 0, member);
    return log_fail(log, RELUME_EFORMAT, "%s: line %d, column %d; %s; expected %s", path, at[0],
                    at[1], member, expected);
}

static relume_status check_head(const jvalue *root, const char *path, const struct relume_log *log)
{
    static const char *const members[] = {"format", "version", "lights", NULL};
    const char *format = jvalue_text(jvalue_member(root, "format"));
    const char *unknown = jvalue_unknown(root, members);
    long long version;
    if (!format || strcmp(format, "relume-rig"))
        return wrong_head(path, "format", "a rig of lights, \"relume-rig\"", log);
    if (!jvalue_integer(jvalue_member(root, "version"), &version) || version != 1)
        return wrong_head(path, "version", "1", log);
    if (unknown)
        return wrong_head(path, unknown, "format, version or lights", log);
    if (!jvalue_is_array(jvalue_member(root, "lights")))
        return wrong_head(path, "lights", "an array", log);
    return RELUME_OK;
}

static relume_status take_lights(relume_rig *rig, const jvalue *root, const char *path,
                                 const struct relume_log *log)
{
    const jvalue *lights = jvalue_member(root, "lights");
    char *copy = mem_text(path);
    relume_status status = copy ? RELUME_OK : RELUME_ENOMEM;
    const char *folder = copy ? dirname(copy) : NULL;
    for (size_t i = 0; !status && i < jvalue_count(lights); i++) {
        struct about about = {
            {say_about, NULL, &about, context_of(log), false}, log, path, (int)i + 1, NULL};
        status = take_light(rig, jvalue_item(lights, i), folder, &about);
    }
    mem_free(copy);
    return status;
}

relume_status relume_rig_load(relume_rig **out, const char *path, const struct relume_log *log)
{
    jvalue *root;
    *out = NULL;
    relume_status status = jvalue_load(&root, path, log);
    if (status)
        return status;
    status = check_head(root, path, log);
    if (!status)
        status = relume_rig_create(out);
    if (!status)
        status = take_lights(*out, root, path, log);
    if (status)
        relume_rig_destroy(out);
    jvalue_free(&root);
    return status;
}

// ---------------------------------------------------------------- writing

// `file` as seen from `folder`, both without links; `file` itself where one of them cannot be
// found. NULL when memory is short.
static char *relative(const char *file, const char *folder)
{
    char from[PATH_MAX], to[PATH_MAX], up[PATH_MAX] = "";
    if (!realpath(folder, from) || !realpath(file, to))
        return mem_text(file);
    size_t same = 0, end = 0;
    while (from[end] && from[end] == to[end])
        if (to[end++] == '/')
            same = end;
    if (!from[end] && to[end] == '/')
        same = end + 1;
    for (const char *rest = strlen(from) < same ? "" : from + same; *rest; rest += *rest == '/') {
        rest += strcspn(rest, "/");
        if (strlen(up) + 4 > sizeof up)
            return mem_text(file);
        strcat(up, "../");
    }
    return mem_format("%s%s", up, to + same);
}

static void put_light(struct jwriter *w, const struct relume_rig_entry *e, const char *folder)
{
    char *file = e->file ? relative(e->file, folder) : NULL;
    char *words = file || !e->file ? spec_text(&e->light, file) : NULL;
    if (!words)
        jfail(w, RELUME_ENOMEM);
    jgap(w, "\n    ");
    jopen_object(w, NULL);
    jgap(w, " ");
    jput_text(w, "name", e->name);
    jput_text(w, "light", words);
    jput_floats(w, "rgb", e->light.rgb, 3, 9);
    jgap(w, "\n      ");
    jput_number(w, "intensity", e->intensity, 17);
    jput_truth(w, "on", e->on);
    jput_truth(w, "solo", e->solo);
    jgap(w, " ");
    jclose(w);
    mem_free(words);
    mem_free(file);
}

relume_status relume_rig_save(const relume_rig *rig, const char *path, const struct relume_log *log)
{
    char *copy = mem_text(path);
    const char *folder = copy ? dirname(copy) : NULL;
    struct jwriter w = {.status = copy ? RELUME_OK : RELUME_ENOMEM};
    jopen_object(&w, NULL);
    jgap(&w, " ");
    jput_text(&w, "format", "relume-rig");
    jput_integer(&w, "version", 1);
    jgap(&w, "\n  ");
    jopen_array(&w, "lights");
    for (int i = 0; copy && i < relume_rig_count(rig); i++)
        put_light(&w, relume_rig_entry(rig, i), folder);
    jgap(&w, " ");
    jclose(&w);
    jgap(&w, " ");
    const relume_status status = jsave(&w, path, log);
    mem_free(copy);
    return status;
}

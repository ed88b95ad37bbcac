// lights_read.c - lights from whatever file holds some
#include "capture/manifest/light_list.h"
#include "capture/manifest/loaded_lights.h"
#include "capture/manifest/manifest.h"
#include "core/base/infile.h"
#include "core/base/log.h"
#include "core/base/memory.h"

#include <errno.h>
#include <relume/image/directions.h>
#include <stdio.h>
#include <string.h>

// JSON starts with a brace or a bracket, perhaps behind comments and blank lines.
static relume_status look(bool *json, const char *path, const struct relume_log *log)
{
    FILE *file = input_open(path, log);
    char line[256];
    const char *start = "";
    if (!file)
        return relume_input_fail(log, path, "cannot be opened", errno);
    while ((!*start || *start == '#') && fgets(line, sizeof line, file))
        start = line + strspn(line, " \t\r\n\xef\xbb\xbf");
    *json = *start == '{' || *start == '[';
    fclose(file);
    return RELUME_OK;
}

// The lights' names, where all have one; false without memory.
static bool list_names(struct relume_captured_lights *out, const jvalue *list)
{
    const size_t n = jvalue_count(list);
    for (size_t i = 0; i < n; i++)
        if (!jvalue_text(jvalue_member(jvalue_item(list, i), "name")))
            return true;
    out->name = mem_zeroed(n, sizeof *out->name);
    for (size_t i = 0; out->name && i < n; i++)
        if (!(out->name[i] = mem_text(jvalue_text(jvalue_member(jvalue_item(list, i), "name")))))
            return false;
    return out->name != NULL;
}

// [[x, y, z], ...], or objects that have such a "direction", "dir" or "position".
static relume_status list_lights(struct relume_captured_lights *out, const jvalue *list,
                                 const char *path, const struct relume_log *log)
{
    static const char *const keys[] = {"direction", "dir", "position"};
    const size_t n = jvalue_count(list);
    if (n < 1 || n > (size_t)limits_or_default(NULL).max_lights)
        return log_fail(log, RELUME_EFORMAT, "%s: no light directions; expected [x, y, z] for each",
                        path);
    out->direction = mem_array(n, sizeof *out->direction);
    if (!out->direction)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < n; i++) {
        const jvalue *item = jvalue_item(list, i), *vector = item;
        double v[3] = {0.0, 0.0, 0.0};
        for (size_t k = 0; jvalue_is_object(item) && k < sizeof keys / sizeof *keys; k++)
            vector = jvalue_is_array(vector) ? vector : jvalue_member(item, keys[k]);
        const bool good = jvalue_numbers(vector, v, 3);
        out->direction[i] = (struct relume_vec3){v[0], v[1], v[2]};
        if (!good || !direction_normalise(&out->direction[i]))
            return log_fail(log, RELUME_EFORMAT,
                            "%s: light %zu; expected three numbers x y z, not all 0", path, i);
    }
    out->count = (int)n;
    return list_names(out, list) ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status from_json(struct relume_captured_lights *out, const char *path,
                               const struct relume_log *log)
{
    jvalue *root;
    relume_status status = jvalue_load(&root, path, log);
    const jvalue *lights = jvalue_member(root, "lights");
    const jvalue *list = jvalue_is_array(root) ? root : jvalue_is_array(lights) ? lights : NULL;
    if (!status && list)
        status = list_lights(out, list, path, log);
    else if (!status)
        status = (is_dome(root) ? dome_lights : manifest_lights)(out, root, path, log);
    jvalue_free(&root);
    return status;
}

// The names of a list; false without memory.
static bool copy_names(struct relume_captured_lights *out, const struct light_list *list)
{
    if (!list->name)
        return true;
    out->name = mem_zeroed((size_t)list->count, sizeof *out->name);
    for (int i = 0; out->name && i < list->count; i++)
        if (!(out->name[i] = mem_text(list->name[i])))
            return false;
    return out->name != NULL;
}

static relume_status from_text(struct loaded_lights *out, const char *path, bool positions,
                               const struct relume_log *log)
{
    struct relume_captured_lights *lights = &out->lights;
    struct light_list list;
    relume_status status = light_list_read(&list, path, NULL, log);
    if (!status) {
        const size_t n = (size_t)list.count;
        const bool places = positions && !list.angles;
        lights->count = list.count;
        lights->direction = mem_copy(list.direction, n, sizeof *lights->direction);
        lights->position = places ? mem_copy(list.vector, n, sizeof *lights->position) : NULL;
        out->line = mem_copy(list.line, n, sizeof *out->line);
        out->numbered = list.numbered;
        out->unit = list.unit;
        if (!lights->direction || (places && !lights->position) || !out->line ||
            !copy_names(lights, &list))
            status = RELUME_ENOMEM;
    }
    light_list_free(&list);
    return status;
}

void relume_captured_lights_destroy(struct relume_captured_lights *list)
{
    mem_free(list->direction);
    mem_free(list->position);
    mem_free(list->intensity);
    for (int i = 0; list->name && i < list->count; i++)
        mem_free(list->name[i]);
    mem_free(list->name);
    *list = (struct relume_captured_lights){0};
}

void loaded_lights_free(struct loaded_lights *list)
{
    mem_free(list->line);
    relume_captured_lights_destroy(&list->lights);
    *list = (struct loaded_lights){0};
}

struct light_names loaded_lights_names(const struct loaded_lights *list, const char *path)
{
    return (struct light_names){.path = path,
                                .count = list->lights.count,
                                .name = (const char *const *)list->lights.name,
                                .line = list->line,
                                .numbered = list->numbered};
}

relume_status loaded_lights_load(struct loaded_lights *out, const char *path, bool positions,
                                 const struct relume_log *log)
{
    bool json;
    *out = (struct loaded_lights){.unit = true};
    relume_status status = look(&json, path, log);
    if (!status)
        status = json ? from_json(&out->lights, path, log) : from_text(out, path, positions, log);
    if (!status && positions && !out->lights.position)
        status = log_fail(log, RELUME_EUNFIT,
                          "%s: holds directions only; expected positions of near lights", path);
    if (status)
        loaded_lights_free(out);
    return status;
}

relume_status relume_captured_lights_load(struct relume_captured_lights *out, const char *path,
                                          bool positions, const struct relume_log *log)
{
    struct loaded_lights list;
    const relume_status status = loaded_lights_load(&list, path, positions, log);
    *out = list.lights;
    mem_free(list.line);
    return status;
}

relume_status relume_captured_lights_read(struct relume_vec3 **out, int *n, const char *path,
                                          const struct relume_log *log)
{
    struct relume_captured_lights list;
    const relume_status status = relume_captured_lights_load(&list, path, false, log);
    *out = list.direction;
    *n = list.count;
    list.direction = NULL;
    relume_captured_lights_destroy(&list);
    return status;
}

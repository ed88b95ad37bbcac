// object_set.c - objects that a session shows
#include "session/object_set.h"

#include <relume/exchange.h>
#include <stdio.h>
#include <string.h>

static void warn_translucent(const relume_objects *objects, const struct relume_log *log)
{
    const struct relume_objects_info *info = relume_objects_info(objects);
    for (int i = 0; i < info->materials; i++)
        if (info->material[i].translucent) {
            if (log && log->message)
                log->message(log->user, RELUME_NOTE,
                             "translucent materials are shown matte by passes; relume relight and "
                             "relume btf render show light going through them");
            return;
        }
}

static relume_status open_described(struct object_set *set,
                                    const struct relume_objects_params *params)
{
    const struct object_options *wanted = &set->wanted;
    const relume_status status = relume_objects_open(&set->objects, wanted->description, params);
    if (!status)
        warn_translucent(set->objects, params->log);
    return status || !wanted->reflections
               ? status
               : relume_objects_load_reflections(
                     set->objects, wanted->reflections,
                     relume_reflection_params(.log = params->log, .threads = params->threads));
}

relume_status object_set_open(struct object_set *set, const struct object_options *wanted,
                              int threads, const struct relume_log *log)
{
    const struct relume_objects_params params = {.log = log, .threads = threads};
    *set = (struct object_set){.wanted = *wanted};
    snprintf(set->described, sizeof set->described, "%s",
             wanted->description ? wanted->description : "");
    snprintf(set->reflections, sizeof set->reflections, "%s",
             wanted->reflections ? wanted->reflections : "");
    if (wanted->description)
        return open_described(set, &params);
    if (wanted->materials == 1)
        snprintf(set->material, sizeof set->material, "%s", wanted->material[0]);
    return wanted->materials ? relume_objects_of_mesh(&set->objects, wanted->mesh, wanted->material,
                                                      wanted->materials, wanted->repeat, &params)
                             : RELUME_OK;
}

bool object_file_is_material(const char *path)
{
    const enum relume_kind kind = relume_kind_of(path);
    return kind == RELUME_KIND_MATERIAL || kind == RELUME_KIND_FITTED ||
           kind == RELUME_KIND_SURFACE;
}

bool object_file_is_description(const char *path)
{
    const enum relume_kind kind = relume_kind_of(path);
    return kind == RELUME_KIND_MODEL || kind == RELUME_KIND_BAKED || kind == RELUME_KIND_OBJECTS;
}

relume_status object_set_replace(struct object_set *set, const char *path, int threads,
                                 const struct relume_log *log)
{
    const struct relume_objects_params params = {.log = log, .threads = threads};
    const bool material = object_file_is_material(path);
    relume_objects *objects;
    const relume_status status = material
                                     ? relume_objects_of_mesh(&objects, set->wanted.mesh, &path, 1,
                                                              set->wanted.repeat, &params)
                                     : relume_objects_open(&objects, path, &params);
    if (status)
        return status;
    warn_translucent(objects, log);
    set->objects = objects;
    snprintf(set->material, sizeof set->material, "%s", material ? path : "");
    snprintf(set->described, sizeof set->described, "%s", material ? "" : path);
    set->reflections[0] = '\0';
    return RELUME_OK;
}

// rig.c - named sets of lights: made, changed, and kept alive with what they point at
#include <relume/rig.h>

#include "core/base/log.h"
#include "core/base/memory.h"
#include "relight/light/environment.h"
#include "relight/light/light.h"
#include "relight/light/spec.h"

#include <math.h>
#include <string.h>

// A file that lights need, opened once.
struct resource {
    enum relume_light_kind kind;
    char *path;
    struct relume_image image;
    relume_environment *environment;
    relume_ies *ies;
    relume_gonio *gonio;
};

struct relume_rig {
    int count;
    struct relume_rig_entry **entry;  // [count], strings are owned
    int resources;
    struct resource **resource;
    struct relume_light *shining;
};

// ---------------------------------------------------------------- memory

static void entry_free(struct relume_rig_entry *e)
{
    if (!e)
        return;
    mem_free((char *)(uintptr_t)e->name);
    mem_free((char *)(uintptr_t)e->spec);
    mem_free((char *)(uintptr_t)e->file);
    mem_free(e);
}

static void resource_free(struct resource *r)
{
    if (!r)
        return;
    relume_image_destroy(&r->image);
    relume_environment_destroy(&r->environment);
    relume_ies_destroy(&r->ies);
    relume_gonio_destroy(&r->gonio);
    mem_free(r->path);
    mem_free(r);
}

relume_status relume_rig_create(relume_rig **out)
{
    *out = mem_zeroed(1, sizeof **out);
    return *out ? RELUME_OK : RELUME_ENOMEM;
}

void relume_rig_destroy(relume_rig **rig)
{
    relume_rig *r = *rig;
    if (!r)
        return;
    for (int i = 0; i < r->count; i++)
        entry_free(r->entry[i]);
    for (int i = 0; i < r->resources; i++)
        resource_free(r->resource[i]);
    mem_free(r->entry);
    mem_free(r->resource);
    mem_free(r->shining);
    mem_free(r);
    *rig = NULL;
}

// ---------------------------------------------------------------- files

static relume_status open_resource(struct resource *r, const struct relume_log *log)
{
    switch (r->kind) {
    case RELUME_LIGHT_SLIDE:
        return relume_image_load(&r->image, r->path, relume_image_params(.log = log));
    case RELUME_LIGHT_ENVIRONMENT: return relume_environment_load(&r->environment, r->path, log);
    case RELUME_LIGHT_IES: return relume_ies_load(&r->ies, r->path, log);
    case RELUME_LIGHT_GONIO: return relume_gonio_load(&r->gonio, r->path, log);
    case RELUME_LIGHT_DIRECTIONAL:
    case RELUME_LIGHT_POINT:
    case RELUME_LIGHT_SPOT:
    case RELUME_LIGHT_AREA: break;
    }
    return RELUME_EINVAL;
}

// NaN would spread over the pixels beside it.
static void clean_picture(struct resource *r, const struct relume_log *log)
{
    const size_t n = (size_t)r->image.width * (size_t)r->image.height * 3;
    size_t bad = 0;
    for (size_t i = 0; i < n; i++)
        if (!(r->image.data[i] >= 0.0f && r->image.data[i] <= 1e9f)) {
            r->image.data[i] = 0.0f;
            bad++;
        }
    if (bad)
        log_line(log, RELUME_WARNING,
                 "%s: %zu pixel%s negative, not finite or above 1e9; treated as black", r->path,
                 bad, bad == 1 ? " is" : "s are");
}

static relume_status find_resource(struct resource **out, relume_rig *rig,
                                   enum relume_light_kind kind, const char *path,
                                   const struct relume_log *log)
{
    for (int i = 0; i < rig->resources; i++) {
        *out = rig->resource[i];
        if ((*out)->kind == kind && !strcmp((*out)->path, path))
            return RELUME_OK;
    }
    struct resource *r = mem_zeroed(1, sizeof *r);
    if (!r || !mem_grow(&rig->resource, (size_t)rig->resources, sizeof *rig->resource)) {
        mem_free(r);
        return RELUME_ENOMEM;
    }
    r->kind = kind;
    r->path = mem_text(path);
    const relume_status status = r->path ? open_resource(r, log) : RELUME_ENOMEM;
    if (status) {
        resource_free(r);
        return status;
    }
    if (kind == RELUME_LIGHT_SLIDE)
        clean_picture(r, log);
    *out = rig->resource[rig->resources++] = r;
    return RELUME_OK;
}

// ---------------------------------------------------------------- entries

static relume_status attach(relume_rig *rig, struct relume_rig_entry *e,
                            const struct relume_log *log)
{
    struct resource *r = NULL;
    const relume_status status = find_resource(&r, rig, e->light.kind, e->file, log);
    if (status)
        return status;
    e->light.image = r->image.data ? &r->image : NULL;
    e->light.environment = r->environment;
    e->light.ies = r->ies;
    e->light.gonio = r->gonio;
    return RELUME_OK;
}

static relume_status make_entry(struct relume_rig_entry *e, relume_rig *rig,
                                const struct spec *spec, const char *folder,
                                const struct relume_log *log)
{
    e->light = spec->light;
    e->on = true;
    e->intensity = 1.0;
    e->name = mem_format("%s %d", relume_light_kind_name(spec->light.kind), rig->count + 1);
    e->file = spec->file ? (folder && spec->file[0] != '/' ? mem_format("%s/%s", folder, spec->file)
                                                           : mem_text(spec->file))
                         : NULL;
    if (!e->name || (spec->file && !e->file))
        return RELUME_ENOMEM;
    e->spec = spec_text(&e->light, e->file);
    if (!e->spec)
        return RELUME_ENOMEM;
    return e->file ? attach(rig, e, log) : RELUME_OK;
}

relume_status relume_rig_add(relume_rig *rig, const char *spec, const char *folder,
                             const struct relume_log *log)
{
    struct spec parsed;
    if (rig->count >= RELUME_RIG_MOST)
        return log_fail(log, RELUME_EINVAL, "too many lights; expected at most %d",
                        RELUME_RIG_MOST);
    relume_status status = spec_parse(&parsed, spec, log);
    if (status)
        return status;
    struct relume_rig_entry *e = mem_zeroed(1, sizeof *e);
    status = e && mem_grow(&rig->entry, (size_t)rig->count, sizeof *rig->entry) ? RELUME_OK
                                                                                : RELUME_ENOMEM;
    if (!status)
        status = make_entry(e, rig, &parsed, folder, log);
    mem_free(parsed.file);
    if (status)
        entry_free(e);
    else
        rig->entry[rig->count++] = e;
    return status;
}

static bool has(const relume_rig *rig, int index)
{
    return index >= 0 && index < rig->count;
}

relume_status relume_rig_remove(relume_rig *rig, int index)
{
    if (!has(rig, index))
        return RELUME_EINVAL;
    entry_free(rig->entry[index]);
    rig->count--;
    memmove(rig->entry + index, rig->entry + index + 1,
            (size_t)(rig->count - index) * sizeof *rig->entry);
    return RELUME_OK;
}

int relume_rig_count(const relume_rig *rig)
{
    return rig->count;
}

const struct relume_rig_entry *relume_rig_entry(const relume_rig *rig, int index)
{
    return has(rig, index) ? rig->entry[index] : NULL;
}

// ---------------------------------------------------------------- changes

static struct relume_light scaled(const struct relume_rig_entry *e)
{
    struct relume_light light = e->light;
    for (int c = 0; c < 3; c++)
        light.rgb[c] = (float)((double)light.rgb[c] * e->intensity);
    return light;
}

// The wanted light with the kind and the files that the entry has.
static struct relume_light changed(const struct relume_rig_entry *old,
                                   const struct relume_rig_entry *want)
{
    struct relume_light light = want->light;
    light.kind = old->light.kind;
    light.image = old->light.image;
    light.environment = old->light.environment;
    light.ies = old->light.ies;
    light.gonio = old->light.gonio;
    return light;
}

static relume_status check(const struct relume_rig_entry *e, const struct relume_log *log)
{
    if (!(e->intensity >= 0.0 && isfinite(e->intensity)))
        return log_fail(log, RELUME_EINVAL,
                        "light '%s': expected an intensity of 0 or more, found %g", e->name,
                        e->intensity);
    const struct relume_light light = scaled(e);
    const char *wrong = light_complaint(&e->light, true);
    if (!wrong)
        wrong = light_complaint(&light, true);
    return wrong ? log_fail(log, RELUME_EINVAL, "light '%s': %s", e->name, wrong) : RELUME_OK;
}

relume_status relume_rig_set(relume_rig *rig, int index, const struct relume_rig_entry *entry,
                             const struct relume_log *log)
{
    if (!has(rig, index))
        return RELUME_EINVAL;
    struct relume_rig_entry *old = rig->entry[index];
    struct relume_rig_entry next = *entry;
    next.light = changed(old, entry);
    next.file = old->file;
    relume_status status = check(&next, log);
    if (status)
        return status;
    const bool renamed = strcmp(entry->name, old->name) != 0;
    next.name = renamed ? mem_text(entry->name) : old->name;
    next.spec = spec_text(&next.light, next.file);
    if (!next.name || !next.spec) {
        mem_free((char *)(uintptr_t)(renamed ? next.name : NULL));
        mem_free((char *)(uintptr_t)next.spec);
        return RELUME_ENOMEM;
    }
    mem_free((char *)(uintptr_t)(renamed ? old->name : NULL));
    mem_free((char *)(uintptr_t)old->spec);
    *old = next;
    return RELUME_OK;
}

relume_status relume_rig_lights(const struct relume_light **out, int *n, relume_rig *rig)
{
    bool solo = false;
    *out = NULL;
    *n = 0;
    mem_free(rig->shining);
    rig->shining = mem_array((size_t)rig->count, sizeof *rig->shining);
    if (!rig->shining)
        return RELUME_ENOMEM;
    for (int i = 0; i < rig->count; i++)
        solo = solo || (rig->entry[i]->on && rig->entry[i]->solo);
    for (int i = 0; i < rig->count; i++)
        if (rig->entry[i]->on && (rig->entry[i]->solo || !solo))
            rig->shining[(*n)++] = scaled(rig->entry[i]);
    *out = rig->shining;
    return RELUME_OK;
}

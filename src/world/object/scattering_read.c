// scattering_read.c - translucent materials in the description of objects
#include "core/base/log.h"
#include "core/base/memory.h"
#include "world/object/object.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// A number for all colours, or one for each.
static bool read_colours(const jvalue *value, float out[3])
{
    double f[3];
    if (!jvalue_numbers(value, f, 3)) {
        if (!jvalue_number(value, &f[0]))
            return false;
        f[1] = f[2] = f[0];
    }
    for (int c = 0; c < 3; c++)
        out[c] = (float)f[c];
    return true;
}

static relume_status find_preset(struct translucent *out, const char *name,
                                 const struct relume_log *log)
{
    const struct scattering_preset *preset = scattering_find(name);
    char all[512];
    size_t n = 0;
    for (const struct scattering_preset *p = scattering_presets; p->name; p++)
        n += (size_t)snprintf(all + n, sizeof all - n, "%s%s", n ? ", " : "", p->name);
    if (!preset)
        return log_fail(log, RELUME_EFORMAT, "translucent: expected one of %s; found '%s'", all,
                        name);
    out->name = preset->name;
    out->scattering = preset->scattering;
    return RELUME_OK;
}

static relume_status read_colour_member(float out[3], const jvalue *value, const char *member,
                                        bool above, const struct relume_log *log)
{
    const float MOST = 1e6f;
    if (!read_colours(jvalue_member(value, member), out))
        return log_fail(log, RELUME_EFORMAT,
                        "translucent: %s: expected a number per mm or [r, g, b]", member);
    for (int c = 0; c < 3; c++)
        if (!(above ? out[c] > 0.0f : out[c] >= 0.0f) || !(out[c] <= MOST))
            return log_fail(log, RELUME_EFORMAT, "translucent: %s: expected %s 0 to %g; found %g",
                            member, above ? "above" : "from", (double)MOST, (double)out[c]);
    return RELUME_OK;
}

static relume_status read_own(struct translucent *out, const jvalue *value,
                              const struct relume_log *log)
{
    const double LEAST = 1.0, MOST = 3.0;
    const jvalue *index = jvalue_member(value, "index");
    double n = 1.3;
    struct scattering *s = &out->scattering;
    out->name = "translucent";
    relume_status status = read_colour_member(s->absorption, value, "absorption", false, log);
    if (!status)
        status = read_colour_member(s->reduced, value, "reduced_scattering", true, log);
    if (!status && index && !(jvalue_number(index, &n) && n >= LEAST && n <= MOST))
        status =
            log_fail(log, RELUME_EFORMAT, "translucent: index: expected %g to %g", LEAST, MOST);
    s->index = (float)n;
    return status;
}

static relume_status read_scale(struct translucent *out, const jvalue *value,
                                const struct relume_log *log)
{
    const double LEAST = 1e-6, MOST = 1e9;
    const jvalue *scale = jvalue_member(value, "scale_mm");
    if (!scale || (jvalue_number(scale, &out->mm) && out->mm >= LEAST && out->mm <= MOST))
        return RELUME_OK;
    return log_fail(log, RELUME_EFORMAT,
                    "translucent: scale_mm: expected how many mm a unit of the world is, %g to %g",
                    LEAST, MOST);
}

relume_status translucent_read(struct translucent *out, const jvalue *value,
                               const struct relume_log *log)
{
    static const char *const known[] = {"preset", "absorption", "reduced_scattering",
                                        "index",  "scale_mm",   NULL};
    *out = (struct translucent){.mm = 0.0};
    if (jvalue_text(value))
        return find_preset(out, jvalue_text(value), log);
    if (!jvalue_is_object(value))
        return log_fail(log, RELUME_EFORMAT,
                        "translucent: expected the name of a material, as \"marble\", or an object "
                        "of absorption and reduced_scattering");
    const char *stranger = jvalue_unknown(value, known);
    const char *preset = jvalue_text(jvalue_member(value, "preset"));
    if (stranger)
        return log_fail(log, RELUME_EFORMAT, "translucent: unknown member '%s'", stranger);
    if (jvalue_member(value, "preset") && !preset)
        return log_fail(log, RELUME_EFORMAT, "translucent: preset: expected a name");
    if (preset && (jvalue_member(value, "absorption") || jvalue_member(value, "index") ||
                   jvalue_member(value, "reduced_scattering")))
        return log_fail(log, RELUME_EFORMAT,
                        "translucent: expected a preset or its own numbers, not both");
    const relume_status status = preset ? find_preset(out, preset, log) : read_own(out, value, log);
    return status ? status : read_scale(out, value, log);
}

// lights_dome.c - the geometry of a light dome, as RelightLab keeps it (.dome, JSON)
//
// Positions are in mm from the middle of the picture, z towards the camera; what counts is their
// ratio to imageWidth. Three forms stand side by side, lightConfiguration says which one is in use.
#include "capture/manifest/manifest.h"

#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/math/vec.h"

#include <stdio.h>
#include <string.h>

enum { FORMS = 3 };
static const struct {
    const char *configuration, *key;
} forms[FORMS] = {
    {"directional", "directions"},
    {"spherical", "positionsSphere"},
    {"lights3d", "positions3d"},
};

bool is_dome(const jvalue *root)
{
    return jvalue_member(root, "lightConfiguration") || jvalue_member(root, "positionsSphere");
}

// {"x":..., "y":..., "z":...} or [x, y, z].
static bool triple(double out[3], const jvalue *value, const char *const keys[3])
{
    if (jvalue_is_array(value))
        return jvalue_numbers(value, out, 3);
    for (int i = 0; i < 3; i++)
        if (!jvalue_number(jvalue_member(value, keys[i]), &out[i]))
            return false;
    return true;
}

static relume_status read_vectors(struct relume_captured_lights *out, const jvalue *array,
                                  double scale, const char *key, const char *path,
                                  const struct relume_log *log)
{
    static const char *const xyz[3] = {"x", "y", "z"};
    const size_t n = jvalue_count(array);
    char where[64];
    if (n < 1 || n > (size_t)limits_or_default(NULL).max_lights)
        return log_wrong(log, path, key, "one {x, y, z} for every light, within the limits");
    out->count = (int)n;
    out->direction = mem_array(n, sizeof *out->direction);
    out->position = mem_array(n, sizeof *out->position);
    if (!out->direction || !out->position)
        return RELUME_ENOMEM;
    for (size_t i = 0; i < n; i++) {
        double v[3];
        snprintf(where, sizeof where, "%s[%zu]", key, i);
        if (!triple(v, jvalue_item(array, i), xyz))
            return log_wrong(log, path, where, "three finite numbers x, y, z");
        out->position[i] = vec3_scale(vec3_of(v[0], v[1], v[2]), scale);
        out->direction[i] = out->position[i];
        if (!direction_normalise(&out->direction[i]))
            return log_wrong(log, path, where, "a light away from the middle of the picture");
    }
    return RELUME_OK;
}

static relume_status read_adjustments(struct relume_captured_lights *out, const jvalue *array,
                                      const char *path, const struct relume_log *log)
{
    static const char *const rgb[3] = {"r", "g", "b"};
    if (!jvalue_count(array))
        return RELUME_OK;
    if (jvalue_count(array) != (size_t)out->count)
        return log_wrong(log, path, "ledAdjust", "one {r, g, b} for every light");
    out->intensity = mem_array((size_t)out->count, sizeof *out->intensity);
    if (!out->intensity)
        return RELUME_ENOMEM;
    for (int i = 0; i < out->count; i++)
        for (int c = 0; c < 3; c++) {
            double gain[3];
            if (!triple(gain, jvalue_item(array, (size_t)i), rgb) || !(gain[c] >= 1e-6) ||
                gain[c] > 1e6)
                return log_wrong(log, path, "ledAdjust",
                                 "three numbers from 1e-6 to 1e6 for every light");
            out->intensity[i][c] = (float)(1.0 / gain[c]);
        }
    return RELUME_OK;
}

relume_status dome_lights(struct relume_captured_lights *out, const jvalue *root, const char *path,
                          const struct relume_log *log)
{
    const char *named = jvalue_text(jvalue_member(root, "lightConfiguration"));
    const jvalue *width = jvalue_member(root, "imageWidth");
    double width_mm = 0.0;
    int form = 0;
    *out = (struct relume_captured_lights){0};
    while (named && form < FORMS && strcmp(named, forms[form].configuration))
        form++;
    if (!named || form == FORMS)
        return log_wrong(log, path, "lightConfiguration", "directional, spherical or lights3d");
    if (width && (!jvalue_number(width, &width_mm) || width_mm < 0.0))
        return log_wrong(log, path, "imageWidth", "a width in mm");
    relume_status status =
        read_vectors(out, jvalue_member(root, forms[form].key),
                     2.0 / (width_mm > 0.0 ? width_mm : 1.0), forms[form].key, path, log);
    if (!status)
        status = read_adjustments(out, jvalue_member(root, "ledAdjust"), path, log);
    if (form == 0) {
        mem_free(out->position);
        out->position = NULL;
    }
    return status;
}

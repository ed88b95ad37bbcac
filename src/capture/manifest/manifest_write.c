// manifest_write.c - capture.json, written
#include "capture/manifest/manifest.h"

#include "core/base/json.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/outfile.h"
#include "image/geometry/print.h"

#include <stdio.h>
#include <stdlib.h>

static void put_text(FILE *f, const char *text)
{
    char *quoted = jvalue_quote(text);
    fputs(quoted ? quoted : "\"\"", f);
    mem_free(quoted);
}

static void put_vectors(FILE *f, const char *key, const struct relume_vec3 *v, int n)
{
    fprintf(f, "    \"%s\": [", key);
    for (int i = 0; i < n; i++)
        fprintf(f, "%s\n      [%.9g, %.9g, %.9g]", i ? "," : "", v[i].x, v[i].y, v[i].z);
    fputs("\n    ]", f);
}

static void put_lights(FILE *f, const struct relume_manifest *m)
{
    fputs("  \"lights\": {\n", f);
    put_vectors(f, "directions", m->directions, m->lights);
    if (m->intensities) {
        fputs(",\n    \"intensities\": [", f);
        for (int i = 0; i < m->lights; i++)
            fprintf(f, "%s\n      [%.9g, %.9g, %.9g]", i ? "," : "", (double)m->intensities[i][0],
                    (double)m->intensities[i][1], (double)m->intensities[i][2]);
        fputs("\n    ]", f);
    }
    if (m->positions) {
        fputs(",\n", f);
        put_vectors(f, "positions", m->positions, m->lights);
        if (m->no_falloff)
            fputs(",\n    \"falloff\": \"none\"", f);
    }
    fputs("\n  },\n", f);
}

static void put_slabs(FILE *f, const struct relume_manifest *m)
{
    fputs("  \"slabs\": [", f);
    for (int i = 0; i < m->slabs; i++) {
        const struct relume_pose *pose = &m->slab[i].pose;
        fputs(i ? ",\n    " : "\n    ", f);
        geometry_print_planes(f, &m->slab[i]);
        fprintf(f, ",\n     \"origin\": [%.9g, %.9g, %.9g], \"axes\": [", pose->origin.x,
                pose->origin.y, pose->origin.z);
        for (int a = 0; a < 3; a++)
            fprintf(f, "%s[%.9g, %.9g, %.9g]", a ? ", " : "", pose->axis[a].x, pose->axis[a].y,
                    pose->axis[a].z);
        fputs("]}", f);
    }
    fputs("\n  ],\n", f);
}

static void put_geometry(FILE *f, const struct relume_manifest *m)
{
    if (!m->slabs) {
        geometry_print(f, &m->geometry);
        return;
    }
    geometry_print_projection(f, &m->geometry);
    put_slabs(f, m);
}

static void put_view(FILE *f, const struct relume_manifest *m, const struct relume_manifest_view *v)
{
    fputs("    {", f);
    if (m->geometry.projection == RELUME_SLAB)
        fprintf(f, "\"uv\": [%.9g, %.9g], ", v->uv[0], v->uv[1]);
    if (m->slabs)
        fprintf(f, "\"slab\": %d, ", v->slab);
    if (v->depth) {
        fputs("\"depth\": ", f);
        put_text(f, v->depth);
        fputs(", ", f);
    }
    if (v->mask) {
        fputs("\"mask\": ", f);
        put_text(f, v->mask);
        fputs(", ", f);
    }
    fputs("\"images\": [", f);
    for (int i = 0; i < m->lights; i++) {
        fputs(i ? ", " : "", f);
        put_text(f, v->images[i]);
    }
    fputs("]}", f);
}

relume_status relume_manifest_write(const struct relume_manifest *manifest, const char *path,
                                    const struct relume_log *log)
{
    char *text = NULL;
    size_t size = 0;
    if (manifest->transfer.curve == RELUME_CURVE_RESPONSE)
        return log_fail(log, RELUME_EINVAL,
                        "%s: a response curve lives in a file of its own; expected linear pictures",
                        path);
    FILE *f = open_memstream(&text, &size);
    if (!f)
        return RELUME_ENOMEM;
    char transfer[32];
    relume_transfer_text(manifest->transfer, transfer, sizeof transfer);
    fprintf(f, "{\n  \"format\": \"relume-capture\",\n  \"version\": %d,\n", MANIFEST_VERSION);
    if (manifest->transfer.curve != RELUME_CURVE_AUTO)
        fprintf(f, "  \"transfer\": \"%s\",\n", transfer);
    if (manifest->provenance)
        fprintf(f, "  \"provenance\": %s,\n", manifest->provenance);
    put_geometry(f, manifest);
    put_lights(f, manifest);
    fputs("  \"views\": [\n", f);
    for (int i = 0; i < manifest->views; i++) {
        put_view(f, manifest, &manifest->view[i]);
        fputs(i + 1 < manifest->views ? ",\n" : "\n", f);
    }
    fputs("  ]\n}\n", f);
    const bool failed = fclose(f) != 0;
    const relume_status status = failed ? RELUME_ENOMEM : outfile_save(path, text, size, log);
    mem_free_libc(text);
    return status;
}

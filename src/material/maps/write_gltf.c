// write_gltf.c - maps on a plane or on a displaced mesh, as glTF 2.0
//
// The normal map is that of the plane also where the mesh is displaced: its vertices keep the
// plane's normal, so that the relief is shaded once, by the map, and displacement adds parallax and
// outlines.
#include "material/maps/write.h"

#include "core/base/memory.h"
#include "core/math/bilinear.h"
#include "core/math/scalar.h"

#include <string.h>

enum { FLOATS = 3 + 3 + 4 + 2 };  // position, normal, tangent, texture

struct grid {
    int columns, rows;  // of cells
    size_t vertices, indices;
    float least[3], most[3];
};

static struct grid grid_of(const struct writing *w)
{
    const struct relume_maps *m = w->maps;
    const int columns = w->params->mesh ? w->params->mesh : 1;
    const int rows =
        w->params->mesh ? larger_of((int)lrint((double)columns * m->height / m->width), 1) : 1;
    const struct grid g = {
        .columns = columns,
        .rows = rows,
        .vertices = (size_t)(columns + 1) * (size_t)(rows + 1),
        .indices = 6 * (size_t)columns * (size_t)rows,
        .least = {INFINITY, INFINITY, INFINITY},
        .most = {-INFINITY, -INFINITY, -INFINITY},
    };
    return g;
}

static void put_vertex(float *v, struct grid *g, const struct writing *w, int i, int j)
{
    const struct relume_maps *m = w->maps;
    const double u = (double)i / g->columns, down = (double)j / g->rows;
    const double width = m->pixel * m->width * w->metres;
    const struct bilinear b =
        bilinear_at(u * m->width - 0.5, down * m->height - 0.5, m->width, m->height, EDGE_CLAMPED);
    const double z = w->params->mesh ? bilinear_value(&b, m->height_map.data, 1, 0) * w->metres : 0;
    const float made[FLOATS] = {
        (float)((u - 0.5) * width),
        (float)((0.5 - down) * width * m->height / m->width),
        (float)z,
        0,
        0,
        1,  // normal
        1,
        0,
        0,
        1,  // tangent along u; its binormal is up the picture
        (float)u,
        (float)down,
    };
    memcpy(v, made, sizeof made);
    for (int c = 0; c < 3; c++) {
        g->least[c] = fminf(g->least[c], v[c]);
        g->most[c] = fmaxf(g->most[c], v[c]);
    }
}

static void put_cells(char *to, const struct grid *g)
{
    for (int j = 0; j < g->rows; j++)
        for (int i = 0; i < g->columns; i++) {
            const uint32_t a = (uint32_t)(j * (g->columns + 1) + i), b = a + 1;
            const uint32_t c = a + (uint32_t)g->columns + 1, d = c + 1;
            const uint32_t cell[6] = {a, c, b, b, c, d};
            memcpy(to, cell, sizeof cell);
            to += sizeof cell;
        }
}

static relume_status write_mesh(const struct writing *w, struct grid *g)
{
    const size_t vertices = g->vertices * FLOATS, size = vertices + g->indices;
    float *data = mem_array(size, sizeof *data);
    if (!data)
        return RELUME_ENOMEM;
    float *vertex = data;
    for (int j = 0; j <= g->rows; j++)
        for (int i = 0; i <= g->columns; i++, vertex += FLOATS)
            put_vertex(vertex, g, w, i, j);
    put_cells((char *)vertex, g);
    const relume_status status = write_bytes(w, "model.bin", data, size * sizeof *data);
    mem_free(data);
    return status;
}

// ---------------------------------------------------------------- model.gltf

static void put_material(FILE *f, const struct writing *w)
{
    fputs("\"materials\": [{\"name\": \"maps\", \"doubleSided\": true,\n", f);
    if (w->masked)
        fputs("    \"alphaMode\": \"MASK\", \"alphaCutoff\": 0.5,\n", f);
    fprintf(
        f,
        "    \"pbrMetallicRoughness\": {\"baseColorTexture\": {\"index\": 0}, "
        "\"metallicRoughnessTexture\": {\"index\": 1}},\n"
        "    \"normalTexture\": {\"index\": 2}, \"occlusionTexture\": {\"index\": 1},\n"
        "    \"extensions\": {\"KHR_materials_specular\": {\"specularTexture\": {\"index\": 3}, "
        "\"specularColorTexture\": {\"index\": 3},\n"
        "        \"specularColorFactor\": [%.9g, %.9g, %.9g]}}}],\n",
        w->specular_most, w->specular_most, w->specular_most);
}

static void put_textures(FILE *f, const struct writing *w)
{
    const char *const image[] = {"basecolor.png", "orm.png", w->gl_normal, "specular.png"};
    fputs("\"images\": [", f);
    for (int i = 0; i < 4; i++)
        fprintf(f, "%s{\"uri\": \"%s\"}", i ? ", " : "", image[i]);
    fputs("],\n\"samplers\": [{\"magFilter\": 9729, \"minFilter\": 9987, \"wrapS\": 33071, "
          "\"wrapT\": 33071}],\n\"textures\": [",
          f);
    for (int i = 0; i < 4; i++)
        fprintf(f, "%s{\"sampler\": 0, \"source\": %d}", i ? ", " : "", i);
    fputs("],\n", f);
}

static void put_accessors(FILE *f, const struct grid *g)
{
    static const struct {
        const char *type;
        int offset;
    } part[] = {{"VEC3", 0}, {"VEC3", 12}, {"VEC4", 24}, {"VEC2", 40}};
    fputs("\"accessors\": [\n", f);
    for (int i = 0; i < 4; i++) {
        fprintf(f,
                "    {\"bufferView\": 0, \"byteOffset\": %d, \"componentType\": 5126, \"count\": "
                "%zu, \"type\": \"%s\"",
                part[i].offset, g->vertices, part[i].type);
        if (i == 0)
            fprintf(f, ",\n        \"min\": [%.9g, %.9g, %.9g], \"max\": [%.9g, %.9g, %.9g]",
                    (double)g->least[0], (double)g->least[1], (double)g->least[2],
                    (double)g->most[0], (double)g->most[1], (double)g->most[2]);
        fputs("},\n", f);
    }
    fprintf(f,
            "    {\"bufferView\": 1, \"componentType\": 5125, \"count\": %zu, \"type\": "
            "\"SCALAR\"}],\n",
            g->indices);
}

static void put_buffers(FILE *f, const struct grid *g)
{
    const size_t stride = FLOATS * sizeof(float), vertices = g->vertices * stride;
    const size_t indices = g->indices * sizeof(uint32_t);
    fprintf(f,
            "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": %zu, \"byteStride\": %zu, "
            "\"target\": 34962},\n    {\"buffer\": 0, \"byteOffset\": %zu, \"byteLength\": %zu, "
            "\"target\": 34963}],\n\"buffers\": [{\"uri\": \"model.bin\", \"byteLength\": %zu}]\n",
            vertices, stride, vertices, indices, vertices + indices);
}

static relume_status write_scene(const struct writing *w, const struct grid *g)
{
    char *text = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&text, &size);
    if (!f)
        return RELUME_ENOMEM;
    fputs("{\n\"asset\": {\"version\": \"2.0\", \"generator\": \"relume " RELUME_VERSION "\"},\n"
          "\"extensionsUsed\": [\"KHR_materials_specular\"],\n"
          "\"scene\": 0, \"scenes\": [{\"nodes\": [0]}], \"nodes\": [{\"mesh\": 0}],\n"
          "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0, \"NORMAL\": 1, "
          "\"TANGENT\": 2, \"TEXCOORD_0\": 3}, \"indices\": 4, \"material\": 0}]}],\n",
          f);
    put_material(f, w);
    put_textures(f, w);
    put_accessors(f, g);
    put_buffers(f, g);
    fputs("}\n", f);
    const relume_status status =
        fclose(f) ? RELUME_ENOMEM : write_bytes(w, "model.gltf", text, size);
    mem_free_libc(text);
    return status;
}

relume_status write_gltf(const struct writing *w)
{
    struct grid g = grid_of(w);
    const relume_status status = write_mesh(w, &g);
    return status ? status : write_scene(w, &g);
}

// write_gltf.c - maps on a plane or on a displaced mesh, as glTF 2.0
//
// The normal map is that of the plane also where the mesh is displaced: its vertices keep the
// plane's normal, so that the relief is shaded once, by the map, and displacement adds parallax and
// outlines.
#include "material/maps/write.h"

#include "core/base/json_write.h"
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

// The picture of a material's property, by its index.
static void put_texture(struct jwriter *w, const char *key, int index)
{
    jopen_object(w, key);
    jput_integer(w, "index", index);
    jclose(w);
}

static void put_specular(struct jwriter *w, double most)
{
    jopen_object(w, "extensions");
    jopen_object(w, "KHR_materials_specular");
    put_texture(w, "specularTexture", 3);
    put_texture(w, "specularColorTexture", 3);
    jgap(w, "\n        ");
    jput_numbers(w, "specularColorFactor", (const double[]){most, most, most}, 3, 9);
    jclose_levels(w, 2);
}

static void put_material(struct jwriter *w, const struct writing *writing)
{
    jgap(w, "\n");
    jopen_array(w, "materials");
    jopen_object(w, NULL);
    jput_text(w, "name", "maps");
    jput_truth(w, "doubleSided", true);
    if (writing->masked) {
        jgap(w, "\n    ");
        jput_text(w, "alphaMode", "MASK");
        jput_number(w, "alphaCutoff", 0.5, 1);
    }
    jgap(w, "\n    ");
    jopen_object(w, "pbrMetallicRoughness");
    put_texture(w, "baseColorTexture", 0);
    put_texture(w, "metallicRoughnessTexture", 1);
    jclose(w);
    jgap(w, "\n    ");
    put_texture(w, "normalTexture", 2);
    put_texture(w, "occlusionTexture", 1);
    jgap(w, "\n    ");
    put_specular(w, writing->specular_most);
    jclose_levels(w, 2);
}

static void put_textures(struct jwriter *w, const char *normal)
{
    const char *const image[] = {"basecolor.png", "orm.png", normal, "specular.png"};
    jgap(w, "\n");
    jopen_array(w, "images");
    for (int i = 0; i < 4; i++) {
        jopen_object(w, NULL);
        jput_text(w, "uri", image[i]);
        jclose(w);
    }
    jclose(w);
    jgap(w, "\n");
    jput_raw(w, "samplers",
             "[{\"magFilter\": 9729, \"minFilter\": 9987, \"wrapS\": 33071, \"wrapT\": 33071}]");
    jgap(w, "\n");
    jopen_array(w, "textures");
    for (int i = 0; i < 4; i++) {
        jopen_object(w, NULL);
        jput_integer(w, "sampler", 0);
        jput_integer(w, "source", i);
        jclose(w);
    }
    jclose(w);
}

static void put_accessors(struct jwriter *w, const struct grid *g)
{
    const struct {
        const char *type;
        int offset;
    } part[] = {{"VEC3", 0}, {"VEC3", 12}, {"VEC4", 24}, {"VEC2", 40}};
    jgap(w, "\n");
    jopen_array(w, "accessors");
    for (int i = 0; i < 4; i++) {
        jgap(w, "\n    ");
        jopen_object(w, NULL);
        jput_integer(w, "bufferView", 0);
        jput_integer(w, "byteOffset", part[i].offset);
        jput_integer(w, "componentType", 5126);
        jput_integer(w, "count", (long long)g->vertices);
        jput_text(w, "type", part[i].type);
        if (i == 0) {
            jgap(w, "\n        ");
            jput_floats(w, "min", g->least, 3, 9);
            jput_floats(w, "max", g->most, 3, 9);
        }
        jclose(w);
    }
    jgap(w, "\n    ");
    jopen_object(w, NULL);
    jput_integer(w, "bufferView", 1);
    jput_integer(w, "componentType", 5125);
    jput_integer(w, "count", (long long)g->indices);
    jput_text(w, "type", "SCALAR");
    jclose_levels(w, 2);
}

static void put_buffers(struct jwriter *w, const struct grid *g)
{
    const size_t stride = FLOATS * sizeof(float), vertices = g->vertices * stride;
    const size_t indices = g->indices * sizeof(uint32_t);
    jgap(w, "\n");
    jopen_array(w, "bufferViews");
    jopen_object(w, NULL);
    jput_integer(w, "buffer", 0);
    jput_integer(w, "byteLength", (long long)vertices);
    jput_integer(w, "byteStride", (long long)stride);
    jput_integer(w, "target", 34962);
    jclose(w);
    jgap(w, "\n    ");
    jopen_object(w, NULL);
    jput_integer(w, "buffer", 0);
    jput_integer(w, "byteOffset", (long long)vertices);
    jput_integer(w, "byteLength", (long long)indices);
    jput_integer(w, "target", 34963);
    jclose_levels(w, 2);
    jgap(w, "\n");
    jopen_array(w, "buffers");
    jopen_object(w, NULL);
    jput_text(w, "uri", "model.bin");
    jput_integer(w, "byteLength", (long long)(vertices + indices));
    jclose_levels(w, 2);
}

// One mesh of one primitive, whose attributes are the first four accessors.
static void put_nodes(struct jwriter *w)
{
    jgap(w, "\n");
    jput_integer(w, "scene", 0);
    jput_raw(w, "scenes", "[{\"nodes\": [0]}]");
    jput_raw(w, "nodes", "[{\"mesh\": 0}]");
    jgap(w, "\n");
    jput_raw(w, "meshes",
             "[{\"primitives\": [{\"attributes\": {\"POSITION\": 0, \"NORMAL\": 1, "
             "\"TANGENT\": 2, \"TEXCOORD_0\": 3}, \"indices\": 4, \"material\": 0}]}]");
}

static relume_status write_scene(const struct writing *writing, const struct grid *g)
{
    struct jwriter w = {0};
    jopen_object(&w, NULL);
    jgap(&w, "\n");
    jopen_object(&w, "asset");
    jput_text(&w, "version", "2.0");
    jput_text(&w, "generator", "relume " RELUME_VERSION);
    jclose(&w);
    jgap(&w, "\n");
    jput_texts(&w, "extensionsUsed", (const char *const[]){"KHR_materials_specular"}, 1);
    put_nodes(&w);
    put_material(&w, writing);
    put_textures(&w, writing->gl_normal);
    put_accessors(&w, g);
    put_buffers(&w, g);
    jgap(&w, "\n");
    return jsave_in(&w, writing->folder, "model.gltf", writing->params->log);
}

relume_status write_gltf(const struct writing *w)
{
    struct grid g = grid_of(w);
    const relume_status status = write_mesh(w, &g);
    return status ? status : write_scene(w, &g);
}

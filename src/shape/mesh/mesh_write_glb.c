// mesh_write_glb.c - meshes as binary glTF 2.0 (Khronos 2021): one JSON chunk, one of bytes
//
// The bytes are, one array after the other: triangles, positions, normals, texture coordinates,
// colours (16 bits, since glTF's are linear), the picture.
#include "shape/mesh/mesh_write.h"

#include "core/base/infile.h"
#include "core/base/json_write.h"
#include "core/base/log.h"
#include "core/base/memory.h"

#include <math.h>
#include <relume/image.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

struct picture {
    char *bytes;  // NULL: none that can be put in
    size_t size;
    const char *type;
};

// One array of the file.
struct view {
    const char *name;  // of the attribute; "" the triangles, NULL the picture
    const char *type;
    int component;  // glTF's number of its type
    size_t count, bytes, offset;
    bool normalised;
};
enum { MOST_VIEWS = 6 };

static size_t padded(size_t bytes)
{
    return (bytes + 3) & ~(size_t)3;
}

// One that cannot be put in is left out, with a warning; short memory is none of these.
static relume_status load_picture(struct picture *p, const struct relume_mesh *m,
                                  const struct relume_log *log)
{
    const char *dot = m->picture && m->texture ? strrchr(m->picture, '.') : NULL;
    *p = (struct picture){.bytes = NULL};
    if (!m->picture || !m->texture)
        return RELUME_OK;
    const bool png = dot && !strcasecmp(dot, ".png");
    p->type = png ? "image/png" : "image/jpeg";
    if (!png && !(dot && (!strcasecmp(dot, ".jpg") || !strcasecmp(dot, ".jpeg")))) {
        log_line(log, RELUME_WARNING,
                 "%s: this picture is left out of the mesh, which has no texture then; glTF takes "
                 ".png and .jpg",
                 m->picture);
        return RELUME_OK;
    }
    const relume_status status =
        input_load(&p->bytes, &p->size, m->picture, (uint64_t)1 << 30, "a picture", NULL);
    if (status && status != RELUME_ENOMEM)
        log_line(log, RELUME_WARNING,
                 "%s: this picture cannot be read; the mesh is written without its texture",
                 m->picture);
    return status == RELUME_ENOMEM ? status : RELUME_OK;
}

static int list_views(struct view view[MOST_VIEWS], const struct relume_mesh *m,
                      const struct picture *p)
{
    enum { U8_PICTURE = 0, U16 = 5123, U32 = 5125, F32 = 5126 };
    const size_t n = m->vertex_count;
    int count = 0;
    view[count++] = (struct view){
        "", "SCALAR", U32, 3 * m->triangle_count, m->triangle_count * sizeof *m->triangle,
        0,  false};
    view[count++] = (struct view){"POSITION", "VEC3", F32, n, n * sizeof *m->position, 0, false};
    if (m->normal)
        view[count++] = (struct view){"NORMAL", "VEC3", F32, n, n * sizeof *m->normal, 0, false};
    if (m->texture)
        view[count++] =
            (struct view){"TEXCOORD_0", "VEC2", F32, n, n * sizeof *m->texture, 0, false};
    if (m->colour)
        view[count++] = (struct view){"COLOR_0", "VEC4", U16, n, n * 4 * sizeof(uint16_t), 0, true};
    if (p->bytes)
        view[count++] = (struct view){NULL, NULL, U8_PICTURE, 1, p->size, 0, false};
    for (int i = 1; i < count; i++)
        view[i].offset = view[i - 1].offset + padded(view[i - 1].bytes);
    return count;
}

// ---------------------------------------------------------------- the JSON chunk

static void put_bounds(struct jwriter *w, const struct relume_mesh *m)
{
    float least[3] = {INFINITY, INFINITY, INFINITY}, most[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < m->vertex_count; i++)
        for (int c = 0; c < 3; c++) {
            least[c] = fminf(least[c], m->position[i][c]);
            most[c] = fmaxf(most[c], m->position[i][c]);
        }
    jput_floats(w, "min", least, 3, 9);
    jput_floats(w, "max", most, 3, 9);
}

static void put_accessors(struct jwriter *w, const struct relume_mesh *m, const struct view *view,
                          int count)
{
    jopen_array(w, "accessors");
    for (int i = 0; i < count && view[i].name; i++) {
        jopen_object(w, NULL);
        jput_integer(w, "bufferView", i);
        jput_integer(w, "componentType", view[i].component);
        jput_integer(w, "count", (long long)view[i].count);
        jput_text(w, "type", view[i].type);
        if (view[i].normalised)
            jput_truth(w, "normalized", true);
        if (!strcmp(view[i].name, "POSITION"))
            put_bounds(w, m);
        jclose(w);
    }
    jclose(w);
}

static void put_buffers(struct jwriter *w, const struct view *view, int count)
{
    const struct view *last = &view[count - 1];
    jopen_array(w, "bufferViews");
    for (int i = 0; i < count; i++) {
        jopen_object(w, NULL);
        jput_integer(w, "buffer", 0);
        jput_integer(w, "byteOffset", (long long)view[i].offset);
        jput_integer(w, "byteLength", (long long)view[i].bytes);
        if (view[i].name)
            jput_integer(w, "target", *view[i].name ? 34962 : 34963);
        jclose(w);
    }
    jclose(w);
    jopen_array(w, "buffers");
    jopen_object(w, NULL);
    jput_integer(w, "byteLength", (long long)(last->offset + padded(last->bytes)));
    jclose_levels(w, 2);
}

static void put_mesh(struct jwriter *w, const struct view *view, int count)
{
    jput_integer(w, "scene", 0);
    jput_raw(w, "scenes", "[{\"nodes\":[0]}]");
    jput_raw(w, "nodes", "[{\"mesh\":0}]");
    jopen_array(w, "meshes");
    jopen_object(w, NULL);
    jopen_array(w, "primitives");
    jopen_object(w, NULL);
    jput_integer(w, "indices", 0);
    jput_integer(w, "material", 0);
    jopen_object(w, "attributes");
    for (int i = 1; i < count && view[i].name; i++)
        jput_integer(w, view[i].name, i);
    jclose_levels(w, 5);
}

static void put_material(struct jwriter *w, const struct relume_mesh *m, int count,
                         const struct picture *p)
{
    jopen_array(w, "materials");
    jopen_object(w, NULL);
    jput_truth(w, "doubleSided", true);
    if (m->cut_out && p->bytes)
        jput_text(w, "alphaMode", "MASK");
    jopen_object(w, "pbrMetallicRoughness");
    jput_integer(w, "metallicFactor", 0);
    jput_integer(w, "roughnessFactor", 1);
    if (p->bytes)
        jput_raw(w, "baseColorTexture", "{\"index\":0}");
    jclose_levels(w, 3);
    if (!p->bytes)
        return;
    jput_raw(w, "textures", "[{\"source\":0}]");
    jopen_array(w, "images");
    jopen_object(w, NULL);
    jput_integer(w, "bufferView", count - 1);
    jput_text(w, "mimeType", p->type);
    jclose_levels(w, 2);
}

static relume_status make_json(char **out, size_t *size, const struct relume_mesh *m,
                               const struct view *view, int count, const struct picture *p)
{
    struct jwriter w = {.style = JSON_DENSE};
    jopen_object(&w, NULL);
    jput_raw(&w, "asset", "{\"version\":\"2.0\",\"generator\":\"relume\"}");
    if (m->triangle_count) {
        put_mesh(&w, view, count);
        put_material(&w, m, count, p);
        put_accessors(&w, m, view, count);
        put_buffers(&w, view, count);
    }
    char *text = jtake(&w, size);
    *out = text ? mem_format("%s%.*s", text, (int)(padded(*size) - *size), "   ") : NULL;
    *size = padded(*size);
    mem_free(text);
    return *out ? RELUME_OK : RELUME_ENOMEM;
}

// ---------------------------------------------------------------- the bytes

static void pad(struct sink *to, size_t bytes)
{
    sink_put(to, "\0\0", padded(bytes) - bytes);
}

// Code values are sRGB (IEC 61966-2-1); opacity is linear already.
static void put_colours(struct sink *to, const struct relume_mesh *m)
{
    uint16_t linear[256];
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    for (int i = 0; i < 256; i++)
        linear[i] = (uint16_t)lrintf(65535.0f * relume_transfer_decode(srgb, (float)i / 255.0f));
    for (size_t i = 0; i < m->vertex_count; i++) {
        const uint8_t *c = m->colour[i];
        const uint16_t rgba[4] = {linear[c[0]], linear[c[1]], linear[c[2]], (uint16_t)(257 * c[3])};
        sink_put(to, rgba, sizeof rgba);
    }
}

static void put_arrays(struct sink *to, const struct relume_mesh *m, const struct picture *p)
{
    sink_put(to, m->triangle, m->triangle_count * sizeof *m->triangle);
    sink_put(to, m->position, m->vertex_count * sizeof *m->position);
    if (m->normal)
        sink_put(to, m->normal, m->vertex_count * sizeof *m->normal);
    for (size_t i = 0; m->texture && i < m->vertex_count; i++) {
        const float down[2] = {m->texture[i][0], 1.0f - m->texture[i][1]};
        sink_put(to, down, sizeof down);
    }
    if (m->colour)
        put_colours(to, m);
    if (p->bytes) {
        sink_put(to, p->bytes, p->size);
        pad(to, p->size);
    }
}

static relume_status write_chunks(struct sink *to, const struct relume_mesh *m, const char *path,
                                  const struct picture *p, const struct relume_log *log)
{
    struct view view[MOST_VIEWS];
    const int count = list_views(view, m, p);
    const struct view *last = &view[count - 1];
    const size_t bytes = m->triangle_count ? last->offset + padded(last->bytes) : 0;
    char *json;
    size_t length;
    const relume_status status = make_json(&json, &length, m, view, count, p);
    if (status)
        return status;
    const size_t total = 12 + 8 + length + (bytes ? 8 + bytes : 0);
    if (total <= UINT32_MAX) {
        const uint32_t head[5] = {0x46546c67, 2, (uint32_t)total, (uint32_t)length, 0x4e4f534a};
        const uint32_t body[2] = {(uint32_t)bytes, 0x004e4942};
        sink_put(to, head, sizeof head);
        sink_put(to, json, length);
        if (bytes) {
            sink_put(to, body, sizeof body);
            put_arrays(to, m, p);
        }
    }
    mem_free(json);
    return total <= UINT32_MAX
               ? RELUME_OK
               : log_fail(log, RELUME_EINVAL,
                          "%s: %zu MB of mesh; expected at most 4 GB, which glTF's sizes hold; "
                          "write .ply",
                          path, total >> 20);
}

relume_status mesh_write_glb(struct sink *to, const struct relume_mesh *mesh, const char *path,
                             const struct relume_log *log)
{
    struct picture p;
    relume_status status = load_picture(&p, mesh, log);
    if (!status)
        status = write_chunks(to, mesh, path, &p, log);
    mem_free(p.bytes);
    return status;
}

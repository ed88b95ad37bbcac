// card_points.c - trees of points in buffers of the graphics card. Shaders read them by
// transport/tree.glsl.
#include "transport/card_points.h"

#include "cli/program/say.h"
#include "world/object/object_points.h"

#include <stdlib.h>
#include <string.h>

enum { LEAVES_WIDE = 256 };  // of textures of leaves
// Of objects; where OpenGL is software, fewer.
enum { LEAVES = 4096, LEAVES_SOFTWARE = 512 };

struct card_node {
    float ball[4], facing[4], cone, edge, area, child;
};
struct card_leaf {
    float returned[3];
    int32_t node;
    float emitted[3];
    int32_t begins;
};

static void release_buffers(struct card_points *c)
{
    const GLuint buffers[] = {c->node, c->sent, c->leaf, c->block, c->spot[0], c->spot[1]};
    const GLuint textures[] = {c->node_texels, c->sent_texels, c->spot_texels[0],
                               c->spot_texels[1]};
    c->gl->DeleteTextures(sizeof textures / sizeof *textures, textures);
    c->gl->DeleteBuffers(sizeof buffers / sizeof *buffers, buffers);
    target_destroy(&c->leaf_place, c->gl);
    target_destroy(&c->leaf_facing, c->gl);
    c->node = c->sent = c->leaf = c->block = c->node_texels = c->sent_texels = 0;
    memset(c->spot, 0, sizeof c->spot);
    memset(c->spot_texels, 0, sizeof c->spot_texels);
    c->of = 0;
}

void card_points_destroy(struct card_points *c)
{
    if (!c->gl)
        return;
    release_buffers(c);
    for (int i = 0; i < CARD_TREES; i++)
        relume_points_free(&c->tree[i]);
    *c = (struct card_points){.gl = NULL};
}

// ---------------------------------------------------------------- buffers

static size_t count_nodes(struct card_points *c)
{
    size_t nodes = 0;
    c->leaves = 0;
    c->of_scene = (int)c->tree[CARD_SCENE].leaves;
    for (int i = 0; i < CARD_TREES; i++) {
        c->first[i] = c->tree[i].levels ? (int)nodes : -1;
        nodes += c->tree[i].nodes;
        c->leaves += (int)c->tree[i].leaves;
    }
    return nodes;
}

static GLuint as_texels(const struct card_points *c, GLuint buffer)
{
    GLuint texture;
    c->gl->GenTextures(1, &texture);
    texture_use(c->gl, 0, GL_TEXTURE_BUFFER, texture);
    c->gl->TexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, buffer);
    return texture;
}

static relume_status upload_nodes(struct card_points *c, size_t nodes)
{
    enum { SENT_BYTES = 8 * sizeof(float) };
    struct card_node *node = calloc(nodes ? nodes : 1, sizeof *node);
    if (!node)
        return RELUME_ENOMEM;
    for (int i = 0; i < CARD_TREES; i++)
        for (size_t k = 0; k < c->tree[i].nodes; k++) {
            const struct relume_points_node *from = &c->tree[i].node[k];
            struct card_node *to = &node[(size_t)c->first[i] + k];
            memcpy(to->ball, from->middle, sizeof from->middle);
            memcpy(to->facing, from->facing, sizeof from->facing);
            to->ball[3] = from->radius, to->facing[3] = from->turned;
            to->cone = from->cone, to->edge = from->edge, to->area = from->area;
            to->child = from->child < 0 ? -1.0f : (float)(from->child + c->first[i]);
        }
    c->node = gl_storage(c->gl, (nodes ? nodes : 1) * sizeof *node, node);
    memset(node, 0, (nodes ? nodes : 1) * sizeof *node);
    c->sent = gl_storage(c->gl, (nodes ? nodes : 1) * (size_t)SENT_BYTES, node);
    free(node);
    c->node_texels = as_texels(c, c->node);
    c->sent_texels = as_texels(c, c->sent);
    return RELUME_OK;
}

static void put_leaves(struct card_leaf *to, float (*place)[3], float (*facing)[3],
                       const struct card_points *c, int tree)
{
    const struct relume_points *p = &c->tree[tree];
    for (size_t i = 0; i < p->leaves; i++) {
        const struct relume_points_leaf *from = &p->leaf[i];
        memcpy(to[i].returned, from->returned, sizeof from->returned);
        memcpy(to[i].emitted, from->emitted, sizeof from->emitted);
        to[i].node = c->first[tree] + (int)(p->first[p->levels - 1] + i);
        to[i].begins = p->begins ? (int)p->begins[i] : 0;
        memcpy(place[i], from->place, sizeof *place);
        memcpy(facing[i], from->normal, sizeof *facing);
    }
}

// Three numbers each, and a fourth that says what they are: 0 is no site.
static relume_status upload_texels(struct target *out, const struct card_points *c,
                                   const float (*values)[3])
{
    const struct gl *gl = c->gl;
    const int rows = (c->leaves + LEAVES_WIDE - 1) / LEAVES_WIDE;
    const size_t texels = (size_t)LEAVES_WIDE * (size_t)(rows > 0 ? rows : 1);
    float(*four)[4] = calloc(texels, sizeof *four);
    relume_status status =
        four ? target_create(out, gl, LEAVES_WIDE, rows > 0 ? rows : 1, c->log) : RELUME_ENOMEM;
    for (int i = 0; i < c->leaves && !status; i++) {
        const bool is_scene = i < c->of_scene;
        memcpy(four[i], values[i], sizeof *values);
        four[i][3] = !is_scene ? 2.0f : c->tree[CARD_SCENE].leaf[i].is_far ? 0.0f : 1.0f;
    }
    if (!status) {
        texture_use(gl, 0, GL_TEXTURE_2D, out->texture);
        gl->TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, out->width, out->height, 0, GL_RGBA, GL_FLOAT,
                       four);
    }
    free(four);
    return status;
}

static relume_status upload_leaves(struct card_points *c)
{
    const size_t leaves = (size_t)c->leaves;
    struct card_leaf *leaf = calloc(leaves + 1, sizeof *leaf);
    float(*place)[3] = calloc(leaves + 1, sizeof *place);
    float(*facing)[3] = calloc(leaves + 1, sizeof *facing);
    relume_status status = leaf && place && facing ? RELUME_OK : RELUME_ENOMEM;
    size_t at = 0;
    for (int i = 0; i < CARD_TREES && !status; i++) {
        put_leaves(leaf + at, place + at, facing + at, c, i);
        at += c->tree[i].leaves;
    }
    if (!status && c->tree[CARD_SCENE].begins)  // where the last one's blocks end
        leaf[c->of_scene].begins = (int)c->tree[CARD_SCENE].begins[c->of_scene];
    if (!status) {
        c->leaf = gl_storage(c->gl, (leaves + 1) * sizeof *leaf, leaf);
        status = upload_texels(&c->leaf_place, c, (const float(*)[3])place);
    }
    if (!status)
        status = upload_texels(&c->leaf_facing, c, (const float(*)[3])facing);
    free(leaf);
    free(place);
    free(facing);
    return status;
}

static relume_status upload_spots(struct card_points *c, int i)
{
    const struct relume_points *p = &c->tree[i ? CARD_OBJECTS : CARD_SCENE];
    float(*texel)[2][4] = calloc(p->spots + 1, sizeof *texel);
    if (!texel)
        return RELUME_ENOMEM;
    for (size_t k = 0; k < p->spots; k++) {
        memcpy(texel[k][0], p->spot[k].place, sizeof p->spot->place);
        memcpy(texel[k][1], p->spot[k].normal, sizeof p->spot->normal);
        texel[k][0][3] = p->spot[k].both ? 1.0f : 0.0f;
    }
    c->spot[i] = gl_storage(c->gl, (p->spots + 1) * sizeof *texel, texel);
    c->spot_texels[i] = as_texels(c, c->spot[i]);
    free(texel);
    return RELUME_OK;
}

static relume_status upload(struct card_points *c)
{
    const struct relume_points *scene = &c->tree[CARD_SCENE];
    const size_t blocks = scene->leaves ? scene->begins[scene->leaves] : 0;
    const size_t nodes = count_nodes(c);
    if (blocks * sizeof *scene->block > (size_t)c->gl->storage_bytes ||
        nodes * (sizeof(struct card_node) / (4 * sizeof(float))) > (size_t)c->gl->max_buffer)
        return say(c->log, RELUME_ESYSTEM,
                   "%zu points of %zu pixels do not fit into the buffers of OpenGL here", nodes,
                   blocks);
    const struct relume_points_block none = {0, 0.0f};
    c->block =
        gl_storage(c->gl, (blocks ? blocks : 1) * sizeof none, blocks ? scene->block : &none);
    relume_status status = upload_nodes(c, nodes);
    if (!status)
        status = upload_leaves(c);
    for (int i = 0; i < 2 && !status; i++)
        status = upload_spots(c, i);
    return status ? status : gl_check(c->gl, "uploading points", c->log);
}

// ---------------------------------------------------------------- what is needed

static relume_status need_scene(struct card_points *c, const struct relume_geometry *geometry,
                                const struct target *places, const relume_objects *objects)
{
    struct relume_image image;
    if (c->tree[CARD_SCENE].node)
        return RELUME_OK;
    relume_status status = target_read(&image, places, c->gl);
    if (!status)
        status = relume_points_of_scene(&c->tree[CARD_SCENE], geometry, &image, objects,
                                        relume_points_params(.log = c->log));
    relume_image_destroy(&image);
    return status;
}

relume_status card_points_need(struct card_points *c, const struct gl *gl,
                               const struct relume_geometry *geometry, const struct target *places,
                               const relume_objects *objects, uint64_t of,
                               const struct relume_log *log)
{
    if (c->gl && c->of == of)
        return RELUME_OK;
    c->gl = gl;
    c->log = log;
    release_buffers(c);
    for (int i = CARD_OBJECTS; i < CARD_TREES; i++)
        relume_points_free(&c->tree[i]);
    relume_status status = need_scene(c, geometry, places, objects);
    if (!status)
        status = relume_points_of_objects(
            &c->tree[CARD_OBJECTS], objects,
            relume_points_params(.log = log, .leaves = gl->software ? LEAVES_SOFTWARE : LEAVES));
    if (!status)
        status = upload(c);
    if (status)
        card_points_destroy(c);
    else
        c->of = of;
    return status;
}

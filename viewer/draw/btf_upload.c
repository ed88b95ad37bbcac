// btf_upload.c - a measured material on the GPU: the arrays of its model and the directions around
// any direction, as buffer textures
#include "draw/btf_upload.h"

#include "cli/program/say.h"
#include "common/vec.h"
#include "gl/target.h"
#include "material/btf/values.h"
#include "material/model/environment.h"
#include "material/surface/texels.h"

#include <stdlib.h>
#include <string.h>

const struct btf_shader btf_shaders[] = {
    {"measured", "btf_measured.frag", {3}, false, false},
    {"lit", "btf_lit.frag", {3}, true, false},
    {"bump", "btf_bump.frag", {3, 3, 3}, false, false},
    {"laf", "btf_laf.frag", {3, 3, 4}, true, false},
    {"painted", "btf_painted.frag", {3, 3, 4}, true, false},
    {"slaf", "btf_slaf.frag", {3, 3, 4, 1}, true, false},
    {"rfp", "btf_rfp.frag", {3}, false, false},
    {"rfnl", "btf_rfnl.frag", {3, 3, 4}, true, false},
    {"rfnlc", "btf_rfnlc.frag", {3, 3, 4, 1}, true, false},
    {"cmf", "btf_cmf.frag", {3, 1}, false, false},
    {"vpca", "btf_vpca.frag", {3, 3, 1}, false, false},
    {"lpca", "btf_lpca.frag", {3, 3, 1, 1}, false, false},
    {"fmf", "btf_fmf.frag", {1, 3}, false, false},
    {"qmf", "btf_qmf.frag", {1, 1, 1, 1, 1}, false, false},
    {"gbrdf", "btf_gbrdf.frag", {1, 1, BTF_PAIR, 1, 3}, false, true},
    {NULL, NULL, {0}, false, false},
};

const struct btf_shader *btf_shader_find(const char *model)
{
    for (const struct btf_shader *t = btf_shaders; t->model; t++)
        if (!strcmp(t->model, model))
            return t;
    return NULL;
}

// ---------------------------------------------------------------- buffers

static relume_status fill_buffer(struct btf_material *m, const struct gl *gl, GLuint *texture,
                                 GLuint *buffer, GLenum format, size_t texels, size_t bytes,
                                 const void *data, const struct relume_log *log)
{
    if (texels > (size_t)gl->max_buffer)
        return say(log, RELUME_ESYSTEM,
                   "model %s: an array of %zu texels; OpenGL reads at most %d here",
                   m->shader->model, texels, gl->max_buffer);
    gl->GenBuffers(1, buffer);
    gl->BindBuffer(GL_TEXTURE_BUFFER, *buffer);
    gl->BufferData(GL_TEXTURE_BUFFER, (GLsizeiptr)bytes, data, GL_STATIC_DRAW);
    gl->GenTextures(1, texture);
    texture_use(gl, 0, GL_TEXTURE_BUFFER, *texture);
    gl->TexBuffer(GL_TEXTURE_BUFFER, format, *buffer);
    m->bytes += bytes;
    return gl_check(gl, "uploading a material", log);
}

// Texture number `i` of the level that is uploaded, the last one: `texels` of `format`.
static relume_status fill(struct btf_material *m, const struct gl *gl, int i, GLenum format,
                          size_t texels, size_t bytes, const void *data,
                          const struct relume_log *log)
{
    struct btf_level *level = &m->level[m->levels - 1];
    return fill_buffer(m, gl, &level->texture[i], &level->buffer[i], format, texels, bytes, data,
                       log);
}

// Halfs by three, padded to four: GL 3.3 has no buffers of three.
static void widen(uint16_t *to, const uint16_t *from, const uint16_t *fourth, size_t texels)
{
    for (size_t i = 0; i < texels; i++) {
        memcpy(to + 4 * i, from + 3 * i, 3 * sizeof *to);
        to[4 * i + 3] = fourth ? fourth[i] : 0;
    }
}

static GLenum format_of(const struct relume_btf_array *a, int numbers)
{
    switch (a->kind) {
    case RELUME_BTF_U8: return GL_R8UI;
    case RELUME_BTF_U16: return GL_R16UI;
    case RELUME_BTF_HALF: return numbers == 1 ? GL_R16F : GL_RGBA16F;
    case RELUME_BTF_U32: return GL_R32UI;
    case RELUME_BTF_FLOAT: break;
    }
    return numbers == 1 ? GL_R32F : GL_RGBA32F;
}

static relume_status upload_array(struct btf_material *m, const struct gl *gl, int i,
                                  const struct relume_btf_array *a,
                                  const struct relume_btf_array *fourth,
                                  const struct relume_log *log)
{
    static const size_t sizes[] = {[RELUME_BTF_U8] = 1,
                                   [RELUME_BTF_U16] = 2,
                                   [RELUME_BTF_HALF] = 2,
                                   [RELUME_BTF_FLOAT] = 4,
                                   [RELUME_BTF_U32] = 4};
    const int numbers = fourth ? 3 : m->shader->numbers[i];
    size_t count = 1;
    for (int d = 0; d < a->dims; d++)
        count *= a->shape[d];
    const size_t texels = count / (size_t)numbers;
    if (numbers != 3)
        return fill(m, gl, i, format_of(a, numbers), texels, count * sizes[a->kind], a->data, log);
    uint16_t *wide = malloc(texels * 4 * sizeof *wide);
    if (!wide)
        return RELUME_ENOMEM;
    widen(wide, a->data, fourth ? fourth->data : NULL, texels);
    const relume_status status =
        fill(m, gl, i, GL_RGBA16F, texels, texels * 4 * sizeof *wide, wide, log);
    free(wide);
    return status;
}

static relume_status upload_measured(struct btf_material *m, const struct gl *gl,
                                     const relume_btf *btf, const struct relume_log *log)
{
    const struct relume_btf_info *info = relume_btf_info(btf);
    const size_t area = (size_t)info->width * (size_t)info->height;
    const size_t texels = area * (size_t)info->views * (size_t)info->lights;
    if (texels > (size_t)gl->max_buffer)
        return say(log, RELUME_ESYSTEM,
                   "%s: %zu measured values; OpenGL reads at most %d here; expected a model of it",
                   info->name, texels, gl->max_buffer);
    uint16_t *wide = malloc(texels * 4 * sizeof *wide);
    if (!wide)
        return RELUME_ENOMEM;
    for (int v = 0; v < info->views; v++)
        for (int l = 0; l < info->lights; l++)
            widen(wide + 4 * area * ((size_t)v * (size_t)info->lights + (size_t)l),
                  relume_btf_picture(btf, v, l), NULL, area);
    const relume_status status =
        fill(m, gl, 0, GL_RGBA16F, texels, texels * 4 * sizeof *wide, wide, log);
    free(wide);
    return status;
}

// ---------------------------------------------------------------- directions

// As btf.glsl.
enum { CELLS = 32, PROBES = 5, TEXELS = 6 };

struct mesh_list {
    const struct relume_vec3 *point;
    int points;
    const int (*triangle)[3];
    int triangles;
    struct relume_vec3 (*across)[3];  // products of the two corners that follow each
    int (*cell)[2];                   // [CELLS * CELLS]: first, count
    float (*texel)[TEXELS][4];
    size_t used, capacity;
};

// The direction at a place of the octahedral map, both in [-1, 1].
static struct relume_vec3 unfolded(double x, double y)
{
    const double z = 1.0 - fabs(x) - fabs(y);
    const double fx = z < 0.0 ? (1.0 - fabs(y)) * (x < 0.0 ? -1.0 : 1.0) : x;
    const double fy = z < 0.0 ? (1.0 - fabs(x)) * (y < 0.0 ? -1.0 : 1.0) : y;
    return vec3_unit((struct relume_vec3){fx, fy, z});
}

static struct relume_vec3 corner_of(const struct mesh_list *d, int triangle, int corner)
{
    const int i = d->triangle[triangle][corner % 3];
    return i < d->points ? d->point[i] : (struct relume_vec3){0, 0, -1};
}

static void fill_across(struct mesh_list *d)
{
    for (int i = 0; i < d->triangles; i++)
        for (int c = 0; c < 3; c++)
            d->across[i][c] = vec3_cross(corner_of(d, i, c + 1), corner_of(d, i, c + 2));
}

static int triangle_at(const struct mesh_list *d, struct relume_vec3 direction)
{
    int best = 0;
    double most = -INFINITY;
    for (int i = 0; i < d->triangles && most < 0.0; i++) {
        double w[3], sum = 0.0;
        for (int c = 0; c < 3; c++)
            sum += w[c] = vec3_dot(direction, d->across[i][c]);
        const double least = fmin(w[0], fmin(w[1], w[2])) / sum;
        if (sum > 1e-12 && least > most) {
            most = least;
            best = i;
        }
    }
    return best;
}

static bool add_triangle(struct mesh_list *d, int triangle)
{
    if (d->used == d->capacity) {
        const size_t capacity = d->capacity ? 2 * d->capacity : 4096;
        void *bigger = realloc(d->texel, capacity * sizeof *d->texel);
        if (!bigger)
            return false;
        d->texel = bigger;
        d->capacity = capacity;
    }
    float(*to)[4] = d->texel[d->used++];
    for (int c = 0; c < 3; c++) {
        const struct relume_vec3 a = d->across[triangle][c], p = corner_of(d, triangle, c);
        const int number = d->triangle[triangle][c];
        to[c][0] = (float)a.x, to[c][1] = (float)a.y, to[c][2] = (float)a.z;
        to[c][3] = number < d->points ? (float)number : -1.0f;
        to[3 + c][0] = (float)p.x, to[3 + c][1] = (float)p.y, to[3 + c][2] = (float)p.z;
        to[3 + c][3] = 0.0f;
    }
    return true;
}

// Probes over the cell and its border find the triangles; of a triangle that slips between them no
// direction is far from one that is listed.
static bool fill_cell(struct mesh_list *d, int cell)
{
    int found[PROBES * PROBES], count = 0;
    for (int i = 0; i < PROBES * PROBES; i++) {
        const double x = cell % CELLS + (i % PROBES) / (PROBES - 1.0);
        const double y = cell / CELLS + i / PROBES / (PROBES - 1.0);
        const int t = triangle_at(d, unfolded(2.0 * x / CELLS - 1.0, 2.0 * y / CELLS - 1.0));
        int k = 0;
        while (k < count && found[k] != t)
            k++;
        if (k == count)
            found[count++] = t;
    }
    d->cell[cell][0] = (int)d->used;
    d->cell[cell][1] = count;
    for (int i = 0; i < count; i++)
        if (!add_triangle(d, found[i]))
            return false;
    return true;
}

// Textures `i` and `i + 1`: the cells, and their triangles.
static relume_status upload_mesh(struct btf_material *m, const struct gl *gl, int i,
                                 const struct relume_vec3 *direction, int n,
                                 const struct relume_log *log)
{
    relume_direction_mesh *mesh;
    relume_status status = relume_direction_mesh_create(&mesh, direction, n, log);
    if (status)
        return status;
    struct mesh_list d = {.point = direction, .points = n};
    d.triangle = relume_direction_mesh_triangles(mesh, &d.triangles);
    d.cell = malloc(CELLS * CELLS * sizeof *d.cell);
    d.across = malloc((size_t)d.triangles * sizeof *d.across);
    status = d.cell && d.across ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        fill_across(&d);
    for (int c = 0; c < CELLS * CELLS && !status; c++)
        status = fill_cell(&d, c) ? RELUME_OK : RELUME_ENOMEM;
    if (!status)
        status =
            fill(m, gl, i, GL_RG32I, CELLS * CELLS, CELLS * CELLS * sizeof *d.cell, d.cell, log);
    if (!status)
        status =
            fill(m, gl, i + 1, GL_RGBA32F, d.used * TEXELS, d.used * sizeof *d.texel, d.texel, log);
    free(d.across);
    free(d.cell);
    free(d.texel);
    relume_direction_mesh_destroy(&mesh);
    return status;
}

// ---------------------------------------------------------------- the map of a surface

// The matrix, then the texels of all tiles; a single zero where there is no map.
static relume_status upload_map(struct btf_material *m, const struct gl *gl,
                                const struct relume_btf_map_info *i, const struct relume_log *log)
{
    static const uint32_t none = 0;
    if (!i)
        return fill(m, gl, BTF_UNIT_MAP, GL_R32UI, 1, sizeof none, &none, log);
    const size_t cells = (size_t)i->columns * (size_t)i->rows;
    const size_t texels = (size_t)i->tiles * (size_t)i->width * (size_t)i->height;
    uint32_t *list = malloc((cells + texels) * sizeof *list);
    if (!list)
        return RELUME_ENOMEM;
    for (size_t k = 0; k < cells; k++)
        list[k] = i->matrix[k];
    memcpy(list + cells, i->texel, texels * sizeof *list);
    memcpy(m->level[m->levels - 1].map, (int[4]){i->columns, i->rows, i->width, i->height},
           sizeof m->level->map);
    const relume_status status = fill(m, gl, BTF_UNIT_MAP, GL_R32UI, cells + texels,
                                      (cells + texels) * sizeof *list, list, log);
    free(list);
    return status;
}

// ---------------------------------------------------------------- the material

static relume_status upload_fitted(struct btf_material *m, const struct gl *gl,
                                   const relume_btf_fitted *fitted, const struct relume_log *log)
{
    struct relume_btf_array a, fourth;
    relume_status status = RELUME_OK;
    for (int i = 0, k = 0; !status && i < BTF_ARRAYS && relume_btf_fitted_array(&a, fitted, k);
         i++, k++) {
        const bool pair = m->shader->numbers[i] == BTF_PAIR;
        if (pair)
            relume_btf_fitted_array(&fourth, fitted, ++k);
        status = upload_array(m, gl, i, &a, pair ? &fourth : NULL, log);
    }
    return status;
}

// What the rays of a g-BRDF need to know of its relief. Twins: gbrdf_prepare, meso_settle.
static void describe_relief(struct btf_level *level, const relume_btf_fitted *fitted)
{
    enum { DEPTH = 0, LIGHT = 6 };
    // rays as flat as meso.c follows, in steps of half a texel, and what each place takes besides
    enum { STEPS_A_TEXEL = 2 * 34, BESIDES = 64 };
    struct relume_btf_array depth, light;
    if (!relume_btf_fitted_array(&depth, fitted, DEPTH) ||
        !relume_btf_fitted_array(&light, fitted, LIGHT))
        return;
    const float *z = depth.data;
    float low = z[0], high = z[0];
    for (int i = 1; i < level->area; i++) {
        low = fminf(low, z[i]);
        high = fmaxf(high, z[i]);
    }
    const float scale = (float)level->side[0];
    level->relief[0] = low * scale;
    level->relief[1] = high * scale;
    level->relief[2] = *(const float *)light.data;
    level->ray_steps = BESIDES + 2 * STEPS_A_TEXEL * (int)ceilf(scale * (high - low));
}

static relume_status upload_level(struct btf_material *m, const struct gl *gl,
                                  const struct relume_object_material *from, int number,
                                  const struct relume_log *log)
{
    const struct relume_btf_surface_level at = relume_btf_surface_level(from->surface, number);
    const struct relume_btf_fitted_info *i = relume_btf_fitted_info(at.model);
    struct btf_level *level = &m->level[m->levels++];
    level->width = at.map->columns * at.map->width;
    level->height = at.map->rows * at.map->height;
    level->area = i->width * i->height;
    level->side[0] = i->width, level->side[1] = i->height;
    if (m->shader->relief)
        describe_relief(level, at.model);
    memcpy(level->counts, (int[4]){i->views, i->lights, i->components, i->lobes},
           sizeof level->counts);
    const relume_status status =
        from->fitted ? upload_fitted(m, gl, at.model, log) : upload_measured(m, gl, from->btf, log);
    return status ? status : upload_map(m, gl, from->mapped ? at.map : NULL, log);
}

relume_status btf_upload(struct btf_material *out, const struct gl *gl,
                         const struct relume_object_material *material,
                         const struct relume_log *log)
{
    *out = (struct btf_material){.shader = btf_shader_find(material->model)};
    struct btf_material *m = out;
    if (!m->shader)
        return say(log, RELUME_ESYSTEM, "%s: model %s cannot be drawn here", material->name,
                   material->model);
    const struct relume_btf_surface_info *info = relume_btf_surface_info(material->surface);
    const struct relume_btf_directions d = relume_btf_fitted_directions(info->model);
    m->without_cosine = d.without_cosine;
    m->rim = relume_btf_fitted_info(info->model)->rim;
    relume_status status = upload_level(m, gl, material, 0, log);
    if (!status)
        status = upload_mesh(m, gl, BTF_UNIT_MESHES, d.view, m->level->counts[0], log);
    if (!status)
        status = upload_mesh(m, gl, BTF_UNIT_MESHES + 2, d.light, m->level->counts[1], log);
    for (int i = 1; i < info->levels && !status; i++)
        status = upload_level(m, gl, material, i, log);
    if (status)
        btf_release(m, gl);
    return status;
}

// ---------------------------------------------------------------- under an environment

static relume_status upload_cones(struct btf_material *m, const struct gl *gl,
                                  const relume_btf_fitted *model,
                                  const relume_prefiltered_maps *prefiltered,
                                  const struct relume_log *log)
{
    relume_btf_environment *sky;
    const int lights = m->level->counts[1];
    const struct relume_vec3 *light = relume_btf_fitted_directions(model).light;
    relume_status status = relume_btf_environment_create(&sky, model, prefiltered);
    if (status)
        return status;
    const struct relume_btf_light_lobe *cone = relume_btf_environment_cones(sky);
    float(*texel)[2][4] = malloc((size_t)lights * sizeof *texel);
    for (int i = 0; texel && i < lights; i++) {
        const float values[2][4] = {
            {(float)cone[i].axis.x, (float)cone[i].axis.y, (float)cone[i].axis.z,
             (float)cone[i].exponent},
            {(float)light[i].x, (float)light[i].y, (float)light[i].z, (float)cone[i].weight}};
        memcpy(texel[i], values, sizeof values);
    }
    status = !texel ? RELUME_ENOMEM
                    : fill_buffer(m, gl, &m->table, &m->table_buffer, GL_RGBA32F,
                                  2 * (size_t)lights, (size_t)lights * sizeof *texel, texel, log);
    free(texel);
    relume_btf_environment_destroy(&sky);
    return status;
}

relume_status btf_need_table(struct btf_material *m, const struct gl *gl,
                             const struct relume_object_material *from,
                             const relume_prefiltered_maps *prefiltered,
                             const struct relume_log *log)
{
    enum { PARTS = 2 * RELUME_PREFILTERED_EXPONENTS * RELUME_PREFILTERED_STEPS };
    if (m->table)
        return RELUME_OK;
    if (!m->shader->lobes)
        return upload_cones(m, gl, relume_btf_surface_info(from->surface)->model, prefiltered, log);
    return fill_buffer(m, gl, &m->table, &m->table_buffer, GL_R32F, PARTS, PARTS * sizeof(float),
                       relume_prefiltered_maps_info(prefiltered)->part, log);
}

void btf_release(struct btf_material *m, const struct gl *gl)
{
    for (int i = 0; i < m->levels; i++) {
        gl->DeleteTextures(BTF_BUFFERS, m->level[i].texture);
        gl->DeleteBuffers(BTF_BUFFERS, m->level[i].buffer);
    }
    gl->DeleteTextures(1, &m->table);
    gl->DeleteBuffers(1, &m->table_buffer);
    *m = (struct btf_material){.shader = NULL};
}

void btf_use(const struct btf_material *m, const struct gl *gl, int level)
{
    for (int i = 0; i < BTF_BUFFERS; i++) {
        const bool mesh = i >= BTF_UNIT_MESHES && i < BTF_UNIT_MESHES + BTF_MESHES;
        const GLuint texture = m->level[mesh ? 0 : level].texture[i];
        if (texture)
            texture_use(gl, i, GL_TEXTURE_BUFFER, texture);
    }
}

// object_materials.c - materials of objects on the GPU, and the programs of their models
#include "draw/object_materials.h"

#include "draw/model_uniforms.h"

#include <stdlib.h>

static const char *const btf_uniforms[] = {
    "rectangle",
    "frame_size",
    "array0",
    "array1",
    "array2",
    "array3",
    "array4",
    "view_cells",
    "view_triangles",
    "light_cells",
    "light_triangles",
    "place",
    "normal_s",
    "tangent_t",
    "footprint",
    "picture",
    "part",
    "eye",
    "texels",
    "finest",
    "level",
    "levels",
    "bilinear",
    "without_cosine",
    "counts",
    "area",
    "map",
    "map_texels",
    "sky",
    "sky_turn",
    "sky_rgb",
    "sky_table",
    "some_lights",
    "relief",
    "side",
    LIGHT_NAMES,
    SHADOW_NAMES,
};

relume_status object_materials_create(struct object_materials *m, const struct gl *gl,
                                      const relume_objects *objects, const struct relume_log *log)
{
    *m = (struct object_materials){.gl = gl, .log = log, .objects = objects};
    m->material = calloc((size_t)relume_objects_info(objects)->materials, sizeof *m->material);
    return m->material ? RELUME_OK : RELUME_ENOMEM;
}

void object_materials_destroy(struct object_materials *m)
{
    const int materials = m->material ? relume_objects_info(m->objects)->materials : 0;
    for (int i = 0; i < materials; i++)
        btf_release(&m->material[i], m->gl);
    for (int i = 0; i < m->programs; i++)
        program_destroy(&m->program[i].program, m->gl);
    free(m->program);
    free(m->material);
    *m = (struct object_materials){.programs = 0};
}

relume_status object_materials_need(struct object_materials *m, int material)
{
    if (m->material[material].shader)
        return RELUME_OK;
    return btf_upload(&m->material[material], m->gl,
                      &relume_objects_info(m->objects)->material[material], m->log);
}

relume_status object_materials_program(const struct program **out, struct object_materials *m,
                                       int material, bool sky)
{
    const struct btf_shader *shader = m->material[material].shader;
    for (int i = 0; i < m->programs; i++)
        if (m->program[i].shader == shader && m->program[i].sky == sky) {
            *out = &m->program[i].program;
            return RELUME_OK;
        }
    struct model_program *more =
        realloc(m->program, ((size_t)m->programs + 1) * sizeof *m->program);
    if (!more)
        return RELUME_ENOMEM;
    m->program = more;
    more[m->programs] = (struct model_program){.shader = shader, .sky = sky};
    *out = &more[m->programs].program;
    return program_create_variant(&more[m->programs++].program, m->gl, shader->source,
                                  sky ? "#define SKY\n" : NULL, btf_uniforms, BTF_COUNT, m->log);
}

// Lights that one draw sums over: llvmpipe ends all loops of a pixel, without a word, after 65535
// rounds. A model goes through its components, at most once for each of three views, or follows two
// rays, for four texels at each of up to eight places.
static int lights_at_once(const struct btf_level *l)
{
    enum { MOST_ROUNDS = 60000, PLACES = 4 * 8, MESH_ROUNDS = 16 };
    const int rounds = PLACES * (MESH_ROUNDS + 3 * l->counts[2] + l->ray_steps);
    return rounds < MOST_ROUNDS ? MOST_ROUNDS / rounds : 1;
}

static void draw_level(const struct object_materials *all, const struct program *program,
                       const struct frame_area *area, const struct btf_level *l, bool sums)
{
    const int lights = l->counts[1], step = sums ? lights_at_once(l) : lights;
    for (int from = 0; from < lights; from += step) {
        const int end = from + step < lights ? from + step : lights;
        all->gl->Uniform2i(program->at[SOME_LIGHTS], from, end);
        draw_whole(all->gl, program, area);
    }
}

void object_materials_draw(const struct object_materials *all, const struct program *program,
                           const struct target *target, int material, bool sums)
{
    const struct btf_material *m = &all->material[material];
    const struct gl *gl = all->gl;
    const GLint *at = program->at;
    const struct frame_area area = {.width = target->width, .height = target->height};
    for (int i = 0; i < m->levels; i++) {
        const struct btf_level *l = &m->level[i];
        gl->Uniform1i(at[LEVEL], i);
        gl->Uniform2i(at[TEXELS], l->width, l->height);
        gl->Uniform1i(at[AREA], l->area);
        gl->Uniform4i(at[MAP], l->map[0], l->map[1], l->map[2], l->map[3]);
        gl->Uniform4i(at[COUNTS], l->counts[0], l->counts[1], l->counts[2], l->counts[3]);
        gl->Uniform3f(at[RELIEF], l->relief[0], l->relief[1], l->relief[2]);
        gl->Uniform2i(at[SIDE], l->side[0], l->side[1]);
        btf_use(m, gl, i);
        draw_level(all, program, &area, l, sums);
    }
}

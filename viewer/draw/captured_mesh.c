// captured_mesh.c - a captured panorama as a mesh that throws shadows. Twin: scenery.c
#include "draw/captured_mesh.h"

#include "common/vec.h"

enum { PLACES, CENTRE, BLOCK, WRAPS, FARTHEST, LEAST_COSINE, CLIP, COUNT };
static const char *const uniforms[] = {"places",   "centre",       "block", "wraps",
                                       "farthest", "least_cosine", "clip"};

// Where OpenGL is software, fewer vertices.
enum { MOST_VERTICES = 1 << 19, MOST_SOFTWARE = 1 << 18 };

static double distance_to(const struct captured_mesh *m, const struct relume_image *places,
                          size_t i)
{
    const float *p = places->data + 3 * i;
    const struct relume_vec3 place = {(double)p[0], (double)p[1], (double)p[2]};
    return vec3_length(vec3_sub(place, m->centre));
}

// Renderers put the background a thousand times as far as the farthest surface; depth maps of
// photographs end at the sky, which many pixels show.
static double farthest_of(const struct captured_mesh *m, const struct relume_image *places)
{
    const double BACKGROUND = 1000.0, NEAR = 0.5, NOWHERE = 1e30;
    const double ABOUT = 0.999, BEFORE = 0.998, MANY = 0.01, MOST = 0.9;
    const size_t pixels = (size_t)places->width * (size_t)places->height;
    double least = INFINITY, most = 0.0;
    size_t at_most = 0;
    for (size_t i = 0; i < pixels; i++) {
        const double away = distance_to(m, places, i);
        least = fmin(least, away);
        most = fmax(most, away);
    }
    if (most * NEAR > least * BACKGROUND)
        return most / BACKGROUND / NEAR;
    for (size_t i = 0; i < pixels; i++)
        at_most += distance_to(m, places, i) >= ABOUT * most;
    const double part = (double)at_most / (double)pixels;
    return part > MANY && part < MOST ? BEFORE * most : NOWHERE;
}

static relume_status find_farthest(struct captured_mesh *m)
{
    struct relume_image places;
    const relume_status status = target_read(&places, m->places, m->gl);
    if (!status)
        m->farthest = farthest_of(m, &places);
    relume_image_destroy(&places);
    return status;
}

relume_status captured_mesh_create(struct captured_mesh *m, const struct gl *gl,
                                   const struct relume_geometry *geometry,
                                   const struct target *places, const struct relume_log *log)
{
    const double APART = 4.0;  // as scenery.c
    const int most = gl->software ? MOST_SOFTWARE : MOST_VERTICES;
    const bool cube = geometry->projection == RELUME_CUBE;
    *m = (struct captured_mesh){
        .gl = gl, .places = places, .centre = geometry->center, .block = 1, .wraps = !cube};
    while ((places->width / m->block) * (places->height / m->block) > most)
        m->block++;
    const double around = cube ? 3.0 * M_PI : 2.0 * M_PI;
    m->least_cosine = cos(fmin(APART * around * m->block / places->width, 0.5 * M_PI));
    gl->GenVertexArrays(1, &m->array);
    relume_status status = program_create_with(&m->program, gl, "between_mesh.vert",
                                               "btf_depth.frag", uniforms, COUNT, log);
    if (!status)
        status = find_farthest(m);
    if (status)
        captured_mesh_destroy(m);
    return status;
}

void captured_mesh_destroy(struct captured_mesh *m)
{
    if (!m->gl)
        return;
    program_destroy(&m->program, m->gl);
    m->gl->DeleteVertexArrays(1, &m->array);
    *m = (struct captured_mesh){.gl = NULL};
}

void captured_mesh_draw(const struct captured_mesh *m, const float clip[16])
{
    const struct gl *gl = m->gl;
    const GLint *at = m->program.at;
    const int across = m->places->width / m->block, down = m->places->height / m->block;
    const int columns = m->wraps ? across : across - 1;
    if (columns < 1 || down < 2)
        return;
    gl->BindVertexArray(m->array);
    gl->UseProgram(m->program.id);
    texture_use(gl, 0, GL_TEXTURE_2D, m->places->texture);
    gl->Uniform1i(at[PLACES], 0);
    gl_set_vec3(gl, at[CENTRE], m->centre);
    gl->Uniform1i(at[BLOCK], m->block);
    gl->Uniform1i(at[WRAPS], m->wraps);
    gl->Uniform1f(at[FARTHEST], (float)m->farthest);
    gl->Uniform1f(at[LEAST_COSINE], (float)m->least_cosine);
    gl->UniformMatrix4fv(at[CLIP], 1, GL_FALSE, clip);
    gl->DrawArrays(GL_TRIANGLES, 0, 6 * columns * (down - 1));
}

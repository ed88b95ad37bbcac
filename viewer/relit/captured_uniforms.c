// captured_uniforms.c - the captured lights as uniforms: zone and triangles
#include "relit/captured_uniforms.h"

#include "format/coder/coding.h"
#include "gl/program.h"
#include "gl/target.h"
#include "relight/light/refit.h"
#include "relit/light_uniforms.h"

#include <stdlib.h>
#include <string.h>

// ---------------------------------------------------------------- the zone

void zone_upload(const struct gl *gl, int unit, GLuint border, const relume_coder *coder)
{
    light_uniforms_upload(gl, unit, border, GL_R32F, GL_RED, RELUME_CAPTURED_REGION_STEPS, 1,
                          relume_coder_region(coder)->border);
}

void zone_set(const struct gl *gl, const GLint *at, int unit, GLuint border,
              const relume_coder *coder)
{
    const struct relume_coder_info *info = relume_coder_info(coder);
    const struct relume_captured_region *zone = relume_coder_region(coder);
    texture_use(gl, unit, GL_TEXTURE_2D, border);
    gl->Uniform1i(at[ZONE_BORDER], unit);
    gl->Uniform1i(at[ZONE_HEMISPHERE], info->hemispherical);
    gl->Uniform1i(at[ZONE_POLE_Y], info->pole_y);
    gl->Uniform1i(at[ZONE_EVERYWHERE], zone->everywhere);
    gl_set_vec3(gl, at[ZONE_RIGHT], zone->right);
    gl_set_vec3(gl, at[ZONE_UP], zone->up);
    gl_set_vec3(gl, at[ZONE_FACING], zone->facing);
    gl->Uniform4f(at[ZONE_AXIS], (float)zone->axis.x, (float)zone->axis.y, (float)zone->axis.z,
                  (float)zone->inside);
}

// ---------------------------------------------------------------- triangles

// A row of four texels holds a triangle, then 16 cells of the map of starts.
enum { TRIANGLE_TEXELS = 4, TRIANGLE_FLOATS = 4 * TRIANGLE_TEXELS };
enum { STARTS = RELUME_WEIGHT_STARTS * RELUME_WEIGHT_STARTS };

int triangles_rows(const struct relume_weight_grid_info *g)
{
    return g->triangles + STARTS / TRIANGLE_FLOATS;
}

static void gather_triangle(float to[TRIANGLE_FLOATS], const struct relume_weight_triangle *t)
{
    for (int i = 0; i < 3; i++) {
        float *row = to + 4 * (i + 1);
        to[i] = (float)t->node[i];
        memcpy(row, t->inverse[i], sizeof t->inverse[i]);
        row[3] = (float)t->across[i];
    }
}

relume_status triangles_upload(const struct gl *gl, int unit, GLuint texture,
                               const struct relume_weight_grid_info *g)
{
    const int rows = triangles_rows(g);
    float *texels = calloc((size_t)rows, TRIANGLE_FLOATS * sizeof *texels);
    if (!texels)
        return RELUME_ENOMEM;
    for (int i = 0; i < g->triangles; i++)
        gather_triangle(texels + (size_t)i * TRIANGLE_FLOATS, &g->triangle[i]);
    for (int i = 0; i < STARTS; i++)
        texels[(size_t)g->triangles * TRIANGLE_FLOATS + (size_t)i] = (float)g->start[i];
    light_uniforms_upload(gl, unit, texture, GL_RGBA32F, GL_RGBA, TRIANGLE_TEXELS, rows, texels);
    free(texels);
    return RELUME_OK;
}

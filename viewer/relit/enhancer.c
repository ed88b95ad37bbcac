// enhancer.c - passes over relit views: normals are fitted once for each view that is looked at
#include "relit/enhancer.h"

#include "capture/manifest/reflectance_table.h"
#include "cli/program/say.h"
#include "common/vec.h"
#include "image/geometry/geometry.h"
#include "relight/normals/enhance.h"
#include "relight/view/slab_set.h"
#include "relight/view/view.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// The defaults of relume_pass_params.
static const float highlight = 0.6f, exponent = 40.0f;
enum { DETAIL = 4 };

enum {
    RECTANGLE,
    SIZE,
    VIEW,
    NORMALS,
    ALBEDOS,
    DETAILS,
    TOWARDS,
    REFERENCE,
    PASS,
    TOWARDS_GIVEN,
    LIGHTS,
    LIGHT_ROWS,
    STRENGTH,
    RANGE,
    STEP,
    COUNT
};
static const char *const uniforms[] = {
    "rectangle", "frame_size", "view",      "normals", "albedos",
    "details",   "towards",    "reference", "pass",    "towards_given",
    "lights",    "light_rows", "strength",  "range",   "step_of",
};
// Texture units, by their uniform
enum {
    UNIT_VIEW,
    UNIT_NORMALS,
    UNIT_ALBEDOS,
    UNIT_DETAILS,
    UNIT_TOWARDS,
    UNIT_REFERENCE,
    UNIT_LIGHTS
};
enum { LIGHTS_WIDE = 512 };

relume_status enhancer_create(struct enhancer *e, const struct gl *gl,
                              const struct code_source *source,
                              const struct relume_geometry *geometry, const double (*uv)[2],
                              int views, const struct relume_log *log)
{
    *e = (struct enhancer){
        .gl = gl, .log = log, .source = *source, .geometry = *geometry, .uv = uv, .views = views};
    e->view = calloc((size_t)views, sizeof *e->view);
    if (!e->view)
        return RELUME_ENOMEM;
    gl->GenVertexArrays(1, &e->vertices);
    gl->GenTextures(1, &e->light_rows);
    return program_create(&e->program, gl, "enhance.frag", uniforms, COUNT, log);
}

void enhancer_use_slabs(struct enhancer *e, const relume_slab_set *slabs, const double (*uv)[2],
                        const int *slab_of)
{
    e->around = slabs;
    e->uv = uv;
    e->slab_of = slab_of;
}

static int slab_of(const struct enhancer *e, int view)
{
    return e->slab_of ? e->slab_of[view] : 0;
}

void enhancer_destroy(struct enhancer *e)
{
    if (!e->gl)
        return;
    for (int i = 0; e->view && i < e->views; i++) {
        struct enhanced_view *v = &e->view[i];
        const GLuint textures[] = {v->normal, v->albedo, v->detail, v->reference};
        e->gl->DeleteTextures(4, textures);
        target_destroy(&v->shown, e->gl);
        relume_image_destroy(&v->albedo_grid);
        relume_image_destroy(&v->normals);
    }
    target_destroy(&e->grid, e->gl);
    e->gl->DeleteTextures(1, &e->light_rows);
    e->gl->DeleteTextures(RELUME_MOST_SLABS, e->towards);
    e->gl->DeleteVertexArrays(1, &e->vertices);
    program_destroy(&e->program, e->gl);
    free(e->view);
    *e = (struct enhancer){0};
}

// ---------------------------------------------------------------- textures

static GLuint upload(const struct gl *gl, GLuint texture, const struct relume_image *image)
{
    if (!texture)
        gl->GenTextures(1, &texture);
    texture_use(gl, 0, GL_TEXTURE_2D, texture);
    gl->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, image->width, image->height, 0, GL_RGB, GL_FLOAT,
                   image->data);
    texture_settings(gl, GL_TEXTURE_2D);
    return texture;
}

// Every step-th pixel.
static relume_status thin(struct relume_image *out, const struct relume_image *image)
{
    const int step = relume_pass_step(image->width, image->height);
    const relume_status status = relume_image_create(out, (image->width + step - 1) / step,
                                                     (image->height + step - 1) / step, 3);
    float *to = out->data;
    for (int y = 0; !status && y < image->height; y += step)
        for (int x = 0; x < image->width; x += step, to += 3)
            memcpy(to, image->data + 3 * ((size_t)y * (size_t)image->width + (size_t)x),
                   3 * sizeof *to);
    return status;
}

static relume_status find_detail(struct enhancer *e, struct enhanced_view *v)
{
    const int radius = e->params.radius > 0 ? e->params.radius : DETAIL;
    struct relume_image detail = {0};
    if (v->detail && v->radius == radius)
        return RELUME_OK;
    const relume_status status = relume_normals_detail(&detail, &v->normals, radius, e->threads);
    if (!status)
        v->detail = upload(e->gl, v->detail, &detail);
    v->radius = radius;
    relume_image_destroy(&detail);
    return status;
}

static relume_status fit(struct enhancer *e, int view)
{
    struct enhanced_view *v = &e->view[view];
    const struct relume_codes *codes;
    struct relume_normals normals = {0};
    relume_status status = e->source.codes(&codes, e->source.user, view);
    if (status)
        return status;
    status = relume_normals_fit(&normals, codes,
                                relume_normals_params(.log = e->log, .threads = e->threads,
                                                      .eye = relume_geometry_eye(&e->geometry)));
    if (!status)
        status = thin(&v->albedo_grid, &normals.albedo);
    if (!status) {
        v->normal = upload(e->gl, 0, &normals.normal);
        v->albedo = upload(e->gl, 0, &normals.albedo);
        v->normals = normals.normal;
        normals.normal = (struct relume_image){0};
    }
    relume_normals_destroy(&normals);
    if (e->source.drop)
        e->source.drop(e->source.user, view);
    return status;
}

// As the library's passes take it.
static struct relume_vec3 towards_eye(const struct enhancer *e, int slab, const struct target *view,
                                      int x, int y)
{
    if (e->around)
        return relume_slab_set_geometry(e->around, slab)->pose.axis[2];
    const struct relume_vec3 ray =
        relume_panorama_ray(&e->geometry, view->width, view->height, x + 0.5, y + 0.5);
    return (struct relume_vec3){-ray.x, -ray.y, -ray.z};
}

static relume_status find_towards(struct enhancer *e, int slab, const struct target *view)
{
    struct relume_image image;
    const relume_status status = relume_image_create(&image, view->width, view->height, 3);
    float *to = image.data;
    for (int y = 0; !status && y < view->height; y++)
        for (int x = 0; x < view->width; x++, to += 3) {
            const struct relume_vec3 towards = towards_eye(e, slab, view, x, y);
            to[0] = (float)towards.x;
            to[1] = (float)towards.y;
            to[2] = (float)towards.z;
        }
    if (!status)
        e->towards[slab] = upload(e->gl, 0, &image);
    relume_image_destroy(&image);
    return status;
}

// ---------------------------------------------------------------- photographs

static int nearest_light(const struct relume_manifest *m, struct relume_vec3 d)
{
    int best = 0;
    double most = -INFINITY;
    for (int i = 0; i < m->lights; i++) {
        const struct relume_vec3 l = m->directions[i];
        const double along = l.x * d.x + l.y * d.y + l.z * d.z;
        if (along > most)
            best = i;
        most = fmax(most, along);
    }
    return best;
}

static int nearest_view(const struct enhancer *e, const struct relume_manifest *m, int view)
{
    const double *uv = e->uv ? e->uv[view] : NULL;
    int best = 0;
    double least = INFINITY;
    for (int i = 0; uv && i < m->views; i++) {
        const double far = hypot(m->view[i].uv[0] - uv[0], m->view[i].uv[1] - uv[1]);
        if (e->around && m->view[i].slab != slab_of(e, view))
            continue;
        if (far < least)
            best = i;
        least = fmin(far, least);
    }
    return best;
}

// The photograph under the captured light nearest to the first one, times its value.
static relume_status find_photograph(struct enhancer *e, int view, const struct target *relit,
                                     const struct relume_light *lights, int n)
{
    struct enhanced_view *v = &e->view[view];
    if (!e->capture || n < 1)
        return RELUME_OK;
    const struct relume_manifest *m = relume_capture_manifest(e->capture);
    const int light = nearest_light(m, lights[0].direction);
    if (relume_capture_width(e->capture) != relit->width ||
        relume_capture_height(e->capture) != relit->height)
        return say(e->log, RELUME_EUNFIT, "the capture's images are %d x %d; expected %d x %d",
                   relume_capture_width(e->capture), relume_capture_height(e->capture),
                   relit->width, relit->height);
    if (v->reference && v->light == light)
        return RELUME_OK;
    struct relume_image image;
    const relume_status status =
        relume_capture_masked(&image, e->capture, nearest_view(e, m, view), light, e->log);
    if (!status)
        v->reference = upload(e->gl, v->reference, &image);
    v->light = light;
    relume_image_destroy(&image);
    return status;
}

// ---------------------------------------------------------------- drawing

static relume_status prepare_view(struct enhancer *e, int view, const struct target *relit,
                                  enum relume_pass pass, const struct relume_light *lights, int n)
{
    struct enhanced_view *v = &e->view[view];
    relume_status status = RELUME_OK;
    if (!v->shown.texture)
        status = target_create(&v->shown, e->gl, relit->width, relit->height, e->log);
    if (!status && relume_pass_needs_normals(pass) && !v->normal)
        status = fit(e, view);
    if (!status && pass == RELUME_PASS_UNSHARP)
        status = find_detail(e, v);
    if (!status && pass == RELUME_PASS_SPECULAR && !e->towards[slab_of(e, view)] &&
        (e->around || e->geometry.projection >= RELUME_CYLINDRICAL))
        status = find_towards(e, slab_of(e, view), relit);
    if (!status && pass == RELUME_PASS_DIFFERENCE)
        status = find_photograph(e, view, relit, lights, n);
    return status;
}

// The directional ones, as enhance.frag reads them. RELUME_ENOMEM.
static relume_status set_lights(const struct enhancer *e, const struct relume_light *lights, int n)
{
    const struct gl *gl = e->gl;
    const int rows = 2 * (n / LIGHTS_WIDE + 1);
    float(*texel)[3] = calloc((size_t)rows * LIGHTS_WIDE, sizeof *texel);
    int count = 0;
    if (!texel)
        return RELUME_ENOMEM;
    for (int i = 0; i < n; i++) {
        const struct relume_vec3 d = vec3_unit(lights[i].direction);
        if (lights[i].kind != RELUME_LIGHT_DIRECTIONAL)
            continue;
        float *direction = texel[2 * (count / LIGHTS_WIDE) * LIGHTS_WIDE + count % LIGHTS_WIDE];
        direction[0] = (float)d.x;
        direction[1] = (float)d.y;
        direction[2] = (float)d.z;
        memcpy(direction + 3 * LIGHTS_WIDE, lights[i].rgb, sizeof lights[i].rgb);
        count++;
    }
    texture_use(gl, UNIT_LIGHTS, GL_TEXTURE_2D, e->light_rows);
    gl->PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, LIGHTS_WIDE, rows, 0, GL_RGB, GL_FLOAT, texel);
    texture_settings(gl, GL_TEXTURE_2D);
    gl->Uniform1i(e->program.at[LIGHTS], count);
    gl->Uniform1i(e->program.at[LIGHT_ROWS], UNIT_LIGHTS);
    free(texel);
    return RELUME_OK;
}

static void set_textures(const struct enhancer *e, int view, const struct target *relit)
{
    const struct enhanced_view *v = &e->view[view];
    const GLuint towards = e->towards[slab_of(e, view)];
    const struct gl *gl = e->gl;
    const GLuint textures[] = {
        [UNIT_VIEW] = relit->texture, [UNIT_NORMALS] = v->normal, [UNIT_ALBEDOS] = v->albedo,
        [UNIT_DETAILS] = v->detail,   [UNIT_TOWARDS] = towards,   [UNIT_REFERENCE] = v->reference,
    };
    for (int unit = UNIT_VIEW; unit <= UNIT_REFERENCE; unit++) {
        texture_use(gl, unit, GL_TEXTURE_2D, textures[unit]);
        gl->Uniform1i(e->program.at[VIEW + unit], unit);
    }
    gl->Uniform1i(e->program.at[TOWARDS_GIVEN], towards != 0);
}

static void draw_pass(const struct enhancer *e, const struct target *onto, enum relume_pass pass,
                      int step)
{
    const struct gl *gl = e->gl;
    const GLint *at = e->program.at;
    const struct relume_pass_params *p = &e->params;
    gl->Uniform1i(at[PASS], (GLint)pass);
    gl->Uniform1i(at[STEP], step);
    gl->Uniform4f(at[STRENGTH], p->gain != 0 ? p->gain : RELUME_PASS_GAIN,
                  p->specular != 0 ? p->specular : highlight,
                  p->exponent > 0 ? p->exponent : exponent, 0);
    gl->Uniform4f(at[RANGE], e->range.low, e->range.high, e->range.pivot, e->range.scale);
    gl->Uniform4f(at[RECTANGLE], 0, 0, (float)onto->width, (float)onto->height);
    gl->Uniform2f(at[SIZE], (float)onto->width, (float)onto->height);
    gl->DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

// As the library does, of a grid of pixels alone.
static relume_status measure(struct enhancer *e, int view, const struct target *relit,
                             enum relume_pass pass, const struct relume_light *lights, int n)
{
    const struct enhanced_view *v = &e->view[view];
    const int step = relume_pass_step(relit->width, relit->height);
    const int width = (relit->width + step - 1) / step, height = (relit->height + step - 1) / step;
    struct relume_image grid;
    relume_status status = target_need(&e->grid, e->gl, width, height, e->log);
    if (status)
        return status;
    set_textures(e, view, relit);  // making a target takes the first
    target_begin(&e->grid, e->gl);
    draw_pass(e, &e->grid, RELUME_PASS_COLOUR, step);
    status = target_read(&grid, &e->grid, e->gl);
    if (!status)
        status = relume_pass_measure(&e->range, &grid, pass,
                                     v->albedo_grid.data ? &v->albedo_grid : NULL, lights, n,
                                     e->params.gain);
    relume_image_destroy(&grid);
    if (e->params.top > e->params.low) {
        e->range.low = e->params.low;
        e->range.high = e->params.top;
    }
    return status;
}

relume_status enhancer_view(const struct target **out, struct enhancer *e, int view,
                            const struct target *relit, enum relume_pass pass,
                            const struct relume_light *lights, int n)
{
    const struct gl *gl = e->gl;
    const struct enhanced_view *v = &e->view[view];
    relume_status status = prepare_view(e, view, relit, pass, lights, n);
    if (status)
        return status;
    gl->BindVertexArray(e->vertices);
    gl->UseProgram(e->program.id);
    status = set_lights(e, lights, n);
    if (!status && relume_pass_needs_range(pass))
        status = measure(e, view, relit, pass, lights, n);
    if (status)
        return status;
    set_textures(e, view, relit);
    target_begin(&v->shown, gl);
    draw_pass(e, &v->shown, pass, 1);
    *out = &v->shown;
    return gl_check(gl, "enhancing", e->log);
}

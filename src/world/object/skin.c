// skin.c - what is there of a surface, and what it sends of its own: the opacity and the emission
// of materials that the files of meshes name (glTF 2.0, Khronos 2021, 3.9.3 and 3.9.4)
//
// A ray passes what is cut out, and of what is blended as many rays as there is nothing of it: by a
// number that the ray and the place are hashed to, so that every picture is the same. Rays of the
// eye see all layers that are blended.
#include "world/object/skin.h"

#include "core/base/memory.h"
#include "core/math/bilinear.h"
#include "core/math/random.h"

#include <string.h>

enum { EMITS = 3, OPACITY = 3 };           // channels
static const float THERE = 1.0f / 512.0f;  // what is less opaque is nowhere

static const struct relume_object_skin *skin_of(const relume_objects *o, int part)
{
    return o->material[o->part[part].material].skin;
}

// What is left of a whole number of repeats; of what is too large for that, 0.
static double within(double x)
{
    const double left = x - floor(x);
    return left < 1.0 ? left : 0.0;
}

// A channel between its texels, which repeat; (s, t) in repeats, t down.
static float texel_at(const struct relume_image *level, double s, double t, int channel)
{
    const double x = within(s) * level->width - 0.5, y = within(t) * level->height - 0.5;
    const double left = floor(x), top = floor(y);
    float row[2];
    for (int j = 0; j < 2; j++) {
        const float *line = level->data + 4 * (size_t)level->width *
                                              (size_t)index_wrapped((int)top + j, level->height);
        const float a = line[4 * index_wrapped((int)left, level->width) + channel];
        const float b = line[4 * index_wrapped((int)left + 1, level->width) + channel];
        row[j] = a + (b - a) * (float)(x - left);
    }
    return row[0] + (row[1] - row[0]) * (float)(y - top);
}

static float opacity_of(const struct relume_object_skin *skin, double s, double t)
{
    if (!skin || skin->cover == RELUME_COVER_WHOLE)
        return 1.0f;
    const float opacity = texel_at(&skin->texels[0], s, t, OPACITY);
    return skin->cover == RELUME_COVER_BLENDED ? opacity : opacity < skin->cutoff ? 0.0f : 1.0f;
}

float skin_opacity(const relume_objects *o, const struct surface_point *p)
{
    return opacity_of(skin_of(o, p->part), p->s, p->t);
}

static uint64_t bits_of(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static double chance(uint32_t triangle, float u, float v, const float direction[3])
{
    uint64_t key = triangle;
    const float all[5] = {u, v, direction[0], direction[1], direction[2]};
    for (int i = 0; i < 5; i++)
        key = random_mix(key ^ bits_of(all[i]));
    return (double)(key >> 11) * 0x1p-53;
}

static bool let_through(const void *context, uint32_t triangle, float u, float v,
                        const float direction[3], bool layers)
{
    const relume_objects *o = context;
    const struct relume_object_skin *skin = skin_of(o, (int)o->mesh.triangles[triangle].material);
    if (!skin || skin->cover == RELUME_COVER_WHOLE)
        return false;
    const uint32_t *c = o->triangles[triangle];
    const double weight[3] = {1.0 - (double)u - (double)v, (double)u, (double)v};
    double s = 0.0, t = 0.0;
    for (int k = 0; k < 3; k++) {
        s += weight[k] * (double)o->vertices[c[k]].texture[0];
        t += weight[k] * (double)o->vertices[c[k]].texture[1];
    }
    const float opacity = opacity_of(skin, s, t);
    if (layers || opacity <= 0.0f || opacity >= 1.0f)
        return opacity < THERE;
    return chance(triangle, u, v, direction) >= (double)opacity;
}

bool skin_holes(struct trace_holes *out, const relume_objects *o)
{
    *out = (struct trace_holes){let_through, o};
    for (int i = 0; i < o->info.materials; i++)
        if (o->material[i].skin && o->material[i].skin->cover != RELUME_COVER_WHOLE)
            return true;
    return false;
}

// ---------------------------------------------------------------- emission

// Between the two levels whose texels are about as wide as the longer side of the pixel.
void skin_add_emission(float rgb[3], const relume_objects *o, const struct surface_point *p,
                       float part)
{
    const struct relume_object_skin *skin = skin_of(o, p->part);
    if (!skin || !skin->sends || part == 0.0f)
        return;
    const double width = skin->texels[0].width, height = skin->texels[0].height;
    const double right = hypot(p->right[0] * width, p->right[1] * height);
    const double down = hypot(p->down[0] * width, p->down[1] * height);
    const double level = fmin(log2(fmax(fmax(right, down), 1.0)), skin->levels - 1.0);
    const int fine = (int)level, coarse = fine + 1 < skin->levels ? fine + 1 : fine;
    const float between = (float)(level - fine);
    for (int c = 0; c < EMITS; c++)
        rgb[c] += part * ((1.0f - between) * texel_at(&skin->texels[fine], p->s, p->t, c) +
                          between * texel_at(&skin->texels[coarse], p->s, p->t, c));
}

// ---------------------------------------------------------------- layers

bool skin_layer(struct surface_point *out, struct skin_layers *l, const relume_objects *o,
                const struct ray *ray, double farthest)
{
    enum { MOST = 64 };
    const float DARK = 1.0f / 1024.0f;
    float from[3], along[3], off[3];
    struct trace_hit hit;
    if (l->left < DARK || l->count >= MOST)
        return false;
    if (!l->count)
        l->from = ray->origin;
    vec3_store(from, l->from);
    vec3_store(along, ray->direction);
    if (!trace_layer(o->tracer, from, along, &hit))
        return false;
    objects_point(out, o, &hit, ray->direction);
    out->distance = vec3_dot(vec3_sub(out->position, ray->origin), ray->direction);
    if (out->distance >= farthest)
        return false;
    l->part = l->left * skin_opacity(o, out);
    l->left -= l->part;
    l->count++;
    vec3_store(from, out->position);
    vec3_store(off, vec3_scale(out->geometric, -1.0));
    trace_leave(from, off, along);
    l->from = vec3_floats(along);
    return true;
}

// ---------------------------------------------------------------- their making

void skin_destroy(const struct relume_object_skin **skin)
{
    struct relume_object_skin *s = (struct relume_object_skin *)*skin;
    struct relume_image *level = s ? (struct relume_image *)s->texels : NULL;
    for (int i = 0; s && i < s->levels; i++)
        relume_image_destroy(&level[i]);
    mem_free(level);
    mem_free(s);
    *skin = NULL;
}

static void fill(struct relume_image *to, const struct relume_image *emitted,
                 const struct relume_image *opacity, const struct skin_factors *f)
{
    const size_t texels = (size_t)to->width * (size_t)to->height;
    for (size_t i = 0; i < texels; i++) {
        for (size_t c = 0; c < EMITS; c++)
            to->data[4 * i + c] =
                f->emission[c] * (emitted->data ? fmaxf(emitted->data[3 * i + c], 0.0f) : 1.0f);
        const float part = f->opacity * (opacity->data ? opacity->data[i] : 1.0f);
        to->data[4 * i + OPACITY] = fminf(fmaxf(part, 0.0f), 1.0f);
    }
}

static relume_status fill_finest(struct relume_image *to, const struct skin_factors *f, int threads)
{
    enum { MOST_SIDE = 2048 };
    const struct relume_image *const given[2] = {f->emitted, f->opaque};
    struct relume_image scaled[2] = {{0}, {0}};
    int width = 1, height = 1;
    for (int i = 0; i < 2; i++) {
        width = given[i] && given[i]->width > width ? given[i]->width : width;
        height = given[i] && given[i]->height > height ? given[i]->height : height;
    }
    width = width < MOST_SIDE ? width : MOST_SIDE;
    height = height < MOST_SIDE ? height : MOST_SIDE;
    relume_status status = relume_image_create(to, width, height, 4);
    for (int i = 0; i < 2 && !status; i++)
        if (given[i])
            status = relume_image_scale(&scaled[i], given[i], width, height,
                                        relume_scale_params(.threads = threads));
    if (!status)
        fill(to, &scaled[0], &scaled[1], f);
    relume_image_destroy(&scaled[0]);
    relume_image_destroy(&scaled[1]);
    return status;
}

relume_status skin_make(const struct relume_object_skin **out, const struct skin_factors *f,
                        int threads)
{
    enum { MOST_LEVELS = 12 };
    const float *e = f->emission;
    struct relume_object_skin *s = mem_zeroed(1, sizeof *s);
    struct relume_image *level = mem_zeroed(MOST_LEVELS, sizeof *level);
    *out = s;
    if (!s || !level) {
        mem_free(level);
        mem_free(s);
        *out = NULL;
        return RELUME_ENOMEM;
    }
    *s = (struct relume_object_skin){.cover = f->cover,
                                     .cutoff = f->cutoff,
                                     .sends = e[0] + e[1] + e[2] > 0.0f,
                                     .texels = level,
                                     .levels = 1};
    relume_status status = fill_finest(&level[0], f, threads);
    while (!status && s->levels < MOST_LEVELS &&
           (level[s->levels - 1].width > 1 || level[s->levels - 1].height > 1)) {
        const struct relume_image *last = &level[s->levels - 1];
        status = relume_image_scale(&level[s->levels], last, last->width > 1 ? last->width / 2 : 1,
                                    last->height > 1 ? last->height / 2 : 1,
                                    relume_scale_params(.threads = threads));
        s->levels += !status;
    }
    if (status)
        skin_destroy(out);
    return status;
}

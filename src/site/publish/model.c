// model.c - see model.h
#include "site/publish/model.h"

#include "core/base/memory.h"
#include "core/math/scalar.h"
#include "site/publish/picture.h"
#include "world/baked/baked.h"

#include <math.h>
#include <relume/shape/mesh.h>
#include <string.h>

enum { AROUND = 32 };  // lights of all sides, in golden angles
enum { SPREAD = 4 };   // texels around charts that programs may read between texels

// ---------------------------------------------------------------- texture

// Of radiance 1, each of 4 pi / AROUND / pi; none where the light is baked in.
static relume_status light_up(baked_lit **lit, const relume_baked *b, int threads)
{
    struct relume_light light[AROUND];
    const float part = 4.0f / AROUND;
    for (int i = 0; i < AROUND; i++) {
        const double y = 1.0 - 2.0 * (i + 0.5) / AROUND, r = sqrt(1.0 - y * y), a = 2.39996323 * i;
        light[i] = (struct relume_light){.kind = RELUME_LIGHT_DIRECTIONAL,
                                         .direction = {r * cos(a), y, r * sin(a)},
                                         .rgb = {part, part, part}};
    }
    return lit_create(lit, b, &frame_world, light, b->info.fixed ? 0 : AROUND, threads);
}

// Texels beside those that are known become means of these.
static relume_status spread(struct relume_image *image, unsigned char *known)
{
    const int width = image->width, height = image->height;
    const size_t n = (size_t)width * (size_t)height;
    unsigned char *before = mem_array(n, 1);
    for (int step = 0; before && step < SPREAD; step++) {
        memcpy(before, known, n);
        for (size_t i = 0; i < n; i++) {
            const int x = (int)(i % (size_t)width), y = (int)(i / (size_t)width);
            float sum[3] = {0.0f, 0.0f, 0.0f}, count = 0.0f;
            for (int k = 0; !before[i] && k < 9; k++) {
                const int u = x + k % 3 - 1, v = y + k / 3 - 1;
                const size_t at = (size_t)v * (size_t)width + (size_t)u;
                if (u < 0 || v < 0 || u >= width || v >= height || !before[at])
                    continue;
                for (size_t c = 0; c < 3; c++)
                    sum[c] += image->data[3 * at + c];
                count += 1.0f;
            }
            known[i] = before[i] || count > 0.0f;
            for (size_t c = 0; count > 0.0f && c < 3; c++)
                image->data[3 * i + c] = sum[c] / count;
        }
    }
    mem_free(before);
    return before ? RELUME_OK : RELUME_ENOMEM;
}

static relume_status paint(struct relume_image *out, const relume_baked *b, const baked_lit *lit)
{
    const int width = b->info.width, height = b->info.height;
    unsigned char *known = mem_zeroed((size_t)width * (size_t)height, 1);
    relume_status status = known ? relume_image_create(out, width, height, 3) : RELUME_ENOMEM;
    for (size_t i = 0; !status && i < (size_t)width * (size_t)height; i++) {
        if (b->cluster[i] == BAKED_NONE)
            continue;
        const float *normal = b->frame[i];
        const struct baked_look look = {
            {((double)(i % (size_t)width) + 0.5) / width,
             ((double)(i / (size_t)width) + 0.5) / height},
            vec3_of((double)normal[0], (double)normal[1], (double)normal[2])};
        lit_colour(out->data + 3 * i, b, lit, &look);
        known[i] = 1;
    }
    if (!status)
        status = spread(out, known);
    mem_free(known);
    return status;
}

static relume_status write_texture(const struct site *site, const char *name, const relume_baked *b)
{
    struct relume_image image = {0};
    baked_lit *lit = NULL;
    const struct relume_rect all = {0, 0, b->info.width, b->info.height};
    relume_status status = light_up(&lit, b, site->params->threads);
    if (!status)
        status = paint(&image, b, lit);
    if (!status)
        status = picture_save_jpeg(site, name, &image, &all);
    lit_destroy(&lit);
    relume_image_destroy(&image);
    return status;
}

// ---------------------------------------------------------------- mesh

struct numbered {
    struct atlas_corner corner;
    size_t number;
};

static int compare(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(struct atlas_corner));
}

// Corners that are alike in everything are one vertex; arrays are of the caller.
static relume_status fill(struct relume_mesh *m, const relume_baked *b)
{
    const size_t corners = 3 * b->info.triangles;
    struct numbered *all = mem_array(corners, sizeof *all);
    m->position = mem_array(corners, sizeof *m->position);
    m->normal = mem_array(corners, sizeof *m->normal);
    m->texture = mem_array(corners, sizeof *m->texture);
    m->triangle = mem_array(b->info.triangles, sizeof *m->triangle);
    const bool allocated = all && m->position && m->normal && m->texture && m->triangle;
    for (size_t i = 0; allocated && i < corners; i++)
        all[i] = (struct numbered){b->triangle[i / 3][i % 3], i};
    if (allocated)
        qsort(all, corners, sizeof *all, compare);
    for (size_t i = 0; allocated && i < corners; i++) {
        const struct atlas_corner *c = &all[i].corner;
        if (!i || compare(&all[i], &all[i - 1])) {
            const size_t at = m->vertex_count++;
            memcpy(m->position[at], c->position, sizeof *m->position);
            memcpy(m->normal[at], c->normal, sizeof *m->normal);
            m->texture[at][0] = c->place[0];
            m->texture[at][1] = 1.0f - c->place[1];
        }
        m->triangle[all[i].number / 3][all[i].number % 3] = (uint32_t)(m->vertex_count - 1);
    }
    m->triangle_count = b->info.triangles;
    mem_free(all);
    return allocated ? RELUME_OK : RELUME_ENOMEM;
}

relume_status model_write(const struct site *site, const struct page *page, const relume_baked *b)
{
    struct relume_mesh mesh = {.vertex_count = 0};
    char *texture = mem_format("%s/iiif/texture.jpg", page->name);
    char *path = mem_format("%s/%s/model.glb", site->path, page->name);
    mesh.picture = mem_format("%s/%s/iiif/texture.jpg", site->path, page->name);
    relume_status status = texture && path && mesh.picture ? fill(&mesh, b) : RELUME_ENOMEM;
    if (!status)
        status = write_texture(site, texture, b);
    if (!status)
        status = relume_mesh_write(&mesh, path, relume_mesh_params(.log = site->log));
    relume_mesh_free(&mesh);
    mem_free(texture);
    mem_free(path);
    return status;
}

// sheet.c - a cloud of billboards as quads and one picture, for other programs
#include "core/base/log.h"
#include "core/base/memory.h"

#include "core/math/scalar.h"
#include "shape/distance/lod.h"

#include <math.h>
#include <relume/shape/billboards.h>
#include <string.h>

// Empty texels around each rectangle, which show what is beside them: pictures are looked at
// between texels.
enum { BORDER = 1, MOST_SIDE = 16384 };

struct place {
    size_t billboard;
    int width, height, left, top;  // with the border
};

static int by_height(const void *a, const void *b)
{
    const struct place *const p = a, *const q = b;
    if (p->height != q->height)
        return p->height > q->height ? -1 : 1;
    return (p->billboard > q->billboard) - (p->billboard < q->billboard);
}

// Shelves, the highest rectangles first; the height of all.
static int shelve(struct place *place, size_t n, int width)
{
    int left = 0, top = 0, shelf = 0;
    for (size_t i = 0; i < n; i++) {
        if (left + place[i].width > width) {
            top += shelf;
            left = shelf = 0;
        }
        if (top > MOST_SIDE)
            return top;
        place[i].left = left, place[i].top = top;
        left += place[i].width;
        shelf = larger_of(shelf, place[i].height);
    }
    return top + shelf;
}

// Where each goes in a picture that is about as wide as high.
static relume_status arrange(struct place *place, int *width, int *height,
                             const struct relume_billboards *cloud, const struct relume_log *log)
{
    double area = 0.0;
    int widest = 0;
    for (size_t i = 0; i < cloud->count; i++) {
        const struct relume_billboard *const b = &cloud->billboard[i];
        place[i] = (struct place){i, b->width + 2 * BORDER, b->height + 2 * BORDER, 0, 0};
        area += (double)place[i].width * place[i].height;
        widest = larger_of(widest, place[i].width);
    }
    qsort(place, cloud->count, sizeof *place, by_height);
    *width = larger_of(widest, (int)fmin(ceil(sqrt(1.1 * area)), MOST_SIDE));
    *height = shelve(place, cloud->count, *width);
    return *width <= MOST_SIDE && *height <= MOST_SIDE
               ? RELUME_OK
               : log_fail(
                     log, RELUME_ELIMIT,
                     "billboards: their picture is larger than %d x %d; expected larger texels",
                     MOST_SIDE, MOST_SIDE);
}

// ---------------------------------------------------------------- colours

static void look_up(float rgb[3], const struct relume_image *picture, double u, double v)
{
    const double x = (u - floor(u)) * picture->width - 0.5;
    const double y = (1.0 - (v - floor(v))) * picture->height - 0.5;
    const double fx = x - floor(x), fy = y - floor(y);
    memset(rgb, 0, 3 * sizeof *rgb);
    for (int k = 0; k < 4; k++) {
        const int i = ((int)floor(x) + (k & 1) + picture->width) % picture->width;
        const int j = smaller_of(larger_of((int)floor(y) + (k >> 1), 0), picture->height - 1);
        const double weight = (k & 1 ? fx : 1.0 - fx) * (k >> 1 ? fy : 1.0 - fy);
        add_scaled(rgb, picture->data + 3 * ((size_t)j * (size_t)picture->width + (size_t)i),
                   (float)weight, 3);
    }
}

static void colour_of(float rgb[3], const struct relume_billboard_texel *t,
                      const struct relume_mesh *mesh, const struct relume_image *colour)
{
    const uint32_t *const v = mesh->triangle[t->triangle];
    const float weight[3] = {1.0f - t->weight[0] - t->weight[1], t->weight[0], t->weight[1]};
    if (colour && mesh->texture) {
        double uv[2] = {0};
        for (int k = 0; k < 3; k++)
            for (int c = 0; c < 2; c++)
                uv[c] += (double)weight[k] * (double)mesh->texture[v[k]][c];
        look_up(rgb, colour, uv[0], uv[1]);
        return;
    }
    const struct relume_transfer srgb = {.curve = RELUME_CURVE_SRGB};
    for (int c = 0; c < 3; c++) {
        rgb[c] = mesh->colour ? 0.0f : 0.8f;
        for (int k = 0; mesh->colour && k < 3; k++)
            rgb[c] +=
                weight[k] * relume_transfer_decode(srgb, (float)mesh->colour[v[k]][c] / 255.0f);
    }
}

// Empty texels take the mean of those around that are not; again for those around these.
static void spread(float *pixel, int stride, const struct place *p)
{
    enum { ROUNDS = 2 };
    for (int round = 0; round < ROUNDS; round++) {
        const float own = -(float)(round + 1);  // coverage of those that are set in this round
        for (int y = 0; y < p->height; y++)
            for (int x = 0; x < p->width; x++) {
                float *const at = pixel + 4 * ((ptrdiff_t)y * stride + x);
                float sum[3] = {0}, n = 0.0f;
                for (int k = 0; k < 9 && at[3] == 0.0f; k++) {
                    const int i = x + k % 3 - 1, j = y + k / 3 - 1;
                    if (i < 0 || j < 0 || i >= p->width || j >= p->height)
                        continue;
                    const float *const from = pixel + 4 * ((ptrdiff_t)j * stride + i);
                    if (from[3] == 0.0f || from[3] == own)
                        continue;
                    add_scaled(sum, from, 1.0f, 3);
                    n += 1.0f;
                }
                for (int c = 0; c < 3 && n > 0.0f; c++)
                    at[c] = sum[c] / n;
                at[3] = n > 0.0f ? own : at[3];
            }
    }
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++) {
            float *const coverage = pixel + 4 * ((ptrdiff_t)y * stride + x) + 3;
            *coverage = fmaxf(*coverage, 0.0f);
        }
}

// Rows of texels go up, those of pictures down.
static void paint(struct relume_image *to, const struct place *p,
                  const struct relume_billboards *cloud, const struct relume_mesh *mesh,
                  const struct relume_image *colour)
{
    const struct relume_billboard *const b = &cloud->billboard[p->billboard];
    float *const pixel = to->data + 4 * ((size_t)p->top * (size_t)to->width + (size_t)p->left);
    for (int y = 0; y < b->height; y++)
        for (int x = 0; x < b->width; x++) {
            const struct relume_billboard_texel *const t =
                &cloud
                     ->texel[b->first + (size_t)(b->height - 1 - y) * (size_t)b->width + (size_t)x];
            float *const at =
                pixel + 4 * ((size_t)(y + BORDER) * (size_t)to->width + (size_t)(x + BORDER));
            if (t->triangle == RELUME_BILLBOARD_NONE)
                continue;
            colour_of(at, t, mesh, colour);
            at[3] = t->coverage;
        }
    spread(pixel, to->width, p);
}

// ---------------------------------------------------------------- quads

static void put_quad(struct relume_mesh *q, const struct place *p,
                     const struct relume_billboards *cloud, int width, int height)
{
    const struct relume_billboard *const b = &cloud->billboard[p->billboard];
    const size_t first = 4 * p->billboard;
    for (int k = 0; k < 4; k++) {
        const int right = k == 1 || k == 2, upper = k >= 2;
        for (int c = 0; c < 3; c++) {
            q->position[first + (size_t)k][c] =
                b->corner[c] + cloud->side * ((float)(right * b->width) * b->across[c] +
                                              (float)(upper * b->height) * b->up[c]);
            q->normal[first + (size_t)k][c] = b->normal[c];
        }
        const double x = p->left + BORDER + right * b->width;
        const double y = p->top + BORDER + (1 - upper) * b->height;
        q->texture[first + (size_t)k][0] = (float)(x / width);
        q->texture[first + (size_t)k][1] = (float)(1.0 - y / height);
    }
    const uint32_t v = (uint32_t)first;
    const uint32_t triangle[2][3] = {{v, v + 1, v + 2}, {v, v + 2, v + 3}};
    memcpy(q->triangle + 2 * p->billboard, triangle, sizeof triangle);
}

static bool make_quads(struct relume_mesh *q, size_t n)
{
    q->position = mem_array(4 * n, sizeof *q->position);
    q->normal = mem_array(4 * n, sizeof *q->normal);
    q->texture = mem_array(4 * n, sizeof *q->texture);
    q->triangle = mem_array(2 * n, sizeof *q->triangle);
    q->vertex_count = 4 * n;
    q->triangle_count = 2 * n;
    return q->position && q->normal && q->texture && q->triangle;
}

relume_status relume_billboards_sheet(struct relume_mesh *quads, struct relume_image *picture,
                                      const struct relume_billboards *cloud,
                                      const struct relume_mesh *mesh,
                                      const struct relume_image *colour,
                                      const struct relume_log *log)
{
    int width = 0, height = 0;
    struct place *place = mem_array(cloud->count, sizeof *place);
    *quads = (struct relume_mesh){.vertex_count = 0};
    *picture = (struct relume_image){.width = 0};
    relume_status status = place ? arrange(place, &width, &height, cloud, log) : RELUME_ENOMEM;
    if (!status)
        status = relume_image_create(picture, width, height, 4);
    if (!status && !make_quads(quads, cloud->count))
        status = RELUME_ENOMEM;
    for (size_t i = 0; !status && i < cloud->count; i++) {
        put_quad(quads, &place[i], cloud, width, height);
        paint(picture, &place[i], cloud, mesh, colour);
    }
    mem_free(place);
    if (status) {
        relume_mesh_free(quads);
        relume_image_destroy(picture);
    }
    return status;
}

// row_counts.c - what is counted in the rows that a member of a team encodes
#include "encode/parts/row_counts.h"

#include "core/base/memory.h"

#include <float.h>
#include <string.h>

relume_status row_counts_create(struct row_counts *out, const relume_capture *capture,
                                const relume_coder *coder, const int *order)
{
    const struct relume_manifest *m = relume_capture_manifest(capture);
    *out = (struct row_counts){.views = m->views,
                               .lights = m->lights,
                               .planes = relume_coder_info(coder)->planes,
                               .height = relume_capture_height(capture),
                               .order = order};
    const size_t views = (size_t)m->views;
    out->view = mem_zeroed(views, sizeof *out->view);
    out->lit = mem_zeroed(views * (size_t)out->lights, sizeof *out->lit);
    out->error = mem_zeroed(views * (size_t)out->height, sizeof *out->error);
    out->range = mem_zeroed((size_t)out->planes, sizeof *out->range);
    return out->view && out->lit && out->error && out->range ? RELUME_OK : RELUME_ENOMEM;
}

void row_counts_destroy(struct row_counts *c)
{
    mem_free(c->view);
    mem_free(c->lit);
    mem_free(c->error);
    mem_free(c->range);
}

// ---------------------------------------------------------------- as a piece

static void hand_in(const void *results, struct piece_writer *to)
{
    const struct row_counts *c = results;
    const size_t lights = (size_t)c->lights, height = (size_t)c->height;
    for (int i = 0; i < c->views; i++) {
        const size_t at = (size_t)c->order[i];
        const struct view_counts *v = &c->view[at];
        if (!v->rows)
            continue;
        piece_put(to, &v->sums, sizeof v->sums);
        piece_put(to, c->lit + at * lights, lights);
        piece_put(to, c->error + at * height + v->row, (size_t)v->rows * sizeof *c->error);
    }
    piece_put(to, c->range, (size_t)c->planes * sizeof *c->range);
}

static bool is_count(uint64_t n)
{
    return n < (uint64_t)1 << 53;
}

static bool are_sums(const struct row_sums *s)
{
    return s->root >= 0.0 && s->root < DBL_MAX && is_count(s->measured) && is_count(s->lit) &&
           is_count(s->pixels) && is_count(s->black) && is_count(s->clipped) &&
           is_count(s->always_clipped) && is_count(s->repaired);
}

static bool get_lights(struct piece_reader *from, bool *lit, size_t lights)
{
    const unsigned char *byte = piece_view(from, lights);
    for (size_t i = 0; byte && i < lights; i++) {
        if (byte[i] > 1)
            return false;
        lit[i] = byte[i] != 0;
    }
    return byte;
}

static bool get_errors(struct piece_reader *from, double *error, size_t rows)
{
    bool good = piece_get(from, error, rows * sizeof *error);
    for (size_t i = 0; good && i < rows; i++)
        good = error[i] >= 0.0 && error[i] < DBL_MAX;
    return good;
}

static relume_status fetch(void *results, struct piece_reader *from)
{
    struct row_counts *c = results;
    const size_t lights = (size_t)c->lights, height = (size_t)c->height;
    bool good = true;
    for (int i = 0; good && i < c->views; i++) {
        const size_t at = (size_t)c->order[i];
        struct view_counts *v = &c->view[at];
        if (v->rows)
            good = piece_get(from, &v->sums, sizeof v->sums) && are_sums(&v->sums) &&
                   get_lights(from, c->lit + at * lights, lights) &&
                   get_errors(from, c->error + at * height + v->row, (size_t)v->rows);
    }
    good = good && piece_get(from, c->range, (size_t)c->planes * sizeof *c->range);
    for (int p = 0; good && p < c->planes; p++)
        good = c->range[p].min >= -FLT_MAX && c->range[p].max <= FLT_MAX;
    return good ? RELUME_OK : RELUME_EDAMAGED;
}

const struct team_bytes row_counts_bytes = {hand_in, fetch};

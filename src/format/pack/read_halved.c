// read_halved.c - the first reduced level of planes that are coded with loss, which their file
// leaves out: it would be most of what levels take, and any of it is soon made of the view
#include "format/coder/codes.h"
#include "format/coder/coding.h"
#include "format/pack/reader.h"

// Where 2 x 2 pixels lie, those of them that there are, and which count.
struct four {
    size_t at[4];
    int n, inside;
    bool counts[4];
};

static struct four four_at(const struct relume_codes *from, int x, int y, const uint16_t *inside)
{
    struct four f = {.n = 0};
    for (int i = 0; i < 4; i++) {
        const int u = 2 * x + i % 2, v = 2 * y + i / 2;
        if (u >= from->width || v >= from->height)
            continue;
        f.at[f.n] = (size_t)v * (size_t)from->width + (size_t)u;
        f.counts[f.n] = !inside || inside[f.at[f.n]];
        f.inside += f.counts[f.n++];
    }
    return f;
}

// Outside codes are those of nothing: in linear light they count, in the display domain not.
static uint16_t mean_of(const struct four *f, const uint16_t *plane, bool all)
{
    unsigned sum = 0, n = 0;
    for (int i = 0; i < f->n; i++)
        if (all || f->counts[i]) {
            sum += plane[f->at[i]];
            n++;
        }
    return (uint16_t)((sum + n / 2) / n);
}

static void halve(uint16_t *out, const struct relume_codes *from, const struct relume_rect *rect,
                  size_t stored)
{
    const size_t pixels = (size_t)rect->width * (size_t)rect->height;
    const bool masked = (size_t)from->planes > stored,
               linear = from->domain == RELUME_DOMAIN_LINEAR;
    const uint16_t *inside = masked ? from->plane[stored] : NULL;
    const int top = relume_storage_top(from->storage);
    for (size_t i = 0; i < pixels; i++) {
        const struct four f =
            four_at(from, (int)(i % (size_t)rect->width), (int)(i / (size_t)rect->width), inside);
        for (size_t p = 0; p < stored; p++)
            out[p * pixels + i] = mean_of(&f, from->plane[p], linear || !f.inside);
        if (masked)
            out[stored * pixels + i] = (uint16_t)(linear     ? (f.inside * top + f.n / 2) / f.n
                                                  : f.inside ? top
                                                             : 0);
    }
}

relume_status reader_load_halved(relume_pack *p, int view, const struct relume_rect *rect,
                                 const struct relume_codes *like, uint16_t *data)
{
    struct relume_rect twice = {2 * rect->left, 2 * rect->top, 2 * rect->width, 2 * rect->height};
    if (twice.width > p->width - twice.left)
        twice.width = p->width - twice.left;
    if (twice.height > p->height - twice.top)
        twice.height = p->height - twice.top;
    struct relume_codes_part from = {.memory = NULL};
    const relume_status status = reader_load_planes(&from, p, view, 0, &twice, like);
    if (!status)
        halve(data, &from.codes, rect, (size_t)p->info.planes);
    relume_codes_part_destroy(&from);
    return status;
}

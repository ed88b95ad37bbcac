// view_parts.c - parts of a slab's views, where all that an eye needs is too much for the graphics
// memory
#include "draw/view_parts.h"
#include "relight/view/view.h"

#include <math.h>
#include <stdlib.h>

relume_status view_parts_create(struct view_parts *p, int views)
{
    *p = (struct view_parts){.rect = calloc((size_t)views, sizeof *p->rect)};
    return p->rect ? RELUME_OK : RELUME_ENOMEM;
}

void view_parts_destroy(struct view_parts *p)
{
    free(p->rect);
    *p = (struct view_parts){.rect = NULL};
}

void view_parts_use(struct view_parts *p, const struct relume_pack_info *info)
{
    const struct relume_codes codes = {.width = info->width,
                                       .height = info->height,
                                       .planes = info->planes,
                                       .storage = info->books ? RELUME_STORE_16 : info->storage};
    p->size[0] = info->width;
    p->size[1] = info->height;
    p->view_bytes = gl_relighter_view_bytes(&codes);
    p->display = info->domain == RELUME_DOMAIN_DISPLAY;
}

bool view_parts_suit(const struct view_parts *p, const struct file_views *v,
                     const struct gl_relighter *relighter, const struct frame_request *q)
{
    for (int i = 0; i < q->lights; i++)
        if (relume_light_is_near(q->light[i].kind) ||
            (p->display && q->light[i].kind == RELUME_LIGHT_ENVIRONMENT))
            return false;
    return relighter->parts.part && p->size[0] && v->grid &&
           q->camera.framing == RELUME_FRAME_EYE && q->pass == RELUME_PASS_COLOUR &&
           !file_views_take_lens(q) &&
           (size_t)file_views_needed(v) * p->view_bytes > relighter->memory.most;
}

relume_status view_parts_relight(struct view_parts *p, struct file_views *v,
                                 struct gl_relighter *relighter, const struct frame_request *q)
{
    const int frame[2] = {file_views_picture_width(q),
                          (int)lround(q->picture.bottom - q->picture.top)};
    struct relume_view_params params = q->view;
    relume_status status = RELUME_OK;
    params.size[0] = p->size[0];
    params.size[1] = p->size[1];
    if (file_views_take_depth(v, q)) {
        status = depths_find_ranges(&v->depths, v->needed);
        params.range = (const double(*)[2])v->depths.range;
    }
    if (!status && relume_slab_parts(p->rect, v->grid, q->camera.eye, frame, &params) < 0)
        status = RELUME_ENOMEM;
    for (int i = 0; !status && i < v->count; i++) {
        v->relit[i] = NULL;
        if (p->rect[i].width)
            status = gl_relighter_part(&v->relit[i], &p->rect[i], relighter, i, p->size);
    }
    return status;
}

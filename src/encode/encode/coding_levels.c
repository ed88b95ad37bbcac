// coding_levels.c - the reduced levels of views with lossy planes
#include "encode/encode/coding.h"

#include "core/base/memory.h"
#include "format/pack/pack_write.h"

#include <stdio.h>

relume_status coding_load_levels(struct coding *c, int view)
{
    if (c->f->view[view].levels)
        return RELUME_OK;
    relume_status status = coded_rows_load_view(&c->rows, view);
    if (!status)
        status = coding_load_extras(c, view);
    return status ? status : contents_reduce(c->f, view);
}

// All but the first, which is most of them and which a reader makes of the view.
static relume_status code_levels(struct coding *c, int view)
{
    struct relume_pack_levels *l = &c->f->levels[view];
    relume_status status = coding_load_levels(c, view);
    for (int k = 1; !status && k < l->levels; k++) {
        struct lossy_words words = {l->coded[k], l->coded_words[k]};
        if (c->levels_by[view] != c->effort.quantiser) {
            mem_free(l->coded[k]);
            status =
                lossy_encode(&words, &l->level[k], 1, &c->effort, c->f->p->threads, c->f->p->log);
            l->coded[k] = words.word;
            l->coded_words[k] = words.count;
        }
        c->level_bytes += 4.0 * (double)words.count;
    }
    c->levels_by[view] = c->effort.quantiser;
    return status;
}

static relume_status count_levels(struct coding *c, int member, double *bytes)
{
    c->level_bytes = 0.0;
    const relume_status status = coding_each_view(c, coding_share(c, member), code_levels);
    *bytes = c->level_bytes;
    return status;
}

relume_status coding_find_levels(struct coding *c, double left)
{
    enum { COARSER = 4 * AV1_STEPS };
    char what[32];
    double all;
    snprintf(what, sizeof what, "levels.%d", c->effort.quantiser);
    const relume_status status = coding_sum(&all, c, what, count_levels);
    if (status || all <= left || c->effort.quantiser + COARSER > AV1_COARSEST)
        return status ? status : coding_each_view(c, c->own, code_levels);
    c->effort.quantiser += COARSER;
    return coding_find_levels(c, left);
}

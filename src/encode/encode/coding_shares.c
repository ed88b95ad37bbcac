// coding_shares.c - which member makes a view's depth, masks and levels; sums of bytes of members
#include "encode/encode/coding.h"

#include "format/team/array.h"

#include <math.h>

struct group_share coding_share(const struct coding *c, int member)
{
    return groups_share(&c->groups, member, team_members(c->team));
}

bool coding_has_first(const struct coding *c, int group, struct group_share share)
{
    const int tile = c->groups.tile[group];
    return share.first <= tile && tile < share.end;
}

relume_status coding_each_view(struct coding *c, struct group_share share,
                               relume_status (*body)(struct coding *c, int view))
{
    const int *begin = c->groups.begin;
    relume_status status = RELUME_OK;
    for (int g = 0; !status && g < c->groups.count; g++)
        for (int i = begin[g]; !status && i < begin[g + 1]; i++)
            if (coding_has_first(c, g, share))
                status = body(c, c->groups.view[i]);
    return status;
}

// Bytes that each member counts of its share, and the sum of all.
struct byte_count {
    struct coding *c;
    relume_status (*count)(struct coding *c, int member, double *bytes);
    int member;
    double bytes, sum;
};

static relume_status begin_count(void *context, int member)
{
    struct byte_count *n = context;
    n->member = member;
    n->bytes = 0.0;
    return RELUME_OK;
}

static relume_status count_share(void *context)
{
    struct byte_count *n = context;
    return n->count(n->c, n->member, &n->bytes);
}

static relume_status add_count(void *context)
{
    struct byte_count *n = context;
    n->sum += n->bytes;
    return fabs(n->bytes) < 0x1p53 ? RELUME_OK : RELUME_EDAMAGED;
}

relume_status coding_sum(double *sum, struct coding *c, const char *what,
                         relume_status (*count)(struct coding *c, int member, double *bytes))
{
    struct byte_count n = {.c = c, .count = count};
    struct team_array array = {&n.bytes, sizeof n.bytes};
    static const struct team_work work = {begin_count, count_share, add_count};
    const relume_status status =
        team_share(c->team, what, &work, &n, &team_array_bytes, &array, c->f->p->log);
    *sum = n.sum;
    return status;
}

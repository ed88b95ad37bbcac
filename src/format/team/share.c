// share.c - one step of the work of a team
#include "format/team/share.h"

#include "core/base/log.h"
#include "core/base/memory.h"

struct step {
    const struct team_work *work;
    void *context;
    const struct team_bytes *bytes;
    void *results;
};

static relume_status compute_share(const struct step *s, int member)
{
    const relume_status status = s->work->begin(s->context, member);
    return status ? status : s->work->compute(s->context);
}

static relume_status make_piece(void *context, int member, struct relume_buffer *out)
{
    const struct step *s = context;
    struct piece_writer writer = {.out = out};
    const relume_status status = compute_share(s, member);
    if (!status)
        s->bytes->hand_in(s->results, &writer);
    return !status && writer.failed ? RELUME_ENOMEM : status;
}

static relume_status take_piece(const struct step *s, int member, const struct relume_buffer *piece)
{
    struct piece_reader reader = {.bytes = piece->data, .size = piece->size};
    relume_status status = s->work->begin(s->context, member);
    if (!status)
        status = s->bytes->fetch(s->results, &reader);
    if (!status && (reader.damaged || piece_left(&reader)))
        status = RELUME_EDAMAGED;
    return status ? status : s->work->add(s->context);
}

static relume_status share_pieces(const struct relume_team *team, const char *what, struct step *s,
                                  const struct relume_log *log)
{
    struct relume_buffer *piece = mem_zeroed((size_t)team->members, sizeof *piece);
    relume_status status =
        piece ? team->share(team->user, what, make_piece, s, piece) : RELUME_ENOMEM;
    for (int i = 0; !status && i < team->members; i++) {
        status = take_piece(s, i, &piece[i]);
        if (status == RELUME_EDAMAGED)
            log_fail(log, status,
                     "what part %d has shared (%s) does not fit this work; remove the --learnt "
                     "folder, and run all parts again by the same relume",
                     i + 1, what);
    }
    for (int i = 0; piece && i < team->members; i++)
        relume_buffer_destroy(&piece[i]);
    mem_free(piece);
    return status;
}

relume_status team_share(const struct relume_team *team, const char *what,
                         const struct team_work *work, void *context,
                         const struct team_bytes *bytes, void *results,
                         const struct relume_log *log)
{
    struct step s = {work, context, bytes, results};
    if (team)
        return share_pieces(team, what, &s, log);
    const relume_status status = compute_share(&s, 0);
    return status ? status : work->add(context);
}

// gather.c - pieces come from other machines, and may be anything
#include "format/team/gather.h"

#include "core/base/log.h"
#include "core/base/memory.h"

relume_status team_gather(const struct relume_team *team, const char *what, relume_team_make *make,
                          team_take *take, void *context, const struct relume_log *log)
{
    const int members = team ? team->members : 1;
    struct relume_buffer *piece = mem_zeroed((size_t)members, sizeof *piece);
    relume_status status = !piece ? RELUME_ENOMEM
                           : team ? team->share(team->user, what, make, context, piece)
                                  : make(context, 0, piece);
    for (int i = 0; !status && i < members; i++) {
        status = take(context, i, &piece[i]);
        if (status == RELUME_EDAMAGED)
            log_fail(log, status,
                     "what part %d has shared (%s) does not fit this work; remove the --learnt "
                     "folder, and run all parts again by the same relume",
                     i + 1, what);
    }
    for (int i = 0; piece && i < members; i++)
        relume_buffer_destroy(&piece[i]);
    mem_free(piece);
    return status;
}

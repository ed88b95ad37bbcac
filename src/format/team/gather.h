// gather.h - pieces of all members of a team, taken one after another
#ifndef TEAM_GATHER_H
#define TEAM_GATHER_H

#include <relume/format/team.h>

// Takes the piece of `member`, of which nothing may be believed: RELUME_EDAMAGED where it is none.
typedef relume_status team_take(void *context, int member, const struct relume_buffer *piece);

// Shares `what` and takes every piece, in the order of the members. Without a team it makes and
// takes the piece of the only one. A status of sharing or taking, with a sentence.
relume_status team_gather(const struct relume_team *team, const char *what, relume_team_make *make,
                          team_take *take, void *context, const struct relume_log *log);

#endif

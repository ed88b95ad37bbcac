// share.h - one step of the work of a team: written for one machine, shared by many
//
// An algorithm hands over its step as a `team_work`, which makes results in its context and keeps
// them. One machine begins, computes and adds once. In a team the member that computes a share also
// writes its results into a piece, and everybody reads the pieces of all members in their order:
// begin, fetch and add. How results become bytes is a `team_bytes`, which stands in a file of its
// own and not in the algorithm's.
//
//     samples.c:  begin -> compute -> add                   one machine
//                 begin -> compute -> hand in               a share, on the machine that makes it
//                 begin -> fetch -> add, of each member     on every machine
#ifndef TEAM_SHARE_H
#define TEAM_SHARE_H

#include "format/team/piece.h"

#include <relume/format/team.h>

// A step of an algorithm, which holds the results of one share at a time.
struct team_work {
    // Starts the share of `member` without results.
    relume_status (*begin)(void *context, int member);
    relume_status (*compute)(void *context);
    // Joins the results to the ones of earlier members.
    relume_status (*add)(void *context);
};
// Results of the share that has begun, as bytes. `fetch` checks what it reads: RELUME_EDAMAGED, or
// it leaves the reader damaged.
struct team_bytes {
    void (*hand_in)(const void *results, struct piece_writer *to);
    relume_status (*fetch)(void *results, struct piece_reader *from);
};

// Does the step `what` (a name as relume_team has it) with all its shares. `team` NULL: one
// machine, which needs no bytes. A status of the work or of sharing, with a message;
// RELUME_ENOMEM.
relume_status team_share(const struct relume_team *team, const char *what,
                         const struct team_work *work, void *context,
                         const struct team_bytes *bytes, void *results,
                         const struct relume_log *log);

// Returns the number of shares.
static inline int team_members(const struct relume_team *team)
{
    return team ? team->members : 1;
}

#endif

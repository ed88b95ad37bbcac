// team.h - several processes that encode parts of one capture, and share what all of them need
//
// A part of the work (relume_encode_capture_params.part) needs a little of all the others: pixels
// to learn from, training of codebooks, ranges of planes. Each member of a team makes its own piece
// of that, and gets everybody's. What follows from the pieces does not depend on how many there
// are: N members write what one process writes, byte for byte.
//
// `relume encode --learnt FOLDER` is a team by files alone: members may run one after another, on
// any machines that see the folder, and be stopped at any time. relume-mpi is one in memory.
#ifndef RELUME_TEAM_H
#define RELUME_TEAM_H

#include <relume/context.h>

#ifdef __cplusplus
extern "C" {
#endif

// Makes the piece of `member`, which may be another than this process: a little of the work, done
// here because that one has not come yet. `out` is empty before; what it then holds is the
// caller's.
typedef relume_status relume_team_make(void *context, int member, struct relume_buffer *out);

// A member's view of its team. Plain data; what `user` points to must live as long as the calls
// that are given the team. Thread-safety: `share` is called from the thread that called the
// library.
struct relume_team {
    int member, members;  // this process, from 0; all of them
    // Members run at the same time, and sharing costs little beside a second of work: rounds of
    // training and ranges are shared too.
    bool close;
    // Everybody's piece of `what` ("samples": small letters, digits and dots) into
    // pieces[members], which are empty before. All members call with the same names in the same
    // order. A status of `make`, or of sharing: a sentence has been said then.
    relume_status (*share)(void *user, const char *what, relume_team_make *make, void *context,
                           struct relume_buffer *pieces);
    void *user;
};

#ifdef __cplusplus
}
#endif
#endif

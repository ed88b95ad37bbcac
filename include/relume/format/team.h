// team.h - several processes that encode parts of one capture, and share what all of them need
//
// A part of the work (relume_encode_capture_params.part) needs a little of all the others: pixels
// to learn from, training of codebooks, ranges of planes. Each member of a team makes its own piece
// of that, and gets everybody's. What follows from the pieces does not depend on how many there
// are: N members write what one process writes, byte for byte.
//
// relume_team_folder is a team by files alone: members may run one after another, on any machines
// that see the folder, and be stopped at any time. relume-mpi is one in memory.
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

// Pieces as files in a folder.
typedef struct relume_team_files relume_team_files;
// A team whose pieces are files in the folder `path`, "samples.3of8": read where they are there,
// else made, whoever's they are, and left for the others. The folder is made if need be.
// `about` says in one line what pieces belong together: a piece of others is RELUME_EUNFIT with a
// sentence. With `own_only` a member makes its own piece alone: `share` then returns
// RELUME_ECANCEL unless all pieces are there. Errors: RELUME_EINVAL (member out of range),
// RELUME_ENOMEM.
RELUME_RESULT relume_status relume_team_folder(relume_team_files **out, const char *path,
                                               int member, int members, const char *about,
                                               bool own_only, const struct relume_log *log);
// It belongs to the folder. Not close.
RELUME_API const struct relume_team *relume_team_of_folder(const relume_team_files *folder);
// Whether pieces of others were missing in the last `share` of a folder with `own_only`.
RELUME_API bool relume_team_folder_waits(const relume_team_files *folder);
RELUME_API void relume_team_folder_destroy(relume_team_files **folder);

#ifdef __cplusplus
}
#endif
#endif

// beside.h - a folder of ours next to an output, where it is made until it is whole
//
//   DIR/.relume-0123456789ab/lock   says what this is; locked as long as its process lives
//                            new    what is being made, a file or a folder
//                            old    a folder that it replaces, where names cannot be exchanged
//
// The name does not depend on the output's, which may have all the 255 bytes that a name may have.
// A process that is killed lets its lock go, so whoever next writes into DIR knows what nobody
// works on any more, and removes it.
#ifndef BASE_BESIDE_H
#define BASE_BESIDE_H

#include <relume/base.h>

typedef struct beside beside;

// In the folder `dir`, for an output called `name` there. NULL with errno set. `log`, which lives
// as long, gets a message about an old folder that could not be removed.
beside *beside_open(const char *dir, const char *name, const struct relume_log *log);
const char *beside_new(const beside *b);
const char *beside_old(const beside *b);
// Remove it with everything in it. NULL is fine.
void beside_close(beside **b);

// Remove what stopped processes of this user left in `dir`. An `old` folder whose name is free goes
// back to it.
void beside_sweep(const char *dir, const struct relume_log *log);
// Whether `path` lies in such a folder.
bool beside_holds(const char *path);

#endif

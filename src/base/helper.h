// helper.h - work on files that may be made to do harm: in processes of their own
//
// Readers of foreign formats run in relume-helper, a program beside the modules. One is started
// when the first such file is met and loads what it needs once (a third of a second); for every
// file it forks a process that has this file, little memory and time, and no way to write, to open
// anything else or to reach the network (src/helper). What crashes there is one sentence here.
#ifndef BASE_HELPER_H
#define BASE_HELPER_H

#include <relume/base.h>

#include <string.h>
#include <sys/types.h>

enum helper_kind { HELPER_PICTURE, HELPER_MESH };

enum { HELPER_WHY = 400 };

// One process. Thread-safety: one thread at a time; several jobs run side by side.
struct helper_job {
    int channel;
    pid_t process;
    char why[HELPER_WHY];  // what went wrong last, for a sentence; "" when nothing did
};

// A process that waits for messages of its kind. RELUME_ESYSTEM when it cannot be had: `why` tells.
relume_status helper_start(struct helper_job *job, enum helper_kind kind);
// Sends, with `file` unless it is -1. RELUME_EDATA: the process has ended, `why` says how.
relume_status helper_tell(struct helper_job *job, const void *message, size_t size, int file);
// Waits for its answer of that size; the same.
relume_status helper_hear(struct helper_job *job, void *answer, size_t size);
// Ends the process. A zeroed or ended job is fine.
void helper_end(struct helper_job *job);

// A bool of an answer: what came may be any byte, where C knows 0 and 1 alone.
static inline void helper_bool(bool *in_answer)
{
    uint8_t byte;
    memcpy(&byte, in_answer, 1);
    *in_answer = byte != 0;
}

// ---- between the library and the program

enum { HELPER_CHANNEL = 3 };  // the program's end of the channel

struct helper_order {
    char version[16];  // RELUME_VERSION
    int kind;          // enum helper_kind, with the process' end of its own channel; or
    pid_t ended;       // not 0: how this process ended is asked
};
struct helper_reply {
    pid_t process;  // 0: none, `why` tells
    int how;        // as waitpid has it
    char why[HELPER_WHY];
};

#endif

// helper.h - work that may crash: in processes of its own
//
// Readers of foreign formats run in relume-helper, a program beside the modules. One is started
// for the first such file and loads what it needs once (a third of a second); then it forks
// processes that have the files they are given, little memory and time, and no way to write, to
// open anything else or to reach the network (src/cli/helper). What crashes there is one sentence
// here.
//
// The coder of lossy planes runs there too. Its pictures are the program's own, so it
// keeps the rights of the program.
//
// A model has a process of its own. Forking one takes 5 ms and more, so pictures share: each goes
// to a process that has nothing open, then to a new one, and where there are as many as processors
// to the one that has the fewest. A process works on one picture at a time, so that a crash is that
// picture's; others that it had open are lost with it, and name it. Each group of sequences that is
// coded goes to an idle process or to a new one, and leaves it idle.
#ifndef BASE_HELPER_H
#define BASE_HELPER_H

#include <relume/base.h>

#include <string.h>
#include <sys/types.h>

enum helper_kind { HELPER_PICTURE, HELPER_MESH, HELPER_AV1 };

enum { HELPER_WHY = 400 };

struct helper_process;

// A file's place in a process. Thread-safety: one thread at a time; several jobs run side by side.
struct helper_job {
    struct helper_process *process;
    char *path;
    char why[HELPER_WHY];  // what went wrong last, for a sentence; "" when nothing did
    // What its answers may cost of a processor; ten times of it they may take by the clock. One
    // that is a disk's or a busy machine's fault takes a part of that, one that sleeps takes it
    // all.
    double processor_s, waited_s;
};

// A place for the file `path`; the caller sets its `processor_s`. RELUME_ESYSTEM with a sentence,
// RELUME_ENOMEM.
relume_status helper_start(struct helper_job *job, enum helper_kind kind, const char *path,
                           const struct relume_log *log);
// Sends a message, with `file` unless it is -1, and waits for the answer. RELUME_EDAMAGED: the
// process has ended, or has not answered in time and is ended; `why` says how.
relume_status helper_ask(struct helper_job *job, const void *message, size_t size, int file,
                         void *answer, size_t answer_size);
// The place is free; what was open there has been closed. A zeroed or ended job is fine.
void helper_end(struct helper_job *job);

// Whose doing it is that a process has too little memory: the file's, which makes it take more than
// any of its size should; the limit's (max_memory); or the machine's, which lets it have less.
enum helper_short { HELPER_SHORT_FILE, HELPER_SHORT_LIMIT, HELPER_SHORT_MACHINE };
// What to say of it; NULL for the machine's, and for a limit that nobody has set, which is a part
// of what the machine has: RELUME_ENOMEM.
static inline const char *helper_short_of(int whose, bool limit_is_set)
{
    if (whose == HELPER_SHORT_FILE)
        return "its reader needs more memory than a file of its size should; damaged, or made to "
               "fill memory";
    return whose == HELPER_SHORT_LIMIT && limit_is_set
               ? "its reader needs more memory than it may have (--max-memory)"
               : NULL;
}

// A bool of an answer: what came may be any byte, where C knows 0 and 1 alone.
static inline void helper_bool(bool *in_answer)
{
    uint8_t byte;
    memcpy(&byte, in_answer, 1);
    *in_answer = byte != 0;
}

// ---- between the library and the program

enum { HELPER_CHANNEL = 3 };  // the program's end of the channel
// A process, and the program, end when nobody asks for that long; half of it later nobody does.
enum { HELPER_IDLE_S = 60 };

struct helper_order {
    char version[16];  // RELUME_VERSION
    int kind;          // enum helper_kind, with the process' end of its own channel; or
    pid_t ended;       // not 0: how this process ended is asked
};
struct helper_reply {
    pid_t process;  // 0: none, `why` says why
    int how;        // as waitpid has it
    int error;      // what the machine lacks: ENOMEM, EMFILE, ...; 0: nothing
    char why[HELPER_WHY];
};

#endif

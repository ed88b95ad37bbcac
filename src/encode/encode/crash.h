// crash.h - a capture whose coder crashed: what is said, and how it is encoded once more
#ifndef ENCODE_CRASH_H
#define ENCODE_CRASH_H

#include "core/base/log.h"

#include <pthread.h>
#include <relume/encode.h>

enum { CRASH_TEXT = 1024 };

// A log that keeps the first error until the end of an attempt, since a crash of the coder
// is a warning when the file is written all the same. Repetitions of its text are dropped.
struct crash_watch {
    struct relume_log log;
    const struct relume_log *to;
    pthread_mutex_t lock;  // of what follows: several threads code
    char error[CRASH_TEXT];
};
const struct relume_log *crash_watch_begin(struct crash_watch *out, const struct relume_log *to);
// Passes the error on if `tell`.
void crash_watch_end(struct crash_watch *w, bool tell);

// Warns that the coder crashed, and says how the file differs.
void crash_say(const struct crash_watch *w, const struct relume_encode_capture_params *p,
               const relume_capture *capture);
// The same params without anything that libaom codes: lossless, with shadows and highlights that
// fade.
struct relume_encode_capture_params crash_params(const struct relume_encode_capture_params *p);

#endif

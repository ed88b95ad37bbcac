// context.h - what calls share, for those who build one for a call of their own
#ifndef BASE_CONTEXT_H
#define BASE_CONTEXT_H

#include <relume/context.h>

struct relume_context {
    const struct relume_limits *limits;  // or NULL
    int threads;
    struct relume_files files;
    struct inputs *inputs;  // or NULL (inputs.h)
};

// That of a log, or NULL; `log` may be NULL.
static inline relume_context *context_of(const struct relume_log *log)
{
    return log ? log->context : NULL;
}

// A copy of that of a log, for another in its place.
static inline struct relume_context context_like(const struct relume_log *log)
{
    const relume_context *c = context_of(log);
    return c ? *c : (struct relume_context){0};
}

#endif

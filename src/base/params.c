// params.c - parameters of callers that were compiled against an older or a newer library
#include "base/params.h"

#include "base/context.h"

#include <string.h>

// Every params struct begins with its size.
void *params_copy(void *own, size_t size, const void *params)
{
    size_t theirs;
    if (params) {
        memcpy(&theirs, params, sizeof theirs);
        memcpy(own, params, theirs && theirs < size ? theirs : size);
    }
    memcpy(own, &size, sizeof size);
    return own;
}

void *params_work(void *own, size_t size, const void *params, size_t log, size_t threads)
{
    const relume_context *context =
        context_of(*(const struct relume_log **)((char *)params_copy(own, size, params) + log));
    int *n = (int *)((char *)own + threads);
    *n = *n || !context ? *n : context->threads;
    return own;
}

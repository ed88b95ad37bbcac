// context_create.c - what calls share; parameters of callers that were compiled against an older or
// a newer library
#include "core/base/context.h"

#include "core/base/inputs.h"
#include "core/base/memory.h"
#include "core/base/params.h"

#include <string.h>

relume_status relume_context_create(relume_context **out,
                                    const struct relume_context_params *params)
{
    const struct relume_context_params p = PARAMS(relume_context_params, params);
    relume_context *c = *out = mem_zeroed(1, sizeof *c);
    if (!c)
        return RELUME_ENOMEM;
    *c = (struct relume_context){.limits = p.limits, .threads = p.threads, .files = p.files};
    if (p.keep_inputs && !(c->inputs = inputs_create()))
        relume_context_destroy(out);
    return *out ? RELUME_OK : RELUME_ENOMEM;
}

void relume_context_destroy(relume_context **context)
{
    if (*context)
        inputs_destroy((*context)->inputs);
    mem_free(*context);
    *context = NULL;
}

void relume_context_note(relume_context *context, const char *path)
{
    if (context && context->inputs)
        inputs_add(context->inputs, path);
}

// ---------------------------------------------------------------- parameters

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

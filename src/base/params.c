// params.c - parameters of callers that were compiled against an older or a newer library
#include "base/params.h"

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

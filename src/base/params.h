// params.h - parameters of callers that were compiled against an older or a newer library
#ifndef BASE_PARAMS_H
#define BASE_PARAMS_H

#include <stddef.h>

// A copy of *params, all default for NULL. What the caller's struct does not hold yet is default,
// and what this library does not know is left out; fields are only ever added at the end.
#define PARAMS(type, params)                                                                       \
    (*(const struct type *)params_copy(&(struct type){.struct_size = 0}, sizeof(struct type),      \
                                       params))
void *params_copy(void *own, size_t size, const void *params);

#endif

// params.h - parameters of callers that were compiled against an older or a newer library
#ifndef BASE_PARAMS_H
#define BASE_PARAMS_H

#include <stddef.h>

// A copy of *params, all default for NULL. What the caller's struct does not hold yet is default,
// and what this library does not know is left out; fields are only ever added at the end.
#define PARAMS(type, params)                                                                       \
    (*(const struct type *)params_copy(&(struct type){.struct_size = 0}, sizeof(struct type),      \
                                       params))
// The same of params with `log` and `threads`: where they name no number it is that of the log's
// context.
#define PARAMS_WORK(type, params)                                                                  \
    (*(const struct type *)params_work(&(struct type){.struct_size = 0}, sizeof(struct type),      \
                                       params, offsetof(struct type, log),                         \
                                       offsetof(struct type, threads)))
void *params_work(void *own, size_t size, const void *params, size_t log, size_t threads);
void *params_copy(void *own, size_t size, const void *params);

#endif

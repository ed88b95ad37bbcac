// functions.h - the numbers of a file as coefficients of its coder's raw functions
#ifndef PUBLISH_FUNCTIONS_H
#define PUBLISH_FUNCTIONS_H

#include <relume/format/coder.h>

// The coder whose weights these functions are: the basis's own, or the weights of the pictures
// between which it interpolates. Errors of relume_coder_create.
relume_status functions_coder(relume_coder **out, const struct relume_coder_info *info,
                              const struct relume_log *log);
// to[functions] += sum over the numbers of what they show in channel c times x[number]
void functions_add(double *to, const struct relume_coder_info *info, int c, const double *x);

#endif

// interpolation.c - the names of enum relume_interpolation
#include <relume/relight/view.h>

#include "core/base/names.h"

#include <string.h>

relume_status relume_interpolation_parse(enum relume_interpolation *out, const char *name)
{
    static const char *const names[] = {[RELUME_INTERPOLATE_CONSTANT] = "constant",
                                        [RELUME_INTERPOLATE_LINEAR] = "linear",
                                        [RELUME_INTERPOLATE_DEPTH] = "depth"};
    const int i = name_find(name, names, sizeof names / sizeof *names);
    *out = (enum relume_interpolation)(i < 0 ? 0 : i);
    return i < 0 ? RELUME_EINVAL : RELUME_OK;
}

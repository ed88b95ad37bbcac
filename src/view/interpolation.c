// interpolation.c - the names of enum relume_interpolation
#include <relume/view.h>

#include <string.h>

relume_status relume_interpolation_parse(enum relume_interpolation *out, const char *name)
{
    static const struct {
        const char *name;
        enum relume_interpolation value;
    } table[] = {{"constant", RELUME_INTERPOLATE_CONSTANT},
                 {"linear", RELUME_INTERPOLATE_LINEAR},
                 {"depth", RELUME_INTERPOLATE_DEPTH}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        if (!strcmp(name, table[i].name)) {
            *out = table[i].value;
            return RELUME_OK;
        }
    return RELUME_EINVAL;
}

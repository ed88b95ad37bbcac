// storage.c - the kinds of codes by name
#include <relume/coder.h>

#include <string.h>

static const struct {
    const char *name;
    int top;
} kinds[] = {
    [RELUME_STORE_8] = {"8", 255},     [RELUME_STORE_10] = {"10", 1023},
    [RELUME_STORE_12] = {"12", 4095},  [RELUME_STORE_16] = {"16", 65535},
    [RELUME_STORE_HALF] = {"half", 0}, [RELUME_STORE_FLOAT] = {"float", 0},
    [RELUME_STORE_LOG] = {"log", 0},
};

const char *relume_storage_name(enum relume_storage storage)
{
    return kinds[storage].name;
}

int relume_storage_top(enum relume_storage storage)
{
    return kinds[storage].top;
}

relume_status relume_storage_parse(enum relume_storage *out, const char *name)
{
    for (size_t i = 1; i < sizeof kinds / sizeof *kinds; i++)
        if (!strcmp(kinds[i].name, name)) {
            *out = (enum relume_storage)i;
            return RELUME_OK;
        }
    return RELUME_EINVAL;
}

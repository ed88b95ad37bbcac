// capture_lights.c - relume capture PHOTO ... -o DIR
#include "capture_lights.h"

relume_status capture_lights(const struct args *args)
{
    if (!args_has(args, "-o"))
        return usage_error("capture: expected -o DIR");
    return RELUME_OK;
}

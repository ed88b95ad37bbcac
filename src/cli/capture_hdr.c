// capture_hdr.c - relume capture --hdr
#include "capture_hdr.h"

relume_status capture_hdr(const struct args *args)
{
    (void)args;
    return usage_error("capture: --hdr is not there yet");
}

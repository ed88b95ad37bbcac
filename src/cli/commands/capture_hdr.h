// capture_hdr.h - relume capture --hdr: the brackets of one view become one radiance map
#ifndef CLI_CAPTURE_HDR_H
#define CLI_CAPTURE_HDR_H

#include "cli.h"

relume_status capture_hdr(const struct args *args);

#endif

// capture_lights.h - relume capture: photographs under one light each become a capture folder
#ifndef CLI_CAPTURE_LIGHTS_H
#define CLI_CAPTURE_LIGHTS_H

#include "cli.h"

relume_status capture_lights(const struct args *args);

#endif

// lights_environment.h - weights of captured lights that add up to an environment
#ifndef CLI_LIGHTS_ENVIRONMENT_H
#define CLI_LIGHTS_ENVIRONMENT_H

#include "cli/cli.h"

enum recipe { RECIPE_NONE, RECIPE_NUKE, RECIPE_NATRON, RECIPE_BLENDER };

struct environment_order {
    const char *file;         // whose lights: a relume file, a capture, an EXR of layers
    const char *environment;  // a picture of all directions, perhaps with degrees behind it
    const char *csv;          // to be written, or NULL
    enum recipe recipe;
    bool json;
};
// Print them, or write what was asked for. An input status, RELUME_EIO, RELUME_ENOMEM.
relume_status lights_environment(const struct args *args, const struct environment_order *order);

#endif

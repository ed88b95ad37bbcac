// light.h - what is wrong with a light
#ifndef RELIGHT_LIGHT_H
#define RELIGHT_LIGHT_H

#include <relume/light.h>

// A clause for people, or NULL when nothing is; `with_files`: pictures, maps and tables count.
const char *light_complaint(const struct relume_light *light, bool with_files);

#endif

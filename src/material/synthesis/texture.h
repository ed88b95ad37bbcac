// texture.h - what every piece of this folder asks of a sample
#ifndef SYNTHESIS_TEXTURE_H
#define SYNTHESIS_TEXTURE_H

#include <relume/material/synthesis.h>

// RELUME_EUNFIT with a sentence for what is no sample.
relume_status texture_check(const struct relume_texture *t, const struct relume_log *log);

#endif

#version 330 core
// A look into a cylinder with end discs.
#include "panorama.glsl"
#include "shared/panorama_discs.glsl"

#ifdef MIRROR
#include "mirror.glsl"
#endif
#ifdef BETWEEN
#include "between/gather.glsl"
#endif

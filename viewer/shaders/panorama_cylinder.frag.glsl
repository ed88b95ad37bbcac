#version 330 core
// A look into a cylinder.
#include "panorama.glsl"
#include "shared/panorama_layout.glsl"
#include "shared/panorama_cylinder.glsl"

#ifdef MIRROR
#include "mirror.glsl"
#endif
#ifdef BETWEEN
#include "between/gather.glsl"
#endif

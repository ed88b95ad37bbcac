#version 330 core
// A look into a sphere.
#include "panorama.glsl"
#include "shared/panorama_layout.glsl"
#include "shared/panorama_sphere.glsl"

#ifdef MIRROR
#include "mirror.glsl"
#endif
#ifdef BETWEEN
#include "between/gather.glsl"
#endif

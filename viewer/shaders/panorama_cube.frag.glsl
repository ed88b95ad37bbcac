#version 330 core
// A look into a cube.
#include "panorama.glsl"
#include "shared/cube.glsl"
#include "shared/panorama_layout.glsl"
#include "shared/panorama_cube.glsl"

#ifdef MIRROR
#include "mirror.glsl"
#endif
#ifdef BETWEEN
#include "between/gather.glsl"
#endif

// A slab through a frame, whose rows run down in the viewer.
#include "shared/footprint.glsl"
#include "shared/footprint_mean.glsl"
#include "shared/slab_window.glsl"

vec2 frame_position()
{
    return gl_FragCoord.xy;
}

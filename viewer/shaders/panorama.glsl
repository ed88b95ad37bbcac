// A look into a panorama, whose rows run down in the viewer. Mirrors and what is between objects
// and scene take samples alone.
#include "shared/footprint.glsl"
#include "shared/panorama.glsl"
#ifndef BETWEEN
out vec4 color;
#endif
#if !defined(MIRROR) && !defined(BETWEEN)
uniform float exposure;

void main()
{
    color = vec4(exposure * panorama_mean(gl_FragCoord.xy).rgb, 1.0);
}
#endif

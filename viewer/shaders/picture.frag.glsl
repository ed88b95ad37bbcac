#version 330 core
// A view as a picture: bilinear when enlarged, the mean of what a pixel covers when reduced.
#include "shared/footprint.glsl"
#include "shared/footprint_mean.glsl"
#include "texels.glsl"
uniform sampler2D view;
uniform vec4 picture;  // left, top, right, bottom of the whole view in the frame
uniform float exposure;
out vec4 color;

vec2 texels_per_pixel()
{
    return vec2(textureSize(view, 0)) / (picture.zw - picture.xy);
}

vec4 value_at(vec2 within)
{
    vec2 pixel = gl_FragCoord.xy + within - picture.xy;
    return vec4(texels_bilinear(view, pixel * texels_per_pixel()), 1.0);
}

void main()
{
    color = vec4(exposure * footprint_mean(texels_per_pixel()).rgb, 1.0);
}

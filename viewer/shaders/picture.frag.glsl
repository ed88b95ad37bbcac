#version 330 core
// A view as a picture: bilinear when enlarged, the mean of what a pixel covers when reduced.
#include "footprint.glsl"
#include "texels.glsl"
uniform sampler2D view;
uniform vec4 picture;  // left, top, right, bottom of the whole view in the frame
uniform float exposure;
out vec4 color;

void main()
{
    vec2 texels_per_pixel = vec2(textureSize(view, 0)) / (picture.zw - picture.xy);
    Footprint across = footprint_of(texels_per_pixel.x);
    Footprint down = footprint_of(texels_per_pixel.y);
    vec3 sum = vec3(0.0);
    for (int j = 0; j < down.count; j++)
        for (int i = 0; i < across.count; i++) {
            vec2 within = vec2(footprint_place(across, i), footprint_place(down, j));
            vec2 pixel = gl_FragCoord.xy + within - picture.xy;
            sum += texels_bilinear(view, pixel * texels_per_pixel);
        }
    color = vec4(exposure * sum / float(across.count * down.count), 1.0);
}

#version 330 core
// A view as a picture: bilinear when enlarged, the mean of what a pixel covers when reduced.
#include "texels.glsl"
uniform sampler2D view;
uniform vec4 picture;  // left, top, right, bottom of the whole view in the frame
uniform float exposure;
out vec4 color;

const int MOST = 16;  // samples along one side of a pixel

void main()
{
    vec2 texels_per_pixel = vec2(textureSize(view, 0)) / (picture.zw - picture.xy);
    ivec2 n = clamp(ivec2(ceil(texels_per_pixel - 0.01)), ivec2(1), ivec2(MOST));
    vec3 sum = vec3(0.0);
    for (int j = 0; j < n.y; j++)
        for (int i = 0; i < n.x; i++) {
            vec2 within = (vec2(i, j) + 0.5) / vec2(n) - 0.5;
            vec2 pixel = gl_FragCoord.xy + within - picture.xy;
            sum += texels_bilinear(view, pixel * texels_per_pixel);
        }
    color = vec4(exposure * sum / float(n.x * n.y), 1.0);
}

// What is shown of one light: its relit picture and what the model adds, black where it would be
// less.
#include "transfer.glsl"

uniform sampler2D coded;   // the relit picture ...
uniform Transfer picture;  // ... by this curve ...
uniform vec3 times;        // ... and this
uniform Transfer display;  // what the codes are interpolated in
uniform vec3 rgb;          // the light, linear
uniform ivec2 origin;      // of the picture in the view
out vec4 color;

vec3 encoded(vec3 v)
{
    return vec3(transfer_encode(display, v.r), transfer_encode(display, v.g),
                transfer_encode(display, v.b));
}

vec3 decoded(Transfer curve, vec3 v)
{
    return vec3(transfer_decode(curve, v.r), transfer_decode(curve, v.g),
                transfer_decode(curve, v.b));
}

void show(vec3 more)
{
    vec3 relit = times * decoded(picture, texelFetch(coded, ivec2(gl_FragCoord.xy), 0).rgb);
    color = vec4(max(relit + rgb * more, min(relit, 0.0)), 1.0);
}

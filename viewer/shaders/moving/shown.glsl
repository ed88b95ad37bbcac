// What is shown of one light: its relit picture and what the model adds, black where it would be
// less.
#include "transfer.glsl"
#include "shared/luminance.glsl"
#include "above_zero.glsl"

uniform sampler2D coded;   // the relit picture ...
uniform Transfer coding;   // ... by this curve ...
uniform vec3 times;        // ... and this
uniform Transfer display;  // what the codes are interpolated in
uniform vec3 rgb;          // the light, linear
uniform ivec2 origin;      // of the picture in the view
uniform bool exchanges;    // the light is a bright source of an environment ...
uniform sampler2D whole;   // ... whose picture this is (Twin: exchange_bright_source)
out vec4 color;

vec3 relit_here()
{
    vec3 relit = times * transfer_decode(coding, texelFetch(coded, ivec2(gl_FragCoord.xy), 0).rgb);
    return exchanges ? above_zero(relit) : relit;
}

void show_in_place_of(vec3 relit, vec3 shown)
{
    shown = max(shown, min(relit, 0.0));
    if (exchanges)
        shown = max(texelFetch(whole, ivec2(gl_FragCoord.xy), 0).rgb - relit + shown, 0.0);
    color = vec4(shown, 1.0);
}

void show(vec3 more)
{
    vec3 relit = relit_here();
    show_in_place_of(relit, relit + rgb * more);
}

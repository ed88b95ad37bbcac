#version 330 core
// The dot product of a pixel's codes with one weight vector (Wong 1998, Eq. 7.6). Scale and offset
// of the codes are folded into the weights and the constant.
uniform sampler2DArray codes;  // four planes in a texel
uniform sampler2D weights;     // [layer of the view][channel]: weights of the four planes for the
                               // sum's r, g, b and the colour's
uniform int first_layer;       // of this array among the view's layers
uniform int layers;
uniform vec3 constant;
uniform bool coloured;         // the sum is multiplied by a colour of the pixel
uniform vec3 colour_constant;
out vec4 color;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 sum = constant, colour = colour_constant;
    for (int i = 0; i < layers; i++) {
        vec4 code = texelFetch(codes, ivec3(at, i), 0);
        int row = first_layer + i;
        sum.r += dot(code, texelFetch(weights, ivec2(0, row), 0));
        sum.g += dot(code, texelFetch(weights, ivec2(1, row), 0));
        sum.b += dot(code, texelFetch(weights, ivec2(2, row), 0));
        if (!coloured)
            continue;
        colour.r += dot(code, texelFetch(weights, ivec2(3, row), 0));
        colour.g += dot(code, texelFetch(weights, ivec2(4, row), 0));
        colour.b += dot(code, texelFetch(weights, ivec2(5, row), 0));
    }
    color = vec4(sum * colour, 1.0);
}

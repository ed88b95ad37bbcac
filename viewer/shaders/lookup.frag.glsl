#version 330 core
// A pixel of a file with codebooks: what its vectors say under the present light, added up. Indices
// are never filtered.
uniform usampler2DArray indices;  // [book]
uniform sampler2DArray table;     // [book]: vector v stands at (v mod 1024, v / 1024)
uniform int books;
out vec4 color;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 sum = vec3(0.0);
    for (int b = 0; b < books; b++) {
        int v = int(texelFetch(indices, ivec3(at, b), 0).r);
        sum += texelFetch(table, ivec3(v & 1023, v >> 10, b), 0).rgb;
    }
    color = vec4(sum, 1.0);
}

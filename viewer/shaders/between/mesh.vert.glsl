#version 330 core
// The captured scene as a mesh, for maps of depths: two triangles for each block of pixels, none
// where neighbours are not one surface. Twin: scenery.c.
uniform sampler2D places;
uniform vec3 centre;  // the eye that captured it
uniform int block;    // pixels along each side of a vertex
uniform bool wraps;   // the last column borders on the first
uniform float farthest, least_cosine;
uniform mat4 clip;

const float STEP = 1.2;

vec3 place_of(ivec2 vertex, ivec2 count)
{
    vertex.x = vertex.x % count.x;
    return texelFetch(places, vertex * block + block / 2, 0).xyz;
}

bool are_neighbours(vec3 a, vec3 b)
{
    vec3 to_a = a - centre, to_b = b - centre;
    float la = length(to_a), lb = length(to_b);
    return la <= farthest && lb <= farthest && la > 0.0 && lb > 0.0 && la <= STEP * lb &&
           lb <= STEP * la && dot(to_a, to_b) >= least_cosine * la * lb;
}

void main()
{
    ivec2 count = textureSize(places, 0) / block;
    int columns = wraps ? count.x : count.x - 1;
    int cell = gl_VertexID / 6, corner = gl_VertexID % 6;
    ivec2 at = ivec2(cell % columns, cell / columns);
    ivec2 first = corner > 2 ? ivec2(1, 1) : ivec2(0, 0);
    vec3 p[3];
    p[0] = place_of(at + first, count);
    p[1] = place_of(at + ivec2(0, 1), count);
    p[2] = place_of(at + ivec2(1, 0), count);
    bool is = are_neighbours(p[0], p[1]) && are_neighbours(p[1], p[2]) && are_neighbours(p[2], p[0]);
    gl_Position = is ? clip * vec4(p[corner % 3], 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
    // what stands before the map's range hides all of it
    if (is && gl_Position.w > 0.0)
        gl_Position.z = max(gl_Position.z, -gl_Position.w);
}

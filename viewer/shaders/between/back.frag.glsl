#version 330 core
// How far off the eye the objects are behind their front: the second of two layers that are peeled
// off (Everitt 2001).
in vec3 at_position;
uniform sampler2D front;  // `grid` times finer
uniform int grid;
uniform vec4 eye;
out vec4 color;

float depth_of(vec3 point)
{
    return eye.w > 0.0 ? distance(point, eye.xyz) : -dot(point, eye.xyz);
}

void main()
{
    vec4 before = texelFetch(front, ivec2(gl_FragCoord.xy) * grid + grid / 2, 0);
    float depth = depth_of(at_position);
    if (before.w == 0.0 || depth <= depth_of(before.xyz) * 1.0001)
        discard;
    color = vec4(depth, 0.0, 0.0, 1.0);
}

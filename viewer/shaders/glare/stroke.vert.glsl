#version 330 core
// A stroke of the eye's aperture (relume_eye_stroke) as its four sides a x + b y <= c, in texels.
layout(location = 0) in vec4 ends;   // x of both, y of both, mm
layout(location = 1) in vec3 shape;  // widths at both, mm; opacity
uniform vec2 texture_size;           // texels, and of one millimetre
flat out vec4 side_a, side_b, side_c;
flat out float opacity;

void main()
{
    float middle = 0.5 * texture_size.x + 0.5;
    vec2 from = middle + texture_size.y * vec2(ends.x, -ends.z);
    vec2 to = middle + texture_size.y * vec2(ends.y, -ends.w);
    vec2 width = texture_size.y * shape.xy;
    float l = length(to - from);
    vec2 along = l > 0.0 ? (to - from) / l : vec2(1.0, 0.0);
    vec2 across = vec2(-along.y, along.x);
    vec2 p[4] = vec2[4](from + 0.5 * width.x * across, to + 0.5 * width.y * across,
                        to - 0.5 * width.y * across, from - 0.5 * width.x * across);
    for (int i = 0; i < 4; i++) {
        vec2 q = p[(i + 1) & 3];
        side_a[i] = p[i].y - q.y;
        side_b[i] = q.x - p[i].x;
        side_c[i] = side_a[i] * p[i].x + side_b[i] * p[i].y;
    }
    opacity = shape.z;
    vec2 corner = 2.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0;
    vec2 at = mix(from, to, 0.5 + 0.5 * corner.x) + 1.5 * corner.x * along +
              (0.5 * max(width.x, width.y) + 1.5) * corner.y * across;
    gl_Position = vec4(2.0 * at / texture_size.x - 1.0, 0.0, 1.0);
}

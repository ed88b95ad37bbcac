#version 330 core
// What a disc lets through of a texel: exact along x on each of so many lines.
flat in vec4 shape;
out vec4 color;

const int LINES = 8;

void main()
{
    vec2 corner = gl_FragCoord.xy - 0.5 - shape.xy;
    float covered = 0.0;
    for (int k = 0; k < LINES; k++) {
        float y = corner.y + (float(k) + 0.5) / float(LINES);
        float rest = shape.z * shape.z - y * y;
        float half_width = sqrt(max(rest, 0.0));
        covered += max(min(corner.x + 1.0, half_width) - max(corner.x, -half_width), 0.0);
    }
    color = vec4(1.0 - shape.w * covered / float(LINES));
}

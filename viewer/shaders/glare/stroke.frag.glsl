#version 330 core
// What a stroke lets through of a texel: exact along x on each of so many lines.
flat in vec4 side_a, side_b, side_c;
flat in float opacity;
out vec4 color;

const int LINES = 16;

void main()
{
    vec2 corner = gl_FragCoord.xy - 0.5;
    float covered = 0.0;
    for (int k = 0; k < LINES; k++) {
        float from = corner.x, to = corner.x + 1.0;
        vec4 rest = side_c - side_b * (corner.y + (float(k) + 0.5) / float(LINES));
        for (int i = 0; i < 4; i++) {
            if (side_a[i] > 0.0)
                to = min(to, rest[i] / side_a[i]);
            else if (side_a[i] < 0.0)
                from = max(from, rest[i] / side_a[i]);
            else if (rest[i] < 0.0)
                to = from;
        }
        covered += max(to - from, 0.0);
    }
    color = vec4(1.0 - opacity * covered / float(LINES));
}

#version 330 core
// The pupil within the lids, times what never moves.
uniform sampler2D fixed_parts;
uniform vec2 texture_size;  // texels, and of one millimetre
uniform float radius;       // of the pupil, mm
uniform vec4 lids;          // parabolas of the lower and the upper edge, mm
uniform bool has_lids;
out vec4 color;

const int LINES = 16;

float half_width(float y)
{
    float rest = radius * radius - y * y;
    if (rest <= 0.0 || (has_lids && (y >= lids.z || y <= lids.x)))
        return 0.0;
    float width = sqrt(rest);
    if (has_lids && lids.w < 0.0)
        width = min(width, sqrt(max((y - lids.z) / lids.w, 0.0)));
    if (has_lids && lids.y > 0.0)
        width = min(width, sqrt(max((y - lids.x) / lids.y, 0.0)));
    return width * texture_size.y;
}

void main()
{
    vec2 corner = gl_FragCoord.xy - 0.5 - (0.5 * texture_size.x + 0.5);
    float open = 0.0;
    for (int k = 0; k < LINES; k++) {
        float w = half_width(-(corner.y + (float(k) + 0.5) / float(LINES)) / texture_size.y);
        open += max(min(corner.x + 1.0, w) - max(corner.x, -w), 0.0);
    }
    color = vec4(open / float(LINES)) * texelFetch(fixed_parts, ivec2(gl_FragCoord.xy), 0).r;
}

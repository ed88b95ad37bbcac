// What is there of a surface, and what it sends of its own. Twin: skin.c, which blends layers; here
// as many pixels of a pattern are there as there is of a surface.
uniform sampler2D skin;  // what it sends; opacity. OpenGL filters it
uniform int cover;       // enum relume_object_cover
uniform float cutoff;

// Numbers from 0 to 1, each once in 4 x 4 pixels (Bayer 1973), others for other surfaces.
float threshold_of(ivec2 at, float surface)
{
    int x = at.x ^ at.y, y = at.y;
    int order = (x & 1) << 3 | (y & 1) << 2 | (x & 2) | (y & 2) >> 1;
    return fract((float(order) + 0.5) / 16.0 + 0.618034 * surface);
}

bool is_there(vec2 texture_at, float surface)
{
    if (cover == 0)
        return true;
    float opacity = textureLod(skin, texture_at, 0.0).a;
    return opacity >= (cover == 1 ? cutoff : threshold_of(ivec2(gl_FragCoord.xy), surface));
}

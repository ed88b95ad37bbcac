// What is there of a surface, and what it sends of its own. Twin: world/object/skin.c. That
// file blends layers. Here as many pixels of a pattern are there as there is of a surface.
uniform sampler2D skin;  // what it sends; opacity. OpenGL filters it
uniform int cover;       // enum relume_object_cover
uniform float cutoff;

// Numbers from 0 to 1, spread evenly over small blocks of pixels ("interleaved gradient noise":
// Jimenez 2014), others for other surfaces.
float threshold_of(ivec2 at, float surface)
{
    float pixel = fract(dot(vec2(at), vec2(0.06711056, 0.00583715)));
    return fract(52.9829189 * pixel + 0.618034 * surface);
}

bool is_there(vec2 texture_at, float surface)
{
    if (cover == 0)
        return true;
    float opacity = textureLod(skin, texture_at, 0.0).a;
    return opacity >= (cover == 1 ? cutoff : threshold_of(ivec2(gl_FragCoord.xy), surface));
}

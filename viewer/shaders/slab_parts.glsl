// The textures of a cell's views, after view00, which may hold parts of these: where each begins in
// its view, and how large views are; 0 and 0: they are whole.
uniform vec4 first_low;   // of view00 and view10
uniform vec4 first_high;  // of view01 and view11
uniform vec2 whole;

vec2 view_size()
{
    return whole.x > 0.0 ? whole : vec2(textureSize(view00, 0));
}

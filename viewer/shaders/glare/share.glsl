// How a texel's light goes to the pixels around its place: falling linearly over one pixel, or over
// one texel where that is wider. `scale`: a texel in pixels.
uniform float scale;
uniform int field, reach;  // texels of the pattern, odd; pixels on either side of the middle

float share_of(int pixel, int texel)
{
    float spread = max(scale, 1.0);
    float away = abs(float(pixel) - float(texel) * scale);
    return away < spread ? (1.0 - away / spread) / spread : 0.0;
}

ivec2 share_texels(int pixel)
{
    float spread = max(scale, 1.0);
    int half_field = field / 2;
    return ivec2(max(int(ceil((float(pixel) - spread) / scale)), -half_field),
                 min(int(floor((float(pixel) + spread) / scale)), half_field));
}

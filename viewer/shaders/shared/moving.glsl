// What a matte surface shows of a light whose shadows move, and how soft these are.

// The matte part of a pixel's model under a light. Twin: shadows_matte of
// src/relight/shadow/shadows.h.
float shadows_matte(vec4 model, vec3 light)
{
    return max(model.x + dot(model.yzw, light), 0.0);
}

// Edges are known to a pixel, and as soft as that. The share has a border of one pixel. Twin:
// soften of src/relight/shadow/shadows.c.
float soften(sampler2D share, ivec2 at)
{
    float sum = 5.0 * texelFetch(share, at + 1, 0).r;
    sum += texelFetch(share, at + ivec2(1, 0), 0).r + texelFetch(share, at + ivec2(0, 1), 0).r;
    sum += texelFetch(share, at + ivec2(2, 1), 0).r + texelFetch(share, at + ivec2(1, 2), 0).r;
    return sum / 9.0;
}

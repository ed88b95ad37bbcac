// Virtual lights as texels, four each. After virtual.
uniform samplerBuffer light;

Virtual virtual_at(int i)
{
    vec4 a = texelFetch(light, 4 * i), b = texelFetch(light, 4 * i + 1);
    vec4 c = texelFetch(light, 4 * i + 2), d = texelFetch(light, 4 * i + 3);
    return Virtual(a.xyz, a.w, b.xyz, b.w > 0.5, c.rgb, d.rgb, int(d.w));
}

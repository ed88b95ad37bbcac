// Of the nine pairs of views and lights around. Written out: a shader on the processor may stop
// after 65535 rounds of all its loops.
vec3 of_view(samplerBuffer values, int row, Blend l)
{
#ifdef SKY
    return texelFetch(values, row + l.index.x).rgb;  // one light at a time
#else
    return l.weight.x * texelFetch(values, row + l.index.x).rgb +
           l.weight.y * texelFetch(values, row + l.index.y).rgb +
           l.weight.z * texelFetch(values, row + l.index.z).rgb;
#endif
}

vec3 blended(samplerBuffer values, int first, Blend v, Blend l)
{
    ivec3 row = first + v.index * counts.y;
    return v.weight.x * of_view(values, row.x, l) + v.weight.y * of_view(values, row.y, l) +
           v.weight.z * of_view(values, row.z, l);
}

// Of the nine pairs of views and lights around.
vec3 blended(samplerBuffer values, int first, Blend v, Blend l)
{
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            float weight = v.weight[i] * l.weight[j];
            if (weight > 0.0)
                sum += weight * texelFetch(values, first + v.index[i] * counts.y + l.index[j]).rgb;
        }
    return sum;
}

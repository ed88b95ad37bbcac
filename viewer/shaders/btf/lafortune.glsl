// Lafortune lobes for each texel. Twin: model_laf.c.
uniform samplerBuffer array0;  // diffuse [texels]
uniform samplerBuffer array1;  // specular [texels][lobes]
uniform samplerBuffer array2;  // lobe [texels][lobes]

vec3 laf_eval(int texel, vec3 v, vec3 l)
{
    vec3 rgb = texelFetch(array0, texel).rgb;
    for (int j = 0; j < counts.w; j++) {
        vec4 lobe = texelFetch(array2, texel * counts.w + j);
        float s = dot(lobe.xyz, v * l);
        if (s > 1e-9)
            rgb += texelFetch(array1, texel * counts.w + j).rgb * exp(lobe.w * log(s));
    }
    return without_cosine ? rgb : rgb * l.z;
}

#ifdef SKY
// For one view a lobe is a cosine lobe of the light. Twin: lit of model_laf.c.
vec3 laf_lit(int texel, vec3 v, mat3 frame)
{
    vec3 rgb = texelFetch(array0, texel).rgb * sky_even(frame, true);
    for (int j = 0; j < counts.w; j++) {
        vec4 lobe = texelFetch(array2, texel * counts.w + j);
        rgb += texelFetch(array1, texel * counts.w + j).rgb *
               sky_lobe(frame, lobe.xyz * v, lobe.w, true);
    }
    return rgb;
}
#endif

// Reflectance fields of lobes for each view. Twin: fields_eval.
uniform samplerBuffer array0;  // diffuse [entries]
uniform samplerBuffer array1;  // specular [entries][views]
uniform samplerBuffer array2;  // lobe [entries][views][lobes]

vec3 fields_eval(int entry, int view, vec3 l)
{
    int slice = entry * counts.x + view;
    float sum = 0.0;
    for (int j = 0; j < counts.w; j++) {
        vec4 lobe = texelFetch(array2, slice * counts.w + j);
        float s = dot(lobe.xyz, l);
        sum += s > 1e-9 ? exp(lobe.w * log(s)) : 0.0;
    }
    return texelFetch(array0, entry).rgb + texelFetch(array1, slice).rgb * sum;
}

#ifdef SKY
// Twin: fields_lit of material/model/fields.c.
vec3 fields_lit(int entry, int view, mat3 frame)
{
    int slice = entry * counts.x + view;
    vec3 sum = vec3(0.0);
    for (int j = 0; j < counts.w; j++) {
        vec4 lobe = texelFetch(array2, slice * counts.w + j);
        sum += sky_lobe(frame, lobe.xyz, lobe.w, without_cosine);
    }
    return texelFetch(array0, entry).rgb * sky_even(frame, without_cosine) +
           texelFetch(array1, slice).rgb * sum;
}
#endif

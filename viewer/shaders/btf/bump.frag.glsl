#version 330 core
// A colour and a normal for each texel, one mean BRDF. Twin: model_bump.c.
const bool view_grid = false, light_grid = false;
#include "btf/btf.glsl"
#include "btf/upright.glsl"

uniform samplerBuffer array0, array1;  // color, normal [texels]
uniform samplerBuffer array2;          // mean [views][lights]

vec3 model_eval(int texel, int view, int light, vec3 v, vec3 l)
{
    vec3 n = normalize(texelFetch(array1, texel).xyz);
    Blend bv = mesh_at(view_cells, view_triangles, upright(v, n));
    vec3 turned = upright(l, n);
    Blend bl = mesh_at(light_cells, light_triangles, turned);
    float scale = without_cosine ? max(turned.z, 0.0) / max(l.z, 1e-6) : bl.rim / bl.size;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            sum += bv.weight[i] * bl.weight[j] *
                   texelFetch(array2, bv.index[i] * counts.y + bl.index[j]).rgb;
    return texelFetch(array0, texel).rgb * scale * sum;
}

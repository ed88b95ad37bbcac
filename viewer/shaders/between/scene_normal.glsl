// Which way a scene faces, by the places that its pixels show. Twin: world/object/scene.c.
uniform sampler2D scene;  // positions; alpha 0: nothing is there

vec3 place_at(ivec2 pixel)
{
    return texelFetch(scene, clamp(pixel, ivec2(0), textureSize(scene, 0) - 1), 0).xyz;
}

// Twin: step_across.
vec3 step_across(ivec2 pixel, ivec2 way)
{
    vec3 at = place_at(pixel), back = at - place_at(pixel - way), on = place_at(pixel + way) - at;
    float b = length(back), o = length(on);
    return o > 0.0 && !(b > 0.0 && b < o) ? on : back;
}

// Twin: scene_normal.
vec3 scene_normal(ivec2 pixel)
{
    vec3 normal = cross(step_across(pixel, ivec2(0, 1)), step_across(pixel, ivec2(1, 0)));
    float size = length(normal);
    return size > 0.0 ? normal / size : vec3(0.0);
}

#version 430
// Pixels between those that have gathered light take it from these, where they show one surface and
// are alike; others are listed. Twins: world/transport/between.c, exchange_fill_scene,
// exchange_fill_objects.
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 3) buffer List { uvec4 listed; uint at[]; };
layout(rgba32f, binding = 0) uniform image2D without;
layout(rgba32f, binding = 1) uniform image2D with_objects;
uniform sampler2D place, facing;
uniform vec2 kind;     // of sites, as micro.comp
uniform int spacing;
uniform vec3 eye;
uniform bool by_part;  // what differs is what comes with objects over what does without

const uint ROW = 256u;

float sum_of(vec3 rgb)
{
    return rgb.r + rgb.g + rgb.b;
}

// Twin: transport_same.
bool same(vec3 step, vec3 normal, vec3 other_normal, float distance)
{
    return dot(normal, other_normal) > 0.9 && abs(dot(step, normal)) < 0.02 * distance;
}

void main()
{
    const float TOO_FEW = 0.05, SAME = 0.1;
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = textureSize(place, 0);
    if (any(greaterThanEqual(pixel, size)) || all(equal(pixel % spacing, ivec2(spacing / 2))))
        return;
    vec4 own = texelFetch(place, pixel, 0);
    if (own.w < kind.x || own.w > kind.y)
        return;
    vec3 normal = texelFetch(facing, pixel, 0).xyz;
    ivec2 corner = (pixel + spacing - spacing / 2) / spacing * spacing + spacing / 2 - spacing;
    float sum = 0.0, least = 1e30, most = 0.0, away = distance(own.xyz, eye);
    vec3 bare = vec3(0.0), full = vec3(0.0);
    for (int i = 0; i < 4; i++) {
        ivec2 beside = corner + spacing * ivec2(i & 1, i >> 1);
        vec2 near = 1.0 - abs(vec2(beside - pixel)) / float(spacing);
        float weight = near.x * near.y;
        if (any(lessThan(beside, ivec2(0))) || any(greaterThanEqual(beside, size)) || weight <= 0.0)
            continue;
        vec4 other = texelFetch(place, beside, 0);
        if (other.w < kind.x || other.w > kind.y ||
            !same(other.xyz - own.xyz, normal, texelFetch(facing, beside, 0).xyz, away))
            continue;
        vec3 a = imageLoad(without, beside).rgb, b = imageLoad(with_objects, beside).rgb;
        float under = by_part ? sum_of(a) : 1.0, part = under > 0.0 ? sum_of(b) / under : 1.0;
        least = min(least, part);
        most = max(most, part);
        bare += weight * a;
        full += weight * b;
        sum += weight;
    }
    if (sum < TOO_FEW || most - least > SAME * most) {
        uint number = atomicAdd(listed.w, 1u);
        atomicMax(listed.y, number / ROW + 1u);
        at[number] = uint(pixel.x + size.x * pixel.y);
        return;
    }
    imageStore(without, pixel, vec4(bare / sum, 1.0));
    imageStore(with_objects, pixel, vec4(full / sum, 1.0));
}

// Prefiltered maps of an environment: one below the other the diffuse one and those of exponents
// 2^(i / 2). Twins: prefiltered_maps.c, sky.c.
uniform sampler2D sky;
uniform float sky_turn;  // of the environment, radians
uniform vec3 sky_rgb;
uniform samplerBuffer sky_table;  // models of lobes: parts of lobes [2][exponents][steps];
                                  // others: for each light the axis and exponent of its cone,
                                  // then its direction and the weight
const int SKY_EXPONENTS = 15, SKY_STEPS = 33;
const float SKY_PI = 3.14159265358979;

// The place in a map, pixels; columns repeat.
vec2 sky_place(vec3 d)
{
    ivec2 size = textureSize(sky, 0);
    float turn = atan(d.x, -d.z) + sky_turn;
    return vec2((0.5 + turn / (2.0 * SKY_PI)) * float(size.x),
                acos(clamp(d.y, -1.0, 1.0)) / SKY_PI * float(size.y / (SKY_EXPONENTS + 1)));
}

vec3 sky_texel(int layer, ivec2 at)
{
    ivec2 size = textureSize(sky, 0);
    int rows = size.y / (SKY_EXPONENTS + 1);
    int column = at.x - size.x * int(floor(float(at.x) / float(size.x)));
    return texelFetch(sky, ivec2(column, layer * rows + clamp(at.y, 0, rows - 1)), 0).rgb;
}

vec3 sky_map(int layer, vec2 place)
{
    vec2 corner = floor(place - 0.5), part_of = place - 0.5 - corner;
    ivec2 at = ivec2(corner);
    return mix(mix(sky_texel(layer, at), sky_texel(layer, at + ivec2(1, 0)), part_of.x),
               mix(sky_texel(layer, at + ivec2(0, 1)), sky_texel(layer, at + ivec2(1, 1)),
                   part_of.x),
               part_of.y);
}

vec3 sky_diffuse(vec3 normal)
{
    return sky_rgb * sky_map(0, sky_place(normal));
}

// Between which exponents.
float sky_layer(float exponent)
{
    return clamp(2.0 * log2(exponent), 0.0, float(SKY_EXPONENTS - 1));
}

vec3 sky_specular(vec3 axis, float exponent)
{
    vec2 place = sky_place(axis);
    float at = sky_layer(exponent);
    int low = min(int(at), SKY_EXPONENTS - 2);
    return sky_rgb * mix(sky_map(low + 1, place), sky_map(low + 2, place), at - float(low));
}

float sky_part(float cosine, float exponent, bool with_cosine)
{
    float at = sky_layer(exponent);
    int low = min(int(at), SKY_EXPONENTS - 2);
    float along = clamp(0.5 * (cosine + 1.0), 0.0, 1.0) * float(SKY_STEPS - 1);
    int step_at = min(int(along), SKY_STEPS - 2);
    int row = ((with_cosine ? SKY_EXPONENTS : 0) + low) * SKY_STEPS + step_at;
    float a = mix(texelFetch(sky_table, row).r, texelFetch(sky_table, row + 1).r,
                  along - float(step_at));
    float b = mix(texelFetch(sky_table, row + SKY_STEPS).r,
                  texelFetch(sky_table, row + SKY_STEPS + 1).r, along - float(step_at));
    return mix(a, b, at - float(low));
}

// What a lobe t of a model in the frame of the surface shows. Twin: ambient_lobe.
vec3 sky_lobe(mat3 frame, vec3 t, float exponent, bool with_cosine)
{
    float size = length(t);
    if (size <= 1e-9)
        return vec3(0.0);
    vec3 axis = frame * (t / size);
    return exp(exponent * log(size)) * 2.0 / (exponent + 1.0) *
           sky_part(dot(frame[2], axis), exponent, with_cosine) * sky_specular(axis, exponent);
}

// What a constant shows, without and with n.l. Twin: sky_ambient.
vec3 sky_even(mat3 frame, bool with_cosine)
{
    return with_cosine ? sky_specular(frame[2], 1.0) : sky_diffuse(frame[2]);
}

// The part of the sky that light number `i` represents. Twin: relume_btf_environment_weight.
vec3 sky_weight(mat3 frame, int i, out vec3 direction)
{
    vec4 cone = texelFetch(sky_table, 2 * i), light_of = texelFetch(sky_table, 2 * i + 1);
    direction = light_of.xyz;
    return light_of.w * sky_specular(frame * cone.xyz, cone.w);
}

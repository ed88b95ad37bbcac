#version 430
// Imperfect shadow maps (Ritschel et al. 2008): a work group draws one from a run of spots and
// fills its holes. Twin: world/transport/maps.c. With SIZE, its texels along a side.
layout(local_size_x = 128) in;
#include "transport/virtual.glsl"
#include "transport/virtual_fetch.glsl"
layout(r32f, binding = 0) writeonly uniform image2D atlas;
uniform samplerBuffer spot;  // two texels each: place, and whether it is lit on both sides; normal
uniform ivec2 spots;         // how many, and in each map
uniform float area;          // of surface, that one in a map stands for
uniform int first;           // light
uniform bool at_objects;

const uint EMPTY = 0xffffffffu;
const float NEVER = 1e30;
const int HALF = SIZE / 2, QUARTER = SIZE / 4, TEXELS = SIZE * SIZE, ALONG = 128;
shared uint texel[TEXELS];  // depths as ordered() has them
shared float half_depth[HALF * HALF], half_spread[HALF * HALF];  // spread below 0: fewer than three are
shared float quarter_depth[QUARTER * QUARTER], quarter_spread[QUARTER * QUARTER];
shared uint least, most;

// Numbers in the order of floats.
uint ordered(float x)
{
    uint bits = floatBitsToUint(x);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

float depth_of(uint bits)
{
    if (bits == EMPTY)
        return NEVER;
    return uintBitsToFloat((bits & 0x80000000u) != 0u ? bits & 0x7fffffffu : ~bits);
}

// Twin: find_texels of world/transport/maps.c.
ivec2 texels_of(float middle, float side)
{
    float part = 0.5 * min(side, float(SIZE) / 4.0);
    int at = int(middle);
    ivec2 range = ivec2(ceil(middle - part - 0.5), ceil(middle + part - 0.5));
    if (range.x >= range.y)
        range = ivec2(at, at + 1);
    return clamp(range, ivec2(0), ivec2(SIZE));
}

// Twin: splat.
void splat(int number, Look l, float chance)
{
    const float LEAST = 0.2, IN_TEXEL = 1.4, SHEET = 1.6;
    vec4 place = texelFetch(spot, 2 * number), at;
    if (!find(at, l, place.xyz))
        return;
    float facing = max(abs(dot(texelFetch(spot, 2 * number + 1).xyz, way_to(l, place.xyz))), LEAST);
    float side = (place.w > 0.0 ? SHEET : 1.0) * 0.5 * float(SIZE) * at.w * sqrt(area * facing);
    if (chance > IN_TEXEL * side * side)
        return;
    ivec2 x = texels_of(0.5 * float(SIZE) * (at.x + 1.0), side), y = texels_of(0.5 * float(SIZE) * (at.y + 1.0), side);
    for (int j = y.x; j < y.y; j++)
        for (int i = x.x; i < x.y; i++)
            atomicMin(texel[j * SIZE + i], ordered(at.z));
}

// The nearest of four that belong together: their mean; their range, below 0 where there are only
// two. Twin: together.
vec2 together(vec4 depth, float apart)
{
    vec2 best = vec2(NEVER, -1.0);
    for (int i = 0; i < 4; i++) {
        float sum = 0.0, range = 0.0;
        int n = 0;
        for (int k = 0; k < 4 && depth[i] < NEVER; k++)
            if (depth[k] >= depth[i] && depth[k] - depth[i] <= apart) {
                sum += depth[k];
                range = max(range, depth[k] - depth[i]);
                n++;
            }
        if (n > 1 && sum / float(n) < best.x)
            best = vec2(sum / float(n), n > 2 ? range : -1.0);
    }
    return best;
}

void pull_half(int i, float apart)
{
    int at = (i / HALF) * 2 * SIZE + (i % HALF) * 2;
    vec2 found = together(vec4(depth_of(texel[at]), depth_of(texel[at + 1]), depth_of(texel[at + SIZE]),
                               depth_of(texel[at + SIZE + 1])), apart);
    half_depth[i] = found.x;
    half_spread[i] = found.y;
}

void pull_quarter(int i, float apart)
{
    int at = (i / QUARTER) * 2 * HALF + (i % QUARTER) * 2;
    vec2 found = together(vec4(half_depth[at], half_depth[at + 1], half_depth[at + HALF],
                               half_depth[at + HALF + 1]), apart);
    quarter_depth[i] = found.x;
    quarter_spread[i] = found.y;
}

// Twin: maps_fill.
void fill(int me)
{
    const float PART = 0.05;
    for (int i = me; i < TEXELS; i += ALONG)
        if (texel[i] != EMPTY) {
            atomicMin(least, texel[i]);
            atomicMax(most, texel[i]);
        }
    barrier();
    float apart = most > least ? PART * (depth_of(most) - depth_of(least)) : 0.0;
    for (int i = me; i < HALF * HALF; i += ALONG)
        pull_half(i, apart);
    barrier();
    for (int i = me; i < QUARTER * QUARTER; i += ALONG)
        pull_quarter(i, 2.0 * apart);
    barrier();
    for (int i = me; i < HALF * HALF; i += ALONG) {
        int over = (i / HALF / 2) * QUARTER + (i % HALF) / 2;
        if (half_depth[i] >= NEVER && quarter_spread[over] >= 0.0) {
            half_depth[i] = quarter_depth[over];
            half_spread[i] = 0.0;
        }
    }
    barrier();
    for (int i = me; i < TEXELS; i += ALONG) {
        int over = (i / SIZE / 2) * HALF + (i % SIZE) / 2;
        float depth = depth_of(texel[i]);
        bool is_behind = depth - half_depth[over] > apart + 2.0 * half_spread[over];
        if (half_spread[over] >= 0.0 && (depth >= NEVER || is_behind))
            texel[i] = ordered(half_depth[over]);
    }
    barrier();
}

void main()
{
    int number = first + int(gl_WorkGroupID.x), me = int(gl_LocalInvocationID.x);
    Virtual v = virtual_at(number);
    if (v.size <= 0.0)
        return;
    Look l = look_of(v, at_objects);
    for (int i = me; i < TEXELS; i += ALONG)
        texel[i] = EMPTY;
    if (me == 0) {
        least = EMPTY;
        most = 0u;
    }
    barrier();
    int begin = int(mixed(uint(number)) % uint(max(spots.x, 1)));
    for (int i = me; i < spots.y; i += ALONG)
        splat((begin + i) % spots.x, l, random_at(uint(number), uint(i)));
    barrier();
    fill(me);
    int across = imageSize(atlas).x / SIZE;
    ivec2 corner = SIZE * ivec2(number % across, number / across);
    for (int i = me; i < TEXELS; i += ALONG)
        imageStore(atlas, corner + ivec2(i % SIZE, i / SIZE), vec4(depth_of(texel[i])));
}

#version 330 core
// A g-BRDF: a relief, a few distributions of micro-normals, and maps. Twins: meso.c, gbrdf.c.
#define OWN_BLEND
#define OWN_PLACES
const bool view_grid = false, light_grid = false;
#include "btf/btf.glsl"
#include "btf/upright.glsl"

uniform samplerBuffer array0;   // depth [texels], in widths
uniform samplerBuffer array1;   // rotation [texels]
uniform samplerBuffer array2;   // diffuse, r0 [texels]
uniform usamplerBuffer array3;  // label [texels]
uniform samplerBuffer array4;   // ndf [materials][NDF_SIDE][NDF_SIDE]
uniform vec3 relief;            // its lowest and highest place, in texels; what a light is times
uniform ivec2 side;             // of the sample, texels

// ---------------------------------------------------------------- the maps

// The four texels around a place, row by row, and how far it is from the first.
struct Around {
    ivec4 texel;
    vec2 part;
};

// Twin: bilinear_tiled.
Around around(vec2 at)
{
    vec2 size = vec2(side), from = at - 0.5;
    vec2 u = from - size * floor(from / size);
    ivec2 first = min(ivec2(u), side - 1), next = first + 1;
    next *= ivec2(lessThan(next, side));
    return Around(ivec4(first.y * side.x + first.x, first.y * side.x + next.x,
                        next.y * side.x + first.x, next.y * side.x + next.x),
                  min(u - vec2(first), 1.0));
}

vec4 shares_of(vec2 part)
{
    vec2 rest = 1.0 - part;
    return vec4(rest.x * rest.y, part.x * rest.y, rest.x * part.y, part.x * part.y);
}

float height_of(int texel)
{
    return float(side.x) * texelFetch(array0, texel).r;
}

// ---------------------------------------------------------------- rays and the relief

const float FLATTEST = 0.03, MOST_STEPS = 960.0, ABOVE = 0.01;
const int REFINEMENTS = 7;

float meso_height(vec2 at)
{
    Around a = around(at);
    vec4 z = vec4(height_of(a.texel.x), height_of(a.texel.y), height_of(a.texel.z),
                  height_of(a.texel.w));
    vec2 rows = mix(z.xz, z.yw, a.part.x);
    return mix(rows.x, rows.y, a.part.y);
}

// What is passed along the plane while z rises by one.
vec2 run_of(vec3 d)
{
    return vec2(d.x, -d.y) / max(d.z, FLATTEST);
}

int steps(float rise, vec2 run)
{
    return 1 + int(min(2.0 * rise * length(run), MOST_STEPS));
}

vec3 meso_seen(vec2 at, vec3 v)
{
    vec2 run = run_of(v);
    float rise = relief.y - relief.x;
    int n = steps(rise, run);
    float over = relief.y, under = over;
    float gap = under - meso_height(at + under * run);
    for (int i = 1; i <= n && gap > 0.0; i++) {
        over = under;
        under = relief.y - rise * float(i) / float(n);
        gap = under - meso_height(at + under * run);
    }
    for (int i = 0; i < REFINEMENTS && gap <= 0.0; i++) {
        float z = 0.5 * (over + under);
        if (z > meso_height(at + z * run))
            over = z;
        else
            under = z;
    }
    return vec3(at + under * run, under);
}

bool meso_open(vec3 from, vec3 d)
{
    vec2 run = run_of(d);
    float rise = max(relief.y - from.z, 0.0);
    int n = steps(rise, run);
    for (int i = 1; i <= n; i++) {
        float up = rise * float(i) / float(n);
        if (from.z + up - meso_height(from.xy + up * run) < -ABOVE)
            return false;
    }
    return true;
}

// Heights of the three texels of a row, `x` in the middle.
vec3 row_of(int x, int y)
{
    int row = (y + side.y) % side.y * side.x;
    return vec3(height_of(row + (x + side.x - 1) % side.x), height_of(row + x),
                height_of(row + (x + 1) % side.x));
}

vec3 meso_normal(int texel)
{
    const vec3 smooth_by = vec3(0.25, 0.5, 0.25);
    int y = texel / side.x, x = texel - y * side.x;
    vec3 above = row_of(x, y - 1), middle = row_of(x, y), below = row_of(x, y + 1);
    float across = dot(smooth_by, vec3(above.z - above.x, middle.z - middle.x, below.z - below.x));
    float down = dot(smooth_by, below - above);
    return normalize(vec3(-0.5 * across, 0.5 * down, 1.0));
}

// ---------------------------------------------------------------- the reflectance

struct Texel {
    vec3 normal, diffuse;
    vec2 turn;
    float r0;
};

Texel between(Around a, vec4 share)
{
    Texel t = Texel(vec3(0.0), vec3(0.0), vec2(0.0), 0.0);
    for (int k = 0; k < 4; k++) {
        vec4 base = texelFetch(array2, a.texel[k]);
        float angle = texelFetch(array1, a.texel[k]).r;
        t.normal += share[k] * meso_normal(a.texel[k]);
        t.diffuse += share[k] * base.rgb;
        t.turn += share[k] * vec2(cos(angle), sin(angle));
        t.r0 += share[k] * base.a;
    }
    t.normal = normalize(t.normal);
    t.turn = dot(t.turn, t.turn) > 1e-12 ? normalize(t.turn) : vec2(1.0, 0.0);
    return t;
}

// A direction in the frame of a texel. Twin: gbrdf_local.
vec3 local(Texel t, vec3 d)
{
    vec3 u = upright(d, t.normal);
    return vec3(dot(t.turn, u.xy), t.turn.x * u.y - t.turn.y * u.x, u.z);
}

const int NDF_SIDE = 32;

vec3 ndf_at(int label, vec3 h)
{
    vec2 at = 0.5 * float(NDF_SIDE) * (1.0 + h.xy / (1.0 + h.z)) - 0.5;
    ivec2 first = ivec2(floor(at)), last = ivec2(NDF_SIDE - 1);
    vec4 share = shares_of(at - vec2(first));
    vec3 sum = vec3(0.0);
    for (int k = 0; k < 4; k++) {
        ivec2 cell = clamp(first + ivec2(k & 1, k >> 1), ivec2(0), last);
        sum += share[k] * texelFetch(array4, (label * NDF_SIDE + cell.y) * NDF_SIDE + cell.x).rgb;
    }
    return sum;
}

// The distributions of the materials around, by their shares.
vec3 blended_ndf(Around a, vec4 share, vec3 h)
{
    vec3 sum = vec3(0.0);
    for (int k = 0; k < 4; k++) {
        int label = int(texelFetch(array3, a.texel[k]).r);
        for (int j = k + 1; j < 4; j++)
            if (int(texelFetch(array3, a.texel[j]).r) == label) {
                share[k] += share[j];
                share[j] = 0.0;
            }
        if (share[k] > 0.0)
            sum += share[k] * ndf_at(label, h);
    }
    return sum;
}

float brdf_grazing(float kh)
{
    float x = 1.0 - kh, x2 = x * x;
    return x2 * x2 * x;
}

vec3 gbrdf_evaluate(vec2 from, vec3 v, vec3 l)
{
    vec3 at = meso_seen(from, v);
    Around a = around(at.xy);
    vec4 share = shares_of(a.part);
    Texel t = between(a, share);
    vec3 k1 = local(t, l), k2 = local(t, v);
    if (k1.z <= 0.0 || !meso_open(at, l))
        return vec3(0.0);
    vec3 h = normalize(k1 + k2);
    float fresnel = t.r0 + (1.0 - t.r0) * brdf_grazing(max(dot(k1, h), 0.0));
    float c2 = max(k2.z, 0.0);
    float masking = k1.z + c2 - k1.z * c2;
    return relief.z * k1.z * (t.diffuse + PI * fresnel / masking * blended_ndf(a, share, h));
}

// ---------------------------------------------------------------- as a model

vec3 model_at(vec2 at, Blend v, Blend l)
{
    vec3 rgb = gbrdf_evaluate(at, v.direction, l.direction);
    return without_cosine ? rgb / max(l.direction.z, 1e-6) : rgb;
}

vec3 model_blend(int texel, Blend v, Blend l)
{
    int y = texel / side.x;
    return model_at(vec2(texel - y * side.x, y) + 0.5, v, l);
}

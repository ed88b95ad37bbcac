// A ray between four cameras, each where it sees the surface of the ray; twin of
// src/relight/view/slab_depth.c, function by function. `shade` also returns how sure it is.
uniform sampler2D view00;  // low u, low v
uniform sampler2D view10;  // high u, low v
uniform sampler2D view01;
uniform sampler2D view11;
uniform sampler2D disparity00;
uniform sampler2D disparity10;
uniform sampler2D disparity01;
uniform sampler2D disparity11;
#include "slab_parts.glsl"
uniform vec4 st;    // st_min, st_max
uniform vec4 cell;  // low u, low v, high u, high v
uniform vec4 here;  // 1 for each camera whose view is there, in the order above, else 0

const float BACKGROUND = -1.0;
const int MOST_STEPS = 256;
const float NEGLIGIBLE = 1e-4;
const float GUESSED = 1e-3;

struct Camera {
    float weight;
    vec2 shift;  // texels per unit of disparity
    float speed, pace;
    ivec2 first;  // texel of its view that its texture begins with
};
vec2 texel;  // where the ray's point on the st plane lies in a view
int rounds;
float slope;
Camera camera00, camera10, camera01, camera11;

// ---------------------------------------------------------------- one camera

vec2 place_at(Camera c, float q)
{
    return texel + q * c.shift;
}

bool within(vec2 at)
{
    vec2 size = view_size();
    return all(greaterThanEqual(at, vec2(0.0))) && all(lessThanEqual(at, size));
}

ivec2 texel_index(sampler2D view, Camera c, ivec2 at)
{
    return clamp(at - c.first, ivec2(0), textureSize(view, 0) - 1);
}

float disparity_at(sampler2D disparity, Camera c, float q)
{
    vec2 at = place_at(c, q);
    if (!within(at))
        return BACKGROUND;
    return texelFetch(disparity, texel_index(disparity, c, ivec2(floor(at))), 0).r;
}

float agreement(float speed, float q, float other)
{
    return clamp(2.0 - abs(q - other) * speed, 0.0, 1.0);
}

struct Sum {
    vec3 rgb;
    float disparity, weight;
};

void gather(inout Sum sum, sampler2D view, sampler2D disparity, Camera c, float q, float surface)
{
    vec2 at = place_at(c, q);
    if (!within(at))
        return;
    ivec2 corner = ivec2(floor(at - 0.5));
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++) {
            ivec2 here = corner + ivec2(i, j);
            vec2 part = 1.0 - abs(at - 0.5 - vec2(here));
            float found = texelFetch(disparity, texel_index(disparity, c, here), 0).r;
            float w = c.weight * part.x * part.y * agreement(c.speed, surface, found);
            sum.rgb += w * texelFetch(view, texel_index(view, c, here), 0).rgb;
            sum.disparity += w * found;
            sum.weight += w;
        }
}

// ---------------------------------------------------------------- one ray

bool pass(inout float q, sampler2D disparity, Camera c, float found, float step)
{
    float from = q + step, before = disparity_at(disparity, c, from);
    float ahead = from - before, behind = found - q;
    if (!(before > BACKGROUND && ahead > 0.0 && behind > 0.0 && abs(found - before) <= slope))
        return false;
    q += step * behind / (ahead + behind);
    return true;
}

void add_seen(inout vec2 sum, sampler2D disparity, Camera c, float q, float step)
{
    float found = disparity_at(disparity, c, q);
    if (!(c.weight > NEGLIGIBLE && found > BACKGROUND))
        return;
    if (abs(found - q) > step) {
        if (!(slope > 0.0 && pass(q, disparity, c, found, step)))
            return;
        found = q;
    }
    sum += c.weight * vec2(found, 1.0);
}

float walking_pace(Camera c)
{
    return c.weight > NEGLIGIBLE ? c.pace : 0.0;
}

int count_steps(float from, float to)
{
    float pace = max(max(walking_pace(camera00), walking_pace(camera10)),
                     max(walking_pace(camera01), walking_pace(camera11)));
    return clamp(int(ceil(abs(from - to) * pace)), 1, MOST_STEPS);
}

bool walk(out float q, float from, float to)
{
    int steps = count_steps(from, to);
    float step = (from - to) / float(steps);
    for (int k = 0; k <= steps; k++) {
        float at = from - float(k) * step;
        vec2 sum = vec2(0.0);
        add_seen(sum, disparity00, camera00, at, step);
        add_seen(sum, disparity10, camera10, at, step);
        add_seen(sum, disparity01, camera01, at, step);
        add_seen(sum, disparity11, camera11, at, step);
        if (sum.y > 0.0) {
            q = sum.x / sum.y;
            return true;
        }
    }
    return false;
}

bool gather_all(out Sum sum, float q, float surface)
{
    sum = Sum(vec3(0.0), 0.0, 0.0);
    gather(sum, view00, disparity00, camera00, q, surface);
    gather(sum, view10, disparity10, camera10, q, surface);
    gather(sum, view01, disparity01, camera01, q, surface);
    gather(sum, view11, disparity11, camera11, q, surface);
    return sum.weight > 1e-6;
}

bool gather_surface(out Sum sum, float from, float to)
{
    float q;
    if (!walk(q, from, to))
        return false;
    for (int round = 0; round < rounds && gather_all(sum, q, q); round++)
        q = sum.disparity / sum.weight;
    return gather_all(sum, q, q);
}

vec4 shade(float nearest, float farthest)
{
    Sum sum;
    bool seen = nearest >= farthest && gather_surface(sum, nearest, farthest);
    if (!seen)
        seen = gather_all(sum, 0.0, BACKGROUND);
    if (!seen) {
        camera00.speed = camera10.speed = camera01.speed = camera11.speed = 0.0;
        gather_all(sum, 0.0, 0.0);
    }
    vec3 rgb = sum.weight > 0.0 ? sum.rgb / sum.weight : vec3(0.0);
    return vec4(rgb, seen ? sum.weight : GUESSED * sum.weight);
}

Camera find_camera(vec2 uv, vec2 at, vec2 part, float present, vec2 first)
{
    vec2 per_st = view_size() / (st.zw - st.xy);
    vec2 shift = (uv - at) * per_st * vec2(1.0, -1.0);
    return Camera(present * part.x * part.y, shift, length(shift), length(shift), ivec2(first));
}

// The cameras of the cell around `nearest`, of a ray that passes `uv`; `at` is its place in the
// window.
void find_cameras(vec2 uv, vec2 nearest, vec2 at)
{
    vec2 size = max(cell.zw - cell.xy, vec2(1e-30));  // one row or column has cells of no width
    vec2 part = clamp((nearest - cell.xy) / size, 0.0, 1.0);
    texel = at * view_size();
    rounds = 2;
    slope = 0.0;
    camera00 = find_camera(uv, cell.xy, 1.0 - part, here.x, first_low.xy);
    camera10 = find_camera(uv, cell.zy, vec2(part.x, 1.0 - part.y), here.y, first_low.zw);
    camera01 = find_camera(uv, cell.xw, vec2(1.0 - part.x, part.y), here.z, first_high.xy);
    camera11 = find_camera(uv, cell.zw, part, here.w, first_high.zw);
}

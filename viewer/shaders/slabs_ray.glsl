// The ray of a pixel in one of several slabs, and what that slab has to say of it. Twins:
// src/relight/view/slabs.c, src/relight/view/slabs_frame.c.
uniform vec4 picture;  // left, top, right, bottom of the picture in the frame
uniform vec3 eye;      // all of them in the slab's own frame
uniform vec3 corner;   // of the picture, and its sides, from the eye
uniform vec3 right;
uniform vec3 down;
uniform vec2 planes;  // z of uv and st
uniform vec4 grid;    // the first and the last lines of the cameras: low u, low v, high u, high v
uniform float slack;  // by how much cells at the border are wider
uniform bool beside;  // rays that no slab's cameras are passed by
uniform sampler2D passed;  // what the others have added up to

const float FADE_UV = 0.25;
const float FADE_ST = 0.0625;
const float LEAST = 1e-4;

vec3 direction_at(vec2 at)
{
    return corner + at.x * right + at.y * down;
}

bool slabs_ray(out vec2 uv, out vec2 hit, vec3 from, vec3 direction)
{
    float way = (planes.y - from.z) / direction.z;
    hit = from.xy + way * direction.xy;
    uv = from.xy + (planes.x - from.z) / (planes.y - from.z) * (hit - from.xy);
    return way > 0.0 && (from.z - planes.y) * (planes.x - planes.y) > 0.0;
}

// Texels that a pixel whose ray hits the window in `hit` covers along its sides.
vec2 slabs_texels(vec2 hit, vec2 at, vec2 per_st)
{
    vec2 pixel = 1.0 / (picture.zw - picture.xy);
    vec2 uv, next, below;
    if (beside)
        return per_st.x * pixel * vec2(length(right), length(down));
    bool right_hits = slabs_ray(uv, next, eye, direction_at(at + vec2(pixel.x, 0.0)));
    bool low_hits = slabs_ray(uv, below, eye, direction_at(at + vec2(0.0, pixel.y)));
    return vec2(right_hits ? length((next - hit) * per_st) : 0.0,
                low_hits ? length((below - hit) * per_st) : 0.0);
}

// Every place of the grid is in one cell.
bool in_cell(vec2 uv, vec4 of)
{
    vec2 low = of.xy - slack * vec2(equal(of.xy, grid.xy));
    bvec2 last = equal(of.zw, grid.zw);
    vec2 high = of.zw + slack * vec2(last);
    return all(greaterThanEqual(uv, low)) && (uv.x < high.x || last.x && uv.x <= high.x) &&
           (uv.y < high.y || last.y && uv.y <= high.y);
}

float fade(float inside, float width)
{
    return smoothstep(0.0, 1.0, inside / width);
}

float line_weight(float at, float low, float high)
{
    return high > low ? fade(min(at - low, high - at), FADE_UV * (high - low)) : 1.0;
}

// Within the grid.
float slab_weight(vec2 uv, vec2 hit, vec4 window)
{
    float inside = line_weight(uv.x, grid.x, grid.z) * line_weight(uv.y, grid.y, grid.w);
    vec2 border = min(hit - window.xy, window.zw - hit);
    vec2 width = FADE_ST * (window.zw - window.xy);
    return max(inside, LEAST) * fade(border.x, width.x) * fade(border.y, width.y);
}

// ---------------------------------------------------------------- beside all grids

const float PI = 3.14159265358979;
const float MOST_ASIDE = PI * 100.0 / 180.0;
const float FLATTEST = 1e-3;

// What is added where a ray passes cameras that do not see it, so that it is known to pass.
const vec4 UNSEEN = vec4(0.0, 0.0, 0.0, -1e-30);

// Whether the ray of this pixel passes the cameras of a slab.
bool is_passed()
{
    return texelFetch(passed, ivec2(gl_FragCoord.xy), 0).a != 0.0;
}

// A ray, its crossings of the planes, where the cameras nearest to it stand, and its weight.
struct Beside {
    vec2 uv, hit, at;
    bool away;
    float weight;
};

Beside slab_ray_beside(vec3 direction, vec4 window)
{
    Beside b = Beside(vec2(0.0), vec2(0.0), vec2(0.0), false, 0.0);
    vec3 way = normalize(direction);
    float to_uv = (planes.x - eye.z) / way.z, to_st = (planes.y - eye.z) / way.z;
    b.away = way.z * (planes.x - planes.y) < 0.0;
    if (!(abs(way.z) > FLATTEST) || (!b.away && to_uv <= 0.0))
        return b;
    vec3 middle = eye + dot(vec3(0.5 * (window.xy + window.zw), planes.y) - eye, way) * way;
    b.uv = eye.xy + to_uv * way.xy;
    b.hit = eye.xy + to_st * way.xy;
    b.at = clamp(middle.xy - abs((planes.x - middle.z) / way.z) * way.xy, grid.xy, grid.zw);
    vec3 from = normalize(middle - vec3(b.at, planes.x));
    float aside = 2.0 * atan(length(from - way), length(from + way));
    if (aside < MOST_ASIDE)
        b.weight = 1.0 / max(aside * aside, 1e-12) - 1.0 / (MOST_ASIDE * MOST_ASIDE);
    return b;
}

// Whether the pixel is this cell's, and its ray.
bool slabs_begin(out vec2 uv, out vec2 hit, vec2 at, vec4 window, vec4 cell)
{
    if (!beside)
        return slabs_ray(uv, hit, eye, direction_at(at)) && in_cell(uv, cell);
    if (is_passed())
        return false;
    Beside ray = slab_ray_beside(direction_at(at), window);
    uv = ray.uv;
    hit = ray.hit;
    return ray.weight > 0.0 && in_cell(ray.at, cell);
}

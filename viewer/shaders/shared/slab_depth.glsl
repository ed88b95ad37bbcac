// A ray between four cameras, each where it sees the surface of the ray. Twin:
// src/relight/view/slab_depth.c. Cameras go by number: low u low v, high u low v, low u high v,
// high u high v. Calls are written out: software renderers look up at every pixel what an index
// selects.
//
// The shader declares three variables or constants. `here` holds 1 for each camera whose view is
// loaded and 0 for others. `rounds` limits how often the surface is refined. `slope` is the
// steepest surface seen from aside, 0 for rays through the grid. It defines how views are stored:
vec2 view_size();
float disparity_texel(int c, ivec2 at);
vec4 view_texel(int c, ivec2 at);

uniform vec4 st;    // st_min, st_max
uniform vec4 cell;  // low u, low v, high u, high v

const float BACKGROUND = -1.0;
const int MOST_STEPS = 256;
const float NEGLIGIBLE = 1e-4;

struct Camera {
    float weight;
    vec2 shift;  // texels per unit of disparity
    float speed, pace;
};
vec2 texel;  // where the ray's point on the st plane lies in a view
Camera camera[4];

// ---------------------------------------------------------------- one camera

vec2 place_at(int c, float q)
{
    return texel + q * camera[c].shift;
}

bool within(vec2 at)
{
    return all(greaterThanEqual(at, vec2(0.0))) && all(lessThanEqual(at, view_size()));
}

float disparity_at(int c, float q)
{
    vec2 at = place_at(c, q);
    return within(at) ? disparity_texel(c, ivec2(floor(at))) : BACKGROUND;
}

float agreement(float speed, float q, float other)
{
    return clamp(2.0 - abs(q - other) * speed, 0.0, 1.0);
}

struct Sum {
    vec4 value;
    float disparity, weight;
};

void gather(inout Sum sum, int c, float q, float surface)
{
    vec2 at = place_at(c, q);
    if (!within(at) || camera[c].weight <= 0.0)
        return;
    ivec2 corner = ivec2(floor(at - 0.5));
    for (int k = 0; k < 4; k++) {
        ivec2 beside = corner + ivec2(k & 1, k >> 1);
        vec2 part = 1.0 - abs(at - 0.5 - vec2(beside));
        float found = disparity_texel(c, beside);
        float w = camera[c].weight * part.x * part.y * agreement(camera[c].speed, surface, found);
        sum.value += w * view_texel(c, beside);
        sum.disparity += w * found;
        sum.weight += w;
    }
}

// ---------------------------------------------------------------- one ray

bool find_crossing(inout float q, int c, float found, float step_)
{
    float from = q + step_, before = disparity_at(c, from);
    float ahead = from - before, behind = found - q;
    if (!(before > BACKGROUND && ahead > 0.0 && behind > 0.0 && abs(found - before) <= slope))
        return false;
    q += step_ * behind / (ahead + behind);
    return true;
}

void add_seen(inout vec2 sum, int c, float q, float step_)
{
    float found = disparity_at(c, q);
    if (!(camera[c].weight > NEGLIGIBLE && found > BACKGROUND))
        return;
    if (abs(found - q) > step_) {
        if (!(slope > 0.0 && find_crossing(q, c, found, step_)))
            return;
        found = q;
    }
    sum += camera[c].weight * vec2(found, 1.0);
}

float walking_pace(int c)
{
    return camera[c].weight > NEGLIGIBLE ? camera[c].pace : 0.0;
}

int count_steps(float from, float to)
{
    float pace = max(max(walking_pace(0), walking_pace(1)), max(walking_pace(2), walking_pace(3)));
    return clamp(int(ceil(abs(from - to) * pace)), 1, MOST_STEPS);
}

bool walk(out float q, float from, float to)
{
    int steps = count_steps(from, to);
    float step_ = (from - to) / float(steps);
    for (int k = 0; k <= steps; k++) {
        float at = from - float(k) * step_;
        vec2 sum = vec2(0.0);
        add_seen(sum, 0, at, step_);
        add_seen(sum, 1, at, step_);
        add_seen(sum, 2, at, step_);
        add_seen(sum, 3, at, step_);
        if (sum.y > 0.0) {
            q = sum.x / sum.y;
            return true;
        }
    }
    return false;
}

bool gather_all(out Sum sum, float q, float surface)
{
    sum = Sum(vec4(0.0), 0.0, 0.0);
    gather(sum, 0, q, surface);
    gather(sum, 1, q, surface);
    gather(sum, 2, q, surface);
    gather(sum, 3, q, surface);
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

// The sums of a ray; whether a camera sees what it meets. Twin: shade of
// src/relight/view/slab_depth.c.
bool gather_ray(out Sum sum, float nearest, float farthest)
{
    if (nearest >= farthest && gather_surface(sum, nearest, farthest))
        return true;
    if (gather_all(sum, 0.0, BACKGROUND))
        return true;
    camera[0].speed = camera[1].speed = camera[2].speed = camera[3].speed = 0.0;
    gather_all(sum, 0.0, 0.0);
    return false;
}

Camera find_camera(vec2 uv, vec2 at, vec2 part, float present)
{
    vec2 per_st = view_size() / (st.zw - st.xy);
    vec2 shift = (uv - at) * per_st * vec2(1.0, -1.0);
    return Camera(present * part.x * part.y, shift, length(shift), length(shift));
}

// The cameras of the cell around `nearest`, of a ray that passes `uv`; `at` is its position in the
// window.
void find_cameras(vec2 uv, vec2 nearest, vec2 at)
{
    vec2 size = max(cell.zw - cell.xy, vec2(1e-30));  // one row or column has cells of no width
    vec2 part = clamp((nearest - cell.xy) / size, 0.0, 1.0);
    texel = at * view_size();
    camera[0] = find_camera(uv, cell.xy, 1.0 - part, here.x);
    camera[1] = find_camera(uv, cell.zy, vec2(part.x, 1.0 - part.y), here.y);
    camera[2] = find_camera(uv, cell.xw, vec2(1.0 - part.x, part.y), here.z);
    camera[3] = find_camera(uv, cell.zw, part, here.w);
}

// A ray beside the grid by depth, after slab_depth.glsl and slabs_ray.glsl. Twin:
// src/relight/view/slab_depth.c.
const float MOST_SLOPE = 12.0;
const float SHALLOW = 1.0 / 3.0;
const float ENDLESS = -0.98;
const float FAR = 1e30;  // no bound

void clip(inout vec2 part, int c)
{
    vec2 size = vec2(textureSize(view00, 0)), shift = camera[c].shift;
    for (int axis = 0; axis < 2; axis++) {
        if (shift[axis] == 0.0)
            continue;
        float first = -texel[axis] / shift[axis];
        float last = (size[axis] - texel[axis]) / shift[axis];
        part = vec2(max(part.x, min(first, last)), min(part.y, max(first, last)));
    }
}

void stretch_one(inout vec2 all, int c, vec2 own)
{
    clip(own, c);
    if (camera[c].weight > 0.0 && own.x <= own.y)
        all = vec2(min(all.x, own.x), max(all.y, own.y));
}

// From where to where, from the eye on.
bool stretch_of(out vec2 stretch, float least, float most, bool away)
{
    vec2 all = vec2(FAR, -FAR), own = vec2(least, most);
    stretch_one(all, 0, own);
    stretch_one(all, 1, own);
    stretch_one(all, 2, own);
    stretch_one(all, 3, own);
    stretch = away ? all.yx : all;
    return all.x <= all.y;
}

bool is_clear(int c, vec2 stretch)
{
    int steps = count_steps(stretch.x, stretch.y);
    if (camera[c].weight <= 0.0)
        return false;
    for (int k = 0; k <= steps; k++) {
        float q = stretch.x + float(k) * (stretch.y - stretch.x) / float(steps);
        if (disparity_at(c, q) > q + SHALLOW * slope)
            return false;
    }
    return true;
}

bool gather_clear(out Sum sum, vec2 stretch)
{
    bool clear = is_clear(0, stretch) || is_clear(1, stretch) || is_clear(2, stretch) ||
                 is_clear(3, stretch);
    return clear &&
           (gather_all(sum, 0.0, BACKGROUND) || gather_all(sum, stretch.y, BACKGROUND));
}

void slow_down(int c, float most)
{
    camera[c].speed = min(camera[c].pace, most);
    if (camera[c].weight > 0.0 && camera[c].pace > most)
        rounds = 0;
}

void look_from_aside()
{
    vec2 across = (grid.zw - grid.xy) * vec2(textureSize(view00, 0)) / (st.zw - st.xy);
    float most = max(length(across), 1.0);
    slope = MOST_SLOPE / most;
    rounds = 2;
    slow_down(0, most);
    slow_down(1, most);
    slow_down(2, most);
    slow_down(3, most);
}

float disparity_of_eye()
{
    bool before = (planes.x - eye.z) * (planes.x - planes.y) > 0.0;
    return before ? (eye.z - planes.y) / (planes.x - eye.z) : FAR;
}

// And how sure it is: 0 is not at all.
vec4 slab_depth_beside(Beside ray, vec2 extent)
{
    vec2 place = (ray.hit - st.xy) / (st.zw - st.xy), stretch;
    float from_eye = disparity_of_eye();
    find_cameras(ray.uv, ray.at, vec2(place.x, 1.0 - place.y));
    look_from_aside();
    float nearest = ray.away ? min(extent.y, from_eye) : extent.y;
    float farthest = ray.away ? extent.x : max(extent.x, from_eye);
    Sum sum;
    bool found = stretch_of(stretch, farthest, nearest, ray.away) &&
               gather_surface(sum, stretch.x, stretch.y);
    if (!found && !(stretch_of(stretch, ray.away ? ENDLESS : from_eye, nearest, ray.away) &&
                  gather_clear(sum, stretch)))
        return vec4(0.0);
    return vec4(sum.value.rgb / sum.weight, sum.weight);
}

// Where a direction lies in a grid of `size` nodes, in nodes; `d` in the pole's frame. After light
// and pole. Twin: relume_weight_grid_place.
vec2 weight_grid_place(vec3 d, ivec2 size)
{
    float down = float(hemisphere ? size.y - 1 : size.y / 2 - 1);
    bool below = d.z < 0.0;
    float theta = atan(length(d.xy), below && hemisphere ? 0.0 : abs(d.z));
    float row = down * (1.0 - sqrt(max(1.0 - theta / (0.5 * PI), 0.0)));
    float column = (atan(d.y, d.x) / (2.0 * PI) + 0.5) * float(size.x - 1);
    return vec2(column, below && !hemisphere ? float(size.y - 1) - row : row);
}

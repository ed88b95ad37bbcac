// The weight of one camera in a frame through an aperture. Twin: src/relight/view/slab_lens.c.
uniform vec2 camera;  // its u, v
uniform vec4 steps;   // to the next lines of the grid: u below, u above, v below, v above

float hat(float away, vec2 step_)
{
    return max(1.0 - abs(away) / (away > 0.0 ? step_.y : step_.x), 0.0);
}

// Twin: relume_slab_lens_weight.
float slab_lens_weight(vec2 uv, float radius)
{
    vec2 away = uv - camera;
    float distant = length(away), left = distant > radius ? 1.0 - radius / distant : 0.0;
    return hat(left * away.x, steps.xy) * hat(left * away.y, steps.zw);
}

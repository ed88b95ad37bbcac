// The frame in which the basis of a file has its pole.
uniform bool hemisphere, pole_y;

// Twin: pole_from_world.
vec3 pole_from_world(vec3 d)
{
    return pole_y ? vec3(-d.z, d.x, d.y) : d;
}

// Twin: is_captured of src/relight/light/near_lights.c.
bool is_captured(vec3 towards)
{
    return !hemisphere || pole_from_world(towards).z >= 0.0;
}

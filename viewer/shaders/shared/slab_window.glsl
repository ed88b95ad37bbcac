// A slab through a frame: where a position of the frame lies in the window, and its ray on the uv
// plane.
uniform vec4 picture;  // left, top, right, bottom of the window in the frame, rows counted down
uniform vec3 eye;      // x, y, and how far towards the st plane the uv plane lies

// Returns the middle of the pixel in the frame, rows counted down. The shader defines it.
vec2 frame_position();

// In the window, 0 to 1.
vec2 window_place(vec2 within)
{
    return (frame_position() + within - picture.xy) / (picture.zw - picture.xy);
}

vec2 slab_uv(vec2 at, vec4 st)
{
    vec2 hit = vec2(mix(st.x, st.z, at.x), mix(st.w, st.y, at.y));
    return eye.xy + eye.z * (hit - eye.xy);
}

// The faces of a cube: ahead, right = ahead x up, up; +x -x +y -y +z -z.
const vec3 face_ahead[6] = vec3[6](vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, -1, 0),
                                   vec3(0, 0, 1), vec3(0, 0, -1));
const vec3 face_right[6] = vec3[6](vec3(0, 0, 1), vec3(0, 0, -1), vec3(1, 0, 0), vec3(1, 0, 0),
                                   vec3(-1, 0, 0), vec3(1, 0, 0));
const vec3 face_up[6] = vec3[6](vec3(0, 1, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(0, 0, -1),
                                vec3(0, 1, 0), vec3(0, 1, 0));

int cube_face_of(vec3 d)
{
    vec3 a = abs(d);
    if (a.x >= a.y && a.x >= a.z)
        return d.x >= 0.0 ? 0 : 1;
    if (a.y >= a.z)
        return d.y >= 0.0 ? 2 : 3;
    return d.z >= 0.0 ? 4 : 5;
}

// The ray through a position in the square of a face, -1 to 1 to the right and up.
vec3 cube_face_ray(int face, vec2 ab)
{
    return face_ahead[face] + ab.x * face_right[face] + ab.y * face_up[face];
}

// What a light that stands near sends to a point. After texels and cube.
#include "shared/light.glsl"

// enum relume_light_kind
const int DIRECTIONAL = 0, SPOT = 3, SLIDE = 4, AREA = 5, IES = 6, GONIO = 7;
struct Light {
    int kind;
    vec3 rgb;
    bool nofall;
    vec3 position;
    vec3 axis, right, up;  // it shines along the axis; unit vectors
    float half_angle;      // radians
};
uniform Light light;
uniform sampler2D picture;  // slide: its picture; ies: intensities [vertical][horizontal];
                            // gonio: relume_gonio_map

vec3 slide_factor(vec3 ray)
{
    vec2 size = vec2(textureSize(picture, 0));
    float forward = dot(ray, light.axis);
    float scale = size.x / (2.0 * tan(light.half_angle) * forward);
    vec2 at = 0.5 * size + scale * vec2(dot(ray, light.right), -dot(ray, light.up));
    bool inside = forward > 0.0 && all(greaterThanEqual(at, vec2(0.0))) &&
                  all(lessThanEqual(at, size));
    return inside ? texels_bilinear(picture, at) : vec3(0.0);
}

vec3 ies_factor(vec3 ray)
{
    vec2 cells = vec2(textureSize(picture, 0) - 1);
    float vertical = off_axis(ray, light.axis) / PI;
    float horizontal = atan(dot(ray, light.up), dot(ray, light.right)) / (2.0 * PI);
    vec2 at = vec2(fract(horizontal), vertical) * cells + 0.5;
    return texels_bilinear(picture, at).rrr;
}

// Twin: relume_gonio_value. Faces stand in borders of one texel.
vec3 gonio_value(vec3 d)
{
    float side = float(textureSize(picture, 0).y - 2);
    int face = cube_face_of(d);
    float ahead = dot(d, face_ahead[face]);
    vec2 ab = vec2(dot(d, face_right[face]), -dot(d, face_up[face])) / ahead;
    vec2 at = clamp((0.5 + 0.5 * ab) * side, 0.0, side) + 1.0;
    return texels_bilinear(picture, at + vec2(float(face) * (side + 2.0), 0.0));
}

vec3 gonio_factor(vec3 ray)
{
    return gonio_value(vec3(dot(ray, light.right), dot(ray, light.up), -dot(ray, light.axis)));
}

// Twin: relume_light_at.
bool light_at(out vec3 towards, out vec3 rgb, vec3 point)
{
    float distance;
    bool arrives = ray_to(towards, distance, light.position, point);
    rgb = light.rgb * (light.nofall ? 1.0 : 1.0 / (distance * distance));
    if (light.kind == SPOT)
        rgb *= spot_factor(-towards, light.axis, light.half_angle);
    else if (light.kind == SLIDE)
        rgb *= slide_factor(-towards);
    else if (light.kind == IES)
        rgb *= ies_factor(-towards);
    else if (light.kind == GONIO)
        rgb *= gonio_factor(-towards);
    return arrives;
}

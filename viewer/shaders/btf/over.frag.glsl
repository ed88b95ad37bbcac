#version 330 core
// Objects over the picture of a scene, where they stand before it.
uniform sampler2D place, shaded;  // `grid` times finer than the frame
uniform sampler2D other;          // the same in another material
uniform sampler2D tint;           // what they are multiplied by
uniform bool tinted;
uniform sampler2D emitted;        // what they send of their own
uniform bool sends;
uniform bool difference;          // show how far it is from that
uniform sampler2D scene;          // positions of the frame's own size; alpha 0: nothing is there
uniform bool in_scene;
uniform sampler2D returned;       // light of the scene that objects show, likewise
uniform bool has_returned;
uniform int grid;
uniform vec4 eye;
uniform float exposure;
out vec4 color;  // with its cover

float depth_of(vec3 point)
{
    return eye.w > 0.0 ? distance(point, eye.xyz) : -dot(point, eye.xyz);
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 behind = texelFetch(scene, pixel, 0);
    float nearest = in_scene && behind.a > 0.0 ? depth_of(behind.xyz) : 1e30;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < grid * grid; i++) {
        ivec2 at = pixel * grid + ivec2(i % grid, i / grid);
        vec4 point = texelFetch(place, at, 0);
        if (point.w == 0.0 || depth_of(point.xyz) >= nearest)
            continue;
        vec3 value = texelFetch(shaded, at, 0).rgb;
        if (difference)
            value = abs(value - texelFetch(other, at, 0).rgb);
        if (tinted)
            value *= texelFetch(tint, at, 0).rgb;
        if (sends && !difference)
            value += texelFetch(emitted, at, 0).rgb;
        if (has_returned)
            value += texelFetch(returned, pixel, 0).rgb;
        sum += vec4(exposure * value, 1.0);
    }
    color = sum / float(grid * grid);
}

#version 330 core
// What objects throw back of what they have gathered, by what they show where light of 1 comes from
// everywhere.
uniform sampler2D front;           // 2: objects
uniform sampler2D gathered;
uniform sampler2D objects, white;  // `grid` times finer
uniform int grid;
out vec4 color;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (texelFetch(front, pixel, 0).w != 2.0)
        discard;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < grid * grid; i++) {
        ivec2 at = pixel * grid + ivec2(i % grid, i / grid);
        if (texelFetch(objects, at, 0).w != 0.0)
            sum += vec4(texelFetch(white, at, 0).rgb, 1.0);
    }
    color = vec4(sum.rgb / max(sum.a, 1.0) * texelFetch(gathered, pixel, 0).rgb, 1.0);
}

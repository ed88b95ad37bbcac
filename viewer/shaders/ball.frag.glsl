#version 330 core
// A matt ball under the light, to show where it comes from.
uniform vec3 ball;   // middle and radius in pixels of the frame
uniform vec3 light;  // unit, x right, y up, z towards the viewer
uniform vec3 value;  // colour of the light, its largest channel 1
out vec4 color;

void main()
{
    vec2 at = (gl_FragCoord.xy - ball.xy) / ball.z;
    float r = length(at);
    vec3 normal = vec3(at.x, -at.y, sqrt(max(1.0 - r * r, 0.0)));
    float lit = max(dot(normal, light), 0.0);
    float spot = smoothstep(0.985, 0.995, dot(normal, light));
    // from behind, the rim glows towards the light
    float back = light.z < 0.0 ? max(-light.z, 0.0) * smoothstep(0.8, 1.0, r) * 0.2 : 0.0;
    vec3 shade = value * (0.04 + 0.7 * lit + back) + spot;
    color = vec4(shade, clamp((1.0 - r) * ball.z, 0.0, 1.0));
}

#version 330 core
// A rectangle of the frame, given in pixels from the top left corner. Frames and views keep their
// first row at the top, which is GL's y = 0; only present.frag turns them over.
uniform vec4 rectangle;   // left, top, right, bottom
uniform vec2 frame_size;  // pixels

void main()
{
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    vec2 pixel = mix(rectangle.xy, rectangle.zw, corner);
    gl_Position = vec4(2.0 * pixel / frame_size - 1.0, 0.0, 1.0);
}

// Pictures of the viewer are as large as the view.
#include "shared/stage.glsl"

vec2 stage_place(vec2 position)
{
    return position;
}

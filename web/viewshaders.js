// viewshaders.js - slabs and panoramas on the graphics card
import CUBE from '../viewer/shaders/shared/cube.glsl';
import FOOTPRINT from '../viewer/shaders/shared/footprint.glsl';
import FOOTPRINT_MEAN from '../viewer/shaders/shared/footprint_mean.glsl';
import PANORAMA from '../viewer/shaders/shared/panorama.glsl';
import PANORAMA_CUBE from '../viewer/shaders/shared/panorama_cube.glsl';
import PANORAMA_CYLINDER from '../viewer/shaders/shared/panorama_cylinder.glsl';
import PANORAMA_DISCS from '../viewer/shaders/shared/panorama_discs.glsl';
import PANORAMA_LAYOUT from '../viewer/shaders/shared/panorama_layout.glsl';
import PANORAMA_SPHERE from '../viewer/shaders/shared/panorama_sphere.glsl';
import SLAB_DEPTH from '../viewer/shaders/shared/slab_depth.glsl';
import SLAB_LENS from '../viewer/shaders/shared/slab_lens.glsl';
import SLAB_WINDOW from '../viewer/shaders/shared/slab_window.glsl';
import { HEAD } from './shaders.js';

// Where a pixel is in the frame.
const FRAME = `
uniform vec2 frame;  // its size
vec2 frame_position() { return vec2(gl_FragCoord.x, frame.y - gl_FragCoord.y); }
`;

// All views of a slab are layers of one texture, their disparities of another, which has more
// texels.
const SLAB_TEXELS = `
uniform sampler2DArray views;
uniform sampler2DArray disparities;
uniform vec4 slot;  // of the cameras in these
const vec4 here = vec4(1.0);
const int rounds = 2;
const float slope = 0.0;
${SLAB_DEPTH}
vec2 view_size() { return vec2(textureSize(disparities, 0).xy); }
ivec2 inner(ivec2 at) { return clamp(at, ivec2(0), textureSize(disparities, 0).xy - 1); }
float disparity_texel(int c, ivec2 at) { return texelFetch(disparities, ivec3(inner(at), int(slot[c])), 0).r; }
vec4 view_texel(int c, ivec2 at)
{
    return texelFetch(views, ivec3((vec2(inner(at)) + 0.5) * vec2(textureSize(views, 0).xy) / view_size(), int(slot[c])), 0);
}
uniform vec2 range;
vec4 cell_value(vec2 uv, vec2 at)
{
    Sum sum;
    find_cameras(uv, uv, at);
    gather_ray(sum, range.y, range.x);
    return sum.weight > 0.0 ? sum.value / sum.weight : vec4(0.0);
}
`;

// Views by the graphics card's filter. The viewer has parts of views, in textures of their own, and
// filters them by itself (slab_cell.glsl).
const SLAB_CELL = `
uniform sampler2DArray views;
uniform vec4 slot, st, cell;
vec2 view_size() { return vec2(textureSize(views, 0).xy); }
vec4 cell_value(vec2 uv, vec2 at)
{
    vec2 part = clamp((uv - cell.xy) / max(cell.zw - cell.xy, vec2(1e-30)), 0.0, 1.0);
    return mix(mix(texture(views, vec3(at, slot.x)), texture(views, vec3(at, slot.y)), part.x),
               mix(texture(views, vec3(at, slot.z)), texture(views, vec3(at, slot.w)), part.x), part.y);
}
`;

// One cell of a slab between four cameras, by number: low u low v, high u low v, ...
export const slabShader = (byDepth) => `${HEAD}${FOOTPRINT}${FOOTPRINT_MEAN}${SLAB_WINDOW}${FRAME}${byDepth ? SLAB_TEXELS : SLAB_CELL}
uniform vec4 grid;
out vec4 colour;
vec4 value_at(vec2 within)
{
    vec2 at = window_place(within);
    return cell_value(slab_uv(at, st), at);
}
void main()
{
    vec2 at = window_place(vec2(0.0)), uv = clamp(slab_uv(at, st), grid.xy, grid.zw);
    bvec2 last = greaterThanEqual(cell.zw, grid.zw);
    bool here_ = all(greaterThanEqual(uv, cell.xy)) && (uv.x < cell.z || last.x) && (uv.y < cell.w || last.y);
    if (!here_ || any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0))))
        discard;
    colour = footprint_mean(view_size() / (picture.zw - picture.xy));
}`;

// What one camera adds to a frame through a wide lens: one sample, since many cameras are added, by
// the graphics card's filter.
export const lensShader = () => `${HEAD}${SLAB_WINDOW}${FRAME}${SLAB_LENS}
uniform sampler2DArray views;
uniform float layer;
uniform vec4 st, grid;
uniform vec2 lens;  // radius, disparity in focus
out vec4 colour;
void main()
{
    vec2 at = window_place(vec2(0.0)), uv = slab_uv(at, st);
    if (any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0))))
        discard;
    vec2 from = at + lens.y * (uv - camera) / (st.zw - st.xy) * vec2(1.0, -1.0);
    bool seen = all(greaterThanEqual(from, vec2(0.0))) && all(lessThanEqual(from, vec2(1.0)));
    float w = seen ? slab_lens_weight(clamp(uv, grid.xy, grid.zw), lens.x) : 0.0;
    colour = vec4(w * texture(views, vec3(from, layer)).rgb, w);
}`;

// ---------------------------------------------------------------- panoramas

const LAYOUTS = {
    cylindrical: PANORAMA_LAYOUT + PANORAMA_CYLINDER, discs: PANORAMA_DISCS,
    spherical: PANORAMA_LAYOUT + PANORAMA_SPHERE, cube: CUBE + PANORAMA_LAYOUT + PANORAMA_CUBE,
};

// A look into a panorama.
export const panoramaShader = (layout) => `${HEAD}${FOOTPRINT}${PANORAMA}${LAYOUTS[layout]}
out vec4 colour;
void main()
{
    colour = panorama_mean(vec2(gl_FragCoord.x, look_size.y - gl_FragCoord.y));
}`;

#version 330 core
// A light that stands near: the basis at every pixel's own direction towards it (Wong 1998, Eq. 7.7
// with its sign corrected).
#include "transfer.glsl"
#include "texels.glsl"
#include "shared/cube.glsl"
#include "light/light.glsl"
#include "light/light_patches.glsl"
#include "light/captured.glsl"
#include "light/triangles.glsl"
#include "shared/weight_grid.glsl"

uniform sampler2D surface;     // where the pixel's surface is; alpha 0: nowhere
uniform sampler2DArray grid;   // weights by direction, four coefficients a texel; the last layer
                               // holds the constants; where there are triangles, nodes are a row
uniform int grid_rows, tiles;  // of the grid, below which are tiles; `triangles` then holds the tile
                               // of each cell, and those of each tile's four, 4096 a row

const int JOINT = 1, LUMINANCE = 2;  // else each channel has coefficients of its own
uniform int form;
uniform int coefficients, layers;
uniform sampler2DArray codes;     // four planes a texel
uniform sampler2D affine;         // [layer]: scale, offset
uniform usampler2DArray indices;  // [book]
uniform sampler2DArray vectors;   // [book]: vector v begins at (v mod 64 * layers, v / 64)
uniform int books;                // 0: planes
uniform bool coded;               // display domain
uniform Transfer display;
out vec4 color;

int tile_of(int cell)
{
    return int(texelFetch(triangles, ivec2(cell >> 2 & 1023, cell >> 12), 0)[cell & 3]);
}

// In texels, within the smallest cell around a place in the grid. Twin: cells_find of
// src/relight/light/cells.c.
vec2 cells_find(vec2 place)
{
    int columns = textureSize(grid, 0).x, across = columns / 3;
    ivec2 corner = clamp(ivec2(place), ivec2(0), ivec2(columns, grid_rows) - 2);
    vec2 at = clamp(place - vec2(corner), 0.0, 1.0);
    int cells = (columns - 1) * (grid_rows - 1);
    int tile = tiles > 0 ? tile_of(corner.y * (columns - 1) + corner.x) : -1;
    while (tile >= 0) {
        ivec2 part = ivec2(greaterThanEqual(at, vec2(0.5)));
        at = 2.0 * at - vec2(part);
        corner = part + 3 * ivec2(tile % across, tile / across) + ivec2(0, grid_rows);
        tile = tile_of(cells + 4 * tile + 2 * part.y + part.x);
    }
    return vec2(corner) + at + 0.5;
}

// Where the weights of a direction are: in the grid, or at three nodes.
struct Place {
    vec2 at;
    ivec3 node;
    vec3 share;
};

Place weight_place(vec3 direction)
{
    vec3 d = pole_from_world(direction);
    Place place = Place(vec2(0.0), ivec3(0), vec3(0.0));
    if (triangle_count == 0) {
        vec2 size = vec2(textureSize(grid, 0).xy);
        place.at = cells_find(weight_grid_place(d, ivec2(int(size.x), grid_rows))) / size;
        return place;
    }
    triangles_find(place.node, place.share, d);
    return place;
}

vec4 coefficients_at(ivec2 at, int layer)
{
    if (books == 0)
        return texelFetch(codes, ivec3(at, layer), 0) * texelFetch(affine, ivec2(0, layer), 0) +
               texelFetch(affine, ivec2(1, layer), 0);
    vec4 sum = vec4(0.0);
    for (int b = 0; b < books; b++) {
        int v = int(texelFetch(indices, ivec3(at, b), 0).r);
        sum += texelFetch(vectors, ivec3((v & 63) * layers + layer, v >> 6, b), 0);
    }
    return sum;
}

float plane_at(ivec2 at, int plane)
{
    return coefficients_at(at, plane >> 2)[plane & 3];
}

vec4 weights_at(Place place, int layer)
{
    if (triangle_count == 0)
        return texture(grid, vec3(place.at, float(layer)));
    return place.share.x * texelFetch(grid, ivec3(place.node.x, 0, layer), 0) +
           place.share.y * texelFetch(grid, ivec3(place.node.y, 0, layer), 0) +
           place.share.z * texelFetch(grid, ivec3(place.node.z, 0, layer), 0);
}

// Four coefficients of three channels stand in three layers: r0 g0 b0 r1, g1 b1 r2 g2, b2 r3 g3 b3.
vec3 dot_separate(ivec2 at, Place place)
{
    vec3 sum = vec3(0.0);
    for (int group = 0; 4 * group < coefficients; group++) {
        vec4 w = weights_at(place, group);
        vec4 c0 = coefficients_at(at, 3 * group);
        vec4 c1 = 3 * group + 1 < layers ? coefficients_at(at, 3 * group + 1) : vec4(0.0);
        vec4 c2 = 3 * group + 2 < layers ? coefficients_at(at, 3 * group + 2) : vec4(0.0);
        sum.r += dot(w, vec4(c0.x, c0.w, c1.z, c2.y));
        sum.g += dot(w, vec4(c0.y, c1.x, c1.w, c2.z));
        sum.b += dot(w, vec4(c0.z, c1.y, c2.x, c2.w));
    }
    return sum;
}

vec3 dot_joint(ivec2 at, Place place)
{
    vec3 sum = vec3(0.0);
    for (int i = 0; i < layers; i++) {
        vec4 c = coefficients_at(at, i);
        sum += vec3(dot(c, weights_at(place, 3 * i)), dot(c, weights_at(place, 3 * i + 1)),
                    dot(c, weights_at(place, 3 * i + 2)));
    }
    return sum;
}

vec3 dot_luminance(ivec2 at, Place place)
{
    float sum = 0.0;
    for (int i = 0; 4 * i < coefficients; i++)
        sum += dot(coefficients_at(at, i), weights_at(place, i));
    return sum * vec3(plane_at(at, coefficients), plane_at(at, coefficients + 1),
                      plane_at(at, coefficients + 2));
}

vec3 reflectance(ivec2 at, vec3 towards)
{
    float share;
    Place place = weight_place(captured(towards, share));
    int last = textureSize(grid, 0).z - 1;
    vec3 value = form == JOINT       ? dot_joint(at, place) + weights_at(place, last).rgb
                 : form == LUMINANCE ? dot_luminance(at, place)
                                     : dot_separate(at, place);
    if (!coded)
        return share * value;
    return share * transfer_decode(display, value);
}

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 point = texelFetch(surface, at, 0);
    vec3 sum = vec3(0.0), towards, rgb;
    if (point.a > 0.0 && light.kind != AREA && light_at(towards, rgb, point.xyz))
        sum = rgb * reflectance(at, towards);
    for (int i = 0; point.a > 0.0 && i < patches; i++)
        if (patch_at(towards, rgb, i, point.xyz) && is_captured(towards))
            sum += rgb * reflectance(at, towards);
    color = vec4(sum, 1.0);
}

// near.js - lamps that stand near: each pixel sees them from a direction of its own; after
// viewer/shaders/near.frag.glsl and src/relight/light/near_lights.c
import FACES from '../viewer/shaders/shared/cube.glsl';
import LIGHT from '../viewer/shaders/shared/light.glsl';
import POLE from '../viewer/shaders/shared/pole.glsl';
import TRIANGLE_SHARES from '../viewer/shaders/shared/triangles.glsl';
import WEIGHT_GRID from '../viewer/shaders/shared/weight_grid.glsl';
import { MOST_SIDE, patchSide, patchesOf } from './lights.js';
import { HEAD } from './shaders.js';
import { loadPicture } from './tiles.js';
import { DECODE, guideGain } from './tileshaders.js';

const DOWN = 64;           // rows of the table from the pole to the horizon
const MOST_DEPTH = 4096;   // pixels a side

// Where the way through a pixel leads, as src/image/geometry/camera.c says. The viewer has these
// places from the library.
const RAYS = {
    cylindrical: `
    if (disc > 0.0 && at.y >= size.y - disc) {
        bool lower = at.x >= disc;
        float up = 1.0 - 2.0 * (at.y - size.y + disc) / disc;
        return vec3(2.0 * (at.x - (lower ? disc : 0.0)) / disc - 1.0, lower ? window.x : window.y, lower ? -up : up);
    }
    return vec3(sin(phi), mix(window.y, window.x, at.y / (size.y - disc)), -cos(phi));`,
    spherical: `
    float up = (0.5 - at.y / size.y) * PI;
    return vec3(cos(up) * sin(phi), sin(up), -cos(up) * cos(phi));`,
    cube: `
    int face = clamp(int(at.x / size.y), 0, 5);
    return cube_face_ray(face, vec2(2.0 * (at.x / size.y - float(face)) - 1.0, 1.0 - 2.0 * at.y / size.y));`,
};
const onPlane = `
    vec3 point = vec3(mix(window.x, window.z, at.x / size.x), mix(window.w, window.y, at.y / size.y), plane);
    if (parallel > 0.5)
        eye.xy = point.xy;
    return point - eye;`;

// What a lamp sends to a point, and where light from a direction is taken from.
export const ARRIVING = `${LIGHT}${POLE}${WEIGHT_GRID}
uniform vec3 lamp_axis;
uniform float half_angle; // of a spot, radians; 0: a point
uniform bool falls, is_patch;
uniform sampler2D taken;  // by direction: where light from there is taken from, and the share that is shown
bool sends(out vec3 towards, out float sent, vec3 from, vec3 point)
{
    float away;
    bool arrives = ray_to(towards, away, from, point);
    sent = falls ? 1.0 / (away * away) : 1.0;
    if (half_angle > 0.0)
        sent *= spot_factor(-towards, lamp_axis, half_angle);
    if (is_patch)
        sent = is_captured(towards) ? sent * max(-dot(towards, lamp_axis), 0.0) : 0.0;
    return arrives;
}
vec2 table_place(vec3 towards)
{
    ivec2 size = textureSize(taken, 0);
    return (weight_grid_place(pole_from_world(towards), size) + 0.5) / vec2(size);
}
`;

// The triangle of captured lights around a direction, of all; the viewer goes from one to the next
// (viewer/shaders/light/triangles.glsl).
export const TRIANGLES = `${TRIANGLE_SHARES}
uniform sampler2D triangles;  // rows of a corner each: of the inverse, and its light
uniform int triangleCount;
void triangles_find(out ivec3 node, out vec3 share, vec3 d)
{
    vec3 corner = vec3(-1.0);
    float best = -1e30;
    for (int t = 0; t < triangleCount && best < -1e-6; t++) {
        vec4 row[3] = vec4[3](texelFetch(triangles, ivec2(0, t), 0), texelFetch(triangles, ivec2(1, t), 0), texelFetch(triangles, ivec2(2, t), 0));
        vec3 found = vec3(dot(row[0].xyz, d), dot(row[1].xyz, d), dot(row[2].xyz, d));
        float least = min(found.x, min(found.y, found.z));
        if (least > best) {
            best = least;
            share = found;
            corner = vec3(row[0].w, row[1].w, row[2].w);
        }
    }
    triangle_shares(node, share, corner);
}
`;

// One lamp on one tile. The table has, by direction, three planes a texel: layers of red, green and
// blue for each layer of codes, then the constants, then, with a guide, what is added to the sum.
// `between`: it has them by captured light, between which light is blended.
const nearShader = (layers, guide, projection, between) => `${HEAD}${DECODE}
uniform sampler2DArray codes;
uniform sampler2DArray table;
uniform sampler2D depth;
uniform vec4 window;     // of the picture on its plane: left, bottom, right, top; of a cylinder v_min, v_max
uniform vec2 size;       // pixels of the picture
uniform vec3 tile;       // its left and top, pixels; pixels a texel
uniform vec2 inverse;    // 1 / depth of the first code, and a step; a step of 0: the surface is the plane
uniform vec3 from;       // the eye
uniform float plane, parallel, disc;
uniform vec3 lamp, colour;
out vec4 light;
${ARRIVING}${projection === 'cube' ? FACES : ''}
vec3 ray_of(inout vec3 eye, vec2 at)
{
    float phi = (2.0 * at.x / size.x - 1.0) * PI;${RAYS[projection] || onPlane}
}
bool surface_at(out vec3 point)
{
    vec2 at = tile.xy + tile.z * gl_FragCoord.xy;
    vec3 eye = from, ray = ray_of(eye, at);
    point = eye + ray;
    if (inverse.y == 0.0)
        return true;
    ivec2 most = textureSize(depth, 0) - 1;
    vec2 found = texelFetch(depth, clamp(ivec2(at / size * vec2(most + 1)), ivec2(0), most), 0).rg;
    float code = floor(255.0 * found.r + 0.5) * 256.0 + floor(255.0 * found.g + 0.5);
    point = eye + normalize(ray) / (inverse.x + (code - 1.0) * inverse.y);
    return code > 0.0;
}

${between ? TRIANGLES : ''}
vec3 value_at(vec2 at)
{
    vec3 value = ${guide ? `texture(table, vec3(at, float(${3 * layers + 1}))).rgb` : 'vec3(0.0)'};
    float gain = 1.0;
    for (int j = 0; j < ${layers}; j++) {
        vec3 code = texelFetch(codes, ivec3(gl_FragCoord.xy, j), 0).rgb;
        if (j == 0)
            gain = ${guideGain(guide, 'code.r')};
        value += vec3(dot(code, texture(table, vec3(at, float(3 * j))).rgb),
                      dot(code, texture(table, vec3(at, float(3 * j + 1))).rgb),
                      dot(code, texture(table, vec3(at, float(3 * j + 2))).rgb));
    }
    return transfer_decode(display, texture(table, vec3(at, float(${3 * layers}))).rgb + gain * value);
}

void main()
{
    vec3 point, towards;
    float sent;
    light = vec4(0.0, 0.0, 0.0, 1.0);
    if (!surface_at(point) || !sends(towards, sent, lamp, point))
        return;
    vec2 at = table_place(towards);
    vec4 from = texture(taken, at);
    ${between ? `vec3 value = vec3(0.0), share;
    ivec3 node;
    triangles_find(node, share, pole_from_world(from.xyz));
    for (int i = 0; i < 3; i++)
        value += share[i] > 0.0 ? share[i] * value_at((vec2(node[i], 0) + 0.5) / vec2(textureSize(table, 0).xy)) : vec3(0.0);` : 'vec3 value = value_at(at);'}
    light = vec4(sent * from.a * colour * value, 1.0);
}`;

// Directions of a table's rows and columns. Twin: node_direction.
function nodeDirection(row, column, columns, rows, poleY) {
    const below = row > DOWN, t = (below ? rows - 1 - row : row) / DOWN, theta = 0.5 * Math.PI * (2 * t - t * t);
    const phi = 2 * Math.PI * column / (columns - 1) - Math.PI, height = t === 1 ? 1e-12 : Math.cos(theta), r = Math.sin(theta);
    const d = [r * Math.cos(phi), r * Math.sin(phi), below ? -height : height];
    return poleY ? [d[1], d[2], -d[0]] : d;
}

export class NearLamps {
    constructor(device, published, basis, told) {
        Object.assign(this, { device, published, basis, told, table: null, taken: null, triangles: null, depths: new Map(), between: published.between === 'linear' });
    }

    // Weights of one column and row of a table, as Relighter.block has them for one.
    putWeights(texels, i, size, weights) {
        const { planes, layers, scale, offset, guide } = this.published, layer = 4 * size;
        for (let c = 0; c < 3; c++) {
            let added = 0;
            for (let k = 0; k < planes; k++) {
                const w = weights[c * (planes + 1) + k];
                added += w * offset[k];
                texels[layer * (3 * Math.floor(k / 3) + c) + 4 * i + k % 3] = 255 * w * scale[k];
            }
            texels[layer * 3 * layers + 4 * i + c] = weights[c * (planes + 1) + planes] + (guide ? 0 : added);
            if (guide)
                texels[layer * (3 * layers + 1) + 4 * i + c] = added;
        }
    }

    // What directions are to the file: tables of weights, and of where light is taken from.
    makeTables() {
        const { published, basis } = this, { hemispherical, pole, lights } = published.basis, depth = 3 * published.layers + (published.guide ? 2 : 1);
        const rows = hemispherical ? DOWN + 1 : 2 * DOWN + 2, columns = 4 * DOWN + 1, n = rows * columns, captured = lights.length / 3;
        const size = this.between ? captured : n, texels = new Float32Array(4 * size * depth), taken = new Float32Array(4 * n);
        for (let i = 0; i < n; i++) {
            const { share, from, weights } = basis.weights(nodeDirection(Math.floor(i / columns), i % columns, columns, rows, pole === 'y'));
            taken.set([...from, share], 4 * i);
            if (!this.between)
                this.putWeights(texels, i, n, weights);
        }
        for (let i = 0; this.between && i < captured; i++)
            this.putWeights(texels, i, captured, basis.weights(lights.slice(3 * i, 3 * i + 3)).weights);
        this.taken = this.upload(columns, rows, taken);
        this.table = this.upload(...(this.between ? [captured, 1] : [columns, rows]), texels, depth);
    }

    upload(width, height, texels, depth) {
        const { gl } = this.device, kind = depth ? gl.TEXTURE_2D_ARRAY : gl.TEXTURE_2D, texture = this.device.texture(gl.LINEAR, kind);
        if (depth) {
            gl.texStorage3D(kind, 1, gl.RGBA16F, width, height, depth);
            gl.texSubImage3D(kind, 0, 0, 0, 0, width, height, depth, gl.RGBA, gl.FLOAT, texels);
        } else {
            gl.texStorage2D(kind, 1, gl.RGBA16F, width, height);
            gl.texSubImage2D(kind, 0, 0, 0, width, height, gl.RGBA, gl.FLOAT, texels);
        }
        return texture;
    }

    // Uniforms of the triangles of captured lights.
    triangleSet() {
        if (!this.triangles) {
            const { gl } = this.device, found = this.basis.pictures({ interpolant: 'delaunay' }).triangles(), n = found.length / 12;
            const texels = new Float32Array(12 * Math.max(n, 1));
            for (let t = 0; t < n; t++)
                for (let i = 0; i < 3; i++)
                    texels.set([...found.subarray(12 * t + 3 + 3 * i, 12 * t + 6 + 3 * i), found[12 * t + i]], 12 * t + 4 * i);
            this.triangles = this.device.texture(gl.NEAREST);
            this.triangleCount = n;
            gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, 3, Math.max(n, 1));
            gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, 3, Math.max(n, 1), gl.RGBA, gl.FLOAT, texels);
        }
        return { triangles: { texture: this.triangles }, triangleCount: { int: this.triangleCount } };
    }

    // Uniforms of what a lamp sends.
    sent(lamp) {
        const { hemispherical, pole } = this.published.basis;
        return { taken: { texture: this.taken }, hemisphere: hemispherical ? 1 : 0, pole_y: pole === 'y' ? 1 : 0, lamp_axis: lamp.axis || [0, 0, -1],
                 half_angle: lamp.half || 0, falls: lamp.nofall ? 0 : 1, is_patch: lamp.kind === 'patch' ? 1 : 0 };
    }

    async loadDepth(view) {
        const { gl } = this.device, { width, height } = this.published, picture = await loadPicture(this.published, view, false);
        const scale = Math.min(1, MOST_DEPTH / Math.max(width, height)), texture = this.device.texture(gl.NEAREST);
        const small = scale === 1 ? picture : await createImageBitmap(picture, { resizeWidth: Math.max(1, Math.round(width * scale)),
            resizeHeight: Math.max(1, Math.round(height * scale)), resizeQuality: 'pixelated', premultiplyAlpha: 'none', colorSpaceConversion: 'none' });
        gl.bindTexture(gl.TEXTURE_2D, texture);
        gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, false);
        gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, small);
        this.depths.set(view.name, texture);
        this.told.changed();
    }

    // Whether lamps can be shown in a view now; where its surface is loads by and by.
    ready(name) {
        const view = this.published.views.find((v) => v.name === name);
        if (!this.table)
            this.makeTables();
        if (view.depth && !this.depths.has(name)) {
            this.depths.set(name, null);
            this.loadDepth(view).catch(this.told.failed);
        }
        return !view.depth || !!this.depths.get(name);
    }

    // Adds near lights to a tile's, whose shadows `moving` moves, if anything does.
    addAll(target, tile, lights, moving) {
        for (const light of lights) {
            const draw = (into) => this.lampsOf(light).forEach((lamp) => this.add(into, tile, lamp));
            if (moving && !moving.gloss)
                moving.addNear(target, tile, light, this, draw);
            else
                draw(target);
        }
    }

    // The lamps that a near light comes to.
    lampsOf(light) {
        return light.kind !== 'panel' ? [light] : patchesOf(light, this.published.window ? patchSide(light, this.published.window) : MOST_SIDE);
    }

    // How the file is seen by a view: uniforms.
    seenBy(view) {
        const { window: w, slab, panorama } = this.published;
        if (w)
            return { window: [...w.min, ...w.max], from: [0, 0, w.camera_z], plane: 0, parallel: w.camera === 'perspective' ? 0 : 1 };
        if (slab)
            return { window: [...slab.st_min, ...slab.st_max], from: [...view.uv, slab.uv_plane_z], plane: slab.st_plane_z, parallel: 0 };
        return { window: [panorama.v_min || 0, panorama.v_max || 0, 0, 0], from: panorama.center, disc: panorama.discs || 0 };
    }

    // Adds a lamp's light to a tile's.
    add(target, tile, lamp) {
        const { published, device } = this, { layers, guide, projection } = published, step = 2 ** tile.level, view = published.views.find((v) => v.name === tile.view);
        const program = device.program(`near ${layers} ${guide} ${projection} ${this.between}`, () => nearShader(layers, guide, projection, this.between));
        device.begin(target, { clear: false, add: 'rgb' });
        program.set({
            codes: { texture: tile.codes, array: true }, table: { texture: this.table, array: true }, depth: { texture: this.depths.get(view.name) || null },
            ...this.seenBy(view), size: [published.width, published.height],
            tile: [tile.x * published.tile * step, tile.y * published.tile * step, step],
            inverse: view.depth ? [view.depth_min, view.depth_step] : [0, 0],
            'display.curve': { int: published.curve }, 'display.gamma': published.gamma, lamp: lamp.position, colour: lamp.rgb, ...this.sent(lamp), ...(this.between ? this.triangleSet() : {}),
        });
        program.draw([0, 0, 1, 1]);
    }

    close() {
        [this.table, this.taken, this.triangles].forEach((texture) => this.device.gl.deleteTexture(texture));
        this.depths.forEach((texture) => this.device.gl.deleteTexture(texture));
    }
}

// near.js - lamps that stand near a flat picture: each pixel sees them from a direction of its own;
// after viewer/shaders/near.frag.glsl and src/relight/near_lights.c
import { patchesOf } from './lights.js';
import { DECODE, HEAD } from './shaders.js';
import { decodePicture } from './tiles.js';
import { loadBytes } from './load.js';

const DOWN = 64;           // rows of the table from the pole to the horizon
const MOST_DEPTH = 4096;   // pixels a side

// One lamp on one tile. The table has, by direction, three planes a texel: layers of red, green and
// blue for each layer of codes, then the constants and the share that is shown.
const nearShader = (layers) => `${HEAD}${DECODE}
uniform sampler2DArray codes;
uniform sampler2DArray table;
uniform sampler2D depth;
uniform vec4 window;     // of the picture on z = 0: left, bottom, right, top
uniform vec2 size;       // pixels of the picture
uniform vec3 tile;       // its left and top, pixels; pixels a texel
uniform vec2 inverse;    // 1 / depth of the first code, and a step; a step of 0: the surface is z = 0
uniform float camera;    // height of the eye
uniform float perspective, hemisphere, poleY;
uniform vec3 lamp, axis, colour;
uniform float halfAngle; // of a spot, radians; 0: a point
uniform float fall, patch_;
out vec4 light;
const float PI = 3.14159265358979;

bool surface_at(out vec3 point)
{
    vec2 at = tile.xy + tile.z * gl_FragCoord.xy;
    point = vec3(mix(window.x, window.z, at.x / size.x), mix(window.w, window.y, at.y / size.y), 0.0);
    if (inverse.y == 0.0)
        return true;
    ivec2 most = textureSize(depth, 0) - 1;
    vec2 found = texelFetch(depth, clamp(ivec2(at / size * vec2(most + 1)), ivec2(0), most), 0).rg;
    float code = floor(255.0 * found.r + 0.5) * 256.0 + floor(255.0 * found.g + 0.5);
    float away = 1.0 / (inverse.x + (code - 1.0) * inverse.y);
    vec3 eye = vec3(perspective > 0.5 ? vec2(0.0) : point.xy, camera);
    point = eye + away * normalize(point - eye);
    return code > 0.0;
}

// Twin: relume_weight_grid_place.
vec2 table_place(vec3 world)
{
    vec3 d = poleY > 0.5 ? vec3(-world.z, world.x, world.y) : world;
    vec2 whole = vec2(textureSize(table, 0).xy);
    float rows = hemisphere > 0.5 ? whole.y : 0.5 * whole.y;
    bool below = d.z < 0.0;
    float theta = atan(length(d.xy), below && hemisphere > 0.5 ? 0.0 : abs(d.z));
    float row = (rows - 1.0) * (1.0 - sqrt(max(1.0 - theta / (0.5 * PI), 0.0)));
    float column = (atan(d.y, d.x) / (2.0 * PI) + 0.5) * (whole.x - 1.0);
    return (vec2(column, below && hemisphere < 0.5 ? whole.y - 1.0 - row : row) + 0.5) / whole;
}

void main()
{
    vec3 point;
    light = vec4(0.0, 0.0, 0.0, 1.0);
    if (!surface_at(point))
        return;
    vec3 towards = lamp - point;
    float away = length(towards);
    if (away < 1e-6)
        return;
    towards /= away;
    float sent = fall > 0.5 ? 1.0 / (away * away) : 1.0;
    if (halfAngle > 0.0)
        sent *= 1.0 - smoothstep(0.9 * halfAngle, halfAngle, atan(length(cross(towards, axis)), -dot(towards, axis)));
    if (patch_ > 0.5)
        sent = hemisphere > 0.5 && (poleY > 0.5 ? towards.y : towards.z) < 0.0 ? 0.0 : sent * max(-dot(towards, axis), 0.0);
    vec2 at = table_place(towards);
    vec4 constant = texture(table, vec3(at, float(${3 * layers})));
    vec3 value = constant.rgb;
    for (int j = 0; j < ${layers}; j++) {
        vec3 code = texelFetch(codes, ivec3(gl_FragCoord.xy, j), 0).rgb;
        value += vec3(dot(code, texture(table, vec3(at, float(3 * j))).rgb),
                      dot(code, texture(table, vec3(at, float(3 * j + 1))).rgb),
                      dot(code, texture(table, vec3(at, float(3 * j + 2))).rgb));
    }
    light = vec4(sent * constant.a * colour * decode(value), 1.0);
}`;

// Directions of a table's rows and columns; twin of node_direction of src/relight/directions.c.
function nodeDirection(row, column, columns, rows, poleY) {
    const below = row > DOWN, t = (below ? rows - 1 - row : row) / DOWN, theta = 0.5 * Math.PI * (2 * t - t * t);
    const phi = 2 * Math.PI * column / (columns - 1) - Math.PI, height = t === 1 ? 1e-12 : Math.cos(theta), r = Math.sin(theta);
    const d = [r * Math.cos(phi), r * Math.sin(phi), below ? -height : height];
    return poleY ? [d[1], d[2], -d[0]] : d;
}

export class NearLamps {
    constructor(device, scene, basis, told) {
        Object.assign(this, { device, scene, basis, told, table: null, depth: null });
    }

    // Weights by direction, as Relighter.block has them for one.
    makeTable() {
        const { gl } = this.device, { scene, basis } = this, { planes, layers, scale, offset } = scene;
        const { hemispherical, pole } = scene.basis, rows = hemispherical ? DOWN + 1 : 2 * DOWN + 2, columns = 4 * DOWN + 1;
        const texels = new Float32Array(4 * rows * columns * (3 * layers + 1)), layer = 4 * rows * columns;
        for (let i = 0; i < rows * columns; i++) {
            const { share, weights } = basis.weights(nodeDirection(Math.floor(i / columns), i % columns, columns, rows, pole === 'y'));
            for (let c = 0; c < 3; c++) {
                let constant = weights[c * (planes + 1) + planes];
                for (let k = 0; k < planes; k++) {
                    const w = weights[c * (planes + 1) + k];
                    constant += w * offset[k];
                    texels[layer * (3 * Math.floor(k / 3) + c) + 4 * i + k % 3] = 255 * w * scale[k];
                }
                texels[layer * 3 * layers + 4 * i + c] = constant;
            }
            texels[layer * 3 * layers + 4 * i + 3] = share;
        }
        const texture = this.device.texture(gl.LINEAR, gl.TEXTURE_2D_ARRAY);
        gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, gl.RGBA16F, columns, rows, 3 * layers + 1);
        gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, 0, columns, rows, 3 * layers + 1, gl.RGBA, gl.FLOAT, texels);
        return texture;
    }

    async loadDepth(view) {
        const { gl } = this.device, { width, height } = this.scene, scale = Math.min(1, MOST_DEPTH / Math.max(width, height));
        const bytes = await loadBytes(`${this.scene.base}${view.name}/depth.png`);
        const picture = await decodePicture(bytes, 'image/png', scale < 1 ? {
            resizeWidth: Math.max(1, Math.round(width * scale)), resizeHeight: Math.max(1, Math.round(height * scale)), resizeQuality: 'pixelated' } : {});
        const texture = this.device.texture(gl.NEAREST);
        gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, false);
        gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, picture);
        picture.close();
        this.depth = texture;
        this.told.changed();
    }

    // Whether lamps can be shown now; where the surface is loads by and by.
    ready() {
        const [view] = this.scene.views;
        this.table = this.table || this.makeTable();
        if (view.depth && !this.loading) {
            this.loading = true;
            this.loadDepth(view).catch(this.told.failed);
        }
        return !view.depth || !!this.depth;
    }

    // Adds near lights to a tile's.
    addAll(target, tile, lights) {
        lights.flatMap((light) => (light.kind === 'panel' ? patchesOf(light, this.scene.window) : [light]))
            .forEach((lamp) => this.add(target, tile, lamp));
    }

    // Adds a lamp's light to a tile's.
    add(target, tile, lamp) {
        const { scene, device } = this, { window: w, layers } = scene, [view] = scene.views, step = 2 ** tile.level;
        const program = device.program(`near ${layers}`, () => nearShader(layers));
        device.begin(target, { clear: false, add: 'rgb' });
        program.set({
            codes: { texture: tile.codes, array: true }, table: { texture: this.table, array: true }, depth: { texture: this.depth },
            window: [w.min[0], w.min[1], w.max[0], w.max[1]], size: [scene.width, scene.height],
            tile: [tile.x * scene.tile * step, tile.y * scene.tile * step, step],
            inverse: view.depth ? [view.depth_min, view.depth_step] : [0, 0], camera: w.camera_z, perspective: w.camera === 'perspective' ? 1 : 0,
            hemisphere: scene.basis.hemispherical ? 1 : 0, poleY: scene.basis.pole === 'y' ? 1 : 0, curve: { int: scene.curve }, gamma: scene.gamma,
            lamp: lamp.position, axis: lamp.axis || [0, 0, -1], colour: lamp.rgb, halfAngle: lamp.half || 0, fall: lamp.nofall ? 0 : 1, patch_: lamp.kind === 'patch' ? 1 : 0,
        });
        program.draw([0, 0, 1, 1]);
    }

    close() {
        this.device.gl.deleteTexture(this.table);
        this.device.gl.deleteTexture(this.depth);
    }
}

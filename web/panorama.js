// panorama.js - looking around in a panorama; after src/relight/view/panorama.c
import { RADIANS, unit } from './lights.js';
import { levelFor } from './paint.js';
import { panoramaShader } from './viewshaders.js';


const FACES = [  // of a cube: ahead, right, up
    [[1, 0, 0], [0, 0, 1], [0, 1, 0]], [[-1, 0, 0], [0, 0, -1], [0, 1, 0]], [[0, 1, 0], [1, 0, 0], [0, 0, 1]],
    [[0, -1, 0], [1, 0, 0], [0, 0, -1]], [[0, 0, 1], [-1, 0, 0], [0, 1, 0]], [[0, 0, -1], [1, 0, 0], [0, 1, 0]],
];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

const discsOf = (published) => (published.projection === 'cylindrical' && published.panorama.discs) || 0;

// The end discs of a cylinder lie in squares below it, the upper one first; as src/relight/view/panorama_discs.c.
function discRay(published, x, y) {
    const side = discsOf(published), lower = x >= side, { v_min, v_max } = published.panorama;
    const right = 2 * (lower ? x - side : x) / side - 1, up = 1 - 2 * y / side;
    return [right, lower ? v_min : v_max, lower ? -up : up];
}

function discPixel(published, d) {
    const side = discsOf(published), lower = d[1] < 0, scale = (lower ? published.panorama.v_min : published.panorama.v_max) / d[1];
    const at = [0.5 + 0.5 * scale * d[0], 0.5 - 0.5 * scale * (lower ? -d[2] : d[2])].map((v) => Math.min(Math.max(v, 0), 1) * side);
    return [at[0] + (lower ? side : 0), at[1] + published.height - side];
}

// The direction that a place of the unfolded picture looks along; any length.
function rayOf(published, x, y) {
    const { width, projection, panorama } = published, height = published.height - discsOf(published), phi = (2 * x / width - 1) * Math.PI;
    if (projection === 'cube') {
        const face = Math.min(Math.max(Math.floor(x / height), 0), 5), [ahead, right, up] = FACES[face];
        const a = 2 * (x - face * height) / height - 1, b = 1 - 2 * y / height;
        return ahead.map((v, i) => v + a * right[i] + b * up[i]);
    }
    if (discsOf(published) && y >= height)
        return discRay(published, x, y - height);
    if (projection === 'cylindrical')
        return [Math.sin(phi), panorama.v_max - y / height * (panorama.v_max - panorama.v_min), -Math.cos(phi)];
    const elevation = (0.5 - y / height) * Math.PI;
    return [Math.cos(elevation) * Math.sin(phi), Math.sin(elevation), -Math.cos(elevation) * Math.cos(phi)];
}

// Its inverse.
function pixelOf(published, d) {
    const { width, projection, panorama } = published, height = published.height - discsOf(published), across = Math.hypot(d[0], d[2]);
    const column = (Math.atan2(d[0], -d[2]) / Math.PI + 1) / 2 * width;
    if (projection === 'cube') {
        const face = FACES.reduce((best, [ahead], i) => (dot(d, ahead) > dot(d, FACES[best][0]) ? i : best), 0);
        const [ahead, right, up] = FACES[face], k = 1 / dot(d, ahead);
        return [(face + 0.5 + 0.5 * k * dot(d, right)) * height, (0.5 - 0.5 * k * dot(d, up)) * height];
    }
    const h = d[1] / across;
    if (discsOf(published) && !(h >= panorama.v_min && h <= panorama.v_max))
        return discPixel(published, d);
    if (projection === 'cylindrical')
        return [column, (panorama.v_max - h) / (panorama.v_max - panorama.v_min) * height];
    return [column, (0.5 - Math.atan2(d[1], across) / Math.PI) * height];
}

// As toCanvas below has it, of directions.
const PIN_WAY = `
uniform vec2 size, pan, tilt;  // cosines and sines
uniform float zoom, planet;
vec3 project(vec3 d)
{
    float right = d.x * pan.x + d.z * pan.y, level = d.x * pan.y - d.z * pan.x;
    float ahead = level * tilt.x + d.y * tilt.y, up = d.y * tilt.x - level * tilt.y, depth = planet + ahead;
    return vec3(0.5 * size + vec2(right, -up) * zoom * 0.5 * size.x / depth, depth > 1e-3 ? depth : 0.0);
}
bool hides(vec3 at)
{
    return false;
}`;

export class Panorama {
    constructor(published, painter, device) {
        Object.assign(this, { published, painter, device });
        this.level = -1;
        this.whole = {};
        this.discs = discsOf(published);  // rows below the cylinder
        this.layout = this.discs ? 'discs' : published.projection;
    }

    // The picture as large as the look needs it, and as textures may be.
    setLevel(target, camera) {
        const { published } = this, { gl } = this.device, most = gl.getParameter(gl.MAX_TEXTURE_SIZE);
        const around = published.projection === 'cube' ? published.width * 2 / 3 : published.width;
        const needed = target.width * camera.zoom * Math.PI / (camera.planet ? 2 : 1);  // pixels around
        let level = Math.min(levelFor(published, needed / around) + camera.coarser, published.levels.length - 1);
        while (published.levels[level].width > Math.min(most, 8192) && level + 1 < published.levels.length)
            level++;
        if (level === this.level)
            return;
        this.close();
        this.level = level;
    }

    // A look's way through a place of the frame, null where the picture ends before; and the place of a direction;
    // as the shader has them.
    toPicture([x, y], camera, width, height) {
        const a = (2 * x / width - 1) / camera.zoom, b = (height - 2 * y) / width / camera.zoom;
        const [pan, tilt] = [camera.pan * RADIANS, camera.tilt * RADIANS];
        const depth = camera.planet ? 0.5 * (1 - a * a - b * b) : 1;
        const up = b * Math.cos(tilt) + depth * Math.sin(tilt), ahead = depth * Math.cos(tilt) - b * Math.sin(tilt);
        const at = pixelOf(this.published, [a * Math.cos(pan) + ahead * Math.sin(pan), up, a * Math.sin(pan) - ahead * Math.cos(pan)]);
        return at[1] >= 0 && at[1] <= this.published.height ? at : null;
    }

    get pinWay() { return PIN_WAY; }

    directionOf([x, y]) { return unit(rayOf(this.published, x, y)); }

    pinValues({ pan, tilt, zoom, planet }) {
        const turned = (degrees) => [Math.cos(degrees * RADIANS), Math.sin(degrees * RADIANS)];
        return { pan: turned(pan), tilt: turned(tilt), zoom, planet: planet ? 1 : 0 };
    }

    toCanvas([x, y], camera, width, height) {
        const d = unit(rayOf(this.published, x, y)), [pan, tilt] = [camera.pan * RADIANS, camera.tilt * RADIANS];
        const right = d[0] * Math.cos(pan) + d[2] * Math.sin(pan), level = d[0] * Math.sin(pan) - d[2] * Math.cos(pan);
        const ahead = level * Math.cos(tilt) + d[1] * Math.sin(tilt), up = d[1] * Math.cos(tilt) - level * Math.sin(tilt);
        const depth = camera.planet ? 1 + ahead : ahead, k = camera.zoom * width / 2 / depth;
        return depth > 1e-3 ? [width / 2 + right * k, height / 2 - up * k] : null;
    }

    draw(target, kind, camera) {
        const { published } = this;
        this.setLevel(target, camera);
        const { width, height } = published.levels[this.level];
        const whole = this.whole[kind] = this.whole[kind] || { ...this.device.target(width, height), cache: {} };
        this.painter.paint(whole, published.views[0], kind, this.level, { scale: 2 ** -this.level, left: 0, top: 0, flip: true, cache: whole.cache },
                           [0, 0, published.width, published.height]);
        const program = this.device.program(`panorama ${this.layout}`, () => panoramaShader(this.layout));
        this.device.begin(target);
        program.set({ ...(this.discs ? { disc: this.discs * 2 ** -this.level } : {}), view: { texture: whole.texture }, look_size: [target.width, target.height], stereographic: camera.planet ? 1 : 0,
                      look: [camera.pan * RADIANS, camera.tilt * RADIANS, 1 / camera.zoom],
                      elevation: published.panorama ? [published.panorama.v_min || 0, published.panorama.v_max || 0] : [0, 0] });
        program.draw();
    }

    close() {
        Object.values(this.whole).forEach((target) => this.device.drop(target));
        this.whole = {};
    }
}

// moving.js - shadows and highlights that move between the captured lights; after src/relight/shadow and
// viewer/relit/moving.c
//
// A view's model is eight numbers a pixel (src/site/publish/moving.h), its stage what rays meet: its depth.
import { Failure, loadBytes } from './load.js';
import { Recent } from './recent.js';
import { decodePicture, loadPicture, partsOf } from './tiles.js';
import { pixelsOf } from './views.js';
import { patchesOf } from './lights.js';
import { glossShader, nearShadowShader, shadowShader, traceShader } from './movingshaders.js';

const NUMBERS = 8, GLOSS_SHINE = 6;
const LEAST_WEIGHT = 1e-4, PHOTOGRAPH = 0.9999, AROUND = 4;  // as src/relight/shadow/around.c
const [PARALLEL, EYE, CYLINDER, SPHERE] = [0, 1, 2, 3];
const PATCHES = 4;  // a side of near areas, as src/relight/shadow/shadows.c
const TILE = 8, MARGIN = 2, DEEPEST = 16, BACKGROUND = 1e30;  // as src/relight/shadow/stage.c
const MOST_STAGES = 16, MOST_STAGE_BYTES = 384 << 20, MOST_REACHED_BYTES = 128 << 20;

// ---------------------------------------------------------------- what moves

// Codes of pictures to numbers.
function modelOf(pictures, { scale, offset }, gloss) {
    const { width, height } = pictures[0], n = width * height, out = new Float32Array(NUMBERS * n);
    const root = (x) => x * Math.abs(x), apart = (x) => Math.sign(x) * Math.max(Math.abs(x) - 0.125, 0) ** 2, same = (x) => x;
    for (let k = 0; k < NUMBERS; k++) {
        const thick = !gloss && k === 0, curve = thick ? (x) => 2 ** x : !gloss || k < 3 ? root : k === GLOSS_SHINE ? apart : same;
        const table = Float32Array.from({ length: 256 }, (_, code) => (thick && code > 247 ? BACKGROUND : curve(code * scale[k] + offset[k])));
        const { data } = pictures[Math.floor(k / 3)];
        for (let i = 0; i < n; i++)
            out[NUMBERS * i + k] = table[data[4 * i + k % 3]];
    }
    return out;
}

// How rays lie in a view's coordinates. Twin: set_up of src/relight/shadow/stage.c.
function raysOf(published, view) {
    const { width, height, projection, window: w, slab, panorama } = published;
    const through = (min, max, u, v, distance, rays, eye) => {
        const scale = [Math.abs(distance) * width / (max[0] - min[0]), -Math.abs(distance) * height / (max[1] - min[1])];
        return { rays, eye, axis: distance > 0 ? -1 : 1, scale, pixel: 1 / Math.max(scale[0], -scale[1]),
                 shift: [(u - min[0]) * width / (max[0] - min[0]), (max[1] - v) * height / (max[1] - min[1])] };
    };
    if (projection === 'slab')
        return through(slab.st_min, slab.st_max, ...view.uv, slab.uv_plane_z - slab.st_plane_z, EYE, [...view.uv, slab.uv_plane_z]);
    if (projection === 'planar')
        return w.camera === 'perspective' ? through(w.min, w.max, 0, 0, w.camera_z, EYE, [0, 0, w.camera_z])
            : through(w.min, w.max, 0, 0, 1, PARALLEL, [0, 0, 0]);
    const cylinder = projection === 'cylindrical', down = cylinder ? height / (panorama.v_min - panorama.v_max) : -height / Math.PI;
    return { rays: cylinder ? CYLINDER : SPHERE, eye: panorama.center, axis: -1, scale: [width / (2 * Math.PI), down],
             shift: [width / 2, cylinder ? -panorama.v_max * down : height / 2], pixel: 2 * Math.PI / width };
}

// Rays through the middles of pixels, [x, y, z]; of parallel ones where they start.
function rayThrough(stage) {
    const { rays, scale, shift, axis } = stage, at = (i, k) => (i + 0.5 - shift[k]) / scale[k];
    if (rays === CYLINDER)
        return (x, y) => [Math.sin(at(x, 0)), at(y, 1), -Math.cos(at(x, 0))];
    if (rays === SPHERE)
        return (x, y) => [Math.sin(at(x, 0)) * Math.cos(at(y, 1)), Math.sin(at(y, 1)), -Math.cos(at(x, 0)) * Math.cos(at(y, 1))];
    return (x, y) => [at(x, 0), at(y, 1), rays === EYE ? axis : 0];
}

// How far the surface is, what is around it. Twin: stage_create.
function surfaceOf(stage, { width, height, data }, view, cameraZ) {
    const flat = stage.rays === PARALLEL, far = new Float32Array(width * height), ray = rayThrough(stage);
    let nearest = Infinity;
    for (let y = 0, i = 0; y < height; y++)
        for (let x = 0; x < width; x++, i++) {
            const code = 256 * data[4 * i] + data[4 * i + 1], depth = 1 / (view.depth_min + (code - 1) * view.depth_step);
            far[i] = !code ? BACKGROUND : flat ? depth - cameraZ : depth / Math.hypot(...ray(x, y));
            if (code && (flat || far[i] > 0))
                nearest = Math.min(nearest, far[i]);
        }
    const deepest = flat ? nearest + DEEPEST * Math.max(width, height) * stage.pixel : BACKGROUND;
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let y = 0, i = 0; y < height; y++)
        for (let x = 0; x < width; x++, i++) {
            if (!(far[i] <= deepest) || far[i] === BACKGROUND) {
                far[i] = BACKGROUND;
                continue;
            }
            const r = ray(x, y), margin = MARGIN * (flat ? stage.pixel : Math.max(stage.pixel * far[i], 0));
            const point = flat ? [r[0], r[1], -far[i]] : [far[i] * r[0], far[i] * r[1], far[i] * r[2]];
            for (let c = 0; c < 3; c++) {
                low[c] = Math.min(low[c], point[c] - margin);
                high[c] = Math.max(high[c], point[c] + margin);
            }
        }
    const large = Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
    return { far, low, high, leastSide: stage.pixel * Math.max(nearest / 8, 1e-6 * large) };
}

// Nearest and farthest of the pixels around each corner, and what is nearest in a tile or beside it.
function spansOf(far, width, height, closes) {
    const column = (x) => (closes ? (x + width) % width : Math.min(Math.max(x, 0), width - 1)), row = (y) => Math.min(Math.max(y, 0), height - 1) * width;
    const span = new Float32Array(2 * (width + 1) * (height + 1));
    for (let y = 0, i = 0; y <= height; y++)
        for (let x = 0; x <= width; x++) {
            const a = far[row(y) + column(x)], b = far[row(y) + column(x - 1)], c = far[row(y - 1) + column(x)], d = far[row(y - 1) + column(x - 1)];
            span[i++] = Math.min(a, b, c, d);
            span[i++] = Math.max(a, b, c, d);
        }
    const columns = Math.ceil(width / TILE), rows = Math.ceil(height / TILE), front = new Float32Array(columns * rows);
    for (let t = 0; t < columns * rows; t++) {
        const left = (t % columns - 1) * TILE, top = (Math.floor(t / columns) - 1) * TILE;
        let least = BACKGROUND;
        for (let y = top; y < top + 3 * TILE; y++)
            for (let x = left; x < left + 3 * TILE; x++)
                least = Math.min(least, far[row(y) + column(x)]);
        front[t] = least;
    }
    return { span, front, columns, rows };
}

// ---------------------------------------------------------------- on the graphics card

export class Moving {
    constructor(device, published, basis, told) {
        Object.assign(this, { device, published, basis, told });
        this.gloss = published.moves === 'highlights';
        this.views = new Recent();    // name -> { state, ... }
        this.reached = new Recent();  // captured lights on tiles
        this.reachedBytes = 0;
        this.scratch = new Map();
        this.between = basis.pictures(this.gloss ? published.basis : { interpolant: 'delaunay' });
    }

    // The captured lights around a direction, [{ light, direction, weight }]; none where it is one of them.
    around(direction) {
        const out = this.between.around(direction, this.gloss ? LEAST_WEIGHT : 0).slice(0, this.gloss ? undefined : AROUND);
        return !this.gloss && out.length && out[0].weight > PHOTOGRAPH ? [] : out;
    }

    texture(width, height, format, data, levels = 1) {
        const { gl } = this.device, texture = this.device.texture(levels > 1 ? gl.LINEAR : gl.NEAREST);
        const channels = { [gl.R32F]: gl.RED, [gl.RG32F]: gl.RG }[format] || gl.RGBA;
        gl.texStorage2D(gl.TEXTURE_2D, levels, format, width, height);
        gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, height, channels, gl.FLOAT, data);
        if (levels > 1) {
            gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_NEAREST);
            gl.generateMipmap(gl.TEXTURE_2D);
        }
        return texture;
    }

    // Whether a view's model is there, which loads by and by; whether it is, or does not come.
    isReady(name) {
        const known = this.views.use(name);
        if (!known)
            this.load(name);
        return !!known && known.state === 'ready';
    }

    isSettled(name) {
        const known = this.views.get(name);
        return !!known && known.state !== 'loading';
    }

    async load(name) {
        const entry = { state: 'loading' }, view = this.published.views.find((v) => v.name === name);
        this.views.set(name, entry);
        try {
            Object.assign(entry, { state: 'still' }, await this.upload(view));
        } catch (error) {
            entry.state = 'failed';
            this.told.failed(error);
        }
        this.forget();
        this.told.changed();
    }

    async modelOf(view) {
        const { published } = this;
        if (published.local)
            return published.local.model(view);
        if (!view.moving)
            return null;
        const address = `${published.base}${view.name}/moving.bin`, parts = partsOf(await loadBytes(address), 3, address);
        const pictures = await Promise.all(parts.map((part) => decodePicture(part, 'image/jpeg').catch(() => {
            throw new Failure(`${view.name}/moving.bin is damaged`);
        })));
        if (pictures.some((p) => p.width !== published.width || p.height !== published.height))
            throw new Failure(`${view.name}/moving.bin has another size than scene.json says`);
        return modelOf(pictures.map(pixelsOf), view.moving, this.gloss);
    }

    // The textures of a view.
    async upload(view) {
        const { gl } = this.device, { width, height } = this.published, n = width * height;
        const model = await this.modelOf(view), depth = this.gloss || !model ? null : pixelsOf(await loadPicture(this.published, view, false));
        if (!model)
            return {};
        const levels = this.published.levels.length, stage = this.gloss ? {} : raysOf(this.published, view), own = {};
        if (!this.gloss) {
            const { far, low, high, leastSide } = surfaceOf(stage, depth, view, (this.published.window || { camera_z: 0 }).camera_z);
            const { span, front, columns, rows } = spansOf(far, width, height, stage.rays >= CYLINDER), surface = new Float32Array(2 * n);
            for (let i = 0; i < n; i++)
                surface.set([far[i], Math.min(model[NUMBERS * i], BACKGROUND)], 2 * i);
            Object.assign(stage, { low, high, far, leastSide });
            own.surface = this.texture(width, height, gl.RG32F, surface);
            own.span = this.texture(width + 1, height + 1, gl.RG32F, span);
            own.front = this.texture(columns, rows, gl.R32F, front);
        }
        const halves = [0, 1].map((half) => {
            const texels = new Float32Array(4 * n), first = this.gloss ? 4 * half : half ? 4 : 1, count = this.gloss || half ? 4 : 3;
            for (let i = 0; i < n; i++)
                if (this.gloss || stage.far[i] < BACKGROUND)
                    texels.set(model.subarray(NUMBERS * i + first, NUMBERS * i + first + count), 4 * i);
            return this.texture(width, height, gl.RGBA16F, texels, levels);
        });
        delete stage.far;
        return { state: 'ready', stage, own, colours: halves[0], matte: halves[1], bytes: (this.gloss ? 22 : 38) * n };
    }

    // Views that have not been in use for long leave.
    forget() {
        let bytes = [...this.views.values()].reduce((sum, v) => sum + (v.bytes || 0), 0);
        this.views.trim(() => bytes > MOST_STAGE_BYTES && this.views.size > MOST_STAGES, (view) => {
            bytes -= view.bytes || 0;
            this.dropView(view);
        }, (view) => view.state === 'ready');
    }

    dropView(view) {
        [...Object.values(view.own || {}), view.colours, view.matte].forEach((texture) => this.device.gl.deleteTexture(texture || null));
    }

    // Uniforms of a view's stage.
    stageOf(view) {
        const { stage, own } = view;
        return { surface: { texture: own.surface }, span: { texture: own.span }, front: { texture: own.front },
                 window: [...stage.scale, ...stage.shift], axis: stage.axis, pixel_side: stage.pixel, least_side: stage.leastSide, low: stage.low, high: stage.high };
    }

    placeOf(tile) {
        const { tile: size, levels } = this.published, level = levels[tile.level];
        return { origin: [tile.x * size, tile.y * size], most: [level.width, level.height], grain: 2 ** tile.level };
    }

    target(key, width, height, format) {
        const name = `${key} ${width} ${height}`;
        if (!this.scratch.has(name))
            this.scratch.set(name, this.device.target(width, height, format));
        return this.scratch.get(name);
    }

    trace(target, tile, view, direction) {
        const { rays } = view.stage, program = this.device.program(`trace ${rays}`, () => traceShader(rays));
        this.device.begin(target);
        program.set({ ...this.stageOf(view), ...this.placeOf(tile), direction });
        program.draw();
        return target.texture;
    }

    // Where a captured light reaches a tile, which is kept.
    reachedBy(captured, tile, view) {
        const key = `${tile.key} ${captured.light}`, bytes = (tile.width + 2) * (tile.height + 2);
        let target = this.reached.use(key);
        if (!target) {
            target = this.device.target(tile.width + 2, tile.height + 2, this.device.gl.R8);
            this.trace(target, tile, view, captured.direction);
            this.reachedBytes += bytes;
            this.reached.set(key, target);
        }
        return target.texture;
    }

    forgetReached() {
        this.reached.trim(() => this.reachedBytes > MOST_REACHED_BYTES, (target) => {
            this.reachedBytes -= target.width * target.height;
            this.device.drop(target);
        });
    }

    // What of a tile and its view all shaders take that add to a picture of one light, which draw(target) makes.
    shown(tile, view, draw) {
        const { gamma, between, curve } = this.published, relit = this.target('relit', tile.width, tile.height), { origin, grain } = this.placeOf(tile);
        this.device.begin(relit);
        draw(relit);
        return { relit: { texture: relit.texture }, colours: { texture: view.colours }, matte: { texture: view.matte }, origin, grain,
                 level: tile.level, 'display.curve': { int: between === 'linear' ? 1 : curve }, 'display.gamma': gamma };
    }

    // Adds a light to `lit`: { direction, colour, around }.
    add(lit, tile, { direction, colour, around }, draw) {
        const view = this.views.get(tile.view), shown = this.shown(tile, view, draw);
        const own = this.gloss ? this.glossOf(around) : this.shadowOf(tile, view, direction, around);
        const program = this.device.program(`moves ${this.gloss}`, this.gloss ? glossShader : shadowShader);
        this.device.begin(lit, { clear: false, add: 'rgb' });
        program.set({ ...shown, ...own, towards: direction, rgb: colour });
        program.draw();
    }

    // The same of a light that stands near; `near`: what knows how lamps send (near.js).
    addNear(lit, tile, light, near, draw) {
        const { gl } = this.device, view = this.views.get(tile.view), { rays, eye } = view.stage, shown = this.shown(tile, view, draw);
        const lamps = light.kind === 'panel' ? patchesOf(light, PATCHES) : [light], { lights } = this.published.basis, own = this.stageOf(view);
        const program = this.device.program(`moves near ${rays}`, () => nearShadowShader(rays));
        this.directions = this.directions || this.texture(lights.length / 3, 1, gl.RGBA32F,
            Float32Array.from({ length: 4 * lights.length / 3 }, (_, i) => (i % 4 < 3 ? lights[3 * Math.floor(i / 4) + i % 4] : 0)));
        this.device.begin(lit, { clear: false, add: 'rgb' });
        program.set({ ...shown, ...own, ...near.sent(lamps[0]), ...near.triangleSet(), lights: { texture: this.directions }, eye, lamps: { int: lamps.length } });
        gl.uniform3fv(program.at('lampAt'), lamps.flatMap((lamp) => lamp.position));
        gl.uniform3fv(program.at('lampColour'), lamps.flatMap((lamp) => lamp.rgb));
        program.draw();
    }

    shadowOf(tile, view, direction, around) {
        const arrives = this.trace(this.target('arrives', tile.width + 2, tile.height + 2, this.device.gl.R8), tile, view, direction);
        const out = { arrives: { texture: arrives } };
        for (let i = 0; i < AROUND; i++) {
            const a = around[i];
            out[`reached${i}`] = { texture: a ? this.reachedBy(a, tile, view) : arrives };
            out[`captured${i}`] = a ? [...a.direction, a.weight] : [0, 0, 0, 0];
        }
        this.forgetReached();
        return out;
    }

    glossOf(around) {
        const { gl } = this.device, { lights } = this.published.basis, texels = new Float32Array(4 * lights.length / 3);
        around.forEach((a, i) => texels.set([...a.direction, a.weight], 4 * i));
        gl.deleteTexture(this.lights || null);
        this.lights = this.texture(lights.length / 3, 1, gl.RGBA32F, texels);
        return { lights: { texture: this.lights }, around: { int: around.length } };
    }

    close() {
        this.views.forEach((view) => this.dropView(view));
        [...this.reached.values(), ...this.scratch.values()].forEach((target) => this.device.drop(target));
        [this.lights, this.directions].forEach((texture) => this.device.gl.deleteTexture(texture || null));
    }
}

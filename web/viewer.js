// viewer.js - an open file: its camera, lights and picture, drawn when something has changed
import { Device } from './gl.js';
import { Basis } from './wasm.js';
import { Failure } from './load.js';
import { loadPublished } from './published.js';
import { Tiles } from './tiles.js';
import { Relighter } from './relight.js';
import { Painter } from './paint.js';
import { Planar } from './planar.js';
import { Slab } from './slab.js';
import { Panorama } from './panorama.js';
import { Comparison } from './compare.js';
import { firstLight } from './lights.js';
import { rakingDirections } from './raking.js';
import { More, loadMore } from './more.js';
import { readState, writeState } from './state.js';
import { brightestExposure, measureRange, meterExposure } from './measure.js';
import { PASSES, TONES_BY_NAME } from './shaders.js';
import { presentShader } from './tileshaders.js';

const MOST_LAMPS = 8;  // that passes enhance
const MEASURED = 128;  // pixels a side
const DRAFT = 256;     // of the canvas while the first picture is drawn, which is no finer
const GROUND = [22, 22, 23].map((v) => v / 255);  // --ground of relume.css
const SLOW = 90, QUICK = 30;  // milliseconds from frame to frame
const LEAST_PIXELS = 1 << 18, MOST_PIXELS = 1 << 25;  // relit in a frame

const needsNormals = (pass) => ['normals', 'specular', 'diffuse-gain', 'unsharp'].includes(pass);
const lampsOf = (lights) => lights.filter((light) => light.kind === 'dir').slice(0, MOST_LAMPS);
const sumOf = (lamps) => [0, 1, 2].map((c) => lamps.reduce((sum, lamp) => sum + lamp.rgb[c], 0));
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

export class Viewer {
    // `told`: changed(), drawn(), failed(error), broken(error), problem(sentence).
    constructor(canvas, home, told) {
        Object.assign(this, { canvas, home, told });
        this.device = new Device(canvas);
        this.pixels = 1 << 22;
        this.coarser = 0;
        this.moving = 0;
        this.waiting = [];
        this.memo = {};  // what the pass takes from the picture
        this.comparison = new Comparison(this);
        this.ready = new Promise((resolve) => { this.isReady = resolve; });
    }

    // Opens the file that a page names, or shows one that is open already.
    async open(address, published) {
        const layer = await this.openLayer(address, published);
        Object.assign(this, layer);
        this.projection = layer.published.projection;
        this.reset();
        this.metering = layer.published.exposure === undefined;
        this.exposure = layer.published.exposure || 0;
        this.draft = true;
        this.resize();
    }

    // All that an open file has.
    async openLayer(address, opened) {
        const published = opened || await loadPublished(address), basis = await Basis.open(published, this.home);
        const tiles = new Tiles(this.device, published, { changed: () => this.invalidate(), failed: (error) => this.told.failed(error) });
        return this.layerOf(published, basis, tiles);
    }

    // A file under lights of its own.
    layerOf(published, basis, tiles) {
        tiles.more = tiles.more || new More(this.device, published, basis, this.home, { changed: () => this.invalidate(), failed: (error) => this.told.failed(error) });
        const relighter = new Relighter(this.device, published, basis, tiles.more);
        const painter = new Painter(this.device, published, tiles, relighter, () => this.invalidate());
        const stage = published.projection === 'planar' ? new Planar(published, painter)
            : published.projection === 'slab' ? new Slab(published, painter, this.device) : new Panorama(published, painter, this.device);
        return { published, basis, tiles, relighter, painter, stage };
    }

    get isPanorama() { return this.stage instanceof Panorama; }
    get isSlab() { return this.stage instanceof Slab; }

    // As the page opens.
    reset() {
        this.lights = [firstLight(this.published)];
        this.chosen = 0;
        this.exposure = 0;
        this.tone = 'linear';
        this.pass = 'colour';
        this.aperture = 0;
        this.focus = this.isSlab ? this.published.slab.st_plane_z : 0;
        this.eye = this.isSlab ? this.stage.middle() : [0, 0, 0];
        Object.assign(this, { pan: 0, tilt: 0, zoom: 1, look: 'perspective', others: [] });
        this.at = null;  // null: the whole picture
        this.setLights(this.lights);
    }

    // ------------------------------------------------------------ changes

    setLights(lights) {
        this.lights = lights;
        this.chosen = clamp(this.chosen, 0, Math.max(0, lights.length - 1));
        this.relighter.setLights(lights);
        this.changed();
    }

    // Raking light from the side of the chosen light, `count` times; again, from the side that it had before.
    rake(count) {
        const light = this.lights[this.chosen], at = (light && light.direction) || [0, 0, 1], { raked } = this;
        const again = raked && raked.to.every((v, i) => Math.abs(v - at[i]) < 1e-6);
        const side = again ? raked.from : at, made = rakingDirections(this.published, side, count);
        this.raked = { from: side, to: made[0] };
        this.chosen = 0;
        this.setLights(made.map((direction) => ({ kind: 'dir', direction, rgb: [1, 1, 1] })));
    }

    changed() {
        this.told.changed();
        this.invalidate();
    }

    // Hints that changes come fast, so that coarse pictures will do where full ones take too long.
    touch() {
        this.moving = performance.now();
    }

    framing() {
        const { width, height } = this.canvas;
        return this.at || this.stage.fit(width, height);
    }

    // Moves the picture by pixels of the canvas.
    shift(dx, dy) {
        const at = this.framing();
        this.setFraming({ ...at, x: at.x - dx / at.scale, y: at.y - dy / at.scale });
    }

    // Enlarges it around a place of the canvas.
    enlarge(factor, x = this.canvas.width / 2, y = this.canvas.height / 2) {
        if (this.isPanorama) {
            this.zoom = clamp(this.zoom * factor, this.look === 'perspective' ? 0.4 : 0.2, 40);
            this.changed();
            return;
        }
        const at = this.framing(), fit = this.stage.fit(this.canvas.width, this.canvas.height).scale;
        const scale = clamp(at.scale * factor, Math.min(fit, 1) / 2, Math.max(32, 2 * fit)), k = 1 / at.scale - 1 / scale;
        this.setFraming({ x: at.x + k * (x - this.canvas.width / 2), y: at.y + k * (y - this.canvas.height / 2), scale });
    }

    setFraming(at) {
        const scale = at.scale * this.sharpen();
        this.at = { x: clamp(at.x, 0, this.published.width), y: clamp(at.y, 0, this.published.height), scale };
        this.changed();
    }

    // Walks, by shares of the grid of cameras; looks around, by degrees.
    walk(dx, dy) {
        const { grid } = this.stage;
        this.eye = [clamp(this.eye[0] + dx * (grid[2] - grid[0]), grid[0], grid[2]),
                    clamp(this.eye[1] + dy * (grid[3] - grid[1]), grid[1], grid[3]), this.eye[2]];
        this.changed();
    }

    turn(pan, tilt) {
        this.pan = ((this.pan + pan + 540) % 360) - 180;
        this.tilt = clamp(this.tilt + tilt, -90, 90);
        this.changed();
    }

    // A little planet is seen from above, unless `values` say otherwise.
    setLook(look, values = {}) {
        const planet = look === 'planet';
        this.look = look;
        this.tilt = values.tilt ?? (planet ? -90 : 0);
        this.zoom = values.zoom ?? (planet ? 0.5 : 1);
        this.changed();
    }

    resize() {
        const full = window.devicePixelRatio || 1, box = this.canvas.getBoundingClientRect();
        const ratio = this.draft ? Math.min(full, DRAFT / Math.max(box.width, box.height, 1)) : full;
        const width = Math.max(1, Math.round(box.width * ratio)), height = Math.max(1, Math.round(box.height * ratio));
        if (this.canvas.width !== width || this.canvas.height !== height) {
            this.canvas.width = width;
            this.canvas.height = height;
        }
        this.invalidate();
    }

    // From now on all pixels of the canvas are drawn; how many times as many a side these are.
    sharpen() {
        const before = this.canvas.width;
        this.draft = false;
        this.resize();
        return this.canvas.width / before;
    }

    // ------------------------------------------------------------ places

    // Pixels of the canvas a pixel of the picture; 0 where that differs from place to place.
    scale() { return this.isPanorama ? 0 : this.framing().scale; }

    // A place of the picture (pixels at full size) on the canvas, or null; and back.
    toCanvas([x, y]) {
        const { width, height } = this.canvas;
        if (this.isPanorama)
            return this.stage.toCanvas([x, y], this.camera(), width, height);
        const at = this.framing();
        return [width / 2 + (x - at.x) * at.scale, height / 2 + (y - at.y) * at.scale];
    }

    toPicture([x, y]) {
        const { width, height } = this.canvas;
        if (this.isPanorama)
            return this.stage.toPicture([x, y], this.camera(), width, height);
        const at = this.framing();
        return [at.x + (x - width / 2) / at.scale, at.y + (y - height / 2) / at.scale];
    }

    // Very many notes on what is looked around in (pins.js).
    async openPins() {
        const { Pins } = await loadMore(this.home);
        return new Pins(this.device, this.stage.pinWay, (place) => this.stage.directionOf(place));
    }

    pinValues() { return { ...this.stage.pinValues(this.camera()), size: [this.canvas.width, this.canvas.height] }; }

    // ------------------------------------------------------------ the state line

    getState() {
        const other = (value, usual) => (value === usual ? undefined : value);
        const values = {
            eye: this.isSlab ? this.eye : undefined,
            at: this.at ? [this.at.x, this.at.y, this.at.scale] : undefined,
            exposure: other(this.exposure, 0), tone: other(this.tone, 'linear'), pass: other(this.pass, 'colour'),
        };
        if (this.isPanorama)
            Object.assign(values, { pan: this.pan, tilt: this.tilt, zoom: this.zoom, projection: other(this.look, 'perspective') });
        if (this.isSlab && this.aperture > 0)
            Object.assign(values, { aperture: this.aperture, focus: this.focus });
        return writeState({ values, lights: this.lights, others: this.others });
    }

    // Shows what a line says; what it does not name is as the page opens.
    setState(line) {
        const { values, lights, others, problem } = readState(line, this.published.takesLamps);
        this.metering = false;
        this.reset();
        Object.assign(this, { others });
        for (const name of ['exposure', 'tone', 'pass', 'pan', 'tilt', 'zoom', 'aperture', 'focus', 'eye'])
            if (values[name] !== undefined)
                this[name] = values[name];
        if (values.projection)
            this.setLook(values.projection, values);
        if (values.at && !this.isPanorama && this.sharpen())
            this.at = { x: values.at[0], y: values.at[1], scale: values.at[2] };
        if (lights)
            this.setLights(lights);
        if (problem)
            this.told.problem(problem);
        this.changed();
    }

    // ------------------------------------------------------------ drawing

    invalidate() {
        if (!this.asked && this.stage && !this.closed) {
            this.asked = true;
            requestAnimationFrame((now) => {
                this.asked = false;
                try {
                    this.frame(now);
                } catch (error) {  // of the graphics card, mostly: nothing more is drawn
                    this.closed = true;
                    this.told.broken(error);
                }
            });
        }
    }

    // A promise of the present view at full detail.
    idle() {
        return new Promise((resolve) => { this.waiting.push(resolve); this.invalidate(); });
    }

    // Slow machines relight less in a frame, and coarser while things move.
    keepPace(now) {
        const gap = now - (this.last || now - QUICK), steady = gap < 500;
        this.last = now;
        if (steady && gap > SLOW)
            this.pixels = Math.max(this.pixels / 2, LEAST_PIXELS);
        else if (gap < QUICK)
            this.pixels = Math.min(this.pixels * 1.5, MOST_PIXELS);
        const moving = now - this.moving < 250;
        if (!moving)
            this.coarser = 0;
        else if (steady && gap > SLOW)
            this.coarser = Math.min(this.coarser + 1, 3);
        return moving;
    }

    target(name) {
        const { width, height } = this.canvas, own = this.targets = this.targets || {};
        if (!own[name] || own[name].width !== width || own[name].height !== height) {
            this.device.drop(own[name]);
            own[name] = this.device.target(width, height);
        }
        return own[name];
    }

    // Of a file that lies where this one does, of another size perhaps.
    camera(layer = this) {
        const at = this.isPanorama ? null : this.framing(), k = layer.published.width / this.published.width;
        return { at: at && { x: at.x * k, y: at.y * k, scale: at.scale / k }, eye: this.eye, pan: this.pan,
                 tilt: this.tilt, zoom: this.zoom, planet: this.look !== 'perspective',
                 aperture: this.aperture, focus: this.focus, coarser: this.coarser };
    }

    // How the file is seen now.
    seen() {
        return { layer: this, lights: this.lights, pass: this.pass, tone: this.tone, exposure: this.exposure, memo: this.memo };
    }

    // `alone`: without the notes.
    frame(now, alone = false) {
        if (this.closed || this.device.gl.isContextLost())
            return;
        const moving = this.keepPace(now), own = this.seen();
        this.comparison.follow();
        const { other } = this.comparison;
        const looks = other ? [own, other] : [own];
        this.painter.complete = true;
        this.painter.rough = false;
        this.tiles.begin();
        looks.forEach((look, i) => this.drawLook(look, i, looks.length > 1 ? this.target(`shown${i}`) : null));
        this.meter(own);
        this.tiles.end();
        if (other)
            this.comparison.draw(this.target('shown0'), this.target('shown1'));
        this.told.drawn(alone);
        this.settle(moving, looks);
    }

    drawLook(look, index, target) {
        const { layer } = look, kinds = needsNormals(look.pass) ? ['light', 'normals', 'albedo'] : ['light'];
        layer.painter.allowed = this.pixels;
        if (layer.tiles !== this.tiles)
            layer.tiles.begin();
        if (layer !== this)
            Object.assign(layer.painter, { complete: true, rough: false });
        for (const kind of kinds)
            layer.stage.draw(this.target(`${kind}${index}`), kind, this.camera(layer));
        this.findRange(look);
        this.present(look, index, target);
        if (layer.tiles !== this.tiles)
            layer.tiles.end();
    }

    settle(moving, looks) {
        const busy = looks.some(({ layer }) => layer.tiles.busy > 0), complete = looks.every(({ layer }) => layer.painter.complete);
        this.drawn = this.drawn || [...this.tiles.tiles.values()].some((tile) => tile.lit.length);
        if (this.drawn) {
            this.isReady();
            looks.forEach(({ layer }) => layer.tiles.more.begin());
        }
        if (this.draft && this.drawn && complete)
            return void this.sharpen();
        if (!complete && !busy)
            this.invalidate();
        if (this.coarser && moving)
            setTimeout(() => this.invalidate(), 260);
        if (complete && !busy && !this.coarser && !looks.some(({ layer }) => layer.painter.rough))
            this.waiting.splice(0).forEach((resolve) => resolve());
    }

    // The whole picture, small, as floats of each kind; null where it is not there yet.
    small({ published, painter }, kinds) {
        const last = published.levels.length - 1, { width, height } = published.levels[last];
        const scale = Math.min(1, MEASURED / Math.max(width, height)), before = painter.complete;
        const target = this.device.target(Math.max(1, Math.round(width * scale)), Math.max(1, Math.round(height * scale)));
        painter.complete = true;
        painter.allowed = Math.max(painter.allowed, 1);
        const out = kinds.map((kind) => {
            painter.paint(target, published.views[0], kind, last, { scale: scale * 2 ** -last, left: 0, top: 0 },
                          [0, 0, published.width, published.height]);
            return this.device.read(target);
        });
        const there = painter.complete;
        painter.complete = there && before;
        this.device.drop(target);
        return there ? out : null;
    }

    // Raking light is dim: the first picture is brighter, but never so much that light from the front
    // would burn it out.
    meter(look) {
        const read = this.metering && this.small(look.layer, ['light']);
        if (!read)
            return;
        const front = this.layerOf(this.published, this.basis, this.tiles);
        this.metering = false;
        front.relighter.setLights([{ kind: 'dir', direction: this.isPanorama ? [0, 1, 0] : [0, 0, 1], rgb: [1, 1, 1] }]);
        const exposure = Math.min(meterExposure(read[0]), brightestExposure(this.small(front, ['light'])[0]), 2);
        front.stage.close();
        this.exposure = Math.round(10 * Math.max(exposure - 0.05, 0)) / 10;
        this.changed();
    }

    // A square of the first view at full size, as floats of a kind, row 0 at its bottom; waits for its tiles.
    async patch(kind, x, y, side) {
        const { painter, tiles, published } = this, part = [Math.max(x, 0), Math.max(y, 0), Math.min(x + side, published.width), Math.min(y + side, published.height)];
        const target = this.device.target(side, side);
        try {
            for (;;) {
                painter.complete = true;
                painter.allowed = Infinity;
                painter.paint(target, published.views[0], kind, 0, { scale: 1, left: -x, top: -y }, part);
                tiles.end();
                if (painter.complete)
                    return this.device.read(target);
                if (painter.touching(0, part).some(([i, j]) => tiles.get(published.views[0].name, 0, i, j).state === 'failed'))
                    throw new Failure('a part of the picture is missing');
                await new Promise((resolve) => setTimeout(resolve, 20));
                if (this.closed)
                    throw new Failure('the picture is closed');
            }
        } finally {
            this.device.drop(target);
        }
    }

    // The light that the canvas shows, before exposure: floats, row 0 at its bottom.
    lightSeen() {
        const target = this.target('light0');
        return { width: target.width, height: target.height, data: this.device.read(target) };
    }

    findRange(look) {
        const { pass, memo, layer, lights } = look, gain = pass === 'diffuse-gain';
        if (memo.of === pass && memo.lights === lights)
            return;
        memo.range = [0, 1, 1, 1];
        const read = ['specular', 'diffuse-gain', 'false-colour'].includes(pass) && this.small(layer, gain ? ['light', 'albedo'] : ['light']);
        if (!read)
            return;
        memo.range = measureRange(pass, read[0], read[1], sumOf(lampsOf(lights)));
        memo.of = pass;
        memo.lights = lights;
    }

    // Into a target, or onto the canvas.
    present(look, index, target) {
        const lamps = lampsOf(look.lights), pass = PASSES.indexOf(look.pass), { gl } = this.device;
        const program = this.device.program(`present ${pass}`, () => presentShader(pass));
        const of = (kind) => ({ texture: this.target(`${needsNormals(look.pass) ? kind : 'light'}${index}`).texture });
        this.device.begin(target);
        program.set({
            light: of('light'), normals: of('normals'), albedos: of('albedo'),
            tone: { int: TONES_BY_NAME.indexOf(look.tone) }, exposure: 2 ** look.exposure, ground: GROUND,
            scale: look.memo.range, count: { int: lamps.length }, lampSum: sumOf(lamps), radius: Math.max(4 * (this.scale() || 1), 1),
        });
        if (lamps.length) {
            gl.uniform3fv(program.at('lamp'), lamps.flatMap((lamp) => lamp.direction));
            gl.uniform3fv(program.at('lampColour'), lamps.flatMap((lamp) => lamp.rgb));
        }
        program.draw();
    }

    // The picture as it is seen, as a PNG.
    snapshot() {
        return new Promise((resolve) => {
            this.frame(performance.now(), true);
            this.canvas.toBlob(resolve, 'image/png');
        });
    }

    close() {
        this.closed = true;
        this.comparison.close();
        if (this.stage) {
            this.stage.close();
            this.tiles.close();
            this.basis.close();
        }
        Object.values(this.targets || {}).forEach((target) => this.device.drop(target));
    }
}

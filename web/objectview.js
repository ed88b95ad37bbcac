// objectview.js - an open object: its eye, lights and picture, drawn when something has changed
import { Device } from './gl.js';
import { cross, unit } from './lights.js';
import { ObjectComparison } from './objectcompare.js';
import { ObjectModel, minus, product } from './objectmodel.js';
import { Pins } from './pins.js';
import { TONES_BY_NAME } from './shaders.js';
import { objectPresentShader } from './objectshaders.js';
import { readState, writeState } from './state.js';

const STEEPEST = 1.5;  // radians over the horizon
const LEAST_SCALE = 0.2, MOST_SCALE = 100;
const SLOW_FRAME = 90, REST_OF_MOVING = 250;  // milliseconds
const FIRST_EYE = [0, 0.6, 1.8];  // from the middle, in diagonals of the box, as 'relume btf render' looks
const MOST_DISTANCES = 512;       // pixels a side
const BEHIND = 0.01;              // diagonals: what lies so much behind the surface is hidden by it

// As project and isSeen below have it.
const PIN_WAY = `
uniform vec3 eye, right, down, ahead;
uniform vec4 window;
uniform vec2 size;
uniform float across;
uniform sampler2D distances;
vec3 project(vec3 place)
{
    vec3 to = place - eye;
    float z = dot(to, ahead);
    vec2 at = (1.0 + vec2(dot(to, right), dot(to, down)) / window.xy / z - window.zw) * 0.5 * size;
    return vec3(at, z > 1e-6 * across ? z : 0.0);
}
bool hides(vec3 at)
{
    ivec2 most = textureSize(distances, 0) - 1, cell = ivec2(floor(vec2(at.x, size.y - at.y) / size * vec2(most + 1)));
    float far = 0.0;
    for (int k = 0; k < 9; k++) {
        ivec2 beside = cell + ivec2(k % 3, k / 3) - 1;
        if (beside == clamp(beside, ivec2(0), most))
            far = max(far, texelFetch(distances, beside, 0).r);
    }
    return far > 0.0 && at.z / across > far + ${BEHIND};
}`;

const within = (x, low, high) => Math.min(Math.max(x, low), high);

export class ObjectViewer {
    // `told`: changed(), drawn(), broken(error), problem(sentence).
    constructor(canvas, home, told) {
        Object.assign(this, { canvas, home, told, waiting: [], moving: 0, rough: false, targets: {}, lit: {}, marked: false });
        this.device = new Device(canvas);
        this.comparison = new ObjectComparison(this);
    }

    async open(address) {
        this.model = await this.openModel(address);
        Object.assign(this, { object: this.model.object, middle: this.model.middle, across: this.model.across });
        this.reset();
        this.resize();
    }

    openModel(address) { return ObjectModel.open(this.device, address, this.home); }

    get isObject() { return true; }

    reset() {
        this.lights = this.object.fixed ? [] : [{ kind: 'dir', direction: unit([-0.4, 0.6, 0.7]), rgb: [1, 1, 1] }];
        Object.assign(this, { chosen: 0, exposure: 0, tone: 'linear', at: [0, 0, 1], others: [] });
        this.setEye(this.middle.map((v, c) => v + this.across * FIRST_EYE[c]));
        this.setLights(this.lights);
    }

    // ------------------------------------------------------------ changes

    setLights(lights) {
        this.lights = lights;
        this.chosen = within(this.chosen, 0, Math.max(0, lights.length - 1));
        this.changed();
    }

    setEye(eye) {
        const from = minus(eye, this.middle), far = Math.hypot(...from);
        this.eye = far > 1e-6 * this.across ? eye : this.middle.map((v, c) => v + this.across * FIRST_EYE[c]);
    }

    // Around the middle, radians.
    turn(right, up) {
        const [x, y, z] = minus(this.eye, this.middle), far = Math.hypot(x, y, z);
        const yaw = Math.atan2(x, z) + right, pitch = within(Math.asin(within(y / far, -1, 1)) + up, -STEEPEST, STEEPEST);
        const way = [Math.cos(pitch) * Math.sin(yaw), Math.sin(pitch), Math.cos(pitch) * Math.cos(yaw)];
        this.eye = this.middle.map((v, c) => v + far * way[c]);
        this.changed();
    }

    // Around a place of the canvas, in halves of its shorter side from its middle.
    enlarge(factor, x = 0, y = 0) {
        const [left, top, scale] = this.at, to = within(scale * factor, LEAST_SCALE, MOST_SCALE), k = 1 / scale - 1 / to;
        this.setFraming([left + k * x, top + k * y, to]);
    }

    shift(dx, dy) {
        const [x, y, scale] = this.at;
        this.setFraming([x - dx / scale, y - dy / scale, scale]);
    }

    setFraming([x, y, scale]) {
        this.at = [within(x, -1.5, 1.5), within(y, -1.5, 1.5), within(scale, LEAST_SCALE, MOST_SCALE)];
        this.changed();
    }

    touch() { this.moving = performance.now(); }

    changed() {
        this.told.changed();
        this.invalidate();
    }

    resize() {
        const ratio = window.devicePixelRatio || 1, box = this.canvas.getBoundingClientRect();
        this.canvas.width = Math.max(1, Math.round(box.width * ratio));
        this.canvas.height = Math.max(1, Math.round(box.height * ratio));
        this.invalidate();
    }

    // ------------------------------------------------------------ the state line

    getState() {
        const whole = this.at[0] === 0 && this.at[1] === 0 && this.at[2] === 1;
        const values = { eye: this.eye, at: whole ? undefined : this.at, exposure: this.exposure || undefined,
                         tone: this.tone === 'linear' ? undefined : this.tone };
        return writeState({ values, lights: this.lights, others: this.others });
    }

    setState(line) {
        const { values, lights, others, problem } = readState(line, false);
        this.reset();
        this.others = others;
        this.exposure = values.exposure ?? 0;
        this.tone = values.tone ?? 'linear';
        if (values.eye)
            this.setEye(values.eye);
        if (values.at)
            this.setFraming(values.at);
        if (lights && !this.object.fixed)
            this.setLights(lights);
        if (problem)
            this.told.problem(problem);
        this.changed();
    }

    // ------------------------------------------------------------ drawing

    // The axes of what is seen: right, down, ahead; as relume_objects_window.
    axes(eye = this.eye) {
        const ahead = unit(minus(this.middle, eye));
        const up = Math.abs(ahead[1]) > 0.9999 ? [0, 0, ahead[1] < 0 ? -1 : 1] : [0, 1, 0], right = unit(cross(ahead, up));
        return { right, down: unit(cross(ahead, right)), ahead };
    }

    // A direction of the world as who looks sees it, right, up and towards the eye; and back.
    toSeen(direction) {
        const { right, down, ahead } = this.axes();
        return [product(direction, right), -product(direction, down), -product(direction, ahead)];
    }

    fromSeen([x, y, z]) {
        const { right, down, ahead } = this.axes();
        return right.map((v, c) => x * v - y * down[c] - z * ahead[c]);
    }

    invalidate() {
        if (this.asked || !this.object || this.closed)
            return;
        this.asked = true;
        requestAnimationFrame(() => {
            this.asked = false;
            try {
                this.frame();
            } catch (error) {
                this.closed = true;
                this.told.broken(error);
            }
        });
    }

    idle() {
        return new Promise((resolve) => { this.waiting.push(resolve); this.invalidate(); });
    }

    // Floats, `width` x `height`, of a name; `deep`: with depth.
    target(name, width, height, deep = false) {
        const { device, device: { gl } } = this, had = this.targets[name];
        if (had && had.width === width && had.height === height)
            return had;
        this.drop(had);
        const target = this.targets[name] = device.target(width, height);
        if (deep) {
            target.depth = gl.createRenderbuffer();
            gl.bindRenderbuffer(gl.RENDERBUFFER, target.depth);
            gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, width, height);
            gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, target.depth);
        }
        return target;
    }

    drop(target) {
        this.device.drop(target);
        if (target && target.depth)
            this.device.gl.deleteRenderbuffer(target.depth);
    }

    // How the object is seen now.
    seen() {
        const { model, lit, lights, eye, at, exposure, tone } = this;
        return { model, lit, lights, eye, at, exposure, tone };
    }

    frame(finely = false) {
        const { device: { gl }, canvas, waiting, comparison } = this, begun = performance.now(), moving = begun - this.moving < REST_OF_MOVING;
        if (this.closed || gl.isContextLost())
            return;
        const rough = moving && this.rough && !finely, times = rough || canvas.width * canvas.height > 1 << 22 ? 1 : 2;
        comparison.follow();
        if (comparison.other) {
            const [own, other] = [this.seen(), comparison.other].map((look, i) => this.draw(look, times, this.target(`shown${i}`, canvas.width, canvas.height)));
            comparison.draw(own, other);
        } else {
            this.draw(this.seen(), times, null);
        }
        if (moving && !finely) {
            gl.finish();
            this.rough = performance.now() - begun > SLOW_FRAME || this.rough;
        }
        this.told.drawn(finely);
        if (rough)
            setTimeout(() => this.invalidate(), REST_OF_MOVING + 10);
        else
            waiting.splice(0).forEach((resolve) => resolve());
    }

    // The eye of a look and its window, as relume_objects_window has them; the same for all that is compared.
    cameraOf({ eye, at }) {
        const axes = this.axes(eye), radius = this.across / 2, { width, height } = this.canvas, shorter = Math.min(width, height);
        const apart = Math.max(Math.hypot(...minus(this.middle, eye)), 1.2 * radius);
        const half = 1.05 * radius / Math.sqrt(apart * apart - radius * radius) / at[2];
        return { eye, ...axes, window: [half * width / shorter, half * height / shorter, at[0] * at[2] * shorter / width, at[1] * at[2] * shorter / height] };
    }

    // A look into `target`, the canvas where it is null; its light has `times` as many pixels each way.
    draw(look, times, target) {
        const { device, canvas: { width, height } } = this, light = this.target('light', times * width, times * height, true);
        look.model.draw(light, this.cameraOf(look), look.model.light(look.lit, look.lights));
        device.begin(target);
        const present = device.program('present', objectPresentShader);
        present.set({ light: { texture: light.texture }, exposure: 2 ** look.exposure, tone: { int: TONES_BY_NAME.indexOf(look.tone) } });
        present.draw();
        return target;
    }

    // ------------------------------------------------------------ places

    camera() { return { at: null }; }
    scale() { return 0; }

    // A place of the object on the canvas: [x, y, distance along the look]; null behind the eye.
    project(place) {
        const { eye, right, down, ahead, window: [wide, high, x, y] } = this.cameraOf(this), { width, height } = this.canvas;
        const to = minus(place, eye), z = product(to, ahead);
        return z > 1e-6 * this.across
            ? [(1 + product(to, right) / wide / z - x) * width / 2, (1 + product(to, down) / high / z - y) * height / 2, z] : null;
    }

    // ... and null where the surface hides it.
    toCanvas(place) {
        const at = this.project(place);
        return at && this.isSeen(at) ? at.slice(0, 2) : null;
    }

    // The place of the surface that is seen at a place of the canvas, or null.
    toPicture([x, y]) {
        const { eye, right, down, ahead, window: [wide, high, left, top] } = this.cameraOf(this), { width, height } = this.canvas;
        const a = (2 * x / width - 1 + left) * wide, b = (2 * y / height - 1 + top) * high;
        return this.model.meet(eye, ahead.map((v, c) => v + a * right[c] + b * down[c]));
    }

    // The distances of what is seen, while notes want to know them.
    measure() {
        const { width, height } = this.canvas, k = Math.min(1, MOST_DISTANCES / Math.max(width, height));
        const target = this.target('distances', Math.ceil(k * width), Math.ceil(k * height), true);
        this.model.drawDistances(target, this.cameraOf(this));
        this.distances = null;
    }

    // ... as numbers, read when the first place asks.
    get measured() {
        const { distances: target } = this.targets;
        if (!this.distances && target)
            this.distances = { width: target.width, height: target.height, data: this.device.read(target) };
        return this.distances || {};
    }

    // The farthest surface around a place of the canvas hides what lies behind it.
    isSeen([x, y, z]) {
        const { width, height, data } = this.measured, column = Math.floor(x / this.canvas.width * width), row = Math.floor((1 - y / this.canvas.height) * height);
        let far = 0;
        for (let j = Math.max(row - 1, 0); j <= Math.min(row + 1, height - 1); j++)
            for (let i = Math.max(column - 1, 0); i <= Math.min(column + 1, width - 1); i++)
                far = Math.max(far, data[4 * (j * width + i)]);
        return !(far > 0) || z / this.across <= far + BEHIND;
    }

    async openPins() { return new Pins(this.device, PIN_WAY, (place) => place); }

    pinValues() {
        const { eye, right, down, ahead, window: shown } = this.cameraOf(this), { width, height } = this.canvas;
        return { eye, right, down, ahead, window: shown, size: [width, height], across: this.across, distances: { texture: this.targets.distances.texture } };
    }

    snapshot() {
        return new Promise((resolve) => {
            this.frame(true);
            this.canvas.toBlob(resolve, 'image/png');
        });
    }

    close() {
        this.closed = true;
        this.comparison.close();
        if (this.model)
            this.model.close();
        const lost = this.device.gl.getExtension('WEBGL_lose_context');
        if (lost)
            lost.loseContext();
    }
}

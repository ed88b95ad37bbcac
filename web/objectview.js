// objectview.js - an open object: its eye, lights and picture, drawn when something has changed
import { Device } from './gl.js';
import { Basis } from './wasm.js';
import { cross, spread, unit } from './lights.js';
import { loadObject } from './objectfile.js';
import { TONES_BY_NAME } from './shaders.js';
import { COLOURS_ACROSS, OBJECT_VERTEX, objectPresentShader, objectShader } from './objectshaders.js';
import { readState, writeState } from './state.js';

const STEEPEST = 1.5;  // radians over the horizon
const LEAST_SCALE = 0.2, MOST_SCALE = 100;
const SLOW_FRAME = 90, REST_OF_MOVING = 250;  // milliseconds
const FIRST_EYE = [0, 0.6, 1.8];  // from the middle, in diagonals of the box, as 'relume btf render' looks

const minus = (a, b) => a.map((v, c) => v - b[c]);
const product = (a, b) => a.reduce((sum, v, c) => sum + v * b[c], 0);
const within = (x, low, high) => Math.min(Math.max(x, low), high);

export class ObjectViewer {
    // `told`: changed(), broken(error), problem(sentence).
    constructor(canvas, home, told) {
        Object.assign(this, { canvas, home, told, waiting: [], moving: 0, rough: false });
        this.device = new Device(canvas);
    }

    async open(address) {
        const object = await loadObject(address);
        this.middle = object.min.map((v, c) => (v + object.max[c]) / 2);
        this.across = Math.hypot(...minus(object.max, object.min));
        this.basis = object.fixed ? null : await this.openBasis(object);
        this.object = object;
        this.upload();
        this.reset();
        this.resize();
    }

    // The basis that the object was baked in, in all three colours the same.
    openBasis({ basis, coefficients: n }) {
        const { functions, transform: own } = basis, transform = new Float32Array(3 * n * functions);
        for (let c = 0; c < 3; c++)
            transform.set(own, c * n * functions);
        return Basis.open({ basis: { ...basis, parameter: [] }, functions, planes: n, transform, mean: new Float32Array(3 * functions) }, this.home);
    }

    reset() {
        this.lights = this.object.fixed ? [] : [{ kind: 'dir', direction: unit([-0.4, 0.6, 0.7]), rgb: [1, 1, 1] }];
        Object.assign(this, { chosen: 0, exposure: 0, tone: 'linear', at: [0, 0, 1], others: [] });
        this.setEye(this.middle.map((v, c) => v + this.across * FIRST_EYE[c]));
        this.setLights(this.lights);
    }

    // ------------------------------------------------------------ buffers

    upload() {
        const { device: { gl }, object: o } = this;
        this.mesh = gl.createVertexArray();
        gl.bindVertexArray(this.mesh);
        [[o.position, 4], [o.place, 2]].forEach(([data, size], i) => {
            gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
            gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
            gl.enableVertexAttribArray(i);
            gl.vertexAttribPointer(i, size, gl.UNSIGNED_SHORT, true, 0, 0);
        });
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
        gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, o.index, gl.STATIC_DRAW);
        gl.bindVertexArray(this.device.empty);
        gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
        this.clusters = this.device.texture(gl.NEAREST);
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.R16UI, o.width, o.height, 0, gl.RED_INTEGER, gl.UNSIGNED_SHORT, o.cluster);
        this.weights = this.layersOf(gl.RGBA8, gl.UNSIGNED_BYTE, Math.ceil(o.components / 4), o.weight);
        this.frames = o.frame && this.layersOf(gl.RGBA8_SNORM, gl.BYTE, 2, o.frame);
        this.colours = this.device.texture(gl.NEAREST);
        this.colour = new Float32Array(4 * COLOURS_ACROSS * Math.ceil(o.vectors / COLOURS_ACROSS));
    }

    layersOf(format, type, layers, data) {
        const { device: { gl }, object: o } = this, texture = this.device.texture(gl.NEAREST, gl.TEXTURE_2D_ARRAY);
        gl.texImage3D(gl.TEXTURE_2D_ARRAY, 0, format, o.width, o.height, layers, 0, gl.RGBA, type, data);
        return texture;
    }

    // All means and components under the lights.
    light() {
        const { device: { gl }, object: o, colour } = this, n = o.coefficients, sum = new Float32Array(3 * n).fill(o.fixed ? 1 : 0);
        if (this.basis)
            for (const light of spread(this.lights, this.basis)) {
                const { share, weights } = this.basis.weights(light.direction);
                for (let c = 0; c < 3; c++)
                    for (let k = 0; k < n; k++)
                        sum[c * n + k] += share * light.rgb[c] * weights[c * (n + 1) + k];
            }
        for (let i = 0, from = 0; i < o.vectors; i++) {
            let r = 0, g = 0, b = 0;
            for (let k = 0; k < n; k++, from += 3) {
                r += o.value[from] * sum[k];
                g += o.value[from + 1] * sum[n + k];
                b += o.value[from + 2] * sum[2 * n + k];
            }
            colour[4 * i] = r;
            colour[4 * i + 1] = g;
            colour[4 * i + 2] = b;
        }
        gl.bindTexture(gl.TEXTURE_2D, this.colours);
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, COLOURS_ACROSS, colour.length / 4 / COLOURS_ACROSS, 0, gl.RGBA, gl.FLOAT, colour);
        this.isLit = true;
    }

    // ------------------------------------------------------------ changes

    setLights(lights) {
        this.lights = lights;
        this.chosen = within(this.chosen, 0, Math.max(0, lights.length - 1));
        this.isLit = false;
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
        if (lights && this.basis)
            this.setLights(lights);
        if (problem)
            this.told.problem(problem);
        this.changed();
    }

    // ------------------------------------------------------------ drawing

    // The axes of what is seen: right, down, ahead; as relume_objects_window.
    axes() {
        const ahead = unit(minus(this.middle, this.eye));
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

    // Floats of the frame, and depth, `times` as wide and high as the canvas.
    target(times) {
        const { device, device: { gl } } = this, width = times * this.canvas.width, height = times * this.canvas.height;
        if (this.drawn && this.drawn.width === width && this.drawn.height === height)
            return this.drawn;
        device.drop(this.drawn);
        if (this.depth)
            gl.deleteRenderbuffer(this.depth);
        this.drawn = device.target(width, height);
        this.depth = gl.createRenderbuffer();
        gl.bindRenderbuffer(gl.RENDERBUFFER, this.depth);
        gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, width, height);
        gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, this.depth);
        return this.drawn;
    }

    frame(finely = false) {
        const { device: { gl }, canvas, waiting } = this, begun = performance.now(), moving = begun - this.moving < REST_OF_MOVING;
        if (this.closed || gl.isContextLost())
            return;
        if (!this.isLit)
            this.light();
        const rough = moving && this.rough && !finely;
        this.draw(this.target(rough || canvas.width * canvas.height > 1 << 22 ? 1 : 2));
        if (moving && !finely) {
            gl.finish();
            this.rough = performance.now() - begun > SLOW_FRAME || this.rough;
        }
        if (rough)
            setTimeout(() => this.invalidate(), REST_OF_MOVING + 10);
        else
            waiting.splice(0).forEach((resolve) => resolve());
    }

    draw(target) {
        const { device, device: { gl }, object: o, canvas: { width, height } } = this, { right, down, ahead } = this.axes();
        const radius = this.across / 2, apart = Math.max(Math.hypot(...minus(this.middle, this.eye)), 1.2 * radius);
        const half = 1.05 * radius / Math.sqrt(apart * apart - radius * radius) / this.at[2], shorter = Math.min(width, height);
        const program = device.program('object', () => objectShader(o.side > 1), OBJECT_VERTEX);
        const nearest = Math.max(Math.hypot(...minus(this.middle, this.eye)) - 1.01 * radius, 1e-3 * radius);
        const window_ = [half * width / shorter, half * height / shorter];
        device.begin(target);
        gl.enable(gl.DEPTH_TEST);
        gl.clear(gl.DEPTH_BUFFER_BIT);
        program.set({
            low: o.min, high: o.max, eye: this.eye, right, down, ahead, depths: [nearest, apart + 2 * radius],
            window: [...window_, this.at[0] * this.at[2] * shorter / width, this.at[1] * this.at[2] * shorter / height],
            side: { int: o.side }, components: { int: o.components }, clusters: { texture: this.clusters },
            weights: { texture: this.weights, array: true }, colours: { texture: this.colours },
            ...(this.frames ? { frames: { texture: this.frames, array: true } } : {}),
        });
        gl.bindVertexArray(this.mesh);
        gl.drawElements(gl.TRIANGLES, 3 * o.triangles, gl.UNSIGNED_INT, 0);
        gl.bindVertexArray(device.empty);
        gl.disable(gl.DEPTH_TEST);
        device.begin(null);
        const present = device.program('present', objectPresentShader);
        present.set({ light: { texture: target.texture }, exposure: 2 ** this.exposure, tone: { int: TONES_BY_NAME.indexOf(this.tone) } });
        present.draw();
    }

    snapshot() {
        return new Promise((resolve) => {
            this.frame(true);
            this.canvas.toBlob(resolve, 'image/png');
        });
    }

    close() {
        this.closed = true;
        if (this.basis)
            this.basis.close();
        const lost = this.device.gl.getExtension('WEBGL_lose_context');
        if (lost)
            lost.loseContext();
    }
}

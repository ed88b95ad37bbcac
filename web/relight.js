// relight.js - tiles under the present lights; after src/relight/relight.c
import { MOST_LIGHTS, MOST_SAMPLES, normalShader, relightShader } from './shaders.js';
import { isNear, spread } from './lights.js';

const SIZES = [1, 2, 4, 8, MOST_LIGHTS];  // lights of a batch: few shaders
let relighters = 0;

export class Relighter {
    // `near`: for lamps that stand near (near.js).
    constructor(device, scene, basis, near) {
        Object.assign(this, { device, scene, basis, near });
        this.lamps = [];
        this.key = relighters++;  // of its pictures of tiles
        this.version = 0;
        this.batches = [];
        this.buffer = device.gl.createBuffer();
        this.samples = null;
        this.count = 0;
    }

    // Numbers of a light in the shader's block; the quantiser goes into the weights.
    block(out, at, weights, colour) {
        const { planes, layers, scale, offset } = this.scene, stride = planes + 1, last = 4 * 3 * layers;
        for (let c = 0; c < 3; c++) {
            let constant = weights[c * stride + planes];
            for (let k = 0; k < planes; k++) {
                const w = weights[c * stride + k];
                constant += w * offset[k];
                out[at + 4 * k + c] = 255 * w * scale[k];
            }
            out[at + last + c] = constant;
            out[at + last + 4 + c] = colour[c];
        }
    }

    // Batches of so many lights; those of `most` that are missing are dark.
    blocks(lights, most) {
        const size = 4 * (3 * this.scene.layers + 2), batches = [];
        for (let first = 0; first < lights.length; first += most) {
            const some = lights.slice(first, first + most), data = new Float32Array(size * most);
            some.forEach((light, i) => this.block(data, i * size, light.weights, light.colour));
            batches.push({ data, count: some.length, most });
        }
        return batches;
    }

    // In linear files all lights are one: their weights are added.
    joined(lights) {
        const sum = new Float32Array(this.basis.size), stride = this.scene.planes + 1;
        for (const light of lights)
            for (let i = 0; i < sum.length; i++)
                sum[i] += light.weights[i] * light.colour[Math.floor(i / stride)];
        return [{ weights: sum, colour: [1, 1, 1] }];
    }

    setLights(lights) {
        this.lamps = this.near.lampsOf(lights.filter(isNear));
        const plain = spread(lights.filter((light) => !isNear(light)), this.basis).map((light) => {
            const { share, weights } = this.basis.weights(light.direction);
            return { weights, colour: light.rgb.map((v) => share * v) };
        });
        this.count = plain.length;
        const sums = this.scene.curve === 1 ? this.joined(plain) : plain;
        this.batches = this.blocks(sums, SIZES.find((size) => size >= Math.min(sums.length, MOST_LIGHTS)));
        this.version++;
    }

    bind(program, batch) {
        const gl = this.device.gl;
        gl.bindBuffer(gl.UNIFORM_BUFFER, this.buffer);
        gl.bufferData(gl.UNIFORM_BUFFER, batch.data, gl.STREAM_DRAW);
        gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, this.buffer);
        gl.uniformBlockBinding(program.id, gl.getUniformBlockIndex(program.id, 'Weights'), 0);
    }

    draw(program, tile, batch) {
        program.set({ codes: { texture: tile.codes, array: true }, lights: { int: batch.count },
                      curve: { int: this.scene.curve }, gamma: this.scene.gamma });
        this.bind(program, batch);
        program.draw([0, 0, 1, 1]);
    }

    // Whether tiles can be lit now.
    ready(failed) { return !this.lamps.length || this.near.ready(failed); }

    // The tile's light, up to date.
    lit(tile) {
        if (this.isLit(tile))
            return tile.lit[this.key];
        const { layers } = this.scene;
        const lit = tile.lit[this.key] = tile.lit[this.key] || this.device.target(tile.width, tile.height);
        this.batches.forEach((batch, i) => {
            const program = this.device.program(`relight ${layers} ${batch.most}`, () => relightShader(layers, batch.most));
            this.device.begin(lit, { clear: i === 0, add: i > 0 && 'rgb' });
            this.draw(program, tile, batch);
        });
        if (!this.batches.length)
            this.device.begin(lit);
        this.lamps.forEach((lamp) => this.near.add(lit, tile, lamp));
        lit.version = this.version;
        return lit;
    }

    isLit(tile) { return !!tile.lit[this.key] && tile.lit[this.key].version === this.version; }

    // The light that a tile has, which may be that of before.
    older(tile) { return tile.lit[this.key]; }

    // The captured lights that normals are found by, spread evenly over their list.
    samplesBlock() {
        if (this.samples)
            return this.samples;
        const all = this.scene.basis.lights, n = all.length / 3, count = Math.min(n, MOST_SAMPLES), picked = [];
        for (let i = 0; i < count; i++) {
            const at = 3 * Math.floor((i + 0.5) * n / count), direction = all.slice(at, at + 3);
            picked.push({ weights: this.basis.weights(direction).weights, colour: direction });
        }
        [this.samples] = this.blocks(picked, MOST_SAMPLES);
        return this.samples;
    }

    // Normals and albedo of a tile, which stay.
    surface(tile) {
        if (tile.surface)
            return tile.surface;
        const { gl } = this.device, surface = this.device.target(tile.width, tile.height);
        surface.albedo = this.device.texture(gl.LINEAR);
        gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA16F, tile.width, tile.height);
        gl.bindFramebuffer(gl.FRAMEBUFFER, surface.frame);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT1, gl.TEXTURE_2D, surface.albedo, 0);
        gl.drawBuffers([gl.COLOR_ATTACHMENT0, gl.COLOR_ATTACHMENT1]);
        this.device.begin(surface);
        this.draw(this.device.program(`normals ${this.scene.layers}`, () => normalShader(this.scene.layers)), tile, this.samplesBlock());
        tile.surface = surface;
        return surface;
    }

    // What of a tile is drawn: its light, normals or albedo.
    texture(tile, kind) {
        if (kind === 'light')
            return this.lit(tile).texture;
        return kind === 'normals' ? this.surface(tile).texture : this.surface(tile).albedo;
    }
}

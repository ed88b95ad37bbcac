// relight.js - tiles under the present lights; after src/relight/light/relight.c
import { MOST_LIGHTS, MOST_SAMPLES, normalShader, relightShader, strideOf } from './tileshaders.js';
import { isNear, spread } from './lights.js';

const SIZES = [1, 2, 4, 8, MOST_LIGHTS];  // lights of a batch: few shaders
let relighters = 0;

export class Relighter {
    // `more`: for lamps that stand near, and for what moves between captured lights (more.js).
    constructor(device, published, basis, more) {
        Object.assign(this, { device, published, basis, more });
        this.stride = strideOf(published.layers, published.guide);
        this.lamps = [];
        this.moved = null;
        this.key = relighters++;  // of its pictures of tiles
        this.version = 0;
        this.batches = [];
        this.buffer = device.gl.createBuffer();
        // lights whose numbers fit in a block: few of many planes on telephones
        this.most = Math.max(1, Math.floor(device.gl.getParameter(device.gl.MAX_UNIFORM_BLOCK_SIZE) / (16 * this.stride)));
        this.samples = null;
        this.count = 0;
    }

    // Numbers of a light in the shader's block; the quantiser goes into the weights.
    block(out, at, weights, colour) {
        const { planes, layers, scale, offset, guide } = this.published, stride = planes + 1, last = 4 * 3 * layers;
        for (let c = 0; c < 3; c++) {
            let added = 0;
            for (let k = 0; k < planes; k++) {
                const w = weights[c * stride + k];
                added += w * offset[k];
                out[at + 4 * k + c] = 255 * w * scale[k];
            }
            out[at + last + c] = weights[c * stride + planes] + (guide ? 0 : added);
            out[at + last + 4 + c] = colour[c];
            if (guide)
                out[at + last + 8 + c] = added;
        }
    }

    // Batches of so many lights; those of `most` that are missing are dark.
    blocks(lights, most) {
        const size = 4 * this.stride, batches = [];
        for (let first = 0; first < lights.length; first += most) {
            const some = lights.slice(first, first + most), data = new Float32Array(size * most);
            some.forEach((light, i) => this.block(data, i * size, light.weights, light.colour));
            batches.push({ data, count: some.length, most });
        }
        return batches;
    }

    // In linear files all lights are one: their weights are added.
    joined(lights) {
        const sum = new Float32Array(this.basis.size), stride = this.published.planes + 1;
        for (const light of lights)
            for (let i = 0; i < sum.length; i++)
                sum[i] += light.weights[i] * light.colour[Math.floor(i / stride)];
        return [{ weights: sum, colour: [1, 1, 1] }];
    }

    setLights(lights) {
        this.lamps = lights.filter(isNear);
        this.plain = spread(lights.filter((light) => !isNear(light)), this.basis).map((light) => {
            const { share, from, weights } = this.basis.weights(light.direction), colour = light.rgb.map((v) => share * v);
            return { direction: from, colour, parts: this.partsOf(from, weights, colour) };
        });
        this.count = this.plain.length;
        this.batches = this.batchesOf(this.plain.flatMap((light) => light.parts));
        this.moved = null;
        this.version++;
    }

    // What a light is relit by: where planes are coded of what is linear between captured lights, by these.
    partsOf(direction, weights, colour) {
        if (this.published.between !== 'linear')
            return [{ weights, colour }];
        this.pictures = this.pictures || this.basis.pictures({ interpolant: 'delaunay' });
        return this.pictures.around(direction).map((a) => (
            { weights: this.basis.weights(a.direction).weights, colour: colour.map((v) => v * a.weight) }));
    }

    batchesOf(lights) {
        const sums = this.published.curve === 1 && lights.length ? this.joined(lights) : lights;
        return this.blocks(sums, SIZES.filter((size) => size <= this.most).find((size, i, sizes) => size >= sums.length || i + 1 === sizes.length));
    }

    // The same where shadows or highlights move: lights between captured ones are shown one by one.
    movedBy(moving) {
        if (!this.moved) {
            const all = this.plain.map((light) => ({ ...light, around: moving.around(light.direction) })), still = all.filter((l) => !l.around.length);
            this.moved = { batches: this.batchesOf(still.flatMap((l) => l.parts)),
                           alone: all.filter((l) => l.around.length).map((l) => ({ ...l, batches: this.batchesOf(l.parts) })) };
        }
        return this.moved;
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
                      'display.curve': { int: this.published.curve }, 'display.gamma': this.published.gamma });
        this.bind(program, batch);
        program.draw([0, 0, 1, 1]);
    }

    // Whether tiles can be lit now.
    ready(tile) {
        const parts = !this.lamps.length || this.more.gone || this.more.need();
        return parts === true || (!!parts && parts.near.ready(tile.view));
    }

    drawBatch(target, tile, batch, i) {
        const { layers, guide } = this.published;
        const program = this.device.program(`relight ${layers} ${guide} ${batch.most}`, () => relightShader(layers, guide, batch.most));
        this.device.begin(target, { clear: i === 0, add: i > 0 && 'rgb' });
        this.draw(program, tile, batch);
    }

    // The tile's light, up to date.
    lit(tile) {
        if (this.isLit(tile))
            return tile.lit[this.key];
        const lit = tile.lit[this.key] = tile.lit[this.key] || this.device.target(tile.width, tile.height);
        const moving = this.more.movingOf(tile.view), { batches, alone } = moving ? this.movedBy(moving) : { batches: this.batches, alone: [] };
        batches.forEach((batch, i) => this.drawBatch(lit, tile, batch, i));
        if (!batches.length)
            this.device.begin(lit);
        alone.forEach((light) => moving.add(lit, tile, light, (target) =>
            light.batches.forEach((batch, i) => this.drawBatch(target, tile, batch, i))));
        if (this.lamps.length && this.more.parts)
            this.more.parts.near.addAll(lit, tile, this.lamps, moving);
        lit.version = `${this.version}${moving ? ' moved' : ''}`;
        return lit;
    }

    // Lit, but shadows and highlights will move that do not yet.
    isRough(tile) { return this.more.awaits(tile.view) && !(tile.lit[this.key] && tile.lit[this.key].version === `${this.version} moved`); }

    isLit(tile) {
        const lit = tile.lit[this.key];
        return !!lit && (lit.version === `${this.version} moved` || (lit.version === `${this.version}` && !this.more.movingOf(tile.view)));
    }

    // The light that a tile has, which may be that of before.
    older(tile) { return tile.lit[this.key]; }

    get mostSamples() { return Math.min(MOST_SAMPLES, this.most); }

    // The captured lights that normals are found by, spread evenly over their list.
    samplesBlock() {
        if (this.samples)
            return this.samples;
        const all = this.published.basis.lights, n = all.length / 3, count = Math.min(n, this.mostSamples), picked = [];
        for (let i = 0; i < count; i++) {
            const at = 3 * Math.floor((i + 0.5) * n / count), direction = all.slice(at, at + 3);
            picked.push({ weights: this.basis.weights(direction).weights, colour: direction });
        }
        [this.samples] = this.blocks(picked, this.mostSamples);
        return this.samples;
    }

    // Normals and albedo of a tile, which stay.
    surface(tile) {
        if (tile.surface)
            return tile.surface;
        const { gl } = this.device, { layers, guide } = this.published, surface = this.device.target(tile.width, tile.height);
        surface.albedo = this.device.texture(gl.LINEAR);
        gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA16F, tile.width, tile.height);
        gl.bindFramebuffer(gl.FRAMEBUFFER, surface.frame);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT1, gl.TEXTURE_2D, surface.albedo, 0);
        gl.drawBuffers([gl.COLOR_ATTACHMENT0, gl.COLOR_ATTACHMENT1]);
        this.device.begin(surface);
        this.draw(this.device.program(`normals ${layers} ${guide}`, () => normalShader(layers, guide, this.mostSamples)), tile, this.samplesBlock());
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

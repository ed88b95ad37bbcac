// objectmodel.js - a baked object on the graphics card: its numbers, what they are under lights, a drawing of
// it, and where a ray meets it
import { Basis } from './wasm.js';
import { cross, spread } from './lights.js';
import { loadObject } from './objectfile.js';
import { COLOURS_ACROSS, OBJECT_VERTEX, distanceShader, objectShader } from './objectshaders.js';

export const minus = (a, b) => a.map((v, c) => v - b[c]);
export const product = (a, b) => a.reduce((sum, v, c) => sum + v * b[c], 0);

// The basis that an object was baked in, in all three colours the same.
function openBasis({ basis, coefficients: n }, home) {
    const { functions, transform: own } = basis, transform = new Float32Array(3 * n * functions);
    for (let c = 0; c < 3; c++)
        transform.set(own, c * n * functions);
    return Basis.open({ basis: { ...basis, parameter: [] }, functions, planes: n, transform, mean: new Float32Array(3 * functions) }, home);
}

export class ObjectModel {
    static async open(device, address, home) {
        const object = await loadObject(address);
        return new ObjectModel(device, object, object.fixed ? null : await openBasis(object, home));
    }

    constructor(device, object, basis) {
        Object.assign(this, { device, object, basis });
        this.middle = object.min.map((v, c) => (v + object.max[c]) / 2);
        this.across = Math.hypot(...minus(object.max, object.min));
        this.upload();
    }

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
        this.colour = new Float32Array(4 * COLOURS_ACROSS * Math.ceil(o.vectors / COLOURS_ACROSS));
    }

    layersOf(format, type, layers, data) {
        const { device: { gl }, object: o } = this, texture = this.device.texture(gl.NEAREST, gl.TEXTURE_2D_ARRAY);
        gl.texImage3D(gl.TEXTURE_2D_ARRAY, 0, format, o.width, o.height, layers, 0, gl.RGBA, type, data);
        return texture;
    }

    // All means and components under lights, kept in `lit` ({} at first) while the lights are the same.
    light(lit, lights) {
        const { device: { gl }, object: o, colour } = this, n = o.coefficients, sum = new Float32Array(3 * n).fill(o.fixed ? 1 : 0);
        if (lit.lights === lights)
            return lit.texture;
        if (this.basis)
            for (const light of spread(lights, this.basis)) {
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
        lit.texture = lit.texture || this.device.texture(gl.NEAREST);
        gl.bindTexture(gl.TEXTURE_2D, lit.texture);
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, COLOURS_ACROSS, colour.length / 4 / COLOURS_ACROSS, 0, gl.RGBA, gl.FLOAT, colour);
        lit.lights = lights;
        return lit.texture;
    }

    // ------------------------------------------------------------ drawing

    // Into a target with depth, as a camera of the view sees it.
    rasterize(target, camera, program, values) {
        const { device, device: { gl }, object: o } = this, radius = this.across / 2;
        const away = Math.hypot(...minus(this.middle, camera.eye));
        device.begin(target);
        gl.enable(gl.DEPTH_TEST);
        gl.clear(gl.DEPTH_BUFFER_BIT);
        program.set({ ...camera, low: o.min, high: o.max, depths: [Math.max(away - 1.01 * radius, 1e-3 * radius), Math.max(away, 1.2 * radius) + 2 * radius], ...values });
        gl.bindVertexArray(this.mesh);
        gl.drawElements(gl.TRIANGLES, 3 * o.triangles, gl.UNSIGNED_INT, 0);
        gl.bindVertexArray(device.empty);
        gl.disable(gl.DEPTH_TEST);
    }

    draw(target, camera, colours) {
        const { device, object: o } = this, program = device.program(o.side > 1 ? 'object views' : 'object', () => objectShader(o.side > 1), OBJECT_VERTEX);
        this.rasterize(target, camera, program, {
            side: { int: o.side }, components: { int: o.components }, clusters: { texture: this.clusters },
            weights: { texture: this.weights, array: true }, colours: { texture: colours },
            ...(this.frames ? { frames: { texture: this.frames, array: true } } : {}),
        });
    }

    // How far away what is seen lies, along the look, in diagonals of the box; 0 where there is nothing.
    drawDistances(target, camera) {
        this.rasterize(target, camera, this.device.program('distances', distanceShader, OBJECT_VERTEX), { unit: 1 / this.across });
    }

    // ------------------------------------------------------------ rays

    // The corners' positions as floats, made when they are first wanted.
    get corners() {
        const { min, max, position, vertices } = this.object;
        if (!this.places) {
            this.places = new Float32Array(3 * vertices);
            for (let i = 0; i < vertices; i++)
                for (let c = 0; c < 3; c++)
                    this.places[3 * i + c] = min[c] + position[4 * i + c] / 65535 * (max[c] - min[c]);
        }
        return this.places;
    }

    corner(i) { return [this.corners[3 * i], this.corners[3 * i + 1], this.corners[3 * i + 2]]; }

    // The triangles that a plane cuts or touches.
    cutBy(place, normal) {
        const { object: { index } } = this, far = product(place, normal), out = [];
        for (let i = 0; i < index.length / 3; i++) {
            const sides = [0, 1, 2].map((k) => product(this.corner(index[3 * i + k]), normal) - far);
            if (Math.min(...sides) <= 0 && Math.max(...sides) >= 0)
                out.push(i);
        }
        return out;
    }

    // Where a ray first meets the surface, or null (Moeller and Trumbore 1997); of the triangles `only`, if there are any.
    meet(from, way, only = null) {
        const { object: { index } } = this, at = (i) => this.corner(i), count = only ? only.length : index.length / 3;
        let nearest = Infinity;
        for (let k = 0; k < count; k++) {
            const i = 3 * (only ? only[k] : k), a = at(index[i]), u = minus(at(index[i + 1]), a), v = minus(at(index[i + 2]), a), p = cross(way, v), d = product(u, p);
            if (d === 0)
                continue;
            const to = minus(from, a), s = product(to, p) / d, q = cross(to, u), t = product(way, q) / d, far = product(v, q) / d;
            if (s >= 0 && t >= 0 && s + t <= 1 && far > 0 && far < nearest)
                nearest = far;
        }
        return nearest < Infinity ? from.map((x, c) => x + nearest * way[c]) : null;
    }

    close() {
        const { device: { gl } } = this;
        if (this.basis)
            this.basis.close();
        [this.clusters, this.weights, this.frames].forEach((texture) => gl.deleteTexture(texture));
        gl.deleteVertexArray(this.mesh);
    }
}

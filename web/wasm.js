// wasm.js - the library's own arithmetic, compiled to WebAssembly (core/core.c)
import { Failure, addScript, fetchBytes } from './load.js';

let coreBytes = null, corePromise = null;

// Called by relume/core.js while it runs.
export function putCore(base64) {
    const text = atob(base64);
    coreBytes = Uint8Array.from(text, (c) => c.charCodeAt(0));
}

// What the compiled code wants of its surroundings: nothing is printed, and it never ends.
const surroundings = {
    env: { emscripten_notify_memory_growth() {} },
    wasi_snapshot_preview1: {
        proc_exit() { throw new Failure('out of memory'); },
        fd_close: () => 0,
        fd_write: () => 0,
        fd_seek: () => 0,
    },
};

// Servers give the file itself, which is smaller than its script.
async function fetchCore(home) {
    const address = new URL('relume-core.wasm', home).href;
    if (address.startsWith('http'))
        coreBytes = await fetchBytes(address).catch(() => null);
}

async function compile(home) {
    await fetchCore(home);
    if (!coreBytes)
        await addScript(new URL('core.js', home).href).catch(() => {
            throw new Failure('relume/core.js is missing');
        });
    const made = await WebAssembly.instantiate(coreBytes, surroundings);
    if (made.instance.exports._initialize)
        made.instance.exports._initialize();
    return made.instance.exports;
}

function openWasm(home) {
    corePromise = corePromise || compile(home);
    return corePromise;
}

// A typed array's content in the core's memory.
function place(core, array) {
    const at = core.core_allocate(Math.max(array.byteLength, 8));
    if (!at)
        throw new Failure('out of memory');
    new Uint8Array(core.memory.buffer, at, array.byteLength)
        .set(new Uint8Array(array.buffer, array.byteOffset, array.byteLength));
    return at;
}

function placeText(core, text) {
    return place(core, new TextEncoder().encode(`${text}\0`));
}

// The basis of a published file: which weights its planes have for light from a direction.
export class Basis {
    static async open(published, home) {
        const basis = new Basis();
        basis.core = await openWasm(home);
        basis.begin(published);
        return basis;
    }

    // Of the captured pictures themselves, which an interpolant blends.
    pictures({ interpolant, parameter = [] }) {
        const b = this.published.basis, n = b.lights.length / 3, transform = new Float32Array(3 * n * n), basis = new Basis();
        for (let i = 0; i < 3 * n; i++)
            transform[i * n + i % n] = 1;
        basis.core = this.core;
        basis.begin({ basis: { ...b, name: 'table', interpolant, parameter, coefficients: n }, functions: n, planes: n, transform, mean: new Float32Array(3 * n) });
        this.beside.push(basis);
        return basis;
    }

    // Of such a basis: its triangles, nodes and inverse each, 12 numbers.
    triangles() {
        const core = this.core, most = 4 * this.captured + 64, out = core.core_allocate(48 * most), n = core.core_triangles(this.handle, out, most);
        const found = new Float32Array(core.memory.buffer, out, 12 * Math.max(n, 0)).slice();
        core.core_free(out);
        if (n < 0)
            throw new Failure('out of memory');
        return found;
    }

    // Of such a basis: the pictures that it blends, [{ light, direction, weight }].
    around(direction, least = 0) {
        const { weights } = this.weights(direction), { lights } = this.published.basis, out = [];
        for (let i = 0; i < lights.length / 3; i++)
            if (Math.abs(weights[i]) > least)
                out.push({ light: i, direction: lights.slice(3 * i, 3 * i + 3), weight: weights[i] });
        return out;
    }

    begin(published) {
        Object.assign(this, { published, beside: [] });
        const core = this.core, b = published.basis;
        const given = [placeText(core, b.name), placeText(core, b.interpolant || ''),
                       place(core, new Float64Array(4).map((_, i) => b.parameter[i] || 0)),
                       place(core, new Float64Array(b.lights)),
                       place(core, published.transform), place(core, published.mean)];
        this.handle = core.core_open(given[0], given[1], given[2], b.coefficients,
                                     b.hemispherical ? 1 : 0, b.pole === 'y' ? 1 : 0, given[3],
                                     b.lights.length / 3);
        const right = this.handle && core.core_functions(this.handle) === published.functions &&
                      core.core_turn(this.handle, given[4], given[5], published.planes);
        given.forEach((at) => core.core_free(at));
        if (!right)
            throw new Failure(`scene.json: basis ${b.name} is not what this page knows`);
        this.size = 3 * (published.planes + 1);
        this.captured = b.lights.length / 3;
        this.out = core.core_allocate(4 * this.size);
    }

    // { share, from, weights }: [3][planes + 1], the last of each three being a constant; `from`: the direction
    // whose weights they are, where light from beyond the captured lights is shown by one at their border.
    weights(direction) {
        const share = this.core.core_weights(this.handle, ...direction, this.out), at = this.core.core_from(this.handle);
        const from = [...new Float64Array(this.core.memory.buffer, at, 3)];
        return { share, from, weights: new Float32Array(this.core.memory.buffer, this.out, this.size).slice() };
    }

    // Lights that stand for a lat-long map: [{ direction, rgb }].
    environment(map, rotateDeg) {
        const core = this.core, given = place(core, map.rgb), out = core.core_allocate(48 * this.captured);
        const n = core.core_environment(this.handle, given, map.width, map.height, rotateDeg, out);
        const found = new Float64Array(core.memory.buffer, out, Math.max(6 * n, 0)).slice();
        core.core_free(given);
        core.core_free(out);
        if (n < 0)
            throw new Failure('out of memory');
        return Array.from({ length: n }, (_, i) => (
            { direction: [...found.subarray(6 * i, 6 * i + 3)], rgb: [...found.subarray(6 * i + 3, 6 * i + 6)] }));
    }

    close() {
        this.beside.forEach((basis) => basis.close());
        if (this.handle)
            this.core.core_close(this.handle);
        this.handle = 0;
    }
}

// core.mjs - the page's WebAssembly beside the same sources compiled natively: core.mjs CORE.wasm < CASES
// prints how many weights are equal bit by bit and the largest difference, of a case's largest weight.
import { readFileSync } from 'node:fs';

const nothing = () => 0;
const made = await WebAssembly.instantiate(readFileSync(process.argv[2]), {
    env: { emscripten_notify_memory_growth: nothing },
    wasi_snapshot_preview1: { proc_exit: nothing, fd_close: nothing, fd_write: nothing, fd_seek: nothing },
});
const core = made.instance.exports;
core._initialize?.();

function place(array) {
    const at = core.core_allocate(array.byteLength + 8);
    new Uint8Array(core.memory.buffer, at, array.byteLength).set(new Uint8Array(array.buffer, 0, array.byteLength));
    return at;
}
const text = (t) => place(Uint8Array.from([...t, '\0'].map((c) => c.charCodeAt(0))));

let all = 0, equal = 0, most = 0, share = 0, environment = 0, library = Infinity;
for (const line of readFileSync(0, 'utf8').trim().split('\n')) {
    const c = JSON.parse(line);
    if (c.library !== undefined) {
        library = c.library;
        continue;
    }
    const f = c.functions, identity = new Float32Array(3 * f * f);
    for (let i = 0; i < 3 * f; i++)
        identity[i * f + i % f] = 1;
    const handle = core.core_open(text(c.basis), text(c.interpolant), place(new Float64Array(c.parameter)), c.coefficients,
                                  c.hemispherical, c.pole, place(new Float64Array(c.lights)), c.lights.length / 3);
    if (!handle || core.core_functions(handle) !== f || !core.core_turn(handle, place(identity), place(new Float32Array(3 * f)), f))
        throw new Error(`${c.basis} ${c.interpolant} cannot be opened`);
    const out = core.core_allocate(12 * (f + 1));
    for (const answer of c.answers) {
        const got = core.core_weights(handle, ...answer.direction, out);
        const weights = new Float32Array(core.memory.buffer, out, f), bits = new Uint32Array(core.memory.buffer, out, f);
        const wanted = new Float32Array(new Uint32Array(answer.bits).buffer), size = Math.max(...wanted.map(Math.abs));
        share = Math.max(share, Math.abs(got - answer.share));
        for (let i = 0; i < f; i++) {
            all++;
            equal += bits[i] === answer.bits[i];
            most = Math.max(most, Math.abs(weights[i] - wanted[i]) / size);
        }
    }
    if (!c.environment)
        continue;
    const map = new Float32Array(3 * 16 * 32).map((_, i) => i * 37 % 101), lights = core.core_allocate(48 * 64);
    const n = core.core_environment(handle, place(map), 32, 16, 30, lights);
    const found = new Float64Array(core.memory.buffer, lights, 6 * n);
    environment = Math.max(environment, n * 6 === c.environment.length ? 0 : 1,
                           ...found.map((v, i) => Math.abs(v - c.environment[i]) / 50));
}
console.log(`weights ${all} equal ${equal} differ ${most} share ${share} environment ${environment} library ${library}`);

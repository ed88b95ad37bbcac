// objectfile.js - object.json and object.bin, checked before anything is made of them
import { Failure, loadBytes, loadJson } from './load.js';

const NEWEST_OBJECT = 1, MOST_SIDE_OF_ATLAS = 4096, MOST_VECTORS = 1 << 22, NOTHING = 65535;

function demand(good, what) {
    if (!good)
        throw new Failure(`object.json: ${what}`);
}

const whole = (value, least, most) => Number.isInteger(value) && value >= least && value <= most;
const three = (list) => Array.isArray(list) && list.length === 3 && list.every(Number.isFinite);

// [coefficients][functions]; where there is none they are the same.
function transformOf(basis, n) {
    const count = n * basis.functions;
    if (basis.transform === undefined)
        return Float32Array.from({ length: count }, (_, i) => (i % (basis.functions + 1) === 0 ? 1 : 0));
    let text = '';
    try {
        text = atob(basis.transform);
    } catch { /* it is damaged */ }
    demand(text.length === 4 * count, 'its transform is damaged');
    return new Float32Array(Uint8Array.from(text, (c) => c.charCodeAt(0)).buffer);
}

function checkObject(o) {
    demand(o && o.format === 'relume-web-object', 'not an object of relume publish');
    demand(whole(o.version, 1, 1e6), 'no version');
    if (o.version > NEWEST_OBJECT)
        throw new Failure(`this object was published by a newer relume (format ${o.version}, this page knows ${NEWEST_OBJECT}); publish it again with it`);
    demand(whole(o.width, 1, MOST_SIDE_OF_ATLAS) && whole(o.height, 1, MOST_SIDE_OF_ATLAS), 'size of the atlas');
    demand(whole(o.side, 1, 32) && whole(o.clusters, 1, 1024) && whole(o.components, 1, 256), 'views, clusters or components');
    demand(whole(o.coefficients, 1, 4096) && whole(o.triangles, 1, 1 << 22) && whole(o.vertices, 1, 3 * o.triangles), 'numbers of its mesh');
    demand(three(o.min) && three(o.max) && o.min.some((v, c) => v < o.max[c]), 'its box');
    o.views = o.side * o.side;
    o.vectors = o.clusters * (1 + o.components) * o.views;
    demand(o.vectors <= MOST_VECTORS, 'views, clusters or components');
    const { basis: b } = o;
    demand(o.fixed === true || (b && typeof b.name === 'string' && b.coefficients === o.coefficients && Array.isArray(b.lights) &&
        b.lights.length % 3 === 0 && whole(b.lights.length / 3, 1, 4096) && b.lights.every(Number.isFinite) && whole(b.functions, 1, 4096)), 'no basis');
    if (!o.fixed)
        b.transform = transformOf(b, o.coefficients);
}

// What half floats mean.
function halvesToFloats(halves) {
    const table = new Float32Array(65536);
    for (let h = 0; h < 65536; h++) {
        const exponent = (h >> 10) & 31, part = h & 1023;
        const value = exponent ? (1 + part / 1024) * 2 ** (exponent - 15) : part * 2 ** -24;
        table[h] = exponent === 31 ? 0 : h & 32768 ? -value : value;
    }
    return Float32Array.from(halves, (h) => table[h]);
}

// The arrays of object.bin, in its order; each begins at a multiple of four bytes.
function arraysOf(o, bytes) {
    const texels = o.width * o.height;
    let at = 0;
    const take = (Kind, count) => {
        const end = at + count * Kind.BYTES_PER_ELEMENT;
        if (end > bytes.length)
            throw new Failure('object.bin is damaged');
        const array = new Kind(bytes.buffer, bytes.byteOffset + at, count);
        at = Math.ceil(end / 4) * 4;
        return array;
    };
    const a = {
        index: take(Uint32Array, 3 * o.triangles), value: halvesToFloats(take(Uint16Array, 3 * o.vectors * o.coefficients)),
        position: take(Uint16Array, 4 * o.vertices), place: take(Uint16Array, 2 * o.vertices),
        cluster: take(Uint16Array, texels), weight: take(Uint8Array, 4 * Math.ceil(o.components / 4) * texels),
        frame: o.side > 1 ? take(Int8Array, 8 * texels) : null,
    };
    if (at !== bytes.length || a.index.some((i) => i >= o.vertices) || a.cluster.some((c) => c >= o.clusters && c !== NOTHING))
        throw new Failure('object.bin is damaged');
    return a;
}

// An object: what object.json has, with its arrays.
export async function loadObject(address) {
    const object = await loadJson(address);
    checkObject(object);
    const bytes = await loadBytes(new URL('object.bin', address).href);
    return Object.assign(object, arraysOf(object, bytes));
}

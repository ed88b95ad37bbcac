// profile.js - what lies along a line: the height of the surface, as relume_profile_of_normals and
// relume_profile_of_heights have it, or the colours that are seen; after src/exchange/notes/measure.c
import { Failure, loadBytes } from './load.js';
import { showProfile } from './profilegraph.js';
import { decodePicture } from './tiles.js';
import { pixelsOf } from './views.js';

const BLOCK = 256;      // pixels a side, of normals that are read at once
const MOST_BLOCKS = 8;  // that are kept
const LONGEST = 100000; // pixels

const apart = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);

// Once a pixel along the legs of a line, and its end: [{ along, place }].
function layOut(places) {
    const legs = places.slice(1).map((p, i) => apart(places[i], p)), length = legs.reduce((sum, l) => sum + l, 0);
    if (!(length <= LONGEST))
        throw new Failure(`this line is ${Math.round(length)} pixels long; profiles have at most ${LONGEST}`);
    const n = Math.ceil(length) + 1, out = [];
    let leg = 0, before = 0;
    for (let k = 0; k < n; k++) {
        const along = k < n - 1 ? k : length;
        while (leg + 2 < places.length && along > before + legs[leg])
            before += legs[leg++];
        const t = legs[leg] > 0 ? Math.min((along - before) / legs[leg], 1) : 0;
        out.push({ along, place: [0, 1].map((c) => (1 - t) * places[leg][c] + t * places[leg + 1][c]) });
    }
    return out;
}

// Bilinear between the pixels around a place that are known; null where none is. pixel(x, y): numbers or null.
function sample(place, pixel) {
    const x = place[0] - 0.5, y = place[1] - 0.5, left = Math.floor(x), top = Math.floor(y);
    let sum = null, share = 0;
    for (let k = 0; k < 4; k++) {
        const column = left + (k & 1), row = top + (k >> 1), weight = (1 - Math.abs(x - column)) * (1 - Math.abs(y - row));
        const values = weight > 0 ? pixel(column, row) : null;
        if (!values)
            continue;
        sum = values.map((v, c) => (sum ? sum[c] : 0) + weight * v);
        share += weight;
    }
    return sum && sum.map((v) => v / share);
}

// Normals of a flat picture at full size, block by block as they are wanted.
class Normals {
    constructor(viewer) {
        Object.assign(this, { viewer, blocks: new Map() });
    }

    async need(place) {
        for (const dx of [-1, 1])
            for (const dy of [-1, 1]) {
                const x = Math.floor((place[0] + dx) / BLOCK), y = Math.floor((place[1] + dy) / BLOCK), key = `${x},${y}`;
                if (this.blocks.has(key) || this.isOutside(x * BLOCK, y * BLOCK))
                    continue;
                if (this.blocks.size >= MOST_BLOCKS)
                    this.blocks.delete(this.blocks.keys().next().value);
                this.blocks.set(key, await this.viewer.patch('normals', x * BLOCK, y * BLOCK, BLOCK));
            }
    }

    isOutside(x, y) {
        const { width, height } = this.viewer.published;
        return x >= width || y >= height || x + BLOCK <= 0 || y + BLOCK <= 0;
    }

    pixel(x, y) {
        const block = this.blocks.get(`${Math.floor(x / BLOCK)},${Math.floor(y / BLOCK)}`);
        const at = 4 * ((BLOCK - 1 - (y & (BLOCK - 1))) * BLOCK + (x & (BLOCK - 1)));
        return block && block[at + 3] > 0 && block[at + 2] > 0 ? [...block.subarray(at, at + 3)] : null;
    }
}

// Slopes are added up along the line; gaps are level.
async function heightsOfNormals(rows, viewer) {
    const normals = new Normals(viewer), found = [];
    for (const { place } of rows) {
        await normals.need(place);
        found.push(sample(place, (x, y) => normals.pixel(x, y)));
    }
    let height = 0, begun = false;
    rows.forEach((row, k) => {
        const to = Math.min(k + 1, rows.length - 1), length = apart(rows[to - 1].place, rows[to].place);
        const direction = [0, 1].map((c) => (length > 0 ? (rows[to].place[c] - rows[to - 1].place[c]) / length : 0));
        const slope = (n) => (-n[0] * direction[0] + n[1] * direction[1]) / n[2];
        begun = begun || !!found[k];
        row.values = begun ? [height] : null;
        if (k + 1 < rows.length && found[k] && found[k + 1])
            height += 0.5 * (slope(found[k]) + slope(found[k + 1])) * length;
    });
}

async function heightsOfDepth(rows, { published }) {
    const [view] = published.views, bytes = await loadBytes(`${published.base}${view.name}/depth.png`);
    const { width, height, data } = pixelsOf(await decodePicture(bytes, 'image/png'));
    const size = (published.window.max[0] - published.window.min[0]) / width;
    let first = null;
    const pixel = (x, y) => {
        const i = 4 * (y * width + x), code = x >= 0 && y >= 0 && x < width && y < height ? 256 * data[i] + data[i + 1] : 0;
        return code ? [-1 / (view.depth_min + (code - 1) * view.depth_step) / size] : null;
    };
    for (const row of rows) {
        const found = sample(row.place, pixel);
        first = first === null && found ? found[0] : first;
        row.values = found && [found[0] - first];
    }
}

// Linear light as it is seen now, before exposure.
function colours(rows, viewer) {
    const { width, height, data } = viewer.lightSeen();
    const pixel = (x, y) => {
        const i = 4 * ((height - 1 - y) * width + x), there = x >= 0 && y >= 0 && x < width && y < height && data[i + 3] > 0;
        return there ? [0, 1, 2].map((c) => Math.max(data[i + c], 0) / data[i + 3]) : null;
    };
    for (const row of rows) {
        const at = viewer.toCanvas(row.place);
        row.values = at && sample(at, pixel);
    }
}

// The profile of a line: { names, rows: [{ along, place, values }] }, values being null where nothing is known.
async function profileOf(viewer, places) {
    const rows = layOut(places), { published } = viewer, flat = published.projection === 'planar' && published.window.camera === 'orthographic';
    if (!flat)
        colours(rows, viewer);
    else if (published.views[0].depth)
        await heightsOfDepth(rows, viewer);
    else
        await heightsOfNormals(rows, viewer);
    return { at: ['along_px', 'x', 'y'], names: flat ? ['height_px'] : ['red', 'green', 'blue'], rows };
}

// What the panel of notes shows of a note's line, and a sentence.
export async function profileOfNote(viewer, note, notes) {
    return showProfile(await profileOf(viewer, note.places), note, notes, 'pixels');
}

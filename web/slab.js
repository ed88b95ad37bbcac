// slab.js - a light slab: looked at from any place before it; after src/relight/view/slab_frame.c
import { lensShader, slabShader } from './viewshaders.js';
import { Views } from './views.js';
import { levelFor } from './paint.js';

const MOST_CELLS = 64;  // of a frame

function linesOf(values) {
    const sorted = [...values].sort((a, b) => a - b), size = sorted[sorted.length - 1] - sorted[0];
    return sorted.filter((v, i) => i === 0 || v - sorted[i - 1] > 1e-6 * size);
}

const nearestOf = (lines, at) => lines.reduce((best, v, i) => (Math.abs(v - at) < Math.abs(lines[best] - at) ? i : best), 0);

// The cells, [low, high] lines each, that lie between two places.
function cellsBetween(lines, from, to) {
    const last = lines.length - 1;
    if (!last)
        return [[0, 0]];
    const clamp = (v) => Math.min(Math.max(v, lines[0]), lines[last]);
    const [low, high] = [clamp(Math.min(from, to)), clamp(Math.max(from, to))], cells = [];
    for (let i = 0; i < last; i++)
        if (lines[i] <= high && (lines[i + 1] > low || i + 1 === last))
            cells.push([i, i + 1]);
    return cells;
}

export class Slab {
    constructor(published, painter, device) {
        Object.assign(this, { published, painter, device });
        this.u = linesOf(published.views.map((v) => v.uv[0]));
        this.v = linesOf(published.views.map((v) => v.uv[1]));
        this.at = new Map(published.views.map((view, i) =>
            [`${nearestOf(this.u, view.uv[0])},${nearestOf(this.v, view.uv[1])}`, i]));
        this.views = new Views(device, published, painter);
        this.grid = [this.u[0], this.v[0], this.u[this.u.length - 1], this.v[this.v.length - 1]];
    }

    // Where an eye begins: the middle of the cameras.
    middle() {
        const { grid } = this;
        return [(grid[0] + grid[2]) / 2, (grid[1] + grid[3]) / 2, this.published.slab.uv_plane_z];
    }

    fit(width, height) {
        const { published } = this, scale = Math.min(width / published.width, height / published.height);
        return { x: published.width / 2, y: published.height / 2, scale };
    }

    // What all cells of a frame share; null for an eye that sees nothing.
    frameOf(target, camera) {
        const { slab, width, height } = this.published, { at, eye } = camera;
        const reach = (slab.uv_plane_z - eye[2]) / (slab.st_plane_z - eye[2]);
        const ahead = (eye[2] - slab.st_plane_z) * (slab.uv_plane_z - slab.st_plane_z) > 0;
        const left = target.width / 2 - at.x * at.scale, top = target.height / 2 - at.y * at.scale;
        return !ahead ? null : {
            picture: [left, top, left + width * at.scale, top + height * at.scale],
            frame: [target.width, target.height],
            eye: [eye[0], eye[1], reach],
            st: [...slab.st_min, ...slab.st_max],
            grid: this.grid,
        };
    }

    cells(shared) {
        const { eye, st } = shared, hit = (e, s) => e + eye[2] * (s - e);
        const across = cellsBetween(this.u, hit(eye[0], st[0]), hit(eye[0], st[2]));
        const down = cellsBetween(this.v, hit(eye[1], st[1]), hit(eye[1], st[3]));
        return across.flatMap((c) => down.map((r) => ({ c, r }))).slice(0, MOST_CELLS);
    }

    drawCell(target, kind, shared, { c, r }) {
        const corners = [[c[0], r[0]], [c[1], r[0]], [c[0], r[1]], [c[1], r[1]]]
            .map(([i, j]) => this.at.get(`${i},${j}`));
        const deep = corners.map((view) => this.views.hasDepth(view)).every((known) => known);
        const slot = corners.map((view) => this.views.paint(view, kind));
        const program = this.device.program(`slab ${deep}`, () => slabShader(deep));
        this.device.begin(target, { clear: false });
        program.set({ ...shared, views: { texture: this.views.texture(kind), array: true }, slot,
                      cell: [this.u[c[0]], this.v[r[0]], this.u[c[1]], this.v[r[1]]],
                      ...(deep ? { disparities: { texture: this.views.depthTexture, array: true }, range: this.views.range } : {}) });
        program.draw();
    }

    // All cameras within the lens, averaged.
    drawLens(target, kind, shared, camera) {
        const { uv_plane_z: uvZ, st_plane_z: stZ } = this.published.slab, { u, v } = this, radius = camera.aperture / 2;
        const m = (camera.focus - stZ) / (uvZ - stZ), eye = camera.eye;
        const step = (lines, i) => [i > 0 ? lines[i] - lines[i - 1] : 1e30, i + 1 < lines.length ? lines[i + 1] - lines[i] : 1e30];
        const near = (lines, i, at) => lines.length === 1 ||
            (lines[i] - step(lines, i)[0] < at + radius && lines[i] + step(lines, i)[1] > at - radius);
        for (let j = 0; j < v.length; j++)
            for (let i = 0; i < u.length; i++) {
                if (!near(u, i, eye[0]) || !near(v, j, eye[1]))
                    continue;
                const layer = this.views.paint(this.at.get(`${i},${j}`), kind);
                const program = this.device.program('lens', lensShader);
                this.device.begin(target, { clear: false, add: true });
                program.set({ ...shared, views: { texture: this.views.texture(kind), array: true }, layer,
                              camera: [u[i], v[j]], lens: [radius, m / (1 - m)], steps: [...step(u, i), ...step(v, j)] });
                program.draw();
            }
    }

    draw(target, kind, camera) {
        const shared = this.frameOf(target, camera);
        this.views.setLevel(Math.min(levelFor(this.published, camera.at.scale) + camera.coarser, this.published.levels.length - 1));
        this.device.begin(target);
        if (!shared)
            return;
        if (camera.aperture > 0)
            this.drawLens(target, kind, shared, camera);
        else
            this.cells(shared).forEach((cell) => this.drawCell(target, kind, shared, cell));
    }

    close() {
        this.views.close();
    }
}

// paint.js - tiles of a view into a frame or a texture, the coarse ones that are there under the fine
// ones that are still to come
import { loadPicture } from './tiles.js';
import { maskShader, tileShader } from './tileshaders.js';

// The level whose texels are as large as pixels, or smaller; `scale` is pixels a texel of level 0.
export function levelFor(published, scale) {
    const level = Math.floor(Math.log2(1 / Math.max(scale, 1e-9)) + 0.02);
    return Math.min(Math.max(level, 0), published.levels.length - 1);
}

export class Painter {
    constructor(device, published, tiles, relighter, changed) {
        Object.assign(this, { device, published, tiles, relighter, changed });
        this.masks = new Map();
        this.complete = true;
        this.rough = false;       // shadows and highlights will move that do not yet
        this.allowed = Infinity;  // pixels that may be relit in this frame
    }

    // The tiles of a level that touch a part of the picture (level 0 pixels).
    touching(level, part) {
        const size = this.published.tile * 2 ** level, out = [];
        const most = [this.tiles.columns(level) - 1, this.tiles.rows(level) - 1];
        const from = [0, 1].map((i) => Math.max(0, Math.floor(part[i] / size)));
        const to = [0, 1].map((i) => Math.min(most[i], Math.floor((part[i + 2] - 1e-6) / size)));
        for (let y = from[1]; y <= to[1]; y++)
            for (let x = from[0]; x <= to[0]; x++)
                out.push([x, y]);
        const middle = [0, 1].map((i) => (part[i] + part[i + 2]) / (2 * size) - 0.5);
        const away = ([x, y]) => Math.hypot(x - middle[0], y - middle[1]);
        return out.sort((a, b) => away(a) - away(b));
    }

    // What shall be drawn of `level` and, where tiles of it are missing, of coarser ones; coarse first.
    chosen(view, level, part) {
        const last = this.published.levels.length - 1, lists = [];
        const early = [...new Set([last, Math.max(this.published.first, level)])].filter((l) => l > level)
            .flatMap((l) => this.touching(l, part).map(([x, y]) => this.tiles.get(view, l, x, y)));
        // the first picture is loaded before the full one
        const waiting = early.some((tile) => tile.state !== 'ready' && tile.state !== 'failed');
        let missing = true;
        for (let l = level; l <= last && missing; l++) {
            const all = this.touching(l, part);
            const known = all.map(([x, y]) => (l === level && !waiting ? this.tiles.get(view, l, x, y)
                : this.tiles.tiles.get(`${view}/${l}_${x}_${y}`)));
            const found = known.filter((t) => t && t.state === 'ready');
            missing = found.length < all.length;
            // what has failed does not come
            if (l === level && known.some((t) => !t || !['ready', 'failed'].includes(t.state)))
                this.complete = false;
            lists.unshift(found);
        }
        return lists.flat();
    }

    // What a tile shows; null when that would take too long in this frame. Old light is better than none.
    textureOf(tile, kind) {
        const done = kind === 'light' ? this.relighter.isLit(tile) : tile.surface;
        this.rough = this.rough || (kind === 'light' && this.relighter.isRough(tile));
        if (!done && (this.allowed <= 0 || (kind === 'light' && !this.relighter.ready(tile)))) {
            const older = kind === 'light' && this.relighter.older(tile);
            this.complete = false;
            return older ? older.texture : null;
        }
        if (!done)
            this.allowed -= tile.width * tile.height;
        return this.relighter.texture(tile, kind);
    }

    mask(view) {
        if (!this.masks.has(view.name)) {
            this.masks.set(view.name, null);
            loadPicture(this.published, view, true).then((picture) => {
                const { gl } = this.device, texture = this.device.texture(gl.LINEAR);
                gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, picture);
                this.masks.set(view.name, texture);
                this.changed();
            }, this.tiles.failed);
        }
        return this.masks.get(view.name);
    }

    // Whether a texture that keeps what was painted needs it again; `cache` remembers what it holds.
    isNews(cache, view, kind, tiles) {
        const masked = view.mask && kind === 'light' && this.mask(view) ? 'masked' : '';
        const holds = `${view.name} ${masked} ${tiles.map(([t]) => `${t.key} ${kind === 'light' ? this.relighter.older(t).version : 0}`).join()}`;
        const news = cache.holds !== holds;
        cache.holds = holds;
        return news;
    }

    // The box of the target that a part of the picture fills; `map`: scale and the place of the
    // picture's left top in the target, pixels, rows down (`flip`: the target's rows run down too).
    box(target, map, part) {
        const x = [part[0], part[2]].map((v) => (v * map.scale + map.left) / target.width);
        const y = [part[1], part[3]].map((v) => (v * map.scale + map.top) / target.height);
        return map.flip ? [x[0], y[1], x[1], y[0]] : [x[0], 1 - y[1], x[1], 1 - y[0]];
    }

    // `target` gets the view's `kind` (relight.js) at `level`; `map.cache`, if any: isNews.
    paint(target, view, kind, level, map, part) {
        const { gl } = this.device, { tile: size, width, height } = this.published;
        const tiles = this.chosen(view.name, level, part).map((tile) => [tile, this.textureOf(tile, kind)])
            .filter(([, texture]) => texture);
        if (map.cache && !this.isNews(map.cache, view, kind, tiles))
            return;
        this.device.begin(target);
        this.scissor(target, map, [0, 0, width, height]);
        for (const [tile, texture] of tiles) {
            const step = 2 ** tile.level, left = tile.x * size * step, top = tile.y * size * step;
            const per = 1 / (map.scale * step);
            const program = this.device.program('tile', tileShader);
            program.set({ tile: { texture }, step_: [per / tile.width, per / tile.height], several: per > 1.01 ? 1 : 0 });
            program.draw(this.box(target, map, [left, top, left + tile.width * step, top + tile.height * step]));
        }
        if (view.mask && kind === 'light' && this.mask(view)) {
            gl.enable(gl.BLEND);
            gl.blendFunc(gl.ZERO, gl.SRC_COLOR);
            const program = this.device.program('mask', maskShader);
            program.set({ mask: { texture: this.mask(view) } });
            program.draw(this.box(target, map, [0, 0, width, height]));
        }
        gl.disable(gl.SCISSOR_TEST);
    }

    // Nothing beside the picture, whose last texels of a coarse level reach beyond it.
    scissor(target, map, part) {
        const { gl } = this.device, [l, b, r, t] = this.box(target, map, part);
        const low = Math.min(b, t), high = Math.max(b, t), w = target.width, h = target.height;
        const x = Math.max(0, Math.round(l * w)), y = Math.max(0, Math.round(low * h));
        gl.enable(gl.SCISSOR_TEST);
        gl.scissor(x, y, Math.max(0, Math.round(r * w) - x), Math.max(0, Math.round(high * h) - y));
    }
}

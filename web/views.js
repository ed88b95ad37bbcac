// views.js - whole views as layers of a texture, where several are looked at together, and their
// disparities
import { Recent } from './recent.js';
import { loadPicture } from './tiles.js';

const MOST_LAYERS = 24;

// Depth along rays to disparities, as relume_slab_disparity: 0 on the st plane, rising towards the
// cameras; -1 the background, -2 beside a surface.
function disparitiesOf(picture, view, slab) {
    const { width, height, data } = picture, out = new Float32Array(width * height);
    const extent = [0, 1].map((i) => slab.st_max[i] - slab.st_min[i]), ahead = slab.uv_plane_z - slab.st_plane_z;
    const code = (i) => 256 * data[4 * i] + data[4 * i + 1];
    const beside = (x, y) => (x > 0 && code(y * width + x - 1)) || (x + 1 < width && code(y * width + x + 1)) ||
        (y > 0 && code((y - 1) * width + x)) || (y + 1 < height && code((y + 1) * width + x));
    let low = Infinity, high = -Infinity;
    for (let y = 0; y < height; y++)
        for (let x = 0; x < width; x++) {
            const i = y * width + x, v = code(i);
            if (!v) {
                out[i] = beside(x, y) ? -2 : -1;
                continue;
            }
            const depth = 1 / (view.depth_min + (v - 1) * view.depth_step);
            const s = slab.st_min[0] + (x + 0.5) / width * extent[0] - view.uv[0];
            const t = slab.st_max[1] - (y + 0.5) / height * extent[1] - view.uv[1];
            const m = 1 - depth / Math.hypot(s, t, ahead);
            out[i] = m < 0.999 ? m / (1 - m) : 999;
            low = Math.min(low, out[i]);
            high = Math.max(high, out[i]);
        }
    return { data: out, low, high };
}

// The bytes of a decoded picture.
export function pixelsOf(picture) {
    if (picture instanceof ImageData)
        return picture;
    const canvas = Object.assign(document.createElement('canvas'), { width: picture.width, height: picture.height });
    const context = canvas.getContext('2d', { willReadFrequently: true, colorSpace: 'srgb' });
    context.drawImage(picture, 0, 0);
    return context.getImageData(0, 0, picture.width, picture.height);
}

export class Views {
    constructor(device, published, painter) {
        Object.assign(this, { device, published, painter });
        this.layers = Math.min(published.views.length, MOST_LAYERS);
        this.slots = new Recent();  // view -> its layer
        this.free = Array.from({ length: this.layers }, (_, i) => i);
        this.depths = new Map();
        this.range = [Infinity, -Infinity];
        this.stores = {};
        this.level = -1;
    }

    store(name, format, width, height) {
        const { gl } = this.device, filter = format === gl.RGBA16F ? gl.LINEAR : gl.NEAREST;
        const texture = this.device.texture(filter, gl.TEXTURE_2D_ARRAY);
        gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, format, width, height, this.layers);
        return texture;
    }

    setLevel(level) {
        const { gl } = this.device, { width, height } = this.published.levels[level];
        if (level === this.level)
            return;
        Object.values(this.stores).forEach((texture) => gl.deleteTexture(texture));
        this.stores = {};
        this.caches = new Map();
        this.level = level;
        this.size = { width, height };
        this.frame = this.frame || gl.createFramebuffer();
    }

    // Of a kind (relight.js).
    texture(kind) {
        this.stores[kind] = this.stores[kind] ||
            this.store(kind, this.device.gl.RGBA16F, this.size.width, this.size.height);
        return this.stores[kind];
    }

    slot(index) {
        let slot = this.slots.use(index);
        if (slot === undefined) {
            this.slots.trim(() => !this.free.length, (layer) => this.free.push(layer));
            slot = this.free.pop();
            this.slots.set(index, slot);
            const depth = this.depths.get(index);
            if (depth && depth.data)
                this.uploadDepth(slot, depth);
        }
        return slot;
    }

    // Paints a view into its layer, which is returned.
    paint(index, kind) {
        const { gl } = this.device, { width, height } = this.size, slot = this.slot(index), texture = this.texture(kind);
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.frame);
        gl.framebufferTextureLayer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, texture, 0, slot);
        const target = { frame: this.frame, width, height }, key = `${kind} ${slot}`;
        if (!this.caches.has(key))
            this.caches.set(key, {});
        this.painter.paint(target, this.published.views[index], kind, this.level,
                           { scale: 2 ** -this.level, left: 0, top: 0, flip: true, cache: this.caches.get(key) },
                           [0, 0, this.published.width, this.published.height]);
        return slot;
    }

    uploadDepth(slot, depth) {
        const { gl } = this.device, { width, height } = this.published;
        this.depthTexture = this.depthTexture || this.store('depth', gl.R32F, width, height);
        gl.bindTexture(gl.TEXTURE_2D_ARRAY, this.depthTexture);
        gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, slot, width, height, 1, gl.RED, gl.FLOAT, depth.data);
    }

    // Whether the disparities of a view are there; they are loaded by and by.
    hasDepth(index) {
        const view = this.published.views[index];
        if (!view.depth)
            return false;
        if (!this.depths.has(index)) {
            this.depths.set(index, {});
            this.loadDepth(index, view).catch((error) => {
                view.depth = false;  // it does not come: the view is shown as a flat one
                this.painter.tiles.failed(error);
                this.painter.changed();
            });
        }
        const depth = this.depths.get(index);
        if (!depth.data)
            this.painter.complete = false;
        return !!depth.data;
    }

    async loadDepth(index, view) {
        const picture = await loadPicture(this.published, view, false);
        const depth = disparitiesOf(pixelsOf(picture), view, this.published.slab);
        this.depths.set(index, depth);
        this.range = [Math.min(this.range[0], depth.low), Math.max(this.range[1], depth.high)];
        if (this.slots.has(index))
            this.uploadDepth(this.slots.get(index), depth);
        this.painter.changed();
    }

    close() {
        Object.values(this.stores).forEach((texture) => this.device.gl.deleteTexture(texture));
        this.device.gl.deleteTexture(this.depthTexture || null);
    }
}

// tiles.js - tiles of a view: loaded when wanted, decoded by the browser, relit when lights change,
// forgotten when others need the memory
import { Failure, loadBytes } from './load.js';
import { Recent } from './recent.js';

const MOST_BYTES = 512 << 20;  // of textures
const MOST_LOADING = 8;

// The pictures of a .bin file.
export function partsOf(bytes, count, address) {
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const damaged = () => new Failure(`${address.split('/').slice(-2).join('/')} is damaged`);
    if (bytes.length < 4 + 4 * count || view.getUint32(0, true) !== count)
        throw damaged();
    const parts = [];
    let at = 4 + 4 * count;
    for (let i = 0; i < count; i++) {
        const size = view.getUint32(4 + 4 * i, true);
        if (at + size > bytes.length)
            throw damaged();
        parts.push(bytes.subarray(at, at + size));
        at += size;
    }
    return parts;
}

// A picture as it is coded: no colour management, no alpha.
export function decodePicture(bytes, type, options = {}) {
    return createImageBitmap(new Blob([bytes], { type }), { colorSpaceConversion: 'none', premultiplyAlpha: 'none', ...options });
}

// The depth or the mask of a view.
export async function loadPicture(published, view, mask) {
    if (published.local)
        return published.local.picture(view, mask);
    return decodePicture(await loadBytes(`${published.base}${view.name}/${mask ? 'mask' : 'depth'}.png`), 'image/png');
}

// All tiles of one file. `changed` is called when one has come, `failed` with a sentence.
export class Tiles {
    constructor(device, published, { changed, failed }) {
        Object.assign(this, { device, published, changed, failed });
        this.tiles = new Recent();
        this.queue = [];
        this.loading = 0;
        this.bytes = 0;
        this.clock = 0;
        this.received = 0;
        this.more = null;  // what only some files and lights need (more.js)
    }

    columns(level) { return Math.ceil(this.published.levels[level].width / this.published.tile); }
    rows(level) { return Math.ceil(this.published.levels[level].height / this.published.tile); }

    // A tile; it is loaded by and by unless it is there. What is asked for first comes first.
    get(view, level, x, y) {
        const key = `${view}/${level}_${x}_${y}`;
        let tile = this.tiles.use(key);
        if (!tile) {
            const { width, height } = this.published.levels[level], size = this.published.tile;
            tile = { key, view, level, x, y, width: Math.min(size, width - x * size), height: Math.min(size, height - y * size),
                     state: 'new', codes: null, lit: [], surface: null };
            this.tiles.set(key, tile);
        }
        tile.used = this.clock;
        if (tile.state === 'new') {
            tile.state = 'queued';
            this.queue.push(tile);
        }
        return tile;
    }

    // Before a frame: what has not begun to load must be asked for again.
    begin() {
        this.clock++;
        for (const tile of this.queue)
            tile.state = 'new';
        this.queue = [];
    }

    // After it.
    end() {
        while (this.loading < MOST_LOADING && this.queue.length)
            this.load(this.queue.shift());
        this.forget();
    }

    get busy() { return this.loading + this.queue.length; }

    // The pictures of a file of a tile, decoded; among AVIF those that are smaller as JPEG.
    async decoded(tile, avif) {
        const address = `${this.published.base}${tile.key}${avif ? '.avif' : ''}.bin`, bytes = await loadBytes(address);
        this.received += bytes.length;
        return Promise.all(partsOf(bytes, this.published.layers, address)
            .map((part) => decodePicture(part, part[0] === 0xff ? 'image/jpeg' : 'image/avif').catch(() => {
                throw new Failure(this.published.pictures === 'avif' ? 'this browser does not decode its AVIF pictures, or they are damaged' : `${tile.key}.bin is damaged`);
            })));
    }

    // Those of its layers: JPEG where there is that and a browser does not decode AVIF.
    async pictures(tile) {
        let pictures = null;
        if (this.published.pictures && !this.plain)
            pictures = await this.decoded(tile, true).catch((error) => {
                if (this.published.pictures === 'avif')
                    throw error;
                this.plain = true;
            });
        pictures = pictures || await this.decoded(tile, false);
        if (pictures.some((p) => p.width !== tile.width || p.height !== tile.height))
            throw new Failure(`${tile.key}.bin has another size than scene.json says`);
        return pictures;
    }

    async load(tile) {
        const { local } = this.published;
        tile.state = 'loading';
        this.loading++;
        try {
            if (local)
                this.uploadCodes(tile, await local.codes(tile));
            else
                this.upload(tile, await this.pictures(tile));
            tile.state = 'ready';
        } catch (error) {
            tile.state = 'failed';
            this.failed(error);
        }
        this.loading--;
        this.changed();
    }

    uploadCodes(tile, codes) {
        const { gl } = this.device, { layers, halves } = this.published;
        tile.codes = this.device.texture(gl.NEAREST, gl.TEXTURE_2D_ARRAY);
        gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, halves ? gl.RGBA16F : gl.RGBA8, tile.width, tile.height, layers);
        gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, 0, tile.width, tile.height, layers, gl.RGBA,
                         halves ? gl.HALF_FLOAT : gl.UNSIGNED_BYTE, codes);
        this.bytes += this.bytesOf(tile);
    }

    bytesOf(tile) { return (this.published.halves ? 8 : 4) * tile.width * tile.height * this.published.layers; }

    upload(tile, pictures) {
        const { gl } = this.device;
        tile.codes = this.device.texture(gl.NEAREST, gl.TEXTURE_2D_ARRAY);
        gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, false);
        gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
        gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, gl.RGBA8, tile.width, tile.height, pictures.length);
        pictures.forEach((picture, layer) => {
            gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, layer, tile.width, tile.height, 1, gl.RGBA, gl.UNSIGNED_BYTE,
                             picture);
            picture.close();
        });
        this.bytes += this.bytesOf(tile);
    }

    // The least recently used leave, but for the coarsest.
    forget() {
        if (this.bytes <= MOST_BYTES)
            return;
        const last = this.published.levels.length - 1;
        this.tiles.trim(() => this.bytes > 0.8 * MOST_BYTES, (tile) => this.drop(tile),
                        (t) => t.state === 'ready' && t.used < this.clock && t.level < last);
    }

    drop(tile) {
        if (tile.codes)
            this.bytes -= this.bytesOf(tile);
        this.device.gl.deleteTexture(tile.codes);
        tile.lit.forEach((lit) => this.device.drop(lit));
        if (tile.surface) {
            this.device.gl.deleteTexture(tile.surface.albedo);
            this.device.drop(tile.surface);
        }
        this.tiles.delete(tile.key);
    }

    close() {
        for (const tile of [...this.tiles.values()])
            this.drop(tile);
        if (this.more)
            this.more.close();
    }
}

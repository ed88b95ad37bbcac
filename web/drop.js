// drop.js - a relume file from the visitor's disk as the picture of a page; nothing is sent anywhere
import { Failure, loadBytes } from './load.js';
import { checkPublished } from './published.js';
import { readFiles } from './openwork.js';

export const isRelume = (file) => /\.exr$/i.test(file.name);

// A file that is open: what lies in a published folder comes from the worker that reads it.
class LocalFile {
    constructor() {
        const address = URL.createObjectURL(new Blob([`(${readFiles})();`], { type: 'text/javascript' }));
        this.worker = new Worker(address);
        URL.revokeObjectURL(address);
        this.asked = new Map();
        this.count = 0;
        this.worker.onmessage = ({ data: { id, answer, why } }) => {
            const { resolve, reject } = this.asked.get(id);
            this.asked.delete(id);
            if (why)
                reject(new Failure(why));
            else
                resolve(answer);
        };
        this.worker.onerror = (event) => {
            event.preventDefault();
            this.asked.forEach(({ reject }) => reject(new Failure('this browser runs no worker for it')));
            this.asked.clear();
        };
    }

    ask(call, given) {
        return new Promise((resolve, reject) => {
            const id = this.count++;
            this.asked.set(id, { resolve, reject });
            this.worker.postMessage({ id, call, given });
        });
    }

    // The codes of a tile, [layers][height][width][4]: bytes, or halves.
    async codes(tile) {
        const { layers, halves } = this.published, view = this.indexOf(tile.key.split('/')[0]);
        const size = 4 * layers * tile.width * tile.height * (halves ? 2 : 1);
        const bytes = await this.ask('tile', { view, level: tile.level, x: tile.x, y: tile.y, size });
        return halves ? new Uint16Array(bytes.buffer) : bytes;
    }

    // The depth or the mask of a view, as its PNG would be.
    async picture(view, mask) {
        const { width, height } = this.published;
        const { data, range } = await this.ask('picture', { view: this.indexOf(view.name), mask, size: 4 * width * height });
        if (!mask)
            [view.depth_min, view.depth_step] = range;
        return new ImageData(new Uint8ClampedArray(data.buffer), width, height);
    }

    // What shadows or highlights of a view move by, eight numbers a pixel.
    async model(view) {
        const { width, height } = this.published, size = 32 * width * height;
        return new Float32Array((await this.ask('model', { view: this.indexOf(view.name), size })).buffer);
    }

    indexOf(name) { return +name.slice(1); }

    close() { this.worker.terminate(); }
}

// Opens a file as loadPublished does; a Failure says why it cannot. `home`: where relume-open.wasm lies.
export async function openFile(file, home) {
    const local = new LocalFile();
    try {
        const bytes = await loadBytes(new URL('relume-open.wasm', home).href);
        const opened = await local.ask('open', { bytes, from: file }), published = JSON.parse(opened.json);
        local.published = checkPublished(published, document.baseURI);
        Object.assign(published, { local, halves: !opened.bytes });
        return published;
    } catch (error) {
        local.close();
        throw error;
    }
}

// more.js - what only some files need, in a script of its own (relume-more.js) that loads when it is
// wanted: shadows and highlights that move (moving.js), lamps that stand near (near.js)
import { Failure, addScript } from './load.js';

let given = null, promise = null;

// Called by relume-more.js while it runs, with what makes its parts of the names that it shares.
export function putMore(make) {
    given = make(window.relume.shared);
}

export function loadMore(home) {
    promise = promise || addScript(new URL('relume-more.js', home).href).then(() => given, () => {
        throw new Failure('relume/relume-more.js is missing');
    });
    return promise;
}

// What one file has of it.
export class More {
    // `told`: changed(), failed(error).
    constructor(device, published, basis, home, told) {
        Object.assign(this, { device, published, basis, home, told, parts: null, gone: false, begun: false });
    }

    // There is a picture: what moves may load, which is more than that needs.
    begin() {
        if (!this.begun && this.published.moves)
            this.told.changed();
        this.begun = true;
    }

    // { near, moving }, or null: they are not there yet, or will not come.
    need() {
        if (!this.asked) {
            this.asked = true;
            loadMore(this.home).then(({ NearLamps, Moving }) => {
                const { device, published, basis, told } = this, near = new NearLamps(device, published, basis, told);
                this.parts = { near, moving: published.moves ? new Moving(device, published, basis, told) : null };
                told.changed();
            }).catch((error) => {
                this.gone = true;
                told.failed(error);
            });
        }
        return this.parts;
    }

    // What moves the shadows or highlights of a view: null where they do not move, or not yet.
    movingOf(view) {
        const parts = this.published.moves && this.begun && this.need();
        return parts && parts.moving.isReady(view) ? parts.moving : null;
    }

    // Whether that will come.
    awaits(view) {
        return !!this.published.moves && !this.gone && !(this.parts && this.parts.moving.isSettled(view));
    }

    close() {
        if (this.parts)
            Object.values(this.parts).forEach((part) => part && part.close());
    }
}

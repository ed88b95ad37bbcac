// marks.js - very many notes over a picture that moves: drawn by and by onto a canvas larger than what is
// seen, which follows the picture without being drawn again

const MARGIN = 400;  // pixels of the screen beside what is seen
const A_FRAME = 800; // notes that are drawn in one

export const MOST_AT_ONCE = A_FRAME;

// What a framing shows of the picture, `margin` pixels of the canvas more on each side.
export function partOf(at, width, height, margin) {
    const x = (width / 2 + margin) / at.scale, y = (height / 2 + margin) / at.scale;
    return [at.x - x, at.y - y, at.x + x, at.y + y];
}

const holds = (a, b) => a[0] <= b[0] && a[1] <= b[1] && a[2] >= b[2] && a[3] >= b[3];

export class Marks {
    // Its canvases lie behind `before`. `draw(note, context, place)` draws one, `again()` asks for a frame.
    constructor(before, { draw, again }) {
        Object.assign(this, { before, draw, again, shown: null, job: null });
    }

    canvas(width, height) {
        const canvas = Object.assign(document.createElement('canvas'), { width, height });
        canvas.setAttribute('aria-hidden', 'true');
        // a processor's canvas: many small marks are slow on a graphics card that is none
        canvas.context = canvas.getContext('2d', { willReadFrequently: true });
        return canvas;
    }

    // A job draws the notes around a framing; `view`: { at, width, height, ratio, version } of the notes.
    begin(view, index) {
        const { at, width, height, ratio } = view, margin = Math.min(MARGIN, Math.max(width, height) / 4);
        const part = partOf(at, width, height, margin), canvas = this.canvas(width + 2 * margin, height + 2 * margin);
        canvas.context.setTransform(ratio, 0, 0, ratio, 0, 0);
        const place = ([x, y]) => [(x - part[0]) * at.scale / ratio, (y - part[1]) * at.scale / ratio];
        return { ...view, part, canvas, place, rest: index.within(partOf(at, width, height, margin + 50)), next: 0 };
    }

    step(job) {
        const end = Math.min(job.next + A_FRAME, job.rest.length);
        for (; job.next < end; job.next++)
            this.draw(job.rest[job.next], job.canvas.context, job.place);
        return job.next === job.rest.length;
    }

    // Lays what is there where it belongs.
    lay({ canvas, at: from, part, ratio }, { at, width, height }) {
        const scale = at.scale / from.scale;
        const left = (width / 2 + (part[0] - at.x) * at.scale) / ratio, top = (height / 2 + (part[1] - at.y) * at.scale) / ratio;
        canvas.style.cssText = `width:${canvas.width / ratio}px;height:${canvas.height / ratio}px;inset:auto;left:0;top:0;` +
            `transform-origin:0 0;transform:translate(${left}px,${top}px) scale(${scale})`;
    }

    suits(job, view) {
        return job && job.version === view.version && job.ratio === view.ratio && job.at.scale === view.at.scale &&
            holds(job.part, partOf(view.at, view.width, view.height, 0));
    }

    // Whether what is shown will do for a view.
    serves(view) { return !!view.at && !this.job && this.suits(this.shown, view); }

    show(view, index) {
        const stale = this.job && (this.job.version !== view.version || this.job.ratio !== view.ratio);
        if (stale || (!this.job && !this.suits(this.shown, view)))
            this.job = this.begin(view, index);
        if (this.job && this.step(this.job)) {
            this.before.before(this.job.canvas);
            if (this.shown)
                this.shown.canvas.remove();
            this.shown = this.job;
            this.job = null;
        }
        if (this.shown)
            this.lay(this.shown, view);
        if (this.job || !this.suits(this.shown, view))
            this.again();
    }

    hide() {
        if (this.shown)
            this.shown.canvas.remove();
        this.shown = this.job = null;
    }
}

// overlay.js - notes, what is being drawn and the scale bar over the picture
import { sayLength } from './notes.js';

const NEAR = 9;         // CSS pixels: what a click means
const MARK = '#e8c46a', SHADE = 'rgba(0, 0, 0, .65)';
const BAR = [80, 200];  // its length, CSS pixels
const MOST_LABELS = 60;

// Lengths of scale bars: 1, 2 and 5.
function niceLength(least) {
    const decade = 10 ** Math.floor(Math.log10(least));
    return [1, 2, 5, 10].map((k) => k * decade).find((x) => x >= least);
}

function segmentDistance(p, a, b) {
    const d = [b[0] - a[0], b[1] - a[1]], square = d[0] ** 2 + d[1] ** 2;
    const t = square > 0 ? Math.min(Math.max(((p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1]) / square, 0), 1) : 0;
    return Math.hypot(p[0] - a[0] - t * d[0], p[1] - a[1] - t * d[1]);
}

export class Overlay {
    // `canvas` lies over the viewer's.
    constructor(canvas, viewer) {
        Object.assign(this, { canvas, viewer, notes: null, shown: true, chosen: null, drawing: null });
        this.context = canvas.getContext('2d');
    }

    // A place of the picture on the screen, CSS pixels; null behind the eye.
    screen(place) {
        const at = this.viewer.toCanvas(place), { ratio } = this;
        return at && [at[0] / ratio, at[1] / ratio];
    }

    get ratio() { return this.viewer.canvas.width / Math.max(this.viewer.canvas.clientWidth, 1); }

    // The note at a place of the screen.
    find(x, y) {
        let best = null, least = NEAR;
        for (const note of this.shown && this.notes ? this.notes.all : []) {
            const at = note.places.map((p) => this.screen(p));
            if (!at.length || at.some((p) => !p))
                continue;
            const ends = note.kind === 'polygon' ? [...at.slice(1), at[0]] : at.slice(1);
            const away = at.length === 1 ? Math.hypot(at[0][0] - x, at[0][1] - y)
                : Math.min(...ends.map((b, i) => segmentDistance([x, y], at[i], b)));
            if (away < least)
                [best, least] = [note, away];
        }
        return best;
    }

    path(places, closed) {
        const { context } = this;
        context.beginPath();
        places.forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
        if (closed)
            context.closePath();
    }

    stroke(colour, wide) {
        const { context } = this;
        for (const [style, width] of [[SHADE, wide + 2.5], [colour, wide]]) {
            context.strokeStyle = style;
            context.lineWidth = width;
            context.stroke();
        }
    }

    label(text, x, y) {
        const { context } = this, words = text.length > 48 ? `${text.slice(0, 47)}…` : text;
        context.lineWidth = 3;
        context.strokeStyle = SHADE;
        context.fillStyle = '#fff';
        context.strokeText(words, x + 9, y - 7);
        context.fillText(words, x + 9, y - 7);
    }

    drawNote(note, at, labelled) {
        const chosen = note === this.chosen, colour = chosen ? '#fff' : MARK;
        if (at.length === 1) {
            this.context.beginPath();
            this.context.arc(at[0][0], at[0][1], chosen ? 7 : 5, 0, 7);
        } else {
            this.path(at, note.kind === 'polygon');
        }
        this.stroke(colour, chosen ? 2.5 : 1.6);
        if (labelled && note.text)
            this.label(note.text, ...at[0]);
    }

    drawBar(width, height) {
        const { viewer, context } = this, mm = this.notes ? this.notes.mm : 0, pixels = viewer.scale() / this.ratio;
        if (!mm || !pixels)
            return;
        const length = niceLength(BAR[0] * mm / pixels), wide = length / mm * pixels, y = height - 16;
        if (wide > BAR[1] * 2 || wide > width - 40)
            return;
        this.path([[18, y - 5], [18, y], [18 + wide, y], [18 + wide, y - 5]], false);
        this.stroke('#fff', 1.6);
        this.label(length >= 10 ? `${length / 10} cm` : length >= 1 ? `${length} mm` : `${+(1000 * length).toPrecision(3)} µm`, 9 + wide / 2 - 14, y);
        context.globalAlpha = 1;
    }

    draw() {
        const { canvas, viewer, context, ratio } = this, { width, height } = viewer.canvas;
        if (canvas.width !== width || canvas.height !== height)
            Object.assign(canvas, { width, height });
        context.setTransform(ratio, 0, 0, ratio, 0, 0);
        context.clearRect(0, 0, width, height);
        context.font = '13px system-ui, sans-serif';
        context.lineJoin = 'round';
        const [w, h] = [width / ratio, height / ratio], seen = [];
        for (const note of this.shown && this.notes ? this.notes.all : []) {
            const at = note.places.map((p) => this.screen(p));
            if (at.length && at.every((p) => p) && at.some(([x, y]) => x > -50 && y > -50 && x < w + 50 && y < h + 50))
                seen.push([note, at]);
        }
        seen.forEach(([note, at]) => this.drawNote(note, at, seen.length <= MOST_LABELS || note === this.chosen));
        if (this.drawing) {
            const at = this.drawing.places.map((p) => this.screen(p)).filter((p) => p);
            this.path(at, this.drawing.kind === 'polygon');
            this.stroke('#fff', 2);
            at.forEach(([x, y]) => { context.beginPath(); context.arc(x, y, 3.5, 0, 7); this.stroke('#fff', 1.5); });
            if (at.length > 1)
                this.label(sayLength(this.drawing.length(), this.notes.mm), ...at[at.length - 1]);
        }
        this.drawBar(w, h);
    }
}

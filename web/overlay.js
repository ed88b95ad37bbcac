// overlay.js - notes, what is being drawn and the scale bar over the picture
import { MOST_AT_ONCE, Marks } from './marks.js';
import { NoteIndex } from './noteindex.js';

const NEAR = 9;         // CSS pixels: what a click means
const MARK = '#e8c46a', SHADE = 'rgba(0, 0, 0, .65)';
const BAR = [80, 200];  // its length, CSS pixels
const MOST_LABELS = 60;
const BESIDE = 50;      // what of a note beside the screen is drawn, CSS pixels
const CROSS = [3, 11];  // from where to where it reaches, CSS pixels
const REST = 300;       // milliseconds

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
    // `canvas` lies over the viewer's. `rested` is called when the picture has been still for a while.
    constructor(canvas, viewer, rested) {
        Object.assign(this, { canvas, viewer, rested, notes: null, shown: true, chosen: null, drawing: null, ratio: 1 });
        this.turns = viewer.isPanorama || viewer.isObject;  // what is seen of the notes is known one by one
        this.context = canvas.getContext('2d');
        this.marks = new Marks(canvas, {
            again: () => requestAnimationFrame(() => this.draw()),
            draw: (note, context, place) => this.drawNote(context, note, note.places.map(place), false),
        });
    }

    // A place of the picture on the screen, CSS pixels; null behind the eye, and behind an object.
    screen(place) {
        const at = this.viewer.toCanvas(place), { ratio } = this;
        return at && [at[0] / ratio, at[1] / ratio];
    }

    // Of the notes, as they are now.
    index() {
        const { notes } = this;
        if (this.indexed !== notes || this.version !== notes.version)
            this.notesByPlace = new NoteIndex(notes.all, notes.file.width, notes.file.height);
        this.indexed = notes;
        this.version = notes.version;
        return this.notesByPlace;
    }

    // The notes that have places.
    placed() {
        const { notes } = this;
        if (this.listed !== notes || this.listedVersion !== notes.version)
            Object.assign(this, { withPlaces: notes.all.filter((note) => note.places.length), listed: notes, listedVersion: notes.version });
        return this.withPlaces;
    }

    // Whether the card draws the notes (pins.js): very many on what turns.
    get isPinned() { return this.turns && this.shown && !!this.notes && this.placed().length > MOST_LABELS; }

    // Draws them, within a frame of the viewer.
    pin() {
        const { notes, viewer, pins } = this;
        if (!this.isPinned)
            return;
        if (!this.asked) {
            this.asked = true;
            viewer.openPins().then((made) => { this.pins = made; viewer.invalidate(); }, (error) => viewer.told.problem(`${error.message}.`));
        }
        if (!pins)
            return;
        if (pins.of !== notes || pins.version !== notes.version)
            pins.set(this.placed());
        Object.assign(pins, { of: notes, version: notes.version });
        pins.draw(viewer.pinValues(), this.viewer.canvas.width / Math.max(viewer.canvas.clientWidth, 1));
    }

    // Notes that may be seen within some pixels of the canvas around a box of it; all where one turns.
    around(left, top, right, bottom, margin) {
        const { viewer } = this;
        if (!this.shown || !this.notes)
            return [];
        if (this.turns)
            return this.placed();
        return this.index().within([...viewer.toPicture([left - margin, top - margin]), ...viewer.toPicture([right + margin, bottom + margin])]);
    }

    // The note at a place of the screen.
    find(x, y) {
        const { ratio } = this, near = NEAR * ratio;
        let best = null, least = NEAR;
        for (const note of this.around(x * ratio, y * ratio, x * ratio, y * ratio, near)) {
            const at = note.places.map((p) => this.screen(p));
            if (at.some((p) => !p))
                continue;
            const ends = note.kind === 'polygon' ? [...at.slice(1), at[0]] : at.slice(1);
            const away = at.length === 1 ? Math.hypot(at[0][0] - x, at[0][1] - y)
                : Math.min(...ends.map((b, i) => segmentDistance([x, y], at[i], b)));
            if (away < least)
                [best, least] = [note, away];
        }
        return best;
    }

    // The `most` of `notes` that are nearest to the middle of the screen, those without a place first.
    nearest(notes, most) {
        const { width, height } = this.canvas, { ratio } = this;
        const away = (note) => {
            const at = note.places.length ? this.screen(note.places[0]) : [width / 2 / ratio, height / 2 / ratio];
            return at ? Math.hypot(at[0] - width / 2 / ratio, at[1] - height / 2 / ratio) : Infinity;
        };
        return notes.map((note) => ({ note, away: away(note) })).sort((a, b) => a.away - b.away).slice(0, most).map(({ note }) => note);
    }

    path(context, places, closed) {
        context.beginPath();
        places.forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
        if (closed)
            context.closePath();
    }

    stroke(context, colour, wide) {
        for (const [style, width] of [[SHADE, wide + 2.5], [colour, wide]]) {
            context.strokeStyle = style;
            context.lineWidth = width;
            context.stroke();
        }
    }

    label(context, text, x, y) {
        const words = text.length > 48 ? `${text.slice(0, 47)}…` : text;
        context.lineWidth = 3;
        context.strokeStyle = SHADE;
        context.fillStyle = '#fff';
        context.strokeText(words, x + 9, y - 7);
        context.fillText(words, x + 9, y - 7);
    }

    drawNote(context, note, at, labelled) {
        const chosen = note === this.chosen, colour = chosen ? '#fff' : MARK;
        if (at.length === 1) {
            context.beginPath();
            context.arc(at[0][0], at[0][1], chosen ? 7 : 5, 0, 7);
        } else {
            this.path(context, at, note.kind === 'polygon');
        }
        this.stroke(context, colour, chosen ? 2.5 : 1.6);
        if (labelled && note.text)
            this.label(context, note.text, ...at[0]);
    }

    drawBar(width, height) {
        const { viewer, context } = this, mm = this.notes ? this.notes.mm : 0, pixels = viewer.scale() / this.ratio;
        if (!mm || !pixels)
            return false;
        const length = niceLength(BAR[0] * mm / pixels), wide = length / mm * pixels, y = height - 16;
        if (wide > BAR[1] * 2 || wide > width - 40)
            return false;
        this.path(context, [[18, y - 5], [18, y], [18 + wide, y], [18 + wide, y - 5]], false);
        this.stroke(context, '#fff', 1.6);
        this.label(context, length >= 10 ? `${length / 10} cm` : length >= 1 ? `${length} mm` : `${+(1000 * length).toPrecision(3)} µm`, 9 + wide / 2 - 14, y);
        return true;
    }

    // Where keys would take a place.
    drawCross(x, y) {
        const { context } = this;
        context.beginPath();
        for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
            context.moveTo(x + CROSS[0] * dx, y + CROSS[0] * dy);
            context.lineTo(x + CROSS[1] * dx, y + CROSS[1] * dy);
        }
        this.stroke(context, '#fff', 1.6);
    }

    drawDrawing() {
        const { context, drawing } = this;
        if (!drawing)
            return false;
        const at = drawing.places.map((p) => this.screen(p)).filter((p) => p);
        this.path(context, at, drawing.kind === 'polygon');
        this.stroke(context, '#fff', 2);
        at.forEach(([x, y]) => { context.beginPath(); context.arc(x, y, 3.5, 0, 7); this.stroke(context, '#fff', 1.5); });
        if (drawing.cross)
            this.drawCross(...drawing.cross);
        if (at.length > 1)
            this.label(context, this.notes.sayLength(drawing.length()), ...at[at.length - 1]);
        return true;
    }

    // Those of them that are seen, with their places on the screen.
    seenOf(notes, width, height) {
        const inside = ([x, y]) => x > -BESIDE && y > -BESIDE && x < width + BESIDE && y < height + BESIDE;
        return notes.map((note) => [note, note.places.map((p) => this.screen(p))])
            .filter(([, at]) => at.every((p) => p) && (!this.turns || at.some(inside)));
    }

    // The notes one by one.
    drawNotes(seen, width, height) {
        const there = this.seenOf(seen, width, height);
        for (const [note, at] of there)
            this.drawNote(this.context, note, at, there.length <= MOST_LABELS || note === this.chosen);
        return there.length > 0;
    }

    // What the card does not draw: the chosen note, and texts where few are seen and nothing moves.
    drawBesidePins(width, height) {
        const { chosen, context } = this, of = `${this.before} ${this.notes.version} ${width} ${height}`;
        if (this.labelsOf !== of && performance.now() - this.moved >= REST) {
            const there = this.seenOf(this.placed(), width, height);
            Object.assign(this, { labelsOf: of, labels: there.length <= MOST_LABELS ? there : [] });
        }
        const labels = this.labelsOf === of ? this.labels : [];
        labels.forEach(([note, at]) => this.label(context, note.text, ...at[0]));
        const at = chosen && chosen.places.length ? chosen.places.map((p) => this.screen(p)) : [null];
        if (at.every((p) => p))
            this.drawNote(context, chosen, at, true);
        return labels.length > 0 || !!at[0];
    }

    // Tells when the picture has come to rest.
    follow(framing) {
        const now = JSON.stringify(framing);
        if (now === this.before)
            return;
        this.before = now;
        this.moved = performance.now();
        clearTimeout(this.resting);
        this.resting = setTimeout(() => { this.rested(); this.draw(); }, REST);
    }

    draw() {
        const { canvas, viewer, context, notes } = this, { width, height } = viewer.canvas;
        const ratio = this.ratio = width / Math.max(viewer.canvas.clientWidth, 1), { at } = viewer.camera();
        if (canvas.width !== width || canvas.height !== height)
            Object.assign(canvas, { width, height });
        this.follow([at, viewer.eye, viewer.at, viewer.pan, viewer.tilt, viewer.zoom]);
        context.setTransform(ratio, 0, 0, ratio, 0, 0);
        context.clearRect(0, 0, width, height);
        context.font = '13px system-ui, sans-serif';
        context.lineJoin = 'round';
        // Chromium goes on showing a canvas that is cleared and no more
        const marked = [this.drawAll({ at, width, height, ratio, version: notes ? notes.version : 0 }), this.drawDrawing(),
                        this.drawBar(width / ratio, height / ratio)];
        canvas.style.visibility = marked.some((is) => is) ? '' : 'hidden';
    }

    // All notes; true: some of them on this canvas. Very many move with the picture (marks.js).
    drawAll(view) {
        const { width, height, ratio } = view, { chosen, context } = this, still = this.shown && this.marks.serves(view);
        if (this.isPinned && this.pins)
            return this.drawBesidePins(width / ratio, height / ratio);
        const seen = still ? [] : this.around(0, 0, width, height, BESIDE * ratio);
        if (!still && (!view.at || seen.length <= MOST_AT_ONCE)) {
            this.marks.hide();
            return this.drawNotes(seen, width / ratio, height / ratio);
        }
        this.marks.show(view, this.index());
        if (chosen && chosen.places.length)
            this.drawNote(context, chosen, chosen.places.map((p) => this.screen(p)), true);
        return !!chosen;
    }

    close() {
        clearTimeout(this.resting);
        if (this.pins)
            this.pins.close();
    }
}

// notepanel.js - the list of notes beside the picture, and how they are made
import { handOut, make } from './controls.js';
import { measureNote } from './notes.js';

const SHOWN = 200;  // of the list at once
const FEWEST = { point: 1, line: 2, polygon: 3 };
const KINDS = { point: 'Point', line: 'Line', polygon: 'Area', view: 'View' };
const BY_KEYS = 'By keys: arrows move a cross, the space bar takes its place.';
const HOW = {
    point: `Click on a place of the picture. ${BY_KEYS}`,
    line: `Click from place to place; Enter ends the line. Of three places the middle one shows its angle. ${BY_KEYS}`,
    polygon: `Click around an area; Enter closes it. ${BY_KEYS}`,
};
const A_STEP = 10;  // of the cross, CSS pixels; with Shift one
const WAYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
const SAID = 400;   // milliseconds after the cross has moved

export class NotePanel {
    // `to`: draw(), say(text), go(state), focus() on the picture, profile(note, notes), a promise of
    // { text, nodes }, where there are profiles.
    constructor(viewer, notes, overlay, to) {
        Object.assign(this, { viewer, notes, overlay, to });
        overlay.notes = notes;
        this.list = make('ol', {});
        this.filter = make('input', { type: 'search', placeholder: 'Search notes', 'aria-label': 'Search notes', oninput: () => this.show() });
        this.text = make('textarea', { rows: 3, 'aria-label': 'Text of the note', oninput: () => this.write() });
        this.measures = make('p', { class: 'measures' });
        this.length = make('input', { type: 'number', min: 0, step: 'any', 'aria-label': 'Its true length in millimetres' });
        this.ruler = make('div', { class: 'row' }, this.length, make('button', { type: 'button', class: 'word', onclick: () => this.setScale() }, 'mm: set the scale'));
        this.profiled = make('div', { class: 'profile', hidden: true });
        this.profiler = make('button', { type: 'button', class: 'word', onclick: () => this.profile() }, 'Profile');
        this.chosen = make('div', { class: 'chosen-note', hidden: true }, this.text, this.measures, this.ruler, this.profiled,
            make('div', { class: 'row' }, this.profiler,
                make('button', { type: 'button', class: 'word', onclick: () => this.visit() }, 'Show its light'),
                make('button', { type: 'button', class: 'word', onclick: () => this.remove() }, 'Remove')));
        this.shown = make('input', { type: 'checkbox', checked: true, onchange: () => { overlay.shown = this.shown.checked; to.draw(); } });
        this.file = make('input', { type: 'file', accept: '.json', hidden: true, onchange: () => this.load(this.file.files[0]) });
        const tool = (kind) => make('button', { type: 'button', class: 'word', onclick: () => this.begin(kind) }, KINDS[kind]);
        this.node = make('aside', { class: 'notes', 'aria-label': 'Notes' },
            make('div', { class: 'row' }, tool('point'), tool('line'), tool('polygon'),
                 make('button', { type: 'button', class: 'word', onclick: () => this.finish('view', []) }, 'View')),
            make('label', {}, this.shown, make('span', {}, 'on the picture')),
            this.filter, this.chosen, this.list,
            make('div', { class: 'row' },
                make('button', { type: 'button', class: 'word', onclick: () => this.save() }, 'Save as a file'),
                make('button', { type: 'button', class: 'word', onclick: () => this.file.click() }, 'Open'), this.file));
        this.show();
    }

    // The notes that are searched for.
    found() {
        const wanted = this.filter.value.toLowerCase();
        return this.notes.all.filter((note) => note.text.toLowerCase().includes(wanted));
    }

    // Of very many notes the list has those near the middle of the picture.
    show() {
        const { notes } = this, found = this.found(), many = found.length > SHOWN;
        const line = (note) => make('li', {}, make('button', { type: 'button', class: note === this.overlay.chosen ? 'note chosen' : 'note',
                                                              onclick: () => { this.choose(note); this.visit(); } },
            make('span', {}, note.text.slice(0, 200) || KINDS[note.kind]), make('small', {}, notes.sayMeasures(note))));
        this.list.replaceChildren(...(many ? this.overlay.nearest(found, SHOWN) : found).map(line));
        if (many)
            this.list.append(make('li', { class: 'more' }, `and ${found.length - SHOWN} more, farther from the middle`));
        if (this.notes.unknown)
            this.list.append(make('li', { class: 'more' }, `${this.notes.unknown} of a kind that this page cannot show`));
    }

    choose(note) {
        if (note !== this.overlay.chosen)
            this.profiled.hidden = true;
        this.overlay.chosen = note;
        this.chosen.hidden = !note;
        if (note) {
            this.text.value = note.text;
            this.measures.textContent = this.notes.sayMeasures(note);
            this.ruler.hidden = note.kind !== 'line';
            this.profiler.hidden = note.kind !== 'line' || !this.to.profile;
        }
        this.show();
        this.to.draw();
    }

    // The picture has come to rest elsewhere.
    rested() {
        if (!this.node.hidden && this.notes.all.length > SHOWN && !this.list.contains(this.node.getRootNode().activeElement))
            this.show();
    }

    // The note before or after the chosen one, of those that are searched for.
    step(by) {
        const found = this.found(), n = found.length, at = found.indexOf(this.overlay.chosen);
        if (!n)
            return this.to.say('There are no notes.');
        const i = at < 0 ? (by > 0 ? 0 : n - 1) : (at + by + n) % n, note = found[i];
        this.choose(note);
        this.visit();
        return this.to.say([`${i + 1} of ${n}: ${note.text.slice(0, 200) || KINDS[note.kind]}`, this.notes.sayMeasures(note)].filter((t) => t).join(', '));
    }

    // The light, eye and framing that a note was made in.
    visit() {
        const note = this.overlay.chosen;
        if (note && note.state)
            this.to.go(note.state);
    }

    write() {
        this.notes.rewrite(this.overlay.chosen, this.text.value);
        this.show();
        this.to.draw();
    }

    remove() {
        const note = this.overlay.chosen;
        this.notes.remove(note);
        this.choose(null);
        this.to.say('The note is removed.');
    }

    setScale() {
        const { length } = measureNote(this.overlay.chosen), mm = +this.length.value / length;
        if (!(mm > 0 && Number.isFinite(mm)))
            return this.to.say('Give the true length of this line in millimetres.');
        this.notes.setScale(mm);
        this.choose(this.overlay.chosen);
        return this.to.say(`A ${this.notes.unit} is ${+mm.toPrecision(4)} mm wide.`);
    }

    // Along the chosen line: a graph, and a table to keep.
    async profile() {
        const note = this.overlay.chosen;
        try {
            const { text, nodes } = await this.to.profile(note, this.notes);
            if (note !== this.overlay.chosen)
                return;
            this.profiled.replaceChildren(...nodes);
            this.profiled.hidden = false;
            this.to.say(text);
        } catch (error) {
            this.to.say(`${error.message}.`);
        }
    }

    // ------------------------------------------------------------ drawing

    begin(kind) {
        const places = [];
        this.overlay.drawing = { kind, places, length: () => measureNote({ kind, places }).length };
        this.to.focus();
        this.to.say(HOW[kind]);
    }

    get isDrawing() { return !!this.overlay.drawing; }

    // Keys while a note is drawn; true: it was one of these.
    key({ key, shiftKey }) {
        const acts = { Enter: () => (this.overlay.drawing.kind === 'point' ? this.mark() : this.end()), Escape: () => this.cancel(),
                       ' ': () => this.mark(), Backspace: () => { this.overlay.drawing.places.pop(); this.to.draw(); } };
        if (!this.isDrawing || !(acts[key] || WAYS[key]))
            return false;
        if (WAYS[key])
            this.moveCross(WAYS[key].map((v) => v * (shiftKey ? 1 : A_STEP)));
        else
            acts[key]();
        return true;
    }

    // The cross stands in the middle at first.
    cross() {
        const { drawing, canvas } = this.overlay;
        drawing.cross = drawing.cross || [canvas.clientWidth / 2, canvas.clientHeight / 2];
        return drawing.cross;
    }

    crossed() { return this.viewer.toPicture(this.cross().map((v) => v * this.overlay.ratio)); }

    moveCross(by) {
        const { drawing, canvas } = this.overlay, most = [canvas.clientWidth, canvas.clientHeight];
        drawing.cross = this.cross().map((v, c) => Math.min(Math.max(v + by[c], 0), most[c]));
        this.to.draw();
        clearTimeout(this.saying);
        this.saying = setTimeout(() => {
            const place = this.isDrawing && this.crossed();
            if (this.isDrawing)
                this.to.say(place ? `The cross is at ${place.map((v) => +v.toPrecision(4)).join(', ')}.` : 'The cross is beside it.');
        }, SAID);
    }

    mark() {
        const { drawing } = this.overlay;
        this.click(this.crossed());
        if (this.isDrawing && drawing.places.length)
            this.to.say(`Place ${drawing.places.length} of the ${KINDS[drawing.kind].toLowerCase()}, ${this.notes.sayLength(drawing.length() || 0)} so far; Enter ends it.`);
    }

    click(place) {
        const { drawing } = this.overlay;
        if (!place)
            return this.to.say('There is nothing there to write on.');
        drawing.places.push(place);
        if (drawing.kind === 'point')
            this.end();
        return this.to.draw();
    }

    end() {
        const { drawing } = this.overlay;
        if (drawing.places.length < FEWEST[drawing.kind])
            return this.to.say(`${drawing.places.length} of ${FEWEST[drawing.kind]} places; click on the picture.`);
        return this.finish(drawing.kind, drawing.places);
    }

    cancel() {
        this.overlay.drawing = null;
        this.to.draw();
    }

    finish(kind, places) {
        this.overlay.drawing = null;
        this.choose(this.notes.add(kind, places, '', this.viewer.getState()));
        this.text.focus();
    }

    // ------------------------------------------------------------ files

    save() {
        handOut(this.notes.toText(), 'application/json', this.notes.file.name.replace(/(\.exr)?$/, '.notes.json'));
        this.notes.changed = false;
        this.to.say('The notes are saved as a file; lay it beside the picture\'s file.');
    }

    async load(file) {
        try {
            this.notes.read(JSON.parse(await file.text()));
            this.choose(null);
        } catch (error) {
            this.to.say(error instanceof SyntaxError ? `${file.name} is damaged.` : `${error.message}.`);
        }
    }
}

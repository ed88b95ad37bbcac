// notes.js - what people write on a picture: a page of W3C annotations, kept as it came but for what is
// changed (docs/notes.md)
import { Failure } from './load.js';

const MOST_NOTES = 100000, MOST_PLACES = 10000, MOST_TEXT = 65536;

export const arePlaces = (places) => places.length >= 1 && places.length <= MOST_PLACES && places.flat().every(Number.isFinite);

// Straight shapes of an SVG selector: { closed, places }, or null.
function shapeOf(svg) {
    const path = /\bd=['"]\s*([^'"]*)['"]/.exec(svg), points = /<(polygon|polyline)\b[^>]*\bpoints=['"]([^'"]*)['"]/.exec(svg);
    const text = path ? path[1] : points ? points[2] : '';
    if (!text || text.length > 40 * MOST_PLACES || (path && !/^M[^A-Za-z]*(L[^A-Za-z]*)*[zZ]?\s*$/.test(text.replace(/(\d)e([-+]?\d)/g, '$1$2'))))
        return null;
    const numbers = (text.match(/[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?/gi) || []).map(Number), places = [];
    for (let i = 0; i + 1 < numbers.length; i += 2)
        places.push([numbers[i], numbers[i + 1]]);
    return arePlaces(places) ? { closed: path ? /[zZ]\s*$/.test(text) : points[1] === 'polygon', places } : null;
}

// A place on a picture, or a shape of it: { kind, places }; null.
function pictureShape(selector) {
    if (selector.type === 'PointSelector' && arePlaces([[selector.x, selector.y]]))
        return { kind: 'point', places: [[selector.x, selector.y]] };
    const shape = selector.type === 'SvgSelector' ? shapeOf(String(selector.value)) : null;
    return shape && shape.places.length > 1 ? { kind: shape.closed ? 'polygon' : 'line', places: shape.places } : null;
}

// One annotation as the page knows it; null where it is of a kind that it does not. `read` makes a
// shape of a selector.
function noteOf(item, read) {
    if (!item || typeof item !== 'object')
        return null;
    const body = [].concat(item.body || [])[0], target = [].concat(item.target || [])[0] || {};
    const selector = [].concat(target.selector || [])[0], state = [].concat(target.state || [])[0];
    const note = { item, kind: 'view', places: [], text: String((body && body.value) || '').slice(0, MOST_TEXT),
                   state: state && typeof state.value === 'string' ? state.value : '' };
    if (!selector)
        return note.state ? note : null;
    const found = read(selector);
    return found && { ...note, ...found };
}

const between = (a, b) => a.map((v, c) => v - b[c]);
const distance = (a, b) => Math.hypot(...between(a, b));

// Half of the sum of the crosses of neighbours: of places in the plane or in space.
function areaOf(places) {
    const sum = [0, 0, 0];
    places.forEach((p, i) => {
        const [x, y, z = 0] = between(p, places[0]), [u, v, w = 0] = between(places[(i + 1) % places.length], places[0]);
        [y * w - z * v, z * u - x * w, x * v - y * u].forEach((part, c) => { sum[c] += part / 2; });
    });
    return Math.hypot(...sum);
}

function angleOf([a, middle, b]) {
    const u = between(a, middle), v = between(b, middle), dot = u.reduce((sum, x, c) => sum + x * v[c], 0);
    return Math.acos(Math.min(Math.max(dot / (Math.hypot(...u) * Math.hypot(...v)), -1), 1)) * 180 / Math.PI;
}

// { length, area, degrees } of a note in pixels, or in an object's units, as relume_note_measure;
// undefined where it has none.
export function measureNote({ kind, places }) {
    const n = places.length, closed = kind === 'polygon', out = {};
    if (n < 2)
        return out;
    out.length = places.reduce((sum, p, i) => sum + (i + 1 < n || closed ? distance(p, places[(i + 1) % n]) : 0), 0);
    if (closed)
        out.area = areaOf(places);
    if (kind === 'line' && n === 3)
        out.degrees = angleOf(places);
    return out;
}

const short = (x) => String(+x.toPrecision(4));


export class Notes {
    // An empty list on a published file, or on one of which `file` says what notes must fit.
    constructor(published, file = { width: published.width, height: published.height, views: published.views && published.views.length }) {
        this.file = { name: `${published.name || 'picture'}.exr`, ...file };
        this.mm = published.mm_per_pixel > 0 ? published.mm_per_pixel : 0;
        this.page = { '@context': ['http://www.w3.org/ns/anno.jsonld', { relume: 'urn:relume:' }], id: '#notes',
                      type: 'AnnotationPage', 'relume:file': this.file, items: [] };
        this.all = [];
        this.unknown = 0;  // notes that cannot be shown, which stay
        this.version = 0;  // of the notes that are there
        this.changed = false;
    }

    // What places are counted in, and the member of the page that says how many millimetres one has.
    get unit() { return 'pixel'; }
    get scaleName() { return 'relume:mmPerPixel'; }

    // Why notes on a file that says so of itself are none on this one; nothing where they are.
    unfit({ width, height }) {
        const { file } = this;
        return width === file.width && height === file.height ? ''
            : `these notes are on a picture of ${width} x ${height} pixels, this one has ${file.width} x ${file.height}`;
    }

    readShape(selector) { return pictureShape(selector); }

    writeShape(kind, places) {
        const d = places.map((p) => p.map((x) => +x.toFixed(2)).join(','));
        return kind === 'point' ? { type: 'PointSelector', x: places[0][0], y: places[0][1] }
            : { type: 'SvgSelector', value: `<svg xmlns='http://www.w3.org/2000/svg'><path d='M${d.join(' L')}${kind === 'polygon' ? ' Z' : ''}'/></svg>` };
    }

    // A length as it is measured, or in millimetres where they are known.
    sayLength(length) { return this.mm ? `${short(length * this.mm)} mm` : `${short(length)} ${this.unit}s`; }

    sayMeasures(note) {
        const m = measureNote(note), out = [], { mm } = this;
        if (m.length !== undefined)
            out.push(this.sayLength(m.length));
        if (m.area !== undefined)
            out.push(mm ? `${short(m.area * mm * mm)} mm²` : `${short(m.area)} square ${this.unit}s`);
        if (m.degrees !== undefined)
            out.push(`${short(m.degrees)}°`);
        return out.join(', ');
    }

    // What a page says; notes on another file are refused.
    read(page) {
        const own = page && page['relume:file'];
        if (!page || page.type !== 'AnnotationPage' || !Array.isArray(page.items) || page.items.length > MOST_NOTES)
            throw new Failure('notes.json is no page of annotations');
        const unfit = own ? this.unfit(own) : '';
        if (unfit)
            throw new Failure(unfit);
        const found = page.items.map((item) => noteOf(item, (selector) => this.readShape(selector)));
        this.page = page;
        this.version++;
        this.all = found.filter((note) => note);
        this.unknown = found.length - this.all.length;
        const mm = page[this.scaleName];
        if (mm > 0 && Number.isFinite(mm))
            this.mm = mm;
    }

    nameOf() {
        const taken = new Set(this.page.items.map((item) => item && item.id));
        let n = this.page.items.length + 1;
        while (taken.has(`n${n}`))
            n++;
        return `n${n}`;
    }

    add(kind, places, text, state) {
        const item = {
            id: this.nameOf(), type: 'Annotation', motivation: kind === 'view' ? 'bookmarking' : 'commenting',
            created: new Date().toISOString().replace(/\.\d+Z$/, 'Z'),
            body: { type: 'TextualBody', format: 'text/plain', value: text },
            target: { type: 'SpecificResource', source: this.file.name, ...(kind === 'view' ? {} : { selector: this.writeShape(kind, places) }),
                      state: { type: 'relume:State', value: state } },
        };
        const note = { item, kind, places, text, state };
        this.page.items.push(item);
        this.all.push(note);
        this.version++;
        this.changed = true;
        return note;
    }

    rewrite(note, text) {
        const body = [].concat(note.item.body || [])[0];
        note.text = text;
        if (body)
            body.value = text;
        else
            note.item.body = { type: 'TextualBody', format: 'text/plain', value: text };
        this.changed = true;
    }

    remove(note) {
        this.page.items = this.page.items.filter((item) => item !== note.item);
        this.all = this.all.filter((other) => other !== note);
        this.version++;
        this.changed = true;
    }

    setScale(mm) {
        this.mm = mm;
        this.page[this.scaleName] = mm;
        this.changed = true;
    }

    toText() { return `${JSON.stringify(this.page, null, 1)}\n`; }
}

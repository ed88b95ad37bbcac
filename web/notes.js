// notes.js - what people write on a picture: a page of W3C annotations, kept as it came but for what is
// changed (docs/notes.md)
import { Failure } from './load.js';

const MOST_NOTES = 100000, MOST_PLACES = 10000, MOST_TEXT = 65536;

const arePlaces = (places) => places.length >= 1 && places.length <= MOST_PLACES && places.flat().every(Number.isFinite);

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

// One annotation as the page knows it; null where it is of a kind that it does not.
function noteOf(item) {
    if (!item || typeof item !== 'object')
        return null;
    const body = [].concat(item.body || [])[0], target = [].concat(item.target || [])[0] || {};
    const selector = [].concat(target.selector || [])[0], state = [].concat(target.state || [])[0];
    const note = { item, kind: 'view', places: [], text: String((body && body.value) || '').slice(0, MOST_TEXT),
                   state: state && typeof state.value === 'string' ? state.value : '' };
    if (!selector)
        return note.state ? note : null;
    if (selector.type === 'PointSelector' && arePlaces([[selector.x, selector.y]]))
        return { ...note, kind: 'point', places: [[selector.x, selector.y]] };
    const shape = selector.type === 'SvgSelector' ? shapeOf(String(selector.value)) : null;
    return shape && shape.places.length > 1 ? { ...note, kind: shape.closed ? 'polygon' : 'line', places: shape.places } : null;
}

const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);

// { length, area, degrees } of a note in pixels, as relume_note_measure; undefined where it has none.
export function measureNote({ kind, places }) {
    const n = places.length, closed = kind === 'polygon', out = {};
    if (n < 2)
        return out;
    out.length = places.reduce((sum, p, i) => sum + (i + 1 < n || closed ? distance(p, places[(i + 1) % n]) : 0), 0);
    if (closed)
        out.area = Math.abs(places.reduce((sum, p, i) => sum + p[0] * places[(i + 1) % n][1] - p[1] * places[(i + 1) % n][0], 0)) / 2;
    if (kind === 'line' && n === 3) {
        const [a, b] = [places[0], places[2]].map((p) => Math.atan2(p[1] - places[1][1], p[0] - places[1][0]));
        const turn = Math.abs(a - b) * 180 / Math.PI;
        out.degrees = turn > 180 ? 360 - turn : turn;
    }
    return out;
}

const short = (x) => String(+x.toPrecision(4));

// A length in pixels, or in millimetres where they are known.
export const sayLength = (pixels, mm) => (mm ? `${short(pixels * mm)} mm` : `${short(pixels)} pixels`);

export function sayMeasures(note, mm) {
    const m = measureNote(note), out = [];
    if (m.length !== undefined)
        out.push(sayLength(m.length, mm));
    if (m.area !== undefined)
        out.push(mm ? `${short(m.area * mm * mm)} mm²` : `${short(m.area)} square pixels`);
    if (m.degrees !== undefined)
        out.push(`${short(m.degrees)}°`);
    return out.join(', ');
}

export class Notes {
    // An empty list on a scene.
    constructor(scene) {
        this.file = { name: `${scene.name || 'picture'}.exr`, width: scene.width, height: scene.height, views: scene.views.length };
        this.mm = scene.mm_per_pixel > 0 ? scene.mm_per_pixel : 0;
        this.page = { '@context': ['http://www.w3.org/ns/anno.jsonld', { relume: 'urn:relume:' }], id: '#notes',
                      type: 'AnnotationPage', 'relume:file': this.file, items: [] };
        this.all = [];
        this.unknown = 0;  // notes that cannot be shown, which stay
        this.version = 0;  // of the notes that are there
        this.changed = false;
    }

    // What a page says; notes on a file of another size are refused.
    read(page) {
        const own = page && page['relume:file'], { width, height } = this.file;
        if (!page || page.type !== 'AnnotationPage' || !Array.isArray(page.items) || page.items.length > MOST_NOTES)
            throw new Failure('notes.json is no page of annotations');
        if (own && (own.width !== width || own.height !== height))
            throw new Failure(`these notes are on a picture of ${own.width} x ${own.height} pixels, this one has ${width} x ${height}`);
        const found = page.items.map(noteOf);
        this.page = page;
        this.version++;
        this.all = found.filter((note) => note);
        this.unknown = found.length - this.all.length;
        if (page['relume:mmPerPixel'] > 0 && Number.isFinite(page['relume:mmPerPixel']))
            this.mm = page['relume:mmPerPixel'];
    }

    nameOf() {
        const taken = new Set(this.page.items.map((item) => item && item.id));
        let n = this.page.items.length + 1;
        while (taken.has(`n${n}`))
            n++;
        return `n${n}`;
    }

    add(kind, places, text, state) {
        const d = places.map((p) => p.map((x) => +x.toFixed(2)).join(','));
        const selector = kind === 'point' ? { type: 'PointSelector', x: places[0][0], y: places[0][1] }
            : { type: 'SvgSelector', value: `<svg xmlns='http://www.w3.org/2000/svg'><path d='M${d.join(' L')}${kind === 'polygon' ? ' Z' : ''}'/></svg>` };
        const item = {
            id: this.nameOf(), type: 'Annotation', motivation: kind === 'view' ? 'bookmarking' : 'commenting',
            created: new Date().toISOString().replace(/\.\d+Z$/, 'Z'),
            body: { type: 'TextualBody', format: 'text/plain', value: text },
            target: { type: 'SpecificResource', source: this.file.name, ...(kind === 'view' ? {} : { selector }),
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
        this.page['relume:mmPerPixel'] = mm;
        this.changed = true;
    }

    toText() { return `${JSON.stringify(this.page, null, 1)}\n`; }
}

// objectnotes.js - notes on an object: their places lie on its surface, in its own coordinates
// (docs/notes.md#notes-on-objects)
import { Notes, arePlaces } from './notes.js';
import { minus } from './objectmodel.js';

const DIGITS = 7;
const SAME = 1e-3;  // diagonals, of the corners of two boxes

const areDeep = (places) => arePlaces(places) && places.every((p) => p.length === 3);

// "LINESTRING Z (x y z, ...)" and "POLYGON Z ((x y z, ...))" of well-known text: { kind, places }, or null.
function shapeOfText(text) {
    const found = /^\s*(LINESTRING|POLYGON)\s*Z\s*(\(.*\))\s*$/i.exec(text), closed = found && found[1].toUpperCase() === 'POLYGON';
    const inside = found && (closed ? /^\(\s*\(([^()]*)\)\s*\)$/ : /^\(([^()]*)\)$/).exec(found[2]);
    if (!inside)
        return null;
    const places = inside[1].split(',').map((place) => place.trim().split(/\s+/).map(Number)), last = places[places.length - 1];
    if (closed && places.length > 1 && places[0].every((x, c) => x === last[c]))
        places.pop();
    return areDeep(places) && places.length > 1 ? { kind: closed ? 'polygon' : 'line', places } : null;
}

export class ObjectNotes extends Notes {
    constructor(object) {
        super(object, { min: object.min, max: object.max });
        this.mm = object.mm_per_unit > 0 ? object.mm_per_unit : 0;
    }

    get unit() { return 'unit'; }
    get scaleName() { return 'relume:mmPerUnit'; }

    unfit({ min, max }) {
        const { file } = this, size = SAME * Math.hypot(...minus(file.max, file.min));
        const same = (a, b) => Array.isArray(a) && a.length === 3 && Math.hypot(...minus(a, b)) <= size;
        return same(min, file.min) && same(max, file.max) ? '' : 'these notes are on an object of another shape';
    }

    readShape(selector) {
        const { type, x, y, z } = selector;
        return type === 'PointSelector' && areDeep([[x, y, z]]) ? { kind: 'point', places: [[x, y, z]] }
            : type === 'WktSelector' ? shapeOfText(String(selector.value)) : null;
    }

    writeShape(kind, places) {
        const [first, ...rest] = places.map((p) => p.map((v) => +v.toPrecision(DIGITS)));
        if (kind === 'point')
            return { type: 'PointSelector', x: first[0], y: first[1], z: first[2] };
        const list = [first, ...rest, ...(kind === 'polygon' ? [first] : [])].map((p) => p.join(' ')).join(', ');
        return { type: 'WktSelector', value: kind === 'polygon' ? `POLYGON Z ((${list}))` : `LINESTRING Z (${list})` };
    }
}

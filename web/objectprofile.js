// objectprofile.js - how far an object's surface lies over a straight line, towards the eye; after
// src/cli/commands/notes_object.c
import { cross, unit } from './lights.js';
import { minus, product } from './objectmodel.js';
import { showProfile } from './profilegraph.js';
import { readState } from './state.js';

const SAMPLES = 256;
const A_WHILE = 40;  // milliseconds until the page may do something else

const onward = (a, b, t) => a.map((v, c) => v + t * b[c]);

// One leg: rays come down from as high as it is long, on the triangles that its plane cuts.
class Leg {
    constructor(model, eye, a, b) {
        Object.assign(this, { model, a, way: minus(b, a) });
        this.length = Math.hypot(...this.way);
        const to = minus(eye, onward(a, this.way, 0.5));
        this.up = unit(onward(to, this.way, -product(to, this.way) / this.length ** 2));
        this.triangles = model.cutBy(a, cross(this.way, this.up));
    }

    at(t) {
        const top = onward(onward(this.a, this.way, t), this.up, this.length);
        const place = this.model.meet(top, this.up.map((v) => -v), this.triangles), height = place && this.length - Math.hypot(...minus(place, top));
        return place && height >= -this.length ? { place, values: [height] } : { place: null, values: null };
    }
}

// The eye of the note, or the viewer's.
export async function profileOfObject(viewer, note, notes) {
    const { places } = note, eye = (note.state && readState(note.state, false).values.eye) || viewer.eye;
    const lengths = places.slice(1).map((p, i) => Math.hypot(...minus(p, places[i]))), length = lengths.reduce((sum, l) => sum + l, 0), rows = [];
    let leg = null, number = -1, before = 0, begun = performance.now();
    for (let k = 0; k < SAMPLES; k++) {
        const to = length * k / (SAMPLES - 1);
        while (number < 0 || (number + 2 < places.length && to > before + lengths[number])) {
            before += number < 0 ? 0 : lengths[number];
            number++;
            leg = null;
        }
        leg = leg || new Leg(viewer.model, eye, places[number], places[number + 1]);
        rows.push({ along: to, ...leg.at(lengths[number] > 0 ? Math.min((to - before) / lengths[number], 1) : 0) });
        if (performance.now() - begun > A_WHILE) {
            await new Promise((resolve) => setTimeout(resolve));
            begun = performance.now();
        }
    }
    return showProfile({ at: ['along', 'x', 'y', 'z'], names: ['height'], rows }, note, notes, 'units');
}

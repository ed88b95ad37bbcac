// noteindex.js - which notes lie in a part of the picture, by a grid over it

const PER_CELL = 4;         // notes, about
const CELLS_OF_A_NOTE = 64; // that a note is entered in; larger ones are looked at always

function boxOf(places) {
    const box = [Infinity, Infinity, -Infinity, -Infinity];
    for (const [x, y] of places) {
        box[0] = Math.min(box[0], x);
        box[1] = Math.min(box[1], y);
        box[2] = Math.max(box[2], x);
        box[3] = Math.max(box[3], y);
    }
    return box;
}

const meet = (a, b) => a[0] <= b[2] && a[2] >= b[0] && a[1] <= b[3] && a[3] >= b[1];

export class NoteIndex {
    // Of notes that have places; those without are nowhere.
    constructor(notes, width, height) {
        this.notes = notes;
        this.boxes = notes.map((note) => boxOf(note.places));
        this.side = Math.min(Math.max(Math.ceil(Math.sqrt(notes.length / PER_CELL)), 1), 128);
        this.size = [width, height];
        this.cells = new Map();
        this.wide = [];
        this.boxes.forEach((box, i) => this.enter(box, i));
    }

    // [first column, first row, last column, last row]; what lies beside the picture is in its outer cells.
    cellsOf(box) {
        return box.map((v, k) => Math.min(Math.max(Math.floor(v / this.size[k % 2] * this.side), 0), this.side - 1));
    }

    enter(box, i) {
        const [left, top, right, bottom] = this.cellsOf(box);
        if (!(box[0] <= box[2]))
            return;
        if ((right - left + 1) * (bottom - top + 1) > CELLS_OF_A_NOTE) {
            this.wide.push(i);
            return;
        }
        for (let y = top; y <= bottom; y++)
            for (let x = left; x <= right; x++) {
                const cell = y * this.side + x;
                if (!this.cells.has(cell))
                    this.cells.set(cell, []);
                this.cells.get(cell).push(i);
            }
    }

    // Notes whose boxes touch a part, [left, top, right, bottom], in the order of the list.
    within(part) {
        const [left, top, right, bottom] = this.cellsOf(part), found = new Set(this.wide);
        for (let y = top; y <= bottom; y++)
            for (let x = left; x <= right; x++)
                (this.cells.get(y * this.side + x) || []).forEach((i) => found.add(i));
        return [...found].filter((i) => meet(this.boxes[i], part)).sort((a, b) => a - b).map((i) => this.notes[i]);
    }
}

// profilegraph.js - a profile as the panel of notes shows it: a graph, a sentence, a table to keep
import { shape } from './ball.js';
import { handOut, make } from './controls.js';

// A number as "%.6g" writes it.
function shortNumber(x) {
    const [digits, power] = x.toExponential(5).split('e'), e = Math.abs(+power);
    return +power >= -4 && +power < 6 ? String(+x.toPrecision(6)) : `${+digits}e${power[0]}${e < 10 ? '0' : ''}${e}`;
}

// The table that `relume notes --profile` writes; `at` names what says where a row is.
function profileTable({ at, names, rows }, mm) {
    const heights = names.length === 1, lines = [[...at, ...names, ...(mm && heights ? ['along_mm', 'height_mm'] : mm ? ['along_mm'] : [])]];
    for (const { along, place, values } of rows) {
        const cells = [along, ...(place || at.slice(1).map(() => null)), ...(values || names.map(() => null)), ...(mm ? [along * mm] : [])];
        if (mm && heights)
            cells.push(values ? values[0] * mm : null);
        lines.push(cells.map((v) => (v === null ? '' : shortNumber(v))));
    }
    return lines.map((line) => `${line.join(',')}\r\n`).join('');
}

const SIZE = [240, 80];  // of a graph
const STROKES = [['#e8c46a'], ['#ff8f80', '#8fd98a', '#8fb4ff']];

// Its graph, and between which values it lies (none: low > high).
function profileGraph({ names, rows }) {
    const all = rows.flatMap(({ values }) => values || []);
    const low = all.reduce((a, b) => Math.min(a, b), Infinity), high = all.reduce((a, b) => Math.max(a, b), -Infinity);
    const last = Math.max(rows[rows.length - 1].along, 1e-9), tall = Math.max(high - low, 1e-9);
    const svg = shape('svg', { viewBox: `-2 -2 ${SIZE[0] + 4} ${SIZE[1] + 4}`, class: 'graph', 'aria-hidden': 'true' });
    names.forEach((_, c) => {
        let pen = 'M';
        const d = rows.map(({ along, values }) => {
            const step = values ? `${pen}${(along / last * SIZE[0]).toFixed(1)},${((high - values[c]) / tall * SIZE[1]).toFixed(1)}` : '';
            pen = values ? 'L' : 'M';
            return step;
        });
        svg.append(shape('path', { d: d.join(''), fill: 'none', stroke: STROKES[names.length > 1 ? 1 : 0][c], 'stroke-width': 1.5 }));
    });
    return { svg, low, high };
}

// A sentence and what is shown of a profile: { at, names, rows: [{ along, place, values }] } of a note's line, in `units`.
export function showProfile(found, note, { file, mm }, units) {
    const { svg, low, high } = profileGraph(found), unit = mm ? 'mm' : units, k = mm || 1;
    const what = found.names.length > 1 ? `Light from ${shortNumber(low)} to ${shortNumber(high)}`
        : `Height from ${+(low * k).toPrecision(3)} to ${+(high * k).toPrecision(3)} ${unit}`;
    const text = low <= high ? `${what}.` : 'Nothing is known along this line.', name = `${file.name.replace(/\.exr$/, '')}.${note.item.id || 'line'}.csv`;
    return { text, nodes: [...(low <= high ? [svg] : []), make('p', { class: 'measures' }, text),
        make('button', { type: 'button', class: 'word', onclick: () => handOut(profileTable(found, mm), 'text/csv', name) }, 'Save the table')] };
}

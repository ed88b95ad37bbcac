// state.js - what is seen as one line: name=value&name=value, with the names and values of the options
// of `relume relight`, blanks written as commas
import { MOST_LIGHTS_OF_A_STATE, RADIANS, cross, edgesFacing, placed, unit } from './lights.js';
import { PASSES, TONES_BY_NAME } from './shaders.js';

const MOST_LETTERS = 65536;
const LOOKS = ['perspective', 'stereographic', 'planet'];

const encode = (text) => encodeURIComponent(text).replace(/%2C/g, ',').replace(/%3A/g, ':').replace(/%2B/g, '+')
    .replace(/[!'()*~]/g, (c) => `%${c.charCodeAt(0).toString(16).toUpperCase()}`);
const shown = (x) => String(+x.toPrecision(6));
const list = (values) => values.map(shown).join(',');

function numbers(value, count, most = 1e6) {
    const parts = value.split(','), out = parts.map((p) => (p === '' ? NaN : Number(p)));
    return parts.length === count && out.every((x) => Number.isFinite(x) && Math.abs(x) <= most) ? out : null;
}

// ---------------------------------------------------------------- lights

const hasLength = (v) => Math.hypot(...v) > 1e-9;

// Soft lights are written as far discs that send what a directional one does; from here.
const FAR = 1000;

const NEAREST = 100;  // areas that are nearer stand near, where something can

function areaOf(words, near) {
    const v = numbers(words.join(','), 9, 1e9);
    if (!v || ![0, 3, 6].every((i) => hasLength(v.slice(i, i + 3))))
        return null;
    const position = v.slice(0, 3), away = Math.hypot(...position), u = v.slice(3, 6), half = Math.hypot(...u);
    if (near && away < NEAREST)
        return hasLength(cross(u, v.slice(6))) ? { ...placed({ kind: 'panel' }, position), u, v: v.slice(6) } : null;
    const value = 4 * half * half / (Math.PI * away * away);
    return { kind: 'area', direction: unit(position), radius: Math.min(Math.atan(half / away), 1), value };
}

function textOfArea(light) {
    const d = light.direction, half = FAR * Math.tan(light.radius), [above, beside] = edgesFacing(d);
    const value = Math.PI * FAR * FAR / (4 * half * half);
    // it sends light along u x v, which must point back at the scene
    return `area,${list(d.map((x) => FAR * x))},${list(above.map((x) => half * x))},${list(beside.map((x) => half * x))}` +
        `,rgb,${list(light.rgb.map((x) => x * value))}`;
}

function spotOf(words) {
    const v = numbers(words.join(','), 7, 1e9);
    return v && hasLength(v.slice(3, 6)) && v[6] > 0 && v[6] < 90
        ? { ...placed({ kind: 'spot' }, v.slice(0, 3)), axis: unit(v.slice(3, 6)), half: v[6] * RADIANS } : null;
}

function pointOf(words) {
    const position = numbers(words.join(','), 3, 1e9);
    return position && placed({ kind: 'point' }, position);
}

function dirOf(words) {
    const direction = numbers(words.join(','), 3, 1e12);
    return direction && hasLength(direction) ? { kind: 'dir', direction: unit(direction) } : null;
}

// A light of the page, or null; `near`: lights may stand near.
function lightOf(text, near) {
    const words = text.split(','), kind = words.shift(), nofall = words.indexOf('nofall');
    if (nofall >= 0)
        words.splice(nofall, 1);
    const colourAt = words.indexOf('rgb'), rgb = colourAt < 0 ? [1, 1, 1] : numbers(words.splice(colourAt).slice(1).join(','), 3, 1e12);
    const falls = near && (kind === 'point' || kind === 'spot');
    if (!rgb || rgb.some((x) => x < 0) || (nofall >= 0 && !falls))
        return null;
    const light = kind === 'dir' ? dirOf(words) : kind === 'area' ? areaOf(words, near)
        : falls && kind === 'point' ? pointOf(words) : falls ? spotOf(words) : null;
    return light && { ...light, rgb: rgb.map((x) => x * (light.value || 1)), ...(nofall >= 0 ? { nofall: true } : {}) };
}

function textOfLight(light) {
    if (light.kind === 'area')
        return textOfArea(light);
    const rgb = light.rgb.every((x) => x === 1) ? '' : `,rgb,${list(light.rgb)}`, nofall = light.nofall ? ',nofall' : '';
    const where = light.kind === 'point' ? `point,${list(light.position)}`
        : light.kind === 'spot' ? `spot,${list([...light.position, ...light.axis, light.half / RADIANS])}`
        : light.kind === 'panel' ? `area,${list([...light.position, ...light.u, ...light.v])}` : `dir,${list(light.direction)}`;
    return where + rgb + nofall;
}

// ---------------------------------------------------------------- names

const choice = (names) => ({ read: (v) => (names.includes(v) ? v : null), write: (v) => v });
const vector = (n) => ({ read: (v) => numbers(v, n), write: list });
const number = (low, high) => ({
    read: (v) => {
        const [x] = numbers(v, 1, 1e9) || [NaN];
        return x >= low && x <= high ? x : null;
    },
    write: shown,
});

const NAMES = {
    view: number(0, 65535),
    eye: vector(3),
    at: { read: (v) => { const n = numbers(v, 3, 1e7); return n && n[2] > 0 ? n : null; }, write: list },
    pan: number(-1e5, 1e5),
    tilt: number(-90, 90),
    zoom: number(0.01, 1e4),
    projection: choice(LOOKS),
    aperture: number(0, 1e6),
    focus: number(-1e6, 1e6),
    exposure: number(-20, 20),
    tone: choice(TONES_BY_NAME),
    pass: choice(PASSES),
};

function decodeOf(text) {
    try {
        return decodeURIComponent(text.replace(/\+/g, '%2B'));
    } catch {
        return null;
    }
}

// { values, lights, others, problem }: what a line says that can be shown; `lights` is null where it
// names none, `others` are entries of other names, `problem` a sentence about what was left out. `near`:
// whether lights may stand near.
export function readState(line, near) {
    const state = { values: {}, lights: null, others: [], problem: '' }, bad = [];
    if (line.length > MOST_LETTERS)
        return { ...state, problem: 'This link is too long; nothing of it is shown.' };
    for (const entry of line.split('&').filter((e) => e)) {
        const cut = entry.indexOf('='), name = cut < 0 ? entry : entry.slice(0, cut);
        const value = cut < 0 ? null : decodeOf(entry.slice(cut + 1));
        if (name === 'light') {
            const light = value === null ? null : lightOf(value, near);
            state.lights = state.lights || [];
            if (light && state.lights.length < MOST_LIGHTS_OF_A_STATE)
                state.lights.push(light);
            else
                bad.push(name);
        } else if (Object.hasOwn(NAMES, name)) {
            const read = value === null ? null : NAMES[name].read(value);
            if (read === null)
                bad.push(name);
            else
                state.values[name] = read;
        } else {
            state.others.push(entry);
        }
    }
    if (bad.length)
        state.problem = `This link asks for what cannot be shown (${[...new Set(bad)].join(', ')}); the rest of it is.`;
    if (state.lights && !state.lights.length && bad.includes('light'))
        state.lights = null;
    return state;
}

// A line of the values that differ from none: those that are undefined are left out.
export function writeState({ values, lights, others }) {
    const entries = Object.keys(NAMES).filter((name) => values[name] !== undefined)
        .map((name) => `${name}=${encode(NAMES[name].write(values[name]))}`);
    const all = lights.filter((light) => light.kind !== 'env').map((light) => `light=${encode(textOfLight(light))}`);
    return [...entries, ...all, ...(others || [])].join('&');
}

// controls.js - the strip below a picture: lights, exposure, what is shown, and what can be done
import { Ball, shape } from './ball.js';
import { COMPARISONS } from './compare.js';
import { RADIANS, distanceOf, gainOf, softnessOf } from './lights.js';
import { PASSES, TONES_BY_NAME } from './shaders.js';

const PASS_NAMES = ['Colour', 'Normals', 'Shiny', 'Relief', 'Fine relief', 'Grey', 'False colour'];
export const WAY_NAMES = ['Nothing', 'Lens', 'Side by side', 'Blink', 'Difference'];
const DISTANCES = [-2, 3];  // of a light, logarithms in units of the scene; the last: far
const TONE_NAMES = ['Plain', 'Soft highlights', 'Film', 'Gamma 2.2'];

// An element with attributes, listeners (on...) and content; text is never read as HTML.
export function make(name, given = {}, ...content) {
    const node = document.createElement(name);
    for (const [key, value] of Object.entries(given)) {
        if (key.startsWith('on')) node.addEventListener(key.slice(2), value);
        else if (value !== undefined && value !== false) node.setAttribute(key, value === true ? '' : value);
    }
    node.append(...content);
    return node;
}

// A file for whoever looks: a text, or a Blob.
export function handOut(content, type, name) {
    const address = URL.createObjectURL(new Blob([content], { type }));
    make('a', { href: address, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(address), 10000);
}

export const hexOf = (rgb) => {
    const most = Math.max(...rgb, 1e-9);
    return `#${rgb.map((v) => Math.round(255 * (v / most) ** (1 / 2.2)).toString(16).padStart(2, '0')).join('')}`;
};
export const colourOf = (hex) => [1, 3, 5].map((i) => (parseInt(hex.slice(i, i + 2), 16) / 255) ** 2.2);

const ICONS = {
    add: 'M12 5v14M5 12h14',
    remove: 'M5 12h14',
    fit: 'M4 9V4h5M20 9V4h-5M4 15v5h5M20 15v5h-5',
    screen: 'M3 5h18v14H3zM8 9h8v6H8z',
    link: 'M10 14a4 4 0 0 0 6 0l3-3a4 4 0 0 0-6-6l-1 1M14 10a4 4 0 0 0-6 0l-3 3a4 4 0 0 0 6 6l1-1',
    save: 'M12 4v11M7 11l5 5 5-5M5 20h14',
    note: 'M5 4h14v12H10l-4 4v-4H5zM8 8h8M8 12h5',
    more: 'M4 7h16M4 12h16M4 17h16M8 5v4M16 10v4M10 15v4',
    help: 'M9 9a3 3 0 1 1 4 3c-1 .5-1 1-1 2M12 18v.5',
    lamp: 'M12 3a6 6 0 0 1 3 11v3H9v-3a6 6 0 0 1 3-11M10 20h4',
    move: 'M12 3v18M3 12h18M12 3l-2 3M12 3l2 3M12 21l-2-3M12 21l2-3M3 12l3-2M3 12l3 2M21 12l-3-2M21 12l-3 2',
};

export function icon(name) {
    const svg = shape('svg', { viewBox: '0 0 24 24', 'aria-hidden': 'true' });
    svg.append(shape('path', { d: ICONS[name] }));
    return svg;
}

export function button(name, title, act) {
    return make('button', { type: 'button', title, 'aria-label': title, onclick: act }, icon(name));
}

// Where the strip is narrow it shows what is in reach of this button's groups ("rest") when it is pressed.
export function unfolder(strip) {
    const node = button('more', 'More settings', () => node.setAttribute('aria-expanded', strip().classList.toggle('open')));
    node.className = 'unfold';
    node.setAttribute('aria-expanded', false);
    return node;
}

export function labelled(text, control) {
    return make('label', {}, make('span', {}, text), control);
}

export function slider(text, low, high, step, act) {
    const input = make('input', { type: 'range', min: low, max: high, step, 'aria-label': text, oninput: () => act(+input.value) });
    return input;
}

export function select(text, names, shown, act) {
    const node = make('select', { 'aria-label': text, onchange: () => act(node.value) },
                      ...names.map((name, i) => make('option', { value: name }, shown[i])));
    return node;
}

// The strip for a viewer; `actions` are what the keys do too (element.js).
export class Controls {
    constructor(viewer, actions) {
        Object.assign(this, { viewer, actions });
        this.ball = new Ball(viewer.isPanorama, { moved: (d) => actions.setDirection(d), chosen: (i) => actions.choose(i) });
        this.mode = button('lamp', '', () => actions.toggleMode());
        this.colour = make('input', { type: 'color', 'aria-label': 'Colour of the light', oninput: () => this.setLight() });
        this.strength = slider('Strength of the light', -4, 4, 0.1, () => this.setLight());
        this.softness = slider('Softness of the light', 0, 40, 1, () => this.setLight());
        this.distance = slider('Distance of the light', ...DISTANCES, 0.1, () => this.setLight());
        this.exposure = slider('Exposure', -5, 5, 0.1, (value) => actions.set('exposure', value));
        this.pass = select('What is shown', PASSES, PASS_NAMES, (value) => actions.set('pass', value));
        this.tone = select('Highlights', TONES_BY_NAME, TONE_NAMES, (value) => actions.set('tone', value));
        this.way = select('Compare', COMPARISONS, WAY_NAMES, (value) => actions.compare(value));
        this.divide = slider('Where the two pictures meet', 0, 1, 0.01, (value) => actions.divide(value));
        this.remove = button('remove', 'Remove this light (Delete)', () => actions.removeLight());
        this.counter = make('output', { 'aria-label': 'Light' });
        const lens = viewer.isSlab ? this.lens() : [];
        const { panorama } = viewer.published, around = panorama && Math.hypot(...panorama.center) > 0;  // lamps are moved around the origin
        const distance = viewer.published.takesLamps && !around ? [labelled('Distance', this.distance)] : [];
        const planet = viewer.isPanorama ? [this.planet()] : [];
        const word = (text, title, act) => make('button', { type: 'button', class: 'word rest', title, onclick: act }, text);
        const raking = viewer.isPanorama ? [] : [word('Raking', 'Raking light (1)', () => actions.rake(1)),
                                                 word('Two sides', 'Raking light from two sides (2)', () => actions.rake(2))];
        this.node = make('div', { class: 'strip', role: 'toolbar', 'aria-label': 'Light and picture' },
            this.ball.node,
            make('div', { class: 'group' },
                make('div', { class: 'row' }, this.mode, this.counter, button('add', 'Another light (N)', () => actions.addLight()),
                     this.remove, this.colour, ...raking),
                make('div', { class: 'row rest' }, labelled('Strength', this.strength), labelled('Soft', this.softness), ...distance)),
            make('div', { class: 'group rest' },
                make('div', { class: 'row' }, labelled('Show', this.pass), labelled('Highlights', this.tone)),
                make('div', { class: 'row' }, labelled('Exposure', this.exposure), ...lens, ...planet)),
            make('div', { class: 'group rest' },
                make('div', { class: 'row' }, labelled('Compare', this.way)),
                make('div', { class: 'row' }, make('button', { type: 'button', class: 'word', title: 'Keep this look to compare with (K)',
                                                              onclick: () => actions.keep() }, 'Keep this look'), this.divide)),
            make('div', { class: 'group tools' },
                make('div', { class: 'row' }, button('fit', 'Whole picture (0)', () => actions.fit()),
                     button('screen', 'Full screen (F)', () => actions.fullScreen()),
                     button('note', 'Notes and measures (M)', () => actions.toggleNotes())),
                make('div', { class: 'row' }, button('link', 'Copy a link to this view (C)', () => actions.copyLink()),
                     button('save', 'Save this picture (S)', () => actions.save()),
                     button('help', 'Keys (?)', () => actions.help()), unfolder(() => this.node))));
        this.show();
    }

    lens() {
        const { grid } = this.viewer.stage, { slab } = this.viewer.published;
        const wide = Math.max(grid[2] - grid[0], grid[3] - grid[1]), deep = slab.uv_plane_z - slab.st_plane_z;
        this.aperture = slider('Width of the lens', 0, wide, wide / 100 || 1, (value) => this.actions.set('aperture', value));
        this.focus = slider('Focus', slab.st_plane_z - deep, slab.st_plane_z + 0.6 * deep, Math.abs(deep) / 200,
                            (value) => this.actions.set('focus', value));
        return [labelled('Lens', this.aperture), labelled('Focus', this.focus)];
    }

    planet() {
        this.look = select('Projection', ['perspective', 'stereographic', 'planet'], ['Room', 'Wide', 'Little planet'],
                           (value) => this.actions.set('look', value));
        return labelled('Look', this.look);
    }

    setLight() {
        const strength = 2 ** +this.strength.value, distance = +this.distance.value;
        this.actions.changeLight({ rgb: colourOf(this.colour.value).map((v) => v * strength), soft: +this.softness.value * RADIANS,
                                   distance: distance < DISTANCES[1] ? 2 ** distance : Infinity });
    }

    // What the viewer has.
    show() {
        const { viewer } = this, light = viewer.lights[viewer.chosen], plain = light && light.kind !== 'env';
        this.ball.show(viewer.lights, viewer.chosen);
        this.counter.textContent = viewer.lights.length ? `${viewer.chosen + 1}/${viewer.lights.length}` : 'dark';
        this.remove.disabled = !viewer.lights.length;
        for (const input of [this.colour, this.strength, this.softness])
            input.disabled = !light;
        this.softness.disabled = !plain || light.kind === 'spot';
        this.distance.disabled = !plain;
        if (light) {
            const seen = light.rgb.map((v) => v / gainOf(light)), away = distanceOf(light);
            this.colour.value = hexOf(seen);
            this.strength.value = Math.log2(Math.max(...seen, 1e-4));
            this.softness.value = Math.round(softnessOf(light) / RADIANS);
            this.distance.value = Number.isFinite(away) ? Math.min(Math.log2(away), DISTANCES[1] - 0.1) : DISTANCES[1];
        }
        this.exposure.value = viewer.exposure;
        this.pass.value = viewer.pass;
        this.tone.value = viewer.tone;
        this.way.value = viewer.comparison.way;
        this.divide.value = viewer.comparison.divide;
        this.divide.hidden = viewer.comparison.way !== 'slider';
        if (this.look)
            this.look.value = viewer.look;
        if (this.aperture) {
            this.aperture.value = viewer.aperture;
            this.focus.value = viewer.focus;
        }
    }

    showMode(lighting, verb) {
        this.mode.replaceChildren(icon(lighting ? 'lamp' : 'move'));
        const title = lighting ? `Dragging moves the light; change to ${verb} (L)` : `Dragging ${verb}s; change to light (L)`;
        this.mode.title = title;
        this.mode.setAttribute('aria-label', title);
        this.mode.setAttribute('aria-pressed', lighting);
    }
}

// object.js - <relume-object src="…/object.json">: a baked object that can be turned and relit
import { Ball, directionOf, placeOf, sayDirection } from './ball.js';
import { COMPARISONS } from './compare.js';
import { WAY_NAMES, button, colourOf, hexOf, labelled, make, select, slider, unfolder } from './controls.js';
import { RADIANS } from './lights.js';
import { put } from './load.js';
import { ObjectNotes } from './objectnotes.js';
import { profileOfObject } from './objectprofile.js';
import { ObjectViewer } from './objectview.js';
import { listenPointers } from './pointer.js';
import { TONES_BY_NAME } from './shaders.js';
import { Stage, following } from './stage.js';
import { putCore } from './wasm.js';

const A_KEY = 0.06, A_TURN = 0.12;  // of the disc of lights; radians
const MOST_LAMPS = 16;
const OBJECT_KEYS = [
    ['Arrow keys', 'turn the object (Shift: the other way of dragging)'], ['L', 'dragging and arrows: turning, or light'],
    ['+ −', 'enlarge, reduce'], ['0', 'the whole object, from the front'], ['N  Delete', 'another light, remove it'], ['[ ]', 'darker, brighter'],
    ['T', 'how highlights are shown'], ['F', 'full screen'], ['M', 'notes and measures'], [', .', 'the note before, the next one'],
    ['K  V  B', 'keep this look; ways to compare with it; change sides'], ['C', 'copy a link to this view'], ['S', 'save this picture'],
];

export class RelumeObject extends Stage {
    // Where relume.css and core.js lie.
    static home = '';

    connectedCallback() {
        this.root = this.shadowRoot || this.attachShadow({ mode: 'open' });
        this.build(RelumeObject.home, 'Drag to turn the object, move the light by its ball');
        this.open().catch((error) => this.fail(error));
    }

    async open() {
        const viewer = new ObjectViewer(this.canvas, RelumeObject.home, {
            changed: () => this.controls && this.controls.show(),
            drawn: (alone) => this.drawOver(alone),
            broken: (error) => this.fail(error),
            problem: (sentence) => this.say(sentence),
        });
        await viewer.open(this.source.href);
        if (!this.isConnected || !this.root.contains(viewer.canvas))
            return viewer.close();
        this.viewer = viewer;
        this.lighting = false;
        this.surface.setAttribute('aria-label', `${viewer.object.title || 'Object'}: an object that can be turned, and whose light can be moved. ` +
                                                'Arrow keys turn it; press the question mark for all keys.');
        this.addControls();
        this.openNotes(new ObjectNotes(viewer.object), profileOfObject, viewer.object.notes ? new URL('notes.json', this.source).href : null);
        this.listen();
        this.watch(viewer);
        const first = this.first ?? this.getAttribute('state');
        if (first)
            viewer.setState(first);
        await viewer.idle();
        return this.isReady();
    }

    // `alone`: the picture is wanted without notes.
    drawOver(alone) {
        const { overlay, viewer } = this;
        if (!overlay)
            return;
        if (overlay.drawing || (overlay.shown && overlay.placed().length))
            viewer.measure();
        if (!alone)
            overlay.pin();
        overlay.draw();
    }

    keep() {
        this.viewer.comparison.keep();
        this.say('This look is kept; turn the object or change the light, and compare.');
    }

    // ------------------------------------------------------------ state

    setState(line) {
        this.first = line;
        if (this.viewer)
            this.viewer.setState(line);
    }

    getState() { return this.viewer ? this.viewer.getState() : this.first || ''; }

    async idle() {
        await this.ready;
        return this.viewer ? this.viewer.idle() : undefined;
    }

    snapshot() { return this.viewer.snapshot(); }

    // ------------------------------------------------------------ the strip

    addControls() {
        const { fixed } = this.viewer.object;
        this.ball = new Ball(false, { moved: (d) => this.setDirection(d), chosen: (i) => { this.viewer.chosen = i; this.show(); } });
        this.counter = make('output', { 'aria-label': 'Light' });
        this.colour = make('input', { type: 'color', 'aria-label': 'Colour of the light', oninput: () => this.setLight() });
        this.strength = slider('Strength of the light', -4, 4, 0.1, () => this.setLight());
        this.softness = slider('Softness of the light', 0, 40, 1, () => this.setLight());
        this.exposure = slider('Exposure', -5, 5, 0.1, (value) => this.set('exposure', value));
        this.mode = button('move', '', () => this.toggleMode());
        this.way = select('Compare', COMPARISONS, WAY_NAMES, (value) => this.compare(value));
        this.divider = slider('Where the two pictures meet', 0, 1, 0.01, (value) => this.divide(value));
        const lights = [this.ball.node, make('div', { class: 'group' },
            make('div', { class: 'row' }, this.mode, this.counter, button('add', 'Another light (N)', () => this.addLight()),
                 button('remove', 'Remove this light (Delete)', () => this.removeLight()), this.colour),
            make('div', { class: 'row rest' }, labelled('Strength', this.strength), labelled('Soft', this.softness)))];
        this.controls = { show: () => this.show(), node: make('div', { class: 'strip', role: 'toolbar', 'aria-label': 'Light and picture' },
            ...(fixed ? [] : lights),
            make('div', { class: 'group rest' }, make('div', { class: 'row' }, labelled('Exposure', this.exposure))),
            make('div', { class: 'group rest' },
                make('div', { class: 'row' }, labelled('Compare', this.way)),
                make('div', { class: 'row' }, make('button', { type: 'button', class: 'word', title: 'Keep this look to compare with (K)',
                                                              onclick: () => this.keep() }, 'Keep this look'), this.divider)),
            make('div', { class: 'group tools' },
                make('div', { class: 'row' }, button('fit', 'The whole object (0)', () => this.fit()), button('screen', 'Full screen (F)', () => this.fullScreen()),
                     button('note', 'Notes and measures (M)', () => this.toggleNotes())),
                make('div', { class: 'row' }, button('link', 'Copy a link to this view (C)', () => this.copyLink()), button('save', 'Save this picture (S)', () => this.save()), button('help', 'Keys (?)', () => this.help()),
                     unfolder(() => this.controls.node)))) };
        this.frame.append(this.controls.node);
        this.showMode();
        this.show();
    }

    // What the viewer has.
    show() {
        const { viewer } = this, light = viewer.lights[viewer.chosen];
        this.ball.show(viewer.lights.map((l) => ({ ...l, direction: viewer.toSeen(l.direction) })), viewer.chosen);
        this.counter.textContent = viewer.lights.length ? `${viewer.chosen + 1}/${viewer.lights.length}` : 'dark';
        for (const input of [this.colour, this.strength, this.softness])
            input.disabled = !light;
        if (light) {
            this.colour.value = hexOf(light.rgb);
            this.strength.value = Math.log2(Math.max(...light.rgb, 1e-4));
            this.softness.value = light.kind === 'area' ? Math.round(light.radius / RADIANS) : 0;
        }
        this.exposure.value = viewer.exposure;
        this.way.value = viewer.comparison.way;
        this.divider.value = viewer.comparison.divide;
        this.divider.hidden = viewer.comparison.way !== 'slider';
    }

    showMode() {
        const title = this.lighting ? 'Dragging moves the light; change to turning (L)' : 'Dragging turns the object; change to light (L)';
        this.mode.title = title;
        this.mode.setAttribute('aria-label', title);
        this.mode.setAttribute('aria-pressed', this.lighting);
    }

    toggleMode() {
        this.lighting = !this.lighting && !this.viewer.object.fixed;
        this.showMode();
        this.say(this.lighting ? 'Dragging and arrow keys move the light.' : 'Dragging and arrow keys turn the object.');
    }

    // ------------------------------------------------------------ what can be done

    set(name, value) {
        this.viewer[name] = value;
        this.viewer.changed();
    }

    // As who looks sees it.
    setDirection(seen) {
        const { viewer } = this, direction = viewer.fromSeen(seen);
        this.dismissHint();
        if (!viewer.lights.length)
            return this.addLight();
        viewer.touch();
        viewer.setLights(viewer.lights.map((light, i) => (i === viewer.chosen ? { ...light, direction } : light)));
        clearTimeout(this.saying);
        this.saying = setTimeout(() => this.say(sayDirection(seen, false)), 600);
        return undefined;
    }

    setLight() {
        const { viewer } = this, rgb = colourOf(this.colour.value).map((v) => v * 2 ** +this.strength.value), radius = +this.softness.value * RADIANS;
        viewer.touch();
        viewer.setLights(viewer.lights.map((light, i) => (i !== viewer.chosen ? light
            : { direction: light.direction, rgb, ...(radius > 0 ? { kind: 'area', radius } : { kind: 'dir' }) })));
    }

    addLight() {
        const { viewer } = this, n = viewer.lights.length, angle = 2.4 * n + 2.2;
        if (viewer.object.fixed)
            return this.say('The light of this object is baked in; no other shines on it.');
        if (n >= MOST_LAMPS)
            return this.say(`There are ${MOST_LAMPS} lights; more would be slow.`);
        viewer.chosen = n;
        const direction = viewer.fromSeen(directionOf([0.6 * Math.cos(angle), 0.6 * Math.sin(angle)], false));
        return viewer.setLights([...viewer.lights, { kind: 'dir', direction, rgb: [1, 1, 1] }]);
    }

    fit() {
        const { viewer } = this, { lights, exposure, tone } = viewer;
        viewer.reset();
        Object.assign(viewer, { exposure, tone });
        viewer.setLights(lights);
    }

    save() { return this.savePicture(this.viewer.object.name); }
    help() { return this.helpWith(OBJECT_KEYS); }

    // ------------------------------------------------------------ pointers and keys

    // A place of the surface in halves of its shorter side from its middle.
    placeOn(x, y) {
        const { width, height } = this.surface.getBoundingClientRect(), half = Math.min(width, height) / 2;
        return [(x - width / 2) / half, (y - height / 2) / half, half];
    }

    lightAt(at) {
        const [x, y] = this.placeOn(at.x, at.y);
        this.setDirection(directionOf([x, -y], false));
    }

    turn(dx, dy) {
        const [, , half] = this.placeOn(0, 0);
        this.dismissHint();
        this.viewer.touch();
        this.viewer.turn(-1.5 * dx / half, 1.5 * dy / half);
    }

    listen() {
        const enlarge = (factor, x, y) => { this.viewer.touch(); this.viewer.enlarge(factor, ...this.placeOn(x, y).slice(0, 2)); };
        listenPointers(this.surface, {
            click: (at) => this.clickNotes(at) || (this.lighting && this.lightAt(at)),
            held: () => this.say(this.lighting ? 'Dragging turns the object now.' : 'Dragging moves the light now.'),
            drag: (at, dx, dy, other) => (this.lighting !== other && !this.viewer.object.fixed ? this.lightAt(at) : this.turn(dx, dy)),
            pinch: (factor, x, y, dx, dy) => {
                const [, , half] = this.placeOn(0, 0);
                this.viewer.shift(dx / half, dy / half);
                enlarge(factor, x, y);
            },
            wheel: enlarge,
        });
        this.listenKeys();
        this.listenLens();
        this.ball.node.addEventListener('keydown', (event) => this.key(event, true));
    }

    moveLight(dx, dy) {
        const { viewer } = this, light = viewer.lights[viewer.chosen];
        if (!light)
            return;
        const [x, y] = placeOf(viewer.toSeen(light.direction), false);
        this.setDirection(directionOf([x + dx, y + dy], false));
    }

    key(event, onBall = false) {
        if (event.ctrlKey || event.metaKey || event.altKey)
            return;
        if (this.panel.key(event)) {
            event.preventDefault();
            return;
        }
        const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
        const { viewer } = this, acts = {
            ...this.usualActs, t: () => this.set('tone', following(TONES_BY_NAME, viewer.tone)),
            v: () => this.compare(following(COMPARISONS, viewer.comparison.way)),
        };
        const act = acts[event.key] || acts[event.key.toLowerCase()];
        if (way && (onBall || this.lighting !== event.shiftKey))
            this.moveLight(A_KEY * way[0], A_KEY * way[1]);
        else if (way)
            viewer.turn(A_TURN * way[0], A_TURN * way[1]);
        else if (act)
            act();
        else
            return;
        event.preventDefault();
    }
}

// ---------------------------------------------------------------- window.relume

RelumeObject.home = new URL('.', document.currentScript ? document.currentScript.src : document.baseURI).href;

const firstObject = () => document.querySelector('relume-object');
let saidObject = () => {};
const objectReady = new Promise((resolve) => { saidObject = resolve; });

// The script copies and the core of relume.js in a page come here too, and all else stays with it.
const before = window.relume;
window.relume = {
    ready: objectReady,
    idle: () => (firstObject() ? firstObject().idle() : objectReady),
    setState: (line) => firstObject() && firstObject().setState(line),
    getState: () => (firstObject() ? firstObject().getState() : ''),
    ...before,
    put: (name, base64) => { put(name, base64); if (before) before.put(name, base64); },
    putCore: (base64) => { putCore(base64); if (before) before.putCore(base64); },
};

customElements.define('relume-object', RelumeObject);

function beginObject() {
    const object = firstObject(), show = () => object.setState(location.hash.slice(1));
    if (!object)
        return;
    object.ready.then(saidObject);
    if (before)
        return;
    if (location.hash.length > 1)
        show();
    window.addEventListener('hashchange', show);
}

if (document.readyState === 'loading')
    document.addEventListener('DOMContentLoaded', beginObject);
else
    beginObject();

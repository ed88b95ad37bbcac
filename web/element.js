// element.js - <relume-view src="…/scene.json">: a picture that can be relit, and its controls
import { Viewer } from './viewer.js';
import { Controls, make } from './controls.js';
import { directionOf, placeOf, sayDirection } from './ball.js';
import { listenPointers } from './pointer.js';
import { COMPARISONS } from './compare.js';
import { readEnvironment } from './hdr.js';
import { isRelume, openFile } from './drop.js';
import { moved, reshaped } from './lights.js';
import { addScript } from './load.js';
import { Notes } from './notes.js';
import { profileOfNote } from './profile.js';
import { PASSES, TONES_BY_NAME } from './shaders.js';
import { Stage, following } from './stage.js';

const STEP = 0.06;  // of the disc of lights, a key
const MOST_LAMPS_OF_PAGE = 16;
const KEYS = [
    ['Arrow keys', 'move the light (Shift: the other way of dragging)'], ['L', 'dragging and arrows: light, or moving'],
    ['+ −', 'enlarge, reduce'], ['0', 'the whole picture'], ['1 2', 'raking light, raking light from two sides'], ['N  Delete', 'another light, remove it'],
    ['Tab in the strip', 'colour, softness and more'], ['[ ]', 'darker, brighter'], ['P', 'what is shown'],
    ['T', 'how highlights are shown'], ['F', 'full screen'], ['M', 'notes and measures'], [', .', 'the note before, the next one'], ['K  V', 'keep this look; ways to compare with it'], ['C', 'copy a link to this view'], ['S', 'save this picture'],
];

export class RelumeView extends Stage {
    // Where relume.css and core.js lie.
    static home = '';

    connectedCallback() {
        this.root = this.shadowRoot || this.attachShadow({ mode: 'open' });
        if (!this.opened && /\/object\.json$/.test(this.source.pathname))
            return this.showObject();
        this.build(RelumeView.home);
        return this.open().catch((error) => this.fail(error));
    }

    // An object has an element of its own (object.js), which lies in this one then.
    showObject() {
        const script = new URL('relume-object.js', RelumeView.home).href;
        const made = customElements.get('relume-object') ? Promise.resolve() : addScript(script);
        const given = [...this.attributes].filter(({ name }) => ['src', 'state', 'poster', 'title', 'compare'].includes(name));
        this.ready = made.then(() => {
            this.object = make('relume-object', { style: 'min-height:0', ...Object.fromEntries(given.map(({ name, value }) => [name, value])) });
            if (this.first !== undefined)
                this.object.setState(this.first);
            this.root.replaceChildren(this.object);
            return this.object.ready;
        }, () => this.root.replaceChildren('relume/relume-object.js is missing.'));
    }

    disconnectedCallback() {
        if (this.object)
            this.first = this.object.getState();
        super.disconnectedCallback();
        this.object = null;
    }

    // A view of a file from the visitor's disk.
    static of(published) {
        const view = document.createElement('relume-view');
        view.opened = published;
        return view;
    }

    // Shows such a file in place of this one, which stays where that fails.
    async show(file) {
        this.say(`Opening ${file.name}.`);
        const published = await openFile(file, RelumeView.home).finally(() => this.say('')), view = RelumeView.of(published);
        view.className = this.className;
        view.style.cssText = this.style.cssText;
        this.replaceWith(view);
        if (this.opened)
            this.opened.local.close();
        await view.ready;
        return view;
    }

    // What visitors should know of it.
    sayOpened() {
        const { title } = this.opened;
        if (this.trouble)
            return this.say(`A part of the picture cannot be shown: ${this.trouble}.`);
        return this.say(`${title} was read by this browser and sent nowhere.`);
    }

    // A file from a disk has no still picture.
    fail(error) {
        if (!this.opened)
            return super.fail(error);
        this.say(`${error.message}.`);
        return this.isReady();
    }

    async open() {
        const viewer = new Viewer(this.canvas, RelumeView.home, {
            changed: () => this.controls && this.controls.show(),
            failed: (error) => {
                this.trouble = error.message;
                return viewer.drawn ? this.say(`A part of the picture cannot be shown: ${error.message}.`) : this.fail(error);
            },
            broken: (error) => this.fail(error),
            problem: (sentence) => this.say(sentence),
            drawn: (alone) => {
                if (this.overlay && !alone)
                    this.overlay.pin();
                return this.overlay && this.overlay.draw();
            },
        });
        await viewer.open(this.source.href, this.opened);
        if (!this.isConnected || !this.root.contains(viewer.canvas))
            return viewer.close();
        this.viewer = viewer;
        const title = viewer.published.title || viewer.published.name || 'Picture';
        this.surface.setAttribute('aria-label', `${title}: a picture whose light can be moved. Arrow keys move the light; ` +
                                                'press the question mark for all keys.');
        this.lighting = viewer.projection === 'planar';
        this.controls = new Controls(viewer, this);
        this.frame.append(this.controls.node);
        this.openNotes(new Notes(viewer.published), profileOfNote, viewer.published.notes ? `${viewer.published.base}notes.json` : null);
        this.showMode();
        this.hint.textContent = this.lighting ? 'Drag across the picture to move the light'
            : viewer.isSlab ? 'Drag to walk around, move the light by its ball' : 'Drag to look around, move the light by its ball';
        this.listen();
        this.watch(viewer);
        if (this.first !== undefined)
            viewer.setState(this.first);
        else if (this.getAttribute('state'))
            viewer.setState(this.getAttribute('state'));
        await viewer.ready;
        if (this.opened)
            this.sayOpened();
        return this.isReady();
    }

    // ------------------------------------------------------------ state

    // Before the file is open the line waits.
    setState(line) {
        this.first = line;
        if (this.shown)
            this.shown.setState(line);
    }

    // The viewer, or an object's element.
    get shown() { return this.object || this.viewer; }

    getState() { return this.shown ? this.shown.getState() : this.first || ''; }

    async idle() {
        await this.ready;
        return this.shown ? this.shown.idle() : undefined;
    }

    snapshot() { return this.shown.snapshot(); }

    // ------------------------------------------------------------ what can be done

    set(name, value) {
        if (name === 'look')
            return this.viewer.setLook(value);
        this.viewer[name] = value;
        return this.viewer.changed();
    }

    choose(index) {
        this.viewer.chosen = index;
        this.controls.show();
    }

    // The chosen light as `change` makes it.
    replaceLight(change) {
        const { viewer } = this, lights = [...viewer.lights];
        if (!lights.length)
            return this.addLight();
        lights[viewer.chosen] = change(lights[viewer.chosen]);
        viewer.touch();
        return viewer.setLights(lights);
    }

    setDirection(direction) {
        this.dismissHint();
        this.replaceLight((light) => (light.kind === 'env'
            ? { ...light, rotate: Math.atan2(direction[0], direction[2]) * 180 / Math.PI } : moved(light, direction)));
        this.sayLight();
    }

    sayLight() {
        const light = this.viewer.lights[this.viewer.chosen];
        clearTimeout(this.saying);
        this.saying = setTimeout(() => light && light.direction && this.say(sayDirection(light.direction, this.viewer.isPanorama)), 600);
    }

    // `rgb` as it is seen in the middle of the picture, `soft` in radians, `distance` from there.
    changeLight({ rgb, soft, distance }) {
        this.replaceLight((light) => (light.kind === 'env' ? { ...light, rgb } : reshaped(light, { seen: rgb, soft, distance })));
    }

    addLight() {
        const { viewer } = this, n = viewer.lights.length;
        if (n >= MOST_LAMPS_OF_PAGE)
            return this.say(`There are ${MOST_LAMPS_OF_PAGE} lights; more would be slow.`);
        const around = viewer.isPanorama, angle = 2.4 * n + 2.2;
        const direction = directionOf([0.6 * Math.cos(angle), 0.6 * Math.sin(angle)], around);
        viewer.chosen = n;
        return viewer.setLights([...viewer.lights, { kind: 'dir', direction, rgb: [1, 1, 1] }]);
    }

    rake(count) {
        this.dismissHint();
        this.viewer.rake(count);
        this.sayLight();
    }

    keep() {
        this.viewer.comparison.keep();
        this.say('This look is kept; change the light or what is shown, and compare.');
    }

    toggleMode() {
        this.lighting = !this.lighting;
        this.showMode();
        this.say(this.lighting ? 'Dragging and arrow keys move the light.' : `Dragging and arrow keys ${this.verb}.`);
    }

    get verb() { return this.viewer.isSlab ? 'walk' : this.viewer.isPanorama ? 'look' : 'move'; }
    showMode() { this.controls.showMode(this.lighting, this.verb); }

    fit() {
        this.viewer.at = null;
        this.viewer.zoom = this.viewer.look === 'planet' ? 0.5 : 1;
        this.viewer.changed();
    }

    save() { return this.savePicture(this.viewer.published.name); }
    help() { return this.helpWith(KEYS); }

    // ------------------------------------------------------------ pointers, keys, dropped files

    // A place on the picture as a place on the disc of lights.
    lightAt(at) {
        const { width, height } = this.surface.getBoundingClientRect(), half = Math.min(width, height) / 2;
        this.setDirection(directionOf([(at.x - width / 2) / half, (height / 2 - at.y) / half], this.viewer.isPanorama));
    }

    move(dx, dy) {
        const { viewer } = this, { width, height } = this.surface.getBoundingClientRect(), ratio = this.canvas.width / width;
        this.dismissHint();
        viewer.touch();
        if (viewer.isSlab)
            viewer.walk(-dx / width, dy / height);
        else if (viewer.isPanorama)
            viewer.turn(-dx * 90 / (width * viewer.zoom), dy * 90 / (width * viewer.zoom));
        else
            viewer.shift(dx * ratio, dy * ratio);
    }

    listen() {
        const ratio = () => this.canvas.width / this.surface.getBoundingClientRect().width;
        const enlarge = (factor, x, y) => { this.viewer.touch(); this.viewer.enlarge(factor, x * ratio(), y * ratio()); };
        listenPointers(this.surface, {
            click: (at) => this.clickNotes(at) || (this.lighting && this.lightAt(at)),
            held: () => this.say(this.lighting ? `Dragging ${this.verb}s now.` : 'Dragging moves the light now.'),
            drag: (at, dx, dy, other) => (this.lighting !== other ? this.lightAt(at) : this.move(dx, dy)),
            pinch: (factor, x, y, dx, dy) => {
                if (!this.viewer.isSlab)
                    this.move(dx, dy);
                enlarge(factor, x, y);
            },
            wheel: enlarge,
        });
        this.listenKeys();
        this.controls.ball.node.addEventListener('keydown', (event) => this.ballKey(event));
        this.listenLens();
        this.surface.addEventListener('dragover', (event) => event.preventDefault());
        this.surface.addEventListener('drop', (event) => {
            event.preventDefault();
            event.stopPropagation();
            this.drop(event.dataTransfer.files[0]).catch((error) => this.say(`${error.message}.`));
        });
    }

    async drop(file) {
        if (!file)
            return undefined;
        if (isRelume(file))
            return this.show(file);
        const map = await readEnvironment(file);
        this.viewer.chosen = 0;
        this.viewer.setLights([{ kind: 'env', name: file.name, map, rotate: 0, rgb: [1, 1, 1] }]);
        return this.say(`${file.name} lights the picture; drag on the ball to turn it.`);
    }

    moveLight(dx, dy) {
        const { viewer } = this, light = viewer.lights[viewer.chosen], around = viewer.isPanorama;
        if (!light || light.kind === 'env')
            return;
        const [x, y] = placeOf(light.direction, around);
        this.setDirection(directionOf([x + dx, y + dy], around));
    }

    ballKey(event) {
        const way = { ArrowLeft: [-STEP, 0], ArrowRight: [STEP, 0], ArrowUp: [0, STEP], ArrowDown: [0, -STEP] }[event.key];
        if (!way)
            return;
        this.moveLight(...way);
        event.preventDefault();
    }

    key(event) {
        if (event.ctrlKey || event.metaKey || event.altKey)
            return;
        if (this.panel.key(event)) {
            event.preventDefault();
            return;
        }
        const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
        const { viewer } = this, acts = {
            ...this.usualActs, 1: () => this.rake(1), 2: () => this.rake(2), v: () => this.compare(following(COMPARISONS, viewer.comparison.way)),
            p: () => this.set('pass', following(PASSES, viewer.pass)), t: () => this.set('tone', following(TONES_BY_NAME, viewer.tone)),
        };
        if (way && this.lighting !== event.shiftKey)
            this.moveLight(STEP * way[0], STEP * way[1]);
        else if (way)
            this.move(-40 * way[0], 40 * way[1]);
        else if (acts[event.key] || acts[event.key.toLowerCase()])
            (acts[event.key] || acts[event.key.toLowerCase()])();
        else
            return;
        event.preventDefault();
    }
}

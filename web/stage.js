// stage.js - what <relume-view> and <relume-object> have in common: a frame with a surface, what it says, notes,
// comparison, and what visitors take with them
//
// Who extends it has `viewer`, `controls` with show(), getState(), setDirection(), lightAt() and key().
import { handOut, make } from './controls.js';
import { Failure, loadJson } from './load.js';
import { NotePanel } from './notepanel.js';
import { Overlay } from './overlay.js';

const QUIET_AFTER = 6000;  // milliseconds

export const following = (list, value) => list[(list.indexOf(value) + 1) % list.length];

export class Stage extends HTMLElement {
    // An empty frame; `home`: where relume.css lies.
    build(home, hint = '') {
        this.canvas = make('canvas', { 'aria-hidden': 'true' });
        this.over = make('canvas', { 'aria-hidden': 'true' });
        this.poster = make('img', { class: 'poster', alt: '', hidden: true });
        this.hint = make('p', { class: 'hint' }, hint);
        this.status = make('p', { class: 'status', role: 'status', 'aria-live': 'polite' });
        this.surface = make('div', { class: 'surface', tabindex: 0, role: 'application' }, this.canvas, this.over, this.poster, this.hint);
        this.frame = make('div', { class: 'frame' }, this.surface, this.status);
        this.root.append(make('link', { rel: 'stylesheet', href: new URL('relume.css', home).href }), this.frame);
        this.ready = new Promise((resolve) => { this.isReady = resolve; });
    }

    disconnectedCallback() {
        if (this.observer)
            this.observer.disconnect();
        document.removeEventListener('keydown', this.bodyKey);
        if (this.viewer) {
            this.overlay.close();
            this.first = this.getState();  // for when it is put elsewhere in the page
            this.viewer.close();
        }
        this.root.replaceChildren();
        this.viewer = this.controls = null;
    }

    get source() { return new URL(this.getAttribute('src') || '', document.baseURI); }

    say(text) {
        this.status.textContent = text;
        this.status.classList.toggle('shown', text !== '');
        clearTimeout(this.silence);
        if (this.poster.hidden)
            this.silence = setTimeout(() => this.status.classList.remove('shown'), QUIET_AFTER);
    }

    // A still picture and a sentence.
    fail(error) {
        const poster = this.getAttribute('poster');
        this.poster.src = poster ? new URL(poster, document.baseURI).href : new URL('poster.jpg', this.source).href;
        this.poster.alt = this.getAttribute('title') || 'A still picture';
        this.poster.hidden = false;
        this.hint.remove();
        this.say(`Only a still picture can be shown: ${error instanceof Failure ? error.message : 'something went wrong in this browser'}.`);
        if (!(error instanceof Failure))
            console.error(error);
        return this.isReady();
    }

    // Follows the size of the canvas, until the graphics give up.
    watch(viewer) {
        this.observer = new ResizeObserver(() => this.viewer.resize());
        this.observer.observe(this.canvas);
        this.canvas.addEventListener('webglcontextlost', () => this.viewer === viewer && this.fail(new Failure('the graphics of this browser gave up')));
    }

    // ------------------------------------------------------------ notes

    // `notes` are those that are made here; what was published, of `address` or null, is added.
    async openNotes(notes, profile, address) {
        const { viewer } = this;
        this.overlay = new Overlay(this.over, viewer, () => this.panel.rested());
        this.panel = new NotePanel(viewer, notes, this.overlay, {
            draw: () => viewer.invalidate(), say: (text) => this.say(text), go: (state) => viewer.setState(state),
            focus: () => this.surface.focus(), profile: (note, list) => profile(viewer, note, list),
        });
        this.panel.node.hidden = true;
        this.frame.append(this.panel.node);
        if (!address)
            return;
        try {
            notes.read(await loadJson(address));
            this.panel.show();
            viewer.invalidate();
        } catch (error) {
            this.say(`The notes cannot be shown: ${error.message}.`);
        }
    }

    toggleNotes() {
        const { node } = this.panel;
        node.hidden = !node.hidden;
        (node.hidden ? this.surface : node.querySelector('button')).focus();
    }

    // What a click means for notes; false: nothing.
    clickNotes(at) {
        const { panel, overlay, viewer } = this, ratio = this.canvas.width / this.surface.getBoundingClientRect().width;
        if (panel.isDrawing) {
            panel.click(viewer.toPicture([at.x * ratio, at.y * ratio]));
            return true;
        }
        const note = overlay.find(at.x, at.y);
        if (note && panel.node.hidden)
            this.toggleNotes();
        if (note || overlay.chosen)
            panel.choose(note);
        return !!note;
    }

    // ------------------------------------------------------------ comparing

    // With the kept look, or with what `compare` names.
    async compare(way) {
        const { comparison } = this.viewer, named = this.getAttribute('compare'), { kept } = comparison;
        const address = named && new URL(named, document.baseURI).href;
        try {
            if (way !== 'off' && address && (!kept || (kept.follows && kept.follows !== address)))
                await comparison.open(address);
        } catch (error) {
            comparison.setWay('off');
            this.controls.show();
            return this.say(`${error.message}.`);
        }
        comparison.setWay(way);
        this.controls.show();
        const what = comparison.title || 'the kept look';
        return way === 'off' ? this.say('') : this.say(way === 'lens' ? `The lens shows ${what}.` : `This is compared with ${what}.`);
    }

    divide(value) {
        this.viewer.comparison.divide = value;
        this.viewer.invalidate();
    }

    // The lens follows the mouse.
    listenLens() {
        this.surface.addEventListener('pointermove', (event) => {
            const { comparison } = this.viewer, box = this.surface.getBoundingClientRect();
            comparison.lens = [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
            if (comparison.way === 'lens')
                this.viewer.invalidate();
        });
    }

    // ------------------------------------------------------------ keys

    // Also those that nothing else in the page takes, where this is its first.
    listenKeys() {
        this.surface.addEventListener('keydown', (event) => this.key(event));
        this.bodyKey = (event) => event.target === document.body && document.querySelector(this.localName) === this && this.key(event);
        document.addEventListener('keydown', this.bodyKey);
    }

    // What keys do that do the same everywhere.
    get usualActs() {
        const { viewer } = this;
        return {
            '+': () => viewer.enlarge(1.25), '=': () => viewer.enlarge(1.25), '-': () => viewer.enlarge(0.8), 0: () => this.fit(),
            l: () => this.toggleMode(), n: () => this.addLight(), Delete: () => this.removeLight(),
            '[': () => this.set('exposure', Math.max(viewer.exposure - 0.25, -20)), ']': () => this.set('exposure', Math.min(viewer.exposure + 0.25, 20)),
            m: () => this.toggleNotes(), ',': () => this.panel.step(-1), '.': () => this.panel.step(1),
            k: () => this.keep(), b: () => viewer.comparison.swap(),
            f: () => this.fullScreen(), c: () => this.copyLink(), s: () => this.save(), '?': () => this.help(),
        };
    }

    // ------------------------------------------------------------ what can be done

    removeLight() {
        const { viewer } = this;
        viewer.setLights(viewer.lights.filter((_, i) => i !== viewer.chosen));
    }

    dismissHint() {
        this.hint.classList.add('gone');
    }

    fullScreen() {
        if (document.fullscreenElement)
            document.exitFullscreen();
        else if (this.requestFullscreen)
            this.requestFullscreen().catch(() => this.say('This browser allows no full screen here.'));
    }

    async copyLink() {
        const address = new URL(location.href);
        address.hash = this.getState();
        try {
            await navigator.clipboard.writeText(address.href);
            this.say('The link to this view is copied.');
        } catch {
            location.hash = address.hash;
            this.say('The address of this page is now a link to this view.');
        }
    }

    async savePicture(name) {
        handOut(await this.snapshot(), 'image/png', `${name || 'picture'}.png`);
        this.say('The picture is saved.');
    }

    // `keys`: pairs of keys and what they do.
    helpWith(keys) {
        if (this.dialog)
            return this.dialog.close();
        const close = () => { this.dialog.remove(); this.dialog = null; this.surface.focus(); };
        this.dialog = make('dialog', { 'aria-label': 'Keys', onclose: close, onclick: () => this.dialog.close() },
            make('dl', {}, ...keys.flatMap(([key, what]) => [make('dt', {}, key), make('dd', {}, what)])));
        this.root.append(this.dialog);
        return this.dialog.showModal();
    }
}

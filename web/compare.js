// compare.js - two looks beside each other: a kept look of this file, or another file
import { Failure } from './load.js';

export const COMPARISONS = ['off', 'lens', 'slider', 'blink', 'difference'];
const BLINK = 700;  // milliseconds

const compareShader = () => `#version 300 es
precision highp float;
precision highp sampler2D;
uniform sampler2D own, other;
uniform int way;        // 1 lens, 2 slider, 3 blink, 4 difference
uniform vec3 lens;      // middle and radius, pixels, rows up
uniform float divide;   // pixels from the left
uniform float second;   // blink: the other one
out vec4 colour;
void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 a = texelFetch(own, at, 0).rgb, b = texelFetch(other, at, 0).rgb;
    float away = distance(gl_FragCoord.xy, lens.xy), line = 0.0;
    bool instead = second > 0.5;
    if (way == 1) {
        instead = away < lens.z;
        line = 1.0 - smoothstep(0.5, 1.8, abs(away - lens.z));
    } else if (way == 2) {
        instead = gl_FragCoord.x > divide;
        line = 1.0 - smoothstep(0.5, 1.5, abs(gl_FragCoord.x - divide));
    }
    vec3 rgb = way == 4 ? min(2.0 * abs(a - b), 1.0) : instead ? b : a;
    colour = vec4(mix(rgb, vec3(1.0), 0.8 * line), 1.0);
}`;

// Why two files cannot lie on each other; nothing where they can.
function unlikeness(own, other) {
    const rows = Math.abs(own.height * other.width / own.width - other.height);
    return other.projection !== own.projection ? `it is ${other.projection}, this one ${own.projection}`
        : rows > 1 + 0.01 * other.height ? `it has ${other.width} x ${other.height} pixels, this one ${own.width} x ${own.height}` : '';
}

// What a look has of its own.
function closeLook({ layer }, viewer) {
    layer.stage.close();
    if (layer.tiles !== viewer.tiles) {
        layer.tiles.close();
        layer.basis.close();
    }
}

export class Comparison {
    constructor(viewer) {
        Object.assign(this, { viewer, way: 'off', kept: null, divide: 0.5, lens: [0.5, 0.5], radius: 0.18, second: false, timer: 0 });
    }

    // The look that is compared with, when it is.
    get other() { return this.way === 'off' ? null : this.kept; }

    // Keeps how the file is seen now.
    keep() {
        const { viewer } = this, layer = viewer.layerOf(viewer.published, viewer.basis, viewer.tiles);
        layer.relighter.setLights(viewer.lights);
        this.replace({ ...viewer.seen(), layer, lights: viewer.lights, memo: {} });
    }

    // Another file of the same kind, seen from the same place; its lights are this one's.
    async open(address) {
        const { viewer } = this, layer = await viewer.openLayer(address), { title, name } = layer.published;
        const unlike = unlikeness(viewer.published, layer.published), look = { ...viewer.seen(), layer };
        if (unlike) {
            closeLook(look, viewer);
            throw new Failure(`${title || name || 'The other file'} cannot be compared with this one: ${unlike}`);
        }
        layer.relighter.setLights(viewer.lights);
        this.replace({ ...look, follows: address, title: title || name || 'the other file' });
    }

    // The title of the other file that is compared with; nothing for a kept look.
    get title() { return this.kept && this.kept.title; }

    replace(look) {
        this.drop();
        this.kept = look;
        this.viewer.invalidate();
    }

    // Another file is shown as this one is.
    follow() {
        const { kept, viewer } = this;
        if (!kept || !kept.follows)
            return;
        if (kept.lights !== viewer.lights)
            kept.layer.relighter.setLights(viewer.lights);
        Object.assign(kept, viewer.seen(), { layer: kept.layer });
    }

    setWay(way) {
        const still = window.matchMedia('(prefers-reduced-motion: reduce)').matches;
        clearInterval(this.timer);
        if (way !== 'off' && !this.kept)
            this.keep();
        this.way = way;
        this.second = way === 'blink';
        if (way === 'blink' && !still)
            this.timer = setInterval(() => this.swap(), BLINK);
        this.viewer.invalidate();
    }

    swap() {
        this.second = !this.second;
        this.viewer.invalidate();
    }

    draw(own, other) {
        const { device, canvas } = this.viewer, { width, height } = canvas;
        const program = device.program('compare', compareShader);
        device.begin(null);
        program.set({ own: { texture: own.texture }, other: { texture: other.texture }, way: { int: COMPARISONS.indexOf(this.way) },
                      lens: [this.lens[0] * width, (1 - this.lens[1]) * height, this.radius * Math.min(width, height)],
                      divide: this.divide * width, second: this.second ? 1 : 0 });
        program.draw();
    }

    drop() {
        if (this.kept)
            closeLook(this.kept, this.viewer);
        this.kept = null;
    }

    close() {
        clearInterval(this.timer);
        this.drop();
    }
}

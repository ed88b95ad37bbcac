// ball.js - the directions of light as a disc: dragged, or moved by keys
//
// A hemisphere is seen from the front, as a ball that the lights shine on. All directions around a
// panorama are seen from above: the middle is straight up, the rim straight down, -z is up.
import { RADIANS, unit } from './lights.js';

const RIM = 0.995;

// Place on the disc, [-1, 1] each, right and up.
export function placeOf(direction, around) {
    if (!around)
        return direction[2] >= 0 ? [direction[0], direction[1]]
            : unit([direction[0], direction[1], 1e-9]).slice(0, 2);
    const r = Math.acos(Math.min(Math.max(direction[1], -1), 1)) / Math.PI, phi = Math.atan2(direction[0], -direction[2]);
    return [r * Math.sin(phi), r * Math.cos(phi)];
}

export function directionOf([x, y], around) {
    const r = Math.hypot(x, y), k = r > RIM ? RIM / r : 1;
    if (!around)
        return [x * k, y * k, Math.sqrt(1 - Math.min(r, RIM) ** 2)];
    const theta = Math.min(r, RIM) * Math.PI, phi = Math.atan2(x, y);
    return [Math.sin(theta) * Math.sin(phi), Math.cos(theta), -Math.sin(theta) * Math.cos(phi)];
}

const SIDES = ['right', 'upper right', 'top', 'upper left', 'left', 'lower left', 'bottom', 'lower right'];
const WINDS = ['front', 'front right', 'right', 'back right', 'back', 'back left', 'left', 'front left'];

// { side, height }: for people.
export function sayDirection(direction, around) {
    const [x, y] = placeOf(direction, around), height = Math.round(Math.asin(Math.min(Math.max(direction[around ? 1 : 2], -1), 1)) / RADIANS);
    const turn = around ? Math.atan2(x, y) : Math.atan2(y, x);
    const side = (around ? WINDS : SIDES)[(Math.round(turn / RADIANS / 45) + 8) % 8];
    return height >= 86 ? (around ? 'light from above' : 'light from the front')
        : `light from the ${side}, ${height} degrees high`;
}

const SVG = 'http://www.w3.org/2000/svg';
export function shape(name, attributes) {
    const node = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes))
        node.setAttribute(key, value);
    return node;
}

// The control. `moved(direction)` is called while the chosen light is dragged, `chosen(index)` when
// another one is taken hold of.
export class Ball {
    constructor(around, { moved, chosen }) {
        Object.assign(this, { around, moved, chosen, lights: [], index: 0 });
        this.node = Object.assign(document.createElement('div'), { className: 'ball', tabIndex: 0 });
        this.node.setAttribute('role', 'slider');
        this.node.setAttribute('aria-label', 'Direction of the light');
        this.node.setAttribute('aria-valuemin', '-90');
        this.node.setAttribute('aria-valuemax', '90');
        this.svg = shape('svg', { viewBox: '-1.12 -1.12 2.24 2.24', 'aria-hidden': 'true' });
        this.svg.append(shape('circle', { class: 'disc', r: 1 }), shape('circle', { class: 'ring', r: around ? 0.5 : 0.707 }));
        this.dots = shape('g', {});
        this.svg.append(this.dots);
        this.node.append(this.svg);
        this.listen();
    }

    show(lights, index) {
        Object.assign(this, { lights, index });
        this.dots.replaceChildren(...lights.map((light, i) => {
            const hidden = light.kind === 'env', [x, y] = hidden ? [0, 0] : placeOf(light.direction, this.around);
            const most = Math.max(...light.rgb, 1e-9), colour = light.rgb.map((v) => Math.round(255 * (v / most) ** (1 / 2.2)));
            return shape('circle', { class: i === index ? 'dot chosen' : 'dot', cx: x, cy: -y, r: hidden ? 0 : light.kind === 'area' ? 0.17 : 0.12,
                                     fill: `rgb(${colour.join()})` });
        }));
        const light = lights[index], known = light && light.kind !== 'env';
        const height = known ? Math.asin(Math.min(Math.max(light.direction[this.around ? 1 : 2], -1), 1)) / RADIANS : 0;
        this.node.setAttribute('aria-valuenow', Math.round(height));
        this.node.setAttribute('aria-valuetext', known ? sayDirection(light.direction, this.around) : 'surroundings');
    }

    placeAt(event) {
        const box = this.node.getBoundingClientRect();
        return [2.24 * (event.clientX - box.left) / box.width - 1.12, 1.12 - 2.24 * (event.clientY - box.top) / box.height];
    }

    listen() {
        const drag = (event) => this.moved(directionOf(this.placeAt(event), this.around));
        this.node.addEventListener('pointerdown', (event) => {
            const at = this.placeAt(event), away = (light) => (light.kind === 'env' ? 9
                : Math.hypot(...placeOf(light.direction, this.around).map((v, i) => v - at[i])));
            const nearest = this.lights.reduce((best, l, i) => (away(l) < away(this.lights[best]) ? i : best), 0);
            if (this.lights.length > 1 && away(this.lights[nearest]) < 0.3)
                this.chosen(nearest);
            this.node.setPointerCapture(event.pointerId);
            this.node.focus();
            this.held = true;
            drag(event);
            event.preventDefault();
        });
        this.node.addEventListener('pointermove', (event) => this.held && drag(event));
        for (const name of ['pointerup', 'pointercancel'])
            this.node.addEventListener(name, () => { this.held = false; });
    }
}

// raking.js - raking light: as low as the captured lights that show relief (`relief` of scene.json)
import { RADIANS } from './lights.js';

const OVERHEAD = 0.1, FACING = 0.5, AS_LOW = Math.PI / 90, TIE = 1e-6;
const FIXED_HEIGHT = 12 * RADIANS, FIXED_SIDE = Math.PI;  // where that is not known
const QUARTER = -Math.PI / 2;  // from the first light to the second

const azimuthCosine = ([x, y], side) => (x * side[0] + y * side[1]) / Math.max(Math.hypot(x, y), 1e-12);
const heightOf = ([x, y, z]) => Math.atan2(z, Math.hypot(x, y));

// Returns the index of the lowest direction on the side, or -1; `except` is left out. Twin: relume_relief_lowest.
export function lowestOf(directions, side, except = -1) {
    const wide = Math.hypot(side[0], side[1]);
    const towards = wide > OVERHEAD * Math.hypot(...side) ? [side[0] / wide, side[1] / wide] : [-Math.SQRT1_2, Math.SQRT1_2];
    const cosine = directions.map((d, i) => (i === except ? -2 : azimuthCosine(d, towards)));
    const least = Math.min(FACING, Math.max(-1, ...cosine)) - TIE;
    const lowest = Math.min(Math.PI, ...directions.filter((_, i) => cosine[i] >= least).map(heightOf));
    let found = -1, most = -2;
    directions.forEach((d, i) => {
        if (cosine[i] >= least && heightOf(d) <= lowest + AS_LOW && cosine[i] > most + TIE) {
            most = cosine[i];
            found = i;
        }
    });
    return found;
}

const turned = ([x, y, z], angle) => [x * Math.cos(angle) - y * Math.sin(angle), x * Math.sin(angle) + y * Math.cos(angle), z];

// The directions of `count` raking lights, 1 or 2: the first on `side`, the other a quarter turn to its right.
export function rakingDirections({ relief, basis, projection }, side, count) {
    const around = !['planar', 'slab'].includes(projection), z = Math.sin(FIXED_HEIGHT), wide = Math.cos(FIXED_HEIGHT);
    const out = Array.from({ length: count }, (_, i) => {
        const a = FIXED_SIDE + i * QUARTER, x = wide * Math.cos(a), y = wide * Math.sin(a);
        return around ? [x, z, -y] : [x, y, z];
    });
    const directions = (relief || []).map((light) => basis.lights.slice(3 * light, 3 * light + 3));
    for (let i = 0, place = -1; i < count; i++) {
        place = lowestOf(directions, i ? turned(out[0], QUARTER) : side, place);
        if (place < 0)
            break;
        out[i] = directions[place];
    }
    return out;
}

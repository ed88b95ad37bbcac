// lights.js - what a light of the page is, and the plain directional lights that stand for it
//
// A light is { kind, direction, rgb, ... } with kind `dir`, `area` (soft: of an angular radius
// `radius`, radians, of a square) or `env` ({ name, map, rotate }). Directions are world vectors of length 1.
// Near a flat picture stand `point`, `spot` (`axis`, `half`: radians) and `panel` (half edges `u` and `v`,
// it shines towards u x v): they have a `position`, of which `direction` is that from the origin, and `nofall`.

export const MOST_LIGHTS_OF_A_STATE = 64;
export const RADIANS = Math.PI / 180;
const SIDE = 4;  // places of a soft light, across and down
export const MOST_SIDE = 8;  // patches of a panel, likewise

export const unit = (v) => {
    const length = Math.hypot(...v);
    return v.map((x) => x / length);
};

export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

const NEAR_KINDS = ['point', 'spot', 'panel'];
export const isNear = (light) => NEAR_KINDS.includes(light.kind);

const along = (v, k) => v.map((x) => k * x);

// A light that stands at a place; at the origin it has no direction, and is said to be in front.
export const placed = (light, position) => ({ ...light, position, direction: Math.hypot(...position) > 1e-9 ? unit(position) : [0, 0, 1] });

// Two vectors of length 1 whose product is -d.
export function edgesFacing(d) {
    const beside = unit(cross(d, Math.abs(d[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0]));
    return [cross(d, beside), beside];
}

// A light moved to a direction, as far away as it is, and turned to the origin.
export function moved(light, direction) {
    if (!isNear(light))
        return { ...light, direction };
    const there = placed(light, along(direction, Math.max(Math.hypot(...light.position), 1e-3))), [u, v] = edgesFacing(direction);
    return light.kind === 'spot' ? { ...there, axis: along(direction, -1) }
        : light.kind === 'panel' ? { ...there, u: along(u, Math.hypot(...light.u)), v: along(v, Math.hypot(...light.v)) } : there;
}

// How far it is from the origin, and the angle that half of it fills, radians.
export const distanceOf = (light) => (isNear(light) ? Math.max(Math.hypot(...light.position), 1e-3) : Infinity);
export const softnessOf = (light) => (light.kind === 'area' ? light.radius
    : light.kind === 'panel' ? Math.atan(Math.hypot(...light.u) / distanceOf(light)) : 0);

// What its values are multiplied by to light the middle of a picture as a directional light of value 1.
export function gainOf(light) {
    const d = distanceOf(light);
    return light.kind === 'panel' ? Math.PI * d * d / (4 * Math.max(Math.hypot(...light.u) * Math.hypot(...light.v), 1e-12))
        : isNear(light) && !light.nofall ? d * d : 1;
}

// A light of another distance and softness that shows the middle of the picture `seen`, as bright as a
// directional light of that value. Spots stay spots, but for far ones.
export function reshaped(light, { distance, soft, seen }) {
    const { direction } = light, far = !Number.isFinite(distance), half = distance * Math.tan(soft), [u, v] = edgesFacing(direction);
    const where = far ? null : placed(light.kind === 'spot' ? light : { kind: 'point' }, along(direction, distance));
    const out = far && soft > 0 ? { kind: 'area', direction, radius: soft } : far ? { kind: 'dir', direction }
        : soft > 0 && light.kind !== 'spot' ? { ...where, kind: 'panel', u: along(u, half), v: along(v, half) } : where;
    return { ...out, rgb: seen.map((value) => value * gainOf(out)) };
}

// Nodes and weights of Gauss and Legendre on [-1, 1]; after src/relight/light/area.c.
function nodesOf(n) {
    return Array.from({ length: n }, (_, i) => {
        let x = n > 1 ? Math.cos(Math.PI * (i + 0.75) / (n + 0.5)) : 0, slope = 1;
        for (let round = 0; round < 9; round++) {
            let before = 1, now = x;
            for (let k = 2; k <= n; k++)
                [before, now] = [now, ((2 * k - 1) * x * now - (k - 1) * before) / k];
            slope = n > 1 ? n * (x * now - before) / (x * x - 1) : 1;
            x -= n > 1 ? now / slope : 0;
        }
        return [x, 2 / ((1 - x * x) * slope * slope)];
    });
}

// How many patches a side of a panel over a picture of `window` needs.
export function patchSide(light, window) {
    const half = Math.max(Math.hypot(...light.u), Math.hypot(...light.v));
    const clamp = (x, low, high) => Math.min(Math.max(x, low), high), [x, y, z] = light.position;
    const away = Math.hypot(x - clamp(x, window.min[0], window.max[0]), y - clamp(y, window.min[1], window.max[1]), z);
    return clamp(Math.ceil(1 + 3.5 / Math.asinh(Math.max(away, 1e-9 * half) / half)), 1, MOST_SIDE);
}

// The patches that a panel comes to: { kind, position, axis, rgb }.
export function patchesOf(light, side) {
    const across = cross(light.u, light.v), nodes = nodesOf(side);
    return nodes.flatMap(([a, i]) => nodes.map(([b, j]) => ({
        kind: 'patch', position: light.position.map((p, c) => p + a * light.u[c] + b * light.v[c]), axis: unit(across),
        rgb: light.rgb.map((value) => value * i * j * Math.hypot(...across) / Math.PI),
    })));
}

// Directions over the square of a soft light, evenly, and their shares: it shines askew at its ends, which
// are farther away.
function squareOf(light) {
    const d = light.direction, half = Math.tan(light.radius), places = [], [above, beside] = edgesFacing(d);
    for (let i = 0; i < SIDE * SIDE; i++) {
        const x = half * ((2 * (i % SIDE) + 1) / SIDE - 1), y = half * ((2 * Math.floor(i / SIDE) + 1) / SIDE - 1);
        places.push({ direction: unit(d.map((v, c) => v + x * beside[c] + y * above[c])), share: (1 + x * x + y * y) ** -2 / SIDE ** 2 });
    }
    return places;
}

// The directional lights that all lights come to; `basis` knows what an environment is to the file.
export function spread(lights, basis) {
    const out = [];
    for (const light of lights) {
        if (light.kind === 'env') {
            out.push(...basis.environment(light.map, light.rotate || 0)
                .map((l) => ({ direction: l.direction, rgb: l.rgb.map((v, c) => v * light.rgb[c]) })));
        } else if (light.kind === 'area') {
            out.push(...squareOf(light).map(({ direction, share }) => ({ direction, rgb: light.rgb.map((v) => v * share) })));
        } else {
            out.push(light);
        }
    }
    return out;
}

// The light of a page that nobody has moved: raking, from the upper left.
export function firstLight(published) {
    const panorama = !['planar', 'slab'].includes(published.projection);
    return { kind: 'dir', direction: unit(panorama ? [-0.5, 0.8, 0.33] : [-0.62, 0.55, 0.56]), rgb: [1, 1, 1] };
}

// lights.js - what a light of the page is, and the plain directional lights that stand for it
//
// A light is { kind, direction, rgb, ... } with kind `dir`, `area` (soft: of an angular radius
// `radius`, radians) or `env` ({ name, map, rotate }). Directions are world vectors of length 1.

export const MOST_LIGHTS_OF_A_STATE = 64;
export const RADIANS = Math.PI / 180;
const RINGS = [[1, 0], [6, 0.57], [12, 0.9]];  // places on a disc: how many, how far out

export const unit = (v) => {
    const length = Math.hypot(...v);
    return v.map((x) => x / length);
};

export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

// Directions over the disc of a soft light, evenly.
function discOf(light) {
    const d = light.direction;
    const beside = unit(cross(d, Math.abs(d[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0])), above = cross(d, beside);
    const places = [];
    for (const [n, r] of RINGS)
        for (let i = 0; i < n; i++) {
            const at = Math.tan(light.radius) * r, phi = 2 * Math.PI * (i + 0.5 * (n > 6)) / n;
            places.push(unit(d.map((x, c) => x + at * (Math.cos(phi) * beside[c] + Math.sin(phi) * above[c]))));
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
            const places = discOf(light);
            out.push(...places.map((direction) => ({ direction, rgb: light.rgb.map((v) => v / places.length) })));
        } else {
            out.push(light);
        }
    }
    return out;
}

// The light of a page that nobody has moved: raking, from the upper left.
export function firstLight(scene) {
    const panorama = !['planar', 'slab'].includes(scene.projection);
    return { kind: 'dir', direction: unit(panorama ? [-0.5, 0.8, 0.33] : [-0.62, 0.55, 0.56]), rgb: [1, 1, 1] };
}

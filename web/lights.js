// lights.js - what a light of the page is, and the plain directional lights that stand for it
//
// A light is { kind, direction, rgb, ... } with kind `dir`, `area` (soft: of an angular radius
// `radius`, radians, of a square) or `env` ({ name, map, rotate }). Directions are world vectors of length 1.

export const MOST_LIGHTS_OF_A_STATE = 64;
export const RADIANS = Math.PI / 180;
const SIDE = 4;  // places of a soft light, across and down

export const unit = (v) => {
    const length = Math.hypot(...v);
    return v.map((x) => x / length);
};

export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

// Directions over the square of a soft light, evenly, and their shares: it shines askew at its ends, which
// are farther away.
function squareOf(light) {
    const d = light.direction, half = Math.tan(light.radius), places = [];
    const beside = unit(cross(d, Math.abs(d[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0])), above = cross(d, beside);
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
export function firstLight(scene) {
    const panorama = !['planar', 'slab'].includes(scene.projection);
    return { kind: 'dir', direction: unit(panorama ? [-0.5, 0.8, 0.33] : [-0.62, 0.55, 0.56]), rgb: [1, 1, 1] };
}

// measure.js - what passes and the first exposure take from the picture; after
// src/relight/normals/enhance_range.c and relume_tone_meter

const LEAST = 1e-4;  // of the brightest: what is darker is background

const luminance = (data, i) => 0.2126 * data[i] + 0.7152 * data[i + 1] + 0.0722 * data[i + 2];

function percentile(values, share) {
    values.sort();
    return values[Math.floor(share * (values.length - 1) + 0.5)];
}

// [low, high, pivot, scale] of relume_pass_range, of a small picture of the whole; `light` and `albedo`
// are RGBA floats, `lamps` the sum of the lights' colours.
export function measureRange(pass, light, albedo, lamps) {
    const n = light.length / 4, kept = [], ratios = [];
    let brightest = 0;
    for (let i = 0; i < n; i++)
        brightest = Math.max(brightest, luminance(light, 4 * i));
    const floor = LEAST * brightest;
    const most = (i) => luminance([0, 1, 2].map((c) => lamps[c] * albedo[4 * i + c]), 0);
    for (let i = 0; i < n; i++) {
        const y = luminance(light, 4 * i);
        if (y > floor)
            kept.push(i);
    }
    if (!kept.length)
        return [0, 1, 1, 1];
    const values = Float32Array.from(kept, (i) => luminance(light, 4 * i));
    let low = percentile(values, 0.01), high = percentile(values, 0.99), pivot = 1, scale = pass === 'specular' ? high : 1;
    if (pass === 'diffuse-gain') {
        for (const i of kept)
            if (most(i) > floor)
                ratios.push(luminance(light, 4 * i) / most(i));
        pivot = ratios.length ? Math.min(2 * percentile(Float32Array.from(ratios), 0.05), 1) : 1;
        const now = percentile(Float32Array.from(kept, (i) => {
            const m = pivot * most(i);
            return Math.max(m + 2 * (luminance(light, 4 * i) - m), 0);
        }), 0.99);
        scale = now > 0 ? high / now : 1;
    }
    if (!(high > low))
        [low, high] = [0, 2 * Math.max(high, 1e-6)];
    return [low, high, pivot, scale];
}

// The exposure in EV that takes the mean of the logarithms to a mid grey, the darkest tenth and the
// brightest fiftieth left out.
export function meterExposure(light) {
    const all = [];
    for (let i = 0; i < light.length; i += 4)
        if (luminance(light, i) > 1e-5)
            all.push(luminance(light, i));
    const kept = Float32Array.from(all).sort().subarray(Math.floor(0.1 * all.length), Math.ceil(0.98 * all.length));
    if (!kept.length)
        return 0;
    return Math.log2(0.18) - kept.reduce((sum, y) => sum + Math.log2(y), 0) / kept.length;
}

// The exposure in EV that takes the brightest channels, but for a hundredth of them, to white.
export function brightestExposure(light) {
    const most = new Float32Array(light.length / 4).map((_, i) => Math.max(light[4 * i], light[4 * i + 1], light[4 * i + 2]));
    return -Math.log2(Math.max(percentile(most, 0.99), 1e-6));
}

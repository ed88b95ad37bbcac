// published.js - what scene.json says, checked before anything is made of it
import { Failure, loadJson } from './load.js';

const NEWEST = 2;
const PROJECTIONS = ['planar', 'slab', 'cylindrical', 'spherical', 'cube'];

function insist(good, what) {
    if (!good)
        throw new Failure(`scene.json: ${what}`);
}

const isWhole = (value, least, most) => Number.isInteger(value) && value >= least && value <= most;
const areNumbers = (list, n) =>
    Array.isArray(list) && (n === undefined || list.length === n) && list.every(Number.isFinite);

function floatsOf(base64, count, name) {
    let text = '';
    try {
        text = atob(base64);
    } catch {
        insist(false, `${name} is damaged`);
    }
    insist(text.length === 4 * count, `${name} has ${text.length / 4} numbers, expected ${count}`);
    const bytes = Uint8Array.from(text, (c) => c.charCodeAt(0));
    return new Float32Array(bytes.buffer);
}

// [curve, gamma]: 1 linear, 2 sRGB, 3 a gamma.
function transferOf(text) {
    const gamma = /^gamma:([0-9.]+)$/.exec(text);
    insist(text === 'srgb' || text === 'linear' || (gamma && +gamma[1] > 0), `unknown transfer ${text}`);
    return gamma ? [3, +gamma[1]] : [text === 'srgb' ? 2 : 1, 1];
}

function checkBasis(published) {
    const { basis, relief } = published;
    insist(basis && typeof basis.name === 'string', 'no basis');
    insist(areNumbers(basis.parameter || [], undefined), 'parameters of the basis');
    insist(areNumbers(basis.lights) && basis.lights.length % 3 === 0 &&
           isWhole(basis.lights.length / 3, 1, 4096), 'lights of the basis');
    insist(isWhole(basis.coefficients, 1, 4096), 'coefficients of the basis');
    insist(relief === undefined || (Array.isArray(relief) && relief.every((i) => isWhole(i, 0, basis.lights.length / 3 - 1))), 'lights that show relief');
    basis.parameter = basis.parameter || [];
}

function checkLevels(published) {
    insist(isWhole(published.tile, 16, 4096), 'size of tiles');
    insist(Array.isArray(published.levels) && published.levels.length > 0, 'levels');
    let { width, height } = published;
    for (const level of published.levels) {
        insist(level.width === width && level.height === height,
               `a level of ${level.width} x ${level.height}, expected ${width} x ${height}`);
        width = Math.ceil(width / 2);
        height = Math.ceil(height / 2);
    }
    published.first = Math.min(published.first_level || 0, published.levels.length - 1);
}

function checkViews(published) {
    insist(Array.isArray(published.views) && isWhole(published.views.length, 1, 65536), 'views');
    insist([undefined, 'shadows', 'highlights'].includes(published.moves), 'what moves');
    insist(published.moves !== 'shadows' || published.projection !== 'cube', 'shadows that move in a cube');
    for (const view of published.views) {
        insist(typeof view.name === 'string' && /^[A-Za-z0-9_-]+$/.test(view.name), 'a view without a name');
        insist(published.projection !== 'slab' || areNumbers(view.uv, 2), 'a view without its place');
        insist(!view.depth || (Number.isFinite(view.depth_min) && Number.isFinite(view.depth_step)),
               'depth without its range');
        insist(published.moves !== 'shadows' || view.depth, 'shadows that move without depth');
        insist(!view.moving || (areNumbers(view.moving.scale, 8) && areNumbers(view.moving.offset, 8)), 'what moves without its scales');
    }
}

function checkGeometry(published) {
    const flat = published.window;
    insist(published.projection !== 'planar' ||
           (flat && areNumbers(flat.min, 2) && areNumbers(flat.max, 2) && flat.max[0] > flat.min[0] && Number.isFinite(flat.camera_z)), 'no window');
    const slab = published.slab;
    insist(published.projection !== 'slab' ||
           (slab && areNumbers([slab.uv_plane_z, slab.st_plane_z]) && areNumbers(slab.st_min, 2) &&
            areNumbers(slab.st_max, 2)), 'no slab');
    const panorama = published.panorama;
    insist(flat || slab || (panorama && areNumbers(panorama.center, 3) &&
           (published.projection !== 'cylindrical' || panorama.v_max > panorama.v_min)), 'no panorama');
}

// A published file: what scene.json has, with `transform`, `mean`, `scale` and `offset` as floats, `base` (the
// address that its other files are relative to), `curve` and `gamma`.
export async function loadPublished(address) {
    return checkPublished(await loadJson(address), address);
}

export function checkPublished(published, address) {
    insist(published && published.format === 'relume-web', 'not a file that relume publish wrote');
    insist(isWhole(published.version, 1, 1e6), 'no version');
    if (published.version > NEWEST)
        throw new Failure(`this file was published by a newer relume (format ${published.version}, ` +
                          `this page knows ${NEWEST}); publish the page again with it`);
    insist(isWhole(published.width, 1, 1 << 20) && isWhole(published.height, 1, 1 << 20), 'size of the picture');
    insist(PROJECTIONS.includes(published.projection), `unknown projection ${published.projection}`);
    insist(isWhole(published.planes, 1, 192) && isWhole(published.functions, 1, 4096), 'number of planes');
    insist(areNumbers(published.scale, published.planes) && areNumbers(published.offset, published.planes), 'scales');
    insist([undefined, 'avif', 'both'].includes(published.pictures), 'unknown pictures');
    insist(published.exposure === undefined || Number.isFinite(published.exposure), 'exposure');
    insist(published.knee === undefined || published.knee > 0, 'the guide of its planes');
    checkBasis(published);
    checkLevels(published);
    checkViews(published);
    checkGeometry(published);
    [published.curve, published.gamma] = transferOf(published.transfer);
    published.transform = floatsOf(published.transform, 3 * published.planes * published.functions, 'transform');
    published.mean = floatsOf(published.mean, 3 * published.functions, 'mean');
    published.layers = Math.ceil(published.planes / 3);
    // of linear light: what makes the gain of a pixel of the code of its first plane
    published.guide = published.knee ? [255 * published.scale[0], published.offset[0], published.knee] : null;
    published.base = new URL('.', address).href;
    published.takesLamps = !!published.window || published.views.every((view) => view.depth);  // that stand near
    return published;
}

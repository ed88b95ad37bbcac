// scene.js - what scene.json says, checked before anything is made of it
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

function checkBasis(basis) {
    insist(basis && typeof basis.name === 'string', 'no basis');
    insist(areNumbers(basis.parameter || [], undefined), 'parameters of the basis');
    insist(areNumbers(basis.lights) && basis.lights.length % 3 === 0 &&
           isWhole(basis.lights.length / 3, 1, 4096), 'lights of the basis');
    insist(isWhole(basis.coefficients, 1, 4096), 'coefficients of the basis');
    basis.parameter = basis.parameter || [];
}

function checkLevels(scene) {
    insist(isWhole(scene.tile, 16, 4096), 'size of tiles');
    insist(Array.isArray(scene.levels) && scene.levels.length > 0, 'levels');
    let { width, height } = scene;
    for (const level of scene.levels) {
        insist(level.width === width && level.height === height,
               `a level of ${level.width} x ${level.height}, expected ${width} x ${height}`);
        width = Math.ceil(width / 2);
        height = Math.ceil(height / 2);
    }
    scene.first = Math.min(scene.first_level || 0, scene.levels.length - 1);
}

function checkViews(scene) {
    insist(Array.isArray(scene.views) && isWhole(scene.views.length, 1, 65536), 'views');
    insist([undefined, 'shadows', 'highlights'].includes(scene.moves), 'what moves');
    insist(scene.moves !== 'shadows' || scene.projection !== 'cube', 'shadows that move in a cube');
    for (const view of scene.views) {
        insist(typeof view.name === 'string' && /^[A-Za-z0-9_-]+$/.test(view.name), 'a view without a name');
        insist(scene.projection !== 'slab' || areNumbers(view.uv, 2), 'a view without its place');
        insist(!view.depth || (Number.isFinite(view.depth_min) && Number.isFinite(view.depth_step)),
               'depth without its range');
        insist(scene.moves !== 'shadows' || view.depth, 'shadows that move without depth');
        insist(!view.moving || (areNumbers(view.moving.scale, 8) && areNumbers(view.moving.offset, 8)), 'what moves without its scales');
    }
}

function checkGeometry(scene) {
    const flat = scene.window;
    insist(scene.projection !== 'planar' ||
           (flat && areNumbers(flat.min, 2) && areNumbers(flat.max, 2) && flat.max[0] > flat.min[0] && Number.isFinite(flat.camera_z)), 'no window');
    const slab = scene.slab;
    insist(scene.projection !== 'slab' ||
           (slab && areNumbers([slab.uv_plane_z, slab.st_plane_z]) && areNumbers(slab.st_min, 2) &&
            areNumbers(slab.st_max, 2)), 'no slab');
    const panorama = scene.panorama;
    insist(flat || slab || (panorama && areNumbers(panorama.center, 3) &&
           (scene.projection !== 'cylindrical' || panorama.v_max > panorama.v_min)), 'no panorama');
}

// A scene: what scene.json has, with `transform`, `mean`, `scale` and `offset` as floats, `base` (the
// address that its other files are relative to), `curve` and `gamma`.
export async function loadScene(address) {
    return checkScene(await loadJson(address), address);
}

export function checkScene(scene, address) {
    insist(scene && scene.format === 'relume-web', 'not a scene of relume publish');
    insist(isWhole(scene.version, 1, 1e6), 'no version');
    if (scene.version > NEWEST)
        throw new Failure(`this file was published by a newer relume (format ${scene.version}, ` +
                          `this page knows ${NEWEST}); publish the page again with it`);
    insist(isWhole(scene.width, 1, 1 << 20) && isWhole(scene.height, 1, 1 << 20), 'size of the picture');
    insist(PROJECTIONS.includes(scene.projection), `unknown projection ${scene.projection}`);
    insist(isWhole(scene.planes, 1, 192) && isWhole(scene.functions, 1, 4096), 'number of planes');
    insist(areNumbers(scene.scale, scene.planes) && areNumbers(scene.offset, scene.planes), 'scales');
    insist([undefined, 'avif', 'both'].includes(scene.pictures), 'unknown pictures');
    insist(scene.exposure === undefined || Number.isFinite(scene.exposure), 'exposure');
    insist(scene.knee === undefined || scene.knee > 0, 'the guide of its planes');
    checkBasis(scene.basis);
    checkLevels(scene);
    checkViews(scene);
    checkGeometry(scene);
    [scene.curve, scene.gamma] = transferOf(scene.transfer);
    scene.transform = floatsOf(scene.transform, 3 * scene.planes * scene.functions, 'transform');
    scene.mean = floatsOf(scene.mean, 3 * scene.functions, 'mean');
    scene.layers = Math.ceil(scene.planes / 3);
    // of linear light: what makes the gain of a pixel of the code of its first plane
    scene.guide = scene.knee ? [255 * scene.scale[0], scene.offset[0], scene.knee] : null;
    scene.base = new URL('.', address).href;
    scene.takesLamps = !!scene.window || scene.views.every((view) => view.depth);  // that stand near
    return scene;
}

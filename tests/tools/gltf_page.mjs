// gltf_page.mjs MODULES FOLDER WIDTH 'X Y Z' PNG ... > page.html: a page without network that shows
// FOLDER/model.gltf by three.js (from the folder of node modules), straight from the front, under each
// light, and prints how far that is from the given picture, sRGB codes: "light N mean M psnr P" a
import fs from 'node:fs';
import path from 'node:path';

const [modules, folder, width, ...rest] = process.argv.slice(2);
const types = { '.png': 'image/png', '.bin': 'application/octet-stream' };
const data = (file, type) => `data:${type};base64,${fs.readFileSync(file).toString('base64')}`;
const model = JSON.parse(fs.readFileSync(path.join(folder, 'model.gltf')));
for (const part of [...model.images, ...model.buffers])
    part.uri = data(path.join(folder, part.uri), types[path.extname(part.uri)]);
const lights = [];
for (let i = 0; i + 1 < rest.length; i += 2)
    lights.push({ direction: rest[i].split(' ').map(Number), picture: data(rest[i + 1], 'image/png') });
const three = `file://${path.resolve(modules)}/three`;
process.stdout.write(`<!DOCTYPE html><meta charset="utf-8"><body style="margin:0"><pre id="out">begin
</pre><script type="importmap">{"imports": {"three": "${three}/build/three.module.js"}}</script>
<script type="module">
import * as THREE from 'three';
import { GLTFLoader } from '${three}/examples/jsm/loaders/GLTFLoader.js';
const say = text => { document.getElementById('out').textContent += text + '\\n'; };
window.onerror = e => say('failed ' + e);
window.onunhandledrejection = e => say('failed ' + e.reason);
// A browser that dumps the page waits for pictures that load, not for bitmaps that are decoded.
window.createImageBitmap = undefined;
const load = source => new Promise((done, fail) => {
    const image = new Image();
    image.onload = () => done(image);
    image.onerror = fail;
    image.src = source;
});
const lights = ${JSON.stringify(lights)};
const pictures = await Promise.all(lights.map(light => load(light.picture)));
const gltf = await new GLTFLoader().parseAsync(${JSON.stringify(JSON.stringify(model))}, '');
const box = new THREE.Box3().setFromObject(gltf.scene), size = box.getSize(new THREE.Vector3());
const width = ${Number(width)}, height = Math.round(width * size.y / size.x);
const camera = new THREE.OrthographicCamera(-size.x / 2, size.x / 2, size.y / 2, -size.y / 2, 0.01, 20 * size.x);
camera.position.z = 10 * size.x;
const renderer = new THREE.WebGLRenderer({ preserveDrawingBuffer: true });
renderer.setPixelRatio(1);
renderer.setSize(width, height);
document.body.prepend(renderer.domElement);
const scene = new THREE.Scene();
scene.background = new THREE.Color(0, 0, 0);
scene.add(gltf.scene);
const lamp = new THREE.DirectionalLight(0xffffff, Math.PI);
scene.add(lamp);
const draw = image => {
    const canvas = document.createElement('canvas');
    canvas.width = width;
    canvas.height = height;
    const flat = canvas.getContext('2d');
    flat.drawImage(image, 0, 0);
    return flat.getImageData(0, 0, width, height).data;
};
for (const [i, light] of lights.entries()) {
    lamp.position.set(...light.direction);
    renderer.render(scene, camera);
    const shown = draw(renderer.domElement), want = draw(pictures[i]);
    let sum = 0, square = 0, n = 0;
    for (let k = 0; k < shown.length; k++) {
        if (k % 4 == 3) continue;
        const d = shown[k] - want[k];
        sum += Math.abs(d);
        square += d * d;
        n++;
    }
    say('light ' + i + ' mean ' + (sum / n).toFixed(2) + ' psnr ' + (10 * Math.log10(255 * 255 * n / (square + 1e-9))).toFixed(2));
}
say('end');
</script>
`);

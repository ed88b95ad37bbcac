#!/bin/sh
# web_page.sh FOLDER 'X Y Z' PNG ['X Y Z' PNG ...] > page.html: a page without network that relights
# a relight folder (bilinear, mrgb; planes as pictures or DeepZoom tiles) by WebGL as viewers do and
# prints how far each light's picture is from the given one: "light N mean M max X psnr P" a line; of
# tiles "root T SIDE of TILE", the longer side of the coarsest level; then "end".
set -eu
folder=$1
shift
data() { printf '"data:image/%s;base64,%s"' "$1" "$(base64 -w0 "$2")"; }
cat <<'PAGE'
<!DOCTYPE html><meta charset="utf-8"><pre id="out">begin
</pre><script>
'use strict';
PAGE
printf 'const info = %s;\nconst planes = [' "$(cat "$folder/info.json")"
for f in $(ls "$folder"/plane_*.jpg 2>/dev/null | sort -t_ -k2 -V); do data jpeg "$f"; printf ','; done
printf '];\nconst descriptions = ['
for f in $(ls "$folder"/plane_*.dzi 2>/dev/null | sort -t_ -k2 -V); do printf '`%s`,' "$(cat "$f")"; done
printf '];\nconst tiles = {'
for f in $(cd "$folder" && find . -path '*_files/*.jpg'); do printf '"%s":' "${f#./}"; data jpeg "$folder/$f"; printf ','; done
printf '};\nconst lights = ['
while [ $# -gt 0 ]; do
    printf '{direction: [%s], picture: ' "$(echo "$1" | tr ' ' ',')"
    data png "$2"
    printf '},'
    shift 2
done
printf '];\n'
cat <<'PAGE'
const say = text => { document.getElementById('out').textContent += text + '\n'; };
const load = url => new Promise((done, fail) => {
    const image = new Image();
    image.onload = () => done(image);
    image.onerror = () => fail('an image cannot be decoded');
    image.src = url;
});

// The layout of a .dzi as OpenLIME 1.2.6 sees it: level 0 is one tile, the last one the whole picture.
function layoutOf(text) {
    const xml = new DOMParser().parseFromString(text, 'text/xml'), root = xml.documentElement;
    const size = root.querySelector('Size'), number = (e, name) => parseInt(e.getAttribute(name));
    const l = {tile: number(root, 'TileSize'), overlap: number(root, 'Overlap'),
               width: number(size, 'Width'), height: number(size, 'Height'), suffix: root.getAttribute('Format')};
    l.levels = Math.ceil(Math.log(Math.max(l.width, l.height) / l.tile) / Math.LN2) + 1;
    return l;
}

// A level of plane `index`, each tile without the overlap that it has where it has neighbours.
async function levelOf(index, level) {
    const l = layoutOf(descriptions[index]), cut = l.levels - 1 - level;
    if (!(l.levels > 0)) throw 'no levels';
    const canvas = document.createElement('canvas'), context = canvas.getContext('2d');
    canvas.width = Math.ceil(l.width / 2 ** cut);
    canvas.height = Math.ceil(l.height / 2 ** cut);
    const columns = Math.ceil((l.width >>> cut) / l.tile), rows = Math.ceil((l.height >>> cut) / l.tile);
    for (let y = 0; y < rows; y++)
        for (let x = 0; x < columns; x++) {
            const name = `plane_${index}_files/${level}/${x}_${y}.${l.suffix}`;
            if (!tiles[name]) throw `no tile ${name}`;
            const image = await load(tiles[name]);
            const left = x ? l.overlap : 0, top = y ? l.overlap : 0;
            const w = Math.min(image.width - left, l.tile), h = Math.min(image.height - top, l.tile);
            context.drawImage(image, left, top, w, h, x * l.tile, y * l.tile, w, h);
        }
    return canvas;
}

const planeCount = planes.length || descriptions.length;
const planeOf = async t => planes.length ? load(planes[t]) : levelOf(t, layoutOf(descriptions[t]).levels - 1);

// Weights of a light: the basis interpolated in the octahedral grid.
function weights(direction) {
    const n = info.resolution, length = Math.hypot(...direction);
    const [x, y, z] = direction.map(v => v / length), s = Math.abs(x) + Math.abs(y) + Math.abs(z);
    const u = ((x + y) / s + 1) / 2 * (n - 1), v = ((y - x) / s + 1) / 2 * (n - 1);
    const i = Math.min(Math.floor(u), n - 2), j = Math.min(Math.floor(v), n - 2);
    const a = u - i, b = v - j, m = info.materials[0], out = [];
    for (let p = 0; p <= info.nplanes; p++)
        for (let k = 0; k < 3; k++) {
            const at = (c, r) => {
                const code = info.basis[(p * n * n + c + r * n) * 3 + k];
                return p === 0 ? code / 255 : (code - 127) / m.range[p - 1];
            };
            out.push((1 - b) * ((1 - a) * at(i, j) + a * at(i + 1, j)) +
                     b * ((1 - a) * at(i, j + 1) + a * at(i + 1, j + 1)));
        }
    return out;
}

function shader(gl, kind, text) {
    const s = gl.createShader(kind);
    gl.shaderSource(s, text);
    gl.compileShader(s);
    if (!gl.getShaderParameter(s, gl.COMPILE_STATUS)) throw gl.getShaderInfoLog(s);
    return s;
}

function program(gl) {
    const count = planeCount, sums = [];
    for (let t = 0; t < count; t++)
        for (let c = 0; c < 3 && 3 * t + c < info.nplanes; c++)
            sums.push(`sum += w[${3 * t + c + 1}] * (texelFetch(plane${t}, at, 0)[${c}] - ` +
                      `bias[${3 * t + c}]) * scale[${3 * t + c}];`);
    const p = gl.createProgram();
    gl.attachShader(p, shader(gl, gl.VERTEX_SHADER, `#version 300 es
        void main() { gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0, 1); }`));
    gl.attachShader(p, shader(gl, gl.FRAGMENT_SHADER, `#version 300 es
        precision highp float;
        ${[...Array(count).keys()].map(t => `uniform highp sampler2D plane${t};`).join('')}
        uniform vec3 w[${info.nplanes + 1}];
        uniform float bias[${info.nplanes}], scale[${info.nplanes}];
        out vec4 colour;
        void main() {
            ivec2 at = ivec2(gl_FragCoord.xy);
            vec3 sum = w[0];
            ${sums.join('\n')}
            colour = vec4(sum, 1);
        }`));
    gl.linkProgram(p);
    if (!gl.getProgramParameter(p, gl.LINK_STATUS)) throw gl.getProgramInfoLog(p);
    return p;
}

function pixelsOf(image) {
    const canvas = document.createElement('canvas');
    canvas.width = info.width;
    canvas.height = info.height;
    const context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, info.width, info.height).data;
}

async function run() {
    const canvas = document.createElement('canvas');
    canvas.width = info.width;
    canvas.height = info.height;
    const gl = canvas.getContext('webgl2', {preserveDrawingBuffer: true, antialias: false});
    if (!gl) throw 'no WebGL 2';
    const p = program(gl), got = new Uint8Array(4 * info.width * info.height);
    gl.useProgram(p);
    for (let t = 0; t < planeCount; t++) {
        gl.activeTexture(gl.TEXTURE0 + t);
        gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB, gl.RGB, gl.UNSIGNED_BYTE, await planeOf(t));
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
        gl.uniform1i(gl.getUniformLocation(p, 'plane' + t), t);
    }
    gl.uniform1fv(gl.getUniformLocation(p, 'bias'), info.materials[0].bias);
    gl.uniform1fv(gl.getUniformLocation(p, 'scale'), info.materials[0].scale);
    for (let l = 0; l < lights.length; l++) {
        gl.uniform3fv(gl.getUniformLocation(p, 'w'), weights(lights[l].direction));
        gl.drawArrays(gl.TRIANGLES, 0, 3);
        // the first row of the textures is the top of the picture, and so is what is read first
        gl.readPixels(0, 0, info.width, info.height, gl.RGBA, gl.UNSIGNED_BYTE, got);
        const want = pixelsOf(await load(lights[l].picture));
        let sum = 0, square = 0, most = 0;
        for (let i = 0; i < got.length; i++) {
            const d = i % 4 === 3 ? 0 : Math.abs(got[i] - want[i]);
            sum += d;
            square += d * d;
            most = Math.max(most, d);
        }
        const n = 3 * info.width * info.height;
        const psnr = Math.min(200, 10 * Math.log10(255 * 255 / (square / n + 1e-20)));
        say(`light ${l} mean ${(sum / n).toFixed(4)} max ${most} psnr ${psnr.toFixed(2)}`);
    }
    // the root of the pyramid is one tile and no speck: a viewer shows it until the others are there
    for (let t = 0; t < descriptions.length; t++) {
        const root = await levelOf(t, 0), l = layoutOf(descriptions[t]);
        say(`root ${t} ${Math.max(root.width, root.height)} of ${l.tile}`);
    }
    say('end');
}
run().catch(e => say('failed ' + e));
</script>
PAGE

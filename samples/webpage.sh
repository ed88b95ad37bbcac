#!/bin/sh
# webpage.sh FOLDER > page.html: one page without network or server that relights the folder of
# `relume export` (--to relight, type bilinear) by WebGL 2: move the pointer, and the light follows.
set -eu
[ -f "${1:?usage: webpage.sh FOLDER >page.html}/info.json" ] || {
    echo "webpage.sh: $1: no info.json; expected a folder of 'relume export FILE -o FOLDER'" >&2
    exit 1
}
cat <<'PAGE'
<!DOCTYPE html>
<meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>Relightable image</title>
<style>body { margin: 0; background: #222; color: #ccc; font: 16px sans-serif; text-align: center }
canvas { max-width: 100vw; max-height: 92vh; touch-action: none; cursor: crosshair }</style>
<canvas id="picture"></canvas><p id="text">Move the pointer over the picture: it is where the light comes from.</p>
<script>
'use strict';
PAGE
printf 'const info = %s;\nconst jpegs = [' "$(cat "$1/info.json")"
for f in $(ls "$1"/plane_*.jpg | sort -t_ -k2 -V); do printf '"data:image/jpeg;base64,%s",' "$(base64 -w0 "$f")"; done
cat <<'PAGE'
];
const n = info.resolution, canvas = document.getElementById('picture');
const gl = canvas.getContext('webgl2', {preserveDrawingBuffer: true});
const tell = text => { document.getElementById('text').textContent = text; };

// The light's weight of each plane and colour: the basis is a grid over the hemisphere, unfolded as an octahedron.
function weights(x, y, z) {
    const s = Math.abs(x) + Math.abs(y) + Math.abs(z), range = info.materials[0].range, w = [];
    const u = ((x + y) / s + 1) / 2 * (n - 1), v = ((y - x) / s + 1) / 2 * (n - 1);
    const i = Math.min(Math.floor(u), n - 2), j = Math.min(Math.floor(v), n - 2), a = u - i, b = v - j;
    for (let p = 0; p <= info.nplanes; p++)
        for (let c = 0; c < 3; c++) {
            const at = (k, l) => info.basis[(p * n * n + k + l * n) * 3 + c];
            const code = (1 - b) * ((1 - a) * at(i, j) + a * at(i + 1, j)) + b * ((1 - a) * at(i, j + 1) + a * at(i + 1, j + 1));
            w.push(p ? (code - 127) / range[p - 1] : code / 255);
        }
    return w;
}

function program() {
    const p = gl.createProgram(), sums = [...Array(info.nplanes).keys()].map(
        k => `sum += w[${k + 1}] * (texelFetch(plane${k / 3 | 0}, at, 0)[${k % 3}] - bias[${k}]) * scale[${k}];`);
    const add = (kind, text) => {
        const s = gl.createShader(kind);
        gl.shaderSource(s, '#version 300 es\n' + text);
        gl.compileShader(s);
        gl.attachShader(p, s);
    };
    add(gl.VERTEX_SHADER, 'void main() { gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0, 1); }');
    add(gl.FRAGMENT_SHADER, `precision highp float;
        ${jpegs.map((_, t) => `uniform highp sampler2D plane${t};`).join(' ')}
        uniform vec3 w[${info.nplanes + 1}];
        uniform float bias[${info.nplanes}], scale[${info.nplanes}];
        out vec4 colour;
        void main() {
            ivec2 at = ivec2(gl_FragCoord.x, ${info.height} - 1 - int(gl_FragCoord.y));
            vec3 sum = w[0];
            ${sums.join('\n')}
            colour = vec4(sum, 1);
        }`);
    gl.linkProgram(p);
    if (!gl.getProgramParameter(p, gl.LINK_STATUS)) throw gl.getProgramInfoLog(p);
    return p;
}

async function start() {
    if (!gl) throw 'this browser has no WebGL 2';
    if (info.type !== 'bilinear' || info.colorspace !== 'mrgb') throw 'export with --type bilinear, without --colorspace';
    canvas.width = info.width;
    canvas.height = info.height;
    gl.viewport(0, 0, info.width, info.height);
    const p = program(), place = name => gl.getUniformLocation(p, name);
    gl.useProgram(p);
    for (let t = 0; t < jpegs.length; t++) {
        const image = new Image();
        image.src = jpegs[t];
        await image.decode();
        gl.activeTexture(gl.TEXTURE0 + t);
        gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB, gl.RGB, gl.UNSIGNED_BYTE, image);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
        gl.uniform1i(place('plane' + t), t);
    }
    gl.uniform1fv(place('bias'), info.materials[0].bias);
    gl.uniform1fv(place('scale'), info.materials[0].scale);
    const light = (x, y) => {
        const r = Math.min(1, 0.999 / Math.hypot(x, y));
        gl.uniform3fv(place('w'), weights(x * r, y * r, Math.sqrt(1 - (x * x + y * y) * r * r)));
        gl.drawArrays(gl.TRIANGLES, 0, 3);
    };
    canvas.onpointermove = e => {
        const box = canvas.getBoundingClientRect();
        light((e.clientX - box.left) / box.width * 2 - 1, 1 - (e.clientY - box.top) / box.height * 2);
    };
    light(-0.6, 0.5);
}
start().catch(e => tell('This page cannot show the picture: ' + e));
</script>
PAGE

// pins.js - very many notes on what turns: their places lie on the graphics card, which finds in one drawing
// which of them are hidden, and draws all others in another
import { HEAD } from './shaders.js';

const ACROSS = 256;        // notes in a row of the table of those that are hidden
const RING = 5, WIDE = 1.6, SHADED = 4.1;  // CSS pixels, as overlay.js draws notes

const hidingShader = (way) => `${HEAD}
layout(location = 0) in vec3 place;
layout(location = 1) in float note;
uniform vec2 rows;
out float hidden;
${way}
void main()
{
    vec3 at = project(place);
    hidden = at.z > 0.0 && !hides(at) ? 0.0 : 1.0;
    vec2 cell = vec2(mod(note, ${ACROSS}.0), floor(note / ${ACROSS}.0)) + 0.5;
    gl_Position = vec4(2.0 * cell / rows - 1.0, 0.0, 1.0);
    gl_PointSize = 1.0;
}`;

const hiddenShader = () => `${HEAD}
in float hidden;
out vec4 colour;
void main()
{
    colour = vec4(hidden);
}`;

// A box around a stroke from end to end; a point is a ring.
const strokeVertex = (way) => `${HEAD}
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
layout(location = 2) in float note;
uniform sampler2D table;
uniform float reach;  // of the box beyond its stroke
out vec2 at;
flat out float length_;
${way}
void main()
{
    int index = int(note);
    if (texelFetch(table, ivec2(index % ${ACROSS}, index / ${ACROSS}), 0).r > 0.5) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
        return;
    }
    vec2 a = project(from).xy, along = project(to).xy - a;
    length_ = length(along);
    along = length_ > 0.0 ? along / length_ : vec2(1.0, 0.0);
    at = vec2((gl_VertexID & 1) == 0 ? -reach : length_ + reach, (gl_VertexID & 2) == 0 ? -reach : reach);
    vec2 corner = a + at.x * along + at.y * vec2(-along.y, along.x);
    gl_Position = vec4(2.0 * corner.x / size.x - 1.0, 1.0 - 2.0 * corner.y / size.y, 0.0, 1.0);
}`;

// The shade beside a stroke ends where the stroke does, so that it spares the one before.
const strokeShader = () => `${HEAD}
uniform vec3 strokes;  // radius of a ring, widths of a stroke and of its shade
in vec2 at;
flat in float length_;
out vec4 colour;
const vec3 MARK = vec3(232.0, 196.0, 106.0) / 255.0;
void main()
{
    float beyond = length_ > 0.0 ? at.x - clamp(at.x, 0.0, length_) : 0.0;
    float away = length_ > 0.0 ? length(vec2(beyond, at.y)) : abs(length(at) - strokes.x);
    float mark = clamp(0.5 * strokes.y + 0.5 - away, 0.0, 1.0);
    float shade = beyond == 0.0 ? 0.65 * clamp(0.5 * strokes.z + 0.5 - away, 0.0, 1.0) : 0.0;
    colour = vec4(mark * MARK, mark + (1.0 - mark) * shade);
}`;

export class Pins {
    // `way` is GLSL: uniform vec2 size of the canvas; vec3 project(vec3 place), pixels from its left top and
    // a number above 0 where that is in front of the eye; bool hides(vec3 at). `placeOf(place)`: three numbers.
    constructor(device, way, placeOf) {
        Object.assign(this, { device, way, placeOf, places: null, shapes: null, table: null });
    }

    // The notes that will be drawn, those of them that have places.
    set(notes) {
        const places = [], shapes = [];
        notes.forEach((note, i) => {
            const at = note.places.map((place) => this.placeOf(place)), last = at.length - 1;
            at.forEach((p, k) => {
                places.push(...p, i);
                if (k < last || !last || note.kind === 'polygon')
                    for (let corner = 0; corner < 4; corner++)
                        shapes.push(...p, ...at[k < last ? k + 1 : 0], i);
            });
        });
        this.close();
        this.places = this.upload(places, [3, 1]);
        this.shapes = this.upload(shapes, [3, 3, 1]);
        this.addBoxes(this.shapes);
        this.table = this.device.target(ACROSS, Math.ceil(notes.length / ACROSS) || 1, this.device.gl.RGBA8);
    }

    upload(numbers, sizes) {
        const { device: { gl, empty } } = this, array = gl.createVertexArray(), buffer = gl.createBuffer(), step = sizes.reduce((a, b) => a + b);
        gl.bindVertexArray(array);
        gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
        gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(numbers), gl.STATIC_DRAW);
        sizes.reduce((from, size, i) => {
            gl.enableVertexAttribArray(i);
            gl.vertexAttribPointer(i, size, gl.FLOAT, false, 4 * step, 4 * from);
            return from + size;
        }, 0);
        gl.bindVertexArray(empty);
        return { array, buffers: [buffer], count: numbers.length / step };
    }

    // Two triangles for each four corners: software that stands in for a card draws instances one by one.
    addBoxes(shapes) {
        const { device: { gl, empty } } = this, index = new Uint32Array(6 * shapes.count / 4), buffer = gl.createBuffer();
        for (let i = 0; i < index.length; i++)
            index[i] = 4 * Math.floor(i / 6) + [0, 1, 2, 2, 1, 3][i % 6];
        gl.bindVertexArray(shapes.array);
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
        gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, index, gl.STATIC_DRAW);
        gl.bindVertexArray(empty);
        shapes.buffers.push(buffer);
        shapes.count = index.length;
    }

    // Onto the canvas, over what it shows; `values` are the uniforms of the way.
    draw(values, ratio) {
        const { device, device: { gl }, way, table, places, shapes } = this;
        const hiding = device.program('pins hidden', hiddenShader, hidingShader(way));
        device.begin(table);
        hiding.set({ ...values, rows: [table.width, table.height] });
        gl.enable(gl.BLEND);
        gl.blendEquation(gl.MAX);
        gl.bindVertexArray(places.array);
        gl.drawArrays(gl.POINTS, 0, places.count);
        gl.blendEquation(gl.FUNC_ADD);

        const stroke = device.program('pins', strokeShader, strokeVertex(way));
        device.begin(null, { clear: false });
        gl.enable(gl.BLEND);
        gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
        gl.bindVertexArray(shapes.array);
        stroke.set({ ...values, table: { texture: table.texture }, strokes: [RING * ratio, WIDE * ratio, SHADED * ratio],
                     reach: 1 + (RING + 0.5 * SHADED) * ratio });
        gl.drawElements(gl.TRIANGLES, shapes.count, gl.UNSIGNED_INT, 0);
        gl.disable(gl.BLEND);
        gl.bindVertexArray(device.empty);
    }

    close() {
        const { device: { gl }, places, shapes, table } = this;
        for (const part of [places, shapes].filter((one) => one)) {
            gl.deleteVertexArray(part.array);
            part.buffers.forEach((buffer) => gl.deleteBuffer(buffer));
        }
        this.device.drop(table);
    }
}

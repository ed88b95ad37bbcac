// gl.js - the little of WebGL2 that is needed: programs, targets, a rectangle to draw
import { Failure } from './load.js';

const CORNERS = `#version 300 es
uniform vec4 box;  // of the target, 0 to 1: left, bottom, right, top
out vec2 place;    // 0 to 1 in it, from its left top
void main()
{
    vec2 at = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    place = vec2(at.x, 1.0 - at.y);
    gl_Position = vec4(2.0 * mix(box.xy, box.zw, at) - 1.0, 0.0, 1.0);
}`;

function compileShader(gl, kind, text) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost())
        throw new Failure(`this browser's graphics cannot draw this: ${gl.getShaderInfoLog(shader)}`);
    return shader;
}

// A program that draws rectangles with `fragment`, unless `vertex` is another shader; uniforms are set by name.
class Program {
    constructor(gl, fragment, vertex = CORNERS) {
        this.gl = gl;
        this.id = gl.createProgram();
        for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]])
            gl.attachShader(this.id, compileShader(gl, kind, text));
        gl.linkProgram(this.id);
        this.places = new Map();
    }

    at(name) {
        if (!this.places.has(name))
            this.places.set(name, this.gl.getUniformLocation(this.id, name));
        return this.places.get(name);
    }

    // Numbers and vectors are floats; { int } an integer; { texture, array } a texture.
    set(values) {
        const gl = this.gl;
        let unit = 0;
        gl.useProgram(this.id);
        for (const [name, value] of Object.entries(values)) {
            const at = this.at(name);
            if (typeof value === 'number') gl.uniform1f(at, value);
            else if (Array.isArray(value)) gl[`uniform${value.length}fv`](at, value);
            else if ('int' in value) gl.uniform1i(at, value.int);
            else {
                gl.activeTexture(gl.TEXTURE0 + unit);
                gl.bindTexture(value.array ? gl.TEXTURE_2D_ARRAY : gl.TEXTURE_2D, value.texture);
                gl.uniform1i(at, unit++);
            }
        }
    }

    // Draws a box of the target, all of it by default.
    draw(box = [0, 0, 1, 1]) {
        this.gl.uniform4fv(this.at('box'), box);
        this.gl.drawArrays(this.gl.TRIANGLE_STRIP, 0, 4);
    }
}

export class Device {
    constructor(canvas) {
        const gl = canvas.getContext('webgl2', {
            alpha: true, antialias: false, depth: false, premultipliedAlpha: true, preserveDrawingBuffer: false,
        });
        if (!gl)
            throw new Failure('this browser has no WebGL2');
        if (!gl.getExtension('EXT_color_buffer_float') && !gl.getExtension('EXT_color_buffer_half_float'))
            throw new Failure('this browser\'s graphics cannot add light');
        gl.getExtension('EXT_float_blend');
        this.gl = gl;
        this.programs = new Map();
        this.empty = gl.createVertexArray();
        gl.bindVertexArray(this.empty);
        gl.disable(gl.DITHER);
    }

    program(key, fragment, vertex) {
        if (!this.programs.has(key))
            this.programs.set(key, new Program(this.gl, fragment(), vertex));
        return this.programs.get(key);
    }

    texture(filter, target = this.gl.TEXTURE_2D) {
        const gl = this.gl, texture = gl.createTexture();
        gl.bindTexture(target, texture);
        for (const [name, value] of [[gl.TEXTURE_MIN_FILTER, filter], [gl.TEXTURE_MAG_FILTER, filter],
                                     [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]])
            gl.texParameteri(target, name, value);
        return texture;
    }

    // What light is added up in: half floats, or whole ones.
    target(width, height, format = this.gl.RGBA16F) {
        const gl = this.gl, texture = this.texture(format === gl.RGBA16F ? gl.LINEAR : gl.NEAREST);
        gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, height);
        const frame = gl.createFramebuffer();
        gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
        return { texture, frame, width, height, bytes: 8 * width * height };
    }

    drop(target) {
        if (!target)
            return;
        this.gl.deleteTexture(target.texture);
        if (target.frame)
            this.gl.deleteFramebuffer(target.frame);
    }

    // Draws into `target`, the canvas when it is null, of which nothing is left by default. `add`: to what
    // is there, alpha too or 'rgb' alone.
    begin(target, { clear = true, add = false } = {}) {
        const gl = this.gl;
        gl.bindFramebuffer(gl.FRAMEBUFFER, target ? target.frame : null);
        gl.viewport(0, 0, target ? target.width : gl.drawingBufferWidth, target ? target.height : gl.drawingBufferHeight);
        gl.clearColor(0, 0, 0, 0);
        if (clear)
            gl.clear(gl.COLOR_BUFFER_BIT);
        if (add) {
            gl.enable(gl.BLEND);
            gl.blendFuncSeparate(gl.ONE, gl.ONE, gl.ONE, add === 'rgb' ? gl.ZERO : gl.ONE);
        } else {
            gl.disable(gl.BLEND);
        }
    }

    // Pixels of a target as floats, row 0 at its bottom.
    read(target) {
        const gl = this.gl, out = new Float32Array(4 * target.width * target.height);
        gl.bindFramebuffer(gl.FRAMEBUFFER, target.frame);
        gl.readPixels(0, 0, target.width, target.height, gl.RGBA, gl.FLOAT, out);
        return out;
    }
}

// hdr.js - Radiance pictures (.hdr), and other pictures as environments
import { Failure } from './load.js';

const MOST_TEXELS = 4096 * 2048;

function headerOf(bytes) {
    let at = 0;
    const line = () => {
        const end = bytes.indexOf(10, at);
        if (end < 0 || end - at > 4096)
            throw new Failure('this .hdr picture is damaged');
        const text = String.fromCharCode(...bytes.subarray(at, end));
        at = end + 1;
        return text;
    };
    if (!line().startsWith('#?'))
        throw new Failure('this is no .hdr picture');
    while (line() !== '');
    const size = /^-Y (\d+) \+X (\d+)$/.exec(line());
    if (!size || !(+size[1] * +size[2] > 0 && +size[1] * +size[2] <= MOST_TEXELS))
        throw new Failure('this .hdr picture has a size or an orientation that this page does not take');
    return { height: +size[1], width: +size[2], at };
}

// One row of four bytes a pixel, run-length coded by channel; returns where the next begins.
function readRow(bytes, at, row, width) {
    const old = width < 8 || width > 32767 || bytes[at] !== 2 || bytes[at + 1] !== 2;
    if (old) {
        row.set(bytes.subarray(at, at + 4 * width));
        return at + 4 * width;
    }
    at += 4;
    for (let c = 0; c < 4; c++)
        for (let x = 0; x < width;) {
            const n = bytes[at++], run = n > 128 ? n - 128 : n;
            if (!(run > 0) || x + run > width)
                throw new Failure('this .hdr picture is damaged');
            for (let i = 0; i < run; i++)
                row[4 * x++ + c] = n > 128 ? bytes[at] : bytes[at + i];
            at += n > 128 ? 1 : run;
        }
    return at;
}

// { width, height, rgb }: linear light, row 0 up.
export function readHdr(bytes) {
    let { width, height, at } = headerOf(bytes);
    const rgb = new Float32Array(3 * width * height), row = new Uint8Array(4 * width);
    for (let y = 0; y < height; y++) {
        if (at >= bytes.length)
            throw new Failure('this .hdr picture is cut short');
        at = readRow(bytes, at, row, width);
        for (let x = 0; x < width; x++)
            for (let c = 0; c < 3 && row[4 * x + 3]; c++)
                rgb[3 * (y * width + x) + c] = (row[4 * x + c] + 0.5) * 2 ** (row[4 * x + 3] - 136);
    }
    return { width, height, rgb };
}

// Any picture that the browser decodes, sRGB made linear.
async function readPicture(file) {
    const bitmap = await createImageBitmap(file).catch(() => {
        throw new Failure(`${file.name} is no picture that this browser reads`);
    });
    const width = Math.min(bitmap.width, 1024), height = Math.max(1, Math.round(bitmap.height * width / bitmap.width));
    const canvas = Object.assign(document.createElement('canvas'), { width, height });
    const context = canvas.getContext('2d');
    context.drawImage(bitmap, 0, 0, width, height);
    const { data } = context.getImageData(0, 0, width, height), rgb = new Float32Array(3 * width * height);
    for (let i = 0; i < width * height; i++)
        for (let c = 0; c < 3; c++) {
            const v = data[4 * i + c] / 255;
            rgb[3 * i + c] = v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
        }
    return { width, height, rgb };
}

// What a dropped file is as an environment.
export async function readEnvironment(file) {
    return /\.hdr$/i.test(file.name) ? readHdr(new Uint8Array(await file.arrayBuffer())) : readPicture(file);
}

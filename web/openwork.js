// openwork.js - what runs beside a page that a relume file was dropped onto: the library's reader
// (open/open.c), compiled to WebAssembly, in a worker that reads the file piece by piece
//
// The function is handed to the worker as text: it uses nothing from around it.
export function readFiles() {
    const reader = new FileReaderSync(), AHEAD = 1 << 18;
    let core, opened, file, piece = new Uint8Array(0), pieceAt = 0;

    const bytesAt = (at, size) => new Uint8Array(core.memory.buffer, at, size);

    function textAt(at) {
        const bytes = new Uint8Array(core.memory.buffer, at);
        return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
    }

    function place(text) {
        const bytes = new TextEncoder().encode(`${text}\0`), at = core.open_allocate(bytes.length);
        bytesAt(at, bytes.length).set(bytes);
        return at;
    }

    // Small pieces are read with what follows them.
    function read(at, offset, size) {
        try {
            if (offset < pieceAt || offset + size > pieceAt + piece.length) {
                const some = file.slice(offset, offset + Math.max(size, AHEAD));
                piece = new Uint8Array(reader.readAsArrayBuffer(some));
                pieceAt = offset;
            }
            if (offset + size > pieceAt + piece.length)
                return 0;
            bytesAt(at, size).set(piece.subarray(offset - pieceAt, offset - pieceAt + size));
            return 1;
        } catch {
            return 0;
        }
    }

    // What the compiled library wants of its surroundings: it has no files, and never ends.
    async function compile(bytes) {
        const made = await WebAssembly.compile(bytes), wanted = { env: {}, wasi_snapshot_preview1: {} };
        for (const { module, name } of WebAssembly.Module.imports(made))
            wanted[module][name] = () => -1;
        wanted.env.page_read = read;
        core = (await WebAssembly.instantiate(made, wanted)).exports;
        core._initialize();
    }

    function fail() {
        throw new Error(opened ? textAt(core.open_why(opened)) : 'there is not enough memory for it');
    }

    const calls = {
        async open({ bytes, from }) {
            await compile(bytes);
            file = from;
            opened = core.open_file(place(file.name), file.size);
            if (!opened || textAt(core.open_why(opened)))
                fail();
            return { json: textAt(core.open_json(opened)), bytes: !!core.open_is_bytes(opened) };
        },
        tile({ view, level, x, y, size }) {
            const at = core.open_tile(opened, view, level, x, y);
            return at ? bytesAt(at, size).slice() : fail();
        },
        model({ view, size }) {
            const at = core.open_model(opened, view);
            return at ? bytesAt(at, size).slice() : fail();
        },
        picture({ view, mask, size }) {
            const range = core.open_range(opened), at = core.open_picture(opened, view, +mask);
            return at ? { data: bytesAt(at, size).slice(), range: [...new Float64Array(core.memory.buffer, range, 2)] } : fail();
        },
    };

    self.onmessage = async ({ data: { id, call, given } }) => {
        try {
            const answer = await calls[call](given);
            self.postMessage({ id, answer }, answer.buffer ? [answer.buffer] : []);
        } catch (error) {
            const memory = error instanceof RangeError || error instanceof WebAssembly.RuntimeError;
            self.postMessage({ id, why: memory ? 'there is not enough memory for it' : error.message });
        }
    };
}

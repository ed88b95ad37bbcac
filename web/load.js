// load.js - files of a published folder, from a server or from a disk
//
// On http(s) a file is fetched. Pages on file:// may not fetch: there every file FOO has a script copy FOO.js,
// a script that calls relume.put with the same bytes in base64. Where fetching fails for another
// origin's rules the script copy is tried too.

const waiting = new Map();  // address of a file -> what waits for its script copy

export class Failure extends Error {}

function bytesOf(base64) {
    const text = atob(base64), bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; i++)
        bytes[i] = text.charCodeAt(i);
    return bytes;
}

// Called by a script copy while it runs.
export function put(name, base64) {
    const script = document.currentScript;
    const address = script ? script.src.replace(/\.js$/, '') : name;
    const wanted = waiting.get(address);
    if (wanted)
        wanted.resolve(bytesOf(base64));
}

export function addScript(address) {
    return new Promise((resolve, reject) => {
        const script = document.createElement('script');
        script.src = address;
        script.onload = () => { script.remove(); resolve(); };
        script.onerror = () => { script.remove(); reject(new Failure('missing')); };
        document.head.append(script);
    });
}

function missing(address) {
    return new Failure(`${decodeURI(address).split('/').slice(-3).join('/')} is missing`);
}

async function loadTwin(address) {
    const bytes = new Promise((resolve, reject) => waiting.set(address, { resolve, reject }));
    try {
        await addScript(address + '.js');
        waiting.get(address).reject(missing(address));  // it has run, and put nothing
        return await bytes;
    } catch {
        throw missing(address);
    } finally {
        waiting.delete(address);
    }
}

export async function fetchBytes(address) {
    const answer = await fetch(address);
    if (!answer.ok)
        throw missing(address);
    return new Uint8Array(await answer.arrayBuffer());
}

// The bytes of a file.
export async function loadBytes(address) {
    if (address.startsWith('file:'))
        return loadTwin(address);
    try {
        return await fetchBytes(address);
    } catch (error) {
        if (error instanceof Failure)
            throw error;
        return loadTwin(address);
    }
}

export async function loadJson(address) {
    const text = new TextDecoder().decode(await loadBytes(address));
    try {
        return JSON.parse(text);
    } catch {
        throw new Failure(`${address.split('/').pop()} is damaged`);
    }
}

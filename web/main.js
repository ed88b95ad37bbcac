// main.js - window.relume: what script copies call, and what a page can ask of its first picture
import { put } from './load.js';
import { putCore } from './wasm.js';
import { putMore } from './more.js';
import { isRelume, openFile } from './drop.js';
import { RelumeView } from './element.js';

RelumeView.home = new URL('.', document.currentScript ? document.currentScript.src : document.baseURI).href;

const first = () => document.querySelector('relume-view');
let saidReady = () => {};
const ready = new Promise((resolve) => { saidReady = resolve; });

// A relume file in place of the first picture, or on a page that has none where its input stands.
async function openFirst(file) {
    if (first())
        return first().show(file);
    const input = document.querySelector('[data-relume-open]'), view = RelumeView.of(await openFile(file, RelumeView.home));
    (input ? input.closest('p') : document.body.lastChild).after(view);
    await view.ready;
    saidReady();
    return view;
}

// Pages that say so take a file by a button, or dropped anywhere.
function takeFiles(input) {
    const said = document.querySelector('[data-relume-said]');
    const take = async (file) => {
        said.textContent = file ? `Opening ${file.name}.` : '';
        try {
            if (file && !isRelume(file))
                throw new Error(`${file.name} is no relume file; expected one that ends with .exr`);
            if (file)
                await openFirst(file);
            said.textContent = '';
        } catch (error) {
            said.textContent = `${error.message}.`;
        }
    };
    input.addEventListener('change', () => take(input.files[0]));
    document.addEventListener('dragover', (event) => event.preventDefault());
    document.addEventListener('drop', (event) => {
        event.preventDefault();
        take(event.dataTransfer.files[0]);
    });
}

window.relume = {
    put,
    putCore,
    putMore,
    open: (file) => openFirst(file).then(() => undefined),  // a promise: a File from a disk is shown
    ready,                                     // a promise: the first picture is drawn
    idle: () => (first() ? first().idle() : ready),  // ... and at full detail
    setState: (line) => first() && first().setState(line),
    getState: () => (first() ? first().getState() : ''),
};

customElements.define('relume-view', RelumeView);

function begin() {
    const view = first();
    const show = () => first().setState(location.hash.slice(1));
    const input = document.querySelector('[data-relume-open]');
    if (input)
        takeFiles(input);
    if (!view)
        return;
    if (location.hash.length > 1)
        show();
    window.addEventListener('hashchange', show);
    view.ready.then(saidReady);
}

if (document.readyState === 'loading')
    document.addEventListener('DOMContentLoaded', begin);
else
    begin();

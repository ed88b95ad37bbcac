// main.js - window.relume: what twins call, and what a page can ask of its first picture
import { put } from './load.js';
import { putCore } from './wasm.js';
import { RelumeView } from './element.js';

RelumeView.home = new URL('.', document.currentScript ? document.currentScript.src : document.baseURI).href;

const first = () => document.querySelector('relume-view');
let saidReady = () => {};
const ready = new Promise((resolve) => { saidReady = resolve; });

window.relume = {
    put,
    putCore,
    ready,                                     // a promise: the first picture is drawn
    idle: () => ready.then(() => first().idle()),  // ... and at full detail
    setState: (line) => first() && first().setState(line),
    getState: () => (first() ? first().getState() : ''),
};

customElements.define('relume-view', RelumeView);

function begin() {
    const view = first();
    const show = () => view.setState(location.hash.slice(1));
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

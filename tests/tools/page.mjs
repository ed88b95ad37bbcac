// page.mjs - a page in headless Chromium, told what to do line by line: page.mjs BROWSER PROFILE < ORDERS
//
//   size W H          of the window            open ADDRESS       and wait until its picture is drawn
//   visit ADDRESS     without waiting          state LINE         show it, wait for full detail
//   snap FILE.png     the picture as saved     shot FILE.png      the window
//   eval SCRIPT       prints what it gives     key NAME...        press keys
//   drag X Y X Y      the mouse                drop FILE          onto the picture
//   touch X Y X Y ... each finger from a place to a place
//   write FILE SCRIPT the text that it gives
//   before SCRIPT     runs first in pages from now on
//   serve ADDRESS FOLDER   answers what begins with ADDRESS from there, and prints what is asked for
//   until SCRIPT      waits until it gives something, half a minute
//
// It speaks the DevTools protocol over a pipe; no package is needed. What a page throws is printed
// behind "thrown".
import { spawn } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';

const [browser, profile] = process.argv.slice(2);
const child = spawn(browser, [
    '--headless=new', '--no-sandbox', '--disable-gpu-sandbox', '--use-gl=angle', '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader', '--remote-debugging-pipe', `--user-data-dir=${profile}`, '--no-first-run',
    '--disable-extensions', '--disable-background-networking', '--mute-audio', '--hide-scrollbars',
    ...(process.env.PAGE_FLAGS || '').split(' ').filter((flag) => flag), 'about:blank',
], { stdio: ['ignore', 'ignore', process.env.PAGE_LOG ? 'inherit' : 'ignore', 'pipe', 'pipe'] });
const asked = new Map(), heard = [];
let count = 0, rest = Buffer.alloc(0);

child.stdio[4].on('data', (bytes) => {
    rest = Buffer.concat([rest, bytes]);
    for (let end = rest.indexOf(0); end >= 0; end = rest.indexOf(0)) {
        const message = JSON.parse(rest.subarray(0, end).toString());
        rest = rest.subarray(end + 1);
        if (asked.has(message.id)) {
            const { resolve, reject } = asked.get(message.id);
            asked.delete(message.id);
            if (message.error) reject(new Error(message.error.message));
            else resolve(message.result);
        } else {
            heard.forEach((listener) => listener(message));
        }
    }
});

let session;
function send(method, params = {}) {
    const id = ++count;
    child.stdio[3].write(`${JSON.stringify({ id, method, params, sessionId: session })}\0`);
    return new Promise((resolve, reject) => asked.set(id, { resolve, reject }));
}

async function evaluate(expression) {
    const { result, exceptionDetails } = await send('Runtime.evaluate', { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails)
        throw new Error(exceptionDetails.exception?.description || exceptionDetails.text);
    return result.value;
}

async function visit(address) {
    const loaded = new Promise((resolve) => {
        const listener = (message) => message.method === 'Page.loadEventFired' && resolve();
        heard.push(listener);
    });
    await send('Page.navigate', { url: address });
    await loaded;
}

const BLOB = `blob => new Promise(done => { const reader = new FileReader();
    reader.onload = () => done(reader.result.split(',')[1]); reader.readAsDataURL(blob); })`;

const TYPES = { html: 'text/html', js: 'text/javascript', css: 'text/css', json: 'application/json', jpg: 'image/jpeg', png: 'image/png', svg: 'image/svg+xml' };

// An answer to a request of the page, of a file of `folder`.
async function answer({ requestId, request }, address, folder) {
    const path = decodeURIComponent(new URL(request.url).pathname.slice(new URL(address).pathname.length));
    const type = TYPES[path.split('.').pop()] || 'application/octet-stream';
    let body = null;
    try {
        body = readFileSync(`${folder}/${path}`).toString('base64');
    } catch { /* it is not there */ }
    console.log(`asked ${path}${body === null ? ' missing' : ''}`);
    await send('Fetch.fulfillRequest', { requestId, responseCode: body === null ? 404 : 200, body: body || '',
                                         responseHeaders: [{ name: 'Content-Type', value: type }, { name: 'Access-Control-Allow-Origin', value: '*' }] });
}

const orders = {
    size: (w, h) => send('Emulation.setDeviceMetricsOverride', { width: +w, height: +h, deviceScaleFactor: 1, mobile: false }),
    visit,
    async open(address) {
        await visit(address);
        await evaluate('window.relume.ready');
    },
    state: (line) => evaluate(`window.relume.setState(${JSON.stringify(line)}); window.relume.idle().then(() => 0)`),
    async snap(file) {
        const base64 = await evaluate(`document.querySelector('relume-view, relume-object').snapshot().then(${BLOB})`);
        writeFileSync(file, Buffer.from(base64, 'base64'));
    },
    async shot(file) {
        const { data } = await send('Page.captureScreenshot', { format: 'png' });
        writeFileSync(file, Buffer.from(data, 'base64'));
    },
    async eval(script) {
        console.log(JSON.stringify(await evaluate(script)) ?? 'undefined');
    },
    async write(line) {
        const cut = line.indexOf(' ');
        writeFileSync(line.slice(0, cut), await evaluate(line.slice(cut + 1)));
    },
    async serve(address, folder) {
        heard.push((message) => {
            if (message.method === 'Fetch.requestPaused')
                answer(message.params, address, folder).catch((error) => console.log(`thrown ${error.message}`));
        });
        await send('Fetch.enable', { patterns: [{ urlPattern: `${address}*` }] });
    },
    async until(script) {
        for (let i = 0; i < 150 && !await evaluate(script).catch(() => false); i++)
            await new Promise((resolve) => setTimeout(resolve, 200));
    },
    before: (source) => send('Page.addScriptToEvaluateOnNewDocument', { source }),
    async key(...names) {
        for (const name of names)
            for (const type of ['keyDown', 'keyUp'])
                await send('Input.dispatchKeyEvent', { type, key: name === 'Space' ? ' ' : name, code: name.length > 1 ? name : undefined,
                                                       text: name.length === 1 && type === 'keyDown' ? name : undefined,
                                                       windowsVirtualKeyCode: { Tab: 9, Enter: 13 }[name] });
    },
    async drag(...places) {
        const [x, y, toX, toY] = places.map(Number);
        const mouse = (type, px, py, buttons) => send('Input.dispatchMouseEvent',
            { type, x: px, y: py, button: 'left', buttons, clickCount: 1 });
        await mouse('mousePressed', x, y, 1);
        for (let i = 1; i <= 4; i++)
            await mouse('mouseMoved', x + (toX - x) * i / 4, y + (toY - y) * i / 4, 1);
        await mouse('mouseReleased', toX, toY, 0);
    },
    async touch(...places) {
        const fingers = [];
        for (let i = 0; i + 3 < places.length; i += 4)
            fingers.push(places.slice(i, i + 4).map(Number));
        const at = (t) => fingers.map(([x, y, toX, toY], id) => ({ x: x + t * (toX - x), y: y + t * (toY - y), id }));
        await send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: at(0) });
        for (let i = 1; i <= 4; i++)
            await send('Input.dispatchTouchEvent', { type: 'touchMove', touchPoints: at(i / 4) });
        await send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
    },
    async drop(file) {
        const base64 = readFileSync(file).toString('base64'), name = file.split('/').pop();
        await evaluate(`(async () => { const bytes = Uint8Array.from(atob('${base64}'), c => c.charCodeAt(0));
            await document.querySelector('relume-view').drop(new File([bytes], ${JSON.stringify(name)})); })()`);
    },
};

async function run() {
    const { targetInfos } = await send('Target.getTargets');
    const page = targetInfos.find((target) => target.type === 'page');
    ({ sessionId: session } = await send('Target.attachToTarget', { targetId: page.targetId, flatten: true }));
    await send('Page.enable');
    await send('Runtime.enable');
    heard.push((message) => {
        if (message.method === 'Runtime.exceptionThrown')
            console.log(`thrown ${message.params.exceptionDetails.exception?.description || message.params.exceptionDetails.text}`);
        if (message.method === 'Runtime.consoleAPICalled' && message.params.type === 'error')
            console.log(`thrown ${message.params.args.map((a) => a.description || a.value).join(' ')}`);
    });
    for (const line of readFileSync(0, 'utf8').split('\n').filter((l) => l.trim() && !l.startsWith('#'))) {
        const cut = line.indexOf(' '), name = cut < 0 ? line : line.slice(0, cut), given = cut < 0 ? '' : line.slice(cut + 1);
        const whole = ['eval', 'state', 'open', 'visit', 'write', 'before', 'until'].includes(name);
        await orders[name](...(whole ? [given] : given.split(' ')));
    }
}

let failed = 0;
try {
    await run();
} catch (error) {
    console.log(`failed ${error.message}`);
    failed = 1;
}
try {
    session = undefined;
    await send('Browser.close');
} catch { /* it has ended already */ }
process.exit(failed);

// pointer.js - mouse, pen and fingers on the picture
//
// One pointer drags; with Ctrl, the second button or after a finger's long press it does the other
// thing. Two fingers move and enlarge.

const LONG_PRESS = 450;  // milliseconds
const STILL = 6;         // CSS pixels

// `to`: click(at), drag(at, dx, dy, other), pinch(factor, x, y, dx, dy), wheel(factor, x, y), held();
// all in CSS pixels of `node`.
export function listenPointers(node, to) {
    const fingers = new Map();
    let other = false, still = false, timer = 0;
    const place = (event) => {
        const box = node.getBoundingClientRect();
        return { x: event.clientX - box.left, y: event.clientY - box.top };
    };
    const middle = () => {
        const [a, b] = [...fingers.values()];
        return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, apart: Math.hypot(a.x - b.x, a.y - b.y) };
    };
    node.addEventListener('pointerdown', (event) => {
        const at = place(event);
        node.setPointerCapture(event.pointerId);
        node.focus({ preventScroll: true });
        fingers.set(event.pointerId, { ...at, from: at });
        clearTimeout(timer);
        still = false;
        if (fingers.size === 1) {
            other = event.ctrlKey || event.metaKey || event.button === 2;
            still = true;
            if (event.pointerType !== 'mouse')
                timer = setTimeout(() => { other = true; to.held(); }, LONG_PRESS);
        }
        event.preventDefault();
    });
    node.addEventListener('pointermove', (event) => {
        const finger = fingers.get(event.pointerId), at = place(event);
        if (!finger)
            return;
        const before = fingers.size > 1 ? middle() : null, dx = at.x - finger.x, dy = at.y - finger.y;
        Object.assign(finger, at);
        if (Math.hypot(at.x - finger.from.x, at.y - finger.from.y) > STILL) {
            clearTimeout(timer);
            still = false;
        }
        if (fingers.size === 1 && !still) {
            to.drag(at, dx, dy, other);
        } else if (fingers.size === 2) {
            const after = middle();
            to.pinch(after.apart / Math.max(before.apart, 1), after.x, after.y, after.x - before.x, after.y - before.y);
        }
    });
    for (const name of ['pointerup', 'pointercancel'])
        node.addEventListener(name, (event) => {
            const finger = fingers.get(event.pointerId);
            clearTimeout(timer);
            fingers.delete(event.pointerId);
            if (finger && still && !other && fingers.size === 0 && name === 'pointerup')
                to.click(finger);
        });
    node.addEventListener('contextmenu', (event) => event.preventDefault());
    node.addEventListener('wheel', (event) => {
        const at = place(event), lines = event.deltaMode === 1 ? 16 : 1;
        to.wheel(2 ** (-event.deltaY * lines / (event.ctrlKey ? 100 : 300)), at.x, at.y);
        event.preventDefault();
    }, { passive: false });
}

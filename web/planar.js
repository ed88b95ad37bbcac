// planar.js - a picture that is moved and enlarged
import { levelFor } from './paint.js';

export class Planar {
    constructor(published, painter) {
        Object.assign(this, { published, painter });
    }

    // The whole picture in a frame: { x, y, scale }, picture pixels of the middle and pixels each.
    fit(width, height) {
        const { published } = this, scale = Math.min(width / published.width, height / published.height);
        return { x: published.width / 2, y: published.height / 2, scale };
    }

    draw(target, kind, camera) {
        const { at } = camera, { published } = this;
        const map = { scale: at.scale, left: target.width / 2 - at.x * at.scale, top: target.height / 2 - at.y * at.scale };
        const part = [Math.max(0, -map.left / at.scale), Math.max(0, -map.top / at.scale),
                      Math.min(published.width, (target.width - map.left) / at.scale),
                      Math.min(published.height, (target.height - map.top) / at.scale)];
        const level = Math.min(levelFor(published, at.scale) + camera.coarser, published.levels.length - 1);
        this.painter.paint(target, published.views[0], kind, level, map, part);
    }

    close() {}
}

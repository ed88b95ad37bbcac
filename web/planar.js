// planar.js - a picture that is moved and enlarged
import { levelFor } from './paint.js';

export class Planar {
    constructor(scene, painter) {
        Object.assign(this, { scene, painter });
    }

    // The whole picture in a frame: { x, y, scale }, picture pixels of the middle and pixels each.
    fit(width, height) {
        const { scene } = this, scale = Math.min(width / scene.width, height / scene.height);
        return { x: scene.width / 2, y: scene.height / 2, scale };
    }

    draw(target, kind, camera) {
        const { at } = camera, { scene } = this;
        const map = { scale: at.scale, left: target.width / 2 - at.x * at.scale, top: target.height / 2 - at.y * at.scale };
        const part = [Math.max(0, -map.left / at.scale), Math.max(0, -map.top / at.scale),
                      Math.min(scene.width, (target.width - map.left) / at.scale),
                      Math.min(scene.height, (target.height - map.top) / at.scale)];
        const level = Math.min(levelFor(scene, at.scale) + camera.coarser, scene.levels.length - 1);
        this.painter.paint(target, scene.views[0], kind, level, map, part);
    }

    close() {}
}

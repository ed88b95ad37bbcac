// panorama.js - looking around in a panorama; after src/view/panorama.c
import { RADIANS } from './lights.js';
import { levelFor } from './paint.js';
import { panoramaShader } from './shaders.js';


export class Panorama {
    constructor(scene, painter, device) {
        Object.assign(this, { scene, painter, device });
        this.level = -1;
        this.whole = {};
    }

    // The picture as large as the look needs it, and as textures may be.
    setLevel(target, camera) {
        const { scene } = this, { gl } = this.device, most = gl.getParameter(gl.MAX_TEXTURE_SIZE);
        const around = scene.projection === 'cube' ? scene.width * 2 / 3 : scene.width;
        const needed = target.width * camera.zoom * Math.PI / (camera.planet ? 2 : 1);  // pixels around
        let level = Math.min(levelFor(scene, needed / around) + camera.coarser, scene.levels.length - 1);
        while (scene.levels[level].width > Math.min(most, 8192) && level + 1 < scene.levels.length)
            level++;
        if (level === this.level)
            return;
        this.close();
        this.level = level;
    }

    draw(target, kind, camera) {
        const { scene } = this;
        this.setLevel(target, camera);
        const { width, height } = scene.levels[this.level];
        const whole = this.whole[kind] = this.whole[kind] || { ...this.device.target(width, height), cache: {} };
        this.painter.paint(whole, scene.views[0], kind, this.level, { scale: 2 ** -this.level, left: 0, top: 0, flip: true, cache: whole.cache },
                           [0, 0, scene.width, scene.height]);
        const program = this.device.program('panorama', () => panoramaShader(scene.projection));
        this.device.begin(target);
        program.set({ view: { texture: whole.texture }, frame: [target.width, target.height], planet: camera.planet ? 1 : 0,
                      look: [camera.pan * RADIANS, camera.tilt * RADIANS, 1 / camera.zoom],
                      elevation: scene.panorama ? [scene.panorama.v_min || 0, scene.panorama.v_max || 0] : [0, 0] });
        program.draw();
    }

    close() {
        Object.values(this.whole).forEach((target) => this.device.drop(target));
        this.whole = {};
    }
}

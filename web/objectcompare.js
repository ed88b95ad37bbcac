// objectcompare.js - two looks at an object beside each other: a kept one, or another object
import { Comparison } from './compare.js';
import { Failure } from './load.js';
import { minus } from './objectmodel.js';

const APART = 0.5;  // diagonals, between the middles of two objects
const UNLIKE = 2;   // of their sizes

export class ObjectComparison extends Comparison {
    keep() {
        this.replace({ ...this.viewer.seen(), lit: {} });
    }

    // Another object at the same place, seen from the same eye; its lights are this one's.
    async open(address) {
        const { viewer } = this, model = await viewer.openModel(address), { title, name } = model.object;
        const k = model.across / viewer.across, apart = Math.hypot(...minus(model.middle, viewer.middle));
        if (k > UNLIKE || k < 1 / UNLIKE || apart > APART * viewer.across) {
            model.close();
            throw new Failure(`${title || name || 'The other object'} cannot be compared with this one: it lies elsewhere, or has another size`);
        }
        this.replace({ ...viewer.seen(), model, lit: {}, follows: address, title: title || name || 'the other object' });
    }

    follow() {
        const { kept, viewer } = this;
        if (kept && kept.follows)
            Object.assign(kept, viewer.seen(), { model: kept.model, lit: kept.lit });
    }

    drop() {
        const { kept, viewer } = this;
        if (kept && kept.model !== viewer.model)
            kept.model.close();
        if (kept)
            viewer.device.gl.deleteTexture(kept.lit.texture || null);
        this.kept = null;
    }
}

// gltf_check.mjs MODULES MODEL.gltf: what Khronos's gltf-validator (from the folder of node modules)
// says of a model: "errors N warnings N infos N hints N", then its messages, a line each.
import fs from 'node:fs';
import path from 'node:path';
import { createRequire } from 'node:module';

const [modules, model] = process.argv.slice(2);
const validator = createRequire(path.resolve(modules) + '/')('gltf-validator');
const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(model)), {
    uri: model,
    externalResourceFunction: async uri =>
        new Uint8Array(fs.readFileSync(path.join(path.dirname(model), decodeURIComponent(uri)))),
});
const n = report.issues;
console.log(`errors ${n.numErrors} warnings ${n.numWarnings} infos ${n.numInfos} hints ${n.numHints}`);
for (const m of n.messages) console.log(m.code, m.pointer, m.message);

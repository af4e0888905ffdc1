// Where three.js has the joints of a .glb: {skin name: {joint: [[x, y, z], ... frames]}}.
//   node positions.mjs NODE_MODULES FILE FRAMES FRAME_RATE
import fs from 'fs';
import path from 'path';
import {pathToFileURL} from 'url';

globalThis.self = globalThis;
const [modules, file, frames, rate] = process.argv.slice(2);
const load = (name) => import(pathToFileURL(path.join(modules, 'three', name)));
const THREE = await load('build/three.module.js');
const {GLTFLoader} = await load('examples/jsm/loaders/GLTFLoader.js');

const bytes = fs.readFileSync(file);
const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
const gltf = await new GLTFLoader().parseAsync(buffer, '');
const mixer = new THREE.AnimationMixer(gltf.scene);
const action = mixer.clipAction(gltf.animations[0]);
action.setLoop(THREE.LoopOnce);
action.clampWhenFinished = true;
action.play();

const skins = new Map();  // skin -> its bones with the names of the file
gltf.scene.traverse((object) => {
  if (!object.isSkinnedMesh || skins.has(object.skeleton)) return;
  const skin = gltf.parser.json.skins[gltf.parser.json.nodes.find(
      (node) => node.name === (object.parent.userData.name || object.parent.name) ||
                node.name === object.name).skin];
  skins.set(object.skeleton, {
    name: skin.name,
    bones: object.skeleton.bones.map(
        (bone, i) => [gltf.parser.json.nodes[skin.joints[i]].name, bone]),
  });
});

const all = {};
for (const {name, bones} of skins.values()) {
  all[name] = {};
  for (const [joint] of bones) all[name][joint] = [];
}
const point = new THREE.Vector3();
for (let frame = 0; frame < Number(frames); ++frame) {
  mixer.setTime(frame / Number(rate));
  gltf.scene.updateMatrixWorld(true);
  for (const {name, bones} of skins.values()) {
    for (const [joint, bone] of bones) {
      all[name][joint].push(bone.getWorldPosition(point).toArray());
    }
  }
}
process.stdout.write(JSON.stringify(all));

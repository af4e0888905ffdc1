// Where three.js has the joints of a .usda: {person: {joint: [[x, y, z], ... frames]}}.
//   node positions.mjs NODE_MODULES FILE FRAMES
import fs from 'fs';
import path from 'path';
import {pathToFileURL} from 'url';

globalThis.self = globalThis;
const [modules, file, frames] = process.argv.slice(2);
const load = (name) => import(pathToFileURL(path.join(modules, 'three', name)));
const THREE = await load('build/three.module.js');
const {USDLoader} = await load('examples/jsm/loaders/USDLoader.js');

const text = fs.readFileSync(file, 'utf8');
const rate = Number(/framesPerSecond = ([\d.]+)/.exec(text)[1]);
const scene = new USDLoader().parse(text);
// It finds bones by their names, which both people share: each has a mixer for what hangs below it.
const people = ['leader', 'follower'].map((name) => scene.getObjectByName(name));
const mixers = people.map((person, i) => {
  const mixer = new THREE.AnimationMixer(person);
  const action = mixer.clipAction(scene.animations[i]);
  action.setLoop(THREE.LoopOnce);
  action.clampWhenFinished = true;
  action.play();
  return mixer;
});

const skeletons = people.map((person) => {
  let skeleton = null;
  person.traverse((object) => { skeleton = skeleton || object.skeleton; });
  return skeleton;
});

const all = {};
const point = new THREE.Vector3();
for (let frame = 0; frame < Number(frames); ++frame) {
  for (const mixer of mixers) mixer.setTime(frame / rate);
  scene.updateMatrixWorld(true);
  people.forEach(({name}, i) => {
    all[name] = all[name] || {};
    for (const bone of skeletons[i].bones) {
      const joint = bone.name.split('/').pop();
      (all[name][joint] = all[name][joint] || []).push(
          point.setFromMatrixPosition(bone.matrixWorld).toArray());
    }
  });
}
process.stdout.write(JSON.stringify(all));

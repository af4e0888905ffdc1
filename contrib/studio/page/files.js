'use strict';
// Uploads and downloads through the gateway.
const LEAST_FRAMES = 2;  // of a leader

// The message of an error response: the gateway's JSON, or a proxy's status.
async function messageIn(response) {
  const text = await response.text();
  try {
    return JSON.parse(text).error.message;
  } catch {
    return `${response.status} ${response.statusText}`;
  }
}

// The joints of a model in the form of the gateway: NAME:PARENT, the parent as an index; the root has
// none.
function skeletonOf(model) {
  const parents = new Map(model.bones.map((bone) => [bone.child_joint ?? 0, bone.parent_joint ?? 0]));
  return model.joint_names.map((name, i) => `${encodeURIComponent(name)}:${parents.get(i) ?? ''}`).join();
}

// The bytes of a sample's file.
async function fetchSample(name) {
  const response = await fetchFrom(`/samples/${name}.bvh`);
  if (!response.ok) throw new CallError(await messageIn(response));
  return response.arrayBuffer();
}

// Reads the leader of a file in the joints of a model: {notes, motion}. `query`: settings for reading it.
async function readMotion(name, bytes, model, query = []) {
  const parts = new URLSearchParams([['name', safeName(name)], ...query]);
  const response = await fetchFrom(`/read?${parts}&skeleton=${skeletonOf(model)}`, {method: 'POST', body: bytes});
  if (!response.ok) throw new CallError(await messageIn(response));
  const {notes, motion} = await response.json();
  return {notes, motion: {joint_names: motion.joint_names, frame_rate_hz: motion.frame_rate_hz,
                          frames: motion.leader.length, positions: Float32Array.from(motion.leader.flat(2))}};
}

// Reads a leader with the current settings. Returns {name, bytes, motion, notes}.
async function readLeader(name, bytes) {
  const query = READING.flatMap((setting) => (
    setting === 'joint_map' ? lines(settings.joint_map) : [settings[setting]]).filter(Boolean).map(
      (value) => [setting, value]));
  const {notes, motion} = await readMotion(name, bytes, modelNamed(settings.model), query);
  if (motion.frames < LEAST_FRAMES) {
    throw new Error(`${name}: expected a motion of at least ${LEAST_FRAMES} frames, got ${
        motion.frames}. A single pose has no reaction.`);
  }
  return {name, bytes, notes, motion};
}

// [frames][joints][3]
function nested({joint_names}, values) {
  const joints = joint_names.length;
  return Array.from({length: values.length / joints / 3}, (_, frame) => Array.from(
      joint_names, (name, joint) => Array.from(values.subarray(
          (frame * joints + joint) * 3, (frame * joints + joint) * 3 + 3))));
}

// The shown pair as "duet-motion" JSON.
function pairJson() {
  const take = state.takes[state.chosen];
  const {motion} = state.leader;
  return JSON.stringify({
    format: 'duet-motion', version: 1, unit: 'metres', up_axis: 'y-up',
    joint_names: motion.joint_names, bones: bonesOf(motion), frame_rate_hz: motion.frame_rate_hz,
    leader: nested(motion, motion.positions), follower: nested(motion, take.positions)});
}

async function download(kind) {
  const query = new URLSearchParams({
    format: kind, name: downloadName(state.takes[state.chosen]), skeleton: 'own'});
  if (settings.resample !== '') query.set('resample', settings.resample);
  await save(await fetchFrom(`/write?${query}`, {method: 'POST', body: pairJson()}));
}

// The settings for the rig's file as parts of a query: for the leader's own, those for reading it.
function rigSettings() {
  const joints = lines(state.rig ? settings.rig_joint_map : settings.joint_map);
  const names = state.rig ? ['resample'] : ['side', 'up_axis', 'metres_per_unit', 'resample'];
  return [...joints.map((joint) => ['joint_map', joint]),
          ...names.map((name) => [name, settings[name]]).filter(([, value]) => value !== '')];
}

// The shown follower on a rig: the leader's own or another file's.
async function downloadOnRig() {
  const {name, bytes} = state.rig ?? state.leader;
  const query = new URLSearchParams([
    ...rigSettings(), ['format', /\.bvh$/i.test(name) ? 'bvh' : 'glb'], ['rig', safeName(name)],
    ['name', downloadName(state.takes[state.chosen])]]);
  tell('Writing the follower on the rig …');
  await save(await fetchFrom(`/write_on_rig?${query}`, {
    method: 'POST', body: new Blob([pairJson(), '\n', bytes])}));
}

async function save(response) {
  if (!response.ok) throw new CallError(await messageIn(response));
  const name = /filename="([^"]+)"/.exec(response.headers.get('Content-Disposition'))[1];
  saveBlob(await response.blob(), name);
}

function saveBlob(blob, name) {
  const link = Object.assign(document.createElement('a'),
                             {href: URL.createObjectURL(blob), download: name});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
  root.dataset.downloaded = name;
  tell(`Saved as ${name}`);
}

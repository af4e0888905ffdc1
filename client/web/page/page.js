'use strict';
// Puts the page together: files in, label sliders, one call at a time to the server, files out.
const root = document.documentElement;
const element = (id) => document.getElementById(id);
const METRES = 1;
const Y_UP = 1;
const SETTLE_MILLISECONDS = 120;  // a slider that moves asks when it has come to rest

const state = {
  model: null,     // as GetModel describes it
  leader: null,    // {joint_names, frame_rate_hz, positions: Float32Array}
  follower: null,  // Float32Array, once an answer is whole
  seed: 0,
  call: null,      // of the call in progress: its AbortController
  answers: 0,
};

const theatre = element('stage');
theatre.addEventListener('drawn', () => {
  const {motion, player} = theatre;
  element('scrub').value = Math.round(player.frame);
  element('time').value = `${(player.frame / motion.frameRate).toFixed(2)} of ` +
                          `${motion.duration.toFixed(2)} s`;
  element('play').textContent = player.playing ? 'Pause' : 'Play';
  root.dataset.draws = theatre.draws;
});
theatre.addEventListener('error', ({detail}) => tell(detail.message, true));

function tell(text, failed = false) {
  element('status').textContent = text;
  element('status').classList.toggle('failed', failed);
  root.dataset.failed = failed;
}

function addSlider(name, value) {
  const label = document.createElement('label');
  label.className = 'slider';
  const input = Object.assign(document.createElement('input'),
                              {type: 'range', min: -1, max: 1, step: 0.05, value, name});
  const shown = Object.assign(document.createElement('output'), {value});
  label.append(Object.assign(document.createElement('span'),
                             {textContent: name.replaceAll('_', ' ')}), input, shown);
  element('labels').append(label);
}

function addButton(parent, text, act) {
  const button = Object.assign(document.createElement('button'), {textContent: text});
  button.addEventListener('click', () => act(button));
  parent.append(button);
  return button;
}

const sliders = () => [...element('labels').querySelectorAll('input')];

// Sets the class of a sample's name, where there is one: what a visitor would try first.
function suggest(name) {
  if (!sliders().some((slider) => slider.name === name)) return;
  for (const slider of sliders()) {
    slider.value = slider.name === name ? 1 : 0;
    slider.parentElement.querySelector('output').value = slider.value;
  }
}

async function readLeader(name, body) {
  tell(`Reading ${name} …`);
  const safe = name.replace(/[^\w.-]/g, '_').replace(/^\.+/, '');
  const response = await fetch(`/read?name=${encodeURIComponent(safe)}`, {method: 'POST', body});
  if (!response.ok) {
    tell(await response.text(), true);
    return;
  }
  const motion = await response.json();
  const positions = Float32Array.from(motion.leader.flat(2));
  state.leader = {...motion, positions};
  state.follower = null;
  const index = (joint) => motion.joint_names.indexOf(state.model.joint_names[joint]);
  theatre.motion = {
    joints: motion.joint_names, frameRate: motion.frame_rate_hz, frames: motion.leader.length,
    leader: positions,
    bones: state.model.bones.map((bone) => [index(bone.parent_joint ?? 0),
                                            index(bone.child_joint ?? 0)]),
  };
  element('scrub').max = theatre.motion.frames - 1;
  element('empty').hidden = true;
  element('transport').hidden = false;
  element('leader-name').textContent = `${name}: ${theatre.motion.frames} frames at ` +
                                       `${Math.round(motion.frame_rate_hz * 100) / 100} Hz`;
  root.dataset.frames = theatre.motion.frames;
  await react();
}

function requestOf(leader) {
  return {
    leader: {joint_names: leader.joint_names, frame_rate_hz: leader.frame_rate_hz, unit: METRES,
             up_axis: Y_UP, frame_count: leader.positions.length / leader.joint_names.length / 3,
             positions: leader.positions},
    label_vector: {weights: sliders().map((slider) => ({interaction_class: slider.name,
                                                        weight: Number(slider.value)}))},
    seed: state.seed,
    variety: Number(element('variety').value),
  };
}

// Asks for the follower as everything stands now; a call that is still being answered is dropped.
async function react() {
  if (!state.leader) return;
  if (state.call) state.call.abort();
  const call = state.call = new AbortController();
  const begun = performance.now();
  tell('Asking …');
  try {
    const leader = state.leader;
    const follower = new Float32Array(leader.positions.length);
    let summary = null;
    for await (const {chunk, summary: last} of callServer(
        'Synthesize', 'SynthesizeRequest', requestOf(leader), 'SynthesizeResponse', call.signal)) {
      if (chunk) {
        const first = chunk.first_frame ?? 0;
        follower.set(chunk.positions, first * leader.joint_names.length * 3);
        theatre.takeFrames(first, chunk.positions);
      }
      summary = summary || last;
    }
    if (!summary) throw new CallError('the answer ended before its end');
    theatre.setFollower(follower);
    finish(follower, summary, begun);
  } catch (error) {
    if (!call.signal.aborted) tell(error.message, true);
  }
}

function finish(follower, summary, begun) {
  state.follower = follower;
  state.answers += 1;
  root.dataset.answers = state.answers;
  for (const button of element('downloads').children) button.disabled = false;
  const far = summary.unfamiliarity > 1.5 ? ' This leader is unlike those that the model learned ' +
      'from: look before you use it.' : '';
  tell(`Answered in ${((performance.now() - begun) / 1000).toFixed(2)} s, seed ${state.seed}.${far}`);
}

async function download(kind) {
  const {joint_names, frame_rate_hz, positions} = state.leader;
  const frames = (values) => Array.from(
      {length: values.length / joint_names.length / 3}, (_, frame) => Array.from(
          joint_names, (name, joint) => Array.from(values.subarray(
              (frame * joint_names.length + joint) * 3, (frame * joint_names.length + joint) * 3 + 3))));
  const response = await fetch(`/write?format=${kind}`, {
    method: 'POST', body: JSON.stringify({joint_names, frame_rate_hz, leader: frames(positions),
                                          follower: frames(state.follower)}),
  });
  if (!response.ok) {
    tell(await response.text(), true);
    return;
  }
  const name = /filename="([^"]+)"/.exec(response.headers.get('Content-Disposition'))[1];
  const link = Object.assign(document.createElement('a'),
                             {href: URL.createObjectURL(await response.blob()), download: name});
  link.click();
  URL.revokeObjectURL(link.href);
  root.dataset.downloaded = name;
}

function connectFiles() {
  const take = async (file) => {
    if (file) await readLeader(file.name, file);
  };
  element('file').addEventListener('change', () => take(element('file').files[0]));
  window.addEventListener('dragover', (event) => {
    event.preventDefault();
    document.body.classList.add('dragging');
  });
  window.addEventListener('dragleave', () => document.body.classList.remove('dragging'));
  window.addEventListener('drop', (event) => {
    event.preventDefault();
    document.body.classList.remove('dragging');
    take(event.dataTransfer.files[0]);
  });
}

function connectControls() {
  let settling = 0;
  document.querySelector('aside').addEventListener('input', (event) => {
    const output = event.target.parentElement.querySelector('output');
    if (!output) return;
    output.value = event.target.value;
    clearTimeout(settling);
    settling = setTimeout(react, SETTLE_MILLISECONDS);
  });
  element('another').addEventListener('click', () => {
    state.seed += 1;
    react();
  });
  element('play').addEventListener('click', () => {
    theatre.toggle();
  });
  element('scrub').addEventListener('input', () => {
    theatre.player.playing = false;
    theatre.seek(Number(element('scrub').value));
  });
}

async function start() {
  const about = await (await fetch('/about.json')).json();
  for await (const answer of callServer('GetModel', 'GetModelRequest', {}, 'GetModelResponse')) {
    state.model = answer.model;
  }
  for (const name of state.model.interaction_classes) addSlider(name, 0);
  element('sampling').hidden = !state.model.samples;
  for (const name of about.samples) {
    addButton(element('samples'), name.replaceAll('_', ' '), async () => {
      const response = await fetch(`/samples/${name}.bvh`);
      suggest(name);
      await readLeader(`${name}.bvh`, await response.arrayBuffer());
    });
  }
  for (const kind of about.formats) {
    addButton(element('downloads'), kind.toUpperCase(), () => download(kind)).disabled = true;
  }
  connectFiles();
  connectControls();
  root.dataset.state = 'ready';
}

start().catch((error) => {
  tell(`The server does not answer: ${error.message}`, true);
  root.dataset.state = 'failed';
});

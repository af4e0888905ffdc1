'use strict';
// Connects the page's parts: leader, settings, answers, downloads.
const root = document.documentElement;
const element = (id) => document.getElementById(id);
const SIDE_BY_SIDE = 4;
const UNFAMILIAR = 1.5;  // SynthesisSummary.unfamiliarity above this gets a warning

const state = {
  models: [],      // as ListModels describes them
  model: null,     // the model of the settings
  samples: [],
  leader: null,    // the result of readLeader
  awaited: '',     // the name of the file that a link refers to
  takes: [],       // answers: {seed, positions, model, version, samples, unfamiliarity, grade, ...}
  chosen: 0,       // the take that is downloaded
  asked: '',       // askedFor() of the takes
  call: null,      // the AbortController of the running calls
  answers: 0,
};

function tell(text, failed = false, problems = []) {
  element('status').textContent = text;
  element('status').classList.toggle('failed', failed);
  element('problems').replaceChildren(...problems.map(
      (problem) => Object.assign(document.createElement('li'), {textContent: problem})));
  root.dataset.failed = failed;
}

// Shows an error; if the server names invalid fields, one line for each.
function tellError(error) {
  const problems = error.problems ?? [];
  tell(problems.length ? 'The server rejected the request:' : error.message, true, problems);
}

function addButton(parent, text, act) {
  const button = Object.assign(document.createElement('button'),
                               {type: 'button', textContent: text});
  button.addEventListener('click', () => act(button));
  parent.append(button);
  return button;
}

// Wraps an action of the visitor; shows its error.
const attempt = (act) => async (...all) => {
  try {
    await act(...all);
  } catch (error) {
    tellError(error);
  }
};

const nameOf = (model) => `${model.name}@${model.version}`;
const modelNamed = (name) => state.models.find((model) => nameOf(model) === name);

const seedsOf = (takes) => takes.map((take) => take.seed);

// Updates address and buttons after a change of the settings.
function changed() {
  history.replaceState(null, '', addressOf(settings));
  const ready = Boolean(state.leader) && isAnyWeight();
  for (const id of ['react', 'try-four', 'another']) element(id).disabled = !ready;
  element('add-key').disabled = element('reread').disabled = !state.leader;
  const answered = state.takes.length > 0;
  const isOther = state.model.samples && !seedsOf(state.takes).includes(settings.seed);
  const stale = answered && (state.asked !== askedFor() || isOther);
  for (const button of element('downloads').children) button.disabled = !answered;
  const rigName = element('rig-choice').value === 'file' ? element('rig-file').files[0]?.name
                                                         : state.leader?.name;
  const isRig = /\.(bvh|glb|gltf)$/i.test(rigName ?? '');
  element('rig-download').disabled = !answered || stale || !isRig;
  element('react').classList.toggle('primary', !answered || stale);
  element('back-to-four').hidden = state.takes.length < 2 || !element('four').hidden;
  element('grade').textContent =
      element('four').hidden ? describeGrade(state.takes[state.chosen]?.grade) : '';
  root.dataset.stale = stale;
  if (state.call) return;
  if (state.leader && !isAnyWeight()) tell('Set at least one reaction, then press React.');
  else if (state.leader && !answered) tell('Press React.');
  else if (stale) tell('The settings have changed: press React.');
}

function showFields() {
  for (const field of document.querySelectorAll('aside [name]')) {
    if (field.closest('#labels')) continue;
    if (field.name in settings && field.type !== 'file') field.value = settings[field.name];
  }
  setSlider(document.querySelector('[name=variety]').parentElement, settings.variety);
}

function showModel() {
  state.model = modelNamed(settings.model);
  showSliders(state.model.interaction_classes, changed);
  for (const part of document.querySelectorAll('.sampling')) part.hidden = !state.model.samples;
  element('start-field').hidden = !state.model.accepts_follower_start;
}

function showLeader() {
  const {name, notes, motion} = state.leader;
  showOne(state.leader, state.takes[state.chosen]?.positions);
  element('scrub').max = motion.frames - 1;
  element('empty').hidden = true;
  element('transport').hidden = false;
  element('leader-name').textContent = `${name}: ${motion.frames} frames at ` +
                                       `${Math.round(motion.frame_rate_hz * 100) / 100} Hz`;
  element('notes').replaceChildren(...notes.map(
      (note) => Object.assign(document.createElement('li'), {textContent: note})));
  root.dataset.frames = motion.frames;
}

// Loads a leader. It makes no call to the server; React does.
async function takeLeader(name, bytes) {
  tell(`Reading ${name} …`);
  stopCalls();
  const {leader: last} = state;
  if (last && (last.name !== name || last.file !== fingerprint(bytes))) {
    // The settings for reading the previous file do not apply to this one.
    for (const setting of READING) settings[setting] = DEFAULTS[setting];
    settings.keyframes = [];
    showFields();
    showKeyframes(changed);
  }
  const leader = await readLeader(name, bytes);
  Object.assign(state, {leader, takes: [], chosen: 0, asked: '', awaited: ''});
  Object.assign(settings, {leader: name, file: leader.file});
  showLeader();
  changed();
  await keepWork();
}

function stopCalls() {
  state.call?.abort();
  state.call = null;
}

// Requests one answer. Calls `show` with each chunk.
async function ask(leader, seed, signal, show) {
  const {motion} = leader;
  const positions = new Float32Array(motion.positions.length);
  const take = {
    seed, positions, leader: leader.name, settings: JSON.stringify(settings),
    model: state.model.name, version: state.model.version, samples: Boolean(state.model.samples),
  };
  let summary = null;
  for await (const answer of callServer('Synthesize', 'SynthesizeRequest', requestOf(motion, seed),
                                        'SynthesizeResponse', signal)) {
    if (answer.chunk) {
      const first = answer.chunk.first_frame ?? 0;
      positions.set(answer.chunk.positions, first * motion.joint_names.length * 3);
      show?.(first, answer.chunk.positions);
    }
    summary = summary || answer.summary;
  }
  if (!summary) throw new CallError('The reply is incomplete. Press React again.');
  return {...take, unfamiliarity: summary.unfamiliarity ?? 0, grade: summary.grade ?? null};
}

// Requests `count` answers with the current settings and consecutive seeds. Cancels running calls.
async function react(count) {
  stopCalls();
  const call = state.call = new AbortController();
  const {leader} = state;
  const asked = askedFor();
  const begun = performance.now();
  const seeds = Array.from({length: count}, (_, index) => settings.seed + index);
  tell(count === 1 ? 'Waiting for the server …'
                   : `Waiting for seeds ${seeds[0]} to ${seeds[count - 1]} …`);
  try {
    const show = count === 1 ? (first, positions) => theatre.takeFrames(first, positions) : null;
    const takes = await Promise.all(seeds.map((seed) => ask(leader, seed, call.signal, show)));
    if (call.signal.aborted) return;
    state.call = null;
    Object.assign(state, {takes, chosen: 0, asked});
    await finish((performance.now() - begun) / 1000);
  } catch (error) {
    if (call.signal.aborted) return;
    call.abort();
    state.call = null;
    tellError(error);
  }
}

async function finish(seconds) {
  const {takes, leader} = state;
  if (takes.length === 1) showOne(leader, takes[0].positions);
  else showFour(leader, takes, keep);
  changed();
  const far = takes.some((take) => take.unfamiliarity > UNFAMILIAR)
      ? ' This leader is unlike the training data. Check the answer before you use it.' : '';
  const seeds = seedsOf(takes);
  const what = !takes[0].samples ? 'one answer' : takes.length === 1 ? `seed ${seeds[0]}`
      : `seeds ${seeds[0]} to ${seeds[seeds.length - 1]}: keep one`;
  tell(`Answered in ${seconds.toFixed(2)} s, ${what}.${far}`);
  state.answers += 1;
  root.dataset.answers = state.answers;
  await keepWork();
}

// Keeps one of several answers.
async function keep(index) {
  state.chosen = index;
  settings.seed = state.takes[index].seed;
  showOne(state.leader, state.takes[index].positions);
  showFields();
  changed();
  tell(`Kept seed ${settings.seed}.`);
  element('back-to-four').focus();
  await keepWork();
}

function connectFiles() {
  const take = attempt(async (file) => {
    if (file) await takeLeader(file.name, await file.arrayBuffer());
  });
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
  element('reread').addEventListener('click', attempt(
      () => takeLeader(state.leader.name, state.leader.bytes)));
  element('rig-choice').addEventListener('change', () => {
    element('rig-other').hidden = element('rig-choice').value !== 'file';
    changed();
  });
  element('rig-file').addEventListener('change', () => {
    element('rig-name').textContent = element('rig-file').files[0]?.name ?? '';
    changed();
  });
  element('rig-download').addEventListener('click', attempt(downloadOnRig));
}

function connectSettings() {
  document.querySelector('aside').addEventListener('input', ({target}) => {
    if (!(target.name in settings)) return;
    if (target.type === 'number' && !target.checkValidity()) return;
    settings[target.name] = typeof DEFAULTS[target.name] === 'number' ? Number(target.value)
                                                                      : target.value;
    if (target.name === 'model') showModel();
    changed();
  });
  joinSlider(document.querySelector('[name=variety]').parentElement, (variety) => {
    settings.variety = variety;
    changed();
  });
  element('react').addEventListener('click', () => react(1));
  element('try-four').addEventListener('click', () => react(SIDE_BY_SIDE));
  element('another').addEventListener('click', () => {
    settings.seed += Math.max(1, element('four').hidden ? 1 : state.takes.length);
    showFields();
    react(element('four').hidden ? 1 : SIDE_BY_SIDE);
  });
  element('back-to-four').addEventListener('click', () => {
    showFour(state.leader, state.takes, keep);
    changed();
    tell('Keep one of the four.');
    element('four').querySelectorAll('figcaption button')[state.chosen].focus();
  });
  element('share').addEventListener('click', attempt(async () => {
    changed();
    if (!navigator.clipboard) {
      throw new Error('The browser does not allow copying. Copy the address of this page.');
    }
    await navigator.clipboard.writeText(location.href);
    tell('The link is copied. It contains the settings and the file\'s name, but not the file.');
  }));
  connectKeyframes(changed);
}

async function takeSample(name) {
  const response = await fetch(`/samples/${name}.bvh`);
  if (!response.ok) throw new CallError(await messageIn(response));
  // The sample's own class is a useful first setting.
  if (!isAnyWeight() && state.model.interaction_classes.includes(name)) setLabels({[name]: 1});
  await takeLeader(`${name}.bvh`, await response.arrayBuffer());
}

// Restores the leader and the answers of the address, from the browser or from the samples.
async function restore() {
  const {leader: name, file} = settings;
  if (!name) return;
  const kept = await keptWork();
  if (kept?.leader && kept.leader.name === name && kept.leader.file === file) {
    if (kept.leader.reading !== readingOf(settings)) {
      await takeLeader(name, kept.leader.bytes);
      return;
    }
    Object.assign(state, kept.asked === askedFor() ? kept : {leader: kept.leader});
    showLeader();
    return;
  }
  if (state.samples.includes(stemOf(name))) {
    await takeSample(stemOf(name));
    return;
  }
  state.awaited = name;
  element('empty').textContent = `This link needs the file ${name}. Drop it here.`;
}

async function takeLink() {
  takeAddress(location.hash);
  const standard = state.models.find((model) => model.is_default) ?? state.models[0];
  const wanted = settings.model;
  if (!modelNamed(wanted)) settings.model = nameOf(standard);
  showFields();
  showModel();
  showKeyframes(changed);
  await restore();
  changed();
  if (wanted && wanted !== settings.model) {
    tell(`The server has no model ${wanted}; using ${settings.model} instead.`, true);
  }
}

async function start() {
  const response = await fetch('/about.json');
  if (!response.ok) throw new CallError(await messageIn(response));
  const about = await response.json();
  const answers = callServer('ListModels', 'ListModelsRequest', {}, 'ListModelsResponse');
  for await (const answer of answers) state.models = answer.models;
  state.samples = about.samples;
  const optionOf = (model) => new Option(nameOf(model) + (model.is_default ? ' (default)' : ''),
                                         nameOf(model));
  document.querySelector('[name=model]').replaceChildren(...state.models.map(optionOf));
  for (const name of about.samples) {
    addButton(element('samples'), name.replaceAll('_', ' '), attempt(() => takeSample(name)));
  }
  for (const kind of about.formats) {
    addButton(element('downloads'), kind.toUpperCase(), attempt(() => download(kind)));
  }
  connectStages();
  connectFiles();
  connectSettings();
  await takeLink();
  window.addEventListener('hashchange', attempt(async () => {
    stopCalls();
    Object.assign(state, {takes: [], chosen: 0, asked: ''});
    await takeLink();
  }));
  root.dataset.state = 'ready';
}

start().catch((error) => {
  tell(`The server does not respond: ${error.message}`, true);
  root.dataset.state = 'failed';
});

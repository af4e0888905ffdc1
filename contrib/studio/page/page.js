'use strict';
// Connects the page's parts: leader, settings, answers, timeline, downloads.
const root = document.documentElement;
const element = (id) => document.getElementById(id);

const state = {
  models: [],      // as ListModels describes them
  model: null,     // the model of the settings
  samples: [],
  leader: null,    // the result of readLeader
  takes: [],       // answers: {seed, positions, model, version, samples, unfamiliarity, grade, ...}
  chosen: 0,       // the take that is shown and downloaded
  asked: '',       // askedFor() of the takes
  rig: null,       // {name, bytes} of the rig's file; null: the leader's own
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

const modelNamed = (name) => state.models.find((model) => nameOf(model) === name);
const seedsOf = (takes) => takes.map((take) => take.seed);

const undoHistory = new UndoHistory(() => showWork(), () => showUndo(undoHistory));
const timeline = new Timeline((what) => changed(what), () => undoHistory.endGesture());
const marker = new StartMarker(element('start-marker'), () => {
  showFields();
  changed('follower\'s start');
}, () => undoHistory.endGesture());

const pinHandles = new PinHandles(element('pin-handles'), element('pin-list'), (what) => changed(what),
                                  () => undoHistory.endGesture());

// Records a change of the work, which `what` describes, and updates everything that shows it.
function changed(what) {
  undoHistory.record(what);
  history.replaceState(null, '', addressOf(settings));
  showButtons();
  timeline.draw();
  followFrame();
  marker.draw();
  pinHandles.draw();
}

function isStale() {
  const take = state.takes[state.chosen];
  if (!take) return false;
  const isOther = settings.seed === '' ? settingsAt(take.settings).seed !== ''
                                       : !seedsOf(state.takes).includes(settings.seed);
  return state.asked !== askedFor() || (state.model.samples && isOther);
}

function showButtons() {
  const ready = Boolean(state.leader) && isAnyWeight();
  for (const id of ['react', 'show-eight', 'another']) element(id).disabled = !ready;
  for (const id of ['add-key', 'reread', 'place']) element(id).disabled = !state.leader;
  element('place').hidden = !state.leader || !state.model.accepts_follower_start;
  const answered = state.takes.length > 0;
  const stale = isStale();
  element('pin').hidden = element('pins').hidden = !state.leader;
  element('pin').disabled = element('pin-add').disabled = !answered;
  if (!answered && pinHandles.isShown) showPins(false);
  element('pins-hint').textContent = answered
      ? 'Drag a joint of the follower in the scene: it must be there in this frame.'
      : 'Press React first, then drag a joint of the follower in the scene.';
  for (const button of element('downloads').children) button.disabled = !answered;
  const rigName = (state.rig ?? state.leader)?.name ?? '';
  element('rig-download').disabled = !answered || !/\.(bvh|glb|gltf)$/i.test(rigName);
  element('rig-choice').value = state.rig ? 'file' : element('rig-choice').value;
  element('rig-name').textContent = state.rig?.name ?? '';
  element('react').classList.toggle('primary', !answered || stale);
  element('grade').textContent = describeGrade(state.takes[state.chosen]?.grade);
  showSeed();
  root.dataset.stale = stale;
  tellNext(answered, stale);
}

// Shows the seed that the server chose in the field that is left to it.
function showSeed() {
  const {seed} = isStale() ? {} : state.takes[state.chosen] ?? {};
  document.querySelector('[name=seed]').placeholder = seed === undefined ? 'automatic' : `${seed} (automatic)`;
}

// Says what to do next.
function tellNext(answered, stale) {
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
  element('turn').value = settings.turn;
}

function showModel() {
  state.model = modelNamed(settings.model);
  showSliders(state.model.interaction_classes, changed);
  timeline.build(state.model.interaction_classes);
  element('pin-joint').replaceChildren(...state.model.joint_names.map(
      (joint) => new Option(jointText(joint), joint)));
  for (const part of document.querySelectorAll('.sampling')) part.hidden = !state.model.samples;
  for (const part of document.querySelectorAll('.starting')) {
    part.hidden = !state.model.accepts_follower_start;
  }
  if (!state.model.accepts_follower_start) placeStart(false);
}

function showAnswer() {
  showMotion(state.leader, state.takes[state.chosen]?.positions);
  showGallery(choose);
}

function showLeader() {
  const {leader} = state;
  element('empty').hidden = Boolean(leader);
  element('timeline').hidden = element('curves').hidden = !leader;
  element('leader-name').textContent = '';
  element('notes').replaceChildren();
  if (!leader) {
    showNothing();
    showGallery(choose);
    placeStart(false);
    return;
  }
  const {name, notes, motion} = leader;
  element('scrub').max = motion.frames - 1;
  showAnswer();
  element('leader-name').textContent = `${name}: ${motion.frames} frames at ` +
                                       `${Math.round(motion.frame_rate_hz * 100) / 100} Hz`;
  element('notes').replaceChildren(...notes.map(
      (note) => Object.assign(document.createElement('li'), {textContent: note})));
  if (isCurved(settings)) element('curves').open = true;
  root.dataset.frames = motion.frames;
}

// Shows everything anew, after undo.
function showWork() {
  stopCalls();
  showFields();
  showModel();
  showLeader();
  showRig();
  changed('');
  tellShown();
}

function tellShown() {
  if (state.takes.length > 0 && root.dataset.stale === 'false') {
    tell(state.model.samples ? `Seed ${state.takes[state.chosen].seed}.` : 'One answer.');
  }
}

// Shows or hides the marker of the follower's start.
function placeStart(shown) {
  element('start-marker').toggleAttribute('hidden', !shown);
  element('place').setAttribute('aria-pressed', shown);
  if (!shown) return;
  showPins(false);
  seekAll(0);
  marker.draw();
}

function connectStart() {
  const isShown = () => !element('start-marker').hasAttribute('hidden');
  element('place').addEventListener('click', () => placeStart(!isShown()));
  element('turn').addEventListener('change', () => {
    const {value} = element('turn');
    if (!state.leader || !element('turn').checkValidity()) return;
    if (value === '') Object.assign(settings, {turn: '', pose: []});
    else turnStart(Number(value));
    showFields();
    changed('follower\'s start');
  });
  element('free-start').addEventListener('click', () => {
    freeStart();
    showFields();
    changed('follower\'s start');
  });
}

function connectTimeline() {
  element('add-key').addEventListener('click', () => {
    keyAll(state.model.interaction_classes);
    element('curves').open = true;
    changed('key all classes');
  });
  element('clear-curves').addEventListener('click', () => {
    settings.curves = {};
    changed('clear the curves');
  });
}

function connectSettings() {
  document.querySelector('aside').addEventListener('input', ({target}) => {
    if (!(target.name in settings)) return;
    if (target.type === 'number' && !target.checkValidity()) return;
    const isNumber = typeof DEFAULTS[target.name] === 'number' || (target.name === 'seed' && target.value !== '');
    settings[target.name] = isNumber ? Number(target.value) : target.value;
    if (target.name === 'model') attempt(chooseModel)();
    else changed(target.name.replaceAll('_', ' '));
  });
  joinSlider(document.querySelector('[name=variety]').parentElement, (variety) => {
    settings.variety = variety;
    changed('variety');
  });
}

// Shows the chosen model. A leader is read again if the model has other joints.
async function chooseModel() {
  showModel();
  const {leader} = state;
  if (!leader || String(leader.motion.joint_names) === String(state.model.joint_names)) {
    changed('model');
    return;
  }
  try {
    await takeLeader(leader.name, leader.bytes);
  } catch (error) {
    Object.assign(state, {leader: null, takes: [], chosen: 0, asked: ''});
    settings.leader = '';
    showLeader();
    changed('model');
    throw error;
  }
}

// The model that a sample suits: the chosen one if it has the sample's class or name.
function modelOfSample(name) {
  const suits = (model) => model.name === name || model.interaction_classes.includes(name);
  if (suits(state.model)) return state.model;
  const standard = state.models.filter((model) => model.is_default);
  return [...standard, ...state.models].find(suits) ?? state.model;
}

// The class that a sample of this name sets: its own, or the first one of its model.
function classOfSample(name, model) {
  const classes = model.interaction_classes;
  return classes.includes(name) ? name : model.name === name ? classes[0] : null;
}

async function takeSample(name) {
  const bytes = await fetchSample(name);
  const model = modelOfSample(name);
  const own = classOfSample(name, model);
  if (model !== state.model) {
    settings.model = nameOf(model);
    showFields();
    showModel();
  }
  if (own) settings.labels = {[own]: 1};
  await takeLeader(`${name}.bvh`, bytes);
}

// Opens the leader of the address: a sample, or a file that the visitor has.
async function openLinked() {
  const {leader: name} = settings;
  if (!name) return;
  if (state.samples.includes(stemOf(name))) await takeLeader(name, await fetchSample(stemOf(name)));
  else element('empty').textContent = `This link needs the file ${name}. Drop it here.`;
}

async function takeLink() {
  takeAddress(location.hash);
  const standard = state.models.find((model) => model.is_default) ?? state.models[0];
  const wanted = settings.model;
  if (!modelNamed(wanted)) settings.model = nameOf(standard);
  showFields();
  showModel();
  await openLinked();
  undoHistory.endGesture();
  changed('open link');
  if (wanted && wanted !== settings.model) {
    tell(`The server has no model ${wanted}; using ${settings.model} instead.`, true);
  }
}

// What moves with the frame on display.
function followStage() {
  const frame = frameNow();
  timeline.showFrame(frame);
  if (isCurved(settings)) followFrame();
  marker.draw();
  pinHandles.draw();
}

async function start() {
  // A file that is dropped too early must not replace the page.
  for (const kind of ['dragover', 'drop']) {
    window.addEventListener(kind, (event) => event.preventDefault());
  }
  const {about, models} = await awaitServer((error) => {
    tell(`${error.message} This page goes on by itself then.`, true);
    root.dataset.state = 'failed';
  });
  tell('');
  state.models = models;
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
  connectStage(followStage);
  connectFiles();
  connectSettings();
  connectAsking();
  connectTimeline();
  connectStart();
  connectPins();
  connectUndo(undoHistory);
  connectKeys();
  await takeLink();
  window.addEventListener('hashchange', attempt(async () => {
    stopCalls();
    Object.assign(state, {takes: [], chosen: 0, asked: ''});
    await takeLink();
  }));
  root.dataset.state = 'ready';
}

start().catch((error) => {
  tellError(error);
  root.dataset.state = 'failed';
});

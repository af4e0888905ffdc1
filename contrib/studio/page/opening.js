'use strict';
// Opens files: leaders, sessions and rigs, chosen or dropped.

// Loads a leader. It makes no call to the server; React does.
async function takeLeader(name, bytes) {
  tell(`Reading ${name} …`);
  stopCalls();
  const {leader: last} = state;
  if (last && (last.name !== name || last.file !== fingerprint(bytes))) {
    // What describes the previous file does not apply to this one.
    for (const setting of [...READING, 'curves', 'start', 'turn', 'pose', 'keep', 'pins']) {
      settings[setting] = structuredClone(DEFAULTS[setting]);
    }
    showFields();
  }
  const leader = await readLeader(name, bytes);
  Object.assign(state, {leader, takes: [], chosen: 0, asked: '', awaited: ''});
  Object.assign(settings, {leader: name, file: leader.file, keep: 0});
  showLeader();
  changed(`open ${name}`);
  await keepNow();
}

// Opens the text of a session file, as one step that can be undone.
async function openSession(text) {
  const session = readSession(text);
  const before = UndoHistory.take('');
  try {
    Object.assign(settings, session.settings,
                  {leader: session.leader.name, file: fingerprint(session.leader.bytes)});
    const known = modelNamed(settings.model);
    if (!known) settings.model = nameOf(state.models.find((model) => model.is_default));
    const leader = await readLeader(session.leader.name, session.leader.bytes.buffer);
    if (session.answer) checkAnswer(session.answer, leader.motion);
    stopCalls();
    Object.assign(state, {leader, takes: session.answer ? [session.answer] : [], chosen: 0,
                          asked: session.answer ? askedForIn(session.answer) : '', rig: null});
    if (session.rig) state.rig = {name: session.rig.name, bytes: session.rig.bytes.buffer};
    undoHistory.endGesture();
    undoHistory.record('open session');
    showWork();
    if (!known) {
      tell(`The server has no model ${session.settings.model}; using ${settings.model} instead.`, true);
    }
  } catch (error) {
    Object.assign(settings, before.settings);
    throw error;
  }
}

// askedFor() of the settings with which an answer was requested.
function askedForIn(answer) {
  const now = structuredClone(settings);
  takeAddress(answer.settings);
  const asked = askedFor();
  Object.assign(settings, now);
  return asked;
}

// Opens a file: a session, or a leader.
async function takeFile(file) {
  if (!file) return;
  if (/\.json$/i.test(file.name)) {
    if (file.size > MAX_SESSION_BYTES) {
      throw new Error(`${file.name}: expected at most ${MAX_SESSION_BYTES >> 20} MiB, got ${
          Math.ceil(file.size / 2 ** 20)} MiB`);
    }
    const text = await file.text();
    if (isSession(text)) {
      await openSession(text);
      return;
    }
  }
  await takeLeader(file.name, await file.arrayBuffer());
}

async function takeRig(file) {
  if (!file) return;
  state.rig = {name: file.name, bytes: await file.arrayBuffer()};
  showRig();
  changed('rig');
  await keepNow();
}

function showRig() {
  element('rig-choice').value = state.rig ? 'file' : 'leader';
  element('rig-other').hidden = !state.rig;
}

function connectFiles() {
  const take = attempt(takeFile);
  const taken = (input, act) => input.addEventListener('change', async () => {
    const [file] = input.files;
    await act(file);
    input.value = '';  // so that the same file can be chosen again
  });
  taken(element('file'), take);
  taken(element('open-file'), take);
  taken(element('rig-file'), attempt(takeRig));
  element('open').addEventListener('click', () => element('open-file').click());
  element('save').addEventListener('click', attempt(async () => {
    saveBlob(new Blob([writeSession()], {type: 'application/json'}), sessionName());
  }));
  window.addEventListener('dragover', (event) => {
    event.preventDefault();
    document.body.classList.add('dragging');
  });
  window.addEventListener('dragleave', () => document.body.classList.remove('dragging'));
  window.addEventListener('drop', (event) => {
    event.preventDefault();
    document.body.classList.remove('dragging');
    const isRig = event.target.closest?.('#rig');
    (isRig ? attempt(takeRig) : take)(event.dataTransfer.files[0]);
  });
  element('reread').addEventListener('click', attempt(
      () => takeLeader(state.leader.name, state.leader.bytes)));
  element('rig-choice').addEventListener('change', () => {
    const isOther = element('rig-choice').value === 'file';
    if (!isOther) state.rig = null;
    element('rig-other').hidden = !isOther;
    changed('rig');
  });
  element('rig-download').addEventListener('click', attempt(downloadOnRig));
}

'use strict';
// Opens files: leaders and rigs, chosen or dropped.

// Loads a leader. It makes no call to the server; React does.
async function takeLeader(name, bytes) {
  tell(`Reading ${name} …`);
  stopCalls();
  const {leader: last} = state;
  if (last && last.name !== name) {
    // What describes the previous file does not apply to this one.
    for (const setting of [...READING, 'curves', 'start', 'turn', 'pose', 'pins']) {
      settings[setting] = structuredClone(DEFAULTS[setting]);
    }
    showFields();
  }
  const leader = await readLeader(name, bytes);
  Object.assign(state, {leader, takes: [], chosen: 0, asked: ''});
  settings.leader = name;
  showLeader();
  changed(`open ${name}`);
}

async function takeFile(file) {
  if (file) await takeLeader(file.name, await file.arrayBuffer());
}

async function takeRig(file) {
  if (!file) return;
  state.rig = {name: file.name, bytes: await file.arrayBuffer()};
  showRig();
  changed('rig');
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
  taken(element('rig-file'), attempt(takeRig));
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

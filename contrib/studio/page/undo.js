'use strict';
// Undo and redo of everything: each state of the work is a snapshot. Snapshots share the leader and
// the answers, which never change.
const MAX_UNDO = 300;
const WORK = ['leader', 'takes', 'chosen', 'asked', 'rig'];

class UndoHistory {
  // `restore(work)` shows a state of the work; `onChange()` is called when the history has changed.
  constructor(restore, onChange) {
    Object.assign(this, {restore, onChange, past: [], future: [], now: null, gesture: ''});
  }

  static take(what) {
    const work = {settings: structuredClone(settings), what};
    for (const name of WORK) work[name] = state[name];
    return work;
  }

  static isSame(a, b) {
    return WORK.every((name) => a[name] === b[name]) &&
        JSON.stringify(a.settings) === JSON.stringify(b.settings);
  }

  // Records the work after a change, which `what` describes. Changes of the same thing in one
  // gesture are one step.
  record(what) {
    const work = UndoHistory.take(what);
    if (this.now && UndoHistory.isSame(this.now, work)) return;
    const continues = what === this.gesture && this.past.length > 0;
    if (this.now && !continues) this.past.push(this.now);
    if (this.past.length > MAX_UNDO) this.past.shift();
    this.future = [];
    this.now = work;
    this.gesture = what;
    this.onChange();
  }

  // The next change is a new step.
  endGesture() { this.gesture = ''; }

  get undoes() { return this.past.length ? this.now.what : ''; }
  get redoes() { return this.future.length ? this.future[this.future.length - 1].what : ''; }

  undo() { this.step(this.past, this.future); }
  redo() { this.step(this.future, this.past); }

  step(from, to) {
    if (from.length === 0) return;
    to.push(this.now);
    this.now = from.pop();
    this.gesture = '';
    const {settings: all, ...work} = this.now;
    delete work.what;
    Object.assign(settings, structuredClone(all));
    Object.assign(state, work);
    this.restore();
    this.onChange();
  }
}

// The buttons, and the keys everywhere, also in fields.
function connectUndo(history) {
  element('undo').addEventListener('click', () => history.undo());
  element('redo').addEventListener('click', () => history.redo());
  window.addEventListener('keydown', (event) => {
    if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
    const key = event.key.toLowerCase();
    if (key === 'z' && !event.shiftKey) history.undo();
    else if (key === 'y' || (key === 'z' && event.shiftKey)) history.redo();
    else return;
    event.preventDefault();
  });
  for (const kind of ['change', 'pointerdown']) {
    window.addEventListener(kind, () => history.endGesture(), true);
  }
}

function showUndo(history) {
  for (const [id, verb, what] of [['undo', 'Undo', history.undoes], ['redo', 'Redo', history.redoes]]) {
    element(id).disabled = !what;
    element(id).title = what ? `${verb}: ${what}` : `Nothing to ${verb.toLowerCase()}`;
    element(id).setAttribute('aria-label', element(id).title);
  }
}

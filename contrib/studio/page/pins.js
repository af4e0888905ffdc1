'use strict';
// Pins: places where joints of the follower must be in a frame of the leader, as
// {joint, frame, position, softness}. The functions take the settings, of which they read or change
// `pins`.
const MAX_PINS = 64;  // the server's limit for one request
const PIN_METRES = 1000;  // largest coordinate in links

const pinAt = (all, joint, frame) =>
    all.pins.find((pin) => pin.joint === joint && pin.frame === frame);

// Adds a pin, or moves the one of the same joint and frame.
function setPin(all, joint, frame, position) {
  const place = position.map((value) => rounded(value));
  if (pinAt(all, joint, frame)) {
    all.pins = all.pins.map((pin) => (pin.joint === joint && pin.frame === frame
        ? {...pin, position: place} : pin));
  } else if (all.pins.length < MAX_PINS) {
    all.pins = [...all.pins, {joint, frame, position: place, softness: 0}];
  }
}

function removePin(all, joint, frame) {
  all.pins = all.pins.filter((pin) => pin.joint !== joint || pin.frame !== frame);
}

function soften(all, index, softness) {
  all.pins = all.pins.map((pin, i) => (i === index ? {...pin, softness} : pin));
}

// right_hand@40=0.2,1.3,0.5,0.25, a joint, a frame, a place and a softness.
const writePin = ({joint, frame, position, softness}) =>
    `${joint}@${frame}=${[...position, ...(softness ? [softness] : [])].join(',')}`;

// Reads a pin of a link; ignores an invalid one.
function readPin(all, text) {
  const [, joint, frame, rest] = /^([\w.-]+)@(\d{1,7})=([-\d.,e]+)$/.exec(text) ?? [];
  const values = (rest ?? '').split(',').map(Number);
  const [x, y, z, softness = 0] = values;
  const isRight = joint && (values.length === 3 || values.length === 4) &&
      [x, y, z].every((value) => Math.abs(value) <= PIN_METRES) && softness >= 0 && softness <= 1;
  if (!isRight) return;
  setPin(all, joint, Number(frame), [x, y, z]);
  const index = all.pins.findIndex((pin) => pin.joint === joint && pin.frame === Number(frame));
  if (index >= 0) soften(all, index, softness);
}

// The pins that a request contains: those of joints that the model has.
const sentPins = (all, joints) => all.pins.filter((pin) => joints.includes(pin.joint));

const constraintsOf = (pins) => pins.map(({joint, frame, position: [x, y, z], softness}) => ({
  joint_name: joint, frame, position: {x, y, z}, softness}));

// What remains of a pin in an answer; '' if it does not have the pin.
function describePin(take, {joint, frame, position}) {
  const met = take?.pins?.find((pin) => pin.joint === joint && pin.frame === frame &&
                                        String(pin.position) === String(position));
  if (!met) return '';
  return met.metres < 0.01 ? 'reached' : `${Math.round(100 * met.metres)} cm away`;
}

// Handles of the follower's joints over the scene, and the list of pins. Dragging a joint pins it in
// the frame on display.
const HANDLE_PIXELS = 7;

const jointText = (joint) => joint.replaceAll('_', ' ');

class PinHandles {
  // `onChange(what)` is called after each change, `onEnd()` after each drag.
  constructor(svg, list, onChange, onEnd) {
    Object.assign(this, {svg, list, onChange, onEnd, handles: new Map(), rows: []});
  }

  get isShown() { return !this.svg.hasAttribute('hidden'); }
  get take() { return state.takes[state.chosen]; }

  // Where the follower's joint is in a frame, or null without an answer.
  placeOf(joint, frame) {
    const {motion} = state.leader ?? {};
    const index = motion?.joint_names.indexOf(joint) ?? -1;
    if (!this.take || index < 0 || frame >= motion.frames) return null;
    return jointAt(this.take.positions, frame * motion.joint_names.length + index);
  }

  // Where a handle is: at the pin, or at the joint.
  handlePlace(joint) {
    return pinAt(settings, joint, frameNow())?.position ?? this.placeOf(joint, frameNow());
  }

  // Pins a joint in the frame on display.
  pin(joint, position) {
    setPin(settings, joint, frameNow(), position);
    this.onChange(`pin of ${jointText(joint)}`);
  }

  remove(joint, frame) {
    removePin(settings, joint, frame);
    this.onChange(`remove pin of ${jointText(joint)}`);
    this.onEnd();
  }

  // ---- The handles.

  handleOf(joint) {
    let handle = this.handles.get(joint);
    if (handle) return handle;
    const group = svgItem('g', {});
    handle = {group, way: svgItem('line', {class: 'way'}),
              grip: svgItem('circle', {class: 'joint', r: HANDLE_PIXELS})};
    group.append(handle.way, handle.grip);
    this.svg.append(group);
    this.handles.set(joint, handle);
    handle.grip.dataset.joint = joint;
    this.connect(handle.grip, joint);
    return handle;
  }

  at(event, place) {
    const box = this.svg.getBoundingClientRect();
    return theatre.pointAt(event.clientX - box.left, event.clientY - box.top, place);
  }

  connect(grip, joint) {
    let [place, off] = [null, null];
    connectDrag(grip, (event) => {
      place = this.handlePlace(joint);
      if (!place) return false;
      if (theatre.player.playing) theatre.pause();
      const at = this.at(event, place);
      off = place.map((value, i) => value - at[i]);
      return true;
    }, (event) => this.pin(joint, this.at(event, place).map((value, i) => value + off[i])), () => this.onEnd());
  }

  draw() {
    this.drawList();
    if (!this.isShown || !theatre.player) return;
    const frame = frameNow();
    for (const [joint, handle] of this.handles) {
      if (!this.placeOf(joint, frame)) handle.group.setAttribute('hidden', '');
    }
    if (!this.take) return;
    for (const joint of state.model.joint_names) {
      const place = this.placeOf(joint, frame);
      if (place) this.drawHandle(this.handleOf(joint), joint, frame, place);
    }
  }

  drawHandle(handle, joint, frame, place) {
    const pin = pinAt(settings, joint, frame);
    const [x, y, depth] = theatre.project(...(pin?.position ?? place));
    const [fromX, fromY] = theatre.project(...place);
    handle.group.toggleAttribute('hidden', depth > 1);
    handle.group.setAttribute('class', pin ? 'pinned' : '');
    handle.grip.setAttribute('cx', x);
    handle.grip.setAttribute('cy', y);
    for (const [name, value] of [['x1', fromX], ['y1', fromY], ['x2', x], ['y2', y]]) {
      handle.way.setAttribute(name, value);
    }
  }

  // ---- The list.

  addRow() {
    const row = document.createElement('li');
    const go = Object.assign(document.createElement('button'), {type: 'button', className: 'pin-name'});
    const label = Object.assign(document.createElement('label'), {textContent: 'softness '});
    const softness = Object.assign(document.createElement('input'), {type: 'number', min: 0, max: 1, step: 0.05});
    label.append(softness);
    const remains = document.createElement('output');
    const drop = Object.assign(document.createElement('button'), {type: 'button', textContent: 'Delete'});
    row.append(go, label, remains, drop);
    const index = this.rows.length;
    const pin = () => settings.pins[index];
    go.addEventListener('click', () => this.goTo(pin()));
    softness.addEventListener('change', () => {
      if (softness.value === '' || !softness.checkValidity()) return;
      soften(settings, index, Number(softness.value));
      this.onChange('softness of a pin');
    });
    drop.addEventListener('click', () => this.remove(pin().joint, pin().frame));
    this.rows.push({row, go, softness, remains});
    this.list.append(row);
  }

  goTo({frame}) {
    showPins(true);
    seekAll(frame);
  }

  drawList() {
    while (this.rows.length > settings.pins.length) this.rows.pop().row.remove();
    while (this.rows.length < settings.pins.length) this.addRow();
    settings.pins.forEach((pin, i) => {
      const {go, softness, remains} = this.rows[i];
      go.textContent = `${jointText(pin.joint)}, frame ${pin.frame}`;
      if (document.activeElement !== softness) softness.value = pin.softness;
      remains.value = describePin(this.take, pin);
    });
  }
}

// Shows or hides the handles.
function showPins(shown) {
  element('pin-handles').toggleAttribute('hidden', !shown);
  element('pin').setAttribute('aria-pressed', shown);
  if (!shown) return;
  placeStart(false);
  element('pins').open = true;
  if (theatre.player?.playing) theatre.pause();
  pinHandles.draw();
}

function connectPins() {
  element('pin').addEventListener('click', () => showPins(!pinHandles.isShown));
  element('pin-add').addEventListener('click', () => {
    const joint = element('pin-joint').value;
    const place = pinHandles.handlePlace(joint);
    if (!place) return;
    showPins(true);
    pinHandles.pin(joint, place);
    pinHandles.onEnd();
  });
  element('pins-clear').addEventListener('click', () => {
    settings.pins = [];
    changed('remove all pins');
  });
}

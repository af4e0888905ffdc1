'use strict';
// Pins: places where joints of the follower must be in a frame of the leader, as
// {joint, frame, position, softness}. The functions take the settings, of which they read or change
// `pins`.
const MAX_PINS = 64;  // the server's limit for one request
const PIN_METRES = 1000;  // largest coordinate in links and sessions

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

// Changes fields of the pin at an index. Returns false if its joint has a pin in the new frame.
function changePin(all, index, fields) {
  const changed = {...all.pins[index], ...fields};
  const same = pinAt(all, changed.joint, changed.frame);
  if (same && same !== all.pins[index]) return false;
  all.pins = all.pins.map((pin, i) => (i === index ? changed : pin));
  return true;
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
  if (index >= 0) changePin(all, index, {softness});
}

// The pins that a request for the frames from `first` on contains; `kept`: of frames that stay, pins
// do nothing. Pins of joints that the model lacks are left out.
const sentPins = (all, joints, kept) =>
    all.pins.filter((pin) => pin.frame >= kept && joints.includes(pin.joint));

const constraintsOf = (pins, first) => pins.map(({joint, frame, position: [x, y, z], softness}) => ({
  joint_name: joint, frame: frame - first, position: {x, y, z}, softness}));

// What remains of a pin in an answer; '' if it does not have the pin.
function describePin(take, {joint, frame, position}) {
  const met = take?.pins?.find((pin) => pin.joint === joint && pin.frame === frame &&
                                        String(pin.position) === String(position));
  if (!met) return '';
  return met.metres < 0.01 ? 'reached' : `${Math.round(100 * met.metres)} cm away`;
}

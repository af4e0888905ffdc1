'use strict';
// A session as a file: JSON with the leader's file, the settings as in the page's address, the chosen
// answer and the rig. A missing or malformed field is an error that names it; settings that are out of
// bounds are left out, as in a link.
const SESSION_FORMAT = 'duet-session';
const SESSION_VERSION = 2;
const MAX_SESSION_BYTES = 2 ** 27;  // the longest leader and its answer at 240 Hz need 80 MB

function toBase64(bytes) {
  let text = '';
  for (let i = 0; i < bytes.length; i += 0x8000) {
    text += String.fromCharCode(...bytes.subarray(i, i + 0x8000));
  }
  return btoa(text);
}

const fromBase64 = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));

const fileOf = ({name, bytes}) => ({name, bytes: toBase64(new Uint8Array(bytes))});

// Positions as base64 of little-endian float32.
function toFloats(positions) {
  const view = new DataView(new ArrayBuffer(4 * positions.length));
  positions.forEach((value, i) => view.setFloat32(4 * i, value, true));
  return toBase64(new Uint8Array(view.buffer));
}

function fromFloats(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  return Float32Array.from({length: bytes.length / 4}, (_, i) => view.getFloat32(4 * i, true));
}

// The work as the text of a session file.
function writeSession() {
  const {leader, takes, chosen, rig} = state;
  if (!leader) throw new Error('session: expected a leader, got none; choose a motion file first');
  const take = takes[chosen];
  const answer = take ? {...take, positions: toFloats(take.positions)} : null;
  return JSON.stringify({format: SESSION_FORMAT, version: SESSION_VERSION, leader: fileOf(leader),
                         settings: addressOf(settings), answer, rig: rig && fileOf(rig)}, null, 1);
}

// ---- Reading.

function refuse(field, expected, value) {
  const text = value === undefined ? 'nothing' : JSON.stringify(value);
  throw new Error(`${field}: expected ${expected}, got ${text.length > 60 ? `${text.slice(0, 60)}…` : text}`);
}

function check(isRight, field, expected, value) {
  if (!isRight) refuse(field, expected, value);
  return value;
}

const isObject = (value) => value !== null && typeof value === 'object' && !Array.isArray(value);
const checkObject = (value, field) => check(isObject(value), field, 'an object', value);
const checkText = (value, field) =>
    check(typeof value === 'string' && value !== '', field, 'a text', value);
const checkNumber = (value, field, most = Number.MAX_VALUE) =>
    check(value >= 0 && value <= most && typeof value === 'number', field, `a number from 0 to ${most}`, value);
const checkWhole = (value, field) =>
    check(Number.isSafeInteger(value) && value >= 0, field, 'a whole number', value);

function checkBytes(value, field) {
  try {
    if (typeof value === 'string') return fromBase64(value);
  } catch { /* refused below */ }
  return refuse(field, 'base64', value);
}

function readFile(file, field) {
  const {name, bytes} = checkObject(file, field);
  return {name: checkText(name, `${field}.name`), bytes: checkBytes(bytes, `${field}.bytes`)};
}

function readAnswer(answer) {
  const at = (name) => `answer.${name}`;
  const take = {...checkObject(answer, 'answer')};
  for (const name of ['leader', 'settings', 'model']) checkText(take[name], at(name));
  for (const name of ['seed', 'version', 'kept']) checkWhole(take[name], at(name));
  checkNumber(take.unfamiliarity, at('unfamiliarity'));
  for (const [name, share] of Object.entries(take.grade ?? {})) checkNumber(share, at(`grade.${name}`), 1);
  check(Array.isArray(take.pins), at('pins'), 'a list', take.pins);
  take.pins.forEach((pin, i) => checkNumber(checkObject(pin, at(`pins[${i}]`)).metres, at(`pins[${i}].metres`)));
  const bytes = checkBytes(take.positions, at('positions'));
  take.positions = bytes.length % 4 ? [NaN] : fromFloats(bytes);
  check(take.positions.every(Number.isFinite), at('positions'), 'base64 of finite float32 values', 'others');
  return take;
}

// Whether a JSON file calls itself a session, valid or not.
function isSession(text) { return /"format"\s*:\s*"duet-session"/.test(text.slice(0, 1000)); }

// Reads the text of a session file: {leader, settings, answer, rig}. Throws an Error that names the
// field.
function readSession(text) {
  let file;
  try {
    file = JSON.parse(text);
  } catch (error) {
    throw new Error(`session: expected JSON, got a text that is not: ${error.message}`);
  }
  const {version, leader, settings: address, answer, rig} = file;
  check(version === SESSION_VERSION, 'version', `${SESSION_VERSION}; another studio has saved this session`, version);
  return {leader: readFile(leader, 'leader'), settings: settingsAt(checkText(address, 'settings')),
          answer: answer && readAnswer(answer), rig: rig && readFile(rig, 'rig')};
}

const sessionName = () => `${stemOf(state.leader?.name ?? 'duet')}.session.json`;

// Checks that an answer fits the leader that was read.
function checkAnswer(answer, motion) {
  const values = motion.positions.length;
  if (answer.positions.length !== values) {
    refuse('answer.positions', `${values} values for the leader's ${motion.frames} frames`,
           answer.positions.length);
  }
  if (answer.kept >= motion.frames) refuse('answer.kept', 'less than all frames', answer.kept);
}

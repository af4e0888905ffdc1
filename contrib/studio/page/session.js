'use strict';
// A session as a file: JSON with the leader's file, all settings, the chosen answer and the rig.
// Reading is strict: an unknown, missing or malformed field is an error that names it.
const SESSION_FORMAT = 'duet-session';
const SESSION_VERSION = 1;
const MAX_SESSION_BYTES = 2 ** 27;  // the longest leader and its answer at 240 Hz need 80 MB
const MAX_SESSION_FRAMES = 240 * 600;

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
  const {leader: name, file, ...all} = settings;
  const take = takes[chosen];
  const answer = take ? {...take, positions: toFloats(take.positions)} : null;
  return JSON.stringify({format: SESSION_FORMAT, version: SESSION_VERSION, leader: fileOf(leader),
                         settings: all, answer, rig: rig && fileOf(rig)}, null, 1);
}

// ---- Reading. Each check is a function (value, field) that returns the value or throws.

function shownValue(value) {
  const text = value === undefined ? 'nothing' : JSON.stringify(value);
  return text.length > 60 ? `${text.slice(0, 60)}…` : text;
}

function refuse(field, expected, value) {
  throw new Error(`${field}: expected ${expected}, got ${shownValue(value)}`);
}

const within = (least, most, whole = false) => (value, field) => {
  const isRight = typeof value === 'number' && value >= least && value <= most &&
      (!whole || Number.isInteger(value));
  return isRight ? value : refuse(field, `${whole ? 'a whole number' : 'a number'} from ${least} to ${
      most}`, value);
};

const textOf = (most, pattern = /^[^]*$/, expected = '') => (value, field) =>
  (typeof value === 'string' && value.length <= most && pattern.test(value) ? value
      : refuse(field, expected || `a text of at most ${most} characters`, value));

const oneOf = (...values) => (value, field) =>
  (values.includes(value) ? value : refuse(field, values.map((one) => JSON.stringify(one)).join(' or '),
                                           value));

const listOf = (check, most) => (value, field) => {
  if (!Array.isArray(value) || value.length > most) refuse(field, `a list of at most ${most}`, value);
  return value.map((one, i) => check(one, `${field}[${i}]`));
};

const orNull = (check) => (value, field) => (value === null ? null : check(value, field));

const isObject = (value) => value !== null && typeof value === 'object' && !Array.isArray(value);

// An object whose fields all have a check. `optional` names those that may be missing.
const record = (checks, optional = []) => (value, field) => {
  if (!isObject(value)) refuse(field, 'an object', value);
  const at = (name) => (field ? `${field}.${name}` : name);
  for (const name of Object.keys(value)) {
    if (!Object.hasOwn(checks, name)) refuse(at(name), 'no such field', value[name]);
  }
  return Object.fromEntries(Object.entries(checks)
      .filter(([name]) => !(optional.includes(name) && value[name] === undefined))
      .map(([name, check]) => [name, check(value[name], at(name))]));
};

const tableOf = (check) => (value, field) => {
  if (!isObject(value)) refuse(field, 'an object', value);
  return Object.fromEntries(Object.entries(value).map(([name, one]) => {
    if (!/^[A-Za-z]\w*$/.test(name)) refuse(field, 'names of interaction classes', name);
    return [name, check(one, `${field}.${name}`)];
  }));
};

function base64(value, field) {
  try {
    if (typeof value === 'string') return fromBase64(value);
  } catch { /* refused below */ }
  return refuse(field, 'base64', value);
}

function floats(value, field) {
  const bytes = base64(value, field);
  if (bytes.length % 4) refuse(field, 'base64 of float32 values', `${bytes.length} bytes`);
  const positions = fromFloats(bytes);
  if (!positions.every(Number.isFinite)) refuse(field, 'finite values', 'others');
  return positions;
}

const weight = within(-MAX_WEIGHT, MAX_WEIGHT);
const frameNumber = within(0, MAX_SESSION_FRAMES, true);
const seedNumber = within(0, Number.MAX_SAFE_INTEGER, true);
const seedSetting = (value, field) => (value === '' ? '' : seedNumber(value, field));

// The points of a curve, with ascending frames.
function points(value, field) {
  const list = listOf((point, at) => {
    if (!Array.isArray(point) || point.length !== 2) refuse(at, '[frame, weight]', point);
    return [frameNumber(point[0], `${at}[0]`), weight(point[1], `${at}[1]`)];
  }, MAX_POINTS)(value, field);
  list.forEach(([frame], i) => {
    if (i > 0 && frame <= list[i - 1][0]) refuse(`${field}[${i}][0]`, 'ascending frames', frame);
  });
  return list;
}

const SETTINGS_CHECK = record({
  ...Object.fromEntries(Object.entries(DEFAULTS).filter(([, value]) => typeof value === 'string')
      .map(([name]) => [name, name in CHOICES ? oneOf(...CHOICES[name]) : textOf(2000)])),
  labels: tableOf(weight), curves: tableOf(points), seed: seedSetting, variety: within(0, 2),
  candidates: within(1, MAX_CANDIDATES, true), keep: frameNumber,
  turn: textOf(20, /^$|^-?\d+(\.\d+)?$/, 'degrees as text, or ""'),
  pose: listOf(within(-100, 100), MAX_POSE), leader: textOf(500), file: textOf(20),
  pins: listOf((pin, at) => PIN_CHECK(pin, at), MAX_PINS),
}, ['leader', 'file', 'pins']);

const PIN_CHECK = record({
  joint: textOf(100, /^[\w.-]+$/, 'a joint\'s name'), frame: frameNumber,
  position: listOf(within(-PIN_METRES, PIN_METRES), 3), softness: within(0, 1),
});

const FILE_CHECK = record({name: textOf(500, /./, 'a file name'), bytes: base64});

const SHARE = within(0, 1);
const GRADE_CHECK = record(
    {twisted: SHARE, skating: SHARE, leader_skating: SHARE, overlapping: SHARE},
    ['twisted', 'skating', 'leader_skating', 'overlapping']);

const ANSWER_CHECK = record({
  seed: seedNumber, positions: floats, leader: textOf(500), settings: textOf(100000), kept: frameNumber,
  model: textOf(200, /./), version: within(1, 2 ** 32, true), samples: oneOf(true, false),
  unfamiliarity: within(0, Number.MAX_VALUE), grade: orNull(GRADE_CHECK),
  pins: listOf(record({
    joint: textOf(100), frame: frameNumber, position: listOf(within(-PIN_METRES, PIN_METRES), 3),
    metres: within(0, Number.MAX_VALUE),
  }), MAX_PINS),
}, ['pins']);

const SESSION_CHECK = record({
  format: oneOf(SESSION_FORMAT), version: oneOf(SESSION_VERSION), leader: FILE_CHECK,
  settings: SETTINGS_CHECK, answer: orNull(ANSWER_CHECK), rig: orNull(FILE_CHECK),
});

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
  if (isObject(file) && file.format === SESSION_FORMAT && file.version > SESSION_VERSION) {
    refuse('version', `at most ${SESSION_VERSION}; a newer studio has saved this session`,
           file.version);
  }
  const session = SESSION_CHECK(file, '');
  if (session.answer) checkTakeSettings(session.answer);
  return session;
}

// An answer remembers its own settings as text.
function checkTakeSettings(answer) {
  let all;
  try {
    all = JSON.parse(answer.settings);
  } catch {
    refuse('answer.settings', 'JSON', answer.settings);
  }
  SETTINGS_CHECK(all, 'answer.settings');
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

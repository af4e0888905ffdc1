'use strict';
// The visitor's settings, without the leader's file. They are stored in the page's address, so that
// a link or a reload restores them. Links are untrusted, so their values are checked here.
const METRES = 1;
const Y_UP = 1;
const CLEAN_UP = {auto: 0, on: 1, off: 2};
const MAX_WEIGHT = 2;
const MAX_CANDIDATES = 16;
const MAX_POSE = 300;
const MAX_NAME = 120;  // characters; the gateway allows a few more

const settings = {
  leader: '',  // the name of its file
  // Reading the file.
  side: 'left', unit: '', metres_per_unit: '', up_axis: '', frame_rate: '', joint_map: '',
  // The request. `labels` are the sliders' weights, `curves` those that change (curves.js), `seed` is a
  // number or '' for one that the server chooses by the leader, `start` is the place of the follower's
  // root, `turn` its direction in degrees with the pose `pose` (start.js), and `pins` are in pins.js.
  model: '', labels: {}, curves: {}, seed: '', variety: 1, candidates: 1, start: '', turn: '',
  pose: [], direction: '', clean_up: 'auto', pins: [],
  // Downloading.
  resample: '', rig_joint_map: '',
};
const DEFAULTS = structuredClone(settings);
const READING = ['side', 'unit', 'metres_per_unit', 'up_axis', 'frame_rate', 'joint_map'];
const CHOICES = {
  side: ['left', 'right'], unit: ['', 'metres', 'millimetres', 'sbu-normalised'],
  up_axis: ['', 'y-up', 'z-up', 'y-down'], clean_up: Object.keys(CLEAN_UP),
};

function writeWeights(weights) {
  return Object.entries(weights).filter(([, weight]) => weight !== 0)
      .map(([name, weight]) => `${name}:${weight}`).join(',');
}

function readWeights(text) {
  const weights = {};
  for (const part of text.split(',')) {
    const [name, value] = part.split(':');
    const weight = Number(value);
    if (/^\w+$/.test(name) && Number.isFinite(weight)) {
      weights[name] = Math.max(-MAX_WEIGHT, Math.min(MAX_WEIGHT, weight));
    }
  }
  return weights;
}

// The settings that differ from the defaults, as the part of an address behind #.
function addressOf(all) {
  const parts = [];
  const add = (name, text) => parts.push(
      `${name}=${encodeURIComponent(text).replace(/%(3A|2C|40|3B|3D)/g, decodeURIComponent)}`);
  for (const [name, value] of Object.entries(all)) {
    if (name === 'labels') {
      if (writeWeights(value)) add(name, writeWeights(value));
    } else if (name === 'curves') {
      for (const [of, points] of Object.entries(value)) add('curve', writeCurve(of, points));
    } else if (name === 'pins') {
      for (const pin of value) add('pin', writePin(pin));
    } else if (String(value) !== String(DEFAULTS[name])) {
      add(name, String(value));
    }
  }
  return `#${parts.join('&')}`;
}

function readNumber(text, least, most, otherwise) {
  const value = Number(text);
  return text !== '' && value >= least && value <= most ? value : otherwise;
}

// Replaces all settings by those of an address.
function takeAddress(hash) {
  Object.assign(settings, structuredClone(DEFAULTS));
  for (const [name, text] of new URLSearchParams(hash.replace(/^#/, ''))) takeSetting(name, text);
}

// The settings of an address. Those of the page do not change.
function settingsAt(hash) {
  const now = structuredClone(settings);
  takeAddress(hash);
  const found = structuredClone(settings);
  Object.assign(settings, now);
  return found;
}

function takeSetting(name, text) {
  if (name === 'labels') {
    settings.labels = readWeights(text);
  } else if (name === 'curve') {
    readCurve(text);
  } else if (name === 'pin') {
    readPin(settings, text);
  } else if (name === 'pose') {
    const values = text.split(',').map(Number);
    if (values.length <= MAX_POSE && values.every(Number.isFinite)) settings.pose = values;
  } else if (name === 'turn') {
    if (readNumber(text, -360, 360, null) !== null) settings.turn = text;
  } else if (name === 'seed') {
    const seed = readNumber(text, 0, Number.MAX_SAFE_INTEGER, '');
    settings.seed = seed === '' ? '' : Math.floor(seed);
  } else if (name === 'variety') {
    settings.variety = readNumber(text, 0, 2, 1);
  } else if (name === 'candidates') {
    settings.candidates = Math.floor(readNumber(text, 1, MAX_CANDIDATES, 1));
  } else if (typeof DEFAULTS[name] === 'string') {
    if (!(name in CHOICES) || CHOICES[name].includes(text)) settings[name] = text.slice(0, 2000);
  }
}

// Whether a class of the model has a weight.
const isAnyWeight = () => state.model.interaction_classes.some(
    (name) => curveOf(settings, name).length > 0 || (settings.labels[name] ?? 0) !== 0);

// The settings that an answer depends on, to detect whether the displayed answer is current.
function askedFor() {
  const {model, labels, curves, variety, candidates, start, turn, pose, direction, clean_up, pins} =
      settings;
  const constant = Object.entries(labels).filter(([name]) => !curves[name]);
  const curved = Object.entries(curves).sort(([a], [b]) => (a < b ? -1 : 1));
  return JSON.stringify([model, writeWeights(Object.fromEntries(constant.sort())), curved, variety,
                         candidates, start, turn, turn === '' ? [] : pose, direction, clean_up,
                         ...pins.map(writePin)]);
}

function numbers(text) {
  const values = text.split(',').map((part) => Number(part.trim() || NaN));
  return values.length === 3 && values.every(Number.isFinite) ? values : null;
}

// Parses three numbers of a field as a message, or throws an Error that names the field.
function pointOf(name, text) {
  const values = numbers(text);
  if (!values) throw new Error(`${name}: expected three numbers such as 0, 0.9, 1, got "${text}"`);
  return {x: values[0], y: values[1], z: values[2]};
}

const messageOf = (weights) => ({weights: Object.entries(weights).map(
    ([interaction_class, weight]) => ({interaction_class, weight}))});

const nameOf = (model) => `${model.name}@${model.version}`;

function selectorOf(model) {
  const [name, version] = model.split('@');
  return version ? {name, version: Number(version)} : {name};
}

// The request for an answer to the leader's motion. `seed`: '' for one that the server chooses.
function requestOf(leader, seed) {
  const classes = state.model.interaction_classes;
  const request = {
    model: selectorOf(settings.model),
    leader: {joint_names: leader.joint_names, frame_rate_hz: leader.frame_rate_hz, unit: METRES,
             up_axis: Y_UP, frame_count: leader.frames, positions: leader.positions},
    ...(seed !== '' && {seed}), variety: settings.variety, candidates: settings.candidates,
  };
  if (classes.some((name) => curveOf(settings, name).length > 0)) {
    request.label_keyframes = labelKeyframes(settings, classes, leader.frames).map(
        ({frame, weights}) => ({frame, label_vector: messageOf(weights)}));
  } else {
    request.label_vector = messageOf(weightsAt(settings, classes, 0));
  }
  const start = startMessage(leader);
  if (start) request.follower_start = start;
  if (settings.direction) {
    request.partner_direction = pointOf('Direction to the follower', settings.direction);
  }
  if (settings.clean_up !== 'auto') request.clean_up = CLEAN_UP[settings.clean_up];
  const pins = sentPins(settings, state.model.joint_names);
  if (pins.length > 0) request.constraints = constraintsOf(pins);
  return request;
}

const lines = (text) => text.split('\n').map((line) => line.trim()).filter(Boolean);

const stemOf = (name) => name.replace(/(?<=.)\.[^.]*$/, '');

// A file's name in the form that the gateway accepts.
function safeName(name) {
  const safe = (text) => text.replace(/[^\w@.+-]/g, '_');
  const stem = safe(stemOf(name)).replace(/^[^A-Za-z0-9_]+/, '').slice(0, MAX_NAME);
  return (stem || 'leader') + safe(name.slice(stemOf(name).length).slice(0, 12));
}

// The name of a download without extension: leader, model, labels and seed of the answer.
function downloadName(take) {
  const weights = (set) => Object.entries(set).filter(([, weight]) => weight !== 0)
      .map(([name, weight]) => `${name}${Number(weight.toFixed(2))}`);
  const all = settingsAt(take.settings);
  const {labels, curves, variety, candidates} = all;
  const names = Object.keys({...labels, ...curves});
  const reaction = isCurved(all)
      ? labelKeyframes(all, names, Infinity).flatMap(
          (key) => [`at${key.frame}`, ...weights(key.weights)]) : weights(labels);
  const parts = [stemOf(take.leader), `${take.model}@${take.version}`, ...reaction];
  if (take.samples && variety !== 1) parts.push(`variety${variety}`);
  if (take.samples && candidates > 1) parts.push(`best_of${candidates}`);
  const seed = take.samples ? `_seed${take.seed}` : '';
  return safeName(`${parts.join('_')}.x`).slice(0, -2).slice(0, MAX_NAME - seed.length) + seed;
}

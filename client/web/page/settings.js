'use strict';
// The visitor's settings, without the leader's file. They are stored in the page's address, so that
// a link or a reload restores them. Links are untrusted, so their values are checked here.
const METRES = 1;
const Y_UP = 1;
const CLEAN_UP = {auto: 0, on: 1, off: 2};
const MAX_WEIGHT = 2;
const MAX_CANDIDATES = 16;
const MAX_NAME = 120;  // characters; the gateway allows a few more

const settings = {
  leader: '', file: '',  // the name and the fingerprint of the leader's file
  // Reading the file.
  side: 'left', unit: '', metres_per_unit: '', up_axis: '', frame_rate: '', joint_map: '',
  // The request. `labels` are the sliders' weights, `keyframes` is [{frame, weights}].
  model: '', labels: {}, keyframes: [], seed: 0, variety: 1, candidates: 1, start: '',
  direction: '', clean_up: 'auto',
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
    } else if (name === 'keyframes') {
      for (const {frame, weights} of value) add('key', `${frame};${writeWeights(weights)}`);
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
  for (const part of hash.replace(/^#/, '').split('&')) {
    const equals = part.indexOf('=');
    if (equals < 0) continue;
    const name = part.slice(0, equals);
    let text;
    try {
      text = decodeURIComponent(part.slice(equals + 1));
    } catch {
      continue;  // a truncated link
    }
    takeSetting(name, text);
  }
}

function takeSetting(name, text) {
  if (name === 'labels') {
    settings.labels = readWeights(text);
  } else if (name === 'key') {
    const [frame, weights] = text.split(';');
    addKeyframe(frame === '' ? -1 : Number(frame), readWeights(weights ?? ''));
  } else if (name === 'seed') {
    settings.seed = Math.floor(readNumber(text, 0, Number.MAX_SAFE_INTEGER, 0));
  } else if (name === 'variety') {
    settings.variety = readNumber(text, 0, 2, 1);
  } else if (name === 'candidates') {
    settings.candidates = Math.floor(readNumber(text, 1, MAX_CANDIDATES, 1));
  } else if (typeof DEFAULTS[name] === 'string') {
    if (!(name in CHOICES) || CHOICES[name].includes(text)) settings[name] = text.slice(0, 2000);
  }
}

// The settings for reading the file, for comparison.
const readingOf = (all) => JSON.stringify(READING.map((name) => all[name]));

// Sets or replaces the weights at a frame.
function addKeyframe(frame, weights) {
  if (!Number.isInteger(frame) || frame < 0) return;
  const others = settings.keyframes.filter((key) => key.frame !== frame);
  settings.keyframes = [...others, {frame, weights}].sort((a, b) => a.frame - b.frame);
}

const isAnyWeight = () => settings.keyframes.length > 0 ||
    Object.values(settings.labels).some((weight) => weight !== 0);

// The settings that an answer depends on, to detect whether the displayed answer is current.
function askedFor() {
  const {model, labels, keyframes, variety, candidates, start, direction, clean_up} = settings;
  return JSON.stringify([model, keyframes.length ? '' : writeWeights(labels),
                         keyframes.map((key) => [key.frame, writeWeights(key.weights)]), variety,
                         candidates, start, direction, clean_up]);
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

function selectorOf(model) {
  const [name, version] = model.split('@');
  return version ? {name, version: Number(version)} : {name};
}

function requestOf(leader, seed) {
  const request = {
    model: selectorOf(settings.model),
    leader: {joint_names: leader.joint_names, frame_rate_hz: leader.frame_rate_hz, unit: METRES,
             up_axis: Y_UP, frame_count: leader.positions.length / leader.joint_names.length / 3,
             positions: leader.positions},
    seed, variety: settings.variety, candidates: settings.candidates,
  };
  if (settings.keyframes.length > 0) {
    request.label_keyframes = settings.keyframes.map(
        ({frame, weights}) => ({frame, label_vector: messageOf(fullWeights(weights))}));
  } else {
    request.label_vector = messageOf(fullWeights(settings.labels));
  }
  if (settings.start) {
    request.follower_start = {root_position: pointOf('Follower starts at', settings.start)};
  }
  if (settings.direction) {
    request.partner_direction = pointOf('Direction to the follower', settings.direction);
  }
  if (settings.clean_up !== 'auto') request.clean_up = CLEAN_UP[settings.clean_up];
  return request;
}

// A weight for every class of the model, because a label vector needs at least one.
function fullWeights(weights) {
  return Object.fromEntries(state.model.interaction_classes.map(
      (name) => [name, weights[name] ?? 0]));
}

// The settings as flags of `duet synthesize`, which the gateway runs.
function flagsOf(take) {
  const weightsOf = (weights) => Object.entries(weights).filter(([, weight]) => weight !== 0)
      .map(([name, weight]) => `${name}=${weight}`);
  const flags = {model: `${take.model}@${take.version}`, seed: String(take.seed),
                 variety: String(settings.variety), candidates: String(settings.candidates),
                 clean_up: settings.clean_up};
  for (const name of READING) if (settings[name] !== '') flags[name] = settings[name];
  flags.joint_map = lines(settings.joint_map);
  if (settings.keyframes.length > 0) {
    flags.keyframe = settings.keyframes.map(({frame, weights}) => `${frame}:${
        weightsOf(fullWeights(weights)).join(',') || `${state.model.interaction_classes[0]}=0`}`);
  } else {
    flags.label = weightsOf(settings.labels);
  }
  if (settings.start) flags.follower_start = settings.start.replaceAll(' ', '');
  if (settings.direction) flags.partner_direction = settings.direction.replaceAll(' ', '');
  return flags;
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
      .map(([name, weight]) => `${name}${weight}`);
  const {labels, keyframes, variety, candidates} = JSON.parse(take.settings);
  const reaction = keyframes.length
      ? keyframes.flatMap((key) => [`at${key.frame}`, ...weights(key.weights)]) : weights(labels);
  const parts = [stemOf(take.leader), `${take.model}@${take.version}`, ...reaction];
  if (take.samples && variety !== 1) parts.push(`variety${variety}`);
  if (take.samples && candidates > 1) parts.push(`best_of${candidates}`);
  const seed = take.samples ? `_seed${take.seed}` : '';
  return safeName(`${parts.join('_')}.x`).slice(0, -2).slice(0, MAX_NAME - seed.length) + seed;
}

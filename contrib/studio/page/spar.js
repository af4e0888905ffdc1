'use strict';
// The Spar page: the visitor is the leader, and the server answers while they move.

const root = document.documentElement;
const element = (id) => document.getElementById(id);
const FRAME_RATE = 30;
const PLAN_FRAMES = 8;
const LONGEST_STEP = 0.25;    // seconds; a tab that slept does not catch up
const HIDDEN_SECONDS = 2;     // a hidden page ends its session
const LATE_SECONDS = 1.5;     // in which the slowest answer decides how far behind it is shown
const CAMERA_SECONDS = 0.7;
const SLOW_SECONDS = 0.05;    // between two pictures, on average; below, the picture gets coarser
const LABEL_SECONDS = 0.3;  // in which changed labels take effect
const AFTER_MOVE_SECONDS = 1;  // in which the reaction to a move ends
const COARSEST = 0.5;         // pixels of the picture for each of the screen, along one axis
const KEYS = {ArrowUp: 'forward', ArrowDown: 'back', ArrowLeft: 'left', ArrowRight: 'right',
              w: 'forward', s: 'back', a: 'left', d: 'right'};

const spar = {
  models: [], leaders: [], model: null, body: null, leader: null, choreography: null,
  session: null, playback: new Playback(),
  latencies: new Latencies(element('figures')), weights: {}, held: new Set(),
  elapsed: 0,      // seconds since the last frame was sent
  lates: [],       // [time, frames] by which answers were late
  behind: 2,       // frames by which the follower is shown late
  seen: false,     // the follower has arrived
  asked: null,     // the class that a move has set
};
const stage = element('stage');

function tell(text, failed = false) {
  element('status').textContent = text;
  element('status').classList.toggle('failed', failed);
  root.dataset.failed = failed;
}

function tellAway(text) {
  element('away').textContent = text;
  element('away').hidden = !text;
  element('away').classList.remove('calm');
}

// Until the first session opens.
function tellComing() {
  tellAway('Your partner is on the way …');
  element('away').classList.add('calm');
}

const attempt = (act) => async (...all) => {
  try {
    await act(...all);
  } catch (error) {
    tell(error.message, true);
  }
};

// The session.

function connect() {
  spar.session?.close();
  const {model} = spar;
  const on = {
    restart() {
      spar.playback.clear();
      Object.assign(spar, {elapsed: 0, lates: []});
    },
    state(name, message) {
      root.dataset.session = name;
      if (name === 'open') {
        tellAway('');
        if (spar.wasAway) spar.latencies.note('resumed');
        spar.wasAway = false;
      } else if (name === 'away') {
        spar.wasAway = true;
        tellAway(`The server is away. Your partner returns when it does.${message ? ` (${message})` : ''}`);
      } else {
        tellAway(`The server rejected the session: ${message}`);
      }
    },
    notice(kind, count) {
      if (kind === NOTICE.skipped) spar.latencies.note('skipped', count);
    },
    frames: takeFrames,
  };
  spar.session = new LiveSession({
    model: nameOf(model), joints: model.joint_names, frameRate: FRAME_RATE, weights: spar.weights,
    plan: PLAN_FRAMES, acceptsStart: model.accepts_follower_start,
  }, on);
}

// The leader's time in frames.
const frameNow = () => spar.session.leader.end - 1 + spar.elapsed * FRAME_RATE;

function takeFrames(part) {
  const {session, latencies} = spar;
  spar.playback.take(session.follower, part);
  latencies.add(1000 * part.latency);
  spar.lates.push([performance.now(), frameNow() - (part.first + part.poses.length - 1)]);
  root.dataset.frames = session.follower.end;
}

// Changes the labels within `ease` seconds. `weights` of the classes that are not named are 0.
function setWeights(weights, ease = LABEL_SECONDS) {
  spar.weights = Object.fromEntries(spar.model.interaction_classes.map(
      (name) => [name, weights[name] ?? 0]));
  for (const label of element('labels').children) {
    setSlider(label, spar.weights[label.querySelector('input').name]);
  }
  spar.session?.changeLabels(spar.weights, ease);
}

// Sets the reaction to a move, or eases to neutral after one. Weights that the visitor has set since
// then stay.
function followMove(move) {
  const isOwn = spar.asked && Object.entries(spar.weights).every(
      ([name, weight]) => weight === (name === spar.asked ? 1 : 0));
  if (move && element('follow').checked) setWeights(move.label ? {[move.label]: 1} : {});
  else if (!move && isOwn) setWeights({}, AFTER_MOVE_SECONDS);
  spar.asked = move && element('follow').checked ? move.label : null;
}

// The model.

async function chooseModel(model) {
  const body = new Body(model.joint_names);
  const {rest, moves} = await movesFor(model, spar.leaders, body);
  spar.session?.close();
  spar.session = null;
  const leader = new Leader(body, rest);
  const choreography = new Choreography(leader, moves, () => distance(body, leader.pose, spar.partner));
  Object.assign(spar, {model, body, leader, choreography, seen: false, asked: null});
  spar.playback = new Playback();  // it begins where showStage places the partner
  choreography.began = (move) => {
    followMove(move);
    showMoves();
  };
  showStage();
  showSliders(model.interaction_classes);
  makeMoves();
  element('help').textContent = helpFor(moves.length);
  setWeights({});
  connect();
}

// Between two people, along the floor.
function distance(body, ...poses) {
  const [a, b] = poses.map((pose) => body.hips(pose));
  return Math.hypot(a[0] - b[0], a[2] - b[2]);
}

// How the moves are thrown, by touch or by keys.
function helpFor(moves) {
  if (matchMedia('(pointer: coarse)').matches) {
    return `${moves > 0 ? 'Tap a move. ' : ''}Hold an arrow to walk. Drag to turn the view.`;
  }
  return `${moves > 0 ? `Keys 1 to ${moves} throw a move. ` : ''}Arrows walk. Drag to turn the view.`;
}

function showStage() {
  const {model, leader} = spar;
  const joints = model.joint_names;
  const bones = model.bones.map(({parent_joint: a, child_joint: b}) => [a ?? 0, b ?? 0]);
  const partner = placed(leader.pose, {x: 0, z: 1.1, yaw: Math.PI});
  stage.motion = {joints, bones, frameRate: FRAME_RATE, frames: 1,
                  leader: Float32Array.from(leader.pose), follower: partner};
  if (!stage.stage) throw new Error('This browser shows no WebGL.');
  for (const {path} of Object.values(stage.people)) path.visible = false;
  spar.playback.standAt(partner);
  Object.assign(spar, {camera: {x: 0, z: 0.55}, partner});
}

function showSliders(classes) {
  element('labels').replaceChildren(...classes.map((name) => {
    const slider = makeSlider(name, -1, 1);
    setSlider(slider, 0);
    joinSlider(slider, (weight) => {
      spar.weights = {...spar.weights, [name]: weight};
      spar.session?.changeLabels(spar.weights, LABEL_SECONDS);
    });
    return slider;
  }));
}

function makeMoves() {
  element('moves').replaceChildren(...spar.choreography.moves.map((move, i) => {
    const button = document.createElement('button');
    button.type = 'button';
    const key = document.createElement('kbd');
    key.textContent = i + 1;
    button.append(key, move.name);
    button.addEventListener('click', () => throwMove(i));
    return button;
  }));
  const again = document.createElement('button');
  Object.assign(again, {type: 'button', id: 'again'});
  again.append(Object.assign(document.createElement('kbd'), {textContent: 'R'}), 'start over');
  again.addEventListener('click', attempt(() => chooseModel(spar.model)));
  element('moves').append(again);
  showMoves();
}

function showMoves() {
  const {moves, current} = spar.choreography;
  moves.forEach((move, i) => {
    element('moves').children[i].setAttribute('aria-pressed', move === current);
  });
  root.dataset.move = current?.leader ?? '';
}

function throwMove(index) {
  const move = spar.choreography.moves[index];
  if (move) spar.choreography.begin(move);
}

// Time.

function advance(seconds) {
  const {choreography, leader, session} = spar;
  const frame = 1 / FRAME_RATE;
  const poses = [];
  for (let left = seconds; left > 0;) {
    const step = Math.min(left, Math.max(frame - spar.elapsed, 1e-6));
    choreography.advance(step);
    spar.elapsed += step;
    left -= step;
    if (spar.elapsed < frame - 1e-6) continue;
    spar.elapsed = 0;
    poses.push(Float32Array.from(leader.pose));
  }
  if (!poses.length || !session) return;
  session.add(poses, performance.now() / 1000);
}

function showFollower(seconds) {
  const now = performance.now();
  spar.lates = spar.lates.filter(([time]) => now - time < 1000 * LATE_SECONDS);
  if (spar.lates.length) {
    const wanted = Math.max(...spar.lates.map(([, late]) => late)) + 0.25;
    spar.behind += clamp(wanted - spar.behind, -seconds, 8 * seconds);
  }
  const pose = spar.session && spar.playback.show(frameNow() - spar.behind, seconds);
  if (!pose) return;
  stage.setPose('follower', pose);
  if (spar.playback.store) spar.seen = true;
  spar.partner = pose;
}

// Keeps both people in view.
function moveCamera(seconds) {
  const [a, b] = [spar.body.hips(spar.leader.pose), spar.body.hips(spar.partner)];
  const share = 1 - Math.exp(-seconds / CAMERA_SECONDS);
  spar.camera = {x: mix(spar.camera.x, (a[0] + b[0]) / 2, share),
                 z: mix(spar.camera.z, (a[2] + b[2]) / 2, share)};
  stage.follow(spar.camera.x, spar.camera.z);
}

// Slow computers get a coarser picture, so that frames are sent and answered in time.
function watchSpeed(seconds) {
  spar.pace = mix(spar.pace ?? 0, seconds, Math.min(1, seconds));
  const {renderer} = stage.stage;
  const ratio = renderer.getPixelRatio();
  if (spar.pace < SLOW_SECONDS || ratio <= COARSEST) return;
  renderer.setPixelRatio(Math.max(COARSEST, ratio * 0.75));
  stage.draw();  // the new picture is empty
  spar.pace = 0;
}

let before = null;
function tick(now) {
  requestAnimationFrame(tick);
  const seconds = before === null ? 0 : Math.min((now - before) / 1000, LONGEST_STEP);
  before = now;
  if (!spar.leader || seconds <= 0) return;
  advance(seconds);
  stage.setPose('leader', spar.leader.pose);
  showFollower(seconds);
  moveCamera(seconds);
  watchSpeed(seconds);
  spar.latencies.show(now);
}

// Keys and touch.

function steer() {
  const sum = (plus, minus) => Number(spar.held.has(plus)) - Number(spar.held.has(minus));
  spar.leader.wanted = {forward: sum('forward', 'back'), left: sum('left', 'right')};
  for (const button of element('steer').children) {
    button.classList.toggle('held', spar.held.has(button.dataset.way));
  }
}

function hold(way, isHeld) {
  if (isHeld) spar.held.add(way);
  else spar.held.delete(way);
  if (!spar.leader) return;
  // Whoever walks stops what they do.
  if (isHeld && spar.choreography.current) spar.choreography.begin(null);
  steer();
}

function connectKeys() {
  window.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target.matches('input[type=number], select')) return;
    const way = KEYS[event.key];
    const isRange = event.target.matches('input');
    if (way && !(isRange && event.key.startsWith('Arrow'))) {
      event.preventDefault();
      if (!event.repeat) hold(way, true);
    } else if (/^[1-9]$/.test(event.key) && !event.repeat) {
      throwMove(Number(event.key) - 1);
    } else if (event.key === 'r') {
      element('again').click();
    }
  });
  window.addEventListener('keyup', ({key}) => {
    if (KEYS[key]) hold(KEYS[key], false);
  });
  window.addEventListener('blur', () => {
    spar.held.clear();
    if (spar.leader) steer();
  });
  // After a mouse, arrows walk again.
  window.addEventListener('pointerup', ({target}) => {
    if (target.matches?.('input[type=range], input[type=checkbox], button')) target.blur();
  });
  for (const button of element('steer').children) {
    const {way} = button.dataset;
    button.addEventListener('pointerdown', (event) => {
      event.stopPropagation();
      button.setPointerCapture(event.pointerId);
      hold(way, true);
    });
    for (const name of ['pointerup', 'pointercancel']) {
      button.addEventListener(name, () => hold(way, false));
    }
    button.addEventListener('keydown', ({key}) => { if (key === ' ') hold(way, true); });
    button.addEventListener('keyup', ({key}) => { if (key === ' ') hold(way, false); });
  }
}

function connectControls() {
  element('model').addEventListener('change', attempt(
      () => chooseModel(spar.models.find((model) => nameOf(model) === element('model').value))));
  // A hidden page draws nothing, so it sends nothing either.
  let hiding = null;
  document.addEventListener('visibilitychange', () => {
    clearTimeout(hiding);
    if (document.hidden) {
      hiding = setTimeout(() => spar.session?.close(), 1000 * HIDDEN_SECONDS);
    } else if (spar.session && !spar.session.socket) {
      connect();
    }
  });
}

async function start() {
  const {about, models} = await awaitServer((error) => {
    tellAway(error.message);
    root.dataset.state = 'failed';
  });
  tellComing();
  spar.leaders = [...about.samples, ...about.moves];
  spar.models = models.filter((model) => model.answers_live);
  if (!spar.models.length) throw new Error('The server has no model that answers live.');
  element('model').replaceChildren(...spar.models.map((model) => new Option(nameOf(model))));
  const asked = new URLSearchParams(location.search).get('model');
  const model = spar.models.find((one) => [nameOf(one), one.name].includes(asked))
      ?? spar.models.find((one) => one.is_default) ?? spar.models[0];
  element('model').value = nameOf(model);
  connectKeys();
  connectControls();
  await chooseModel(model);
  requestAnimationFrame(tick);
  root.dataset.state = 'ready';
}

start().catch((error) => {
  tellAway(error.message);
  root.dataset.state = 'failed';
});

'use strict';
// The follower's start: a place on the floor, and optionally a direction. The visitor drags a marker
// in the scene or fills in fields. The marker shows a pose, which is sent and met
// exactly: that of the shown answer's first frame, else the leader's. A place that is only filled in
// is sent as the root's position, which leaves the pose to the model and is met within decimetres.
const RING_METRES = 0.3;
const ARROW_METRES = 0.55;
const FIRST_DISTANCE = 1;  // metres in front of the leader, where nothing else is known

const radians = (degrees) => degrees * Math.PI / 180;
const rounded = (value, digits = 3) => Number(value.toFixed(digits)) + 0;

const rootJoint = (motion) =>
    Math.max(0, motion.joint_names.indexOf(state.model.root_joint || 'torso'));

const jointAt = (positions, joint) => Array.from(positions.subarray(joint * 3, joint * 3 + 3));

// The direction that a pose faces, degrees about y: 0 is +z, 90 is +x.
function headingOf(motion, positions) {
  const [left, right] = ['left_hip', 'right_hip'].map(
      (name) => jointAt(positions, Math.max(0, motion.joint_names.indexOf(name))));
  const [x, z] = [right[0] - left[0], right[2] - left[2]];
  return x === 0 && z === 0 ? 0 : Math.atan2(z, -x) * 180 / Math.PI;
}

// A pose relative to its root and facing +z, and what was taken off.
function normalPose(motion, positions) {
  const root = jointAt(positions, rootJoint(motion));
  const heading = headingOf(motion, positions);
  return {root, heading, pose: turned(positions, -heading, root, [0, 0, 0])};
}

// A pose turned about `from`, which moves to `to`.
function turned(pose, degrees, from, to) {
  const [sine, cosine] = [Math.sin(radians(degrees)), Math.cos(radians(degrees))];
  const out = new Float32Array(pose.length);
  for (let i = 0; i < pose.length; i += 3) {
    const [x, y, z] = [pose[i] - from[0], pose[i + 1] - from[1], pose[i + 2] - from[2]];
    out.set([to[0] + x * cosine + z * sine, to[1] + y, to[2] + z * cosine - x * sine], i);
  }
  return out;
}

// The pose that starts where the settings leave it open.
function openStart({motion}) {
  const count = motion.joint_names.length * 3;
  const answer = state.takes[state.chosen];
  if (answer) return normalPose(motion, answer.positions.subarray(0, count));
  const start = normalPose(motion, motion.positions.subarray(0, count));
  const {root, heading} = start;
  start.root = [root[0] + FIRST_DISTANCE * Math.sin(radians(heading)), root[1],
                root[2] + FIRST_DISTANCE * Math.cos(radians(heading))];
  start.heading = heading + 180;
  return start;
}

// The start of the settings: {root, heading, pose}, the pose relative to the root and facing +z.
function startNow(leader) {
  const open = openStart(leader);
  const root = numbers(settings.start) ?? open.root;
  const heading = settings.turn === '' ? open.heading : Number(settings.turn);
  const isPose = settings.turn !== '' && settings.pose.length === open.pose.length;
  return {root, heading, pose: isPose ? Float32Array.from(settings.pose) : open.pose};
}

// FollowerStart of a request; null if the server chooses.
function startMessage(motion) {
  if (!settings.start && settings.turn === '') return null;
  if (settings.start) pointOf('Follower starts at', settings.start);
  if (settings.turn === '') return {root_position: pointOf('Follower starts at', settings.start)};
  const {root, heading, pose} = startNow({motion});
  return {pose: {positions: turned(pose, heading, [0, 0, 0], root)}};
}

function setStart(root, degrees, pose) {
  settings.start = root.map((value) => rounded(value)).join(', ');
  settings.pose = Array.from(pose, (value) => rounded(value));
  settings.turn = String(rounded(((degrees + 180) % 360 + 360) % 360 - 180, 1));
}

function moveStart(x, z) {
  const {root, heading, pose} = startNow(state.leader);
  setStart([x, root[1], z], heading, pose);
}

function turnStart(degrees) {
  const {root, pose} = startNow(state.leader);
  setStart(root, degrees, pose);
}

function freeStart() {
  Object.assign(settings, {start: '', turn: '', pose: []});
}

// The marker: a ring, an arrow with a knob, and the outline of the pose, drawn over the scene.
class StartMarker {
  constructor(svg, onChange, onEnd) {
    this.svg = svg;
    this.onChange = onChange;
    this.onEnd = onEnd;
    this.body = this.add('path', 'body');
    this.ring = this.add('path', 'ring');
    this.arrow = this.add('path', 'arrow');
    this.knob = this.add('circle', 'knob');
    this.knob.setAttribute('r', 9);
    this.connect(this.ring, (at) => moveStart(at[0] - this.grip[0], at[1] - this.grip[1]));
    this.connect(this.knob, ([x, z]) => {
      const {root} = startNow(state.leader);
      turnStart(Math.atan2(x - root[0], z - root[2]) * 180 / Math.PI);
    });
  }

  add(kind, name) {
    const item = svgItem(kind, {class: name});
    this.svg.append(item);
    return item;
  }

  // The place on the floor below a pointer, [x, z], or null above the horizon.
  floorBelow(event) {
    const box = this.svg.getBoundingClientRect();
    return theatre.floorAt(event.clientX - box.left, event.clientY - box.top);
  }

  connect(item, move) {
    connectDrag(item, (event) => {
      const at = this.floorBelow(event);
      if (!at) return false;
      const {root} = startNow(state.leader);
      this.grip = [at[0] - root[0], at[1] - root[2]];
      return true;
    }, (event) => {
      const at = this.floorBelow(event);
      if (!at) return;
      move(at);
      this.onChange();
    }, () => this.onEnd());
  }

  draw() {
    if (this.svg.hasAttribute('hidden') || !state.leader || !theatre.player) return;
    const {root, heading, pose} = startNow(state.leader);
    const floor = theatre.floorHeight;
    const point = (x, z) => theatre.project(x, floor, z).slice(0, 2);
    const around = (degrees, metres) => point(root[0] + metres * Math.sin(radians(degrees)),
                                              root[2] + metres * Math.cos(radians(degrees)));
    const path = (points, close) => `M${points.map(
        ([x, y]) => `${x.toFixed(1)} ${y.toFixed(1)}`).join('L')}${close ? 'Z' : ''}`;
    const circle = Array.from({length: 40}, (_, i) => around(9 * i, RING_METRES));
    const tip = around(heading, ARROW_METRES);
    this.ring.setAttribute('d', path(circle, true));
    this.arrow.setAttribute('d', path([around(heading, RING_METRES), tip]));
    this.knob.setAttribute('cx', tip[0]);
    this.knob.setAttribute('cy', tip[1]);
    const body = turned(pose, heading, [0, 0, 0], root);
    const joint = (index) => theatre.project(...jointAt(body, index)).slice(0, 2);
    this.body.setAttribute('d', bonesOf(state.leader.motion).filter((bone) => Math.min(...bone) >= 0)
        .map(([parent, child]) => path([joint(parent), joint(child)])).join(''));
    const isSet = Boolean(settings.start || settings.turn !== '');
    this.svg.classList.toggle('set', isSet);
  }
}

'use strict';
// Reads the motion of one person from BVH text.

const CENTIMETRE = 0.01;

// A 3 by 3 matrix, row by row, that rotates by degrees about an axis.
function rotationAbout(axis, degrees) {
  const [c, s] = [Math.cos(degrees * Math.PI / 180), Math.sin(degrees * Math.PI / 180)];
  return {X: [1, 0, 0, 0, c, -s, 0, s, c], Y: [c, 0, s, 0, 1, 0, -s, 0, c],
          Z: [c, -s, 0, s, c, 0, 0, 0, 1]}[axis];
}

function timesMatrix(a, b) {
  return a.map((_, i) => [0, 1, 2].reduce(
      (sum, k) => sum + a[Math.floor(i / 3) * 3 + k] * b[k * 3 + i % 3], 0));
}

const timesVector = (m, v) => [0, 3, 6].map(
    (row) => m[row] * v[0] + m[row + 1] * v[1] + m[row + 2] * v[2]);

// The joints of a HIERARCHY: [{name, parent, offset, channels}], parents first.
function readHierarchy(lines) {
  const joints = [];
  const open = [];
  for (const line of lines) {
    const words = line.trim().split(/\s+/);
    if (['ROOT', 'JOINT', 'End'].includes(words[0])) {
      joints.push({name: words[0] === 'End' ? '' : words[1], parent: open[open.length - 1] ?? -1,
                   offset: [0, 0, 0], channels: []});
    } else if (words[0] === '{') {
      open.push(joints.length - 1);
    } else if (words[0] === '}') {
      open.pop();
    } else if (words[0] === 'OFFSET') {
      joints[joints.length - 1].offset = words.slice(1, 4).map(Number);
    } else if (words[0] === 'CHANNELS') {
      joints[joints.length - 1].channels = words.slice(2);
    }
  }
  return joints;
}

// The places of all joints in one frame.
function placeJoints(joints, values) {
  let next = 0;
  const places = [];
  const turns = [];
  for (const {parent, offset, channels} of joints) {
    const at = [...offset];
    let turn = [1, 0, 0, 0, 1, 0, 0, 0, 1];
    for (const channel of channels) {
      const value = values[next++];
      if (channel.endsWith('position')) at['XYZ'.indexOf(channel[0])] += value;
      else turn = timesMatrix(turn, rotationAbout(channel[0], value));
    }
    if (parent < 0) {
      places.push(at);
      turns.push(turn);
    } else {
      const from = timesVector(turns[parent], at);
      places.push(from.map((value, axis) => places[parent][axis] + value));
      turns.push(timesMatrix(turns[parent], turn));
    }
  }
  return places;
}

// {frameRate, frames}: each frame a Float32Array [names, 3] in metres, for the joints `names`, or
// null if the file lacks one of them.
function readBvh(text, names) {
  const [head, motion] = text.split(/^MOTION\s*$/m);
  const joints = readHierarchy(head.split('\n'));
  const wanted = names.map((name) => joints.findIndex((joint) => joint.name === name));
  if (wanted.includes(-1)) return null;
  const lines = motion.trim().split('\n');
  const frames = lines.slice(2).map((line) => {
    const places = placeJoints(joints, line.trim().split(/\s+/).map(Number));
    return Float32Array.from(wanted.flatMap((joint) => places[joint]), (value) => value * CENTIMETRE);
  });
  return {frameRate: Math.round(1 / Number(lines[1].split(':')[1])), frames};
}

// What the keys 1 to 6 throw: the samples, or the figures of a dance.

// Blows go through a partner who stands too near: the leader first steps back until there is room.
const BLOWS = ['kick', 'push', 'punch'];
const ROOM_METRES = 0.2;     // from the furthest hand or ankle to the middle of the partner's hips
const STEP_BACK_SECONDS = 0.8;  // at most
const BEAT_FRAMES = 10;   // of samples/salsa.bvh
const BAR_BEATS = 8;
const DANCE_BPM = 180;
// Figures of samples/salsa.bvh in beats. The basic step repeats between the others.
const FIGURES = [
  {name: 'basic step', label: 'basic', from: 16, to: 24, loops: true},
  {name: 'turn the follower', label: 'follower_turn', from: 28, to: 36},
  {name: 'cross body lead', label: 'cross_body', from: 52, to: 60},
  {name: 'step apart', label: 'apart', from: 80, to: 88},
];

async function sampleOf(name, joints) {
  const response = await fetchFrom(`/samples/${name}.bvh`);
  if (!response.ok) throw new CallError(await messageIn(response));
  return readBvh(await response.text(), joints);
}

// {rest, moves, isDance}, where moves are [{name, label, clip}], or null if no sample has the
// model's joints. A model without a sample of its classes has no moves: its leader stands and is dragged.
async function movesFor(model, samples, body) {
  const joints = model.joint_names;
  const names = model.interaction_classes.filter((name) => samples.includes(name)).slice(0, 9);
  if (!names.length && samples.includes('salsa')) {
    const dance = await sampleOf('salsa', joints);
    if (!dance || model.interaction_classes.includes('basic')) return dance && danceOf(dance, body, model.bones);
    return {isDance: false, rest: standing(dance.frames[0], body, model.bones), moves: []};
  }
  const motions = await Promise.all(names.map((name) => sampleOf(name, joints)));
  if (!motions.length || motions.includes(null)) return null;
  return {
    isDance: false, rest: motions[0].frames[0],
    moves: names.map((name, i) => ({
      name: name.replaceAll('_', ' '), label: name,
      clip: new Clip(body, name, motions[i].frames, motions[i].frameRate),
    })),
  };
}

function danceOf({frames, frameRate}, body, bones) {
  const moves = FIGURES.map(({name, label, from, to, loops = false}) => ({
    name, label,
    clip: new Clip(body, name, frames.slice(from * BEAT_FRAMES, to * BEAT_FRAMES + 1), frameRate,
                   {loops, turns: true}),
  }));
  return {isDance: true, rest: standing(frames[0], body, bones), moves};
}

// The direction of the bone to each joint of a person who stands, ready to hold hands, and looks
// along +z, the left side at +x.
const STANDING = [
  [/shoulder/, [1, 0.5, 0]], [/hip$/, [1, -0.3, 0]], [/elbow/, [0.14, -1, -0.08]],
  [/wrist|hand/, [0.05, -0.55, 1]], [/knee/, [0.05, -1, 0.16]], [/ankle|foot/, [0.02, -1, -0.12]],
  [/toe/, [0.1, -0.4, 1]], [/head/, [0, 1, 0.12]], [/./, [0, 1, 0]],
];

// A standing pose with the limbs of another pose, the lowest joint as high as there.
function standing(like, body, bones) {
  const pose = new Float32Array(like.length);
  for (const {parent_joint: parent = 0, child_joint: child = 0} of bones) {
    const name = body.names[child];
    const [, [x, ...rest]] = STANDING.find(([pattern]) => pattern.test(name));
    const direction = [name.startsWith('right') ? -x : x, ...rest];
    const length = norm(sub(body.at(like, child), body.at(like, parent)));
    body.put(pose, child, add(body.at(pose, parent), direction, length / norm(direction)));
  }
  const lowest = (one) => one.reduce((least, value, i) => (i % 3 === 1 ? Math.min(least, value) : least), Infinity);
  const up = lowest(like) - lowest(pose);
  return pose.map((value, i) => (i % 3 === 1 ? value + up : value));
}

// Chooses the leader's next clip.
class Choreography {
  // `distance()`: from the leader to the partner, metres.
  constructor(leader, {moves, isDance}, distance) {
    Object.assign(this, {leader, moves, isDance, distance});
    this.backing = 0;      // seconds for which the leader still steps back before the move
    this.current = null;   // the move being done
    this.queued = null;
    leader.ended = (clip, over) => this.next(over);
  }

  // Throws a move; a figure of a dance waits for the next bar. Returns whether it began.
  choose(move) {
    if (!this.isDance || !this.current) return this.begin(move, 0);
    // The basic step, again: stop dancing.
    if (move === this.current && move.clip.loops) return this.begin(null, 0);
    this.queued = move;
    return false;
  }

  begin(move, over) {
    this.current = move;
    this.queued = null;
    this.backing = move && this.isNear(move) ? STEP_BACK_SECONDS : 0;
    this.leader.backs = this.backing > 0;
    this.leader.play(this.backing > 0 ? null : move && move.clip, over);
    this.began?.(move);
    return true;
  }

  isNear({label, clip}) {
    return BLOWS.includes(label) && this.distance() < clip.reach + ROOM_METRES;
  }

  // Begins the move for which the leader has stepped back.
  stepBack(seconds) {
    if (this.backing === 0) return;
    this.backing = this.isNear(this.current) ? Math.max(0, this.backing - seconds) : 0;
    if (this.backing > 0) return;
    this.leader.backs = false;
    this.leader.play(this.current.clip);
  }

  next(over) {
    this.begin(this.queued ?? (this.isDance ? this.moves[0] : null), over);
  }

  // Moves the leader; called for every step of time.
  advance(seconds) {
    const {leader, current} = this;
    const bar = BAR_BEATS * 60 / DANCE_BPM;
    const before = leader.clipTime;
    this.stepBack(seconds);
    leader.advance(seconds);
    const over = leader.clipTime % bar;
    if (this.queued && current === this.current && current?.clip.loops
        && Math.floor(leader.clipTime / bar) > Math.floor(before / bar)) this.next(over);
  }
}

'use strict';
// What the keys throw: the samples of the model's classes.

// Blows go through a partner who stands too near: the leader first steps back until there is room.
const BLOWS = ['kick', 'push', 'punch'];
const ROOM_METRES = 0.2;     // from the furthest hand or ankle to the middle of the partner's hips
const STEP_BACK_SECONDS = 0.8;  // at most
const MAX_MOVES = 9;         // keys 1 to 9

// A sample in a model's joints, {frameRate, frames}: each frame a Float32Array [joints, 3].
async function sampleOf(name, model) {
  const {motion} = await readMotion(`${name}.bvh`, await fetchSample(name), model);
  const values = motion.joint_names.length * 3;
  return {frameRate: motion.frame_rate_hz, frames: Array.from(
      {length: motion.frames}, (_, i) => motion.positions.slice(i * values, (i + 1) * values))};
}

// {rest, moves}, where moves are [{name, label, clip}]. A model without a sample of its classes has no
// moves: its leader stands and walks.
async function movesFor(model, samples, body) {
  const names = model.interaction_classes.filter((name) => samples.includes(name)).slice(0, MAX_MOVES);
  if (!names.length) {
    const {frames} = await sampleOf('salsa', model);
    return {rest: standing(frames[0], body, model.bones), moves: []};
  }
  const motions = await Promise.all(names.map((name) => sampleOf(name, model)));
  return {
    rest: motions[0].frames[0],
    moves: names.map((name, i) => ({
      name: name.replaceAll('_', ' '), label: name,
      clip: new Clip(body, motions[i].frames, motions[i].frameRate),
    })),
  };
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

// Lets the leader do one move after another.
class Choreography {
  // `distance()`: from the leader to the partner, metres.
  constructor(leader, moves, distance) {
    Object.assign(this, {leader, moves, distance});
    this.backing = 0;      // seconds for which the leader still steps back before the move
    this.current = null;   // the move being done
    leader.ended = () => this.begin(null);
  }

  // Begins a move, or ends one with null.
  begin(move) {
    this.current = move;
    this.backing = move && this.isNear(move) ? STEP_BACK_SECONDS : 0;
    this.leader.backs = this.backing > 0;
    this.leader.play(this.backing > 0 ? null : move && move.clip);
    this.began?.(move);
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

  // Moves the leader; called for every step of time.
  advance(seconds) {
    this.stepBack(seconds);
    this.leader.advance(seconds);
  }
}

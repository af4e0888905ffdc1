'use strict';
// The leader's body: vectors, poses, legs that reach the floor.

const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const add = (a, b, scale = 1) => [a[0] + b[0] * scale, a[1] + b[1] * scale, a[2] + b[2] * scale];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const norm = (a) => Math.hypot(a[0], a[1], a[2]);
const mix = (a, b, share) => a + (b - a) * share;
const clamp = (value, least, most) => Math.min(most, Math.max(least, value));
const smooth = (share) => {
  const t = clamp(share, 0, 1);
  return t * t * (3 - 2 * t);
};

// A rotation about the axis [x, y, z] (a unit vector) by radians, as a function of vectors.
function turning(axis, angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return (v) => {
    const cross = [axis[1] * v[2] - axis[2] * v[1], axis[2] * v[0] - axis[0] * v[2],
                   axis[0] * v[1] - axis[1] * v[0]];
    const along = dot(axis, v) * (1 - c);
    return v.map((value, i) => value * c + cross[i] * s + axis[i] * along);
  };
}

// Places on the floor: {x, z, yaw}. A person with yaw 0 looks along +z, the left side at +x.
function placed(pose, {x, z, yaw}) {
  const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
  const out = new Float32Array(pose.length);
  for (let i = 0; i < pose.length; i += 3) {
    out[i] = x + c * pose[i] + s * pose[i + 2];
    out[i + 1] = pose[i + 1];
    out[i + 2] = z - s * pose[i] + c * pose[i + 2];
  }
  return out;
}

// The inverse of `placed`.
function unplaced(pose, {x, z, yaw}) {
  const moved = Float32Array.from(pose, (value, i) => value - [x, 0, z][i % 3]);
  return placed(moved, {x: 0, z: 0, yaw: -yaw});
}

// The place that `inner`, given relative to `outer`, has in the world.
function placeWithin(outer, inner) {
  const [x, , z] = placed([inner.x, 0, inner.z], outer);
  return {x, z, yaw: outer.yaw + inner.yaw};
}

// The joints of a skeleton and their roles.
class Body {
  constructor(names) {
    this.names = names;
    const find = (...choices) => choices.map((name) => names.indexOf(name)).find((i) => i >= 0) ?? -1;
    const side = (name) => ({
      hip: find(`${name}_hip`), knee: find(`${name}_knee`),
      foot: find(`${name}_foot`, `${name}_ankle`), toe: find(`${name}_toe`),
      shoulder: find(`${name}_shoulder`), elbow: find(`${name}_elbow`),
      hands: [`${name}_wrist`, `${name}_hand`].map((hand) => names.indexOf(hand)).filter((i) => i >= 0),
    });
    this.sides = [side('left'), side('right')];
    this.waist = find('torso', 'spine');
    const legs = this.sides.flatMap(({knee, foot, toe}) => [knee, foot, toe]);
    const hips = [...this.sides.map(({hip}) => hip), names.indexOf('hips')];
    this.legs = legs.filter((joint) => joint >= 0);
    this.upper = names.map((_, joint) => joint)
        .filter((joint) => !legs.includes(joint) && !hips.includes(joint));
    this.pelvis = hips.filter((joint) => joint >= 0);
  }

  at(pose, joint) { return [pose[joint * 3], pose[joint * 3 + 1], pose[joint * 3 + 2]]; }
  put(pose, joint, place) { pose.set(place, joint * 3); }

  hips(pose) {
    const [left, right] = this.sides.map(({hip}) => this.at(pose, hip));
    return add(left, right).map((value) => value / 2);
  }

  // Where a pose stands and looks.
  place(pose) {
    const [left, right] = this.sides.map(({hip}) => this.at(pose, hip));
    const [x, , z] = this.hips(pose);
    return {x, z, yaw: Math.atan2(right[2] - left[2], left[0] - right[0])};
  }

  moveAll(pose, joints, move) {
    for (const joint of joints) this.put(pose, joint, move(this.at(pose, joint)));
  }

  // Turns joints about a point.
  turn(pose, joints, centre, rotate) {
    this.moveAll(pose, joints, (place) => add(centre, rotate(sub(place, centre))));
  }

  // Moves the pelvis and all above it.
  shift(pose, by) {
    this.moveAll(pose, [...this.pelvis, ...this.upper], (place) => add(place, by));
  }

  // Bends a leg so that it reaches from its hip to the foot. Thigh and shin keep their lengths in
  // `like`; the knee points to where it points in the pose.
  reach(pose, {hip, knee, foot}, like) {
    const thigh = norm(sub(this.at(like, knee), this.at(like, hip)));
    const shin = norm(sub(this.at(like, foot), this.at(like, knee)));
    const from = this.at(pose, hip);
    const to = sub(this.at(pose, foot), from);
    const length = clamp(norm(to), 1e-3, (thigh + shin) * 0.9995);
    const along = to.map((value) => value / (norm(to) || 1));
    const near = (thigh * thigh - shin * shin + length * length) / (2 * length);
    const out = Math.sqrt(Math.max(0, thigh * thigh - near * near));
    const bent = add(sub(this.at(pose, knee), from), [0, 0, 0.05]);
    let pole = add(bent, along, -dot(bent, along));
    if (norm(pole) < 1e-3) pole = [0, 0, 1];
    this.put(pose, knee, add(add(from, along, near), pole, out / norm(pole)));
  }
}

// The leader of the Spar page. It stands, breathes, walks and plays clips; every change is
// blended.
const BLEND_SECONDS = 0.2;
const WALK_SPEED = 1.15;     // metres a second
const BACK_SPEED = 0.8;
const TURN_SPEED = 1.9;      // radians a second
const EASE_SECONDS = 0.16;   // until walking and turning have their speed
const STEP_SECONDS = 0.92;   // for a left and a right step
const STANCE = 0.58;         // share of a step in which the foot stands

// A piece of motion, relative to where its first frame stands: poses [joints, 3] at `frameRate`.
class Clip {
  constructor(body, poses, frameRate) {
    this.frameRate = frameRate;
    const first = body.place(poses[0]);
    this.poses = poses.map((pose) => unplaced(pose, first));
    // How far hands and feet come forward, metres.
    const limbs = body.sides.flatMap(({foot, hands}) => [foot, ...hands]).filter((joint) => joint >= 0);
    this.reach = Math.max(...this.poses.flatMap((pose) => limbs.map((joint) => body.at(pose, joint)[2])));
  }

  get seconds() { return (this.poses.length - 1) / this.frameRate; }

  // The pose at a time, interpolated.
  at(seconds) {
    const length = this.poses.length - 1;
    const frame = clamp(seconds * this.frameRate, 0, length);
    const before = Math.min(Math.floor(frame), length - 1);
    const [a, b] = [this.poses[before], this.poses[before + 1]];
    return a.map((value, i) => mix(value, b[i], frame - before));
  }
}

class Leader {
  // `rest`: a standing pose, [joints, 3].
  constructor(body, rest) {
    this.body = body;
    this.rest = unplaced(rest, body.place(rest));
    this.root = {x: 0, z: 0, yaw: 0};
    this.time = 0;
    this.step = 0;               // phase of the steps
    this.speed = this.spin = 0;  // forward in metres a second, to the left in radians a second
    this.wanted = {forward: 0, left: 0};  // -1 to 1, by keys
    this.backs = false;                   // steps back, whatever the keys want
    this.clip = null;
    this.clipTime = 0;
    this.offset = new Float32Array(this.rest.length);  // from what it does to what it shows
    this.offsetTime = BLEND_SECONDS;
    this.shown = this.source();
    this.pose = placed(this.shown, this.root);  // in the world, Float32Array [joints, 3]
  }

  // Starts a clip, or ends one with null, blended.
  play(clip) {
    if (this.clip) this.root = placeWithin(this.root, {...this.body.place(this.source()), yaw: 0});
    this.clip = clip;
    this.clipTime = 0;
    this.rebase(this.pose);
  }

  // Continues from a pose in the world, and forgets it within BLEND_SECONDS.
  rebase(world) {
    const now = unplaced(world, this.root);
    this.offset = this.source().map((value, i) => now[i] - value);
    this.offsetTime = 0;
  }

  advance(seconds) {
    this.time += seconds;
    this.walk(seconds);
    if (this.clip) {
      this.clipTime += seconds;
      if (this.clipTime >= this.clip.seconds) this.ended?.();
    }
    this.offsetTime += seconds;
    const left = 1 - smooth(this.offsetTime / BLEND_SECONDS);
    this.shown = this.source();
    if (left > 0) this.shown = this.shown.map((value, i) => value + this.offset[i] * left);
    this.pose = placed(this.shown, this.root);
  }

  walk(seconds) {
    const {forward, left} = this.backs ? {forward: -1, left: 0} : this.wanted;
    const ease = 1 - Math.exp(-seconds / EASE_SECONDS);
    const still = this.clip ? 0 : 1;
    this.speed = mix(this.speed, still * forward * (forward > 0 ? WALK_SPEED : BACK_SPEED), ease);
    this.spin = mix(this.spin, still * left * TURN_SPEED, ease);
    this.root.yaw += this.spin * seconds;
    this.root.x += Math.sin(this.root.yaw) * this.speed * seconds;
    this.root.z += Math.cos(this.root.yaw) * this.speed * seconds;
    if (this.effort > 0.02) this.step = (this.step + seconds / STEP_SECONDS) % 1;
  }

  // From 0, standing, to 1, walking.
  get effort() {
    return clamp(Math.abs(this.speed) / 0.5 + Math.abs(this.spin) / 1.2, 0, 1);
  }

  // What it does now, relative to its root.
  source() {
    return this.clip ? this.clip.at(this.clipTime) : this.locomotion();
  }

  locomotion() {
    const {body, rest, effort} = this;
    const pose = rest.slice();
    const turn = 2 * Math.PI;
    this.breathe(pose, 1 - effort);
    const beat = Math.sin(turn * this.step);
    body.shift(pose, [-0.022 * effort * beat, 0.016 * effort * Math.cos(2 * turn * this.step) - 0.022 * effort,
                      0.03 * this.speed]);
    body.sides.forEach((side, i) => {
      const phase = (this.step + 0.5 * i) % 1;
      const {along, lift} = this.footOf(phase);
      for (const joint of [side.foot, side.toe]) {
        if (joint < 0) continue;
        const place = body.at(pose, joint);
        body.put(pose, joint, add(place, [0, lift * effort, along - 0.3 * effort * place[2]]));
      }
      this.swing(pose, side, Math.cos(turn * (phase - 0.05)) * clamp(this.speed, -1, 1) * 0.42);
    });
    const twist = turning([0, 1, 0], 0.07 * clamp(this.speed, -1, 1) * Math.cos(turn * this.step));
    body.turn(pose, body.upper, body.hips(pose), twist);
    for (const side of body.sides) body.reach(pose, side, rest);
    return pose;
  }

  // The foot's way along the walk and its height, metres: back with the floor, then forward.
  footOf(phase) {
    const reach = this.speed * STANCE * STEP_SECONDS / 2;
    if (phase < STANCE) return {along: mix(reach, -reach, phase / STANCE), lift: 0};
    const share = (phase - STANCE) / (1 - STANCE);
    return {along: mix(-reach, reach, smooth(share)), lift: 0.085 * Math.sin(Math.PI * share)};
  }

  // Swings an arm about its shoulder and bends its elbow a little.
  swing(pose, {shoulder, elbow, hands}, angle) {
    const {body} = this;
    body.turn(pose, [elbow, ...hands], body.at(pose, shoulder), turning([1, 0, 0], angle));
    const bend = turning([1, 0, 0], -0.25 * Math.abs(angle) - 0.12 * this.effort);
    body.turn(pose, hands, body.at(pose, elbow), bend);
  }

  // Breath, and the weight from foot to foot.
  breathe(pose, share) {
    const {body, time} = this;
    const breath = Math.sin(time * 1.7) * share;
    const sway = (Math.sin(time * 0.55) + 0.4 * Math.sin(time * 0.31 + 1)) * share;
    body.shift(pose, [0.02 * sway, -0.004 - 0.003 * breath, 0.005 * Math.sin(time * 0.7) * share]);
    const above = body.upper.filter((joint) => joint !== body.waist);
    body.moveAll(pose, above, (place) => add(place, [0, 0.006 * breath, -0.003 * breath]));
    body.turn(pose, body.upper, body.hips(pose), turning([0, 1, 0], 0.035 * Math.sin(time * 0.43) * share));
    for (const {shoulder, elbow, hands} of body.sides) {
      body.turn(pose, [elbow, ...hands], body.at(pose, shoulder), turning([1, 0, 0], -0.03 - 0.03 * breath));
    }
  }
}

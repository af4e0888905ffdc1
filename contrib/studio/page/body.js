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

  // Bends hips and waist by radians, forward and to the left.
  bend(pose, forward, left) {
    const hips = this.hips(pose);
    const rotate = (share) => {
      const [a, b] = [turning([1, 0, 0], forward * share), turning([0, 0, 1], -left * share)];
      return (v) => b(a(v));
    };
    this.turn(pose, this.upper, hips, rotate(0.5));
    const above = this.upper.filter((joint) => joint !== this.waist);
    this.turn(pose, above, this.at(pose, this.waist), rotate(0.5));
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

// As kUsualAnkleHeight in model/retargeting/foot_pose.h, metres.
const USUAL_ANKLE_HEIGHT = 0.06;

const ALIASES = {torso: 'spine', left_foot: 'left_ankle', right_foot: 'right_ankle'};

// The motion of one character or two. Pages contain positions [frames, joints, 3] in metres, y up,
// as base64 of little-endian float32.
class Motion {
  constructor(data) {
    this.joints = data.joints;
    this.bones = data.bones;
    this.frameRate = data.frameRate;
    this.frames = data.frames;
    this.classes = data.classes || [];
    this.keyframes = data.keyframes || [];
    this.people = {};
    for (const name of ['leader', 'follower']) {
      if (data[name]) this.people[name] = Motion.decode(data[name]);
    }
    for (const [name, positions] of Object.entries(this.people)) {
      if (positions.length !== this.frames * this.joints.length * 3) {
        throw new Error(`${name}: expected ${this.frames} × ${this.joints.length} × 3 values, ` +
                        `got ${positions.length}`);
      }
    }
  }

  // Makes a Motion from a Motion, from the constructor's argument, or from the content of a
  // "duet-motion" JSON file (docs/formats.md) in metres, y up.
  static of(data) {
    if (data instanceof Motion) return data;
    if (!data || data.format !== 'duet-motion') return new Motion(data);
    if ((data.unit || 'metres') !== 'metres' || (data.up_axis || 'y-up') !== 'y-up') {
      throw new Error(`expected metres, y-up, got ${data.unit}, ${data.up_axis}`);
    }
    if (!data.leader || !data.joint_names || !(data.frame_rate_hz > 0)) {
      throw new Error('expected joint_names, frame_rate_hz and leader, got an object without them');
    }
    const flat = (frames) => frames && Float32Array.from(frames.flat(2));
    return new Motion({joints: data.joint_names, bones: data.bones || [],
                       frameRate: data.frame_rate_hz, frames: data.leader.length,
                       leader: flat(data.leader), follower: flat(data.follower)});
  }

  // Base64 of little-endian float32, or the values themselves.
  static decode(base64) {
    if (base64 instanceof Float32Array) return base64;
    const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
    const view = new DataView(bytes.buffer);
    const values = new Float32Array(bytes.length / 4);
    for (let i = 0; i < values.length; ++i) values[i] = view.getFloat32(4 * i, true);
    return values;
  }

  // Seconds from the first frame to the last.
  get duration() {
    return (this.frames - 1) / this.frameRate;
  }

  // A joint's index by name, or -1. Skeletons with more joints name some of them otherwise.
  find(joint) {
    const index = this.joints.indexOf(joint);
    return index < 0 && joint in ALIASES ? this.joints.indexOf(ALIASES[joint]) : index;
  }

  // Writes the pose at a fractional frame into `out` [joints] of THREE.Vector3.
  pose(person, frame, out) {
    const positions = this.people[person];
    const stride = this.joints.length * 3;
    const before = Math.min(Math.floor(frame), this.frames - 1);
    const after = Math.min(before + 1, this.frames - 1);
    const t = frame - before;
    for (let joint = 0; joint < this.joints.length; ++joint) {
      const a = before * stride + joint * 3;
      const b = after * stride + joint * 3;
      out[joint].set(positions[a] + (positions[b] - positions[a]) * t,
                     positions[a + 1] + (positions[b + 1] - positions[a + 1]) * t,
                     positions[a + 2] + (positions[b + 2] - positions[a + 2]) * t);
    }
  }

  // Class weights at a frame: linear between keyframes, constant before the first and after the
  // last.
  weights(frame) {
    const keys = this.keyframes;
    if (keys.length === 0) return [];
    let next = keys.findIndex((key) => key.frame > frame);
    if (next === 0) return keys[0].weights;
    if (next < 0) return keys[keys.length - 1].weights;
    const [a, b] = [keys[next - 1], keys[next]];
    const t = (frame - a.frame) / (b.frame - a.frame);
    return a.weights.map((weight, i) => weight + (b.weights[i] - weight) * t);
  }

  // The box around both characters over all frames.
  bounds() {
    const box = new THREE.Box3();
    const point = new THREE.Vector3();
    for (const positions of Object.values(this.people)) {
      for (let i = 0; i < positions.length; i += 3) {
        box.expandByPoint(point.fromArray(positions, i));
      }
    }
    return box;
  }

  // The root of the skeleton, or the first joint.
  get root() {
    return Math.max(0, this.find('torso'));
  }

  // Where a camera that tracks the characters looks, in each frame: the middle between their roots, averaged
  // over half a second before and after it, so that steps do not shake the picture. Each is [x, z], metres.
  path() {
    const people = Object.values(this.people);
    const at = (frame, axis) => people.reduce((sum, positions) => sum +
        positions[(frame * this.joints.length + this.root) * 3 + axis], 0) / people.length;
    const reach = Math.round(this.frameRate / 2);
    const middles = Array.from({length: this.frames}, (_, frame) => [at(frame, 0), at(frame, 2)]);
    return middles.map((_, frame) => {
      const near = middles.slice(Math.max(0, frame - reach), frame + reach + 1);
      return [0, 1].map((axis) => near.reduce((sum, middle) => sum + middle[axis], 0) / near.length);
    });
  }

  // Every joint of both characters in about 500 frames of all; from a path, if one is given.
  points(path = null) {
    const joints = this.joints.length;
    const step = Math.max(1, Math.floor(this.frames / 500));
    const points = [];
    for (const positions of Object.values(this.people)) {
      for (let frame = 0; frame < this.frames; frame += step) {
        const [x, z] = path ? path[frame] : [0, 0];
        for (let i = frame * joints * 3; i < (frame + 1) * joints * 3; i += 3) {
          points.push(new THREE.Vector3(positions[i] - x, positions[i + 1], positions[i + 2] - z));
        }
      }
    }
    return points;
  }

  // The floor is the world's, y = 0, so that a floating character is visible. If that is far away,
  // the capture has no floor: the floor is then under the leader's feet, and `ofWorld` is false.
  floor() {
    const stands = this.standingHeight('leader');
    const ofWorld = Math.abs(stands) < 0.6;
    return {height: ofWorld ? 0 : stands - USUAL_ANKLE_HEIGHT, ofWorld};
  }

  // The height of a person's ankles above the soles, metres, so that a standing person touches the
  // floor.
  soleDepth(person) {
    const feet = [this.find('left_foot'), this.find('right_foot')].filter((joint) => joint >= 0);
    const depth = this.lowOf(person, feet) - this.floor().height;
    return depth >= 0.01 && depth <= 0.25 ? depth : USUAL_ANKLE_HEIGHT;
  }

  // The lowest joint of nearly every frame; robust against single bad frames.
  standingHeight(person) {
    return this.lowOf(person, this.joints.map((name, joint) => joint));
  }

  // The 2nd percentile of the height of the lowest of some joints.
  lowOf(person, joints) {
    const positions = this.people[person];
    const stride = this.joints.length * 3;
    const lowest = [];
    for (let start = 0; start < positions.length; start += stride) {
      lowest.push(Math.min(...joints.map((joint) => positions[start + joint * 3 + 1])));
    }
    lowest.sort((a, b) => a - b);
    return lowest[Math.floor(lowest.length * 0.02)];
  }

  // A person's mean position over the clip.
  centre(person) {
    const positions = this.people[person];
    const sum = new THREE.Vector3();
    const point = new THREE.Vector3();
    for (let i = 0; i < positions.length; i += 3) sum.add(point.fromArray(positions, i));
    return sum.multiplyScalar(3 / positions.length);
  }

  // Horizontal direction from the leader to the follower; for one person, the direction of the
  // hips; +z if there is none.
  axis() {
    const axis = this.people.follower ? this.centre('follower').sub(this.centre('leader'))
                                      : this.facing();
    axis.setY(0);
    return axis.length() < 0.05 ? new THREE.Vector3(0, 0, 1) : axis.normalize();
  }

  // The direction of the leader's hips in the first frame; zero without hips.
  facing() {
    const [left, right] = [this.find('left_hip'), this.find('right_hip')];
    if (left < 0 || right < 0) return new THREE.Vector3();
    const at = (joint) => new THREE.Vector3().fromArray(this.people.leader, joint * 3);
    return new THREE.Vector3(0, 1, 0).cross(at(right).sub(at(left)));
  }
}

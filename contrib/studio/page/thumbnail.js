'use strict';
// Small moving pictures of answers, drawn with lines. (A browser has few WebGL contexts.)
const THICKNESS = [  // metres
  [/head/, 0.1], [/shoulder|neck|hip|torso|spine|chest/, 0.15], [/knee/, 0.13], [/foot|ankle|toe/, 0.1],
  [/elbow/, 0.095], [/hand|wrist/, 0.08],
];
const HEAD_METRES = 0.12;
const THUMBNAIL_COLOURS = {leader: '#f0a04b', follower: '#4fb3bf'};
const MARGIN_METRES = 0.16;

// A camera far away that sees all answers from the side, a little from above, with the leader left
// if that is where the first answer puts it. `people`: Float32Arrays of the same joints.
class ThumbnailView {
  constructor(leader, answers) {
    const [from, to] = [leader, answers[0]].map(ThumbnailView.centre);
    let [x, z] = [to[0] - from[0], to[2] - from[2]];
    const length = Math.hypot(x, z);
    [x, z] = length > 0.05 ? [x / length, z / length] : [0, 1];
    // Towards the camera: across the line between the people, as the scene's first view.
    const d = [-z * 0.82 - x * 0.42, 0.3, x * 0.82 - z * 0.42];
    const size = Math.hypot(...d);
    this.towards = d.map((value) => value / size);
    const [dx, dy, dz] = this.towards;
    const flat = Math.hypot(dx, dz);
    this.right = [dz / flat, 0, -dx / flat];
    this.up = [-dy * dx / flat, flat, -dy * dz / flat];
    this.fit([leader, ...answers]);
  }

  static centre(positions) {
    const sum = [0, 0, 0];
    for (let i = 0; i < positions.length; ++i) sum[i % 3] += positions[i];
    return sum.map((value) => value * 3 / positions.length);
  }

  // The position on the picture's plane and the depth, metres.
  see(positions, i) {
    const dot = (axis) => positions[i] * axis[0] + positions[i + 1] * axis[1] +
        positions[i + 2] * axis[2];
    return [dot(this.right), dot(this.up), dot(this.towards)];
  }

  fit(people) {
    this.box = [Infinity, Infinity, -Infinity, -Infinity];
    this.floor = Infinity;
    for (const positions of people) {
      for (let i = 0; i < positions.length; i += 3) {
        const [x, y] = this.see(positions, i);
        this.floor = Math.min(this.floor, positions[i + 1]);
        this.box = [Math.min(this.box[0], x), Math.min(this.box[1], y), Math.max(this.box[2], x),
                    Math.max(this.box[3], y)];
      }
    }
    this.box = this.box.map((value, i) => value + (i < 2 ? -MARGIN_METRES : MARGIN_METRES));
  }
}

class Thumbnail {
  constructor(canvas, view, {joint_names: joints, positions: leader}, follower, bones) {
    Object.assign(this, {canvas, view, joints, bones, people: {leader, follower}});
    const width = (name) => (THICKNESS.find(([pattern]) => pattern.test(name)) ?? [0, 0.08])[1];
    this.widths = bones.map(([, child]) => width(joints[child]));
    this.head = joints.indexOf('head');
    this.sides = ['left_shoulder', 'right_shoulder', 'right_hip', 'left_hip']
        .map((name) => joints.indexOf(name));
  }

  draw(frame) {
    const {canvas, view} = this;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [canvas.clientWidth * ratio, canvas.clientHeight * ratio].map(Math.round);
    if (!width || !height) return;
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
    const paint = canvas.getContext('2d');
    const [left, bottom, right, top] = view.box;
    const scale = Math.min(width / (right - left), height / (top - bottom));
    this.scale = scale;
    this.place = ([x, y]) => [width / 2 + (x - (left + right) / 2) * scale,
                              height / 2 - (y - (bottom + top) / 2) * scale];
    paint.clearRect(0, 0, width, height);
    paint.lineCap = paint.lineJoin = 'round';
    const at = Math.max(0, Math.round(frame)) * this.joints.length * 3;
    const strokes = Object.keys(this.people).flatMap((person) => {
      this.shade(paint, person, at);
      return this.strokesOf(person, at);
    });
    for (const stroke of strokes.sort((a, b) => a.depth - b.depth)) stroke.draw(paint);
  }

  // A shadow on the floor below the middle of a person.
  shade(paint, person, at) {
    const positions = this.people[person];
    const root = [positions[at + this.sides[2] * 3], this.view.floor,
                  positions[at + this.sides[2] * 3 + 2]];
    if (!Number.isFinite(root[0])) return;
    const [x, y] = this.place(this.view.see(root, 0));
    paint.fillStyle = 'rgba(0, 0, 0, .28)';
    paint.beginPath();
    paint.ellipse(x, y, 0.32 * this.scale, 0.1 * this.scale, 0, 0, 2 * Math.PI);
    paint.fill();
  }

  strokesOf(person, at) {
    const positions = this.people[person];
    const see = (joint) => this.view.see(positions, at + joint * 3);
    const colour = THUMBNAIL_COLOURS[person];
    const line = (points, metres, depth, fill) => ({
      depth,
      draw: (paint) => {
        paint.beginPath();
        points.forEach((point, i) => paint[i ? 'lineTo' : 'moveTo'](...this.place(point)));
        if (fill) paint.closePath();
        // A dark edge separates limbs.
        for (const [style, more] of [['rgba(20, 22, 26, .75)', 0.03], [colour, 0]]) {
          paint.strokeStyle = paint.fillStyle = style;
          paint.lineWidth = (metres + more) * this.scale;
          if (fill) paint.fill();
          paint.stroke();
        }
      },
    });
    const strokes = this.bones.map(([parent, child], i) => {
      const ends = [see(parent), see(child)];
      return line(ends, this.widths[i], (ends[0][2] + ends[1][2]) / 2, false);
    });
    if (Math.min(...this.sides) >= 0) {
      const corners = this.sides.map(see);
      strokes.push(line(corners, 0.1, corners.reduce((sum, [, , z]) => sum + z / 4, 0.02), true));
    }
    if (this.head >= 0) {
      const [x, y, depth] = see(this.head);
      strokes.push(line([[x, y], [x, y + 1e-3]], 2 * HEAD_METRES, depth, false));
    }
    return strokes;
  }
}

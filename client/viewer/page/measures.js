// Optional measures: a line where the characters are nearest, a ring under every standing foot, and
// the values as text.
class Measures {
  constructor(stage, motion, output) {
    this.motion = motion;
    this.output = output;
    this.floor = stage.scenery.floor;
    this.floorOfWorld = motion.floor().ofWorld;
    this.group = new THREE.Group();
    this.group.visible = false;
    stage.scene.add(this.group);
    this.line = new THREE.Line(
        new THREE.BufferGeometry().setFromPoints([new THREE.Vector3(), new THREE.Vector3(0, 1, 0)]),
        new THREE.LineBasicMaterial({color: 0xffffff, depthTest: false}));
    this.line.frustumCulled = false;
    this.line.renderOrder = 1;
    this.group.add(this.line);
    this.rings = ['leader', 'follower'].flatMap((person) => ['left_foot', 'right_foot']
        .filter((joint) => motion.people[person] && motion.find(joint) >= 0)
        .map((joint) => this.addRing(person, motion.find(joint))));
  }

  // Metres: the largest distance of joints in contact, and the largest height of a standing ankle.
  static get TOUCH() { return 0.15; }
  static get STANDS() { return 0.13; }
  // Metres per second: the largest speed of a standing foot.
  static get SLOW() { return 0.5; }

  addRing(person, joint) {
    const mesh = new THREE.Mesh(new THREE.RingBufferGeometry(0.11, 0.135, 40),
                                new THREE.MeshBasicMaterial({color: linear(COLOURS[person])}));
    mesh.rotation.x = -Math.PI / 2;
    this.group.add(mesh);
    return {person, joint, mesh};
  }

  get shown() { return this.group.visible; }

  toggle() {
    this.group.visible = !this.group.visible;
    this.output.hidden = !this.group.visible;
    return this.group.visible;
  }

  at(person, frame) {
    const pose = this.motion.joints.map(() => new THREE.Vector3());
    this.motion.pose(person, Math.min(Math.max(frame, 0), this.motion.frames - 1), pose);
    return pose;
  }

  // The nearest two joints.
  static nearest(a, b) {
    let best = {distance: Infinity};
    a.forEach((p, i) => b.forEach((q, j) => {
      const distance = p.distanceTo(q);
      if (distance < best.distance) best = {distance, i, j};
    }));
    return best;
  }

  update(frame) {
    if (!this.shown) return;
    const texts = [];
    const poses = {leader: this.at('leader', frame)};
    if (this.motion.people.follower) {
      poses.follower = this.at('follower', frame);
      texts.push(this.updateLine(poses));
    }
    const standing = this.updateRings(poses, frame);
    for (const person of Object.keys(poses)) {
      const low = Math.min(...poses[person].map(({y}) => y)) - this.floor;
      const feet = standing[person] === 1 ? '1 foot' : `${standing[person] || 'no'} feet`;
      texts.push(`${person}: ${feet} down, lowest joint ${(100 * low).toFixed(0)} cm above the floor`);
    }
    if (!this.floorOfWorld) texts.push('floor put under the leader: the world has none');
    this.output.replaceChildren(...texts.map((text) => {
      const line = document.createElement('p');
      line.textContent = text;
      return line;
    }));
  }

  updateLine({leader, follower}) {
    const {distance, i, j} = Measures.nearest(leader, follower);
    this.line.geometry.setFromPoints([leader[i], follower[j]]);
    const touch = distance < Measures.TOUCH;
    this.line.material.color.set(touch ? 0xff5a4a : 0xffffff);
    const name = (joint) => this.motion.joints[joint].replace(/_/g, ' ');
    return `${touch ? 'touch' : 'nearest'}: ${name(i)} to ${name(j)}, ${distance.toFixed(2)} m`;
  }

  // A foot stands if it is low and slow. Returns the number of standing feet of each person.
  updateRings(poses, frame) {
    const before = {};
    for (const person of Object.keys(poses)) before[person] = this.at(person, frame - 1);
    const standing = {};
    for (const {person, joint, mesh} of this.rings) {
      const at = poses[person][joint];
      const speed = at.distanceTo(before[person][joint]) * this.motion.frameRate;
      mesh.visible = at.y - this.floor < Measures.STANDS && speed < Measures.SLOW;
      mesh.position.set(at.x, this.floor + 0.006, at.z);
      standing[person] = (standing[person] || 0) + (mesh.visible ? 1 : 0);
    }
    return standing;
  }
}

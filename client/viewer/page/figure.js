// Half the height of a foot, metres.
const THINNEST_SOLE = 0.015, THICKEST_SOLE = 0.05;

// A character's body: a tapered capsule for each bone and a ball for each joint. If the joint names
// are known, also a chest, a pelvis and a head that show which way the character faces.
class Figure {
  constructor(motion, person, colour) {
    this.motion = motion;
    this.person = person;
    this.group = new THREE.Group();
    this.pose = motion.joints.map(() => new THREE.Vector3());
    this.skin = new THREE.MeshStandardMaterial({color: linear(colour), roughness: 0.62, metalness: 0});
    this.jointSkin = this.skin.clone();
    this.jointSkin.color.multiplyScalar(0.72);
    this.soleDepth = motion.soleDepth(person);
    this.radii = motion.joints.map((name) => this.radius(name));
    this.bones = motion.bones.map(([parent, child]) => this.addBone(parent, child));
    this.balls = motion.joints.map((name, joint) => this.addBall(joint));
    this.addTrunk();
    this.addHead();
    for (const side of ['left', 'right']) {
      this.addHand(side);
      this.addFoot(side);
    }
    // The bounding box changes with the pose.
    this.group.traverse((object) => { object.frustumCulled = false; });
  }

  // Radii in metres by joint name; joints with unknown names get slender limbs.
  static radius(name) {
    const table = [
      [/head_top/, 0.02], [/head/, 0.05], [/neck/, 0.047], [/shoulder|clavicle/, 0.052], [/elbow/, 0.041],
      [/hand|wrist/, 0.036], [/torso|spine|chest/, 0.066], [/hip|pelvis|root/, 0.072],
      [/knee/, 0.054], [/foot|ankle|toe/, 0.043],
    ];
    const row = table.find(([pattern]) => pattern.test(name.toLowerCase()));
    return row ? row[1] : 0.035;
  }

  // Keeps the ankle's ball above the floor.
  radius(name) {
    const radius = Figure.radius(name);
    return /foot|ankle/.test(name.toLowerCase())
        ? Math.min(radius, Math.max(this.soleDepth, THINNEST_SOLE)) : radius;
  }

  addMesh(geometry, material) {
    const mesh = new THREE.Mesh(geometry, material);
    mesh.castShadow = true;
    mesh.receiveShadow = true;
    this.group.add(mesh);
    return mesh;
  }

  addBone(parent, child) {
    const geometry = new THREE.CylinderBufferGeometry(
        this.radii[child] * 0.94, this.radii[parent] * 0.94, 1, 20, 1, true);
    geometry.translate(0, 0.5, 0);
    return {parent, child, mesh: this.addMesh(geometry, this.skin)};
  }

  addBall(joint) {
    return this.addMesh(new THREE.SphereBufferGeometry(this.radii[joint], 20, 14), this.jointSkin);
  }

  // An ellipsoid placed by `place`, which returns {centre, right, up, size} or null.
  addEllipsoid(material, place) {
    const mesh = this.addMesh(new THREE.SphereBufferGeometry(1, 32, 22), material);
    this.ellipsoids = (this.ellipsoids || []).concat({mesh, place});
  }

  joint(name) {
    const index = this.motion.find(name);
    return index < 0 ? null : this.pose[index];
  }

  has(...names) {
    return names.every((name) => this.motion.find(name) >= 0);
  }

  addTrunk() {
    const middle = (a, b, t = 0.5) => a.clone().lerp(b, t);
    if (this.has('left_shoulder', 'right_shoulder', 'neck', 'torso')) {
      this.addEllipsoid(this.skin, () => {
        const [left, right] = [this.joint('left_shoulder'), this.joint('right_shoulder')];
        const [neck, torso] = [this.joint('neck'), this.joint('torso')];
        const height = neck.distanceTo(torso);
        return {
          centre: middle(middle(left, right), torso, 0.42),
          right: right.clone().sub(left),
          up: neck.clone().sub(torso),
          size: [left.distanceTo(right) * 0.47, height * 0.66, 0.105],
        };
      });
    }
    if (this.has('left_hip', 'right_hip', 'torso')) {
      this.addEllipsoid(this.skin, () => {
        const [left, right] = [this.joint('left_hip'), this.joint('right_hip')];
        const torso = this.joint('torso');
        const hips = middle(left, right);
        return {
          centre: middle(hips, torso, 0.16),
          right: right.clone().sub(left),
          up: torso.clone().sub(hips),
          size: [left.distanceTo(right) * 0.5 + 0.062, 0.12, 0.1],
        };
      });
      this.addEllipsoid(this.skin, () => {
        const [left, right] = [this.joint('left_hip'), this.joint('right_hip')];
        const torso = this.joint('torso');
        const hips = middle(left, right);
        return {
          centre: middle(hips, torso, 0.62),
          right: right.clone().sub(left),
          up: torso.clone().sub(hips),
          size: [left.distanceTo(right) * 0.34 + 0.05, torso.distanceTo(hips) * 0.75, 0.088],
        };
      });
    }
  }

  // A skull, and a dark visor where the face is: the direction across the hips or the shoulders.
  addHead() {
    if (!this.has('head', 'neck')) return;
    const sides = [['left_shoulder', 'right_shoulder'], ['left_hip', 'right_hip']]
                      .find(([left, right]) => this.has(left, right));
    const frame = () => {
      const [head, neck] = [this.joint('head'), this.joint('neck')];
      const right = sides ? this.joint(sides[1]).clone().sub(this.joint(sides[0]))
                          : new THREE.Vector3(1, 0, 0);
      return {centre: head.clone(), right, up: head.clone().sub(neck), size: [0.088, 0.118, 0.102]};
    };
    this.addEllipsoid(this.skin, frame);
    if (!sides) return;
    const visor = new THREE.MeshStandardMaterial({color: linear(0x1b1d22), roughness: 0.25, metalness: 0.1});
    this.addEllipsoid(visor, () => {
      const place = frame();
      const forward = place.up.clone().cross(place.right).normalize();
      place.centre.addScaledVector(forward, 0.036)
          .addScaledVector(place.up.clone().normalize(), 0.014);
      place.size = [0.074, 0.042, 0.074];
      return place;
    });
  }

  // Continues the forearm.
  addHand(side) {
    const [elbow, hand] = [`${side}_elbow`, `${side}_hand`];
    if (!this.has(elbow, hand)) return;
    this.addEllipsoid(this.skin, () => {
      const up = this.joint(hand).clone().sub(this.joint(elbow)).normalize();
      return {centre: this.joint(hand).clone().addScaledVector(up, 0.06), right: Figure.across(up), up,
              size: [0.042, 0.085, 0.022]};
    });
  }

  // In front of the ankle: at a right angle to the shin in the air, level on the floor.
  addFoot(side) {
    const [knee, foot] = [`${side}_knee`, `${side}_foot`];
    if (!this.has(knee, foot, 'left_hip', 'right_hip')) return;
    const floor = this.motion.standingHeight(this.person);
    const half = Math.min(Math.max(this.soleDepth / 2, THINNEST_SOLE), THICKEST_SOLE);
    this.addEllipsoid(this.skin, () => {
      const ankle = this.joint(foot);
      const shin = this.joint(knee).clone().sub(ankle).normalize();
      const raised = THREE.Math.smoothstep(ankle.y - floor, 0.03, 0.18);
      const upright = THREE.Math.smoothstep(shin.y, 0.1, 0.6);
      const up = new THREE.Vector3(0, 1, 0).lerp(shin, 1 - (1 - raised) * upright).normalize();
      const right = this.joint('right_hip').clone().sub(this.joint('left_hip'));
      const ahead = up.clone().cross(right).normalize();
      return {centre: ankle.clone().addScaledVector(ahead, 0.07).addScaledVector(up, half - this.soleDepth),
              right: ahead.clone().cross(up), up, size: [0.046, half, 0.13]};
    });
  }

  // Any direction perpendicular to another.
  static across(along) {
    const axis = Math.abs(along.y) < 0.8 ? new THREE.Vector3(0, 1, 0) : new THREE.Vector3(1, 0, 0);
    return axis.cross(along).normalize();
  }

  // Sets the pose of a fractional frame.
  update(frame) {
    this.motion.pose(this.person, frame, this.pose);
    const up = new THREE.Vector3(0, 1, 0);
    for (const {parent, child, mesh} of this.bones) {
      const along = this.pose[child].clone().sub(this.pose[parent]);
      const length = along.length();
      mesh.position.copy(this.pose[parent]);
      mesh.scale.set(1, Math.max(length, 1e-4), 1);
      if (length > 1e-6) mesh.quaternion.setFromUnitVectors(up, along.divideScalar(length));
    }
    this.balls.forEach((ball, joint) => ball.position.copy(this.pose[joint]));
    for (const {mesh, place} of this.ellipsoids || []) Figure.orient(mesh, place());
  }

  static orient(mesh, {centre, right, up, size}) {
    const y = up.clone().normalize();
    const z = right.clone().cross(up).normalize();
    const x = y.clone().cross(z);
    mesh.position.copy(centre);
    mesh.scale.set(size[0], size[1], size[2]);
    if (x.lengthSq() > 0.5) {
      mesh.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(x, y, z));
    }
  }
}

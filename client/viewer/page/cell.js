// One motion of a gallery in its own scenery, with its transform to the space that all cells share.
// In that space the leader starts at the origin and the follower is along +z.
class Cell {
  constructor(data, renderer) {
    this.name = data.name;
    this.motion = new Motion(data);
    this.scenery = new Scenery(this.motion, renderer, 1024);
    this.people = {};
    for (const name of Object.keys(this.motion.people)) {
      const figure = new Figure(this.motion, name, COLOURS[name]);
      this.scenery.scene.add(figure.group);
      this.people[name] = {figure, path: this.scenery.addPath(name, COLOURS[name])};
    }
    this.start = new THREE.Vector3().fromArray(this.motion.people.leader, this.motion.root * 3)
        .setY(this.scenery.floor);
    const axis = this.motion.axis();
    this.yaw = Math.atan2(axis.x, axis.z);
  }

  // Answers to one leader, and takes of one place, keep their relative positions.
  shareWorld(other) {
    const turned = Math.abs(Math.atan2(Math.sin(this.yaw - other.yaw), Math.cos(this.yaw - other.yaw)));
    const [mine, its] = [this.motion.facing(), other.motion.facing()];
    const sameFacing = mine.length() > 0 && its.length() > 0 && mine.angleTo(its) < 0.35;
    if (this.start.distanceTo(other.start) > 0.25 || !(sameFacing || turned < 0.35)) return;
    this.start = other.start;
    this.yaw = other.yaw;
  }

  // The box around the motion in the shared space.
  sharedBox() {
    const box = new THREE.Box3();
    const {min, max} = this.scenery.box;
    for (let corner = 0; corner < 8; ++corner) {
      const point = new THREE.Vector3(corner & 1 ? max.x : min.x, corner & 2 ? max.y : min.y,
                                      corner & 4 ? max.z : min.z).sub(this.start);
      box.expandByPoint(point.applyAxisAngle(new THREE.Vector3(0, 1, 0), -this.yaw));
    }
    return box;
  }

  // Shows the pose at a time; holds the last one after the end.
  update(seconds) {
    const frame = Math.min(seconds * this.motion.frameRate, this.motion.frames - 1);
    for (const {figure} of Object.values(this.people)) figure.update(frame);
  }

  show(person, visible) {
    if (!this.people[person]) return;
    this.people[person].figure.group.visible = this.people[person].path.visible = visible;
  }
}

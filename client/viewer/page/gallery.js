// All cells on one canvas, seen by one camera in the space that they share.
class Gallery {
  constructor(canvas, data) {
    this.canvas = canvas;
    this.renderer = makeRenderer(canvas);
    this.renderer.setScissorTest(true);
    this.renderer.info.autoReset = false;
    this.cells = data.motions.map((motion) => new Cell(
        {...motion, joints: data.joints, bones: data.bones}, this.renderer));
    for (const cell of this.cells.slice(1)) cell.shareWorld(this.cells[0]);
    this.box = new THREE.Box3();
    for (const cell of this.cells) this.box.union(cell.sharedBox());
    this.camera = new THREE.PerspectiveCamera(32, 1, 0.05, 400);
    this.mount = new THREE.Group();  // the shared space within a cell
    this.eye = this.camera.clone();  // the camera there
    this.mount.add(this.eye);
    // One camera at the distance of the largest motion; the fog is scaled so that smaller ones stay
    // clear.
    const reach = this.box.getSize(new THREE.Vector3()).length();
    for (const cell of this.cells) cell.scenery.addFog(reach);
    this.controls = makeControls(this.camera, canvas, reach);
    this.labels = this.cells.map((cell) => this.addLabel(cell));
  }

  get duration() {
    return Math.max(...this.cells.map((cell) => cell.motion.duration));
  }

  addLabel(cell) {
    const label = document.createElement('div');
    label.className = 'label';
    const name = document.createElement('b');
    name.textContent = cell.name;
    const length = document.createElement('span');
    length.textContent = `${cell.motion.frames} frames at ${Number(cell.motion.frameRate.toFixed(2))} Hz`;
    label.append(name, length);
    this.canvas.parentElement.append(label);
    return label;
  }

  // The number of columns that brings the cells closest to the best aspect ratio.
  columns(width, height) {
    const count = this.cells.length;
    const wanted = 0.9;  // fits two people who stand face to face
    let best = 1;
    let least = Infinity;
    for (let columns = 1; columns <= count; ++columns) {
      const aspect = (width / columns) / (height / Math.ceil(count / columns));
      const waste = Math.ceil(count / columns) * columns / count;
      const badness = Math.abs(Math.log(aspect / wanted)) + Math.log(waste);
      if (badness < least) [best, least] = [columns, badness];
    }
    return best;
  }

  resize() {
    const {clientWidth: width, clientHeight: height} = this.canvas;
    this.renderer.setSize(width, height, false);
    const columns = this.columns(width, height);
    const rows = Math.ceil(this.cells.length / columns);
    const gap = 2;
    this.cells.forEach((cell, i) => {
      const [column, row] = [i % columns, Math.floor(i / columns)];
      const left = Math.round(width * column / columns);
      const right = Math.round(width * (column + 1) / columns) - (column + 1 < columns ? gap : 0);
      const top = Math.round(height * row / rows) + (row > 0 ? gap : 0);
      const bottom = Math.round(height * (row + 1) / rows);
      cell.place = {x: left, y: height - bottom, width: right - left, height: bottom - top};
      Object.assign(this.labels[i].style,
                    {left: `${left + 12}px`, top: `${top + 10}px`, maxWidth: `${right - left - 24}px`});
    });
    const {width: w, height: h} = this.cells[0].place;
    this.camera.aspect = w / Math.max(1, h);
    this.camera.updateProjectionMatrix();
  }

  view(name) {
    const direction = viewDirection(name, new THREE.Vector3(0, 0, 1));
    const centre = this.box.getCenter(this.controls.target);
    this.camera.position.copy(centre).addScaledVector(
        direction, fittingDistance(cornersOf(this.box), centre, direction, this.camera));
    this.controls.update();
  }

  // Returns the number of triangles drawn.
  draw(seconds) {
    this.renderer.info.reset();
    this.eye.position.copy(this.camera.position);
    this.eye.quaternion.copy(this.camera.quaternion);
    for (const cell of this.cells) {
      cell.update(seconds);
      const {x, y, width, height} = cell.place;
      this.renderer.setViewport(x, y, width, height);
      this.renderer.setScissor(x, y, width, height);
      this.eye.aspect = width / Math.max(1, height);
      this.eye.updateProjectionMatrix();
      this.mount.position.copy(cell.start);
      this.mount.rotation.y = cell.yaw;
      this.mount.updateMatrixWorld(true);
      this.renderer.render(cell.scenery.scene, this.eye);
    }
    return this.renderer.info.render.triangles;
  }
}

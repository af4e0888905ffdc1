// Scenery and camera of one motion. Draws only on request.
class Stage {
  constructor(canvas, motion) {
    this.canvas = canvas;
    this.motion = motion;
    this.renderer = makeRenderer(canvas);
    this.scenery = new Scenery(motion, this.renderer, 2048);
    this.camera = new THREE.PerspectiveCamera(32, 1, 0.05, 400);
    this.controls = makeControls(this.camera, canvas, this.scenery.reach);
    this.moved = new THREE.Vector3();  // from the motion's own place
  }

  get scene() {
    return this.scenery.scene;
  }

  addPath(person, colour) {
    return this.scenery.addPath(person, colour);
  }

  // Moves the camera so that the whole motion is in view.
  view(name) {
    const direction = viewDirection(name, this.motion.axis());
    this.controls.target.copy(this.scenery.box.getCenter(new THREE.Vector3())).add(this.moved);
    this.camera.position.copy(this.controls.target)
        .addScaledVector(direction, fittingDistance(this.scenery.box, direction, this.camera));
    this.controls.update();
  }

  // Moves camera and lights from the middle of the motion to (x, z).
  moveTo(x, z) {
    const centre = this.scenery.box.getCenter(new THREE.Vector3());
    const by = new THREE.Vector3(x - centre.x, 0, z - centre.z).sub(this.moved);
    this.moved.add(by);
    for (const thing of [this.camera, ...this.scenery.lights]) thing.position.add(by);
    this.controls.target.add(by);
  }

  // Fits the picture to the canvas. Returns whether that changed its size.
  resize() {
    const {clientWidth, clientHeight} = this.canvas;
    if (clientWidth === this.width && clientHeight === this.height) return false;
    this.width = clientWidth;
    this.height = clientHeight;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / Math.max(1, clientHeight);
    this.camera.updateProjectionMatrix();
    return true;
  }

  // Returns the number of triangles drawn.
  draw() {
    this.renderer.render(this.scene, this.camera);
    return this.renderer.info.render.triangles;
  }
}

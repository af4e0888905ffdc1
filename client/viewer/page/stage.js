// Frees what an object of a scene holds of the renderer's memory. The renderer keeps a shader while another object uses it.
function release({geometry, material, shadow}) {
  const parts = [geometry, material, material && material.map, shadow && shadow.map];
  for (const part of parts.filter(Boolean)) part.dispose();
}

// Scenery and camera of one motion, which a renderer shows. Draws only on request.
class Stage {
  constructor(renderer, motion) {
    this.renderer = renderer;
    this.canvas = renderer.domElement;
    this.motion = motion;
    this.scenery = new Scenery(motion, renderer, 2048);
    this.camera = new THREE.PerspectiveCamera(32, 1, 0.05, 400);
    this.controls = makeControls(this.camera, this.canvas, this.scenery.reach);
    this.moved = new THREE.Vector3();  // from the motion's own place
    this.path = null;                  // while the camera tracks the characters: Motion.path()
  }

  // Whether the characters walk so far that they are small in a picture of the whole motion.
  get isFar() {
    const near = new THREE.Box3().setFromPoints(this.motion.points(this.motion.path()));
    return this.scenery.reach > 1.4 * near.getSize(new THREE.Vector3()).length();
  }

  // Lets the camera track the characters, or stay where all of the motion is in view.
  track(tracks) {
    this.path = tracks ? this.motion.path() : null;
    const centre = this.scenery.box.getCenter(new THREE.Vector3());
    if (!tracks) this.moveTo(centre.x, centre.z);
  }

  // Moves a camera that tracks the characters to where they are in a frame, a fraction.
  goTo(frame) {
    if (!this.path) return;
    const before = Math.floor(frame);
    const [x, z] = this.path[before];
    const [nextX, nextZ] = this.path[Math.min(before + 1, this.path.length - 1)];
    this.moveTo(x + (nextX - x) * (frame - before), z + (nextZ - z) * (frame - before));
  }


  get scene() {
    return this.scenery.scene;
  }

  addPath(person, colour) {
    return this.scenery.addPath(person, colour);
  }

  removePath(path) {
    this.scene.remove(path);
    release(path);
  }

  // Moves the camera so that the whole motion is in view, or the characters in every frame while it tracks them.
  view(name) {
    const direction = viewDirection(name, this.motion.axis());
    const points = this.motion.points(this.path);
    const centre = new THREE.Box3().setFromPoints(points).getCenter(new THREE.Vector3());
    const distance = fittingDistance(points, centre, direction, this.camera);
    const {target} = this.controls;
    this.scenery.box.getCenter(target).add(this.moved);
    if (this.path) target.add(new THREE.Vector3(centre.x, 0, centre.z));
    this.camera.position.copy(target).addScaledVector(direction, distance);
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

  dispose() {
    this.controls.dispose();
    this.scene.traverse(release);
  }
}

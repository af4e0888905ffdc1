// <duet-motion>: shows one person, or a leader and a follower, in 3D on any page. See
// docs/viewer_element.md.
const ELEMENT_STYLE = `
  :host { display: block; position: relative; aspect-ratio: 16 / 10; min-height: 120px;
    overflow: hidden; background: #24262b; color: #e9eaed; outline: none;
    font: 13px/1.45 "Inter", "Segoe UI", Roboto, "DejaVu Sans", system-ui, sans-serif; }
  :host([hidden]) { display: none; }
  :host(:focus-visible) { box-shadow: 0 0 0 2px #e9eaed; }
  canvas { position: absolute; inset: 0; width: 100%; height: 100%; display: block; outline: none; }
  [hidden] { display: none !important; }
  [part=controls] { position: absolute; left: 10px; right: 10px; bottom: 10px; display: flex;
    gap: 10px; align-items: center; padding: 6px 12px 6px 8px; border-radius: 10px;
    background: rgba(28, 30, 35, .78); }
  button { flex: none; display: grid; place-items: center; width: 34px; height: 34px; padding: 0;
    border: 0; border-radius: 50%; background: #e9eaed; cursor: pointer; }
  button:focus-visible, input:focus-visible { outline: 2px solid #fff; outline-offset: 2px; }
  svg { width: 18px; height: 18px; fill: #17181c; }
  input { flex: 1; min-width: 40px; height: 28px; margin: 0; accent-color: #e9eaed; }
  output { flex: none; font-variant-numeric: tabular-nums; white-space: nowrap; }
  [part=message] { position: absolute; left: 10px; right: 10px; top: 40%; margin: 0;
    text-align: center; color: #ffd9d4; }
`;
const ELEMENT_BODY = `
  <canvas part="canvas" aria-hidden="true"></canvas>
  <div part="controls" hidden>
    <button part="play" aria-label="Play or pause"><svg viewBox="0 0 24 24" aria-hidden="true"><path/></svg></button>
    <input part="time" type="range" min="0" max="0" step="1" value="0" aria-label="Frame">
    <output></output>
  </div>
  <p part="message" role="alert" hidden></p>
`;
const PLAY_SHAPE = 'M8 5.2v13.6a.8.8 0 0 0 1.2.7l11-6.8a.8.8 0 0 0 0-1.4l-11-6.8A.8.8 0 0 0 8 5.2z';
const PAUSE_SHAPE = 'M7 5h3.2v14H7zM13.8 5H17v14h-3.2z';
const VIEWS = ['reset', 'front', 'side', 'top'];

class DuetMotion extends HTMLElement {
  static get observedAttributes() {
    return ['src', 'controls', 'frame', 'paused', 'once', 'speed', 'view', 'track'];
  }

  constructor() {
    super();
    this.draws = 0;
    this.view = 'reset';   // until the visitor moves the camera
    this.stale = false;    // something has changed since the last draw
    this.onScreen = true;
    const root = this.attachShadow({mode: 'open'});
    // Constructed style sheets do not count as inline styles in the page's policy.
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(ELEMENT_STYLE);
    root.adoptedStyleSheets = [sheet];
    root.innerHTML = ELEMENT_BODY;
    this.canvas = root.querySelector('canvas');
    this.parts = Object.fromEntries(['controls', 'play', 'time', 'message'].map(
        (name) => [name, root.querySelector(`[part=${name}]`)]));
    this.parts.output = root.querySelector('output');
    this.connectControls();
  }

  connectedCallback() {
    this.connected = true;
    if (!this.hasAttribute('tabindex')) this.tabIndex = 0;
    if (!this.hasAttribute('role')) this.setAttribute('role', 'group');
    if (!this.hasAttribute('aria-label')) this.setAttribute('aria-label', 'Motion in three dimensions');
    this.resizes = new ResizeObserver(() => this.resize());
    this.resizes.observe(this);
    this.shows = new IntersectionObserver((entries) => {
      this.onScreen = entries[entries.length - 1].isIntersecting;
    });
    this.shows.observe(this);
    let before = null;
    const tick = (now) => {
      if (!this.connected) return;
      this.ticking = requestAnimationFrame(tick);
      // Do not skip time that a background tab slept.
      this.tick(before === null ? 0 : Math.min((now - before) / 1000, 0.1));
      before = now;
    };
    this.ticking = requestAnimationFrame(tick);
    if (this.data) {
      this.motion = this.data;  // the element was removed from the page and inserted again
    } else {
      this.load();
    }
  }

  disconnectedCallback() {
    this.connected = false;
    cancelAnimationFrame(this.ticking);
    this.resizes.disconnect();
    this.shows.disconnect();
    this.leaveStage();
  }

  attributeChangedCallback(name, before, value) {
    if (name === 'src' && this.connected) this.load();
    if (name === 'controls') this.parts.controls.hidden = value === null;
    if (this.player) this.apply(name, value);
  }

  // Applies an attribute.
  apply(name, value) {
    if (name === 'frame' && value !== null) this.seek(Number(value) || 0);
    if (name === 'paused') this.player.playing = value === null;
    if (name === 'once') this.player.looping = value === null;
    if (name === 'speed') this.player.speed = Number(value) > 0 ? Number(value) : 1;
    if (name === 'view' && VIEWS.includes(value)) this.look(value);
    if (name === 'track' && this.stage) this.track(value !== null);
    this.touch();
  }

  // Loads `src`, or the JSON in a <script type="application/json"> inside the element.
  async load() {
    const source = this.getAttribute('src');
    const inside = this.querySelector('script[type="application/json"]');
    if (!source && !inside) {
      // The element is connected before the parser has read its content.
      if (document.readyState === 'loading') {
        document.addEventListener('DOMContentLoaded', () => this.load(), {once: true});
      }
      return;
    }
    this.asked = (this.asked || 0) + 1;
    const asked = this.asked;
    try {
      const data = source ? await DuetMotion.fetched(source) : JSON.parse(inside.textContent);
      if (asked === this.asked) this.motion = Motion.of(data);  // no newer request
    } catch (error) {
      this.fail(`${source || 'the motion inside the element'}: ${error.message}`);
    }
  }

  static async fetched(source) {
    const response = await fetch(source);
    if (!response.ok) throw new Error(`the server returned ${response.status}`);
    return response.json();
  }

  // The motion on display. Set it to any argument of Motion.of.
  get motion() { return this.shown; }
  set motion(data) {
    this.data = data;
    this.parts.message.hidden = true;
    try {
      this.shown = Motion.of(data);
      this.stand();
    } catch (error) {
      this.leaveStage();
      this.fail(error.message);
    }
  }

  // Builds the scenery of the motion and restarts playback.
  stand() {
    if (!this.renderer && !drawsWebGl()) throw new Error(NO_WEBGL);
    const player = this.player = new Player(this.shown);
    player.playing = !matchMedia('(prefers-reduced-motion: reduce)').matches;
    for (const name of ['paused', 'once', 'speed', 'frame', 'view']) {
      if (this.hasAttribute(name)) this.apply(name, this.getAttribute(name));
    }
    this.said = player.playing;
    this.parts.time.max = player.last;
    this.build();
    this.tell('ready', {frames: this.shown.frames, frameRate: this.shown.frameRate});
  }

  // Replaces the scenery. The renderer stays, because compiling its shaders takes the longest.
  build() {
    if (this.renderer && this.renderer.getContext().isContextLost()) this.leaveStage();
    if (!this.renderer) this.newRenderer();
    const before = this.stage;
    this.stage = new Stage(this.renderer, this.shown);
    this.stage.controls.addEventListener('change', () => this.touch());
    this.stage.controls.addEventListener('start', () => {
      this.view = null;
      this.tell('orbit');
    });
    this.zoomWhenWanted();
    this.people = {};
    for (const name of Object.keys(this.shown.people)) {
      const figure = new Figure(this.shown, name, COLOURS[name]);
      this.stage.scene.add(figure.group);
      this.people[name] = {figure, path: this.stage.addPath(name, COLOURS[name])};
    }
    this.resize();
    if (this.hasAttribute('track')) this.stage.track(true);
    this.look(this.view || 'reset');
    if (before) before.dispose();  // now that the new scene has been drawn with the same shaders
  }

  newRenderer() {
    // A canvas never gets a second context.
    const canvas = this.canvas.cloneNode();
    this.canvas.replaceWith(canvas);
    this.canvas = canvas;
    this.renderer = makeRenderer(canvas);
  }

  leaveStage() {
    if (!this.stage) return;
    this.stage.controls.dispose();
    this.renderer.forceContextLoss();
    this.stage = this.people = this.renderer = null;
  }

  fail(message) {
    this.parts.message.textContent = message;
    this.parts.message.hidden = false;
    this.tell('error', {message});
  }

  tell(name, detail = {}) {
    this.dispatchEvent(new CustomEvent(name, {detail}));
  }

  // Requests a redraw.
  touch() { this.stale = true; }

  get frames() { return this.shown ? this.shown.frames : 0; }
  get duration() { return this.shown ? this.shown.duration : 0; }
  get frame() { return this.player ? this.player.frame : 0; }
  set frame(frame) { this.seek(frame); }
  get playing() { return Boolean(this.player && this.player.playing); }

  play() { if (!this.playing) this.toggle(); }
  pause() { if (this.playing) this.toggle(); }
  toggle() {
    if (this.player) this.player.toggle();
    this.touch();
  }
  seek(frame) {
    if (this.player) this.player.seek(frame);
    this.touch();
  }

  // Moves the camera to a view: reset, front, side or top.
  look(view) {
    this.view = view;
    if (this.stage) this.stage.view(view);
    this.touch();
  }

  // Lets the camera track the characters, or stay where the whole motion is in view.
  track(tracks) {
    this.stage.track(tracks);
    this.look(this.view || 'reset');
  }

  show(person, visible) {
    const {figure, path} = this.people[person];
    figure.group.visible = path.visible = visible;
    this.touch();
  }

  // Replaces the follower, Float32Array [frames, joints, 3], while the leader continues to play.
  setFollower(positions) {
    const isFirst = !this.shown.people.follower;
    this.shown.people.follower = positions;
    if (isFirst) {
      // The scenery depends on the size of the motion.
      this.build();
      return;
    }
    const {follower} = this.people;
    const before = follower.path;
    follower.path = this.stage.addPath('follower', COLOURS.follower);
    this.stage.removePath(before);
    if (this.stage.path) this.stage.track(true);
    this.touch();
  }

  // Replaces the follower's frames from `first` on; no effect without a follower.
  takeFrames(first, positions) {
    const {follower} = this.shown.people;
    if (!follower) return;
    follower.set(positions, first * this.shown.joints.length * 3);
    this.touch();
  }

  // Shows a person's pose, Float32Array [joints, 3], in a motion of one frame: for motion that
  // arrives while it is shown.
  setPose(person, positions) {
    this.shown.people[person].set(positions);
    this.touch();
  }

  // Moves camera and lights so that they show the floor around (x, z) as they showed the motion.
  follow(x, z) {
    if (this.stage) this.stage.moveTo(x, z);
    this.touch();
  }

  // The height of the floor, metres.
  get floorHeight() { return this.stage ? this.stage.scenery.floor : 0; }

  // Where a point of the world is drawn: [x, y, depth], pixels from the element's top left corner.
  // A depth above 1 is behind the camera.
  project(x, y, z) {
    const {camera} = this.stage;
    camera.updateMatrixWorld();
    const point = new THREE.Vector3(x, y, z).project(camera);
    return [(point.x + 1) / 2 * this.clientWidth, (1 - point.y) / 2 * this.clientHeight, point.z];
  }

  // The place on the floor, [x, z], that is drawn at a pixel of the element; null above the horizon.
  floorAt(x, y) {
    const {camera} = this.stage;
    camera.updateMatrixWorld();
    const at = new THREE.Vector2(2 * x / this.clientWidth - 1, 1 - 2 * y / this.clientHeight);
    const caster = new THREE.Raycaster();
    caster.setFromCamera(at, camera);
    const floor = new THREE.Plane(new THREE.Vector3(0, 1, 0), -this.floorHeight);
    const point = caster.ray.intersectPlane(floor, new THREE.Vector3());
    return point ? [point.x, point.z] : null;
  }

  // The point that is drawn at a pixel of the element, as far from the camera as `place`: [x, y, z].
  pointAt(x, y, place) {
    const {camera} = this.stage;
    camera.updateMatrixWorld();
    const depth = new THREE.Vector3(...place).project(camera).z;
    const point = new THREE.Vector3(2 * x / this.clientWidth - 1, 1 - 2 * y / this.clientHeight, depth);
    return point.unproject(camera).toArray();
  }

  resize() {
    if (!this.stage || !this.clientWidth || !this.stage.resize()) return;
    if (this.view) this.stage.view(this.view);
    this.draw();  // resizing clears the canvas
  }

  tick(seconds) {
    if (!this.stage || !this.onScreen) return;
    const played = this.player.playing;
    if (played) {
      this.player.advance(seconds);
      this.touch();
    }
    this.stage.controls.update();
    if (this.stale) this.draw();
  }

  // Draws the current frame. Listeners of "frame" may change the scene first.
  draw() {
    if (!this.stage) return;
    this.stale = false;
    this.stage.goTo(this.player.frame);
    for (const {figure} of Object.values(this.people)) figure.update(this.player.frame);
    this.tell('frame', {frame: this.player.frame});
    this.triangles = this.stage.draw();
    this.draws += 1;
    this.showControls();
    this.tell('drawn', {frame: this.player.frame});
    if (this.said !== this.player.playing) {
      this.said = this.player.playing;
      this.tell(this.said ? 'play' : 'pause');
    }
  }

  showControls() {
    const {play, time, output} = this.parts;
    play.querySelector('path').setAttribute('d', this.player.playing ? PAUSE_SHAPE : PLAY_SHAPE);
    time.value = Math.round(this.player.frame);
    const seconds = (frames) => (frames / this.shown.frameRate).toFixed(2);
    output.textContent = `${seconds(this.player.frame)} / ${seconds(this.player.last)} s`;
  }

  connectControls() {
    this.parts.play.addEventListener('click', () => this.toggle());
    this.parts.time.addEventListener('input', () => {
      if (!this.player) return;
      this.player.playing = false;
      this.seek(Number(this.parts.time.value));
    });
    this.addEventListener('keydown', (event) => this.key(event));
    for (const name of ['focusin', 'focusout']) {
      this.addEventListener(name, () => this.zoomWhenWanted());
    }
    // Runs before the camera's controls. Without focus, one finger scrolls the page.
    this.addEventListener('pointerdown', (event) => {
      if (!this.stage) return;
      this.stage.controls.enabled =
          this.isWhole || this.isFocused || event.pointerType !== 'touch';
    }, {capture: true});
  }

  // Whether the page has its own keys and does not scroll.
  get isWhole() { return this.hasAttribute('whole'); }
  get isFocused() { return this.matches(':focus-within'); }

  // The wheel scrolls the page until the element has the focus.
  zoomWhenWanted() {
    if (this.stage) this.stage.controls.enableZoom = this.isWhole || this.isFocused;
  }

  key(event) {
    if (this.isWhole || !this.player || event.ctrlKey || event.metaKey || event.altKey) return;
    const from = event.composedPath()[0];
    if (from === this.parts.play && event.key === ' ') return;
    if (from === this.parts.time && event.key !== ' ') return;
    const player = this.player;
    const keys = {
      ' ': () => player.toggle(),
      ArrowLeft: () => player.step(-1),
      ArrowRight: () => player.step(1),
      Home: () => { player.step(0); player.seek(0); },
      End: () => { player.step(0); player.seek(player.last); },
      0: () => this.look('reset'),
      1: () => this.look('front'),
      2: () => this.look('side'),
      3: () => this.look('top'),
    };
    if (!keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
    this.touch();
  }
}

if (!customElements.get('duet-motion')) customElements.define('duet-motion', DuetMotion);

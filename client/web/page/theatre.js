'use strict';
// Where a leader and its follower are seen: the viewer's stage, figures and clock, for motion that
// changes while it plays.
class Theatre {
  // `onFrame` is called with whatever frame is drawn.
  constructor(canvas, onFrame) {
    this.canvas = canvas;
    this.onFrame = onFrame;
    this.draws = 0;
    this.stale = false;  // something changed since the last drawing
    window.addEventListener('resize', () => this.resize());
    window.requestAnimationFrame((now) => this.tick(now, now));
  }

  // joints, bones: of the motion; leader: Float32Array [frames, joints, 3], metres, y up.
  setLeader({joints, bones, frameRate, leader}) {
    const motion = new Motion({joints, bones, frameRate, frames: leader.length / joints.length / 3});
    motion.people.leader = leader;
    this.motion = motion;
    this.player = new Player(motion);
    this.player.playing = !window.matchMedia('(prefers-reduced-motion: reduce)').matches;
    this.build();
  }

  // What stands around a motion has its size, and a canvas keeps its renderer: both are made anew.
  build() {
    const canvas = this.canvas.cloneNode();
    this.canvas.replaceWith(canvas);
    this.canvas = canvas;
    if (this.stage) this.stage.renderer.forceContextLoss();
    this.stage = new Stage(canvas, this.motion);
    this.figures = Object.keys(this.motion.people).map((person) => {
      const figure = new Figure(this.motion, person, COLOURS[person]);
      this.stage.scene.add(figure.group);
      return figure;
    });
    this.paths = Object.keys(this.motion.people).map(
        (person) => this.stage.addPath(person, COLOURS[person]));
    this.stage.controls.addEventListener('change', () => this.touch());
    this.resize();
    this.stage.view('reset');
  }

  touch() {
    this.stale = true;
  }

  // Frames of the follower from `first` on, in place of those of the answer before.
  takeFrames(first, positions) {
    const follower = this.motion.people.follower;
    if (!follower) return;
    follower.set(positions, first * this.motion.joints.length * 3);
    this.touch();
  }

  // The whole follower.
  setFollower(positions) {
    const isFirst = !this.motion.people.follower;
    this.motion.people.follower = positions;
    if (isFirst) {
      this.build();
      return;
    }
    this.stage.scene.remove(this.paths.pop());
    this.paths.push(this.stage.addPath('follower', COLOURS.follower));
    this.touch();
  }

  resize() {
    if (this.stage) this.stage.resize();
    this.touch();
  }

  tick(now, before) {
    window.requestAnimationFrame((next) => this.tick(next, now));
    if (!this.stage) return;
    if (this.player.playing) this.touch();
    // A tab that slept does not leap ahead.
    this.player.advance(Math.min((now - before) / 1000, 0.1));
    this.stage.controls.update();
    if (!this.stale) return;
    this.stale = false;
    for (const figure of this.figures) figure.update(this.player.frame);
    this.stage.draw();
    this.draws += 1;
    this.onFrame(this.player);
  }
}

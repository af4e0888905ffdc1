// Playback: the current frame, and whether it advances.
class Player {
  constructor(motion) {
    this.motion = motion;
    this.frame = 0;  // fractional while playing
    this.playing = true;
    this.looping = true;
    this.speed = 1;
  }

  get last() {
    return this.motion.frames - 1;
  }

  seek(frame) {
    this.frame = Math.min(Math.max(frame, 0), this.last);
  }

  // Steps by whole frames and pauses.
  step(by) {
    this.playing = false;
    this.seek(Math.round(this.frame) + by);
  }

  toggle() {
    this.playing = !this.playing;
    if (this.playing && !this.looping && this.frame >= this.last) this.frame = 0;
  }

  // Advances by real seconds.
  advance(seconds) {
    if (!this.playing) return;
    this.frame += seconds * this.speed * this.motion.frameRate;
    if (this.frame < this.last) return;
    if (this.looping && this.last > 0) {
      this.frame %= this.last;
    } else {
      this.frame = this.last;
      this.playing = false;
    }
  }
}

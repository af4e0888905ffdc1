// The beat of the music: shows it, and clicks on it while the motion plays. The browser's audio
// clock places the clicks. On every frame they are compared with where the player will be, so they
// follow pauses, seeking, the speed and the loop.
class Metronome {
  static get LOOK_AHEAD() { return 0.25; }  // seconds; longer than a slow frame
  static get TOLERANCE() { return 0.02; }   // seconds by which frames come early or late
  static get MEMORY() { return 0.5; }       // seconds in which a beat is not repeated
  static get BEATS_IN_BAR() { return 4; }
  static get FLASH() { return 0.12; }       // seconds

  // `beat`: {bpm, offset}, with the time of the first beat in seconds.
  constructor(beat, player) {
    this.beat = beat;
    this.player = player;
    this.period = 60 / beat.bpm;
    this.on = false;
    this.clicks = [];  // placed on the audio clock: {beat, at, sound}
    this.before = 0;   // the position at the last update
    this.element = (id) => document.getElementById(id);
    this.element('beat').hidden = false;
    this.element('bpm').textContent = `${Number(beat.bpm.toFixed(2))} BPM`;
    this.element('metronome').hidden = !this.possible;
  }

  get possible() {
    return typeof AudioContext !== 'undefined';
  }

  // Seconds of motion from the first frame.
  get position() {
    return this.player.frame / this.player.motion.frameRate;
  }

  // Browsers allow sound only after a click or a key.
  toggle() {
    this.on = !this.on;
    this.element('metronome').setAttribute('aria-pressed', this.on);
    if (this.on) {
      if (!this.audio) this.audio = new AudioContext();
      this.audio.resume();
    } else {
      this.keep(() => false);
      this.audio.suspend();
    }
  }

  update() {
    this.show();
    if (this.on && this.audio.state === 'running') this.place();
    this.before = this.position;
  }

  // Brings the clicks into line with the beats to come.
  place() {
    const now = this.audio.currentTime;
    const latency = this.audio.outputLatency || 0;
    const wanted = this.upcoming().map(
        ({beat, after}) => ({beat, at: Math.max(now, now + after - latency)}));
    const isSame = (click, {beat, at}, within) =>
        click.beat === beat && Math.abs(click.at - at) <= within;
    this.keep((click) => wanted.some((beat) => isSame(click, beat, Metronome.TOLERANCE)));
    for (const beat of wanted) {
      const isPlaced = this.clicks.some((click) => isSame(click, beat, Metronome.MEMORY));
      if (!isPlaced) this.clicks.push({...beat, sound: this.sound(beat)});
    }
  }

  // Silences the clicks to come for which `isRight` is false. While the motion plays, remembers
  // those of the last moments: a late frame must not repeat them.
  keep(isRight) {
    const now = this.audio.currentTime;
    this.clicks = this.clicks.filter((click) => {
      if (click.at <= now) return this.player.playing && now - click.at < Metronome.MEMORY;
      if (isRight(click)) return true;
      click.sound.disconnect();
      return false;
    });
  }

  // The beats that the player has reached since the last update, and those that it reaches within
  // LOOK_AHEAD, each `after` seconds from now.
  upcoming() {
    const {player, period} = this;
    const {offset} = this.beat;
    if (!player.playing) return [];
    const end = player.last / player.motion.frameRate;
    const found = [];
    const passed = (this.position - this.before) / player.speed;
    const isContinued = passed >= 0 && passed < Metronome.LOOK_AHEAD;
    let [from, after] = isContinued ? [this.before, -passed] : [this.position, 0];
    while (after < Metronome.LOOK_AHEAD) {
      const to = Math.min(end, from + (Metronome.LOOK_AHEAD - after) * player.speed);
      for (let beat = Math.max(0, Math.ceil((from - offset) / period - 1e-6));
           offset + beat * period < to; ++beat) {
        found.push({beat, after: after + (offset + beat * period - from) / player.speed});
      }
      if (!player.looping || to < end || end <= 0) break;
      after += (end - from) / player.speed;
      from = 0;
    }
    return found;
  }

  // A click; the first beat of a bar is higher and louder.
  sound({beat, at}) {
    const accent = beat % Metronome.BEATS_IN_BAR === 0;
    const [tone, volume] = [this.audio.createOscillator(), this.audio.createGain()];
    tone.frequency.value = accent ? 1760 : 1174;
    volume.gain.setValueAtTime(accent ? 0.5 : 0.25, at);
    volume.gain.exponentialRampToValueAtTime(0.001, at + 0.05);
    tone.connect(volume);
    volume.connect(this.audio.destination);
    tone.start(at);
    tone.stop(at + 0.06);
    return volume;
  }

  // Lights the beat's place in its bar, brightest on the beat itself.
  show() {
    const beats = (this.position - this.beat.offset) / this.period;
    const beat = Math.floor(beats + 1e-6);
    const since = Math.max(0, beats - beat) * this.period;
    const row = this.element('beats');
    row.style.setProperty('--flash', Math.max(0, 1 - since / Metronome.FLASH).toFixed(3));
    [...row.children].forEach((dot, i) => {
      dot.classList.toggle('now', beat >= 0 && beat % Metronome.BEATS_IN_BAR === i);
    });
  }
}

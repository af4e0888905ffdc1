// Saves files: a picture, a film of one run, a GIF of one run, and the motion.
function save(blob, name) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
  root.dataset.saved = `${name} ${blob.size}`;
}

// The canvas is cleared after the browser has displayed it, so draw and read it in one task.
function savePicture(element, name) {
  element.draw();
  element.canvas.toBlob((blob) => save(blob, `${name}.png`), 'image/png');
}

// Records the motion once, from its first frame to its last, at the selected speed.
class Film {
  constructor(element, name) {
    this.element = element;
    this.name = name;
    element.addEventListener('drawn', () => this.follow());
  }

  get possible() {
    return typeof MediaRecorder !== 'undefined' && Boolean(this.element.canvas.captureStream);
  }

  start() {
    if (this.recorder) return;
    const {canvas, player} = this.element;
    const type = ['video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/webm', 'video/mp4']
                     .find((kind) => MediaRecorder.isTypeSupported(kind));
    this.recorder = new MediaRecorder(canvas.captureStream(),
                                      {mimeType: type, videoBitsPerSecond: 8_000_000});
    const parts = [];
    this.recorder.ondataavailable = ({data}) => parts.push(data);
    this.recorder.onstop = () => {
      this.recorder = null;
      save(new Blob(parts, {type}), `${this.name}.${type.includes('webm') ? 'webm' : 'mp4'}`);
    };
    this.looping = player.looping;
    player.looping = false;
    player.seek(0);
    player.playing = true;
    this.recorder.start();
  }

  follow() {
    const {player} = this.element;
    if (!this.recorder || player.playing || this.recorder.state !== 'recording') return;
    player.looping = this.looping;
    this.recorder.stop();
  }
}

// Saves one run as GIF, drawn as fast as possible.
class Gif {
  static get PIXELS() { return 480; }         // the longer side
  static get MOST_RATE() { return 100 / 6; }  // browsers slow down faster ones
  static get MOST_FRAMES() { return 300; }

  constructor(element, name) {
    this.element = element;
    this.name = name;
  }

  // The frames to draw, and the duration of each in hundredths of a second.
  plan() {
    const {player, motion} = this.element;
    const perSecond = motion.frameRate * player.speed;
    const seconds = player.last / perSecond;
    const hundredths = Math.max(Math.round(100 / Math.min(perSecond, Gif.MOST_RATE)),
                                Math.ceil(100 * seconds / Gif.MOST_FRAMES));
    const step = perSecond * hundredths / 100;
    const frames = [];
    for (let frame = 0; frame <= player.last + 1e-6; frame += step) frames.push(frame);
    return {frames, hundredths};
  }

  picture(frame, paint) {
    const {player} = this.element;
    player.seek(frame);
    this.element.draw();
    const {width, height} = paint.canvas;
    paint.drawImage(this.element.canvas, 0, 0, width, height);
    return paint.getImageData(0, 0, width, height).data;
  }

  async start() {
    if (this.running) return;
    this.running = true;
    const {canvas, player} = this.element;
    const before = {frame: player.frame, playing: player.playing};
    player.playing = false;
    const share = Math.min(1, Gif.PIXELS / Math.max(canvas.width, canvas.height));
    const paint = Object.assign(document.createElement('canvas'),
                                {width: Math.round(canvas.width * share),
                                 height: Math.round(canvas.height * share)})
                      .getContext('2d', {willReadFrequently: true});
    const {frames, hundredths} = this.plan();
    const some = [0, 0.25, 0.5, 0.75, 1].map((part) => this.picture(part * player.last, paint));
    const palette = new Palette(some, 255);
    const writer = new GifWriter(paint.canvas.width, paint.canvas.height, palette.colours);
    for (const frame of frames) {
      writer.add(palette.indices(this.picture(frame, paint)), hundredths);
      await new Promise((resolve) => setTimeout(resolve));  // keeps the page responsive
    }
    Object.assign(player, before);
    this.element.draw();
    this.running = false;
    save(writer.blob(), `${this.name}.gif`);
  }
}

function saveMotion(base64, name) {
  const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
  save(new Blob([bytes], {type: 'model/gltf-binary'}), `${name}.glb`);
}

// Files out of the page: a picture, a film of one run, and the motion itself.
function save(blob, name) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
  root.dataset.saved = `${name} ${blob.size}`;
}

// `draw` draws what is shown now: a canvas forgets it once the browser has it.
function savePicture(canvas, draw, name) {
  draw();
  canvas.toBlob((blob) => save(blob, `${name}.png`), 'image/png');
}

// Records the motion once, from its first frame to its last, at the speed that is chosen.
class Film {
  constructor(canvas, player, name) {
    this.canvas = canvas;
    this.player = player;
    this.name = name;
  }

  get possible() {
    return typeof MediaRecorder !== 'undefined' && Boolean(this.canvas.captureStream);
  }

  start() {
    if (this.recorder) return;
    const type = ['video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/webm', 'video/mp4']
                     .find((kind) => MediaRecorder.isTypeSupported(kind));
    this.recorder = new MediaRecorder(this.canvas.captureStream(),
                                      {mimeType: type, videoBitsPerSecond: 8_000_000});
    const parts = [];
    this.recorder.ondataavailable = ({data}) => parts.push(data);
    this.recorder.onstop = () => {
      this.recorder = null;
      save(new Blob(parts, {type}), `${this.name}.${type.includes('webm') ? 'webm' : 'mp4'}`);
    };
    this.looping = this.player.looping;
    this.player.looping = false;
    this.player.seek(0);
    this.player.playing = true;
    this.recorder.start();
  }

  // Called for every frame of the screen.
  follow() {
    if (!this.recorder || this.player.playing || this.recorder.state !== 'recording') return;
    this.player.looping = this.looping;
    this.recorder.stop();
  }
}

function saveMotion(base64, name) {
  const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
  save(new Blob([bytes], {type: 'model/gltf-binary'}), `${name}.glb`);
}

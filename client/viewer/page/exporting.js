// Saves files: a picture, a film of one run, and the motion.
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

function saveMotion(base64, name) {
  const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
  save(new Blob([bytes], {type: 'model/gltf-binary'}), `${name}.glb`);
}

// The panels around the stage: title, class weights, playback.
class Panel {
  constructor(data, motion, player) {
    this.motion = motion;
    this.player = player;
    this.element = (id) => document.getElementById(id);
    this.element('title').textContent = data.title;
    this.element('subtitle').textContent = data.subtitle;
    this.element('scrub').max = player.last;
    this.addWeights();
    this.addMarks();
  }

  addWeights() {
    this.rows = this.motion.classes.map((name) => {
      const row = document.createElement('div');
      row.className = 'weight';
      const [label, bar, value] = ['name', 'bar', 'value'].map((part) => {
        const element = document.createElement('span');
        element.className = part;
        row.append(element);
        return element;
      });
      label.textContent = label.title = name.replace(/_/g, ' ');
      const fill = document.createElement('i');
      bar.append(fill);
      this.element('weights').append(row);
      return {fill, value};
    });
  }

  // A diamond on the scrub bar for every keyframe of the weights.
  addMarks() {
    if (this.motion.keyframes.length < 2) return;
    for (const {frame} of this.motion.keyframes) {
      if (frame > this.player.last) continue;
      const mark = document.createElement('i');
      // The thumb's centre moves between 7 px inside of both ends.
      const share = frame / Math.max(1, this.player.last);
      mark.style.left = `calc(7px + (100% - 14px) * ${share})`;
      this.element('marks').append(mark);
    }
  }

  update() {
    const {player, motion} = this;
    showTime({player, frameRate: motion.frameRate});
    motion.weights(player.frame).forEach((weight, i) => Panel.show(this.rows[i], weight));
  }

  static show({fill, value}, weight) {
    const width = Math.min(Math.abs(weight), 2) * 25;
    fill.style.left = `${weight < 0 ? 50 - width : 50}%`;
    fill.style.width = `${width}%`;
    fill.className = weight < 0 ? 'negative' : '';
    value.textContent = weight.toFixed(2).replace('-', '−');
  }
}

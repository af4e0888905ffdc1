// The server's grade of the answer: what a viewer would notice, in figures, and as marks of the
// twisted and overlapping frames on the time line.
class Grade {
  // `grade`: {twisted, skating, leaderSkating, overlapping, badRuns [[first frame, frames]]}.
  constructor(grade, player) {
    this.runs = grade.badRuns.filter(([first]) => first <= player.last);
    this.player = player;
    this.box = document.getElementById('grade');
    this.button = document.getElementById('next-fault');
    this.box.hidden = false;
    this.addFigures(grade);
    this.button.hidden = this.runs.length === 0;
    this.runs.forEach((run) => this.addMark(run));
  }

  static percent(share) {
    const percent = 100 * share;
    return `${percent > 0 && percent < 1 ? '< 1' : Math.round(percent)} %`;
  }

  addFigures({twisted, overlapping, skating, leaderSkating}) {
    const figures = [
      ['twisted', 'Shoulders are turned against the hips by more than 45 degrees', twisted],
      ['overlapping', 'Heads or trunks overlap', overlapping],
      ['feet move', 'Both ankles move faster than 10 cm/s; people who step and turn do so too', skating,
        leaderSkating],
    ];
    for (const [name, meaning, share, ofLeader] of figures) {
      const row = document.createElement('p');
      row.title = meaning;
      const [label, value] = [document.createElement('span'), document.createElement('b')];
      label.textContent = name;
      value.textContent = Grade.percent(share);
      if (ofLeader !== undefined) value.append(`, leader ${Grade.percent(ofLeader)}`);
      row.classList.toggle('fault', Math.round(100 * (share - (ofLeader || 0))) > 0);
      row.append(label, value);
      this.box.insertBefore(row, this.button);
    }
  }

  // A bar from half a frame before a run to half a frame after it.
  addMark([first, count]) {
    const last = Math.max(1, this.player.last);
    const from = Math.max(0, first - 0.5) / last;
    const to = Math.min(last, first + count - 0.5) / last;
    const mark = document.createElement('b');
    // As in Panel.addMarks: the thumb's centre moves between 7 px inside of both ends.
    mark.style.left = `calc(7px + (100% - 14px) * ${from})`;
    mark.style.width = `calc((100% - 14px) * ${to - from})`;
    document.getElementById('marks').append(mark);
  }

  get current() {
    const frame = Math.round(this.player.frame);
    return this.runs.findIndex(([first, count]) => frame >= first && frame < first + count);
  }

  update() {
    if (this.runs.length === 0) return;
    const now = this.current;
    this.button.classList.toggle('now', now >= 0);
    this.button.textContent = now >= 0 ? `Marked frames ${now + 1} of ${this.runs.length}`
        : `Marked frames: ${this.runs.length}`;
  }

  // Pauses at the next run, or at the first one after the last.
  next() {
    if (this.runs.length === 0) return;
    const frame = Math.round(this.player.frame);
    const [first] = this.runs.find((run) => run[0] > frame) || this.runs[0];
    this.player.step(0);
    this.player.seek(first);
  }
}

'use strict';
// The strip of latencies: a bar for each answer, marks for frames that the server skipped.

const STRIP_BARS = 180;
const STRIP_MS = [50, 100, 200, 400, 800];  // heights of the strip

class Strip {
  constructor(canvas, figures) {
    Object.assign(this, {canvas, figures});
    this.bars = [];   // {ms, mark}
    this.counts = {skipped: 0, resumed: 0};
    this.mark = '';
    this.written = 0;
  }

  add(ms) {
    this.bars.push({ms, mark: this.mark});
    this.mark = '';
    if (this.bars.length > STRIP_BARS) this.bars.shift();
  }

  note(kind, count = 1) {
    this.counts[kind] += count;
    this.mark = kind;
  }

  percentile(share) {
    const sorted = this.bars.map(({ms}) => ms).filter(Number.isFinite).sort((a, b) => a - b);
    return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
  }

  draw(now) {
    const {canvas} = this;
    const scale = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    canvas.width = width * scale;
    canvas.height = height * scale;
    const paint = canvas.getContext('2d');
    paint.scale(scale, scale);
    const longest = Math.max(...this.bars.map(({ms}) => ms || 0), 1);
    const top = STRIP_MS.find((ms) => ms >= longest) ?? STRIP_MS[STRIP_MS.length - 1];
    paint.strokeStyle = '#3a3d46';
    paint.beginPath();
    paint.moveTo(0, height / 2 + 0.5);
    paint.lineTo(width, height / 2 + 0.5);
    paint.stroke();
    const step = width / STRIP_BARS;
    this.bars.forEach(({ms, mark}, i) => {
      const x = width - (this.bars.length - i) * step;
      paint.fillStyle = mark === 'skipped' ? '#ff9d8a' : mark === 'resumed' ? '#f0a04b' : '#4fb3bf';
      const tall = Math.max(2, Math.min(1, ms / top) * (height - 4));
      paint.fillRect(x, height - tall, Math.max(1, step - 0.8), tall);
    });
    paint.fillStyle = '#a6a9b2';
    paint.font = '11px system-ui, "DejaVu Sans", sans-serif';
    paint.fillText(`${top} ms`, 6, 14);
    if (now - this.written > 500) this.write(now);
  }

  write(now) {
    this.written = now;
    if (!this.bars.length) return;
    const {skipped, resumed} = this.counts;
    const text = [`Half within ${this.percentile(0.5).toFixed(0)} ms`,
                  `99 % within ${this.percentile(0.99).toFixed(0)} ms`, `${skipped} frames skipped`];
    if (resumed) text.push(`resumed ${resumed} ${resumed === 1 ? 'time' : 'times'}`);
    this.figures.textContent = `${text.join(' · ')}.`;
  }
}

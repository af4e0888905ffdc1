const CURVE_COLOURS = ['#e9eaed', '#e8795f', '#7fb069', '#b58bd6', '#e6c229', '#5fa8e8', '#ee8bb0',
                       '#8fd3c8', '#c49a6c', '#a3a9b5', '#d4e157', '#ff8a50'];
const NOISE_FILTER_SECONDS = 0.1;

// The mean speed of the follower's joints in each frame, m/s, after a Gaussian filter.
// Without it, noise of a capture would count as movement.
function speedCurve(motion) {
  const positions = motion.people.follower || motion.people.leader;
  const stride = motion.joints.length * 3;
  const speeds = [];
  const smooth = gaussianFilter(positions, stride, motion.frames,
                                NOISE_FILTER_SECONDS * motion.frameRate);
  for (let frame = 1; frame < motion.frames; ++frame) {
    let sum = 0;
    for (let i = frame * stride; i < (frame + 1) * stride; i += 3) {
      sum += Math.hypot(smooth[i] - smooth[i - stride], smooth[i + 1] - smooth[i + 1 - stride],
                        smooth[i + 2] - smooth[i + 2 - stride]);
    }
    speeds.push(sum / motion.joints.length * motion.frameRate);
  }
  return speeds.length > 0 ? [speeds[0], ...speeds] : [0];
}

// The horizontal distance of the two roots in each frame, metres; null for one person.
function distanceCurve(motion) {
  const {leader, follower} = motion.people;
  if (!follower) return null;
  const root = Math.max(0, motion.find('torso')) * 3;
  const stride = motion.joints.length * 3;
  return Array.from({length: motion.frames}, (_, frame) => {
    const at = frame * stride + root;
    return Math.hypot(leader[at] - follower[at], leader[at + 2] - follower[at + 2]);
  });
}

function gaussianFilter(values, stride, frames, sigma) {
  const reach = Math.ceil(3 * sigma);
  const weights = Array.from({length: 2 * reach + 1},
                             (_, i) => Math.exp(-0.5 * ((i - reach) / sigma) ** 2));
  const smooth = new Float64Array(values.length);
  for (let frame = 0; frame < frames; ++frame) {
    let total = 0;
    for (let i = -reach; i <= reach; ++i) {
      if (frame + i < 0 || frame + i >= frames) continue;
      const weight = weights[i + reach];
      total += weight;
      for (let k = 0; k < stride; ++k) {
        smooth[frame * stride + k] += weight * values[(frame + i) * stride + k];
      }
    }
    for (let k = 0; k < stride; ++k) smooth[frame * stride + k] /= total;
  }
  return smooth;
}

// A chart over the timeline, with one curve for each cell that has values.
class Chart {
  constructor(parent, title, unit, curves, duration) {
    this.curves = curves;
    this.duration = duration;
    const box = document.createElement('div');
    box.className = 'chart';
    box.innerHTML = '<header><b></b><span></span></header><svg preserveAspectRatio="none"></svg>' +
        '<i class="now"></i><em class="top"></em><em class="bottom"></em>';
    box.querySelector('b').textContent = title;
    parent.append(box);
    this.now = box.querySelector('.now');
    this.readings = box.querySelector('span');
    this.unit = unit;
    const most = Math.max(...curves.map(({values}) => Math.max(...values)), 1e-3);
    this.top = Chart.above(most);
    box.querySelector('.top').textContent = `${this.top} ${unit}`;
    box.querySelector('.bottom').textContent = '0';
    this.draw(box.querySelector('svg'));
  }

  // Rounds up to 1, 1.5, 2, 3, 4, 5, 6 or 8 times a power of ten.
  static above(value) {
    const power = 10 ** Math.floor(Math.log10(value));
    const step = [1, 1.5, 2, 3, 4, 5, 6, 8, 10].find((factor) => factor * power >= value * 0.999);
    return Number((step * power).toPrecision(3));
  }

  draw(svg) {
    svg.setAttribute('viewBox', '0 0 1000 100');
    const half = document.createElementNS('http://www.w3.org/2000/svg', 'path');
    half.setAttribute('class', 'grid');
    half.setAttribute('d', 'M0 1H1000M0 50H1000M0 99H1000');
    svg.append(half);
    for (const {values, cell} of this.curves) {
      const line = document.createElementNS('http://www.w3.org/2000/svg', 'polyline');
      line.setAttribute('points', values.map((value, frame) => {
        const seconds = frame / cell.motion.frameRate;
        const x = 1000 * seconds / Math.max(this.duration, 1e-6);
        return `${x.toFixed(2)},${(99 - 98 * value / this.top).toFixed(2)}`;
      }).join(' '));
      line.setAttribute('stroke', cell.colour);
      svg.append(line);
    }
  }

  update(seconds) {
    this.now.style.left = `${100 * seconds / Math.max(this.duration, 1e-6)}%`;
    this.readings.replaceChildren(...this.curves.map(({values, cell}) => {
      const frame = Math.min(Math.round(seconds * cell.motion.frameRate), values.length - 1);
      const reading = document.createElement('span');
      reading.style.color = cell.colour;
      reading.textContent = `${values[frame].toFixed(2)} ${this.unit}`;
      return reading;
    }));
  }
}

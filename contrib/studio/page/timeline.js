'use strict';
// Label curves: for each class a list of points [frame, weight] with ascending frames, linear between
// points and constant outside them. A class without points has the weight of its slider in every
// frame. The functions take the settings, of which they read or change `labels` and `curves`.
const MAX_POINTS = 500;  // of one curve in a link

const curveOf = (all, name) => all.curves[name] ?? [];
const isCurved = (all) => Object.values(all.curves).some((points) => points.length > 0);

function weightAt(all, name, frame) {
  const points = curveOf(all, name);
  if (points.length === 0) return all.labels[name] ?? 0;
  const next = points.findIndex(([at]) => at > frame);
  if (next === 0) return points[0][1];
  if (next < 0) return points[points.length - 1][1];
  const [[from, before], [to, after]] = [points[next - 1], points[next]];
  return before + (after - before) * (frame - from) / (to - from);
}

const weightsAt = (all, classes, frame) => Object.fromEntries(
    classes.map((name) => [name, weightAt(all, name, frame)]));

// Adds a point, or replaces the one in the same frame.
function setPoint(all, name, frame, weight) {
  const others = curveOf(all, name).filter(([at]) => at !== frame);
  all.curves[name] = [...others, [frame, weight]].sort(([a], [b]) => a - b);
}

// Moves the point at `from`, not beyond its neighbours. Returns its new frame.
function movePoint(all, name, from, frame, weight, frames) {
  const points = curveOf(all, name);
  const index = points.findIndex(([at]) => at === from);
  const least = index > 0 ? points[index - 1][0] + 1 : 0;
  const most = index < points.length - 1 ? points[index + 1][0] - 1 : frames - 1;
  const to = Math.max(least, Math.min(most, frame));
  all.curves[name] = points.map((point, i) => (i === index ? [to, weight] : point));
  return to;
}

function removePoint(all, name, frame) {
  all.curves[name] = curveOf(all, name).filter(([at]) => at !== frame);
  if (all.curves[name].length === 0) delete all.curves[name];
}

// The curves as the key frames of a request about `frames` frames: [{frame, weights}]. Lines between the
// points of all curves are exact.
function labelKeyframes(all, classes, frames) {
  const points = classes.flatMap((name) => curveOf(all, name).map(([at]) => Math.min(frames - 1, at)));
  return [...new Set(points)].sort((a, b) => a - b).map(
      (frame) => ({frame, weights: weightsAt(all, classes, frame)}));
}

// "hug;0:0,30:1", the form of a curve in the page's address.
const writeCurve = (name, points) => `${name};${points.map((point) => point.join(':')).join(',')}`;

function readCurve(text) {
  const [name, list = ''] = text.split(';');
  if (!/^[A-Za-z]\w*$/.test(name)) return;
  for (const part of list.split(',').slice(0, MAX_POINTS)) {
    const [frame, weight] = part.split(':').map((value) => (value ? Number(value) : NaN));
    if (!Number.isSafeInteger(frame) || frame < 0 || !Number.isFinite(weight)) continue;
    setPoint(settings, name, frame, Math.max(-MAX_WEIGHT, Math.min(MAX_WEIGHT, weight)));
  }
}

// The lanes below the scene: a curve for each class. A click adds a point, dragging moves it, a right
// click removes it. The slider of a class sets a point exactly, and by keys.
const LANE_INSET = 8;      // half of the thumb of the timeline, which the lanes are aligned with
const LANE_MARGIN = 6;     // above and below the greatest weights
const GRIP_PIXELS = {mouse: 9, pen: 12, touch: 20};
const WEIGHT_STEP = 0.05;
const HOLD_PIXELS = 3;     // a smaller movement of a point that is held does not move it

// A weight as the sliders step it.
const stepped = (weight) => rounded(Math.round(weight / WEIGHT_STEP) * WEIGHT_STEP, 2);

class Lane {
  // Calls `changed(what)` after each change of the curve and `ended()` after a gesture.
  constructor(name, changed, ended) {
    this.name = name;
    this.text = name.replaceAll('_', ' ');
    this.changed = changed;
    this.node = Object.assign(document.createElement('div'), {className: 'lane'});
    this.title = Object.assign(document.createElement('span'), {className: 'lane-name'});
    this.value = Object.assign(document.createElement('output'), {className: 'lane-value'});
    this.svg = svgItem('svg', {role: 'img', 'aria-label': `Curve of ${this.text}`});
    this.zero = svgItem('line', {class: 'zero'});
    this.line = svgItem('polyline', {class: 'curve'});
    this.head = svgItem('line', {class: 'playhead', y1: 0, y2: '100%'});
    this.points = svgItem('g', {});
    this.svg.append(this.zero, this.line, this.head, this.points);
    this.node.append(this.title, this.svg, this.value);
    this.title.textContent = this.text;
    this.connect(ended);
  }

  get frames() { return state.leader.motion.frames; }
  get curve() { return curveOf(settings, this.name); }

  // The greatest weight of the scale.
  get range() {
    return this.curve.some(([, weight]) => Math.abs(weight) > 1) ? MAX_WEIGHT : 1;
  }

  x(frame) {
    return LANE_INSET + (this.width - 2 * LANE_INSET) * frame / Math.max(1, this.frames - 1);
  }
  y(weight) {
    const half = this.height / 2 - LANE_MARGIN;
    return this.height / 2 - half * Math.max(-1, Math.min(1, weight / this.range));
  }
  frameAt(x) {
    const share = (x - LANE_INSET) / Math.max(1, this.width - 2 * LANE_INSET);
    return Math.max(0, Math.min(this.frames - 1, Math.round(share * (this.frames - 1))));
  }
  weightAtPixel(y) {
    const share = (this.height / 2 - y) / Math.max(1, this.height / 2 - LANE_MARGIN);
    return stepped(Math.max(-1, Math.min(1, share)) * this.range);
  }

  draw() {
    this.width = this.svg.clientWidth;
    this.height = this.svg.clientHeight;
    if (!this.width) return;
    const {curve} = this;
    const [left, right] = [this.x(0), this.x(this.frames - 1)];
    for (const end of ['y1', 'y2']) this.zero.setAttribute(end, this.y(0));
    this.zero.setAttribute('x1', left);
    this.zero.setAttribute('x2', right);
    const constant = settings.labels[this.name] ?? 0;
    const knots = curve.length === 0 ? [[left, this.y(constant)], [right, this.y(constant)]]
        : [[left, this.y(curve[0][1])], ...curve.map(([frame, weight]) => [this.x(frame), this.y(weight)]),
           [right, this.y(curve[curve.length - 1][1])]];
    this.line.setAttribute('points', knots.map((knot) => knot.map(
        (value) => value.toFixed(1)).join()).join(' '));
    this.node.classList.toggle('curved', curve.length > 0);
    this.node.classList.toggle('idle', curve.length === 0 && constant === 0);
    this.points.replaceChildren(...curve.map(([frame, weight]) => svgItem(
        'circle', {class: 'point', r: 5.5, cx: this.x(frame), cy: this.y(weight)})));
    this.showFrame(frameNow());
  }

  showFrame(frame) {
    if (!this.width) return;
    for (const end of ['x1', 'x2']) this.head.setAttribute(end, this.x(frame));
    this.value.textContent = rounded(weightAt(settings, this.name, frame), 2).toFixed(2)
        .replace('-', '−');
  }

  // The frame of the point below a pointer, or null.
  pointAt(event, x, y) {
    const grip = GRIP_PIXELS[event.pointerType] ?? GRIP_PIXELS.mouse;
    let [nearest, found] = [grip, null];
    for (const [frame, weight] of this.curve) {
      const distance = Math.hypot(this.x(frame) - x, this.y(weight) - y);
      if (distance <= nearest) [nearest, found] = [distance, frame];
    }
    return found;
  }

  // A point has changed: shows its frame.
  show(frame) {
    seekAll(frame);
    this.changed(`curve of ${this.text}`);
  }

  connect(ended) {
    const {svg} = this;
    let [held, from] = [null, null];  // the frame of the point that is dragged, and where it was taken
    const place = (event) => {
      const box = svg.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    connectDrag(svg, (event) => {
      if (!this.width) return false;
      const [x, y] = from = place(event);
      held = this.pointAt(event, x, y);
      if (held === null) {
        held = this.frameAt(x);
        setPoint(settings, this.name, held, this.weightAtPixel(y));
      }
      this.show(held);
      return true;
    }, (event) => {
      const [x, y] = place(event);
      if (from && Math.hypot(x - from[0], y - from[1]) < HOLD_PIXELS) return;
      from = null;
      held = movePoint(settings, this.name, held, this.frameAt(x), this.weightAtPixel(y), this.frames);
      this.show(held);
    }, ended);
    svg.addEventListener('contextmenu', (event) => {
      const frame = this.pointAt(event, ...place(event));
      if (frame === null) return;
      event.preventDefault();
      removePoint(settings, this.name, frame);
      this.changed(`remove a point of ${this.text}`);
    });
  }
}

// All lanes.
class Timeline {
  // As Lane.
  constructor(changed, ended) {
    Object.assign(this, {lanes: [], changed, ended});
    new ResizeObserver(() => this.draw()).observe(element('lanes'));
    element('curves').addEventListener('toggle', () => this.draw());
  }

  laneOf(name) { return this.lanes.find((lane) => lane.name === name); }

  // One lane for each class of the model.
  build(classes) {
    if (this.lanes.map((lane) => lane.name).join() === classes.join()) return;
    this.lanes = classes.map((name) => new Lane(name, this.changed, this.ended));
    element('lanes').replaceChildren(...this.lanes.map((lane) => lane.node));
  }

  draw() {
    if (!state.leader) return;
    for (const lane of this.lanes) lane.draw();
  }

  showFrame(frame) {
    for (const lane of this.lanes) lane.showFrame(frame);
  }
}

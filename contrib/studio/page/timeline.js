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

// The curves as the key frames of a request about the frames [first, end): [{frame, weights}], with
// frames that count from `first`. Lines between the points of all curves are exact.
function labelKeyframes(all, classes, first, end) {
  const frames = new Set();
  for (const name of classes) {
    for (const [at] of curveOf(all, name)) frames.add(Math.max(first, Math.min(end - 1, at)));
  }
  return [...frames].sort((a, b) => a - b).map(
      (at) => ({frame: at - first, weights: weightsAt(all, classes, at)}));
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

// The lanes below the scene: a curve for each class. A click adds a point, dragging moves it. With
// keys: Enter adds a point at the current frame, arrows move the focused point, Delete removes it.
const LANE_INSET = 8;      // half of the thumb of the timeline, which the lanes are aligned with
const LANE_MARGIN = 6;     // above and below the greatest weights
const GRIP_PIXELS = {mouse: 9, pen: 12, touch: 20};
const WEIGHT_STEP = 0.05;

// A weight as the sliders step it.
const stepped = (weight) => rounded(Math.round(weight / WEIGHT_STEP) * WEIGHT_STEP, 2);

class Lane {
  // Calls `owner.select(name, frame)` and `owner.changed(name)`.
  constructor(name, owner) {
    this.name = name;
    this.text = name.replaceAll('_', ' ');
    this.owner = owner;
    this.held = null;  // the frame of the point that is dragged
    this.node = Object.assign(document.createElement('div'), {className: 'lane'});
    this.title = Object.assign(document.createElement('span'), {className: 'lane-name'});
    this.value = Object.assign(document.createElement('output'), {className: 'lane-value'});
    this.svg = svgItem('svg', {tabindex: 0, role: 'group', 'aria-label':
      `Curve of ${this.text}: Enter adds a point at the current frame`});
    this.kept = svgItem('rect', {class: 'kept', x: 0, y: 0, height: '100%'});
    this.zero = svgItem('line', {class: 'zero'});
    this.line = svgItem('polyline', {class: 'curve'});
    this.head = svgItem('line', {class: 'playhead', y1: 0, y2: '100%'});
    this.points = [];
    this.svg.append(this.kept, this.zero, this.line, this.head);
    this.node.append(this.title, this.svg, this.value);
    this.title.textContent = this.text;
    this.connect();
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
    this.kept.setAttribute('width', settings.keep > 0 ? this.x(settings.keep - 1) : 0);
    this.drawPoints();
    this.showFrame(frameNow());
  }

  // Keeps the circles, so that the focus stays on a point while it moves.
  drawPoints() {
    const {curve} = this;
    while (this.points.length > curve.length) this.points.pop().remove();
    while (this.points.length < curve.length) {
      const point = svgItem('circle', {class: 'point', tabindex: 0, role: 'slider', r: 5.5,
                                       'aria-valuemin': -MAX_WEIGHT, 'aria-valuemax': MAX_WEIGHT});
      this.points.push(point);
      this.svg.append(point);
    }
    curve.forEach(([frame, weight], i) => {
      const point = this.points[i];
      point.setAttribute('cx', this.x(frame));
      point.setAttribute('cy', this.y(weight));
      point.setAttribute('aria-label', `${this.text} at frame ${frame}`);
      point.setAttribute('aria-valuenow', weight);
      point.dataset.frame = frame;
      point.classList.toggle('selected', this.owner.isSelected(this.name, frame));
    });
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

  focus(frame) {
    this.points.find((point) => Number(point.dataset.frame) === frame)?.focus({preventScroll: true});
  }

  remove(frame) {
    const index = this.curve.findIndex(([at]) => at === frame);
    removePoint(settings, this.name, frame);
    this.owner.select(null);
    this.owner.changed(this.name, 'remove a point of');
    (this.points[Math.min(index, this.points.length - 1)] ?? this.svg).focus({preventScroll: true});
  }

  move(from, frame, weight) {
    const to = movePoint(settings, this.name, from, frame, weight, this.frames);
    this.owner.select(this.name, to);
    this.owner.changed(this.name);
    return to;
  }

  add(frame, weight) {
    setPoint(settings, this.name, frame, weight);
    this.owner.select(this.name, frame);
    this.owner.changed(this.name);
    this.focus(frame);
  }

  connect() {
    const {svg} = this;
    const place = (event) => {
      const box = svg.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    connectDrag(svg, (event) => {
      if (!this.width) return false;
      const [x, y] = place(event);
      this.held = this.pointAt(event, x, y);
      if (this.held === null) {
        this.held = this.frameAt(x);
        this.add(this.held, this.weightAtPixel(y));
      } else {
        this.owner.select(this.name, this.held);
        this.focus(this.held);
      }
      this.from = [x, y];
      return true;
    }, (event) => {
      const [x, y] = place(event);
      if (this.from && Math.hypot(x - this.from[0], y - this.from[1]) < 3) return;
      this.from = null;
      this.held = this.move(this.held, this.frameAt(x), this.weightAtPixel(y));
    }, () => {
      this.held = null;
      this.owner.ended();
    });
    svg.addEventListener('contextmenu', (event) => {
      const frame = this.pointAt(event, ...place(event));
      if (frame === null) return;
      event.preventDefault();
      this.remove(frame);
    });
    svg.addEventListener('focusin', ({target}) => {
      if (target.dataset.frame) this.owner.select(this.name, Number(target.dataset.frame));
    });
    svg.addEventListener('keydown', (event) => this.key(event));
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const frame = event.target.dataset.frame === undefined ? null : Number(event.target.dataset.frame);
    if (frame === null) {
      if (event.key !== 'Enter') return;
      const now = frameNow();
      this.add(now, rounded(weightAt(settings, this.name, now), 2));
    } else {
      const weight = weightAt(settings, this.name, frame);
      const step = event.shiftKey ? 10 : 1;
      const limited = (value) => Math.max(-MAX_WEIGHT, Math.min(MAX_WEIGHT, rounded(value, 2)));
      const keys = {
        ArrowLeft: () => this.move(frame, frame - step, weight),
        ArrowRight: () => this.move(frame, frame + step, weight),
        ArrowUp: () => this.move(frame, frame, limited(weight + step * WEIGHT_STEP)),
        ArrowDown: () => this.move(frame, frame, limited(weight - step * WEIGHT_STEP)),
        Delete: () => this.remove(frame),
        Backspace: () => this.remove(frame),
      };
      if (!keys[event.key]) return;
      keys[event.key]();
      this.owner.ended();
    }
    event.preventDefault();
    event.stopPropagation();
  }
}

// All lanes, and the fields of the selected point.
class Timeline {
  // Calls `changed(what)` after each change of a curve and `ended()` after a gesture.
  constructor(changed, ended) {
    this.lanes = [];
    this.selected = null;  // {name, frame}
    this.tell = changed;
    this.ended = ended;
    new ResizeObserver(() => this.draw()).observe(element('lanes'));
    element('point-frame').addEventListener('change', () => this.edit());
    element('point-weight').addEventListener('input', () => this.edit());
    element('point-remove').addEventListener('click', () => {
      const {name, frame} = this.selected;
      this.laneOf(name).remove(frame);
    });
    element('curves').addEventListener('toggle', () => this.draw());
  }

  laneOf(name) { return this.lanes.find((lane) => lane.name === name); }
  isSelected(name, frame) { return this.selected?.name === name && this.selected.frame === frame; }

  // One lane for each class of the model.
  build(classes) {
    if (this.lanes.map((lane) => lane.name).join() === classes.join()) return;
    this.lanes = classes.map((name) => new Lane(name, this));
    element('lanes').replaceChildren(...this.lanes.map((lane) => lane.node));
  }

  changed(name, verb = 'curve of') { this.tell(`${verb} ${name.replaceAll('_', ' ')}`); }

  select(name, frame) {
    if (name === null || this.isSelected(name, frame)) {
      if (name === null) this.selected = null;
    } else {
      this.selected = {name, frame};
      seekAll(frame);
    }
    this.showSelected();
  }

  showSelected() {
    const {selected} = this;
    const point = selected && curveOf(settings, selected.name).find(([at]) => at === selected.frame);
    if (!point) this.selected = null;
    element('point').hidden = !point;
    element('curves-hint').hidden = Boolean(point);
    for (const lane of this.lanes) {
      for (const node of lane.points) {
        node.classList.toggle('selected', this.isSelected(lane.name, Number(node.dataset.frame)));
      }
    }
    if (!point) return;
    element('point-name').textContent = selected.name.replaceAll('_', ' ');
    element('point-frame').max = state.leader.motion.frames - 1;
    for (const [id, value] of [['point-frame', point[0]], ['point-weight', point[1]]]) {
      if (document.activeElement !== element(id)) element(id).value = value;
    }
  }

  // Takes the fields of the selected point.
  edit() {
    const fields = ['point-frame', 'point-weight'].map(element);
    if (!this.selected || fields.some((field) => field.value === '' || !field.checkValidity())) return;
    const [frame, weight] = fields.map((field) => Number(field.value));
    const {name, frame: from} = this.selected;
    this.laneOf(name).move(from, Math.round(frame), weight);
  }

  draw() {
    if (!state.leader) return;
    for (const lane of this.lanes) lane.draw();
    this.showSelected();
  }

  showFrame(frame) {
    for (const lane of this.lanes) lane.showFrame(frame);
  }
}

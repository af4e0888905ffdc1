'use strict';
// Label curves: for each class a list of points [frame, weight] with ascending frames, linear between
// points and constant outside them. A class without points has the weight of its slider in every
// frame. The functions take the settings, of which they read or change `labels` and `curves`.
const MAX_POINTS = 500;  // of one curve in a link or a session

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

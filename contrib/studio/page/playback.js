'use strict';
// The follower between the frames that have arrived, and how fast answers come.

const SETTLE_SECONDS = 0.08;   // in which a plan that was shown gives way to the final frames
const ARRIVE_SECONDS = 0.4;    // as SETTLE_SECONDS, from a pose that nobody has synthesised
const MEASURED_ANSWERS = 180;
const SHOW_MS = 500;           // between two changes of the figures

// Shows the follower at any time, counted in frames. Frames that are not final yet come from the
// newest plan.
class Playback {
  constructor() {
    this.settle = SETTLE_SECONDS;
    this.clear();
  }

  clear() {
    this.store = null;
    this.plan = [];
    this.planFirst = 0;
    this.last = null;      // {time, pose} without the offset
    this.offset = null;
    this.carried = this.shown ?? null;
  }

  // Shows a pose until the first frame arrives, and goes over to it.
  standAt(pose) {
    this.shown = this.carried = pose;
    this.settle = ARRIVE_SECONDS;
  }

  take(store, part) {
    this.store = store;
    this.plan = part.plan;
    this.planFirst = part.first + part.poses.length;
  }

  frame(index) {
    const {store, plan} = this;
    if (index < store.end) return store.get(Math.max(index, store.first));
    return plan[Math.min(index - this.planFirst, plan.length - 1)] ?? store.get(store.end - 1);
  }

  at(time) {
    const before = Math.floor(time);
    const [a, b] = [this.frame(before), this.frame(before + 1)];
    return a.map((value, i) => mix(value, b[i], time - before));
  }

  // The pose to show at a time, or null before the first frame. `seconds` since the last call.
  show(time, seconds) {
    if (!this.store) return this.shown ?? null;
    const pose = this.at(Math.max(0, time));
    // What was shown for the last time, if it is known better now, and what a session before showed.
    const [was, is] = this.carried ? [this.carried, pose]
        : this.last ? [this.last.pose, this.at(this.last.time)] : [pose, pose];
    this.settle = mix(this.settle, SETTLE_SECONDS, Math.min(1, seconds));
    const left = Math.exp(-seconds / this.settle);
    this.offset = pose.map((_, i) => ((this.offset?.[i] ?? 0) + was[i] - is[i]) * left);
    this.carried = null;
    this.last = {time: Math.max(0, time), pose};
    this.shown = pose.map((value, i) => value + this.offset[i]);
    return this.shown;
  }
}

// The times from the leader's frames to their answers, in words.
class Latencies {
  constructor(figures) {
    Object.assign(this, {figures, times: [], counts: {skipped: 0, resumed: 0}, shown: 0});
  }

  add(ms) {
    if (Number.isFinite(ms)) this.times.push(ms);
    if (this.times.length > MEASURED_ANSWERS) this.times.shift();
  }

  note(kind, count = 1) { this.counts[kind] += count; }

  show(now) {
    if (now - this.shown < SHOW_MS || !this.times.length) return;
    this.shown = now;
    const sorted = [...this.times].sort((a, b) => a - b);
    const within = (share) => sorted[Math.floor(share * (sorted.length - 1))].toFixed(0);
    const {skipped, resumed} = this.counts;
    const text = [`Half within ${within(0.5)} ms`, `99 % within ${within(0.99)} ms`, `${skipped} frames skipped`];
    if (resumed) text.push(`resumed ${resumed} ${resumed === 1 ? 'time' : 'times'}`);
    this.figures.textContent = `${text.join(' · ')}.`;
  }
}

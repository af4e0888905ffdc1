'use strict';
// A live session with the server, over the gateway's WebSocket. It resumes by itself.
const HISTORY_FRAMES = 90;       // until the server's header tells
const RESUME_SECONDS = 2;        // a longer interruption begins a new session
const RETRY_SECONDS = [0.2, 0.5, 1, 2];
const MAX_BUFFERED_BYTES = 2 ** 18;
const NOTICE = {gap: 1, late: 2, skipped: 3, draining: 4};

// Frames by index, of which the last are kept.
class FrameStore {
  constructor() { this.frames = new Map(); this.first = this.end = 0; }
  push(pose) { this.frames.set(this.end++, pose); }
  get(index) { return this.frames.get(index); }
  keep(count) {
    while (this.end - this.first > count) this.frames.delete(this.first++);
  }
  // The values of frames from `first` to before `end`.
  values(first, end) {
    const out = [];
    for (let i = first; i < end; ++i) out.push(...this.frames.get(i));
    return out;
  }
}

// Calls `on.frames(part)` with {first, poses, plan, latency}, `on.notice(kind, count)`,
// `on.state(name, message)` with "open", "away" or "failed", and `on.restart()` when frames count
// from 0 again.
class LiveSession {
  constructor(settings, on) {
    this.settings = settings;  // {model, joints, frameRate, weights, plan, acceptsStart}
    this.on = on;
    this.attempts = 0;
    this.seed = null;  // the server's choice, which a resumed or new session keeps
    this.restart();
    this.connect();
  }

  restart() {
    this.leader = new FrameStore();
    this.follower = new FrameStore();
    this.captures = new Map();
    this.kept = HISTORY_FRAMES;
    this.on.restart();
  }

  get isOpen() { return this.socket?.readyState === WebSocket.OPEN; }
  get joints() { return this.settings.joints.length; }

  connect() {
    const scheme = location.protocol === 'https:' ? 'wss:' : 'ws:';
    const socket = this.socket = new WebSocket(`${scheme}//${location.host}/live`);
    socket.binaryType = 'arraybuffer';
    this.status = null;
    socket.addEventListener('open', () => this.begin());
    socket.addEventListener('message', ({data}) => {
      if (socket !== this.socket) return;
      try {
        if (typeof data === 'string') this.status = JSON.parse(data);
        else this.take(decode('SynthesizeLiveResponse', new Uint8Array(data)));
      } catch (error) {
        console.error(error);
        socket.close();  // and resume
      }
    });
    socket.addEventListener('close', ({reason}) => {
      if (socket === this.socket) this.leave(reason);
    });
  }

  send(message) {
    if (this.isOpen) this.socket.send(encode('SynthesizeLiveRequest', message));
  }

  begin() {
    const {settings} = this;
    // Here and not when it connects: frames are added while the socket opens.
    const wasAwayLong = this.leader.end - this.follower.end > RESUME_SECONDS * settings.frameRate;
    if (wasAwayLong) this.start = this.follower.get(this.follower.end - 1) ?? this.start;
    if (wasAwayLong || this.follower.end === 0) this.restart();  // older frames are of no use
    const {leader, follower} = this;
    const end = Math.min(follower.end, leader.end);
    const first = Math.max(follower.first, end - this.kept);
    const start = {
      model: selectorOf(settings.model),
      leader: {joint_names: settings.joints, frame_rate_hz: settings.frameRate, unit: METRES, up_axis: Y_UP},
      label_vector: messageOf(settings.weights), ...(this.seed !== null && {seed: this.seed}),
      plan_frames: settings.plan,
    };
    // Frames without an answer belong to the start: the server evaluates all of it, whereas it skips
    // evaluations for frames that queue up later.
    const known = end > 0 ? leader.end : 0;
    if (end > 0) {
      start.leader.frame_count = known - first;
      start.leader.positions = leader.values(first, known);
      start.history = {first_frame: first, follower_frame_count: end - first,
                       follower_positions: follower.values(first, end)};
    } else if (this.start && settings.acceptsStart) {
      start.follower_start = {pose: {positions: this.start}};
    }
    this.send({start});
    this.next = end;  // of the follower's frames in this stream
    this.sendFrames(known);
  }

  sendFrames(first) {
    const {leader} = this;
    if (first >= leader.end) return;
    this.send({frames: {first_frame: first, frame_count: leader.end - first,
                        positions: leader.values(first, leader.end),
                        capture_seconds: this.captures.get(leader.end - 1)}});
  }

  // Adds the leader's next frames, captured at `seconds` of performance.now().
  add(poses, seconds) {
    const first = this.leader.end;
    for (const pose of poses) {
      this.captures.set(this.leader.end, seconds);
      this.leader.push(pose);
    }
    this.forget();
    if (!this.isOpen) return;
    if (this.socket.bufferedAmount > MAX_BUFFERED_BYTES) this.socket.close();
    else this.sendFrames(first);
  }

  forget() {
    const behind = Math.min(this.leader.end - this.follower.end, RESUME_SECONDS * this.settings.frameRate + 1);
    this.leader.keep(this.kept + Math.max(0, behind));
    this.follower.keep(this.kept);
    for (const index of this.captures.keys()) {
      if (index >= this.leader.first) break;
      this.captures.delete(index);
    }
  }

  // Changes the labels within `ease` seconds.
  changeLabels(weights, ease) {
    this.settings.weights = weights;
    this.send({label_change: {label_vector: messageOf(weights),
                              ease_frames: Math.round(ease * this.settings.frameRate)}});
  }

  take(message) {
    const {header, frames, notice} = message;
    if (header) {
      this.kept = Math.max(1, header.history_frames ?? 0);
      this.seed = header.seed ?? 0;
      this.attempts = 0;
      this.on.state('open', '');
    } else if (frames) {
      this.takeFrames(frames);
    } else if (notice) {
      this.on.notice(notice.kind ?? 0, notice.frames?.frame_count ?? 0);
      if (notice.kind === NOTICE.draining) this.socket.close();
    }
  }

  takeFrames({first_frame: first = 0, frame_count: count, positions, plan_positions: plan,
              capture_seconds: captured}) {
    const size = this.joints * 3;
    const cut = (values) => Array.from({length: values.length / size}, (_, i) =>
      Float32Array.from(values.slice(i * size, (i + 1) * size)));
    if (first !== this.next) throw new Error(`frames: expected ${this.next}, got ${first}`);
    this.next += count;
    const poses = cut(positions).slice(Math.max(0, this.follower.end - first));
    if (poses.length === 0) return;
    const begin = this.follower.end;
    for (const pose of poses) this.follower.push(pose);
    this.forget();
    const latency = performance.now() / 1000 - (captured ?? this.captures.get(begin) ?? NaN);
    this.on.frames({first: begin, poses, plan: cut(plan), latency});
  }

  // The socket has closed.
  leave(reason) {
    const {status} = this;
    const isFinal = status && ![0, 1, 4, 8, 13, 14].includes(status.code);
    const message = status?.message || reason || '';
    if (isFinal) {
      this.on.state('failed', message);
      return;
    }
    this.on.state('away', message);
    const wait = RETRY_SECONDS[Math.min(this.attempts++, RETRY_SECONDS.length - 1)];
    this.timer = setTimeout(() => this.connect(), 1000 * wait);
  }

  // Ends the session.
  close() {
    clearTimeout(this.timer);
    const {socket} = this;
    this.socket = null;
    socket?.close();
  }
}

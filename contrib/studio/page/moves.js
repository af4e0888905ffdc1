'use strict';
// What the keys throw: the leaders that the gateway has for the model's classes.

// Blows go through a partner who stands too near: the leader first steps back until there is room.
const BLOWS = ['kick', 'push', 'punch'];
const ROOM_METRES = 0.2;     // from the furthest hand or ankle to the middle of the partner's hips
const STEP_BACK_SECONDS = 0.8;  // at most
const MAX_MOVES = 9;         // keys 1 to 9
// Leaders that suit a class of another name.
const SUITS = {shake_hands: 'meet_hands', high_five: 'meet_hands'};
// Leaders who ask for nothing.
const NEUTRAL = ['wave', 'sit'];

// A sample in a model's joints, {frameRate, frames}: each frame a Float32Array [joints, 3].
async function sampleOf(name, model) {
  const {motion} = await readMotion(`${name}.bvh`, await fetchSample(name), model);
  const values = motion.joint_names.length * 3;
  return {frameRate: motion.frame_rate_hz, frames: Array.from(
      {length: motion.frames}, (_, i) => motion.positions.slice(i * values, (i + 1) * values))};
}

// The class that a move asks for: that of its name, or of the table; null if the model has neither.
function labelOf(name, classes) {
  return [name, SUITS[name]].find((label) => classes.includes(label)) ?? null;
}

// {rest, moves}, where moves are [{leader, name, label, clip}]: those of the model's classes, in their order, then
// those that ask for nothing.
async function movesFor(model, leaders, body) {
  const classes = model.interaction_classes;
  const names = classes.flatMap((label) => leaders.filter((name) => labelOf(name, classes) === label))
                    .concat(NEUTRAL).slice(0, MAX_MOVES);
  const motions = await Promise.all(names.map((name) => sampleOf(name, model)));
  return {
    rest: motions[0].frames[0],
    moves: names.map((name, i) => ({
      leader: name, name: name.replaceAll('_', ' '), label: labelOf(name, classes),
      clip: new Clip(body, motions[i].frames, motions[i].frameRate),
    })),
  };
}

// Lets the leader do one move after another.
class Choreography {
  // `distance()`: from the leader to the partner, metres.
  constructor(leader, moves, distance) {
    Object.assign(this, {leader, moves, distance});
    this.backing = 0;      // seconds for which the leader still steps back before the move
    this.current = null;   // the move being done
    leader.ended = () => this.begin(null);
  }

  // Begins a move, or ends one with null.
  begin(move) {
    this.current = move;
    this.backing = move && this.isNear(move) ? STEP_BACK_SECONDS : 0;
    this.leader.backs = this.backing > 0;
    this.leader.play(this.backing > 0 ? null : move && move.clip);
    this.began?.(move);
  }

  isNear({label, clip}) {
    return BLOWS.includes(label) && this.distance() < clip.reach + ROOM_METRES;
  }

  // Begins the move for which the leader has stepped back.
  stepBack(seconds) {
    if (this.backing === 0) return;
    this.backing = this.isNear(this.current) ? Math.max(0, this.backing - seconds) : 0;
    if (this.backing > 0) return;
    this.leader.backs = false;
    this.leader.play(this.current.clip);
  }

  // Moves the leader; called for every step of time.
  advance(seconds) {
    this.stepBack(seconds);
    this.leader.advance(seconds);
  }
}

'use strict';
// The scene: the leader, and the chosen answer.
const theatre = document.getElementById('stage');

const bonesOf = (motion) => {
  const index = (joint) => motion.joint_names.indexOf(state.model.joint_names[joint]);
  return state.model.bones.map((bone) => [index(bone.parent_joint ?? 0),
                                          index(bone.child_joint ?? 0)]);
};

function motionOf({motion}, follower) {
  return {
    joints: motion.joint_names, frameRate: motion.frame_rate_hz, frames: motion.frames,
    leader: motion.positions, bones: bonesOf(motion),
    ...(follower && {follower: follower.slice()}),  // the next answer's chunks are written into it
  };
}

// Shows the leader with or without a follower, and keeps the frame and the state of playback.
function showMotion(leader, follower) {
  const before = theatre.player;
  const [frame, playing] = before ? [before.frame, before.playing] : [0, null];
  const same = theatre.shownLeader === leader;
  theatre.hidden = false;
  if (follower && same) theatre.setFollower(follower.slice());
  else theatre.motion = motionOf(leader, follower);
  theatre.shownLeader = leader;
  if (!same || playing === null || !theatre.player) return;
  theatre.player.playing = playing;
  theatre.seek(frame);
}

function showNothing() {
  theatre.hidden = true;
  theatre.leaveStage();
  theatre.shownLeader = theatre.player = null;
}

const frameNow = () => Math.round(theatre.player?.frame ?? 0);

function showTime() {
  const {motion, player} = theatre;
  element('scrub').value = Math.round(player.frame);
  element('scrub').setAttribute('aria-valuetext', `frame ${Math.round(player.frame)}`);
  element('time').value = `${(player.frame / motion.frameRate).toFixed(2)} / ` +
                          `${motion.duration.toFixed(2)} s`;
  element('time').title = `frame ${Math.round(player.frame)} of ${motion.frames - 1}`;
  element('play').textContent = player.playing ? 'Pause' : 'Play';
  root.dataset.draws = theatre.draws;
}

// Pauses at a frame.
function seekAll(frame) {
  if (!theatre.player) return;
  theatre.player.playing = false;
  theatre.seek(frame);
}

const SVG = 'http://www.w3.org/2000/svg';

function svgItem(kind, attributes) {
  const item = document.createElementNS(SVG, kind);
  for (const [name, value] of Object.entries(attributes)) item.setAttribute(name, value);
  return item;
}

// Lets an item over the scene be dragged. `hold(event)` returns whether the pointer takes hold of it.
function connectDrag(item, hold, move, drop) {
  let isHeld = false;
  item.addEventListener('pointerdown', (event) => {
    isHeld = event.button === 0 && hold(event);
    if (!isHeld) return;
    item.setPointerCapture(event.pointerId);
    event.preventDefault();
    event.stopPropagation();
  });
  item.addEventListener('pointermove', (event) => {
    if (isHeld) move(event);
  });
  for (const kind of ['pointerup', 'pointercancel']) {
    item.addEventListener(kind, () => {
      if (isHeld) drop();
      isHeld = false;
    });
  }
}

// Calls `follow` after each redraw.
function connectStage(follow) {
  theatre.addEventListener('drawn', () => {
    showTime();
    follow();
  });
  theatre.addEventListener('error', ({detail}) => tell(detail.message, true));
  element('play').addEventListener('click', () => theatre.toggle());
  element('scrub').addEventListener('input', () => seekAll(Number(element('scrub').value)));
}

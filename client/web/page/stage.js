'use strict';
// The 3D views: one answer, or four side by side that follow the time of the first.
const theatre = document.getElementById('stage');

const bonesOf = (leader) => {
  const index = (joint) => leader.joint_names.indexOf(state.model.joint_names[joint]);
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

const fourStages = () => [...element('four').querySelectorAll('duet-motion')];
const stages = () => (element('four').hidden ? [theatre] : fourStages());

// Shows the leader with or without a follower, and keeps the frame and the state of playback.
function showOne(leader, follower) {
  const before = stages()[0].player;
  const [frame, playing] = before ? [before.frame, before.playing] : [0, null];
  element('four').hidden = true;
  element('four').replaceChildren();
  theatre.hidden = false;
  if (follower && theatre.shownLeader === leader) {
    theatre.setFollower(follower.slice());
  } else {
    theatre.motion = motionOf(leader, follower);
  }
  const same = theatre.shownLeader === leader;
  theatre.shownLeader = leader;
  if (!same || playing === null || !theatre.player) return;
  theatre.player.playing = playing;
  theatre.seek(frame);
}

// Describes a MotionGrade, which leaves out figures that are 0; '' without one.
function describeGrade(grade) {
  if (!grade) return '';
  const percent = (name) => `${Math.round(100 * (grade[name] ?? 0))} %`;
  return `Twisted ${percent('twisted')}, both feet move ${percent('skating')} (leader ${
      percent('leader_skating')}), overlapping ${percent('overlapping')}.`;
}

// Shows several answers. Calls `keep` with the index of the answer that the visitor chooses.
function showFour(leader, takes, keep) {
  const before = stages()[0].player;
  const cells = takes.map((take, index) => {
    const cell = document.createElement('figure');
    const stage = document.createElement('duet-motion');
    stage.setAttribute('aria-label', `Answer ${index + 1}, seed ${take.seed}`);
    const caption = document.createElement('figcaption');
    addButton(caption, `Keep seed ${take.seed}`, () => keep(index));
    const grade = document.createElement('p');
    grade.textContent = describeGrade(take.grade);
    caption.append(grade);
    cell.append(stage, caption);
    return cell;
  });
  theatre.hidden = true;
  element('four').replaceChildren(...cells);
  element('four').hidden = false;
  fourStages().forEach((stage, index) => {
    stage.motion = motionOf(leader, takes[index].positions);
    if (index > 0) {
      stage.pause();
      return;
    }
    stage.addEventListener('drawn', () => {
      for (const other of fourStages().slice(1)) {
        if (other.player && other.frame !== stage.frame) other.seek(stage.frame);
      }
      showTime(stage);
    });
    if (before) {
      stage.player.playing = before.playing;
      stage.seek(before.frame);
    }
  });
}

function showTime(stage) {
  const {motion, player} = stage;
  element('scrub').value = Math.round(player.frame);
  element('scrub').setAttribute('aria-valuetext', `frame ${Math.round(player.frame)}`);
  element('time').value = `${(player.frame / motion.frameRate).toFixed(2)} of ` +
                          `${motion.duration.toFixed(2)} s`;
  element('play').textContent = player.playing ? 'Pause' : 'Play';
  root.dataset.draws = stage.draws;
}

// Pauses at a frame.
function seekAll(frame) {
  const [first] = stages();
  if (!first.player) return;
  first.player.playing = false;
  first.seek(frame);
}

function connectStages() {
  theatre.addEventListener('drawn', () => {
    if (!theatre.hidden) showTime(theatre);
  });
  theatre.addEventListener('error', ({detail}) => tell(detail.message, true));
  element('play').addEventListener('click', () => stages()[0].toggle());
  element('scrub').addEventListener('input', () => seekAll(Number(element('scrub').value)));
}

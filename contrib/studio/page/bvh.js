'use strict';
// Reads the motion of one person from BVH text.

const CENTIMETRE = 0.01;

// A 3 by 3 matrix, row by row, that rotates by degrees about an axis.
function rotationAbout(axis, degrees) {
  const [c, s] = [Math.cos(degrees * Math.PI / 180), Math.sin(degrees * Math.PI / 180)];
  return {X: [1, 0, 0, 0, c, -s, 0, s, c], Y: [c, 0, s, 0, 1, 0, -s, 0, c],
          Z: [c, -s, 0, s, c, 0, 0, 0, 1]}[axis];
}

function timesMatrix(a, b) {
  return a.map((_, i) => [0, 1, 2].reduce(
      (sum, k) => sum + a[Math.floor(i / 3) * 3 + k] * b[k * 3 + i % 3], 0));
}

const timesVector = (m, v) => [0, 3, 6].map(
    (row) => m[row] * v[0] + m[row + 1] * v[1] + m[row + 2] * v[2]);

// The joints of a HIERARCHY: [{name, parent, offset, channels}], parents first.
function readHierarchy(lines) {
  const joints = [];
  const open = [];
  for (const line of lines) {
    const words = line.trim().split(/\s+/);
    if (['ROOT', 'JOINT', 'End'].includes(words[0])) {
      joints.push({name: words[0] === 'End' ? '' : words[1], parent: open[open.length - 1] ?? -1,
                   offset: [0, 0, 0], channels: []});
    } else if (words[0] === '{') {
      open.push(joints.length - 1);
    } else if (words[0] === '}') {
      open.pop();
    } else if (words[0] === 'OFFSET') {
      joints[joints.length - 1].offset = words.slice(1, 4).map(Number);
    } else if (words[0] === 'CHANNELS') {
      joints[joints.length - 1].channels = words.slice(2);
    }
  }
  return joints;
}

// The places of all joints in one frame.
function placeJoints(joints, values) {
  let next = 0;
  const places = [];
  const turns = [];
  for (const {parent, offset, channels} of joints) {
    const at = [...offset];
    let turn = [1, 0, 0, 0, 1, 0, 0, 0, 1];
    for (const channel of channels) {
      const value = values[next++];
      if (channel.endsWith('position')) at['XYZ'.indexOf(channel[0])] += value;
      else turn = timesMatrix(turn, rotationAbout(channel[0], value));
    }
    if (parent < 0) {
      places.push(at);
      turns.push(turn);
    } else {
      const from = timesVector(turns[parent], at);
      places.push(from.map((value, axis) => places[parent][axis] + value));
      turns.push(timesMatrix(turns[parent], turn));
    }
  }
  return places;
}

// {frameRate, frames}: each frame a Float32Array [names, 3] in metres, for the joints `names`, or
// null if the file lacks one of them.
function readBvh(text, names) {
  const [head, motion] = text.split(/^MOTION\s*$/m);
  const joints = readHierarchy(head.split('\n'));
  const wanted = names.map((name) => joints.findIndex((joint) => joint.name === name));
  if (wanted.includes(-1)) return null;
  const lines = motion.trim().split('\n');
  const frames = lines.slice(2).map((line) => {
    const places = placeJoints(joints, line.trim().split(/\s+/).map(Number));
    return Float32Array.from(wanted.flatMap((joint) => places[joint]), (value) => value * CENTIMETRE);
  });
  return {frameRate: Math.round(1 / Number(lines[1].split(':')[1])), frames};
}

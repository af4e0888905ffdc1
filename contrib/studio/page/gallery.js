'use strict';
// The gallery: several answers as moving thumbnails with their grades. Choosing one shows it in the
// scene. The tiles are radio buttons: arrow keys move the choice.
const gallery = {tiles: [], thumbnails: [], order: 'grade'};

// Describes a MotionGrade, which leaves out figures that are 0; '' without one.
function describeGrade(grade) {
  if (!grade) return '';
  const percent = (name) => {
    const share = grade[name] ?? 0;
    return share > 0 && share < 0.005 ? 'below 1 %' : `${Math.round(100 * share)} %`;
  };
  return `Twisted ${percent('twisted')}, both feet move ${percent('skating')} (leader ${
      percent('leader_skating')}), overlapping ${percent('overlapping')}.`;
}

// How much of an answer a viewer would fault: frames that are twisted or overlap, and those that
// skate beyond the leader's. Infinity without a grade.
function faultsOf({grade}) {
  if (!grade) return Infinity;
  const {twisted = 0, overlapping = 0, skating = 0, leader_skating: leaders = 0} = grade;
  return twisted + overlapping + Math.max(0, skating - leaders);
}

// The takes' indices in the order of the tiles. Equal grades keep the order of the seeds.
function galleryOrder(takes, order) {
  const indices = takes.map((take, index) => index);
  if (order !== 'grade') return indices;
  return indices.sort((a, b) => (faultsOf(takes[a]) - faultsOf(takes[b])) || a - b);
}

// The worst fault of a grade in percent, [name, percent]; ['', 0] if all are below 1 %.
function worstFault(grade) {
  const {twisted = 0, overlapping = 0, skating = 0, leader_skating: leaders = 0} = grade;
  return [['overlap', overlapping], ['twist', twisted], ['slide', Math.max(0, skating - leaders)]]
      .map(([name, share]) => [name, Math.round(100 * share)])
      .reduce((worst, fault) => (fault[1] > worst[1] ? fault : worst), ['', 0]);
}

function makeTile(text) {
  const tile = document.createElement('button');
  Object.assign(tile, {type: 'button', className: 'answer'});
  tile.setAttribute('role', 'radio');
  const canvas = document.createElement('canvas');
  canvas.setAttribute('aria-hidden', 'true');
  const title = Object.assign(document.createElement('span'), {className: 'seed', textContent: text});
  tile.append(title, canvas);
  return tile;
}

function addGrade(tile, grade) {
  const list = Object.assign(document.createElement('span'), {className: 'grade'});
  const [name, percent] = worstFault(grade);
  list.classList.add(percent > 25 ? 'bad' : percent > 5 ? 'fair' : 'good');
  list.textContent = name ? `${name} ${percent} %` : 'no faults';
  tile.append(list);
}

// Shows tiles without pictures while the answers are on their way.
function awaitGallery(count) {
  gallery.thumbnails = [];
  gallery.tiles = Array.from({length: count}, () => {
    const tile = makeTile('…');
    tile.disabled = true;
    tile.classList.add('waiting');
    return tile;
  });
  element('answers').replaceChildren(...gallery.tiles);
  element('gallery').hidden = false;
}

function arriveInGallery(index) { gallery.tiles[index]?.classList.add('arrived'); }

// Shows the answers. Calls `choose` with the index of the one that the visitor chooses.
function showGallery(choose) {
  const {leader, takes} = state;
  element('gallery').hidden = takes.length < 2;
  if (takes.length < 2) {
    gallery.tiles = gallery.thumbnails = [];
    element('answers').replaceChildren();
    return;
  }
  const view = new ThumbnailView(leader.motion.positions, takes.map((take) => take.positions));
  const bones = bonesOf(leader.motion).filter((bone) => Math.min(...bone) >= 0);
  const order = galleryOrder(takes, gallery.order);
  const best = galleryOrder(takes, 'grade')[0];
  gallery.tiles = order.map((index) => {
    const take = takes[index];
    const tile = makeTile(`seed ${take.seed}`);
    tile.dataset.index = index;
    tile.setAttribute('aria-label', `Seed ${take.seed}. ${describeGrade(take.grade)}`);
    tile.title = describeGrade(take.grade);
    if (take.grade) addGrade(tile, take.grade);
    if (index === best && take.grade) tile.classList.add('best');
    tile.addEventListener('click', () => choose(index));
    return tile;
  });
  gallery.thumbnails = order.map((index, i) => new Thumbnail(
      gallery.tiles[i].querySelector('canvas'), view, leader.motion, takes[index].positions, bones));
  element('answers').replaceChildren(...gallery.tiles);
  showChoice();
  drawGallery();
}

// Marks the chosen tile, the only one that Tab reaches.
function showChoice() {
  for (const tile of gallery.tiles) {
    const isChosen = Number(tile.dataset.index) === state.chosen;
    tile.setAttribute('aria-checked', isChosen);
    tile.tabIndex = isChosen ? 0 : -1;
  }
}

function drawGallery() {
  for (const thumbnail of gallery.thumbnails) thumbnail.draw(theatre.frame);
}

// Chooses the tile at a place of the gallery.
function chooseTile(place) {
  const tile = gallery.tiles[place];
  if (!tile || tile.disabled) return;
  tile.click();
  tile.focus({preventScroll: true});
  tile.scrollIntoView({block: 'nearest', inline: 'nearest'});
}

function connectGallery(choose) {
  const keys = {ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1};
  element('answers').addEventListener('keydown', (event) => {
    const count = gallery.tiles.length;
    const now = gallery.tiles.indexOf(event.target);
    if (now < 0) return;
    if (event.key in keys) chooseTile((now + keys[event.key] + count) % count);
    else if (event.key === 'Home') chooseTile(0);
    else if (event.key === 'End') chooseTile(count - 1);
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
  element('order').addEventListener('change', () => {
    gallery.order = element('order').value;
    showGallery(choose);
  });
  new ResizeObserver(drawGallery).observe(element('answers'));
}

// Small moving pictures of answers, drawn with lines. (A browser has few WebGL contexts.)
const THICKNESS = [  // metres
  [/head/, 0.1], [/shoulder|neck|hip|torso|spine|chest/, 0.15], [/knee/, 0.13], [/foot|ankle|toe/, 0.1],
  [/elbow/, 0.095], [/hand|wrist/, 0.08],
];
const HEAD_METRES = 0.12;
const THUMBNAIL_COLOURS = {leader: '#f0a04b', follower: '#4fb3bf'};
const MARGIN_METRES = 0.16;

// A camera far away that sees all answers from the side, a little from above, with the leader left
// if that is where the first answer puts it. `people`: Float32Arrays of the same joints.
class ThumbnailView {
  constructor(leader, answers) {
    const [from, to] = [leader, answers[0]].map(ThumbnailView.centre);
    let [x, z] = [to[0] - from[0], to[2] - from[2]];
    const length = Math.hypot(x, z);
    [x, z] = length > 0.05 ? [x / length, z / length] : [0, 1];
    // Towards the camera: across the line between the people, as the scene's first view.
    const d = [-z * 0.82 - x * 0.42, 0.3, x * 0.82 - z * 0.42];
    const size = Math.hypot(...d);
    this.towards = d.map((value) => value / size);
    const [dx, dy, dz] = this.towards;
    const flat = Math.hypot(dx, dz);
    this.right = [dz / flat, 0, -dx / flat];
    this.up = [-dy * dx / flat, flat, -dy * dz / flat];
    this.fit([leader, ...answers]);
  }

  static centre(positions) {
    const sum = [0, 0, 0];
    for (let i = 0; i < positions.length; ++i) sum[i % 3] += positions[i];
    return sum.map((value) => value * 3 / positions.length);
  }

  // The position on the picture's plane and the depth, metres.
  see(positions, i) {
    const dot = (axis) => positions[i] * axis[0] + positions[i + 1] * axis[1] +
        positions[i + 2] * axis[2];
    return [dot(this.right), dot(this.up), dot(this.towards)];
  }

  fit(people) {
    this.box = [Infinity, Infinity, -Infinity, -Infinity];
    this.floor = Infinity;
    for (const positions of people) {
      for (let i = 0; i < positions.length; i += 3) {
        const [x, y] = this.see(positions, i);
        this.floor = Math.min(this.floor, positions[i + 1]);
        this.box = [Math.min(this.box[0], x), Math.min(this.box[1], y), Math.max(this.box[2], x),
                    Math.max(this.box[3], y)];
      }
    }
    this.box = this.box.map((value, i) => value + (i < 2 ? -MARGIN_METRES : MARGIN_METRES));
  }
}

class Thumbnail {
  constructor(canvas, view, {joint_names: joints, positions: leader}, follower, bones) {
    Object.assign(this, {canvas, view, joints, bones, people: {leader, follower}});
    const width = (name) => (THICKNESS.find(([pattern]) => pattern.test(name)) ?? [0, 0.08])[1];
    this.widths = bones.map(([, child]) => width(joints[child]));
    this.head = joints.indexOf('head');
    this.sides = ['left_shoulder', 'right_shoulder', 'right_hip', 'left_hip']
        .map((name) => joints.indexOf(name));
  }

  draw(frame) {
    const {canvas, view} = this;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [width, height] = [canvas.clientWidth * ratio, canvas.clientHeight * ratio].map(Math.round);
    if (!width || !height) return;
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
    const paint = canvas.getContext('2d');
    const [left, bottom, right, top] = view.box;
    const scale = Math.min(width / (right - left), height / (top - bottom));
    this.scale = scale;
    this.place = ([x, y]) => [width / 2 + (x - (left + right) / 2) * scale,
                              height / 2 - (y - (bottom + top) / 2) * scale];
    paint.clearRect(0, 0, width, height);
    paint.lineCap = paint.lineJoin = 'round';
    const at = Math.max(0, Math.round(frame)) * this.joints.length * 3;
    const strokes = Object.keys(this.people).flatMap((person) => {
      this.shade(paint, person, at);
      return this.strokesOf(person, at);
    });
    for (const stroke of strokes.sort((a, b) => a.depth - b.depth)) stroke.draw(paint);
  }

  // A shadow on the floor below the middle of a person.
  shade(paint, person, at) {
    const positions = this.people[person];
    const root = [positions[at + this.sides[2] * 3], this.view.floor,
                  positions[at + this.sides[2] * 3 + 2]];
    if (!Number.isFinite(root[0])) return;
    const [x, y] = this.place(this.view.see(root, 0));
    paint.fillStyle = 'rgba(0, 0, 0, .28)';
    paint.beginPath();
    paint.ellipse(x, y, 0.32 * this.scale, 0.1 * this.scale, 0, 0, 2 * Math.PI);
    paint.fill();
  }

  strokesOf(person, at) {
    const positions = this.people[person];
    const see = (joint) => this.view.see(positions, at + joint * 3);
    const colour = THUMBNAIL_COLOURS[person];
    const line = (points, metres, depth, fill) => ({
      depth,
      draw: (paint) => {
        paint.beginPath();
        points.forEach((point, i) => paint[i ? 'lineTo' : 'moveTo'](...this.place(point)));
        if (fill) paint.closePath();
        // A dark edge separates limbs.
        for (const [style, more] of [['rgba(20, 22, 26, .75)', 0.03], [colour, 0]]) {
          paint.strokeStyle = paint.fillStyle = style;
          paint.lineWidth = (metres + more) * this.scale;
          if (fill) paint.fill();
          paint.stroke();
        }
      },
    });
    const strokes = this.bones.map(([parent, child], i) => {
      const ends = [see(parent), see(child)];
      return line(ends, this.widths[i], (ends[0][2] + ends[1][2]) / 2, false);
    });
    if (Math.min(...this.sides) >= 0) {
      const corners = this.sides.map(see);
      strokes.push(line(corners, 0.1, corners.reduce((sum, [, , z]) => sum + z / 4, 0.02), true));
    }
    if (this.head >= 0) {
      const [x, y, depth] = see(this.head);
      strokes.push(line([[x, y], [x, y + 1e-3]], 2 * HEAD_METRES, depth, false));
    }
    return strokes;
  }
}

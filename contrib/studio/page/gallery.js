'use strict';
// The gallery: several answers as pictures with their grades, the best first. Choosing one shows it in
// the scene. The tiles are radio buttons: arrow keys move the choice.
const PICTURE_PIXELS = 200;  // the height of a tile's picture

const gallery = {tiles: []};

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
const galleryOrder = (takes) => takes.map((take, index) => index)
    .sort((a, b) => (faultsOf(takes[a]) - faultsOf(takes[b])) || a - b);

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
  const {takes} = state;
  element('gallery').hidden = takes.length < 2;
  if (takes.length < 2) {
    gallery.tiles = [];
    element('answers').replaceChildren();
    return;
  }
  const order = galleryOrder(takes);
  gallery.tiles = order.map((index, place) => {
    const take = takes[index];
    const tile = makeTile(`seed ${take.seed}`);
    tile.dataset.index = index;
    tile.setAttribute('aria-label', `Seed ${take.seed}. ${describeGrade(take.grade)}`);
    tile.title = describeGrade(take.grade);
    if (take.grade) addGrade(tile, take.grade);
    if (place === 0 && take.grade) tile.classList.add('best');
    tile.addEventListener('click', () => choose(index));
    return tile;
  });
  element('answers').replaceChildren(...gallery.tiles);
  showChoice();
  drawPictures();
}

// Draws each answer in the middle of the motion, from where the visitor looks at the scene.
function drawPictures() {
  const {player, canvas} = theatre;
  if (!player || !canvas.width || !canvas.height) return;
  const {frame} = player;
  theatre.seek(Math.floor(theatre.frames / 2));
  for (const tile of gallery.tiles) {
    theatre.setFollower(state.takes[tile.dataset.index].positions);
    theatre.draw();
    const picture = tile.querySelector('canvas');
    picture.height = PICTURE_PIXELS;
    picture.width = Math.round(PICTURE_PIXELS * canvas.width / canvas.height);
    picture.getContext('2d').drawImage(canvas, 0, 0, picture.width, picture.height);
  }
  theatre.setFollower(state.takes[state.chosen].positions.slice());
  theatre.seek(frame);
}

// Marks the chosen tile, the only one that Tab reaches.
function showChoice() {
  for (const tile of gallery.tiles) {
    const isChosen = Number(tile.dataset.index) === state.chosen;
    tile.setAttribute('aria-checked', isChosen);
    tile.tabIndex = isChosen ? 0 : -1;
  }
}

// Chooses the tile at a place of the gallery.
function chooseTile(place) {
  const tile = gallery.tiles[place];
  if (!tile || tile.disabled) return;
  tile.click();
  tile.focus({preventScroll: true});
  tile.scrollIntoView({block: 'nearest', inline: 'nearest'});
}

function connectGallery() {
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
}

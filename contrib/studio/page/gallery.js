'use strict';
// The gallery: several answers as pictures with their grades, the best first. Choosing one shows it in
// the scene.
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

// The shares of frames that a viewer would fault: those that overlap or are twisted, and those that
// slide beyond the leader's.
const faultsOf = ({twisted = 0, overlapping = 0, skating = 0, leader_skating: leaders = 0}) => ({
  overlap: overlapping, twist: twisted, slide: Math.max(0, skating - leaders)});

// The takes' indices in the order of the tiles. Equal grades keep the order of the seeds.
function galleryOrder(takes) {
  const faults = takes.map(({grade}) => (grade
      ? Object.values(faultsOf(grade)).reduce((sum, share) => sum + share, 0) : Infinity));
  return takes.map((take, index) => index).sort((a, b) => (faults[a] - faults[b]) || a - b);
}

function makeTile({seed, grade}) {
  const tile = Object.assign(document.createElement('button'), {
    type: 'button', className: 'answer', title: describeGrade(grade)});
  tile.setAttribute('aria-label', `Seed ${seed}. ${tile.title}`);
  tile.append(Object.assign(document.createElement('span'), {className: 'seed', textContent: `seed ${seed}`}),
              document.createElement('canvas'));
  if (grade) tile.append(makeGrade(grade));
  return tile;
}

// The worst fault in percent.
function makeGrade(grade) {
  const [name, percent] = Object.entries(faultsOf(grade)).map(([fault, share]) => [fault, Math.round(100 * share)])
      .reduce((worst, fault) => (fault[1] > worst[1] ? fault : worst), ['', 0]);
  return Object.assign(document.createElement('span'), {
    className: `grade ${percent > 25 ? 'bad' : percent > 5 ? 'fair' : 'good'}`,
    textContent: name ? `${name} ${percent} %` : 'no faults'});
}

// Shows the answers. Calls `choose` with the index of the one that the visitor chooses.
function showGallery(choose) {
  const {takes} = state;
  element('gallery').hidden = takes.length < 2;
  const order = takes.length < 2 ? [] : galleryOrder(takes);
  gallery.tiles = order.map((index, place) => {
    const tile = makeTile(takes[index]);
    tile.dataset.index = index;
    if (place === 0 && takes[index].grade) tile.classList.add('best');
    tile.addEventListener('click', () => choose(index));
    return tile;
  });
  element('answers').replaceChildren(...gallery.tiles);
  showChoice();
  if (order.length > 0) drawPictures();
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

// Marks the chosen tile.
function showChoice() {
  for (const tile of gallery.tiles) {
    tile.setAttribute('aria-pressed', Number(tile.dataset.index) === state.chosen);
  }
}

// Chooses the tile at a place of the gallery.
function chooseTile(place) {
  const tile = gallery.tiles[place];
  if (!tile) return;
  tile.click();
  tile.focus({preventScroll: true});
  tile.scrollIntoView({block: 'nearest', inline: 'nearest'});
}

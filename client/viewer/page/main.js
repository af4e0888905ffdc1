// Puts the page together. `document.documentElement.dataset` tells programs how it stands: state
// (loading, ready, failed), frames, frame, draws, triangles, error.
const COLOURS = {leader: 0xf0a04b, follower: 0x4fb3bf};
const root = document.documentElement;

function fail(message) {
  root.dataset.state = 'failed';
  root.dataset.error = message;
  const box = document.getElementById('failure');
  box.hidden = false;
  box.textContent = message;
}

window.addEventListener('error', (event) => fail(event.message));
window.addEventListener('unhandledrejection', (event) => fail(String(event.reason)));

// "#frame=12&view=side&paused", or the same after "?".
function openingState() {
  const text = `${location.search.slice(1)}&${location.hash.slice(1)}`;
  const state = {};
  for (const part of text.split('&')) {
    const [key, value] = part.split('=');
    if (key) state[key] = value === undefined ? '' : decodeURIComponent(value);
  }
  return state;
}

function webGlWorks() {
  const canvas = document.createElement('canvas');
  return Boolean(canvas.getContext('webgl') || canvas.getContext('experimental-webgl'));
}

function start() {
  const data = JSON.parse(document.getElementById('data').textContent);
  const motion = new Motion(data);
  root.dataset.frames = motion.frames;
  if (!webGlWorks()) {
    fail('This browser shows no WebGL: switch on hardware acceleration, or try another browser.');
    return;
  }

  const stage = new Stage(document.getElementById('stage'), motion);
  const player = new Player(motion);
  const panel = new Panel(data, motion, player);
  const people = {};
  for (const [name, colour] of Object.entries(COLOURS)) {
    const figure = new Figure(motion, name, colour);
    stage.scene.add(figure.group);
    people[name] = {figure, path: stage.addPath(name, colour)};
  }

  let view = 'reset';  // until the camera is moved by hand
  let stale = true;    // something changed since the last drawing
  let draws = 0;
  const touch = () => { stale = true; };
  const chooseView = (name) => {
    view = name;
    stage.view(name);
    for (const button of document.querySelectorAll('[data-view]')) {
      button.classList.toggle('chosen', button.dataset.view === name && name !== 'reset');
    }
    touch();
  };

  const resize = () => {
    stage.resize();
    if (view) chooseView(view);
    touch();
  };
  window.addEventListener('resize', resize);
  stage.controls.addEventListener('change', touch);
  stage.controls.addEventListener('start', () => {
    view = null;
    document.getElementById('hint').classList.add('gone');
    for (const button of document.querySelectorAll('[data-view]')) button.classList.remove('chosen');
  });
  connectInput({player, people, chooseView, touch});

  const opening = openingState();
  if ('frame' in opening) player.seek(Number(opening.frame) || 0);
  if ('paused' in opening) player.playing = false;
  if (['front', 'side', 'top'].includes(opening.view)) view = opening.view;
  resize();

  let before = null;
  function tick(now) {
    // A tab that slept does not leap ahead.
    const seconds = before === null ? 0 : Math.min((now - before) / 1000, 0.1);
    before = now;
    if (player.playing) {
      player.advance(seconds);
      touch();
    }
    stage.controls.update();
    if (stale) {
      stale = false;
      for (const {figure} of Object.values(people)) figure.update(player.frame);
      panel.update();
      root.dataset.triangles = stage.draw();
      root.dataset.draws = ++draws;
      root.dataset.frame = Math.round(player.frame);
      if (root.dataset.state === 'loading') root.dataset.state = 'ready';
    }
    window.requestAnimationFrame(tick);
  }
  window.requestAnimationFrame(tick);
}

start();

// Connects the parts of a gallery.
function start() {
  const data = JSON.parse(document.getElementById('data').textContent);
  if (!drawsWebGl()) {
    fail(NO_WEBGL);
    return;
  }
  const element = (id) => document.getElementById(id);
  element('title').textContent = data.title;
  element('subtitle').textContent = data.subtitle;
  const gallery = new Gallery(element('stage'), data);

  // Time is counted in frames of the motion with the highest rate.
  const frameRate = Math.max(...gallery.cells.map((cell) => cell.motion.frameRate));
  const timeline = {frameRate, frames: Math.round(gallery.duration * frameRate) + 1};
  const player = new Player(timeline);
  root.dataset.frames = timeline.frames;
  root.dataset.cells = gallery.cells.length;

  element('people').hidden = gallery.cells.every(({motion}) => !motion.people.follower);

  let view = 'reset';  // until the visitor moves the camera
  let stale = true;    // something has changed since the last draw
  let draws = 0;
  const touch = () => { stale = true; };
  const chooseView = (name) => {
    view = name;
    gallery.view(name);
    for (const button of document.querySelectorAll('[data-view]')) {
      button.classList.toggle('chosen', button.dataset.view === name && name !== 'reset');
    }
    touch();
  };
  const resize = () => {
    gallery.resize();
    if (view) chooseView(view);
    touch();
  };
  window.addEventListener('resize', resize);
  gallery.controls.addEventListener('change', touch);
  gallery.controls.addEventListener('start', () => {
    view = null;
    for (const button of document.querySelectorAll('[data-view]')) button.classList.remove('chosen');
  });
  const showPerson = (person, visible) => {
    for (const cell of gallery.cells) cell.show(person, visible);
  };
  connectInput({player, showPerson, chooseView, touch});
  element('scrub').max = player.last;

  const opening = openingState();
  if ('frame' in opening) player.seek(Number(opening.frame) || 0);
  if ('paused' in opening) player.playing = false;
  if (['front', 'side', 'top'].includes(opening.view)) view = opening.view;
  resize();

  let before = null;
  function tick(now) {
    // Do not skip time that a background tab slept.
    const seconds = before === null ? 0 : Math.min((now - before) / 1000, 0.1);
    before = now;
    if (player.playing) {
      player.advance(seconds);
      touch();
    }
    gallery.controls.update();
    if (stale) {
      stale = false;
      root.dataset.triangles = gallery.draw(player.frame / frameRate);
      showTime({player, frameRate});
      root.dataset.draws = ++draws;
      root.dataset.frame = Math.round(player.frame);
      if (root.dataset.state === 'loading') root.dataset.state = 'ready';
    }
    window.requestAnimationFrame(tick);
  }
  window.requestAnimationFrame(tick);
}

start();

// Puts the page together.
function start() {
  const data = JSON.parse(document.getElementById('data').textContent);
  const motion = new Motion(data);
  root.dataset.frames = motion.frames;
  if (!webGlWorks()) return;

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
  const showPerson = (name, visible) => {
    people[name].figure.group.visible = people[name].path.visible = visible;
  };
  const element = (id) => document.getElementById(id);
  const measures = new Measures(stage, motion, element('measures'));
  const film = new Film(stage.canvas, player, data.title);
  element('save-film').hidden = !film.possible;
  element('save-motion').hidden = !data.glb;
  const draw = () => {
    for (const {figure} of Object.values(people)) figure.update(player.frame);
    measures.update(player.frame);
    panel.update();
    root.dataset.triangles = stage.draw();
  };
  const measure = () => element('measure').setAttribute('aria-pressed', measures.toggle());
  connectInput({player, showPerson, chooseView, touch, more: [
    {id: 'measure', key: 'm', action: measure},
    {id: 'save-picture', key: 'p', action: () => savePicture(stage.canvas, draw, data.title)},
    {id: 'save-film', key: film.possible ? 'r' : '', action: () => film.start()},
    {id: 'save-motion', action: () => saveMotion(data.glb, data.title)},
  ]});

  const opening = openingState();
  if ('frame' in opening) player.seek(Number(opening.frame) || 0);
  if ('paused' in opening) player.playing = false;
  if ('measure' in opening) measure();
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
    film.follow();
    stage.controls.update();
    if (stale) {
      stale = false;
      draw();
      root.dataset.draws = ++draws;
      root.dataset.frame = Math.round(player.frame);
      if (root.dataset.state === 'loading') root.dataset.state = 'ready';
    }
    window.requestAnimationFrame(tick);
  }
  window.requestAnimationFrame(tick);
}

start();

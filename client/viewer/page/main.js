// Connects the page's parts: the motion element and the panels around it.
function start() {
  const data = JSON.parse(document.getElementById('data').textContent);
  const element = (id) => document.getElementById(id);
  const scene = element('stage');
  scene.addEventListener('error', ({detail}) => fail(detail.message));
  scene.motion = data;
  if (!scene.stage) return;
  const {motion, player, stage} = scene;
  root.dataset.frames = motion.frames;

  const panel = new Panel(data, motion, player);
  const measures = new Measures(stage, motion, element('measures'));
  const film = new Film(scene, data.title);
  const grade = data.grade ? new Grade(data.grade, player) : null;
  const showChosen = (name) => {
    for (const button of document.querySelectorAll('[data-view]')) {
      button.classList.toggle('chosen', button.dataset.view === name && name !== 'reset');
    }
  };
  const chooseView = (name) => {
    scene.look(name);
    showChosen(name);
  };
  scene.addEventListener('orbit', () => {
    showChosen(null);
    element('hint').classList.add('gone');
  });
  scene.addEventListener('frame', () => {
    measures.update(player.frame);
    panel.update();
    if (grade) grade.update();
  });
  scene.addEventListener('drawn', () => {
    root.dataset.triangles = scene.triangles;
    root.dataset.draws = scene.draws;
    root.dataset.frame = Math.round(player.frame);
    if (root.dataset.state === 'loading') root.dataset.state = 'ready';
  });

  element('save-film').hidden = !film.possible;
  element('save-motion').hidden = !data.glb;
  const track = (tracks) => {
    scene.toggleAttribute('track', tracks);
    element('track-people').setAttribute('aria-pressed', tracks);
  };
  const measure = () => element('measure').setAttribute('aria-pressed', measures.toggle());
  connectInput({
    player, chooseView,
    showPerson: (name, visible) => scene.show(name, visible),
    touch: () => scene.touch(),
    more: [
      {id: 'track-people', key: 't', action: () => track(!scene.hasAttribute('track'))},
      {id: 'measure', key: 'm', action: measure},
      {id: 'save-picture', key: 'p', action: () => savePicture(scene, data.title)},
      {id: 'save-film', key: film.possible ? 'r' : '', action: () => film.start()},
      {id: 'save-motion', action: () => saveMotion(data.glb, data.title)},
      ...(grade ? [{id: 'next-fault', key: 'n', action: () => grade.next()}] : []),
    ],
  });

  const opening = openingState();
  if ('frame' in opening) player.seek(Number(opening.frame) || 0);
  if ('paused' in opening) player.playing = false;
  if ('measure' in opening) measure();
  if ('track' in opening || stage.isFar) track(true);
  chooseView(['front', 'side', 'top'].includes(opening.view) ? opening.view : 'reset');
}

start();

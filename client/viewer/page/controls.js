// Start and failure of a page. `document.documentElement.dataset` reports its state to programs:
// state (loading, ready, failed), frames, frame, draws, triangles, error.
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

// Displays the player's position.
function showTime({player, frameRate}) {
  const element = (id) => document.getElementById(id);
  const shown = Math.round(player.frame);
  element('scrub').value = shown;
  element('scrub').style.setProperty('--done', `${100 * player.frame / Math.max(1, player.last)}%`);
  element('frame').textContent = shown;
  element('of').textContent = ` / ${player.last}`;
  const seconds = (frames) => (frames / frameRate).toFixed(2);
  element('time').textContent = `${seconds(player.frame)} / ${seconds(player.last)} s`;
  element('play').classList.toggle('playing', player.playing);
  element('loop').setAttribute('aria-pressed', player.looping);
  for (const button of document.querySelectorAll('[data-speed]')) {
    button.classList.toggle('chosen', Number(button.dataset.speed) === player.speed);
  }
}

// Handles mouse, touch and keys, except for the camera, which has its own controls.
// `showPerson(name, visible)` shows or hides the leader or the follower.
// `more`: actions by the id of their button, with their key.
function connectInput({player, showPerson, chooseView, touch, more = []}) {
  const element = (id) => document.getElementById(id);
  const onClick = (target, action) => target.addEventListener('click', (event) => {
    action();
    touch();
    // After a mouse click, the space bar plays and pauses instead of pressing this button again.
    if (event.detail > 0) target.blur();
  });

  onClick(element('play'), () => player.toggle());
  onClick(element('loop'), () => { player.looping = !player.looping; });
  for (const button of document.querySelectorAll('[data-speed]')) {
    onClick(button, () => { player.speed = Number(button.dataset.speed); });
  }
  for (const button of document.querySelectorAll('[data-view]')) {
    onClick(button, () => chooseView(button.dataset.view));
  }
  for (const button of document.querySelectorAll('[data-person]')) {
    onClick(button, () => {
      const visible = button.getAttribute('aria-pressed') !== 'true';
      showPerson(button.dataset.person, visible);
      button.setAttribute('aria-pressed', visible);
    });
  }
  for (const {id, action} of more) onClick(element(id), action);
  element('scrub').addEventListener('input', () => {
    player.playing = false;
    player.seek(Number(element('scrub').value));
    touch();
  });

  const keys = {
    ' ': () => player.toggle(),
    ArrowLeft: () => player.step(-1),
    ArrowRight: () => player.step(1),
    Home: () => { player.step(0); player.seek(0); },
    End: () => { player.step(0); player.seek(player.last); },
    l: () => { player.looping = !player.looping; },
    0: () => chooseView('reset'),
    1: () => chooseView('front'),
    2: () => chooseView('side'),
    3: () => chooseView('top'),
  };
  for (const {key, action} of more) if (key) keys[key] = action;
  window.addEventListener('keydown', (event) => {
    const action = keys[event.key];
    if (!action || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === ' ' && event.target instanceof HTMLButtonElement) return;
    event.preventDefault();
    action();
    touch();
  });
}

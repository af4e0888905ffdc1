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


'use strict';
// Keys of the whole page. Fields keep their own keys.
const PAGE_KEYS = {
  ' ': () => theatre.toggle(),
  ArrowLeft: () => seekAll(frameNow() - 1),
  ArrowRight: () => seekAll(frameNow() + 1),
  Home: () => seekAll(0),
  End: () => seekAll(theatre.frames - 1),
  r: () => press('react'),
  e: () => press('show-eight'),
  n: () => press('another'),
  k: () => press('add-key'),
  p: () => press('place'),
  j: () => press('pin'),
  '?': () => element('help').showModal(),
};

const press = (id) => {
  if (!element(id).disabled && !element(id).hidden) element(id).click();
};

// Whether an element uses a key itself.
function usesKey(item, key) {
  if (item.closest('dialog[open]')) return true;
  if (item.matches('select, textarea, input:not([type=range]):not([type=file])')) return true;
  if (key === ' ') return item.matches('button, summary, a, input, [role=button]');
  const moves = ['ArrowLeft', 'ArrowRight', 'Home', 'End'].includes(key);
  return moves && item.matches('input[type=range]');
}

function connectKeys() {
  window.addEventListener('keydown', (event) => {
    if (event.defaultPrevented || event.altKey || event.ctrlKey || event.metaKey) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (usesKey(event.target, key)) return;
    const place = '12345678'.indexOf(key);
    if (place >= 0) chooseTile(place);
    else if (PAGE_KEYS[key] && state.leader) PAGE_KEYS[key]();
    else return;
    event.preventDefault();
  });
  element('show-help').addEventListener('click', () => element('help').showModal());
}

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

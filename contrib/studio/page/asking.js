'use strict';
// Asks the server for answers.
const GALLERY_SIZE = 8;
const UNFAMILIAR = 1.5;  // SynthesisSummary.unfamiliarity above this gets a warning

function stopCalls() {
  state.call?.abort();
  state.call = null;
}

// Requests one answer; `seed`: '' for one that the server chooses. Calls `show` with each chunk.
async function ask(leader, seed, signal, show) {
  const {motion} = leader;
  const values = motion.joint_names.length * 3;
  const positions = new Float32Array(motion.positions.length);
  const take = {
    positions, leader: leader.name, settings: addressOf({...settings, seed}),
    model: state.model.name, version: state.model.version, samples: Boolean(state.model.samples),
  };
  const pins = sentPins(settings, state.model.joint_names);
  let [header, summary] = [null, null];
  for await (const answer of callServer('Synthesize', 'SynthesizeRequest',
                                        requestOf(motion, seed), 'SynthesizeResponse', signal)) {
    if (answer.chunk) {
      const first = answer.chunk.first_frame ?? 0;
      positions.set(answer.chunk.positions, first * values);
      show?.(first, answer.chunk.positions);
    }
    header ||= answer.header;
    summary ||= answer.summary;
  }
  if (!header || !summary) throw new CallError('The reply is incomplete. Press React again.');
  return {
    ...take, seed: header.seed ?? 0, unfamiliarity: summary.unfamiliarity ?? 0, grade: summary.grade ?? null,
    pins: pins.map(({joint, frame, position}, i) => ({
      joint, frame, position, metres: summary.constraint_metres[i] ?? 0})),
  };
}

// The first seed of `count` answers, '' for one that the server chooses. A gallery is asked again with
// the same seeds, whichever of its answers is chosen.
function firstSeed(count) {
  const seeds = seedsOf(state.takes);
  return count > 1 && seeds.length > 1 && seeds.includes(settings.seed) ? Math.min(...seeds)
                                                                       : settings.seed;
}

// Requests `count` answers with the current settings and consecutive seeds, the first one that of the
// settings or the server's. Cancels running calls.
// If one fails, the answers of before stay.
async function react(count) {
  stopCalls();
  const call = state.call = new AbortController();
  const {leader} = state;
  const [asked, begun] = [askedFor(), performance.now()];
  const seed = firstSeed(count);
  tell('Waiting for the server …');
  try {
    const show = count === 1 ? (first, positions) => theatre.takeFrames(first, positions) : null;
    // The other seeds follow the first, which only its answer names if the server chooses it.
    const first = ask(leader, seed, call.signal, show);
    const start = seed === '' && count > 1 ? (await first).seed : seed;
    const others = Array.from({length: count - 1}, (_, i) => ask(leader, start + i + 1, call.signal, show));
    const takes = await Promise.all([first, ...others]);
    if (call.signal.aborted) return;
    state.call = null;
    const chosen = galleryOrder(takes)[0];
    Object.assign(state, {takes, chosen, asked});
    if (count > 1) settings.seed = takes[chosen].seed;
    finish((performance.now() - begun) / 1000);
  } catch (error) {
    if (call.signal.aborted) return;
    call.abort();
    state.call = null;
    showAnswer();
    tellError(error);
  }
}

function describeSeeds(takes) {
  if (!takes[0].samples) return 'one answer';
  return takes.length === 1 ? `seed ${takes[0].seed}`
                            : `seeds ${takes[0].seed} to ${takes[takes.length - 1].seed}: choose one`;
}

function finish(seconds) {
  const {takes, chosen} = state;
  showFields();
  showAnswer();
  changed(takes.length > 1 ? 'show eight' : 'react');
  const far = takes.some((take) => take.unfamiliarity > UNFAMILIAR)
      ? ' This leader is unlike the training data. Check the answer before you use it.' : '';
  const missed = takes[chosen].pins.filter(({metres}) => metres >= 0.01).length;
  const pins = missed > 0 ? ` ${missed} of ${takes[chosen].pins.length} pins missed.` : '';
  tell(`Answered in ${seconds.toFixed(2)} s, ${describeSeeds(takes)}.${pins}${far}`);
  if (takes.length > 1) element('gallery').scrollIntoView({block: 'nearest'});
  state.answers += 1;
  root.dataset.answers = state.answers;
}

// Shows another answer of the gallery.
function choose(index) {
  if (index === state.chosen) return;
  state.chosen = index;
  settings.seed = state.takes[index].seed;
  showMotion(state.leader, state.takes[index].positions);
  showChoice();
  showFields();
  changed(`choose seed ${settings.seed}`);
  tell(`Seed ${settings.seed}.`);
}

function connectAsking() {
  element('react').addEventListener('click', () => react(1));
  element('show-eight').addEventListener('click', () => react(GALLERY_SIZE));
  element('another').addEventListener('click', () => {
    const count = state.takes.length > 1 ? GALLERY_SIZE : 1;
    if (state.takes.length > 0) settings.seed = Math.max(...seedsOf(state.takes)) + 1;
    react(count);
  });
}

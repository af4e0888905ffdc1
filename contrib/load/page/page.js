// The page of a report of duet-load: draws the JSON that stands in the page.

const PERCENTILES = ['min', 'p1', 'p5', 'p50', 'p90', 'p95', 'p99', 'p99.9', 'max'];
const SHOWN_BY_LOAD = ['p50', 'p95', 'p99', 'p99.9', 'max'];

const short = (value) => (value === undefined || value === null ? '-'
  : value.toFixed(value < 100 ? 1 : 0));
const loadOf = (step) => step.rate || step.callers;
const kindName = (kind) => `${kind.model}, ${kind.frames} frames`;

function addTable(caption, header, rows) {
  const table = add(add(document.body, 'div', { class: 'scroll' }), 'table');
  add(table, 'caption', {}, caption);
  const head = add(add(table, 'thead'), 'tr');
  for (const cell of header) add(head, 'th', {}, cell);
  const body = add(table, 'tbody');
  for (const row of rows) {
    const line = add(body, 'tr');
    for (const cell of row) add(line, 'td', {}, cell);
  }
}

function addPercentiles(report, caption, figure) {
  addTable(caption, ['load', 'calls', ...PERCENTILES], report.steps.map((step) => {
    const figures = step.answers[figure];
    return [step.load, figures.count, ...PERCENTILES.map((name) => short(figures[name]))];
  }));
}

function addTables(report) {
  addTable('Load and throughput',
    ['load', 'seconds', 'calls/s wanted', 'calls/s sent', 'calls/s answered', 'frames/s',
      'sent late, p99 ms'],
    report.steps.map((step) => [step.load, short(step.seconds), short(step.due_per_second),
      short(step.sent_per_second), short(step.answered_per_second), short(step.frames_per_second),
      short(step.late_ms.p99)]));
  addTable('How calls ended, and after how many milliseconds',
    ['load', 'status', 'calls', 'p50', 'p99', 'max'],
    report.steps.flatMap((step) => Object.entries(step.ended_ms).map(([code, times]) => [
      step.load, code, times.count, short(times.p50), short(times.p99), short(times.max)])));
  addPercentiles(report, 'First chunk, milliseconds', 'first_chunk_ms');
  addPercentiles(report, 'Whole call, milliseconds', 'whole_call_ms');
  addPercentiles(report, 'Frames a second of each call', 'call_frames_per_second');
  if (report.steps[0].kinds.length < 2) return;
  addTable('By kind of call, milliseconds',
    ['load', 'kind', 'answered', 'first chunk p50', 'p99', 'whole call p50', 'p99'],
    report.steps.flatMap((step) => step.kinds.map((kind) => {
      const { first_chunk_ms: first, whole_call_ms: whole } = kind.answers;
      return [step.load, kindName(kind), whole.count, short(first.p50), short(first.p99),
        short(whole.p50), short(whole.p99)];
    })));
}

function drawByLoad(parent, report) {
  const sweep = {
    xLabel: report.steps[0].rate ? 'calls a second' : 'callers',
    xTicks: report.steps.map((step) => [loadOf(step), String(loadOf(step))]),
    logX: true,
  };
  const line = (name, value) => (
    { name, points: report.steps.map((step) => [loadOf(step), value(step)]) });
  for (const [title, figure] of [['First chunk by load', 'first_chunk_ms'],
    ['Whole call by load', 'whole_call_ms']]) {
    drawChart(parent, { ...sweep, title, yLabel: 'milliseconds', logY: true,
      series: SHOWN_BY_LOAD.map((name) => line(name, (step) => step.answers[figure][name])) });
  }
  const series = [line('answered', (step) => step.answered_per_second),
    line('sent', (step) => step.sent_per_second)];
  if (report.steps[0].rate) series.push(line('wanted', (step) => step.due_per_second));
  drawChart(parent, { ...sweep, title: 'Calls a second by load', yLabel: 'calls a second', series });
}

// The whole distribution: at each step to the right a tenth of the calls are left.
function drawByPercentile(parent, report) {
  const nines = ([percentile, ms]) => [-Math.log10(1 - percentile / 100), ms];
  const series = report.steps.map((step) => (
    { name: step.load, points: step.whole_call_percentiles.map(nines) }));
  const most = Math.max(0, ...series.flatMap(({ points }) => points.map((point) => point[0])));
  const ticks = [0, 50, 90, 99, 99.9, 99.99, 99.999].map((p) => [nines([p])[0], String(p)]);
  drawChart(parent, { title: 'Whole call by percentile', xLabel: 'percentile',
    yLabel: 'milliseconds', logY: true, series, xTicks: ticks.filter(([x]) => x <= most + 1e-9) });
}

function drawOverTime(parent, step) {
  const line = (name, value) => (
    { name, points: step.timeline.map((interval) => [interval.second, value(interval)]) });
  drawChart(parent, { title: `${step.load}: whole call over time`, xLabel: 'seconds',
    yLabel: 'milliseconds', logY: true,
    series: ['p50', 'p99', 'max'].map((name) => line(name, (i) => i[`${name}_ms`])) });
  const length = step.timeline[1].second - step.timeline[0].second;
  drawChart(parent, { title: `${step.load}: calls over time`, xLabel: 'seconds',
    yLabel: 'calls a second', series: [line('due', (i) => i.due / length),
      line('answered', (i) => i.answered / length),
      line('not answered', (i) => i.not_answered / length)] });
}

// Live sessions.

const SHOWN_LIVE = ['p50', 'p99', 'p99.9', 'max'];

function drawLatency(parent, report) {
  const nines = ([percentile, ms]) => [-Math.log10(1 - percentile / 100), ms];
  const series = report.live.map((step) => (
    { name: step.load, points: step.latency_percentiles.map(nines) }));
  const most = Math.max(0, ...series.flatMap(({ points }) => points.map((point) => point[0])));
  const ticks = [0, 50, 90, 99, 99.9, 99.99, 99.999].map((p) => [nines([p])[0], String(p)]);
  drawChart(parent, { title: 'Latency by percentile', xLabel: 'percentile', yLabel: 'milliseconds',
    logY: true, series, xTicks: ticks.filter(([x]) => x <= most + 1e-9) });
  if (report.live.length < 2) return;
  drawChart(parent, { title: 'Latency by sessions', xLabel: 'sessions', yLabel: 'milliseconds',
    logX: true, logY: true,
    xTicks: report.live.map((step) => [step.sessions, String(step.sessions)]),
    series: SHOWN_LIVE.map((name) => (
      { name, points: report.live.map((step) => [step.sessions, step.latency_ms[name]]) })) });
}

function drawLatencyOverTime(parent, step) {
  drawChart(parent, { title: `${step.load}: latency over time`, xLabel: 'seconds',
    yLabel: 'milliseconds', logY: true,
    series: ['p50', 'p99', 'max'].map((name) => (
      { name, points: step.timeline.map((i) => [i.second, i[`${name}_ms`]]) })) });
}

function drawLive(report) {
  add(document.body, 'p', {}, `${report.model}, delay ${report.delay_frames} frames. Latency runs `
    + 'from when a leader frame was due to be sent to the arrival of the final follower frame of '
    + 'the same instant.');
  const charts = add(document.body, 'div', { class: 'charts' });
  drawLatency(charts, report);
  for (const step of report.live) if (step.timeline.length > 1) drawLatencyOverTime(charts, step);
  for (const [caption, figure, what] of [['Latency, milliseconds', 'latency_ms', 'frames'],
    ['At the server, milliseconds', 'at_server_ms', 'messages'],
    ['First frame, milliseconds', 'first_frame_ms', 'sessions']]) {
    addTable(caption, ['load', what, ...PERCENTILES], report.live.map((step) => [step.load,
      step[figure].count, ...PERCENTILES.map((name) => short(step[figure][name]))]));
  }
  const counts = ['sent', 'answered', 'late', 'missed', 'skipped', 'interpolated', 'dropped', 'lost',
    'doubled'];
  addTable('Frames', ['load', ...counts], report.live.map((step) => (
    [step.load, ...counts.map((name) => step[name])])));
  addTable('Sessions', ['load', 'status', 'sessions'], report.live.flatMap((step) => (
    Object.entries(step.ended).map(([code, count]) => [step.load, code, count]))));
}

function drawReport(report) {
  document.title = report.title;
  add(document.body, 'h1', {}, report.title);
  add(document.body, 'p', { class: 'faint' }, `${report.program}, ${report.time}. `
    + Object.entries(report.settings).map(([name, value]) => `--${name} ${value}`).join('  '));
  for (const step of report.live || report.steps) {
    if (step.not_kept_up) {
      add(document.body, 'p', { class: 'warning' }, `${step.load}: ${step.not_kept_up}`);
    }
  }
  if (report.live) {
    drawLive(report);
    return;
  }
  add(document.body, 'p', {}, 'Times run from when a call was due, not from when it was sent.');
  const charts = add(document.body, 'div', { class: 'charts' });
  if (report.steps.length > 1) drawByLoad(charts, report);
  drawByPercentile(charts, report);
  for (const step of report.steps) if (step.timeline.length > 1) drawOverTime(charts, step);
  addTables(report);
}

drawReport(JSON.parse(document.getElementById('report').textContent));
document.documentElement.dataset.state = 'ready';

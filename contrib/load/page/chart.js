'use strict';
// Lines over labelled axes, as an <svg> element. Units: pixels, y down.

const SIZE = { width: 640, height: 340, left: 66, right: 16, top: 62, bottom: 46 };
const GLYPH = 6.6;  // the greatest width of a character of the legend
const LEGEND_LINE = 26;
const STYLES = 8;  // classes s0 to s7
const MOST_DOTS = 24;  // more would hide their line

function add(parent, name, attributes = {}, text = '') {
  const svg = name === 'svg' || parent instanceof SVGElement;
  const node = svg ? document.createElementNS('http://www.w3.org/2000/svg', name)
                   : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.textContent = text;
  parent.append(node);
  return node;
}

// Round values of a linear axis: steps of 1, 2 or 5 times a power of ten, about five of them.
function linearTicks(low, high) {
  const rough = (high - low) / 5;
  const decade = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].find((nice) => nice * decade >= rough * (1 - 1e-9)) * decade;
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) {
    ticks.push(Number((i * step).toPrecision(10)));
  }
  return ticks;
}

// The decades; 1, 2 and 5 of each where there are few, and all nine digits in less than one.
function logTicks(low, high) {
  const decades = Math.log10(high / low);
  const digits = decades < 0.7 ? [1, 2, 3, 4, 5, 6, 7, 8, 9] : decades < 2.5 ? [1, 2, 5] : [1];
  const ticks = [];
  for (let decade = Math.floor(Math.log10(low)); decade <= Math.log10(high); ++decade) {
    for (const digit of digits) {
      const value = Number((digit * 10 ** decade).toPrecision(10));
      if (value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9)) ticks.push(value);
    }
  }
  return ticks;
}

// An axis from values to parts of its length, 0 to 1. `room` widens a logarithmic range by a
// factor; a linear one then begins at 0.
function makeAxis(values, log, room) {
  const has = (value) => Number.isFinite(value) && (!log || value > 0);
  const shown = values.filter(has);
  let low = shown.length ? Math.min(...shown) : 1;
  let high = shown.length ? Math.max(...shown) : 10;
  if (room && log) [low, high] = [low / room, high * room];
  if (room && !log) [low, high] = [0, high > 0 ? room * high : 1];
  if (low === high) [low, high] = log ? [low / 2, high * 2] : [low - 0.5, high + 0.5];
  const scaled = (value) => (log ? Math.log10(value) : value);
  return {
    has,
    part: (value) => (scaled(value) - scaled(low)) / (scaled(high) - scaled(low)),
    ticks: () => (log ? logTicks : linearTicks)(low, high).map((value) => [value, String(value)]),
  };
}

function drawLegend(svg, series) {
  let x = SIZE.left;
  for (const [i, { name }] of series.entries()) {
    const width = LEGEND_LINE + 6 + GLYPH * name.length + 14;
    if (x + width > SIZE.width && i > 0) {
      add(svg, 'text', { x, y: 42, class: 'tick' }, '...');
      return;
    }
    add(svg, 'path', { d: `M${x} 38h${LEGEND_LINE}`, class: `series s${i % STYLES}` });
    add(svg, 'text', { x: x + LEGEND_LINE + 6, y: 42, class: 'tick' }, name);
    x += width;
  }
}

function drawAxes(svg, chart, xTicks, yTicks, toX, toY) {
  const floor = SIZE.height - SIZE.bottom, right = SIZE.width - SIZE.right;
  for (const [value, label] of yTicks) {
    add(svg, 'path', { d: `M${SIZE.left} ${toY(value)}H${right}`, class: 'grid' });
    add(svg, 'text', { x: SIZE.left - 7, y: toY(value) + 4, 'text-anchor': 'end', class: 'tick' },
      label);
  }
  for (const [value, label] of xTicks) {
    add(svg, 'path', { d: `M${toX(value)} ${floor}v5`, class: 'axis' });
    add(svg, 'text', { x: toX(value), y: floor + 18, 'text-anchor': 'middle', class: 'tick' }, label);
  }
  add(svg, 'path', { d: `M${SIZE.left} ${floor}H${right}`, class: 'axis' });
  add(svg, 'text', { x: (SIZE.left + right) / 2, y: SIZE.height - 8, 'text-anchor': 'middle',
    class: 'label' }, chart.xLabel);
  const middle = (SIZE.top + floor) / 2;
  add(svg, 'text', { x: 14, y: middle, 'text-anchor': 'middle', class: 'label',
    transform: `rotate(-90 14 ${middle})` }, chart.yLabel);
}

// A point without a place on the axes leaves a gap.
function drawSeries(svg, points, index, x, y, toX, toY) {
  let path = '', down = false;
  const dots = [];
  for (const [px, py] of points) {
    const shown = x.has(px) && y.has(py);
    if (shown) {
      path += `${down ? 'L' : 'M'}${toX(px)} ${toY(py)}`;
      dots.push({ cx: toX(px), cy: toY(py), r: 2.6, class: `series s${index % STYLES}` });
    }
    down = shown;
  }
  add(svg, 'path', { d: path, class: `series s${index % STYLES}` });
  if (points.length <= MOST_DOTS) for (const dot of dots) add(svg, 'circle', dot);
}

// chart: title, xLabel, yLabel, series: [{name, points: [[x, y], ...]}], and optionally logX, logY
// (values of 0 and below leave gaps; a linear y axis begins at 0) and xTicks: [[value, label], ...].
function drawChart(parent, chart) {
  const x = makeAxis(chart.series.flatMap(({ points }) => points.map((p) => p[0])), chart.logX, 0);
  const y = makeAxis(chart.series.flatMap(({ points }) => points.map((p) => p[1])), chart.logY,
    chart.logY ? 1.15 : 1.06);
  const round = (value) => Math.round(value * 10) / 10;
  const toX = (value) => round(SIZE.left + x.part(value) * (SIZE.width - SIZE.left - SIZE.right));
  const toY = (value) => round(SIZE.height - SIZE.bottom
    - y.part(value) * (SIZE.height - SIZE.top - SIZE.bottom));
  const svg = add(add(parent, 'figure'), 'svg', { viewBox: `0 0 ${SIZE.width} ${SIZE.height}`,
    role: 'img', 'aria-label': chart.title });
  add(svg, 'text', { x: SIZE.left, y: 20, class: 'title' }, chart.title);
  drawLegend(svg, chart.series);
  drawAxes(svg, chart, chart.xTicks || x.ticks(), y.ticks(), toX, toY);
  for (const [i, series] of chart.series.entries()) {
    drawSeries(svg, series.points, i, x, y, toX, toY);
  }
}

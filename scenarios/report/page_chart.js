'use strict';
// Line charts in SVG, drawn at the width of their figure and again when it changes.

const SVG = document.querySelector('svg').namespaceURI;
const CHART = {height: 230, left: 54, right: 10, top: 8, bottom: 34};

function svg(name, attributes, parent, text) {
  const node = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  if (text !== undefined) node.textContent = text;
  if (parent) parent.append(node);
  return node;
}

function element(name, attributes, parent, text) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  if (text !== undefined) node.textContent = text;
  if (parent) parent.append(node);
  return node;
}

// Steps of 1, 2 or 5 times a power of ten, about `count` of them.
function roundTicks(low, high, count) {
  if (!(high > low)) return [low];
  const raw = (high - low) / count, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map(s => s * power).find(s => s >= raw * 0.999);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + step * 1e-9; i++) ticks.push(i * step);
  return ticks;
}

function label(value) {
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e5)) return value.toExponential(0).replace('e+', 'e');
  return String(Number(value.toPrecision(4)));
}

// How values become heights: forward and back, range and ticks from the data.
const SCALES = {
  linear: {
    forward: v => v,
    range: (low, high) => [Math.min(0, low), high > low || high > 0 ? high * 1.04 : 1],
    ticks: (low, high) => roundTicks(low, high, 5).map(v => [v, label(v)]),
  },
  count: {
    forward: v => v,
    range: (low, high) => [0, Math.max(1, high) * 1.1],
    ticks: (low, high) => roundTicks(low, high, 5).filter(Number.isInteger).map(v => [v, label(v)]),
  },
  log: {
    forward: v => Math.log10(v),
    range: (low, high) => [Math.floor(low), Math.max(Math.ceil(high), Math.floor(low) + 1)],
    ticks: (low, high) => roundTicks(low, high, 6).filter(Number.isInteger).map(v => [v, label(10 ** v)]),
  },
  // Nines: 0, 0.9, 0.99, ... are equally far apart; beyond 0.9999 nothing is told apart.
  oblateness: {
    forward: v => -Math.log10(Math.max(1 - v, 1e-4)),
    range: (low, high) => [0, Math.max(2, Math.ceil(high))],
    ticks: (low, high) => roundTicks(0, high, 6).filter(Number.isInteger).map(v => [v, v === 0 ? '0' : (1 - 10 ** -v).toFixed(v)]),
  },
};

// Straight pieces between finite values; `step` holds each value until the next.
function curve(series, x, y) {
  let path = '', pen = false, last = 0;
  series.x.forEach((value, i) => {
    const height = y(series.y[i]);
    if (!Number.isFinite(height)) { pen = false; return; }
    const at = `${x(value).toFixed(1)} ${height.toFixed(1)}`;
    if (pen && series.step) path += `L${x(value).toFixed(1)} ${last.toFixed(1)}`;
    path += (pen ? 'L' : 'M') + at;
    pen = true;
    last = height;
  });
  return path;
}

function limits(series, key, forward) {
  let low = Infinity, high = -Infinity;
  for (const s of series) for (const value of s[key]) {
    const v = forward(value);
    if (Number.isFinite(v)) { low = Math.min(low, v); high = Math.max(high, v); }
  }
  return low <= high ? [low, high] : [0, 1];
}

// Intervals of x in which `mark` is true, as shaded bands.
function bands(parent, xs, mark, x, top, height) {
  for (let i = 0; i < xs.length; i++) {
    if (!mark(i)) continue;
    const begin = xs[i];
    while (i + 1 < xs.length && mark(i + 1)) i++;
    const end = xs[Math.min(i + 1, xs.length - 1)];
    svg('rect', {x: x(begin), width: Math.max(1, x(end) - x(begin)), y: top, height, fill: 'var(--shade)'}, parent);
  }
}

function nearestIndex(xs, value) {
  let low = 0, high = xs.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (xs[middle] < value) low = middle + 1; else high = middle;
  }
  return low > 0 && value - xs[low - 1] < xs[low] - value ? low - 1 : low;
}

// chart: {title, unit, scale, xTitle, series: [{name, color, x, y, dashed, step}], shade: {x, mark}, marks: [y], onPoint(x)}
// A series without a name has a hint: no place in the key, but in what the cursor says.
function drawChart(figure, chart) {
  const series = chart.series.filter(s => s.y.some(Number.isFinite));
  figure.replaceChildren();
  figure.hidden = series.length === 0;
  if (figure.hidden) return;
  const caption = element('figcaption', {}, figure);
  element('b', {}, caption, chart.title + (chart.unit ? ` (${chart.unit})` : ''));
  for (const s of series) {
    if (!s.name) continue;
    const key = element('span', {class: 'key'}, caption);
    element('span', {class: s.dashed ? 'swatch dashed' : 'swatch', style: `color: ${s.color}`}, key);
    key.append(s.name);
  }
  const width = Math.max(320, figure.clientWidth), scale = SCALES[chart.scale || 'linear'];
  const right = width - CHART.right, bottom = CHART.height - CHART.bottom;
  const [x0, x1] = limits(series, 'x', v => v), [y0, y1] = scale.range(...limits(series, 'y', scale.forward));
  const x = v => CHART.left + (v - x0) / (x1 - x0 || 1) * (right - CHART.left);
  const yOf = v => bottom - (v - y0) / (y1 - y0) * (bottom - CHART.top);
  const root = svg('svg', {viewBox: `0 0 ${width} ${CHART.height}`, role: 'img', 'aria-label': chart.title}, figure);
  if (chart.shade) bands(root, chart.shade.x, chart.shade.mark, x, CHART.top, bottom - CHART.top);
  for (const [value, text] of scale.ticks(y0, y1)) {
    svg('line', {class: 'gridline', x1: CHART.left, x2: right, y1: yOf(value), y2: yOf(value)}, root);
    svg('text', {x: CHART.left - 7, y: yOf(value) + 4, 'text-anchor': 'end'}, root, text);
  }
  for (const value of chart.marks || []) {
    const y = yOf(scale.forward(value));
    svg('line', {class: 'mark', x1: CHART.left, x2: right, y1: y, y2: y}, root);
    svg('text', {x: right - 4, y: y - 4, 'text-anchor': 'end'}, root, label(value));
  }
  for (const value of roundTicks(x0, x1, Math.max(3, width / 90))) {
    svg('line', {class: 'axis', x1: x(value), x2: x(value), y1: bottom, y2: bottom + 4}, root);
    svg('text', {x: x(value), y: bottom + 16, 'text-anchor': 'middle'}, root, label(value));
  }
  svg('line', {class: 'axis', x1: CHART.left, x2: right, y1: bottom, y2: bottom}, root);
  svg('text', {x: (CHART.left + right) / 2, y: CHART.height - 3, 'text-anchor': 'middle'}, root, chart.xTitle);
  for (const s of series) {
    svg('path', {class: 'curve', d: curve(s, x, v => yOf(scale.forward(v))), stroke: s.color,
                 'stroke-dasharray': s.dashed ? '5 3' : 'none', 'stroke-opacity': s.dashed ? .8 : 1}, root);
  }
  addCursor(figure, root, chart, series, {x0, x1, x, right, bottom, width});
}

function addCursor(figure, root, chart, series, frame) {
  const line = svg('line', {class: 'cursor', y1: CHART.top, y2: frame.bottom, visibility: 'hidden'}, root);
  const tip = element('div', {class: 'tip', hidden: ''}, figure);
  root.addEventListener('pointermove', event => {
    const box = root.getBoundingClientRect();
    const at = (event.clientX - box.left) * frame.width / box.width;
    const value = frame.x0 + (at - CHART.left) / (frame.right - CHART.left) * (frame.x1 - frame.x0);
    if (value < frame.x0 || value > frame.x1) return;
    line.setAttribute('x1', at);
    line.setAttribute('x2', at);
    line.setAttribute('visibility', 'visible');
    tip.hidden = false;
    tip.textContent = '';
    element('div', {}, tip, `${chart.xTitle}: ${value.toFixed(1)}`);
    for (const s of series) {
      const y = s.y[nearestIndex(s.x, value)];
      const row = element('div', {}, tip, `${s.name || s.hint}: ${Number.isFinite(y) ? label(y) : '–'}`);
      row.style.color = s.color;
    }
    tip.style.left = at > frame.width / 2 ? 'auto' : `${at + 14}px`;
    tip.style.right = at > frame.width / 2 ? `${frame.width - at + 14}px` : 'auto';
    if (chart.onPoint) chart.onPoint(value);
  });
  root.addEventListener('pointerleave', () => {
    line.setAttribute('visibility', 'hidden');
    tip.hidden = true;
    if (chart.onPoint) chart.onPoint(null);
  });
}

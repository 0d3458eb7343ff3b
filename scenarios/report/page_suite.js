// Puts the data of a suite into its figures.

const DATA = JSON.parse(document.getElementById('data').textContent);

function typed(text, Type) {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  return new Type(bytes.buffer);
}

function css(name) { return getComputedStyle(document.documentElement).getPropertyValue(name).trim(); }

function decode(scenario) {
  for (const series of [scenario.truth, scenario.keys, ...scenario.estimates])
    if (series) for (const key of Object.keys(series)) if (key !== 'method') series[key] = typed(series[key], Float32Array);
  if (scenario.map) scenario.map.xy = typed(scenario.map.xy, Uint16Array);
  if (scenario.example)
    for (const scan of scenario.example.scans)
      for (const part of ['heights_cm', 'points_lidar_cm']) scan[part] = typed(scan[part], Int16Array);
  return scenario;
}

// A canvas at the device's resolution, drawn now and whenever its size or the colours change.
const canvases = [];
function addCanvas(parent, className, draw) {
  const canvas = element('canvas', {class: className}, parent);
  const redraw = () => {
    const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const g = canvas.getContext('2d');
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    draw(g, width, height);
  };
  new ResizeObserver(redraw).observe(canvas);
  canvases.push(redraw);
  return canvas;
}

// How world coordinates become pixels: the truth with a margin, and estimates as far as half its size around.
function view(scenario, width, height, series) {
  const {x, y} = scenario.truth;
  const limits = values => values.reduce(([low, high], v) => [Math.min(low, v), Math.max(high, v)], [Infinity, -Infinity]);
  const [x0, x1] = limits(x), [y0, y1] = limits(y), reach = Math.max(x1 - x0, y1 - y0) / 2 + 2;
  const box = [x0, x1, y0, y1];
  for (const s of series) s.x.forEach((v, i) => {
    box[0] = Math.max(x0 - reach, Math.min(box[0], v));
    box[1] = Math.min(x1 + reach, Math.max(box[1], v));
    box[2] = Math.max(y0 - reach, Math.min(box[2], s.y[i]));
    box[3] = Math.min(y1 + reach, Math.max(box[3], s.y[i]));
  });
  const margin = 2.5, w = box[1] - box[0] + 2 * margin, h = box[3] - box[2] + 2 * margin;
  const scale = Math.min(width / w, height / h), cx = (box[0] + box[1]) / 2, cy = (box[2] + box[3]) / 2;
  return {scale, width, height, to: (px, py) => [width / 2 + (px - cx) * scale, height / 2 - (py - cy) * scale]};
}

function drawPath(g, v, path, color, width) {
  g.strokeStyle = color;
  g.lineWidth = width;
  g.lineJoin = 'round';
  g.beginPath();
  path.x.forEach((x, i) => g.lineTo(...v.to(x, path.y[i])));
  g.stroke();
}

function drawScaleBar(g, v) {
  const most = v.width / 4 / v.scale, power = 10 ** Math.floor(Math.log10(most));
  const metres = [5, 2, 1].map(s => s * power).find(m => m <= most), y = v.height - 10, right = v.width - 12;
  g.strokeStyle = g.fillStyle = css('--soft');
  g.lineWidth = 1.5;
  g.beginPath();
  g.moveTo(right - metres * v.scale, y - 4);
  g.lineTo(right - metres * v.scale, y);
  g.lineTo(right, y);
  g.lineTo(right, y - 4);
  g.stroke();
  g.font = '11px system-ui, sans-serif';
  g.textAlign = 'center';
  g.fillText(`${label(metres)} m`, right - metres * v.scale / 2, y - 6);
  g.textAlign = 'start';
}

function drawEnds(g, v, path) {
  g.fillStyle = css('--truth');
  g.font = '11px system-ui, sans-serif';
  for (const [i, text] of [[0, 'start'], [path.x.length - 1, 'end']]) {
    const [x, y] = v.to(path.x[i], path.y[i]);
    g.beginPath();
    g.arc(x, y, 3, 0, 2 * Math.PI);
    g.fill();
    g.fillText(text, x + 6, y + (i ? 13 : -5));
  }
}

function drawTrajectories(scenario) {
  return (g, width, height) => {
    g.clearRect(0, 0, width, height);
    const v = view(scenario, width, height, scenario.estimates);
    drawPath(g, v, scenario.truth, css('--truth'), 5);
    for (const estimate of scenario.estimates)
      drawPath(g, v, estimate, css(`--m-${estimate.method}`), estimate.method === DATA.focus ? 2 : 1.4);
    drawEnds(g, v, scenario.truth);
    drawScaleBar(g, v);
  };
}

function drawCloud(g, v, map) {
  g.fillStyle = `rgba(${css('--cloud')}, 0.35)`;
  for (let i = 0; i < map.xy.length; i += 2) {
    const [x, y] = v.to(map.origin[0] + map.xy[i] * map.step_m, map.origin[1] + map.xy[i + 1] * map.step_m);
    g.fillRect(x, y, 1.2, 1.2);
  }
}

function drawArrow(g, x, y, yaw) {
  const length = 15, dx = Math.cos(yaw), dy = -Math.sin(yaw), tip = [x + dx * length, y + dy * length];
  g.beginPath();
  g.moveTo(x, y);
  g.lineTo(...tip);
  g.moveTo(tip[0] - 6 * dx - 3.5 * dy, tip[1] - 6 * dy + 3.5 * dx);
  g.lineTo(...tip);
  g.lineTo(tip[0] - 6 * dx + 3.5 * dy, tip[1] - 6 * dy - 3.5 * dx);
  g.stroke();
}

function drawScene(scenario) {
  return (g, width, height) => {
    g.clearRect(0, 0, width, height);
    const keys = scenario.keys, v = view(scenario, width, height, []);
    if (scenario.map) drawCloud(g, v, scenario.map);
    drawPath(g, v, scenario.estimates.find(e => e.method === DATA.focus), css('--ink'), 1);
    const half = 2.6;
    keys.x.forEach((value, i) => {
      const [x, y] = v.to(value, keys.y[i]);
      g.fillStyle = css('--distinct');
      g.strokeStyle = css('--similar');
      g.lineWidth = 1.3;
      g.beginPath();
      if (keys.s[i] === 1) {
        g.arc(x, y, half, 0, 2 * Math.PI);
        g.fill();
      } else {
        g.moveTo(x - half, y);
        g.lineTo(x + half, y);
        g.moveTo(x, y - half);
        g.lineTo(x, y + half);
        g.stroke();
      }
    });
    g.strokeStyle = css('--arrow');
    g.lineWidth = 2;
    keys.x.forEach((value, i) => { if (keys.tau[i] === 1) drawArrow(g, ...v.to(value, keys.y[i]), keys.yaw[i]); });
    drawEnds(g, v, scenario.truth);
    drawScaleBar(g, v);
  };
}

function addKey(parent, text, color, swatch) {
  const key = element('span', {class: 'key'}, parent);
  element('span', {class: `swatch ${swatch || ''}`, style: swatch === 'dot' ? `background: ${color}` : `color: ${color}`}, key);
  key.append(text);
}

function addScenarios() {
  const keys = document.getElementById('keys'), holder = document.getElementById('scenarios');
  addKey(keys, 'truth', 'var(--truth)');
  for (const method of DATA.methods) addKey(keys, method, `var(--m-${method})`);
  addKey(keys, 'distinct scene (s = 1)', 'var(--distinct)', 'dot');
  addKey(keys, 'similar scene (s = 0)', 'var(--similar)', 'tick');
  addKey(keys, 'stored descriptor', 'var(--arrow)');
  for (const scenario of DATA.scenarios) {
    const drawing = element('div', {class: 'drawing'}, holder);
    element('h3', {}, drawing, scenario.name);
    const panels = element('div', {class: 'panels'}, drawing);
    addCanvas(element('div', {class: 'panel'}, panels), '', drawTrajectories(scenario));
    if (scenario.keys) addCanvas(element('div', {class: 'panel'}, panels), '', drawScene(scenario));
  }
}

// From dark blue over green to yellow, 0 to 1.
function heat(u) {
  const stops = [[46, 20, 82], [52, 92, 141], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
  const at = Math.min(1, Math.max(0, u)) * (stops.length - 1), i = Math.min(stops.length - 2, Math.floor(at)), f = at - i;
  return stops[i].map((c, k) => Math.round(c + f * (stops[i + 1][k] - c)));
}

function drawScan(scan, range, high) {
  return (g, width, height) => {
    g.clearRect(0, 0, width, height);
    const scale = Math.min(width, height) / 2 / range * Math.min(width, height) / height, p = scan.points_lidar_cm;
    for (let i = 0; i < p.length; i += 3) {
      g.fillStyle = `rgb(${heat((p[i + 2] / 100 + 1) / (high + 1))})`;
      g.fillRect(width / 2 + p[i] / 100 * scale, height / 2 - p[i + 1] / 100 * scale, 1.3, 1.3);
    }
    drawScaleBar(g, {width, height, scale});
  };
}

function drawDescriptor(scan, high) {
  return (g, width, height) => {
    for (let ring = 0; ring < 20; ring++)
      for (let sector = 0; sector < 60; sector++) {
        g.fillStyle = `rgb(${heat(scan.heights_cm[60 * ring + sector] / 100 / high)})`;
        g.fillRect(sector * width / 60, ring * height / 20, width / 60 + 1, height / 20 + 1);
      }
  };
}

// As far as nearly all points of the three scans lie.
function reach(scans, range) {
  const distances = [];
  for (const {points_lidar_cm: p} of scans)
    for (let i = 0; i < p.length; i += 3) distances.push(Math.hypot(p[i], p[i + 1]) / 100);
  distances.sort((a, b) => a - b);
  return Math.min(range, 1.1 * (distances[Math.floor(0.98 * distances.length)] || range));
}

function addExamples() {
  const holder = document.getElementById('examples-of');
  for (const scenario of DATA.scenarios) {
    if (!scenario.example) continue;
    document.getElementById('examples').hidden = false;
    const {scans, max_range_m: range} = scenario.example;
    const high = Math.max(...scans.flatMap(scan => [...scan.heights_cm])) / 100 || 1, shown = reach(scans, range);
    element('h3', {}, holder, scenario.name);
    const row = element('div', {class: 'example'}, holder);
    scans.forEach((scan, i) => {
      const figure = element('figure', {}, row), caption = element('figcaption', {}, figure);
      element('b', {}, caption, `Scan ${scan.scan}, key scan ${scan.key}`);
      const apart = i ? `, distance ${scan.distance.toFixed(3)} to the first` : '';
      element('span', {class: 'key'}, caption, (scan.stored ? 'stored' : 'not stored') + apart);
      addCanvas(figure, 'cloud', drawScan(scan, shown, high));
      addCanvas(figure, 'descriptor', drawDescriptor(scan, high));
    });
  }
}

const BAR_TITLES = {
  'descriptors.index_bytes': 'Index (bytes)', 'descriptors.descriptor_bytes': 'Descriptors (bytes)',
  'descriptors.database_bytes': 'Whole database (bytes)',
};

// Groups of bars, one group per scenario, one bar per method, on a logarithmic axis.
function drawBars(figure, {metric, rows}) {
  figure.replaceChildren();
  const scenarios = [...new Set(rows.map(r => r.scenario))], methods = DATA.methods.filter(m => rows.some(r => r.method === m));
  const caption = element('figcaption', {}, figure);
  element('b', {}, caption, BAR_TITLES[metric]);
  for (const method of methods) addKey(caption, method, `var(--m-${method})`, 'dot');
  const width = Math.max(320, figure.clientWidth), height = 280, left = 54, bottom = height - 74, top = 8;
  const values = rows.flatMap(r => [r.value, r.reference || r.value]);
  const low = Math.floor(Math.log10(Math.min(...values))), high = Math.max(low + 1, Math.ceil(Math.log10(Math.max(...values))));
  const y = v => bottom - (Math.log10(v) - low) / (high - low) * (bottom - top);
  const root = svg('svg', {viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': BAR_TITLES[metric]}, figure);
  for (let power = low; power <= high; power++) {
    svg('line', {class: 'gridline', x1: left, x2: width, y1: y(10 ** power), y2: y(10 ** power)}, root);
    svg('text', {x: left - 7, y: y(10 ** power) + 4, 'text-anchor': 'end'}, root, label(10 ** power));
  }
  const group = (width - left) / scenarios.length, bar = Math.min(18, group * 0.8 / methods.length);
  scenarios.forEach((scenario, i) => {
    const middle = left + group * (i + 0.5);
    const text = svg('text', {x: middle, y: bottom + 12, 'text-anchor': 'end', transform: `rotate(-35 ${middle} ${bottom + 12})`}, root, scenario);
    text.setAttribute('font-size', '11');
    methods.forEach((method, k) => {
      const row = rows.find(r => r.scenario === scenario && r.method === method);
      if (!row) return;
      const x = middle + (k - methods.length / 2) * bar;
      const rect = svg('rect', {x: x + 0.5, width: bar - 1, y: y(row.value), height: bottom - y(row.value), fill: `var(--m-${method})`}, root);
      svg('title', {}, rect, `${scenario}, ${method}: ${Math.round(row.value)}`);
      if (row.reference) svg('line', {x1: x - 1, x2: x + bar + 1, y1: y(row.reference), y2: y(row.reference), stroke: 'var(--ink)', 'stroke-width': 2}, root);
    });
  });
  svg('line', {class: 'axis', x1: left, x2: width, y1: bottom, y2: bottom}, root);
}

function drawCharts() {
  const holder = document.getElementById('memory-bars');
  document.getElementById('bars').hidden = DATA.bars.length === 0;
  while (holder.children.length < DATA.bars.length) element('figure', {}, holder);
  DATA.bars.forEach((bars, i) => drawBars(holder.children[i], bars));
  const series = DATA.offsets.filter(o => o.recall.length).map(o => ({
    x: o.offset_m, y: o.recall, name: o.method, color: `var(--m-${o.method})`,
  }));
  document.getElementById('offsets').hidden = series.length === 0;
  if (series.length) drawChart(document.querySelector('[data-chart="offsets"]'), {title: 'Recall', xTitle: 'lateral offset (m)', series});
}

function start() {
  for (const place of document.querySelectorAll('[data-focus]')) place.textContent = DATA.focus;
  DATA.scenarios.forEach(decode);
  addScenarios();
  addExamples();
  drawCharts();
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => canvases.forEach(redraw => redraw()));
  let width = window.innerWidth;
  window.addEventListener('resize', () => {
    if (window.innerWidth === width) return;
    width = window.innerWidth;
    drawCharts();
  });
}

start();

// Puts the data of the page into its figures.

function typed(text, Type) {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  return new Type(bytes.buffer);
}

function decode(run, index, count) {
  for (const part of ['truth', 'estimate', 'odometry', 'scans', 'weak', 'stored'])
    if (run[part]) for (const key of Object.keys(run[part])) run[part][key] = typed(run[part][key], Float32Array);
  if (run.map) run.map.xyz = typed(run.map.xyz, Uint16Array);
  run.color = count > 1 ? `--run${index % 6}` : '--estimate';
  return run;
}

// The name without what all results share.
function shorten(runs) {
  const same = runs.every(run => run.scenario === runs[0].scenario);
  for (const run of runs) run.short = same ? run.name.slice(run.scenario.length + 3) : run.name;
  return runs;
}

const RUNS = shorten(JSON.parse(document.getElementById('data').textContent).runs.map((run, i, all) => decode(run, i, all.length)));
const several = RUNS.length > 1;
const map = new MapView(document.getElementById('map'));
let shown = RUNS[0];

const figure = name => document.querySelector(`[data-chart="${name}"]`);
const line = (source, x, y, name, color, more) => ({x: source[x], y: source[y], name, color: `var(${color})`, ...more});

// Marks on the map where the path is after `value` seconds or metres.
function follow(key) {
  return value => {
    const {estimate} = shown, i = value === null ? 0 : nearestIndex(estimate[key], value);
    map.point = value === null ? null : [estimate.x[i], estimate.y[i]];
    map.draw();
  };
}

function errorSeries(x, y) {
  if (several) return RUNS.filter(run => run.estimate.error_m).map(run => line(run.estimate, x, y, run.short, run.color));
  const series = [line(shown.estimate, x, y, 'estimate', '--estimate')];
  if (shown.odometry) series.unshift(line(shown.odometry, x, y, 'odometry', '--odometry', {dashed: true}));
  return series;
}

function drawErrors() {
  if (!RUNS.some(run => run.estimate.error_m)) return;
  for (const [key, xTitle, suffix] of [['t', 'time (s)', 'time'], ['d', 'distance travelled (m)', 'distance']]) {
    const onPoint = follow(key);
    drawChart(figure(`error-${suffix}`), {title: 'Position error', unit: 'm', xTitle, series: errorSeries(key, 'error_m'), onPoint});
    drawChart(figure(`attitude-${suffix}`), {title: 'Attitude error', unit: '°', xTitle, series: errorSeries(key, 'error_deg'), onPoint});
  }
}

function drawScene(scans) {
  const series = [
    line(scans, 'd', 'alpha_t', 'translation', '--run0'), line(scans, 'd', 'alpha_r', 'rotation', '--run1'),
    line(scans, 'd', 'true_alpha_t', 'true, translation', '--run0', {dashed: true}),
    line(scans, 'd', 'true_alpha_r', 'true, rotation', '--run1', {dashed: true}),
  ];
  drawChart(figure('scene'), {title: 'Oblateness α', scale: 'oblateness', xTitle: 'distance travelled (m)', series,
                              shade: {x: scans.d, mark: i => scans.s[i] === 0}, marks: [0.98], onPoint: follow('d')});
}

function eigenSeries(scans, block) {
  const colors = ['--run4', '--run5', '--run0'], names = ['smallest', 'middle', 'largest'];
  return [0, 1, 2].flatMap(i => [
    line(scans, 't', `eigen_${block}_${i}`, names[i], colors[i]),
    line(scans, 't', `true_eigen_${block}_${i}`, '', colors[i], {dashed: true, hint: `true ${names[i]}`}),
  ]);
}

function drawInformation(scans) {
  const xTitle = 'time (s)', onPoint = follow('t');
  drawChart(figure('eigen-t'), {title: 'Translation', unit: 'per point', scale: 'log', xTitle, series: eigenSeries(scans, 't'), onPoint});
  drawChart(figure('eigen-r'), {title: 'Rotation', unit: 'm² per point', scale: 'log', xTitle, series: eigenSeries(scans, 'r'), onPoint});
  drawChart(figure('degenerate'), {title: 'Degenerate directions', scale: 'count', xTitle, onPoint, series: [
    line(scans, 't', 'degenerate_directions', 'held by the prior', '--run0', {step: true}),
    line(scans, 't', 'true_degenerate_directions', 'true', '--run4', {step: true, dashed: true}),
  ]});
  drawChart(figure('weak-angle'), {title: 'Weakest direction, estimated against true', unit: '°', xTitle, onPoint, series: [
    line(scans, 't', 'weak_angle_t_deg', 'translation', '--run0'), line(scans, 't', 'weak_angle_r_deg', 'rotation', '--run1'),
  ]});
}

function drawRun() {
  for (const id of ['scene', 'information']) document.getElementById(id).hidden = !shown.scans;
  if (!shown.scans) return;
  drawScene(shown.scans);
  drawInformation(shown.scans);
}

function listLayers() {
  const holder = document.getElementById('layers');
  holder.replaceChildren();
  for (const layer of LAYERS) {
    if (!layer.has(shown)) continue;
    const box = element('label', {}, holder), input = element('input', {type: 'checkbox'}, box);
    input.checked = !map.hidden.has(layer.id);
    const color = layer.id === 'estimate' ? `var(${shown.color})` : layer.color;
    element('span', {class: `swatch ${layer.swatch || ''}`,
                     style: layer.swatch === 'dot' ? `background: ${color}` : `color: ${color}`}, box);
    box.append(layer.id === 'estimate' && several ? shown.short : layer.name);
    input.addEventListener('change', () => {
      if (input.checked) map.hidden.delete(layer.id); else map.hidden.add(layer.id);
      map.draw();
    });
  }
}

// The other results of the same scenario are drawn with the estimate.
function listOthers() {
  for (const other of map.others) {
    const key = element('span', {class: 'key'}, document.getElementById('layers'));
    element('span', {class: 'swatch', style: `color: var(${other.color})`}, key);
    key.append(other.short);
  }
}

function show(index) {
  shown = RUNS[index];
  map.show(shown, RUNS.filter(run => run !== shown && run.scenario === shown.scenario));
  listLayers();
  listOthers();
  drawRun();
  for (const table of document.querySelectorAll('#loops [data-run]')) table.hidden = several && Number(table.dataset.run) !== index;
}

function listenToLoops() {
  for (const table of document.querySelectorAll('#loops [data-run]')) {
    table.addEventListener('pointerover', event => {
      const row = event.target.closest('tr[data-row]');
      const loops = RUNS[Number(table.dataset.run)].loops;
      map.marked = row ? loops[Number(row.dataset.row)] : null;
      map.draw();
    });
    table.addEventListener('pointerleave', () => { map.marked = null; map.draw(); });
  }
}

function start() {
  const choice = document.getElementById('run');
  RUNS.forEach((run, i) => element('option', {value: i}, choice, run.name));
  document.getElementById('run-choice').hidden = !several;
  choice.addEventListener('change', () => show(Number(choice.value)));
  document.getElementById('fit').addEventListener('click', () => map.fit());
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => map.draw());
  listenToLoops();
  drawErrors();
  show(0);
  let width = window.innerWidth;
  window.addEventListener('resize', () => {
    if (window.innerWidth === width) return;
    width = window.innerWidth;
    drawErrors();
    drawRun();
  });
}

start();

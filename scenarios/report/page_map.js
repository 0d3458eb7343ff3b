// The map from above on a canvas: points, trajectories, loops; drag to move, wheel to zoom.

function css(name) { return getComputedStyle(document.documentElement).getPropertyValue(name).trim(); }

// What can be shown of a run, in the order of drawing.
const LAYERS = [
  {id: 'cloud', name: 'Map', swatch: 'dot', color: 'rgb(var(--cloud))', has: run => run.map},
  {id: 'odometry', name: 'Odometry', swatch: 'dashed', color: 'var(--odometry)', has: run => run.odometry},
  {id: 'truth', name: 'Truth', color: 'var(--truth)', has: run => run.truth},
  {id: 'estimate', name: 'Estimate', color: 'var(--estimate)', has: run => run.estimate},
  {id: 'weak', name: 'Degenerate directions', color: 'var(--weak)', has: run => run.weak && run.weak.x && run.weak.x.length},
  {id: 'stored', name: 'Stored descriptors', swatch: 'dot', color: 'var(--stored)', has: run => run.stored},
  {id: 'missed', name: 'Missed revisits', swatch: 'dashed', color: 'var(--missed)', has: run => run.missed && run.missed.length},
  {id: 'accepted', name: 'Loops', color: 'var(--good)', has: run => run.loops && run.loops.some(l => l.kind === 'accepted')},
  {id: 'true', name: 'True loops', color: 'var(--good)', has: run => run.loops && run.loops.some(l => l.kind === 'true')},
  {id: 'false', name: 'False loops', color: 'var(--bad)', has: run => run.loops && run.loops.some(l => l.kind === 'false')},
];

class MapView {
  constructor(holder) {
    this.canvas = holder.querySelector('canvas');
    this.readout = holder.querySelector('output');
    this.hidden = new Set();
    this.others = [];
    this.marked = null;
    this.point = null;
    this.listen();
    new ResizeObserver(() => this.resize()).observe(this.canvas);
  }

  show(run, others) {
    this.run = run;
    this.others = others;
    this.cloud = null;
    this.resize();
    this.fit();
  }

  fit() {
    let box = [Infinity, Infinity, -Infinity, -Infinity];
    const extend = (x, y) => { box = [Math.min(box[0], x), Math.min(box[1], y), Math.max(box[2], x), Math.max(box[3], y)]; };
    const {truth, estimate} = this.run;
    if (truth) truth.x.forEach((x, i) => extend(x, truth.y[i]));
    estimate.x.forEach((x, i) => extend(x, estimate.y[i]));
    const margin = 4, width = box[2] - box[0] + 2 * margin, height = box[3] - box[1] + 2 * margin;
    this.scale = Math.min(this.width / width, this.height / height);
    this.centre = [(box[0] + box[2]) / 2, (box[1] + box[3]) / 2];
    this.draw();
  }

  resize() {
    const ratio = window.devicePixelRatio || 1;
    this.width = this.canvas.clientWidth;
    this.height = this.canvas.clientHeight;
    this.canvas.width = Math.round(this.width * ratio);
    this.canvas.height = Math.round(this.height * ratio);
    this.ratio = ratio;
    if (this.scale) this.draw();
  }

  toScreen(x, y) {
    return [this.width / 2 + (x - this.centre[0]) * this.scale, this.height / 2 - (y - this.centre[1]) * this.scale];
  }

  toWorld(px, py) {
    return [this.centre[0] + (px - this.width / 2) / this.scale, this.centre[1] - (py - this.height / 2) / this.scale];
  }

  zoom(factor, px, py) {
    const [x, y] = this.toWorld(px, py);
    this.scale = Math.min(4000, Math.max(0.05, this.scale * factor));
    this.centre = [x - (px - this.width / 2) / this.scale, y + (py - this.height / 2) / this.scale];
    this.draw();
  }

  listen() {
    const canvas = this.canvas;
    let from = null;
    canvas.addEventListener('pointerdown', event => { from = [event.offsetX, event.offsetY]; canvas.setPointerCapture(event.pointerId); });
    canvas.addEventListener('pointerup', () => { from = null; });
    canvas.addEventListener('pointermove', event => {
      if (from) {
        this.centre[0] -= (event.offsetX - from[0]) / this.scale;
        this.centre[1] += (event.offsetY - from[1]) / this.scale;
        from = [event.offsetX, event.offsetY];
        this.draw();
      }
      this.describe(event.offsetX, event.offsetY);
    });
    canvas.addEventListener('pointerleave', () => { this.readout.textContent = ''; });
    canvas.addEventListener('wheel', event => {
      event.preventDefault();
      this.zoom(Math.exp(-event.deltaY * 0.0015), event.offsetX, event.offsetY);
    }, {passive: false});
    canvas.addEventListener('keydown', event => {
      const move = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
      if (move) {
        event.preventDefault();
        this.centre = [this.centre[0] + 60 * move[0] / this.scale, this.centre[1] + 60 * move[1] / this.scale];
        this.draw();
      }
      if (event.key === '+' || event.key === '=') this.zoom(1.25, this.width / 2, this.height / 2);
      if (event.key === '-') this.zoom(0.8, this.width / 2, this.height / 2);
    });
  }

  describe(px, py) {
    const [x, y] = this.toWorld(px, py);
    let text = `x ${x.toFixed(2)} m, y ${y.toFixed(2)} m`, best = 8;
    for (const line of [...(this.run.loops || []), ...(this.run.missed || [])]) {
      if (this.hidden.has(line.kind) || line.kind === 'rejected') continue;
      const a = this.toScreen(...line.from), b = this.toScreen(...line.to);
      const ab = [b[0] - a[0], b[1] - a[1]], length = ab[0] ** 2 + ab[1] ** 2;
      const u = length ? Math.min(1, Math.max(0, ((px - a[0]) * ab[0] + (py - a[1]) * ab[1]) / length)) : 0;
      const distance = Math.hypot(px - a[0] - u * ab[0], py - a[1] - u * ab[1]);
      if (distance < best) { best = distance; text += ` · ${line.label}`; }
    }
    this.readout.textContent = text;
  }

  draw() {
    const g = this.canvas.getContext('2d');
    g.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    g.clearRect(0, 0, this.width, this.height);
    for (const layer of LAYERS) {
      if (this.hidden.has(layer.id) || !layer.has(this.run)) continue;
      g.save();
      this['draw_' + layer.id](g);
      g.restore();
    }
    if (this.marked) this.drawLine(g, this.marked, css('--ink'), 3, []);
    if (this.point) this.drawPoint(g, this.point);
    this.drawScaleBar(g);
  }

  // Many faint dots: written as pixels, lighter where few points fall together.
  draw_cloud(g) {
    const {origin, step_m: step, xyz} = this.run.map;
    const w = this.canvas.width, h = this.canvas.height, image = g.createImageData(w, h);
    const rgb = css('--cloud').split(',').map(Number), scale = this.scale * this.ratio;
    const size = scale > 40 ? 2 : 1;
    for (let i = 0; i < xyz.length; i += 3) {
      const x = origin[0] + xyz[i] * step, y = origin[1] + xyz[i + 1] * step;
      const px = Math.floor(w / 2 + (x - this.centre[0]) * scale), py = Math.floor(h / 2 - (y - this.centre[1]) * scale);
      for (let dx = 0; dx < size; dx++) for (let dy = 0; dy < size; dy++) {
        if (px + dx < 0 || py + dy < 0 || px + dx >= w || py + dy >= h) continue;
        const at = 4 * ((py + dy) * w + px + dx);
        [image.data[at], image.data[at + 1], image.data[at + 2]] = rgb;
        image.data[at + 3] = Math.min(190, image.data[at + 3] + 55);
      }
    }
    g.putImageData(image, 0, 0);
  }

  drawPath(g, path, color, width, dash) {
    g.strokeStyle = color;
    g.lineWidth = width;
    g.lineJoin = 'round';
    g.setLineDash(dash || []);
    g.beginPath();
    path.x.forEach((x, i) => g.lineTo(...this.toScreen(x, path.y[i])));
    g.stroke();
  }

  draw_truth(g) {
    this.drawPath(g, this.run.truth, css('--truth'), 3.5);
    const {x, y} = this.run.truth;
    g.fillStyle = css('--truth');
    for (const [i, text] of [[0, 'start'], [x.length - 1, 'end']]) {
      const [px, py] = this.toScreen(x[i], y[i]);
      g.beginPath();
      g.arc(px, py, 4, 0, 2 * Math.PI);
      g.fill();
      g.font = '12px system-ui, sans-serif';
      g.fillText(text, px + 7, py - 6);
    }
  }

  draw_odometry(g) { this.drawPath(g, this.run.odometry, css('--odometry'), 1.5, [6, 3]); }

  draw_estimate(g) {
    for (const other of this.others) this.drawPath(g, other.estimate, css(other.color), 1.5);
    this.drawPath(g, this.run.estimate, css(this.run.color), 1.75);
  }

  draw_weak(g) {
    const {x, y, dx, dy} = this.run.weak;
    g.strokeStyle = css('--weak');
    g.lineWidth = 1.5;
    g.beginPath();
    x.forEach((value, i) => {
      const half = 0.5;
      g.moveTo(...this.toScreen(value - half * dx[i], y[i] - half * dy[i]));
      g.lineTo(...this.toScreen(value + half * dx[i], y[i] + half * dy[i]));
    });
    g.stroke();
  }

  draw_stored(g) {
    g.fillStyle = css('--stored');
    this.run.stored.x.forEach((x, i) => {
      const [px, py] = this.toScreen(x, this.run.stored.y[i]);
      g.beginPath();
      g.arc(px, py, 2.6, 0, 2 * Math.PI);
      g.fill();
    });
  }

  drawLine(g, line, color, width, dash) {
    const a = this.toScreen(...line.from), b = this.toScreen(...line.to);
    g.strokeStyle = g.fillStyle = color;
    g.lineWidth = width;
    g.setLineDash(dash);
    g.beginPath();
    g.moveTo(...a);
    g.lineTo(...b);
    g.stroke();
    g.setLineDash([]);
    for (const end of [a, b]) {
      g.beginPath();
      g.arc(...end, 2.6, 0, 2 * Math.PI);
      g.fill();
    }
  }

  draw_missed(g) { for (const line of this.run.missed) this.drawLine(g, line, css('--missed'), 1.5, [4, 3]); }
  draw_accepted(g) { for (const line of this.run.loops) if (line.kind === 'accepted') this.drawLine(g, line, css('--good'), 2, []); }
  draw_true(g) { for (const line of this.run.loops) if (line.kind === 'true') this.drawLine(g, line, css('--good'), 2, []); }
  draw_false(g) { for (const line of this.run.loops) if (line.kind === 'false') this.drawLine(g, line, css('--bad'), 2, []); }

  drawPoint(g, point) {
    const [px, py] = this.toScreen(...point);
    g.strokeStyle = css('--ink');
    g.fillStyle = css(this.run.color);
    g.lineWidth = 2;
    g.beginPath();
    g.arc(px, py, 6, 0, 2 * Math.PI);
    g.fill();
    g.stroke();
  }

  drawScaleBar(g) {
    const most = 140 / this.scale, power = 10 ** Math.floor(Math.log10(most));
    const metres = [5, 2, 1].map(s => s * power).find(m => m <= most);
    const right = this.width - 14, y = this.height - 14, left = right - metres * this.scale;
    g.strokeStyle = g.fillStyle = css('--soft');
    g.lineWidth = 1.5;
    g.beginPath();
    g.moveTo(left, y - 4);
    g.lineTo(left, y);
    g.lineTo(right, y);
    g.lineTo(right, y - 4);
    g.stroke();
    g.font = '12px system-ui, sans-serif';
    g.textAlign = 'center';
    g.fillText(`${label(metres)} m`, (left + right) / 2, y - 6);
    g.textAlign = 'start';
  }
}

// SPDX-License-Identifier: GPL-3.0-or-later
import { colours } from '../../../report/web/src/chart.js';
import { number } from '../../../report/web/src/data.js';
import { el, exportButtons } from '../../../report/web/src/dom.js';
import { CanvasPen, SvgPen } from './pens.js';

const plots = new Set();
let asked = false,
  whenDrawn = [];

const shown = (plot) => plot.canvas.isConnected && plot.canvas.clientWidth > 0;

/**
 * Draws every plot that is in sight, once, in the next picture of the browser; the others when they come into sight.
 * `done` is called after that.
 */
export function redrawAll(done = null) {
  if (done) whenDrawn.push(done);
  if (asked) return;
  asked = true;
  requestAnimationFrame(() => {
    asked = false;
    for (const plot of plots) {
      if (!plot.canvas.isConnected) {
        if (plot.seen) plots.delete(plot);
      } else if (plot.inSight && shown(plot)) plot.draw();
      else plot.late = true;
    }
    const calls = whenDrawn;
    whenDrawn = [];
    for (const call of calls) call();
  });
}

// Ink on paper: the pictures are drawn anew before the browser prints, and back after.
for (const event of ['beforeprint', 'afterprint'])
  addEventListener(event, () => {
    for (const plot of plots) if (plot.canvas.isConnected && shown(plot)) plot.draw();
  });

/**
 * The residuals of all rows (scatter.js, vectors.js) are drawn by hand, all else by the plotting library. A selection draws
 * every point of every plot in sight again. The library took 0.55 s or more for 100 000 rows in 6 plots (its `large` scatter, a rectangle
 * for each point; headless browser, two cores). These pens write pixels: 0.12 s. The library also has no arrows in space without
 * WebGL, and its brush and zoom have no keys.
 */
/** A picture of our own: `paint(pen, colours)` draws it with any pen; pen.width and pen.height are its size. */
export class Plot {
  constructor(label, { height, paint, name }) {
    this.label = label;
    this.paint = paint;
    this.canvas = el('canvas', { class: 'plot', role: 'img', tabindex: '0', 'aria-label': label });
    this.canvas.style.height = `${height}px`;
    this.seen = this.inSight = false;
    this.late = true;
    const stem = name ?? label.replace(/[^\w]+/g, '_');
    this.element = el(
      'figure',
      { class: 'plot' },
      this.canvas,
      exportButtons([
        [
          'PNG',
          `${stem}.png`,
          () => {
            this.draw();
            return new Promise((done) => this.canvas.toBlob(done));
          },
        ],
        ['SVG', `${stem}.svg`, () => new Blob([this.svg()], { type: 'image/svg+xml' })],
      ]),
    );
    plots.add(this);
    new ResizeObserver(() => {
      if (shown(this)) this.draw();
    }).observe(this.canvas);
    new IntersectionObserver(
      (entries) => {
        this.inSight = entries.at(-1).isIntersecting;
        if (this.inSight && this.late && shown(this)) this.draw();
      },
      { rootMargin: '120px' },
    ).observe(this.canvas);
  }
  draw() {
    this.seen = true;
    this.late = false;
    this.paint(new CanvasPen(this.canvas, this.canvas.clientWidth, this.canvas.clientHeight), colours());
  }
  svg() {
    const c = colours();
    const pen = new SvgPen(this.canvas.clientWidth, this.canvas.clientHeight, c.panel);
    this.paint(pen, c);
    return pen.toString();
  }
}

/** About `count` round numbers within [low, high]. */
function ticks(low, high, count) {
  const raw = (high - low) / Math.max(1, count);
  if (!(raw > 0) || !Number.isFinite(raw)) return [];
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((k) => k * power).find((one) => one >= raw);
  const list = [];
  for (let at = Math.ceil(low / step) * step; at <= high + 1e-9 * step; at += step) list.push(Math.abs(at) < 1e-9 * step ? 0 : at);
  return list;
}

/** Frame, grid and words of two axes; view: {x: [low, high], y: [low, high]}. */
export function axes(pen, area, view, { x, y, title }, c) {
  const toX = (value) => area.x + ((value - view.x[0]) / (view.x[1] - view.x[0])) * area.w;
  const toY = (value) => area.y + area.h - ((value - view.y[0]) / (view.y[1] - view.y[0])) * area.h;
  for (const value of ticks(...view.y, area.h / 34)) {
    pen.line([area.x, toY(value), area.x + area.w, toY(value)], value === 0 ? c.soft : c.line, 1);
    pen.text(area.x - 4, toY(value), number(value, 3), { colour: c.soft, align: 'right', size: 10 });
  }
  for (const value of ticks(...view.x, area.w / 62)) {
    pen.line([toX(value), area.y, toX(value), area.y + area.h], c.line, 1);
    pen.text(toX(value), area.y + area.h + 8, number(value, 3), { colour: c.soft, align: 'center', size: 10 });
  }
  pen.rect(area.x, area.y, area.w, area.h, null, c.line);
  if (x) pen.text(area.x + area.w / 2, area.y + area.h + 21, x, { colour: c.ink, align: 'center', size: 11 });
  if (y) pen.text(area.x - 38, area.y + area.h / 2, y, { colour: c.ink, align: 'center', size: 11, turn: -Math.PI / 2 });
  if (title) pen.text(area.x + 2, area.y - 8, title, { colour: c.ink, size: 11, bold: true });
}

/** Least and largest finite value, a little apart. */
export function range(values, margin = 0.04) {
  let low = Infinity,
    high = -Infinity;
  for (let i = 0; i < values.length; ++i) {
    const value = values[i];
    if (value < low && value > -1e30) low = value;
    if (value > high && value < 1e8) high = value;
  }
  if (!(low <= high)) return [0, 1];
  const pad = (high - low) * margin || Math.abs(high) * 0.1 || 1;
  return [low - pad, high + pad];
}

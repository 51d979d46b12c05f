// SPDX-License-Identifier: GPL-3.0-or-later
import { number } from '../../../report/web/src/data.js';
import { el } from '../../../report/web/src/dom.js';
import { Plot, axes, range, redrawAll } from './plot.js';
import { select, selection, store } from './store.js';
import { hideTip, showTip } from './tip.js';

const kFit = 0,
  kCheck = 1,
  kDim = 2,
  kChosen = 3,
  kOver = 4;
export const kNone = 255;
// More bars than these hide one another, and the points.
const kMostBars = 800;
const kNearPx = 9;
// Narrower plots stand in rows, with one key for all of them.
const kLegendFrom = 420;

/** Colours of points: fit and check rows; where rows are chosen, all others step back. */
export const palette = (c) => [c.fit, c.check, c.line, c.accent2, c.ccw];

/** What the colours of small plots are. */
export const pointKey = () =>
  el(
    'p',
    { class: 'key' },
    [
      ['fit', 'fit rows'],
      ['check', 'check rows, which no fit has seen'],
      ['accent2', 'chosen rows'],
    ].map(([ink, words]) => el('span', {}, el('i', { class: `dot ${ink}` }), words)),
    el('span', {}, 'bars: ± standard uncertainty of the reading'),
  );

/**
 * Points of observations: data() gives {x, y, row, u, check, overlay} (typed arrays; u: standard uncertainties of y, drawn
 * as bars where there are few points, may be absent; overlay: other y values laid over, or null) and words() {x, y, title}.
 * Pointing at one tells its row. Drag: choose rows. Shift-drag or arrow keys: move. Wheel, + and -: zoom. Double click
 * or 0: the whole. Escape: choose nothing.
 */
export function scatter(label, { height, data, words, name, fixed = null }) {
  let view = null,
    drag = null,
    drawn = null;
  const whole = () => {
    const d = data();
    return { x: range(d.x), y: fixed?.() ?? range(d.overlay ? [...range(d.y, 0), ...range(d.overlay, 0)] : d.y) };
  };
  const areaOf = (pen) => ({ x: 50, y: 18, w: Math.max(10, pen.width - 60), h: Math.max(10, pen.height - 50) });
  /** Reading ± its standard uncertainty. */
  const bars = (pen, area, d, ky, ink) => {
    const points = [];
    for (let i = 0; i < d.u.length; ++i) {
      const half = d.u[i] * ky,
        x = drawn.px[i];
      if (!(half > 0) || x < area.x || x > area.x + area.w) continue;
      const low = Math.min(area.y + area.h, drawn.py[i] + half),
        high = Math.max(area.y, drawn.py[i] - half);
      if (low > high) points.push(x, low, x, high, NaN, NaN);
    }
    if (points.length) pen.line(points, ink, 1);
  };
  /** What the colours are, at the right: above the frame, or within it where a title is in the way. */
  const legend = (pen, area, d, any, c) => {
    if (area.w < kLegendFrom) return;
    const inks = palette(c);
    const has = (role) => d.row.some((row) => Number(Boolean(d.check[row])) === role);
    const items = any
      ? [
          ['chosen', inks[kChosen]],
          ['others', inks[kDim]],
        ]
      : [...(has(0) ? [['fit rows', inks[kFit]]] : []), ...(has(1) ? [['check rows', inks[kCheck]]] : [])];
    if (d.overlay) items.push(['explained', inks[kOver]]);
    if (d.u && d.u.length <= kMostBars && d.u.some((u) => u > 0)) items.push(['± u', c.soft]);
    const wide = items.reduce((sum, [text]) => sum + 6 * text.length + 18, 0);
    const y = 6.4 * (words().title ?? '').length + wide < area.w ? area.y - 9 : area.y + 9;
    let x = area.x + area.w - (y > area.y ? 6 : 0);
    for (const [text, ink] of items.reverse()) {
      pen.text(x, y, text, { colour: c.soft, align: 'right', size: 10 });
      x -= 6 * text.length + 6;
      pen.rect(x - 4, y - 3, 6, 6, ink);
      x -= 12;
    }
  };
  const plot = new Plot(label, {
    height,
    name,
    paint(pen, c) {
      const d = data();
      if (!d) return;
      if (view === null) view = whole();
      const area = areaOf(pen);
      axes(pen, area, view, words(), c);
      const n = d.x.length;
      if (!drawn || drawn.n !== n) drawn = { n, px: new Float32Array(n), py: new Float32Array(n), colour: new Uint8Array(n) };
      const kx = area.w / (view.x[1] - view.x[0]),
        ky = area.h / (view.y[1] - view.y[0]);
      const place = (values) => {
        for (let i = 0; i < n; ++i) {
          drawn.px[i] = area.x + (d.x[i] - view.x[0]) * kx;
          drawn.py[i] = area.y + area.h - (values[i] - view.y[0]) * ky;
        }
      };
      place(d.y);
      const any = selection.count > 0;
      if (d.u && n <= kMostBars) bars(pen, area, d, ky, any ? c.line : c.soft);
      const size = n > 20000 ? 1.5 : n > 3000 ? 2 : 3;
      for (let i = 0; i < n; ++i) drawn.colour[i] = any ? kDim : d.check[d.row[i]] ? kCheck : kFit;
      pen.dots(area, drawn.px, drawn.py, drawn.colour, palette(c), size);
      if (any) {
        for (let i = 0; i < n; ++i) drawn.colour[i] = selection.rows[d.row[i]] ? kChosen : kNone;
        pen.dots(area, drawn.px, drawn.py, drawn.colour, palette(c), size + 1);
      }
      if (d.overlay) {
        place(d.overlay);
        drawn.colour.fill(kOver);
        pen.dots(area, drawn.px, drawn.py, drawn.colour, palette(c), size);
      }
      legend(pen, area, d, any, c);
      if (drag?.brush)
        pen.rect(
          Math.min(drag.x0, drag.x1),
          Math.min(drag.y0, drag.y1),
          Math.abs(drag.x1 - drag.x0),
          Math.abs(drag.y1 - drag.y0),
          c.accent2,
          c.accent2,
          0.15,
        );
    },
  });
  const { canvas } = plot;
  const at = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  const area = () => areaOf({ width: canvas.clientWidth, height: canvas.clientHeight });
  const valueAt = (px, py) => {
    const a = area();
    return [view.x[0] + ((px - a.x) / a.w) * (view.x[1] - view.x[0]), view.y[0] + ((a.y + a.h - py) / a.h) * (view.y[1] - view.y[0])];
  };
  const move = (dx, dy) => {
    const [w, h] = [view.x[1] - view.x[0], view.y[1] - view.y[0]];
    view = { x: view.x.map((v) => v - dx * w), y: view.y.map((v) => v + dy * h) };
    plot.draw();
  };
  const zoom = (factor, cx = null, cy = null) => {
    const [mx, my] = cx === null ? [(view.x[0] + view.x[1]) / 2, (view.y[0] + view.y[1]) / 2] : valueAt(cx, cy);
    view = { x: view.x.map((v) => mx + (v - mx) * factor), y: view.y.map((v) => my + (v - my) * factor) };
    plot.draw();
  };
  const brush = (add) => {
    const d = data();
    const [xa, ya] = valueAt(Math.min(drag.x0, drag.x1), Math.max(drag.y0, drag.y1)),
      [xb, yb] = valueAt(Math.max(drag.x0, drag.x1), Math.min(drag.y0, drag.y1));
    const rows = add ? selection.rows.slice() : new Uint8Array(selection.rows.length);
    for (let i = 0; i < d.x.length; ++i) if (d.x[i] >= xa && d.x[i] <= xb && d.y[i] >= ya && d.y[i] <= yb) rows[d.row[i]] = 1;
    select(rows);
  };
  canvas.addEventListener('pointerdown', (event) => {
    if (view === null || event.button !== 0) return;
    const [x, y] = at(event);
    drag = { x0: x, y0: y, x1: x, y1: y, brush: !event.shiftKey, add: event.ctrlKey || event.metaKey };
    canvas.setPointerCapture(event.pointerId);
  });
  /** The point under the pointer, as words. */
  const tell = (event) => {
    const d = data();
    if (!d || drawn === null || !store.rows) return hideTip();
    const [x, y] = at(event);
    let best = -1,
      least = kNearPx * kNearPx;
    const values = d.y,
      a = area(),
      kx = a.w / (view.x[1] - view.x[0]),
      ky = a.h / (view.y[1] - view.y[0]);
    for (let i = 0; i < values.length; ++i) {
      const dx = a.x + (d.x[i] - view.x[0]) * kx - x,
        dy = a.y + a.h - (values[i] - view.y[0]) * ky - y;
      if (dx * dx + dy * dy < least) {
        least = dx * dx + dy * dy;
        best = i;
      }
    }
    if (best < 0) return hideTip();
    const { rows } = store,
      row = d.row[best],
      said = words();
    return showTip(event, [
      `${rows.files[rows.row_file[row]]}, line ${rows.row_line[row]}${rows.runs[rows.row_run[row]] ? `, run ${rows.runs[rows.row_run[row]]}` : ''}, ${d.check[row] ? 'check' : 'fit'} row`,
      `${said.x ?? said.title ?? 'at'}: ${number(d.x[best], 6)}`,
      `${said.y ?? 'residual'}: ${number(values[best], 4)}${d.u && d.u[best] > 0 ? ` ± ${number(d.u[best], 2)} (u)` : ''}`,
    ]);
  };
  canvas.addEventListener('pointerleave', hideTip);
  canvas.addEventListener('pointermove', (event) => {
    if (drag === null) {
      if (view !== null) tell(event);
      return;
    }
    hideTip();
    const [x, y] = at(event);
    if (!drag.brush) move((x - drag.x1) / area().w, (y - drag.y1) / area().h);
    Object.assign(drag, { x1: x, y1: y });
    if (drag.brush) plot.draw();
  });
  canvas.addEventListener('pointerup', () => {
    if (drag === null) return;
    const moved = Math.hypot(drag.x1 - drag.x0, drag.y1 - drag.y0) > 3;
    if (drag.brush && moved) brush(drag.add);
    else if (drag.brush && selection.count) select(new Uint8Array(selection.rows.length));
    drag = null;
    plot.draw();
  });
  canvas.addEventListener('pointercancel', () => {
    drag = null;
  });
  canvas.addEventListener(
    'wheel',
    (event) => {
      if (view === null || !(event.ctrlKey || document.activeElement === canvas)) return;
      event.preventDefault();
      zoom(event.deltaY > 0 ? 1.2 : 1 / 1.2, ...at(event));
    },
    { passive: false },
  );
  canvas.addEventListener('dblclick', () => {
    view = whole();
    plot.draw();
  });
  canvas.addEventListener('keydown', (event) => {
    const act = {
      ArrowLeft: () => move(0.1, 0),
      ArrowRight: () => move(-0.1, 0),
      ArrowUp: () => move(0, 0.1),
      ArrowDown: () => move(0, -0.1),
      '+': () => zoom(1 / 1.2),
      '-': () => zoom(1.2),
      0: () => {
        view = whole();
        plot.draw();
      },
      Escape: () => select(new Uint8Array(selection.rows.length)),
    }[event.key];
    if (!act || view === null) return;
    event.preventDefault();
    act();
  });
  plot.reset = () => {
    view = null;
    drawn = null;
    redrawAll();
  };
  return plot;
}

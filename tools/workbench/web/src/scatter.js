// SPDX-License-Identifier: GPL-3.0-or-later
import { Plot, axes, range, redrawAll } from './plot.js';
import { select, selection } from './store.js';

const kFit = 0,
  kCheck = 1,
  kDim = 2,
  kChosen = 3,
  kOver = 4;
export const kNone = 255;

/** Colours of points: fit and check rows; where rows are chosen, all others step back. */
export const palette = (c) => [c.fit, c.check, c.line, c.accent2, c.ccw];

/**
 * Points of observations: data() gives {x, y, row, check, overlay} (typed arrays; overlay: other y values laid over, or
 * null) and words() {x, y, title}. Drag: choose rows. Shift-drag or arrow keys: move. Wheel, + and -: zoom. Double click
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
      const size = n > 20000 ? 1.5 : n > 3000 ? 2 : 3;
      const any = selection.count > 0;
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
  canvas.addEventListener('pointermove', (event) => {
    if (drag === null) return;
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

// SPDX-License-Identifier: GPL-3.0-or-later
import { choice, el } from '../../../report/web/src/dom.js';
import { number } from '../../../report/web/src/data.js';
import { Plot, redrawAll, ticks } from './plot.js';
import { kNone } from './scatter.js';
import { select, selection, store } from './store.js';

const kSteps = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];

/** Ball-bar plot of a circle: deviation from the nominal circle, magnified; drag across a sector: choose its rows. */
export function polarPlot(circle, height) {
  const [a, b] = circle.plane;
  let most = 0,
    drag = null;
  for (const run of circle.runs)
    run.measured_um.forEach((value, i) => {
      if (!run.check[i]) most = Math.max(most, Math.abs(value));
    });
  let step = kSteps.find((one) => one * 3 >= most) ?? 1000;
  const frame = (pen) => ({ cx: pen.width / 2, cy: pen.height / 2, unit: (Math.min(pen.width, pen.height) / 2 - 26) / 8 });
  const ring = (f, um, from = 0, to = 360) => {
    const r = f.unit * (5 + um / step),
      points = [];
    for (let deg = from; deg <= to; deg += 3)
      points.push(f.cx + r * Math.cos((deg * Math.PI) / 180), f.cy - r * Math.sin((deg * Math.PI) / 180));
    return points;
  };
  const place = (f, deg, um) => {
    const r = f.unit * Math.max(0, 5 + um / step),
      angle = (deg * Math.PI) / 180;
    return [f.cx + r * Math.cos(angle), f.cy - r * Math.sin(angle)];
  };
  const track = (f, run, values, check) => {
    const points = [];
    for (let i = 0; i < values.length; ++i)
      points.push(...(Boolean(run.check[i]) === check ? place(f, run.angle_deg[i], values[i]) : [NaN, NaN]));
    return points;
  };
  const plot = new Plot(`Polar plot, ${a}${b} plane`, {
    height,
    name: `polar_${a}${b}`,
    paint(pen, c) {
      const f = frame(pen);
      for (const k of ticks(-5, 3, 8)) pen.line(ring(f, k * step), k === 0 ? c.ink : c.line, k === 0 ? 1.4 : 1, k === 0 ? [5, 4] : []);
      for (let deg = 0; deg < 360; deg += 30) pen.line([...place(f, deg, -5 * step), ...place(f, deg, 3 * step)], c.line);
      ['+' + a, '+' + b, '−' + a, '−' + b].forEach((name, k) => {
        const [x, y] = place(f, 90 * k, 3.7 * step);
        pen.text(x, y, name, { colour: c.ink, align: 'center' });
      });
      circle.runs.forEach((run) => {
        const colour = run.direction > 0 ? c.ccw : c.cw;
        pen.line(track(f, run, run.measured_um, false), colour, 1);
        pen.line(track(f, run, run.model_um, false), colour, 2.4);
        pen.line(track(f, run, run.measured_um, true), colour, 1, [2, 3]);
        if (selection.count) {
          const px = new Float32Array(run.row.length),
            py = new Float32Array(run.row.length);
          const shade = Uint8Array.from(run.row, (row, i) => {
            [px[i], py[i]] = place(f, run.angle_deg[i], run.measured_um[i]);
            return selection.rows[row] ? 0 : kNone;
          });
          pen.dots({ x: 0, y: 0, w: pen.width, h: pen.height }, px, py, shade, [c.accent2], 3);
        }
        pen.text(8, 14 + 15 * circle.runs.indexOf(run), `${run.label} thin: measured, thick: model`, { colour });
      });
      if (drag)
        pen.line([f.cx, f.cy, ...place(f, drag.from, 3 * step), NaN, NaN, f.cx, f.cy, ...place(f, drag.to, 3 * step)], c.accent2, 1.5);
      pen.text(8, pen.height - 10, `${number(step)} µm per division; nominal radius ${number(circle.nominal_radius_mm, 6)} mm`, {
        colour: c.soft,
      });
    },
  });
  const angleOf = (event) => {
    const box = plot.canvas.getBoundingClientRect(),
      f = frame({ width: box.width, height: box.height });
    return ((Math.atan2(f.cy - (event.clientY - box.top), event.clientX - box.left - f.cx) * 180) / Math.PI + 360) % 360;
  };
  plot.canvas.addEventListener('pointerdown', (event) => {
    drag = { from: angleOf(event), to: angleOf(event) };
    plot.canvas.setPointerCapture(event.pointerId);
  });
  plot.canvas.addEventListener('pointermove', (event) => {
    if (drag) {
      drag.to = angleOf(event);
      plot.draw();
    }
  });
  plot.canvas.addEventListener('pointerup', () => {
    if (!drag) return;
    // The shorter way round between the two rays.
    let [from, to] = [drag.from, drag.to];
    if ((to - from + 360) % 360 > 180) [from, to] = [to, from];
    const wide = (to - from + 360) % 360;
    drag = null;
    const rows = new Uint8Array(store.rows.n_rows);
    if (wide > 0.5)
      circle.runs.forEach((run) =>
        run.row.forEach((row, i) => {
          if ((run.angle_deg[i] - from + 360) % 360 <= wide) rows[row] = 1;
        }),
      );
    select(rows);
  });
  plot.element.prepend(
    el(
      'div',
      { class: 'controls' },
      choice(
        'magnification',
        kSteps.map((one) => [String(one), `${one} µm/div`]),
        String(step),
        (value) => {
          step = Number(value);
          redrawAll();
        },
      ),
    ),
  );
  return plot;
}

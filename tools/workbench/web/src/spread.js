// SPDX-License-Identifier: GPL-3.0-or-later
import { number } from '../../../report/web/src/data.js';
import { Plot, axes } from './plot.js';
import { select, selection, store } from './store.js';

const kBins = 60;

/** Quantile of the standard normal distribution (Acklam's rational approximation, 1.2e-9 relative). */
function normalQuantile(p) {
  const a = [-39.69683028665376, 220.9460984245205, -275.9285104469687, 138.357751867269, -30.66479806614716, 2.506628277459239];
  const b = [-54.47609879822406, 161.5858368580409, -155.6989798598866, 66.80131188771972, -13.28068155288572];
  const c = [-0.007784894002430293, -0.3223964580411365, -2.400758277161838, -2.549732539343734, 4.374664141464968, 2.938163982698783];
  const d = [0.007784695709041462, 0.3224671290700398, 2.445134137142996, 3.754408661907416];
  const poly = (list, x) => list.reduce((sum, one) => sum * x + one, 0);
  if (p > 0.5) return -normalQuantile(1 - p);
  if (p < 0.02425) {
    const q = Math.sqrt(-2 * Math.log(p));
    return poly(c, q) / (poly(d, q) * q + 1);
  }
  const q = p - 0.5,
    r = q * q;
  return (poly(a, r) * q) / (poly(b, r) * r + 1);
}

/** The group in increasing order: values, normal scores and the place in the group; worked out once. */
function sorted(group) {
  if (group.sorted) return group.sorted;
  const n = group.value.length;
  const order = Uint32Array.from({ length: n }, (_, i) => i).sort((i, j) => group.value[i] - group.value[j]);
  const value = new Float32Array(n),
    score = new Float32Array(n),
    row = new Uint32Array(n);
  for (let i = 0; i < n; ++i) {
    value[i] = group.value[order[i]];
    row[i] = group.row[order[i]];
    score[i] = normalQuantile((i + 0.5) / n);
  }
  group.sorted = { value, score, row };
  return group.sorted;
}

export const sortedGroup = sorted;

/** Histogram of a group's residuals; drag: choose the rows within. */
export function histogram(label, height, group) {
  let drag = null;
  const areaOf = (pen) => ({ x: 50, y: 18, w: Math.max(10, pen.width - 60), h: Math.max(10, pen.height - 50) });
  const limitsOf = (one) => {
    const { value } = sorted(one);
    const most = Math.max(Math.abs(value[0]), Math.abs(value[value.length - 1])) || 1;
    return [-most * 1.02, most * 1.02];
  };
  const plot = new Plot(label, {
    height,
    name: 'histogram',
    paint(pen, c) {
      const one = group();
      if (!one) return;
      const [low, high] = limitsOf(one),
        area = areaOf(pen);
      const all = new Uint32Array(kBins),
        chosen = new Uint32Array(kBins);
      for (let i = 0; i < one.value.length; ++i) {
        const bin = Math.min(kBins - 1, Math.floor(((one.value[i] - low) / (high - low)) * kBins));
        ++all[bin];
        if (selection.count && selection.rows[one.row[i]]) ++chosen[bin];
      }
      const most = Math.max(...all) * 1.08;
      axes(pen, area, { x: [low, high], y: [0, most] }, { x: `residual ${one.kind} [${one.unit}]`, y: 'rows', title: 'histogram' }, c);
      const bar = (counts, colour, opacity) =>
        counts.forEach((count, bin) => {
          if (count)
            pen.rect(
              area.x + (bin * area.w) / kBins + 0.5,
              area.y + area.h * (1 - count / most),
              area.w / kBins - 1,
              (area.h * count) / most,
              colour,
              null,
              opacity,
            );
        });
      bar(all, selection.count ? c.soft : c.fit, selection.count ? 0.35 : 0.8);
      bar(chosen, c.accent2, 1);
      if (drag) pen.rect(Math.min(drag.x0, drag.x1), area.y, Math.abs(drag.x1 - drag.x0), area.h, c.accent2, c.accent2, 0.15);
    },
  });
  const xOf = (event) => event.clientX - plot.canvas.getBoundingClientRect().left;
  plot.canvas.addEventListener('pointerdown', (event) => {
    drag = { x0: xOf(event), x1: xOf(event) };
    plot.canvas.setPointerCapture(event.pointerId);
  });
  plot.canvas.addEventListener('pointermove', (event) => {
    if (drag) {
      drag.x1 = xOf(event);
      plot.draw();
    }
  });
  plot.canvas.addEventListener('pointerup', () => {
    if (!drag || !group()) return;
    const one = group(),
      area = areaOf({ width: plot.canvas.clientWidth, height }),
      [low, high] = limitsOf(one);
    const [from, to] = [Math.min(drag.x0, drag.x1), Math.max(drag.x0, drag.x1)].map((x) => low + ((x - area.x) / area.w) * (high - low));
    drag = null;
    const rows = new Uint8Array(store.rows.n_rows);
    if (to > from) for (let i = 0; i < one.value.length; ++i) if (one.value[i] >= from && one.value[i] <= to) rows[one.row[i]] = 1;
    select(rows);
  });
  return plot;
}

/** Mean and spread of a group in words. */
export function spreadWords(group) {
  let sum = 0,
    squares = 0;
  for (const value of group.value) {
    sum += value;
    squares += value * value;
  }
  return `${group.kind}: ${group.value.length} readings, mean ${number(sum / group.value.length, 3)}, rms ${number(Math.sqrt(squares / group.value.length), 4)} ${group.unit}`;
}

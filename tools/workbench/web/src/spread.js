// SPDX-License-Identifier: GPL-3.0-or-later
import { axisStyle, chart, colours, tooltipStyle } from '../../../report/web/src/chart.js';
import { number, printed } from '../../../report/web/src/data.js';
import { el } from '../../../report/web/src/dom.js';
import { dragged } from './drag.js';
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
export function sorted(group) {
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

/** Histogram of a group's residuals; drag: choose the rows within. A figure with its chart as `plot`. */
export function histogram(label, height, group) {
  let limits = [];
  const plot = chart(label, () => {
    const c = colours(),
      one = group();
    const { value } = sorted(one);
    const most = 1.02 * (Math.max(Math.abs(value[0]), Math.abs(value[value.length - 1])) || 1);
    const counts = { all: new Uint32Array(kBins), chosen: new Uint32Array(kBins) };
    for (let i = 0; i < one.value.length; ++i) {
      const bin = Math.min(kBins - 1, Math.floor(((one.value[i] + most) / (2 * most)) * kBins));
      ++counts.all[bin];
      if (selection.count && selection.rows[one.row[i]]) ++counts.chosen[bin];
    }
    const bars = (name, color, opacity) => ({
      name,
      type: 'bar',
      barWidth: '92%',
      barGap: '-100%',
      itemStyle: { color, opacity },
      data: Array.from(counts[name], (count, bin) => [-most + ((bin + 0.5) * 2 * most) / kBins, count]),
    });
    const axis = (name, nameGap) => ({ ...axisStyle(c), type: 'value', name, nameLocation: 'middle', nameGap });
    const series = [bars('all', selection.count ? c.soft : c.fit, selection.count ? 0.35 : 0.8), bars('chosen', c.accent2, 1)];
    if (limits.length)
      series[0].markLine = {
        silent: true,
        symbol: 'none',
        label: { show: false },
        lineStyle: { color: c.accent2 },
        data: limits.map((xAxis) => ({ xAxis })),
      };
    return {
      height,
      option: {
        tooltip: { ...tooltipStyle(c), trigger: 'axis' },
        grid: { left: 58, right: 16, top: 18, bottom: 46 },
        xAxis: {
          ...axis(`residual ${one.kind} [${one.unit}]`, 28),
          min: -most,
          max: most,
          axisLabel: { ...axisStyle(c).axisLabel, formatter: (x) => number(x, 3) },
        },
        yAxis: axis('rows', 38),
        series,
      },
    };
  });
  dragged(
    plot,
    (event) => plot.valueAt(event, 'gridIndex')?.[0] ?? null,
    (from, to) => {
      limits = from === null ? [] : [from, to];
      plot.redraw();
    },
    (a, b) => {
      const one = group(),
        [from, to] = [Math.min(a, b), Math.max(a, b)];
      const rows = new Uint8Array(store.rows.n_rows);
      if (to > from) for (let i = 0; i < one.value.length; ++i) if (one.value[i] >= from && one.value[i] <= to) rows[one.row[i]] = 1;
      select(rows);
    },
  );
  return Object.assign(el('figure', {}, plot), { plot });
}

/** Mean and spread of a group in words. */
export function spreadWords(group) {
  let sum = 0,
    squares = 0;
  for (const value of group.value) {
    sum += value;
    squares += value * value;
  }
  const rms = Math.sqrt(squares / group.value.length),
    mean = sum / group.value.length;
  return `${group.kind}: ${group.value.length} readings, mean ${printed(number(Math.abs(mean) < 1e-6 * rms ? 0 : mean, 3))}, rms ${number(rms, 4)} ${group.unit}`;
}

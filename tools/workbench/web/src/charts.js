// SPDX-License-Identifier: GPL-3.0-or-later
import { axisStyle, colours, legendStyle, tooltipStyle } from '../../../report/web/src/chart.js';
import { number } from '../../../report/web/src/data.js';
import { labelled } from '../../../report/web/src/diagnosis.js';
import { ladderOptions } from '../../../report/web/src/plots.js';
import { figure } from './parts.js';

const tip = (c, unit) => ({
  ...tooltipStyle(c),
  trigger: 'axis',
  axisPointer: { type: 'shadow' },
  valueFormatter: (value) => `${number(value, 4)} ${unit}`,
});

/** The ladder of a diagnosis with its noise floor. */
export function ladderFigure(result) {
  const steps = labelled(result);
  return steps.length
    ? figure(
        'ladder',
        ladderOptions(steps, Number.isFinite(result.noise_um) ? result.noise_um : null),
        'Check rows are no part of any fit: only their fall is a gain.',
      )
    : null;
}

/** Steps on one scale: [{label, rms_um, check_rms_um}]. */
export const fallingFigure = (steps, noise) => figure('before and after', ladderOptions(steps, Number.isFinite(noise) ? noise : null));

const kShares = [
  ['linearisation_um', 'neglected terms'],
  ['table_um', 'tables (truncation)'],
  ['function_um', 'functions'],
  ['rounding_um', 'rounding'],
  ['input_um', 'inputs (quantisation)'],
  ['lag_um', 'lags'],
  ['second_order_um', 'second order'],
];

/** How the bounds stand to the noise, in words: beside its bar theirs could not be seen. */
function besideNoise(outputs, noise) {
  const most = Math.max(...outputs.map((one) => one.total_um));
  if (!Number.isFinite(noise) || !(noise > 0)) return '';
  return most < noise
    ? ` The noise of the measurement, ${number(noise, 3)} µm, is ${number(noise / most, 2)} times the largest.`
    : ` The noise of the measurement is ${number(noise, 3)} µm.`;
}

/** What the proved bound of each output is made of, the noise of the measurement beside it. */
export function budgetFigure(bound, noise) {
  const outputs = bound.outputs.filter((one) => one.total_um > 0);
  return figure(
    'error budget',
    () => {
      const c = colours();
      const inks = [c.fit, c.check, c.ccw, c.cw, c.accent2, c.soft, c.ink];
      const rows = outputs.map((one) => one.axis);
      const series = kShares.map(([key, name], k) => ({
        name,
        type: 'bar',
        stack: 'bound',
        barMaxWidth: 30,
        itemStyle: { color: inks[k] },
        data: outputs.map((one) => one[key]),
      }));
      // An empty bar at the end of each carries its sum.
      series.push({
        name: 'sum',
        type: 'bar',
        stack: 'bound',
        barMaxWidth: 30,
        itemStyle: { color: 'transparent' },
        data: outputs.map((one) => ({ value: 0, label: { formatter: `${number(one.total_um, 3)} µm` } })),
        label: { show: true, position: 'right', color: c.ink, fontSize: 11 },
        tooltip: { show: false },
      });
      return {
        height: 110 + 44 * rows.length,
        option: {
          legend: { ...legendStyle(c), top: 0, left: 0, data: kShares.map(([, name]) => name) },
          tooltip: tip(c, 'µm'),
          grid: { left: 10, right: 80, top: 48, bottom: 40, containLabel: true },
          xAxis: {
            ...axisStyle(c),
            type: 'value',
            min: 0,
            name: 'proved bound of the correction [µm]',
            nameLocation: 'middle',
            nameGap: 26,
          },
          yAxis: { ...axisStyle(c), type: 'category', inverse: true, data: rows, splitLine: { show: false } },
          series,
        },
      };
    },
    outputs.length
      ? `Worst case over the whole declared range, proved; seen errors are two to five times smaller.${besideNoise(outputs, noise)}`
      : null,
  );
}

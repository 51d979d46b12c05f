// SPDX-License-Identifier: GPL-3.0-or-later
import { axisStyle, chart, colours, legendStyle, tooltipStyle } from './chart.js';
import { el } from './dom.js';
import { legendEntries } from './legend.js';
import { byKind } from './matrix.js';
import { number } from './data.js';

const kBins = 60;

/** How the residuals of one unit are distributed, fit rows beside check rows, as share of their rows. */
export function histogram(detail, unit) {
  const { residual, row } = detail.observations;
  const values = { fit: [], check: [] };
  for (const group of byKind(detail.observations).filter((one) => one.unit === unit)) {
    for (const i of group.index) (detail.row_check?.[row[i]] ? values.check : values.fit).push(residual[i]);
  }
  let limit = 0;
  for (const value of [...values.fit, ...values.check]) limit = Math.max(limit, Math.abs(value));
  if (!(limit > 0)) return null;
  const share = (list) => {
    const counts = new Float64Array(kBins);
    for (const value of list) counts[Math.min(kBins - 1, Math.floor(((value + limit) / (2 * limit)) * kBins))] += 100 / list.length;
    return Array.from(counts, (count, bin) => [-limit + ((bin + 0.5) * 2 * limit) / kBins, count]);
  };
  const plot = chart(`Histogram of the residuals in ${unit}`, () => {
    const c = colours();
    const series = [
      {
        name: 'fit rows',
        type: 'bar',
        data: share(values.fit),
        barWidth: '96%',
        barGap: '-100%',
        itemStyle: { color: c.fit, opacity: 0.55 },
      },
    ];
    if (values.check.length) {
      series.push({
        name: 'check rows',
        type: 'line',
        step: 'middle',
        data: share(values.check),
        showSymbol: false,
        itemStyle: { color: c.check },
        lineStyle: { color: c.check, width: 2 },
      });
    }
    return {
      height: 260,
      option: {
        legend: { ...legendStyle(c), top: 0, right: 8 },
        tooltip: { ...tooltipStyle(c), trigger: 'axis', valueFormatter: (value) => `${number(value, 3)} %` },
        grid: { left: 58, right: 16, top: 30, bottom: 46 },
        xAxis: {
          ...axisStyle(c),
          type: 'value',
          min: -limit,
          max: limit,
          name: `residual [${unit}]`,
          nameLocation: 'middle',
          nameGap: 28,
          splitLine: { show: false },
          axisLabel: { ...axisStyle(c).axisLabel, showMinLabel: false, showMaxLabel: false, formatter: (value) => number(value, 3) },
        },
        yAxis: {
          ...axisStyle(c),
          type: 'value',
          axisLine: { show: false, onZero: false },
          name: 'share of rows [%]',
          nameLocation: 'middle',
          nameGap: 38,
        },
        series,
      },
    };
  });
  return el('figure', {}, plot);
}

/** Fit and check rms of each step: [{label, rms_um, check_rms_um}]; the noise floor as a line where it is known. */
export function ladder(steps, noise = null) {
  return el('figure', {}, chart('Rms of fit and check rows at each step', ladderOptions(steps, noise)));
}

const kLabelWidth = 300, // px of the label of a step
  kLettersOfLine = 40, // of 13 px in that width
  kLineHeight = 18;

/** What `chart` wants for it. A measurement of angles alone has steps in µrad. */
export function ladderOptions(steps, noise = null) {
  const lengths = steps.some((step) => Number.isFinite(step.rms_um)) || !steps.some((step) => Number.isFinite(step.rms_urad));
  const unit = lengths ? 'µm' : 'µrad',
    key = lengths ? 'um' : 'urad';
  // A row is as high as its label: one of four lines stands over its neighbours else.
  const lines = Math.max(1, ...steps.map((step) => Math.ceil((step.label ?? '').length / kLettersOfLine)));
  const rowHeight = Math.max(58, kLineHeight * (lines + 1));
  return () => {
    const c = colours();
    const bar = (name, of, color) => ({
      name,
      type: 'bar',
      data: steps.map((step) => step[of] ?? null),
      barMaxWidth: 26,
      itemStyle: { color },
      label: {
        show: true,
        position: 'right',
        color: c.ink,
        backgroundColor: c.panel,
        fontSize: 12,
        formatter: ({ value }) => number(value, 3),
      },
    });
    const series = [bar('fit rows', `rms_${key}`, c.fit)];
    if (steps.some((step) => Number.isFinite(step[`check_rms_${key}`])))
      series.push(bar('check rows (not seen by the fit)', `check_rms_${key}`, c.check));
    if (noise !== null) {
      series[0].markLine = {
        silent: true,
        symbol: 'none',
        z: 1, // behind the bars and their figures
        data: [{ xAxis: noise }],
        lineStyle: { color: c.trend, type: 'dashed', width: 1.5 },
        label: { formatter: `noise ${number(noise, 3)} ${unit}`, color: c.ink, position: 'start', distance: 2 },
      };
    }
    return {
      height: 90 + rowHeight * steps.length,
      option: {
        legend: { ...legendStyle(c), top: 0, left: 0 },
        tooltip: {
          ...tooltipStyle(c),
          trigger: 'axis',
          axisPointer: { type: 'shadow' },
          valueFormatter: (value) => `${number(value, 4)} ${unit}`,
        },
        grid: { left: 10, right: 60, top: 34, bottom: noise === null ? 44 : 62, containLabel: true },
        xAxis: { ...axisStyle(c), type: 'value', min: 0, name: `rms [${unit}]`, nameLocation: 'middle', nameGap: noise === null ? 28 : 46 },
        yAxis: {
          ...axisStyle(c),
          type: 'category',
          inverse: true,
          data: steps.map((step) => step.label),
          splitLine: { show: false },
          axisLabel: { color: c.ink, fontSize: 13, width: kLabelWidth, lineHeight: kLineHeight, overflow: 'break' },
        },
        series,
      },
    };
  };
}

/** Residuals of two models over one column: {observation, unit, column, column_unit, x[], before[], after[]}. */
export function beforeAfter(picture) {
  const unit = picture.unit === 'urad' ? 'µrad' : 'µm';
  const x = `${picture.column}${picture.column_unit ? ` [${picture.column_unit}]` : ''}`;
  return el(
    'figure',
    {},
    chart(`Residual of ${picture.observation} in ${unit} against ${x}, before and after`, () => {
      const c = colours();
      const points = (name, values, color) => ({
        name,
        type: 'scatter',
        symbolSize: 4,
        data: Array.from(picture.x, (at, i) => [at, values[i]]),
        itemStyle: { color, opacity: 0.8 },
      });
      return {
        height: 280,
        option: {
          legend: { ...legendStyle(c), top: 0, right: 8 },
          tooltip: { ...tooltipStyle(c), valueFormatter: (value) => number(value, 4) },
          grid: { left: 66, right: 16, top: 30, bottom: 46 },
          xAxis: {
            ...axisStyle(c),
            type: 'value',
            scale: true,
            name: x,
            nameLocation: 'middle',
            nameGap: 28,
            splitLine: { show: false },
            axisLine: { ...axisStyle(c).axisLine, onZero: false },
          },
          yAxis: {
            ...axisStyle(c),
            type: 'value',
            name: `residual of ${picture.observation} [${unit}]`,
            nameLocation: 'middle',
            nameGap: 44,
            axisLine: { show: false, onZero: false },
          },
          series: [points('before', picture.before, c.check), points('after', picture.after, c.fit)],
        },
      };
    }),
  );
}

/** Curves over one quantity: {x: {name, unit, values}, y: [{name, unit, values, colour, style: dashed or points}], bars, log}. */
export function curves(plotted) {
  const name = (one) => `${one.name}${one.unit ? ` [${one.unit}]` : ''}`;
  return el(
    'figure',
    {},
    chart(`${[...new Set(plotted.y.map(name))].join(', ')} against ${name(plotted.x)}`, () => {
      const c = colours();
      const palette = [c.fit, c.check, c.ccw, c.cw];
      const series = plotted.y.map((one, i) => ({
        name: one.name,
        type: plotted.bars ? 'bar' : 'line',
        showSymbol: false,
        sampling: 'lttb',
        data: Array.from(plotted.x.values, (x, k) => [x, one.values[k]]),
        itemStyle: { color: palette[(one.colour ?? i) % 4] },
        lineStyle: {
          color: palette[(one.colour ?? i) % 4],
          width: one.style === 'points' ? 0 : one.style === 'dashed' ? 1 : 1.5,
          type: one.style === 'dashed' ? 'dashed' : 'solid',
        },
        ...(one.style === 'points' ? { showSymbol: true, symbol: 'circle', symbolSize: 4, sampling: undefined } : {}),
      }));
      const unit = plotted.y[0].unit ? ` [${plotted.y[0].unit}]` : '';
      return {
        height: 300,
        option: {
          legend: { ...legendStyle(c), top: 0, right: 8, data: legendEntries(plotted) },
          tooltip: { ...tooltipStyle(c), trigger: 'axis', valueFormatter: (value) => number(value, 4) },
          grid: { left: 66, right: 20, top: 34, bottom: 48 },
          xAxis: {
            ...axisStyle(c),
            type: plotted.log ? 'log' : 'value',
            scale: true,
            name: name(plotted.x),
            nameLocation: 'middle',
            nameGap: 28,
            splitLine: { show: false },
          },
          yAxis: {
            ...axisStyle(c),
            type: 'value',
            scale: true,
            axisLine: { ...axisStyle(c).axisLine, onZero: false },
            name: plotted.y.length === 1 ? name(plotted.y[0]) : `value${unit}`,
            nameLocation: 'middle',
            nameGap: 48,
          },
          series,
        },
      };
    }),
    plotted.caption ? el('figcaption', {}, plotted.caption) : null,
  );
}

// SPDX-License-Identifier: GPL-3.0-or-later
import { axisStyle, chart, colours } from './chart.js';
import { choice, el } from './dom.js';
import { number } from './data.js';

const kMostPoints = 8000; // per cell; beyond it every n-th is drawn
const kBins = 24; // of the mean that is drawn over the points
/** As it is printed: the JSON has um or urad. */
export const unitOf = (one) => (one.unit === 'urad' ? 'µrad' : 'µm');

/** Observations of each kind: {kind, unit, index: [...]}. */
export function byKind(observations) {
  const groups = observations.kind.map((kind, k) => ({ kind, unit: unitOf({ unit: observations.unit[k] }), index: [] }));
  for (let i = 0; i < observations.row.length; ++i) {
    if (Number.isFinite(observations.residual[i])) groups[observations.kind_index[i]].index.push(i);
  }
  return groups.filter((group) => group.index.length > 0);
}

/** Columns that vary, and the names of those that do not. */
function columnsOf(detail) {
  const varying = [],
    constant = [];
  detail.columns.forEach((column, i) => {
    let low = Infinity,
      high = -Infinity;
    for (const value of detail.column_data[i]) {
      if (value < low) low = value;
      if (value > high) high = value;
    }
    if (!(high > low)) constant.push(column.name);
    else varying.push({ ...column, values: detail.column_data[i], low, high });
  });
  if ((detail.runs?.length ?? 0) > 1 && !varying.some((column) => column.kind === 'run')) {
    varying.push({ name: 'run', unit: '', kind: 'run', values: detail.row_run, low: 0, high: detail.runs.length - 1, labels: detail.runs });
  }
  for (const column of varying) {
    if (column.kind === 'run') column.labels ??= detail.runs;
    const few = new Set();
    for (const value of column.values) if (few.size <= 6 && Number.isFinite(value)) few.add(value);
    column.levels = few.size <= 6 ? [...few].sort((p, q) => p - q) : null;
  }
  return { varying, constant };
}

// Points over a value that has few levels are spread a little, always in the same way.
const spread = (i) => ((i * 2654435761) % 4294967296) / 4294967296 - 0.5;

function pointsOf(column, group, detail, limit) {
  const { row, residual } = detail.observations;
  const stride = Math.max(1, Math.ceil(group.index.length / kMostPoints));
  const width = column.levels ? 0.12 * (column.high - column.low) : 0;
  const points = { fit: [], check: [] };
  for (let k = 0; k < group.index.length; k += stride) {
    const i = group.index[k];
    const x = column.values[row[i]];
    if (!Number.isFinite(x)) continue;
    const y = Math.max(-limit, Math.min(limit, residual[i]));
    (detail.row_check?.[row[i]] ? points.check : points.fit).push([x + width * spread(i), y]);
  }
  return points;
}

/** Mean residual of the fit rows in bins of the column: a guide for the eye, drawn over the points. */
function meanLine(column, group, detail) {
  const { row, residual } = detail.observations;
  const { levels } = column;
  const count = levels ? levels.length : kBins;
  const sum = new Float64Array(count),
    n = new Uint32Array(count);
  for (const i of group.index) {
    const x = column.values[row[i]];
    if (!Number.isFinite(x) || detail.row_check?.[row[i]]) continue;
    const bin = levels ? levels.indexOf(x) : Math.min(kBins - 1, Math.floor(((x - column.low) / (column.high - column.low)) * kBins));
    sum[bin] += residual[i];
    n[bin] += 1;
  }
  const at = (bin) => (levels ? levels[bin] : column.low + ((bin + 0.5) / kBins) * (column.high - column.low));
  return Array.from(sum, (total, bin) => (n[bin] ? [at(bin), total / n[bin]] : null)).filter(Boolean);
}

function cellAxis(c, cell, column) {
  const margin = column.levels ? 0.15 * (column.high - column.low) : 0;
  const labels = column.labels;
  return {
    ...axisStyle(c),
    gridIndex: cell,
    type: 'value',
    min: column.low - margin,
    max: column.high + margin,
    name: `${column.name}${column.unit ? ` [${column.unit}]` : ''}`,
    nameLocation: 'middle',
    nameGap: 20,
    splitLine: { show: false },
    splitNumber: 3,
    axisLine: { ...axisStyle(c).axisLine, onZero: false },
    axisTick: { ...axisStyle(c).axisTick, customValues: column.levels ?? undefined },
    axisLabel: {
      ...axisStyle(c).axisLabel,
      fontSize: 10,
      showMinLabel: Boolean(column.levels),
      showMaxLabel: Boolean(column.levels),
      customValues: column.levels ?? undefined,
      formatter: (value) => (labels ? (labels[value] ?? '') : number(value, 4)),
    },
  };
}

function band(group, columns, detail, limit) {
  const label = `Residual of ${group.kind} in ${group.unit} against ${columns.map((column) => column.name).join(', ')}`;
  return chart(label, (width) => {
    const c = colours();
    const left = 58,
      gap = 14,
      cellHeight = 128,
      rowHeight = cellHeight + 50;
    const across = Math.max(1, Math.min(columns.length, Math.floor((width - left) / 190)));
    const cellWidth = (width - left - 8 - gap * (across - 1)) / across;
    const option = { grid: [], xAxis: [], yAxis: [], series: [] };
    columns.forEach((column, cell) => {
      const place = cell % across,
        line = Math.floor(cell / across);
      option.grid.push({
        left: left + place * (cellWidth + gap),
        top: 8 + line * rowHeight,
        width: cellWidth,
        height: cellHeight,
        show: true,
        borderColor: c.line,
        backgroundColor: 'transparent',
      });
      option.xAxis.push(cellAxis(c, cell, column));
      option.yAxis.push({
        ...axisStyle(c),
        gridIndex: cell,
        type: 'value',
        min: -limit,
        max: limit,
        splitNumber: 4,
        interval: limit / 2,
        axisLine: { ...axisStyle(c).axisLine, onZero: false },
        axisLabel: { ...axisStyle(c).axisLabel, show: place === 0, formatter: (value) => number(value, 3) },
        name: place === 0 ? group.unit : '',
        nameLocation: 'middle',
        nameGap: 42,
        axisTick: { show: place === 0 },
      });
      const points = pointsOf(column, group, detail, limit);
      const dots = (data, color) => ({
        type: 'scatter',
        xAxisIndex: cell,
        yAxisIndex: cell,
        data,
        symbolSize: 2.2,
        silent: true,
        large: true,
        largeThreshold: 500,
        itemStyle: { color, opacity: 0.5 },
      });
      option.series.push(dots(points.check, c.check), dots(points.fit, c.fit));
      option.series.push({
        type: 'line',
        xAxisIndex: cell,
        yAxisIndex: cell,
        data: meanLine(column, group, detail),
        silent: true,
        z: 5,
        showSymbol: Boolean(column.levels),
        symbol: 'rect',
        symbolSize: [14, 3],
        itemStyle: { color: c.trend },
        lineStyle: { color: c.trend, width: 2 },
      });
    });
    return { height: Math.ceil(columns.length / across) * rowHeight + 12, option };
  });
}

function sentences(findings, kind) {
  const own = (findings ?? []).filter((one) => one.observation === kind);
  return own.length
    ? el(
        'ul',
        { class: 'note' },
        own.map((one) => el('li', {}, one.sentence)),
      )
    : null;
}

function limitOf(groups, unit, detail, scale) {
  const { row, residual } = detail.observations;
  const sizes = groups
    .filter((group) => group.unit === unit)
    .flatMap((group) => group.index)
    .filter((i) => scale !== 'fit' || !detail.row_check?.[row[i]])
    .map((i) => Math.abs(residual[i]))
    .sort((p, q) => p - q);
  const at = scale === '0.99' ? Math.floor(0.99 * sizes.length) : sizes.length - 1;
  const size = sizes[Math.max(0, Math.min(sizes.length - 1, at))] || 1;
  const digit = 10 ** Math.floor(Math.log10(size));
  return [1, 1.5, 2, 3, 4, 5, 6, 8, 10].map((step) => step * digit).find((one) => one >= size * (1 - 1e-9)) ?? 10 * digit;
}

/** Residuals of every kind of observation against every quantity, on one scale; what was found stands beside the plots. */
export function residualMatrix(detail, findings = []) {
  const groups = byKind(detail.observations);
  const { varying, constant } = columnsOf(detail);
  if (groups.length === 0 || varying.length === 0) return [el('p', {}, 'No observation to draw.')];
  const host = el('div');
  const fill = (scale) =>
    host.replaceChildren(
      ...groups.flatMap((group) =>
        [
          el(
            'h3',
            {},
            `Residual of ${group.kind}`,
            el('small', {}, ` ${group.unit}, measured − model, ${group.index.length} observations`),
          ),
          sentences(findings, group.kind),
          band(group, varying, detail, limitOf(groups, group.unit, detail, scale)),
        ].filter(Boolean),
      ),
    );
  fill('1');
  const most = Math.max(...groups.map((group) => group.index.length));
  const stride = Math.ceil(most / kMostPoints);
  return [
    el(
      'div',
      { class: 'controls' },
      choice(
        'Scale',
        [
          ['1', 'largest residual'],
          ['fit', 'largest residual of the fit rows (others at the edge)'],
          ['0.99', '99 % of the residuals (others at the edge)'],
        ],
        '1',
        fill,
      ),
      el('span', { class: 'key' }, el('i', { class: 'dot fit' }), 'fit rows'),
      el('span', { class: 'key' }, el('i', { class: 'dot check' }), 'check rows'),
      el('span', { class: 'key' }, el('i', { class: 'dash' }), `mean of the fit rows in ${kBins} bins`),
    ),
    host,
    el(
      'p',
      { class: 'note' },
      'One scale for all plots of a unit: what leans, bends or splits in a plot is what the model does not know.',
      constant.length ? ` Constant, so not drawn: ${constant.join(', ')}.` : '',
      stride > 1 ? ` Of long kinds every n-th observation is drawn (n = ${stride}).` : '',
    ),
  ];
}

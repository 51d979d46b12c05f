// SPDX-License-Identifier: GPL-3.0-or-later
import { axisStyle, chart, colours, legendStyle } from './chart.js';
import { choice, el, table } from './dom.js';
import { fixed, number } from './data.js';

// From the centre of the plot to the nominal circle, and from there outwards, in divisions.
const kInside = 5,
  kOutside = 3;
const kSteps = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];

// Of the fit rows, which decide the scale at first.
function largest(circle) {
  let most = 0;
  for (const run of circle.runs) {
    for (const values of [run.measured_um, run.model_um]) {
      (values ?? []).forEach((value, i) => {
        if (Number.isFinite(value) && !run.check?.[i]) most = Math.max(most, Math.abs(value));
      });
    }
  }
  return most;
}

/** Points [radius, angle] of those samples of a run that are (or are not) check rows, broken where samples are left out. */
function track(run, values, wantCheck, least) {
  const points = [];
  let open = false;
  for (let i = 0; i < run.angle_deg.length; ++i) {
    const wanted = Boolean(run.check?.[i]) === wantCheck && Number.isFinite(values[i]);
    if (wanted) points.push([Math.max(values[i], least), run.angle_deg[i]]);
    else if (open) points.push([NaN, NaN]);
    open = wanted;
  }
  return points;
}

function series(run, least, c) {
  const colour = run.direction > 0 ? c.ccw : c.cw;
  const line = (name, values, check, width, type, opacity, z) => {
    const data = values ? track(run, values, check, least) : [];
    if (data.length === 0) return null;
    return {
      name,
      type: 'line',
      coordinateSystem: 'polar',
      data,
      showSymbol: false,
      connectNulls: false,
      silent: true,
      z,
      itemStyle: { color: colour },
      lineStyle: { color: colour, width, type, opacity },
    };
  };
  return [
    line(`${run.label} measured`, run.measured_um, false, 1.2, 'solid', 0.75, 2),
    line(`${run.label} model`, run.model_um, false, 2.6, 'solid', 1, 4),
    line(`${run.label} check measured`, run.measured_um, true, 1, 'dotted', 0.9, 1),
    line(`${run.label} check model`, run.model_um, true, 2, 'dashed', 0.9, 3),
  ].filter(Boolean);
}

/**
 * The plot that users of a ball bar know: the deviation from the nominal circle, magnified, both senses. `more(least, colours)`:
 * further series; the chart is the figure's `plot`.
 */
export function polarPlot(circle, more = () => []) {
  const [a, b] = circle.plane;
  const most = largest(circle);
  let step = kSteps.find((one) => one * kOutside >= most) ?? kSteps[kSteps.length - 1];
  let withCheck = false;
  const magnification = (one) => number((1000 * circle.nominal_radius_mm) / (kInside * one), 3);
  const plot = chart(`Polar plot of the radial deviation in the ${a}${b} plane`, (width) => {
    const c = colours();
    const height = Math.min(640, Math.max(420, width));
    const all = circle.runs.flatMap((run) => series(run, -kInside * step, c)).filter((one) => withCheck || !one.name.includes(' check '));
    const zero = {
      name: 'nominal circle',
      type: 'line',
      coordinateSystem: 'polar',
      showSymbol: false,
      silent: true,
      z: 5,
      data: Array.from({ length: 181 }, (_, i) => [0, i * 2]),
      itemStyle: { color: c.ink },
      lineStyle: { color: c.ink, width: 1.6, type: 'dashed' },
    };
    return {
      height,
      option: {
        legend: { ...legendStyle(c), bottom: 0, data: [...all.map((one) => one.name), zero.name] },
        polar: { radius: Math.min(width, height - 70) / 2 - 34, center: ['50%', (height - 60) / 2 + 4] },
        angleAxis: {
          ...axisStyle(c),
          type: 'value',
          min: 0,
          max: 360,
          interval: 30,
          startAngle: 0,
          clockwise: false,
          axisLabel: {
            color: c.ink,
            fontSize: 12,
            hideOverlap: false,
            formatter: (deg) => ({ 0: `0° +${a}`, 90: `90° +${b}`, 180: `180° −${a}`, 270: `270° −${b}`, 360: '' })[deg] ?? `${deg}°`,
          },
        },
        radiusAxis: {
          ...axisStyle(c),
          type: 'value',
          min: -kInside * step,
          max: kOutside * step,
          interval: step,
          axisLine: { show: false },
          axisTick: { show: false },
          z: 10,
          axisLabel: {
            color: c.ink,
            fontSize: 11,
            rotate: 0,
            textBorderColor: c.panel,
            textBorderWidth: 3,
            formatter: (um) => (Math.round(um / step) % 2 !== 0 ? '' : `${um > 0 ? '+' : ''}${number(um)}`),
          },
        },
        series: [...all, zero, ...more(-kInside * step, c)],
      },
    };
  });
  const choices = kSteps.map((one) => [String(one), `${one} µm per division (${magnification(one)}×)`]);
  const hasCheck = circle.runs.some((run) => Array.from(run.check ?? []).some(Boolean));
  const controls = el(
    'div',
    { class: 'controls' },
    choice('Magnification', choices, String(step), (value) => {
      step = Number(value);
      plot.redraw();
    }),
    hasCheck
      ? choice(
          'Check rows',
          [
            ['no', 'hidden'],
            ['yes', 'shown'],
          ],
          'no',
          (value) => {
            withCheck = value === 'yes';
            plot.redraw();
          },
        )
      : null,
  );
  const figure = el(
    'figure',
    {},
    controls,
    plot,
    el(
      'figcaption',
      {},
      `Radial deviation in µm about the nominal circle of ${number(circle.nominal_radius_mm, 7)} mm ` +
        '(dashed); thin: measured, thick: model. Angles from the first axis towards the second.',
    ),
  );
  figure.plot = plot;
  return figure;
}

/** ISO 230-4 numbers of one circle. */
export function circleTable(circle) {
  const [a, b] = circle.plane;
  const runs = circle.runs;
  const row = (name, unit, text) => [name, unit, ...runs.map(text)];
  const rows = [
    row(`Centre ${a}`, 'mm', (run) => fixed(run.centre_mm?.[0], 4)),
    row(`Centre ${b}`, 'mm', (run) => fixed(run.centre_mm?.[1], 4)),
    row('Best-fit radius', 'mm', (run) => fixed(run.radius_mm, 4)),
    row('Circular deviation G', 'µm', (run) => fixed(run.circular_deviation_um, 1)),
    row('Radial deviation, max', 'µm', (run) => fixed(run.max_radial_um, 1)),
    row('   at', 'deg', (run) => fixed(run.max_radial_deg, 3)),
    row('Radial deviation, min', 'µm', (run) => fixed(run.min_radial_um, 1)),
    row('   at', 'deg', (run) => fixed(run.min_radial_deg, 3)),
    row('Feed', 'mm/min', (run) => fixed(run.feed_mm_min, 1)),
  ];
  const columns = [{ name: '', left: true }, { name: 'unit', left: true }, ...runs.map((run) => ({ name: run.label }))];
  const both = [
    ['Bidirectional circular deviation G(b)', 'µm', fixed(circle.bidirectional_um, 1)],
    ['Circular hysteresis H', 'µm', fixed(circle.hysteresis_um, 1)],
    ['   at', 'deg', fixed(circle.hysteresis_deg, 3)],
    ['Hysteresis, samples paired by angle', 'µm', fixed(circle.hysteresis_by_angle_um, 1)],
    ['   at', 'deg', fixed(circle.hysteresis_by_angle_deg, 3)],
  ].filter((one) => one[2] !== '–');
  const ranked = (circle.diagnostics ?? []).map((one) => [
    one.name,
    one.unit === 'um' ? 'µm' : one.unit === 'um/m' ? 'µm/m' : one.unit,
    fixed(one.value, one.unit === 'ms' ? 3 : 1),
    fixed(one.effect_um, 1),
    `${fixed(100 * one.share, 1)} %`,
  ]);
  return [
    table(`ISO 230-4, ${a}${b} plane, each sense about its own centre`, columns, rows),
    both.length ? table('Both senses', [{ name: '', left: true }, { name: 'unit', left: true }, { name: 'value' }], both) : null,
    ranked.length
      ? table(
          'What shapes the circle, strongest first (effect on the radius, peak to peak)',
          [{ name: '', left: true }, { name: 'unit', left: true }, { name: 'value' }, { name: 'effect, µm' }, { name: 'share' }],
          ranked,
        )
      : null,
  ].filter(Boolean);
}

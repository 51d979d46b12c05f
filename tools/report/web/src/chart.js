// SPDX-License-Identifier: GPL-3.0-or-later
import { init, use } from 'echarts/core';
import { BarChart, LineChart, ScatterChart } from 'echarts/charts';
import { GridComponent, LegendComponent, MarkLineComponent, PolarComponent, TitleComponent, TooltipComponent } from 'echarts/components';
import { CanvasRenderer, SVGRenderer } from 'echarts/renderers';
import { el, exportButtons } from './dom.js';
import { t } from './translate.js';

use([
  BarChart,
  LineChart,
  ScatterChart,
  GridComponent,
  LegendComponent,
  MarkLineComponent,
  PolarComponent,
  TitleComponent,
  TooltipComponent,
  CanvasRenderer,
  SVGRenderer,
]);

const charts = new Set();
const dark = matchMedia('(prefers-color-scheme: dark)');

/** Colours of the page as the style sheet has them now. */
export function colours() {
  const style = getComputedStyle(document.documentElement);
  const colour = (name) => style.getPropertyValue(`--${name}`).trim();
  return {
    ink: colour('ink'),
    soft: colour('soft'),
    line: colour('line'),
    panel: colour('panel'),
    fit: colour('fit'),
    check: colour('check'),
    ccw: colour('ccw'),
    cw: colour('cw'),
    trend: colour('trend'),
    accent: colour('accent'),
    accent2: colour('accent2'),
  };
}

const named = (one) => (one && typeof one === 'object' && 'name' in one ? { ...one, name: t(one.name) } : one);
/** Numbers of an axis without separators of thousands: "1,000" is one in German. */
const axisNumber = (value) => (typeof value === 'number' ? String(Number(value.toPrecision(12))).replace('-', '−') : value);
const axis = (one) => {
  const of = named(one);
  if (!of || typeof of !== 'object') return of;
  if (Array.isArray(of.data)) return { ...of, data: of.data.map((text) => t(text)) };
  const written = typeof of.axisLabel?.formatter === 'function' ? of.axisLabel.formatter : axisNumber;
  return { ...of, axisLabel: { ...of.axisLabel, formatter: (...place) => t(String(written(...place))) } };
};
const each = (list, change) => (Array.isArray(list) ? list.map(change) : list && change(list));
/** The entries of a legend are the names of series: an entry in another language belongs to no series, and is not drawn. */
const legendOf = (one) =>
  one.data ? { ...one, data: one.data.map((entry) => (typeof entry === 'string' ? t(entry) : named(entry))) } : one;
const seriesOf = (one) => {
  const of = named(one),
    label = of.markLine?.label,
    value = of.label?.formatter;
  if (typeof value === 'function') of.label = { ...of.label, formatter: (place) => t(value(place)) };
  if (typeof label?.formatter !== 'string') return of;
  return { ...of, markLine: { ...of.markLine, label: { ...label, formatter: t(label.formatter) } } };
};

/** The names of series, axes and categories, the legend and the labels of lines in the language of the report. */
function localised({ height, option }) {
  const translated = { ...option };
  for (const [key, change] of [
    ['series', seriesOf],
    ['legend', legendOf],
    ['xAxis', axis],
    ['yAxis', axis],
  ])
    if (option[key] !== undefined) translated[key] = each(option[key], change);
  return { height, option: translated };
}

/**
 * A chart in a box. `options(width)` gives {height, option} for a width in px and is asked again when the width or the
 * colours change. Drawn when it comes near the window.
 */
export function chart(label, untranslated) {
  const options = (width) => localised(untranslated(width));
  const box = el('div', { class: 'chart', role: 'img', 'aria-label': label });
  const entry = { box, options, instance: null, width: 0 };
  // Charts that a choice has replaced.
  for (const old of charts) {
    if (old.instance !== null && !old.box.isConnected) {
      old.instance.dispose();
      charts.delete(old);
    }
  }
  charts.add(entry);
  const near = new IntersectionObserver(
    (seen) => {
      if (seen.some((one) => one.isIntersecting)) {
        near.disconnect();
        draw(entry);
      }
    },
    { rootMargin: '600px' },
  );
  near.observe(box);
  const { height } = options(1000);
  box.style.height = `${height}px`;
  box.redraw = () => draw(entry, true);
  /** What the pointer of an event is at: values of a grid's axes, radius and angle of a polar plot; null before it is drawn. */
  box.valueAt = (event, system) => {
    const { left, top } = box.getBoundingClientRect();
    return entry.instance?.convertFromPixel({ [system]: 0 }, [event.clientX - left, event.clientY - top]) ?? null;
  };
  box.options = () => options(box.clientWidth || 1000);
  const stem = label.replace(/[^\w]+/g, '_');
  entry.exports = exportButtons([
    ['PNG', `${stem}.png`, () => png(entry)],
    ['SVG', `${stem}.svg`, () => new Blob([svg(entry)], { type: 'image/svg+xml' })],
    ['CSV', `${stem}.csv`, () => new Blob([csv(entry.options(1000).option)], { type: 'text/csv' })],
  ]);
  return box;
}

function png(entry) {
  draw(entry);
  const [, base64] = entry.instance.getDataURL({ pixelRatio: 2, backgroundColor: colours().panel }).split(',');
  return new Blob([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], { type: 'image/png' });
}

function svg(entry) {
  const width = entry.box.clientWidth || 1000;
  const { height, option } = entry.options(width);
  const twin = init(null, null, { renderer: 'svg', ssr: true, width, height });
  twin.setOption({ animation: false, backgroundColor: colours().panel, ...option });
  const text = twin.renderToSVGString();
  twin.dispose();
  return text;
}

const cell = (value) => {
  const text = value === null || value === undefined ? '' : String(value);
  return /[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;
};

/** The numbers of a chart: a row a point, with the names of its axes. */
function csv(option) {
  const first = (one) => [one].flat()[0] ?? {};
  const x = first(option.xAxis ?? option.angleAxis),
    y = first(option.yAxis ?? option.radiusAxis);
  const rows = [['series', x.name || 'x', y.name || 'y']];
  const categories = x.data ?? y.data;
  for (const series of [option.series ?? []].flat())
    Array.from(series.data ?? []).forEach((item, i) => {
      const value = item !== null && typeof item === 'object' && 'value' in item ? item.value : item;
      const several = Array.isArray(value) || ArrayBuffer.isView(value);
      rows.push([series.name ?? '', ...(several ? Array.from(value) : [categories?.[i] ?? i, value])]);
    });
  return `${rows.map((row) => row.map(cell).join(',')).join('\n')}\n`;
}

function draw(entry, again = false) {
  const width = entry.box.clientWidth;
  if (width === 0 || (again && entry.instance === null)) return;
  const { height, option } = entry.options(width);
  entry.width = width;
  entry.box.style.height = `${height}px`;
  if (entry.instance === null) {
    entry.instance = init(entry.box, null, { renderer: 'canvas' });
    entry.box.append(entry.exports);
  }
  entry.instance.resize({ width, height });
  entry.instance.setOption({ animation: false, backgroundColor: 'transparent', ...option }, { notMerge: true });
}

/** Draws every chart that was drawn before once more: the colours have changed. */
export function redrawCharts() {
  for (const entry of charts) if (entry.instance) draw(entry);
}

addEventListener('resize', () => {
  for (const entry of charts) if (entry.instance && entry.box.clientWidth !== entry.width) draw(entry);
});
dark.addEventListener('change', redrawCharts);

// A canvas does not flow: for paper each chart is drawn anew, no wider than A4 or Letter between their margins, in ink's colours.
const paperWidth = 640;
addEventListener('beforeprint', () => {
  document.documentElement.dataset.print = 'yes';
  for (const entry of charts) {
    if (entry.box.clientWidth > paperWidth) entry.box.style.width = `${paperWidth}px`;
    draw(entry);
  }
});
addEventListener('afterprint', () => {
  delete document.documentElement.dataset.print;
  for (const entry of charts) {
    entry.box.style.width = '';
    draw(entry);
  }
});

/** Text and lines of an axis in the page's colours. */
export function axisStyle(c) {
  return {
    axisLine: { lineStyle: { color: c.soft } },
    axisTick: { lineStyle: { color: c.soft } },
    axisLabel: { color: c.soft, fontSize: 11, hideOverlap: true },
    nameTextStyle: { color: c.ink, fontSize: 12 },
    splitLine: { lineStyle: { color: c.line } },
  };
}

export function legendStyle(c) {
  return {
    textStyle: { color: c.ink, fontSize: 12 },
    inactiveColor: c.line,
    icon: 'roundRect',
    itemWidth: 18,
    itemHeight: 6,
    type: 'plain',
  };
}

export function tooltipStyle(c) {
  return { backgroundColor: c.panel, borderColor: c.line, textStyle: { color: c.ink, fontSize: 12 }, renderMode: 'richText' };
}

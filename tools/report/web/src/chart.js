// SPDX-License-Identifier: GPL-3.0-or-later
import { init, use } from 'echarts/core';
import { BarChart, LineChart, ScatterChart } from 'echarts/charts';
import { GridComponent, LegendComponent, MarkLineComponent, PolarComponent, TitleComponent, TooltipComponent } from 'echarts/components';
import { CanvasRenderer } from 'echarts/renderers';
import { el } from './dom.js';

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

/**
 * A chart in a box. `options(width)` gives {height, option} for a width in px and is asked again when the width or the
 * colours change. Drawn when it comes near the window.
 */
export function chart(label, options) {
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
  box.options = () => options(box.clientWidth || 1000);
  box.picture = () => {
    draw(entry);
    return entry.instance.getDataURL({ pixelRatio: 2, backgroundColor: colours().panel });
  };
  return box;
}

function draw(entry, again = false) {
  const width = entry.box.clientWidth;
  if (width === 0 || (again && entry.instance === null)) return;
  const { height, option } = entry.options(width);
  entry.width = width;
  entry.box.style.height = `${height}px`;
  if (entry.instance === null) entry.instance = init(entry.box, null, { renderer: 'canvas' });
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

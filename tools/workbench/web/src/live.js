// SPDX-License-Identifier: GPL-3.0-or-later
import { axisStyle, colours, legendStyle } from '../../../report/web/src/chart.js';
import { el, tiles } from '../../../report/web/src/dom.js';
import { number } from '../../../report/web/src/data.js';
import { button, figure, panel } from './parts.js';

const kSeconds = 20;
const kHealth = ['overruns', 'skipped', 'missing_readings', 'saturated', 'slewing', 'beyond_range', 'faults'];

/** Corrections of each axis over the last seconds. */
function traces(samples) {
  const c = colours(),
    inks = [c.fit, c.check, c.ccw, c.cw, c.accent2, c.soft];
  const last = samples.at(-1) ?? { axes: {}, at_s: 0 };
  const names = Object.keys(last.axes);
  const axis = (name, nameGap) => ({ ...axisStyle(c), type: 'value', name, nameLocation: 'middle', nameGap });
  return {
    height: 230,
    option: {
      color: inks,
      legend: { ...legendStyle(c), top: 0, left: 58 },
      grid: { left: 66, right: 16, top: 30, bottom: 44 },
      xAxis: { ...axis('seconds', 26), min: -kSeconds, max: 0 },
      yAxis: {
        ...axis(`correction [${last.axes[names[0]]?.unit === 'deg' ? 'mdeg' : 'µm'}]`, 46),
        scale: true,
        axisLine: { onZero: false },
      },
      series: names.map((name) => ({
        name,
        type: 'line',
        showSymbol: false,
        lineStyle: { width: 1.6 },
        data: samples.map((one) => [one.at_s - last.at_s, 1e3 * (one.axes[name]?.correction ?? NaN)]),
      })),
    },
  };
}

/** "X of transform 2 (tool): BX*dirX": where in the chain it stands is of no use while a machine runs. */
const inShort = (effect) => effect.replace(/ of transform \d+ \(\w+\)/, '');

/** What each effect adds just now, the largest first. */
function shares(last) {
  const c = colours();
  const list = [...(last?.shares ?? [])].sort((a, b) => Math.abs(b.correction) - Math.abs(a.correction)).slice(0, 11);
  return {
    height: 230,
    option: {
      grid: { left: 8, right: 60, top: 8, bottom: 40, containLabel: true },
      xAxis: { ...axisStyle(c), type: 'value', name: 'what each effect adds [µm or mdeg]', nameLocation: 'middle', nameGap: 26 },
      yAxis: {
        ...axisStyle(c),
        type: 'category',
        inverse: true,
        axisTick: { show: false },
        data: list.map((one) => `${one.axis}  ${inShort(one.effect)}`),
        axisLabel: { color: c.soft, fontSize: 11, width: 260, overflow: 'truncate' },
      },
      series: {
        type: 'bar',
        label: { show: true, position: 'right', color: c.ink, formatter: ({ value }) => number(value, 3) },
        data: list.map((one) => ({ value: 1e3 * one.correction, itemStyle: { color: one.correction < 0 ? c.check : c.fit } })),
      },
    },
  };
}

/** What runs, since when, and how much of it arrives: no correction must not look like one. */
function runs(last) {
  if (!last.running) return last.image === 'lost' ? 'RUNS NOTHING: the confirmed image is lost' : 'runs nothing';
  const held = Object.entries(last.axes)
    .filter(([, axis]) => axis.saturated)
    .map(([name, axis]) => `${name} ${axis.limits}`);
  return `${last.running} (${last.image}) runs for ${number(last.t - last.running_since_t, 4)} s, ${number(100 * last.weight, 3)} % of the correction is active${held.length ? `; held: ${held.join('; ')}` : ''}`;
}

/** What a board does just now: corrections over time, what each effect adds, latency, faults; ten pictures a second or more. */
export function livePanel(url, getJson) {
  let running = false,
    samples = [],
    after = 0,
    drawn = [];
  const figures = el('div', { id: 'live-figures' }),
    words = el('p', { class: 'note', role: 'status', id: 'live-state' }, 'not watching');
  const lines = figure('corrections over time', () => traces(samples)),
    bars = figure('what each effect adds', () => shares(samples.at(-1)));
  const pictures = el('div', { class: 'live', hidden: '' }, lines, bars);
  function show(last) {
    pictures.hidden = false;
    const rate = drawn.length > 1 ? (drawn.length - 1) / (drawn.at(-1) - drawn[0]) : 0;
    words.textContent = `mode ${last.mode}${last.holding ? ', held' : ''}, fault ${last.fault}; ${runs(last)}; ${number(rate, 3)} pictures a second`;
    words.classList.toggle('error', last.fault !== 'none' || last.image === 'lost');
    Object.assign(words.dataset, { mode: last.mode, rate: rate.toFixed(2), tick: last.tick });
    const us = (label, value) => ({ label, value: number(value, 3), unit: 'µs' });
    figures.replaceChildren(
      tiles([
        us('latency p99', last.latency_us.p99),
        us('latency max', last.latency_us.max),
        us('tick p99', last.execution_us.p99),
        us('tick max', last.execution_us.max),
        ...kHealth.map((name) => ({ label: name.replace(/_/g, ' '), value: String(last.health[name]) })),
      ]),
    );
    for (const one of [lines, bars]) one.firstElementChild.redraw();
  }
  async function follow() {
    while (running) {
      let answer;
      try {
        answer = await getJson('/api/live', { to: url(), after });
        if (answer.error && !answer.pictures.length) throw new Error(answer.error);
      } catch (why) {
        words.textContent = `${why.message}: what is shown is old`;
        words.classList.add('error');
        figures.classList.add('stale');
        running = false;
        go.textContent = 'Watch';
        return;
      }
      // A board that says nothing new is not shown as if it were well.
      const stale = !answer.pictures.length;
      figures.classList.toggle('stale', stale);
      if (stale) {
        words.textContent = 'no news from the board: what is shown is old';
        words.classList.add('error');
        continue;
      }
      after = answer.pictures.at(-1).seq;
      const end = answer.pictures.at(-1).at_s;
      samples = [...samples, ...answer.pictures].filter((one) => end - one.at_s < kSeconds);
      drawn = [...drawn, performance.now() / 1000].slice(-40);
      if (document.body.dataset.view === 'board') show(answer.pictures.at(-1));
      await new Promise((done) => requestAnimationFrame(done));
    }
  }
  const go = button(
    'Watch',
    () => {
      running = !running;
      go.textContent = running ? 'Stop' : 'Watch';
      if (!running) return;
      samples = [];
      drawn = [];
      after = 0;
      follow();
    },
    { id: 'watch' },
  );
  return panel('Live', el('div', { class: 'controls' }, go, words), figures, pictures);
}

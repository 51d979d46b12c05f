// SPDX-License-Identifier: GPL-3.0-or-later
import { el, tiles } from '../../../report/web/src/dom.js';
import { number } from '../../../report/web/src/data.js';
import { button, panel } from './parts.js';
import { Plot, axes, range } from './plot.js';

const kSeconds = 20;
const kHealth = ['overruns', 'skipped', 'missing_readings', 'saturated', 'slewing', 'beyond_range', 'faults'];

/** Values of an axis' correction over the last seconds. */
function trace(samples, c) {
  const names = Object.keys(samples.at(-1)?.axes ?? {}),
    inks = [c.fit, c.check, c.ccw, c.cw, c.accent2, c.soft];
  const end = samples.at(-1)?.at_s ?? 0;
  return names.map((name, k) => ({
    name,
    colour: inks[k % inks.length],
    unit: samples.at(-1).axes[name].unit === 'deg' ? 'mdeg' : 'µm',
    x: samples.map((one) => one.at_s - end),
    y: samples.map((one) => 1e3 * (one.axes[name]?.correction ?? NaN)),
  }));
}

/** "X of transform 2 (tool): BX*dirX": where in the chain it stands is of no use while a machine runs. */
const inShort = (effect) => effect.replace(/ of transform \d+ \(\w+\)/, '');

/** What runs, since when, and how much of it arrives: no correction must not look like one. */
function runs(last) {
  if (!last.running) return last.image === 'lost' ? 'RUNS NOTHING: the confirmed image is lost' : 'runs nothing';
  const held = Object.entries(last.axes)
    .filter(([, axis]) => axis.saturated)
    .map(([name, axis]) => `${name} ${axis.limits}`);
  return `${last.running} (${last.image}) runs for ${number(last.t - last.running_since_t, 4)} s, ${number(100 * last.weight, 3)} % of it in${held.length ? `; held: ${held.join('; ')}` : ''}`;
}

/** What a board does just now: corrections over time, what each effect adds, latency, faults; ten pictures a second or more. */
export function livePanel(url, getJson) {
  let running = false,
    samples = [],
    after = 0,
    drawn = [];
  const figures = el('div', { id: 'live-figures' }),
    words = el('p', { class: 'note', role: 'status', id: 'live-state' }, 'not watching');
  const lines = new Plot('corrections over time', {
    height: 230,
    name: 'live_corrections',
    paint(pen, c) {
      const traces = trace(samples, c);
      const area = { x: 56, y: 18, w: pen.width - 66, h: pen.height - 50 };
      if (!traces.length) return;
      const view = { x: [-kSeconds, 0], y: range(traces.flatMap((one) => one.y).filter(Number.isFinite), 0.1) };
      axes(pen, area, view, { x: 'seconds', y: `correction [${traces[0].unit}]`, title: 'correction of each axis' }, c);
      traces.forEach((one, k) => {
        const points = [];
        one.x.forEach((x, i) =>
          points.push(
            area.x + Math.max(0, 1 + x / kSeconds) * area.w,
            area.y + area.h * (1 - (one.y[i] - view.y[0]) / (view.y[1] - view.y[0])),
          ),
        );
        pen.line(points, one.colour, 1.6);
        pen.text(area.x + area.w - 8 - 26 * (traces.length - 1 - k), 9, one.name, { colour: one.colour, bold: true, align: 'right' });
      });
    },
  });
  const shares = new Plot('what each effect adds', {
    height: 230,
    name: 'live_effects',
    paint(pen, c) {
      const list = [...(samples.at(-1)?.shares ?? [])].sort((a, b) => Math.abs(b.correction) - Math.abs(a.correction)).slice(0, 11);
      const most = Math.max(1e-9, ...list.map((one) => Math.abs(one.correction)));
      pen.text(4, 8, 'what each effect adds just now [µm or mdeg]', { colour: c.ink, bold: true });
      const middle = pen.width * 0.72,
        half = pen.width * 0.2;
      list.forEach((one, i) => {
        const y = 20 + i * 19,
          w = (half * one.correction) / most;
        pen.text(4, y + 8, `${one.axis}  ${inShort(one.effect).slice(0, Math.max(8, Math.floor((middle - half) / 6.4)))}`, {
          colour: c.soft,
        });
        pen.rect(Math.min(middle, middle + w), y, Math.abs(w), 15, one.correction < 0 ? c.check : c.fit);
        pen.text(pen.width - 4, y + 8, number(1e3 * one.correction, 3), { colour: c.ink, align: 'right' });
      });
      pen.line([middle, 18, middle, pen.height], c.line);
    },
  });
  const pictures = el('div', { class: 'live', hidden: '' }, lines.element, shares.element);
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
    lines.draw();
    shares.draw();
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

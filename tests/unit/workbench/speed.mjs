// SPDX-License-Identifier: GPL-3.0-or-later
// speed.mjs BIN SOURCE [ROWS]: how fast the workbench is with very many rows, in a headless browser. No test: it prints.
import { spawn } from 'node:child_process';
import { copyFileSync, createWriteStream, mkdtempSync, rmSync } from 'node:fs';
import { once } from 'node:events';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { Page } from './browser.mjs';

const [, , bin, source = '.', count = '100000'] = process.argv;
const folder = mkdtempSync(join(tmpdir(), 'workbench-speed-'));

let seed = 1;
const uniform = () => {
  seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
  return seed / 2 ** 32;
};
const normal = () => Math.sqrt(-2 * Math.log(1 - uniform())) * Math.cos(2 * Math.PI * uniform());

/** A survey of the bridge of tests/data/hidden with as many rows as asked for. */
async function survey() {
  const out = createWriteStream(join(folder, 'survey.csv'));
  out.write('X[mm],Y[mm],Z[mm],dirX,vX[mm/s],feed[mm/min],t[s],T_room[degC],x[mm],y[mm],z[mm],u[mm],run\n');
  for (let i = 0; i < Number(count); ++i) {
    const [X, Y, Z, v] = [600 * uniform(), 400 * uniform(), -300 * uniform(), 50 * normal()];
    out.write(
      `${X.toFixed(4)},${Y.toFixed(4)},${Z.toFixed(4)},${v < 0 ? -1 : 1},${v.toFixed(3)},${[2000, 4000, 6000][i % 3]},${(0.3 * i).toFixed(2)},${(20 + 2 * Math.sin(i / 9e3)).toFixed(3)},` +
        `${(X + 20 + 1e-3 * normal()).toFixed(6)},${(Y - 30 + 1e-3 * normal()).toFixed(6)},${(Z - 120 + 1e-3 * normal() + 3e-5 * v).toFixed(6)},0.001,s${i % 4}\n`,
    );
  }
  out.end();
  await once(out, 'finish');
}

const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];
const say = (what, ms) => console.log(`${what.padEnd(64)} ${ms.toFixed(1)} ms`);

async function measure(page, url) {
  const from = performance.now();
  await page.go(url);
  await page.until("document.body.dataset.view === 'project'", 'the frame');
  say('address opened to the frame of the page', performance.now() - from);
  await page.until("document.body.dataset.ready === 'yes'", 'the rows');
  say('... to all rows loaded', performance.now() - from);
  await page.evaluate("location.hash = '#compare'");
  await page.until("document.getElementById('compare-figures')", 'the numbers', 300);
  await page.evaluate("document.querySelector('.matrix canvas').scrollIntoView({ block: 'center' })");
  await new Promise((done) => setTimeout(done, 800));
  const [x, y, w, h] = await page.evaluate(
    "(() => { const b = document.querySelector('.matrix canvas').getBoundingClientRect(); return [b.left, b.top, b.width, b.height]; })()",
  );
  const chosen = [];
  for (let i = 0; i < 6; ++i) {
    await page.drag([x + 60 + 10 * i, y + 20], [x + 0.5 * w, y + h - 34]);
    await new Promise((done) => setTimeout(done, 1200));
    chosen.push(Number(await page.evaluate('document.body.dataset.redrawMs')));
  }
  say('rows chosen to all plots in sight redrawn, median of 6', median(chosen));
  const keys = (selector, key) =>
    page.evaluate(`(() => { const c = document.querySelector('${selector}'), from = performance.now();
    for (let i = 0; i < 20; ++i) c.dispatchEvent(new KeyboardEvent('keydown', { key: '${key}' })); return (performance.now() - from) / 20; })()`);
  say('one plot moved', await keys('.matrix canvas', 'ArrowLeft'));
  say('vectors turned', await keys('canvas[aria-label^="Residual vectors"]', 'ArrowLeft'));
  await page.evaluate("location.hash = '#add'");
  await page.until("document.getElementById('parameter').options.length > 0", 'the parameters');
  const moved = [];
  for (let i = 1; i <= 5; ++i) {
    await page.evaluate(
      `(() => { delete document.getElementById('slider-figures').dataset.ms; const s = document.getElementById('slider'); s.value = '${0.1 * i}'; s.dispatchEvent(new Event('input')); })()`,
    );
    await page.until("document.getElementById('slider-figures').dataset.ms", 'the prediction');
    moved.push(Number(await page.evaluate("document.getElementById('slider-figures').dataset.ms")));
  }
  say('slider moved to the new residual on the page, median of 5', median(moved));
}

await survey();
copyFileSync(join(source, 'tests/data/hidden/bridge_lag_cyclic/model.xml'), join(folder, 'model.xml'));
const from = performance.now();
const server = spawn(join(bin, 'vernier'), ['workbench', folder, '--no-browser', '--json', '-'], { stdio: ['ignore', 'pipe', 'ignore'] });
let text = '';
for await (const piece of server.stdout) {
  text += piece;
  if (text.includes('}')) break;
}
say('command to serving', performance.now() - from);
const page = await Page.open();
try {
  await measure(page, JSON.parse(text).url);
} finally {
  await page.close();
  server.kill();
  rmSync(folder, { recursive: true, force: true });
}

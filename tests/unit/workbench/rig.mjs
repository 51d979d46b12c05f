// SPDX-License-Identifier: GPL-3.0-or-later
// What the journeys share: WHICH BIN SOURCE [PICTURES] of the command line, a project with its workbench, a board, and a page.
import { execFileSync, spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import assert from 'node:assert/strict';
import { browserName, Page } from './browser.mjs';

const [, , which, bin, source, pictures] = process.argv;
const vernier = join(bin, 'vernier');
const top = mkdtempSync(join(tmpdir(), 'workbench-journey-'));
const folder = join(top, 'project');
const started = [];

const json = (...words) =>
  JSON.parse(execFileSync(vernier, [...words, '--json', '-'], { cwd: folder, stdio: ['ignore', 'pipe', 'ignore'], maxBuffer: 1 << 28 }));
const data = (name) => readFileSync(join(source, 'tests/data', name), 'latin1');
const freePort = () =>
  new Promise((done) => {
    const server = createServer().listen(0, '127.0.0.1', () => {
      const { port } = server.address();
      server.close(() => done(port));
    });
  });

/** A program that runs until the end of the test. */
function start(name, words, options = {}) {
  const child = spawn(join(bin, name), words, { stdio: ['ignore', 'pipe', 'inherit'], ...options });
  started.push(child);
  return child;
}

async function workbench() {
  const child = start('vernier', ['workbench', folder, '--no-browser', '--json', '-']);
  let text = '';
  for await (const piece of child.stdout) {
    text += piece;
    if (text.includes('}')) break;
  }
  return JSON.parse(text).url;
}

/** A board of the machine's axes, all simulated, which trusts the key of the project. */
async function board(axes, keys) {
  const port = await freePort();
  const axis = ([name, low, high]) =>
    `[axis.${name}]\nlow = ${low}\nhigh = ${high}\nmax_speed = 500\nmax_acceleration = 5000\ncorrection_share = 0.05\nposition = { kind = "sim" }\noutput = { kind = "sim" }\n`;
  writeFileSync(
    join(top, 'board.toml'),
    `[board]\nname = "journey"\nstore = "store"\npublic_key = "${join(folder, keys, 'vernier.pub')}"\ntrial_s = 60\nactivate = true\nmax_lost_ticks = 0.9\n${axes.map(axis).join('')}[[link]]\nkind = "modbus-tcp"\nport = ${port}\n`,
  );
  start('vernierd', ['--board', join(top, 'board.toml')], { cwd: top, stdio: 'ignore' });
  const url = `tcp://127.0.0.1:${port}`;
  for (let i = 0; ; ++i) {
    try {
      execFileSync(vernier, ['status', '--to', url], { stdio: 'ignore' });
      return url;
    } catch (why) {
      if (i > 100) throw why;
    }
    await new Promise((done) => setTimeout(done, 50));
  }
}

const text = (page, selector) => page.evaluate(`document.querySelector(${JSON.stringify(selector)})?.textContent ?? ''`);
const attribute = (page, selector, name) =>
  page.evaluate(`document.querySelector(${JSON.stringify(selector)})?.dataset[${JSON.stringify(name)}] ?? null`);
const view = (page, name) => page.evaluate(`location.hash = '#${name}'`);
const done = (page, command) =>
  page.until(
    `document.getElementById('command').textContent.startsWith(${JSON.stringify(command)}) && document.getElementById('job-state').dataset.state === 'done'`,
    command,
    120,
  );
async function picture(page, name, scroll = null) {
  if (!pictures) return;
  if (scroll)
    await page.evaluate(
      `document.querySelector(${JSON.stringify(scroll)}).closest('.panel').scrollIntoView({ block: 'start' }); scrollBy(0, -54)`,
    );
  await new Promise((wait) => setTimeout(wait, 400));
  await page.picture(join(pictures, `workbench_${name}.png`));
}
const near = (shown, wanted, what) =>
  assert.ok(
    Math.abs(Number(shown) - wanted) <= 1e-9 * Math.max(1, Math.abs(wanted)),
    `${what}: the page has ${shown}, the command ${wanted}`,
  );

/** Runs the journey of the command line's name; `expected` complaints of the page are no failure of it. */
export async function journey(all, expected = {}) {
  try {
    if (browserName() === null) {
      console.log('journey: Skipped, no headless browser');
      return;
    }
    execFileSync('mkdir', [folder]);
    const url = await workbench();
    const page = await Page.open();
    try {
      await page.go(url);
      await page.until("document.body.dataset.ready === 'yes'", 'the page');
      await all[which](page);
      assert.deepEqual(
        page.complaints.filter((one) => !expected[which]?.test(one)),
        [],
      );
      console.log(`journey: ${which} is as it should be`);
    } finally {
      await page.close();
    }
  } catch (why) {
    console.error(`journey: ${which} fails: ${why.stack}`);
    process.exitCode = 1;
  } finally {
    for (const child of started) child.kill('SIGTERM');
    await Promise.all(
      started.map((child) => child.exitCode !== null || child.signalCode !== null || new Promise((gone) => child.on('exit', gone))),
    );
    rmSync(top, { recursive: true, force: true, maxRetries: 20 });
  }
}

export { attribute, bin, board, data, done, folder, json, near, picture, pictures, source, started, text, top, vernier, view };

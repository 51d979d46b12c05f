#!/usr/bin/env node
// SPDX-License-Identifier: GPL-3.0-or-later
// screen_test.mjs PAGE PICTURES HEADLINE: on a screen of 1100 pixels no figure of the candidates is behind a scroll bar, a cause has at
// most two lines, no tile of a simulation is empty, and the page has so many pictures of residuals and this headline. Skipped
// without a browser.
import { pathToFileURL } from 'node:url';
import assert from 'node:assert/strict';
import { Page, browserName } from '../workbench/browser.mjs';

if (browserName() === null) {
  console.log('screen_test: Skipped, no headless browser');
  process.exit(0);
}
const [file, pictures, headline] = process.argv.slice(2);
const page = await Page.open({ width: 1100, height: 720 });
try {
  await page.go(pathToFileURL(file).href);
  await page.until("document.documentElement.dataset.ready === 'yes'", 'the page');
  const hidden = await page.evaluate(
    "[...document.querySelectorAll('.whole')].map((one) => [one.scrollWidth - one.clientWidth, one.scrollHeight - one.clientHeight])",
  );
  assert.ok(hidden.length > 0, 'the page has a table of candidates');
  for (const beyond of hidden) assert.ok(Math.max(...beyond) <= 1, `px behind a scroll bar: ${beyond}`);
  const lines = await page.evaluate(
    "[...document.querySelectorAll('.whole td:first-child')].map((one) => one.clientHeight / parseFloat(getComputedStyle(one).lineHeight))",
  );
  assert.ok(lines.length > 0 && Math.max(...lines) < 2.9, `lines of a cause: ${lines}`);
  assert.equal(await page.evaluate("document.querySelectorAll('.pictures .chart').length"), Number(pictures));
  const empty = await page.evaluate(
    "[...document.querySelectorAll('.tile')].filter((one) => one.querySelector('dd').textContent === '–').map((one) => one.textContent)",
  );
  assert.deepEqual(empty, []);
  const said = await page.evaluate("document.querySelector('.verdict').textContent");
  assert.ok(said.startsWith(headline), said);
  assert.deepEqual(page.complaints, []);
  console.log(`screen_test: ${pictures} pictures, "${said}"`);
} finally {
  await page.close();
}

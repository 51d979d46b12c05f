#!/usr/bin/env node
// SPDX-License-Identifier: GPL-3.0-or-later
// save_test.mjs PAGE: each chart of a page gives itself as SVG and its numbers as CSV. Skipped without a browser.
import { pathToFileURL } from 'node:url';
import assert from 'node:assert/strict';
import { Page, browserName } from '../workbench/browser.mjs';

if (browserName() === null) {
  console.log('save_test: Skipped, no headless browser');
  process.exit(0);
}
const page = await Page.open({ width: 1280, height: 720 });
try {
  await page.go(pathToFileURL(process.argv[2]).href);
  await page.until("document.documentElement.dataset.ready === 'yes'", 'the page');
  await page.evaluate(
    '(() => { const make = URL.createObjectURL; URL.createObjectURL = (blob) => { window.saved = blob; return make.call(URL, blob); }; })()',
  );
  const count = await page.evaluate("document.querySelectorAll('.chart').length");
  assert.ok(count > 0, 'the page has charts');
  for (let k = 0; k < count; ++k) {
    await page.evaluate(`document.querySelectorAll('.chart')[${k}].scrollIntoView({ block: 'center' })`);
    await page.until(`document.querySelectorAll('.chart')[${k}].querySelector('.exports')`, `chart ${k} to be drawn`);
    const saved = async (label) => {
      await page.evaluate('window.saved = null');
      await page.evaluate(
        `[...document.querySelectorAll('.chart')[${k}].querySelectorAll('.exports button')].find((one) => one.textContent === '${label}').click()`,
      );
      await page.until('window.saved', `${label} of chart ${k}`);
      return page.evaluate('window.saved.text()');
    };
    const svg = await saved('SVG');
    assert.ok(svg.startsWith('<svg') && svg.trimEnd().endsWith('</svg>'), `chart ${k}: ${svg.slice(0, 80)}`);
    const lines = (await saved('CSV')).trim().split('\n');
    assert.ok(lines[0].startsWith('series,') && lines.length > 2, `chart ${k}: ${lines.slice(0, 3)}`);
    const numbers = lines.slice(1).flatMap((line) => line.match(/-?\d+(\.\d+)?(e-?\d+)?/g) ?? []);
    assert.ok(numbers.length >= lines.length - 1, `chart ${k}: numbers in each line`);
  }
  assert.deepEqual(page.complaints, []);
  console.log(`save_test: ${count} charts can be saved`);
} finally {
  await page.close();
}

#!/usr/bin/env node
// SPDX-License-Identifier: GPL-3.0-or-later
// print_test.mjs PAGE: on paper (A4, and Letter) nothing of a page reaches beyond the sheet: no chart, no table, no text; nothing is
// folded away, and from a dark screen comes ink on white. Skipped without a browser.
import { pathToFileURL } from 'node:url';
import { Page, browserName } from '../workbench/browser.mjs';

if (browserName() === null) {
  console.log('print_test: Skipped, no headless browser');
  process.exit(0);
}
const page = await Page.open({ width: 1280, height: 720, dark: true });
let failed = 0;
try {
  await page.send('Page.navigate', { url: pathToFileURL(process.argv[2]).href });
  const value = async (expression) =>
    (await page.send('Runtime.evaluate', { expression, returnByValue: true, awaitPromise: true })).result.value;
  for (let tries = 0; tries < 100 && !(await value("document.documentElement.dataset.ready === 'yes'")); ++tries)
    await new Promise((done) => setTimeout(done, 100));
  const charts = await value("document.querySelectorAll('.chart').length");
  for (const [name, millimetres] of [
    ['A4', 210 - 24],
    ['Letter', 215.9 - 24],
  ]) {
    // As the browser does it: the event first, then the layout of the sheet.
    await value("dispatchEvent(new Event('beforeprint'))");
    await page.send('Emulation.setEmulatedMedia', { media: 'print' });
    const width = Math.floor((millimetres * 96) / 25.4);
    await page.send('Emulation.setDeviceMetricsOverride', { width, height: 1000, deviceScaleFactor: 1, mobile: false });
    const beyond = await value(`[...document.querySelectorAll('main *')]
      .filter((one) => one.getBoundingClientRect().width > 0 && one.getBoundingClientRect().right > ${width} + 1)
      .map((one) => one.tagName + '.' + one.className).slice(0, 5).join(', ')`);
    const cut = await value(`[...document.querySelectorAll('.scroll')]
      .filter((one) => one.scrollHeight > one.clientHeight + 1 || one.scrollWidth > one.clientWidth + 1).length`);
    const folded = await value("document.querySelectorAll('details:not([open])').length");
    const ink = await value('getComputedStyle(document.body).backgroundColor');
    if (beyond || cut || folded || ink !== 'rgb(255, 255, 255)') {
      failed = 1;
      console.log(`print_test: ${name}: beyond the sheet: ${beyond || 'nothing'}; tables cut: ${cut}; folded: ${folded}; paper ${ink}`);
    }
    await value("dispatchEvent(new Event('afterprint'))");
    await page.send('Emulation.setEmulatedMedia', { media: '' });
    await page.send('Emulation.setDeviceMetricsOverride', { width: 1280, height: 720, deviceScaleFactor: 1, mobile: false });
  }
  if (!failed) console.log(`print_test: nothing cut on A4 and Letter, ${charts} charts`);
} finally {
  await page.close();
}
process.exit(failed);

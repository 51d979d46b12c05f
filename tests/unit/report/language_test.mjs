#!/usr/bin/env node
// SPDX-License-Identifier: GPL-3.0-or-later
// language_test.mjs PAGE LANGUAGE [TEXT…]: the page states its language; in German no English sentence is left and numbers have a
// comma; of another language the texts are there. Skipped without a browser.
import { pathToFileURL } from 'node:url';
import { Page, browserName } from '../workbench/browser.mjs';
import { faultsOf, kTextsOfPage } from './english_words.mjs';

if (browserName() === null) {
  console.log('language_test: Skipped, no headless browser');
  process.exit(0);
}
const [, , path, language, ...wanted] = process.argv;
const kEnglish = /\b(the|of|is|are|with|what|which|and|by|not|from|over|against|forward|backward|mean|value|rows|error)\b/i;
const page = await Page.open({ width: 1280, height: 720 });
const faults = [];
try {
  await page.send('Page.navigate', { url: pathToFileURL(path).href });
  const value = async (expression) =>
    (await page.send('Runtime.evaluate', { expression, returnByValue: true, awaitPromise: true })).result.value;
  for (let tries = 0; tries < 100 && !(await value("document.documentElement.dataset.ready === 'yes'")); ++tries)
    await new Promise((done) => setTimeout(done, 100));
  const texts = await value(`(() => {
    const found = [document.title];
    const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT,
      (node) => node.parentElement.closest('script, style, noscript, code') ? NodeFilter.FILTER_REJECT : NodeFilter.FILTER_ACCEPT);
    while (walk.nextNode()) if (walk.currentNode.textContent.trim()) found.push(walk.currentNode.textContent.trim());
    for (const node of document.querySelectorAll('[title], [aria-label]'))
      for (const name of ['title', 'aria-label']) if (node.getAttribute(name)) found.push(node.getAttribute(name));
    return found;
  })()`);
  if ((await value('document.documentElement.lang')) !== language) faults.push(`lang is not ${language}`);
  if (texts.length < 50) faults.push(`the page has ${texts.length} texts only`);
  for (const one of wanted) if (!texts.includes(one)) faults.push(`'${one}' is not on the page`);
  if (language === 'de') {
    for (const one of new Set(texts)) if (kEnglish.test(one)) faults.push(`English: ${one}`);
    for (const [one, found] of faultsOf(await value(kTextsOfPage))) faults.push(`English (${found.join(', ')}): ${one}`);
    // An entry of a legend that is no name of a series is not drawn.
    const lost = await value(`[...document.querySelectorAll('.chart')].flatMap((chart) => {
      const { option } = chart.options();
      const names = new Set([option.series].flat().map((one) => one.name));
      return (option.legend?.data ?? []).map((one) => one.name ?? one).filter((name) => !names.has(name));
    })`);
    for (const one of lost) faults.push(`no series of the legend's entry: ${one}`);
    if (path.endsWith('positioning.html') && !texts.some((one) => /^[−-]?\d+,\d+$/.test(one))) faults.push('no number has a comma');
    for (const one of new Set(texts)) if (/^[−-]?\d+\.\d+( [%°µ]m?)?$/.test(one)) faults.push(`point: ${one}`);
    // Of an axis in values: no separator of thousands, which is the decimal sign of the reader.
    const labels = await value(`[...document.querySelectorAll('.chart')].flatMap((chart) => {
      const { option } = chart.options();
      return [option.xAxis, option.yAxis].flat().filter((axis) => axis && axis.type !== 'category' && !axis.data)
        .map((axis) => [2500, 2.5].map((at) => axis.axisLabel?.formatter?.(at, 0) ?? 'its own').join(' '));
    })`);
    if (path.endsWith('positioning.html') && !labels.includes('2500 2,5')) faults.push(`labels of the axes: ${labels}`);
    for (const one of labels) if (/its own|\d\.\d|\d,\d{3}/.test(one)) faults.push(`label of an axis: ${one}`);
  }
} finally {
  await page.close();
}
for (const fault of faults) console.log(`language_test: ${fault}`);
process.exit(faults.length ? 1 : 0);

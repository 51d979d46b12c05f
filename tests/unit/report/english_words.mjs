// SPDX-License-Identifier: GPL-3.0-or-later
// english_words.mjs [PAGE…]: the English words that are visible on German pages, one line a text. A word is English if the English side
// of the catalogue (tools/report/languages/de.json) has the word and the German side has not, or if the word is usual in reports and no
// German word.
import { readFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';
import { Page } from '../workbench/browser.mjs';

const kLetters = /\p{L}+/gu;
/** English words that no German text has, also where the catalogue lacks the text. */
const kUsual =
  'the of is are with what which and by not from over against forward backward mean value rows row error errors noise rms visit customer reading readings without after before change changes drift step steps file files axis axes none all both each has have no only than that this these when where fit check'.split(
    ' ',
  );
/** Paths and names of a machine file or a measurement are no words: T_room, moving-bridge, data/survey.csv, payload. */
const kName = /\S*[_/]\S*|\bmoving-bridge\b|\b(payload|clamp|base)\b|\bvernier [a-z]+/g;
const words = (text) => text.replace(kName, ' ').match(kLetters) ?? [];

export function englishWords() {
  const { texts } = JSON.parse(readFileSync(new URL('../../../tools/report/languages/de.json', import.meta.url), 'utf8'));
  const german = new Set(Object.values(texts).flatMap((text) => text.match(kLetters) ?? []));
  const small = new Set([...german].map((one) => one.toLowerCase()));
  const english = new Set([...Object.keys(texts).flatMap(words), ...kUsual].map((one) => one.toLowerCase()));
  return new Set([...english].filter((one) => one.length > 2 && !small.has(one)));
}

/** All texts of a page: elements, titles, and the words in its charts. */
export const kTextsOfPage = `(() => {
  const found = [document.title];
  const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT,
    (node) => node.parentElement.closest('script, style, noscript, code') ? NodeFilter.FILTER_REJECT : NodeFilter.FILTER_ACCEPT);
  while (walk.nextNode()) if (walk.currentNode.textContent.trim()) found.push(walk.currentNode.textContent.trim());
  for (const node of document.querySelectorAll('[title], [aria-label]'))
    for (const name of ['title', 'aria-label']) if (node.getAttribute(name)) found.push(node.getAttribute(name));
  const each = (one, then) => [one].flat().filter(Boolean).forEach(then);
  for (const box of document.querySelectorAll('.chart')) {
    const { option } = box.options();
    for (const key of ['xAxis', 'yAxis', 'radiusAxis', 'angleAxis', 'visualMap'])
      each(option[key], (axis) => {
        if (axis.name) found.push(axis.name);
        each(axis.text, (text) => found.push(text));
        if (axis.type === 'category') each(axis.data, (text) => found.push(String(text.value ?? text)));
      });
    each(option.series, (series) => {
      if (series.name) found.push(series.name);
      const label = series.markLine?.label?.formatter;
      if (typeof label === 'string') found.push(label);
      each(series.markLine?.data, (line) => typeof line.name === 'string' && found.push(line.name));
    });
  }
  return [...new Set(found)];
})()`;

/** The texts with an English word, each with its English words. */
export function faultsOf(texts, english = englishWords()) {
  return texts.map((text) => [text, words(text).filter((one) => english.has(one.toLowerCase()))]).filter(([, found]) => found.length > 0);
}

if (process.argv[1]?.endsWith('english_words.mjs')) {
  for (const path of process.argv.slice(2)) {
    const page = await Page.open({ width: 1280, height: 720 });
    try {
      await page.send('Page.navigate', { url: pathToFileURL(path).href });
      for (let tries = 0; tries < 100; ++tries) {
        const ready = await page.send('Runtime.evaluate', {
          expression: "document.documentElement.dataset.ready === 'yes'",
          returnByValue: true,
        });
        if (ready.result.value) break;
        await new Promise((done) => setTimeout(done, 100));
      }
      const { result } = await page.send('Runtime.evaluate', { expression: kTextsOfPage, returnByValue: true });
      for (const [text, found] of faultsOf(result.value)) console.log(`${path.replace(/.*\//, '')}: ${found.join(' ')}: ${text}`);
    } finally {
      await page.close();
    }
  }
}

// SPDX-License-Identifier: GPL-3.0-or-later
// What `vernier lint` says of the chosen machine and rows: before a fit, where the files can still be read in another way.
import { el } from '../../../report/web/src/dom.js';
import { getJson, Refused } from './api.js';
import { panel, programWords } from './parts.js';
import { on, store } from './store.js';

/** Findings in sight at once; a file may have as many as it has columns. */
const kAtOnce = 8;
const kOrder = ['error', 'warning', 'remark'];

const place = (one) => `${one.file}${one.line ? `, line ${one.line}` : ''}${one.word ? `, "${one.word}"` : ''}`;

/** The words of the page for what names an option of the command line. */
const words = (said) =>
  programWords(said)
    .replace(
      /vernier import table \S+ --deviation \S+ … adds/,
      'under Project, "read differently" beside the file with "deviation of" adds',
    )
    .replace(/ \(vernier set --artefact ([^,)]+),/, ' (make a new machine file with $1 in the field "artefact",')
    .replace(/ \(--fix\)/, ' (the field "fix" of the options of fit)');

const item = (one) =>
  el(
    'li',
    { 'data-weight': one.weight, 'data-word': one.word },
    `${place(one)}: ${words(one.what)}`,
    one.meaning ? el('small', {}, ` – ${words(one.meaning)}`) : null,
  );

/** Nothing is said of files without a finding. */
export function lintPanel() {
  const list = el('ul', { class: 'findings' }),
    more = el('ul', { class: 'findings' }),
    rest = el('details', {}, el('summary', {}, 'more'), more);
  const box = panel('What a check of the files says', list, rest);
  box.id = 'lint';
  box.hidden = true;
  let asking = 0;
  on('rows', async () => {
    const mine = ++asking;
    box.hidden = true;
    if (!store.rows) return; // rows that cannot be read have a panel of their own
    let findings = [];
    try {
      ({ findings } = await getJson('/api/lint', { machine: store.machine, measurement: store.measurements }));
    } catch (why) {
      if (!(why instanceof Refused)) throw why; // a file that cannot be read says so elsewhere
    }
    if (mine !== asking || !findings.length) return;
    const order = findings.sort((a, b) => kOrder.indexOf(a.weight) - kOrder.indexOf(b.weight));
    list.replaceChildren(...order.slice(0, kAtOnce).map(item));
    more.replaceChildren(...order.slice(kAtOnce).map(item));
    rest.hidden = order.length <= kAtOnce;
    box.hidden = false;
  });
  return box;
}

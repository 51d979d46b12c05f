// SPDX-License-Identifier: GPL-3.0-or-later
import { el } from '../../../report/web/src/dom.js';
import { number, printed } from '../../../report/web/src/data.js';
import { getJson } from './api.js';
import { guarded, pageWords, panel } from './parts.js';
import { emit, on, store } from './store.js';

/** The rules in words for the person at the machine (tools/docs/safety.md has their reasons). */
const kAsks = {
  correction: 'Is the largest correction small beside the machine?',
  'max-correction': "Does it stay within each axis' limit?",
  cancellation: 'Are there no large terms that cancel one another?',
  uncertainty: 'Is the correction known well enough?',
  'measured-range': 'Was it measured where it works?',
  'input-range': 'Were temperatures and inputs in that range?',
  'set-up': 'Is the set-up of the instrument kept out of the axes?',
  converged: 'Did the fit converge?',
  residual: 'Is little left of the readings?',
  outlier: 'Does no single reading stand apart?',
  'check-rows': 'Do held-out rows confirm the model?',
  disturbed: 'Was the instrument undisturbed?',
};

const answer = (one) => (one.value === null ? 'not known' : one.ok ? 'yes' : one.accepted ? 'accepted' : 'NO');

function safetyTable(rules) {
  const head = ['', 'value', 'limit', '', 'most by', ''];
  return el(
    'div',
    { class: 'scroll' },
    el(
      'table',
      { id: 'safety' },
      el(
        'thead',
        {},
        el(
          'tr',
          {},
          head.map((name, i) => el('th', { class: i === 1 || i === 2 ? 'num' : 'text' }, name)),
        ),
      ),
      el(
        'tbody',
        {},
        rules.map((one) =>
          el(
            'tr',
            { class: one.ok || one.value === null ? null : 'fails', 'data-rule': one.rule, title: one.reason },
            el('td', { class: 'text' }, `${kAsks[one.rule] ?? one.rule} `, el('small', {}, one.rule)),
            el('td', { class: 'num' }, one.value === null ? '–' : number(one.value, 3)),
            el('td', { class: 'num' }, number(one.limit, 3)),
            el('td', { class: 'text' }, printed(one.unit)),
            el('td', { class: 'text' }, printed(one.culprit)),
            el('td', { class: 'text answer' }, answer(one)),
          ),
        ),
      ),
    ),
  );
}

const kWhyUnknown = {
  'check-rows': 'the fit had no check rows (column role)',
  'max-correction': 'no axis has a limit (maxcorrection)',
};

/** Why rules have no value: no fit wrote the file, else what the fit did not have. */
function reasonOf(unknown) {
  if (unknown.includes('converged')) return 'no fit wrote this file.';
  return `${unknown.map((rule) => kWhyUnknown[rule] ?? rule).join(', ')}.`;
}

/** The sheet of the machine that is chosen, before anything is compiled; looked at whenever this view is. */
export function safetyPanel() {
  const box = el('div', { class: 'safety-room' }),
    error = el('div', {}),
    words = el('p', { id: 'safety-words', class: 'verdict' });
  async function look() {
    if (!store.machine) {
      words.textContent = '';
      box.replaceChildren(el('p', { class: 'note' }, 'Choose a machine above.'));
      return;
    }
    const asked = store.machine;
    const sheet = await guarded(error, () => getJson('/api/safety', { machine: asked }));
    if (asked !== store.machine) return;
    store.safety = sheet;
    emit('safety');
    const unknown = (sheet?.rules ?? []).filter((one) => one.value === null).map((one) => one.rule);
    const holds = unknown.length
      ? `What is known holds; ${unknown.length} of ${sheet.rules.length} rules cannot be evaluated: ${reasonOf(unknown)}`
      : 'Every rule holds.';
    const refusal = sheet ? pageWords(sheet.refusal, 'vernier compile') : '';
    // The heading is the rule that does not hold; what to do about it is a text below the heading.
    const [rule, ...remedy] = (sheet ? (sheet.ok ? holds : refusal.replace(/^n/, 'N')) : '').split(/(?<=;) /);
    words.replaceChildren(rule, ...(remedy.length ? [' ', el('span', { class: 'remedy' }, remedy.join(' '))] : []));
    words.classList.toggle('error', Boolean(sheet) && !sheet.ok);
    words.dataset.ok = sheet ? sheet.ok : '';
    box.replaceChildren(...(sheet ? [safetyTable(sheet.rules)] : []));
  }
  on('rows', () => {
    store.safety = null;
    if (document.body.dataset.view === 'board') look();
  });
  return { element: panel('Safe to run?', words, box, error), look };
}

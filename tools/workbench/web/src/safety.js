// SPDX-License-Identifier: GPL-3.0-or-later
import { el } from '../../../report/web/src/dom.js';
import { number, printed } from '../../../report/web/src/data.js';
import { freeName, getJson, run } from './api.js';
import { button, guarded, kMeasuredTravel, pageWords, panel } from './parts.js';
import { choose } from './rows.js';
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

/** Why a machine is not safe to run: [the rule that does not hold, what to do about it]; empty words: it is, or is not known. */
export function refusedRule(sheet) {
  const refusal = sheet && !sheet.ok ? pageWords(sheet.refusal, 'vernier compile') : '';
  const [rule, ...remedy] = refusal.replace(/^n/, 'N').split(/(?<=;) /);
  return [rule, remedy.join(' ')];
}

/** A new machine file that works only where it was measured; null: it does, or the rule is accepted. */
function measuredTravel(rules, error) {
  const rule = rules.find((one) => one.rule === 'measured-range');
  if (!rule || rule.value === null || rule.ok || rule.accepted) return null;
  const reduce = () =>
    guarded(error, async () => {
      const output = freeName(`${store.machine.replace(/\.[^.]*$/, '')}-travel`, '.xml');
      await run({ command: 'set', machine: store.machine, 'measured-travel': true, output });
      await choose(output, store.measurements);
    });
  return el('div', { class: 'controls' }, button(kMeasuredTravel, reduce, { class: 'quiet', id: 'measured-travel' }));
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
    // The heading is the rule that does not hold; what to do about it is a text below the heading.
    const [rule, remedy] = refusedRule(sheet);
    words.replaceChildren(sheet?.ok ? holds : rule, ...(remedy ? [' ', el('span', { class: 'remedy' }, remedy)] : []));
    words.classList.toggle('error', Boolean(sheet) && !sheet.ok);
    words.dataset.ok = sheet ? sheet.ok : '';
    box.replaceChildren(...(sheet ? [measuredTravel(sheet.rules, error), safetyTable(sheet.rules)].filter(Boolean) : []));
  }
  on('rows', () => {
    store.safety = null;
    if (document.body.dataset.view === 'board') look();
  });
  return { element: panel('Safe to run?', words, box, error), look };
}

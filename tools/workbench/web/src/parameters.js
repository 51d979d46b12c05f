// SPDX-License-Identifier: GPL-3.0-or-later
import { el } from '../../../report/web/src/dom.js';
import { number } from '../../../report/web/src/data.js';
import { getJson } from './api.js';
import { panel } from './parts.js';
import { emit, on, store } from './store.js';

const kFrom = {
  data: ['measured', 'the readings determine it'],
  convention: ['not determined', 'part of a combination that the readings do not determine: set to the value nearest nominal'],
  combination: [
    'measured in a combination',
    'the readings determine the value, beside a small part that is set to the value nearest nominal',
  ],
  prior: ['not measured', 'nominal, give or take what is plausible'],
};
const kShown = 500;

/** What a parameter rests on. A parameter of a combination whose value is far above its uncertainty is measured. */
const kFarAbove = 4; // standard uncertainties: a difference that chance does not make
function origin(one) {
  if (one.from !== 'convention' || one.std === null) return one.from;
  return Math.abs(one.value - (one.nominal ?? 0)) > kFarAbove * one.std ? 'combination' : 'convention';
}

/** Every free parameter with its value, its uncertainty, and what it rests on. */
export function parameterPanel() {
  const body = el('tbody', { id: 'parameters' }),
    words = el('p', { class: 'note' });
  const row = (one) => {
    const [label, why] = kFrom[origin(one)] ?? ['not fitted', 'no fit of this file knows it, or its value was changed since'];
    return el(
      'tr',
      { 'data-from': one.from ?? '' },
      el('td', { class: 'text' }, one.name),
      el('td', { class: 'num' }, number(one.value, 6)),
      el('td', { class: 'num' }, one.std === null ? '–' : number(one.std, 2)),
      el('td', { class: 'text' }, one.unit),
      el('td', { class: 'num' }, one.nominal === null ? '' : number(one.nominal, 6)),
      el('td', { class: 'text' }, el('span', { class: `from ${one.from ?? 'none'}`, title: why }, label)),
    );
  };
  on('rows', async () => {
    body.replaceChildren();
    words.textContent = '';
    store.parameters = [];
    emit('parameters');
    if (!store.rows) return;
    const asked = store.rows;
    const list = await getJson('/api/parameters', { machine: store.machine, measurement: store.measurements }).catch(() => []);
    if (asked !== store.rows) return;
    store.parameters = list;
    emit('parameters');
    body.replaceChildren(...list.slice(0, kShown).map(row));
    const count = (from) => list.filter((one) => origin(one) === from).length;
    words.textContent =
      `${list.length} free: ${count('data')} measured, ${count('combination')} measured in a combination, ${count('convention')} not determined (nearest nominal), ${count('prior')} not measured, ` +
      `${count(null)} not fitted in this file.${list.length > kShown ? ` The first ${kShown} are shown.` : ''}`;
  });
  const head = ['parameter', 'value', '± std. uncertainty', 'unit', 'nominal', 'rests on'];
  return panel(
    'Parameters',
    words,
    el(
      'div',
      { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': 'Parameters' },
      el(
        'table',
        {},
        el(
          'thead',
          {},
          el(
            'tr',
            {},
            head.map((name, i) => el('th', { class: [1, 2, 4].includes(i) ? 'num' : 'text' }, name)),
          ),
        ),
        body,
      ),
    ),
  );
}

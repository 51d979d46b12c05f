// SPDX-License-Identifier: GPL-3.0-or-later
import { el } from '../../../report/web/src/dom.js';
import { getJson, postJson } from './api.js';
import { button, needsSubject, panel } from './parts.js';
import { on, store } from './store.js';

/** A term of one's own: checked while it is written, names completed. */
export function termPanel(addEffect) {
  let names = [],
    transforms = [],
    at = 0;
  const input = el('input', {
    type: 'text',
    class: 'term',
    id: 'term',
    spellcheck: 'false',
    autocomplete: 'off',
    placeholder: 'k*(T_column-20)*Z',
    'aria-label': 'term',
  });
  const place = el('select', { id: 'term-place', 'aria-label': 'where' }),
    list = el('ul', { class: 'completion', role: 'listbox', hidden: '' }),
    words = el('p', { id: 'term-check', class: 'note', role: 'status' });
  const wordAt = () => input.value.slice(0, input.selectionStart).match(/[A-Za-z_]\w*$/)?.[0] ?? '';
  const where = () => JSON.parse(place.value);
  // Columns that were recorded and that the machine does not know yet; a term may bring two of them along.
  const candidates = () => (store.rows?.columns ?? []).filter((one) => one.kind === 'candidate');
  const brought = () => {
    const used = new Set(input.value.match(/[A-Za-z_]\w*/g) ?? []);
    return candidates()
      .filter((one) => used.has(one.name))
      .map((one, i) => `input${i ? i + 1 : ''}=${one.name},${i === 0 && one.unit ? `unit=${one.unit},` : ''}`)
      .join('');
  };
  const unit = () => (/^(r[XYZ]|theta|alpha)$/.test(where().dof) ? 'deg' : 'mm');
  const take = (name) => {
    const word = wordAt(),
      start = input.selectionStart - word.length;
    input.setRangeText(name, start, input.selectionStart, 'end');
    list.hidden = true;
    input.focus();
    check();
  };
  const offer = () => {
    const word = wordAt();
    const found = word ? names.filter((one) => one.name.toLowerCase().startsWith(word.toLowerCase()) && one.name !== word).slice(0, 8) : [];
    at = 0;
    list.hidden = found.length === 0;
    list.replaceChildren(
      ...found.map((one, i) => {
        const item = el(
          'li',
          { role: 'option', 'aria-selected': i === 0 ? 'true' : 'false', 'data-name': one.name },
          one.name,
          el('small', {}, `  ${one.unit} ${one.what}`),
        );
        item.addEventListener('pointerdown', (event) => {
          event.preventDefault();
          take(one.name);
        });
        return item;
      }),
    );
  };
  async function check() {
    if (!input.value.trim() || !place.value) {
      words.textContent = '';
      return;
    }
    const asked = input.value;
    const answer = await postJson('/api/term', {
      machine: store.machine,
      term: asked,
      unit: unit(),
      columns: candidates().map(({ name, unit: of }) => ({ name, unit: of })),
    }).catch((why) => ({ ok: false, message: why.message, word: '' }));
    if (asked !== input.value) return;
    words.dataset.ok = answer.ok;
    words.className = answer.ok ? 'note' : 'error';
    words.textContent = answer.ok
      ? [answer.k_unit === null ? 'the unit of k is not known' : `k is in ${answer.k_unit}`, ...answer.warnings].join('; ')
      : `${answer.message}${answer.word ? `: "${answer.word}"` : ''}`;
  }
  input.addEventListener('input', () => {
    offer();
    check();
  });
  place.addEventListener('change', check);
  input.addEventListener('keydown', (event) => {
    if (list.hidden) return;
    const items = [...list.children];
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step) at = (at + step + items.length) % items.length;
    else if (event.key === 'Tab' || event.key === 'Enter') take(items[at].dataset.name);
    else if (event.key === 'Escape') list.hidden = true;
    else return;
    event.preventDefault();
    items.forEach((item, i) => item.setAttribute('aria-selected', String(i === at)));
  });
  const add = button(
    'Add and fit',
    () => addEffect(`custom:branch=${where().branch},transform=${where().n},dof=${where().dof},${brought()}term=${input.value.trim()}`),
    { id: 'add-term', ...needsSubject },
  );
  async function build() {
    ({ names, transforms } = store.machine
      ? await getJson('/api/names', { machine: store.machine }).catch(() => ({ names: [], transforms: [] }))
      : { names: [], transforms: [] });
    for (const column of candidates()) names.push({ name: column.name, unit: column.unit, what: 'column of the measurement' });
    place.replaceChildren(
      ...transforms.flatMap((one) =>
        one.dofs.map(({ dof, text }) =>
          el(
            'option',
            { value: JSON.stringify({ branch: one.branch, n: one.n, dof }) },
            `${one.branch === 'tool' ? '' : `${one.branch} `}${one.n} ${dof} = ${text}`,
          ),
        ),
      ),
    );
    check();
  }
  on('rows', build);
  build();
  return panel('A term of your own', el('div', { class: 'controls' }, place, input, add), list, words);
}

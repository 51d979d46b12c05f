// SPDX-License-Identifier: GPL-3.0-or-later
import { el } from '../../../report/web/src/dom.js';
import { number } from '../../../report/web/src/data.js';
import { select, selection, store } from './store.js';

const kRowPx = 22;

/** Rows of the measurement, worst first; only those in sight are in the page, so that 10⁵ of them scroll. */
export function rowTable(height) {
  const { rows } = store;
  const shown = [
    ['file', (r) => rows.files[rows.row_file[r]]],
    ['line', (r) => rows.row_line[r]],
    ['run', (r) => rows.runs[rows.row_run[r]]],
    ['role', (r) => (rows.row_check[r] ? 'check' : 'fit')],
    ...rows.kinds.map((group) => {
      const at = new Float32Array(rows.n_rows).fill(NaN);
      group.row.forEach((row, i) => {
        at[row] = group.value[i];
      });
      return [`${group.kind} [${group.unit}]`, (r) => number(at[r], 4), at];
    }),
    ...rows.columns
      .slice(0, 6)
      .map((column) => [`${column.name}${column.unit ? ` [${column.unit}]` : ''}`, (r) => number(column.data[r], 6)]),
  ];
  const order = Uint32Array.from({ length: rows.n_rows }, (_, i) => i).sort((i, j) => rows.size[j] - rows.size[i]);
  let list = order,
    onlyChosen = false;
  const body = el('div', { class: 'rows-body' }),
    inner = el('div', { class: 'rows-inner' });
  body.append(inner);
  const scroll = el(
    'div',
    { class: 'rows', tabindex: '0', role: 'grid', 'aria-label': 'Rows, largest residual first', 'aria-rowcount': rows.n_rows },
    el(
      'div',
      { class: 'rows-head', role: 'row' },
      shown.map(([name]) => el('span', { role: 'columnheader' }, name)),
    ),
    body,
  );
  scroll.style.height = `${height}px`;
  function draw() {
    list = onlyChosen ? order.filter((row) => selection.rows[row]) : order;
    body.style.height = `${list.length * kRowPx}px`;
    const first = Math.max(0, Math.floor(scroll.scrollTop / kRowPx) - 4),
      last = Math.min(list.length, first + Math.ceil(height / kRowPx) + 8);
    inner.style.transform = `translateY(${first * kRowPx}px)`;
    inner.replaceChildren(
      ...Array.from({ length: last - first }, (_, k) => {
        const row = list[first + k];
        const line = el(
          'div',
          { role: 'row', class: selection.rows[row] ? 'chosen' : null, 'data-row': row },
          shown.map(([, text]) => el('span', { role: 'gridcell' }, text(row))),
        );
        return line;
      }),
    );
  }
  scroll.addEventListener('scroll', draw);
  inner.addEventListener('click', (event) => {
    const row = Number(event.target.closest('[data-row]')?.dataset.row);
    if (!Number.isInteger(row)) return;
    const next = selection.rows.slice();
    next[row] = next[row] ? 0 : 1;
    select(next);
  });
  const only = el('input', { type: 'checkbox' });
  only.addEventListener('change', () => {
    onlyChosen = only.checked;
    scroll.scrollTop = 0;
    draw();
  });
  return { element: el('div', {}, el('label', { class: 'choice hands' }, only, ' only chosen rows'), scroll), draw };
}

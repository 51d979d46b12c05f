// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that comes from a file or a user goes in as text, never as markup.

import { t } from './translate.js';

/** Attributes that a person reads or hears. */
const kSpoken = new Set(['title', 'aria-label', 'placeholder']);

/** An element with attributes and children; strings become text nodes, in the language of the report. */
export function el(name, attributes = {}, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value !== undefined && value !== null) node.setAttribute(key, kSpoken.has(key) ? t(value) : value);
  }
  for (const child of children.flat(Infinity)) {
    if (child !== null && child !== undefined) node.append(child instanceof Node ? child : t(String(child)));
  }
  return node;
}

/** Gives the person a file. */
export function save(name, blob) {
  const link = el('a', { href: URL.createObjectURL(blob), download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

/** Buttons that save a picture or its numbers: [[label, file name, () => Blob or a promise of one]]. */
export function exportButtons(kinds) {
  return el(
    'span',
    { class: 'exports' },
    kinds.map(([label, name, make]) => {
      const node = el('button', { type: 'button', class: 'quiet', title: `Save as ${label}` }, label);
      node.addEventListener('click', async () => save(name, await make()));
      return node;
    }),
  );
}

let sections = 0;

/** A section with a heading, linked from the bar at the top. */
export function section(root, title, ...children) {
  const id = `s${++sections}`;
  const node = el('section', { id, 'aria-labelledby': `${id}h` }, el('h2', { id: `${id}h` }, title), ...children);
  root.append(node);
  document.getElementById('nav').append(el('a', { href: `#${id}` }, title));
  return node;
}

/** Table of texts; columns: [{name, left}] (left: text, else a right-aligned number). whole: all rows and columns are in sight. */
export function table(caption, columns, rows, { whole = false } = {}) {
  const cell = (name, column, text) => el(name, { class: column.left ? 'text' : 'num', scope: name === 'th' ? 'col' : null }, text);
  return el(
    'div',
    { class: whole ? 'scroll whole' : 'scroll', tabindex: '0', role: 'region', 'aria-label': caption },
    el(
      'table',
      {},
      el('caption', {}, caption),
      el(
        'thead',
        {},
        el(
          'tr',
          {},
          columns.map((column) => cell('th', column, column.name)),
        ),
      ),
      el(
        'tbody',
        {},
        rows.map((row) =>
          el(
            'tr',
            {},
            row.map((text, i) => cell('td', columns[i], text)),
          ),
        ),
      ),
    ),
  );
}

/** Labelled numbers in a row of tiles: [{label, value, unit, hint}]. */
export function tiles(items) {
  return el(
    'dl',
    { class: 'tiles' },
    items.map((item) =>
      el(
        'div',
        { class: item.strong ? 'tile strong' : 'tile', title: item.hint },
        el('dt', {}, item.label),
        el('dd', {}, item.value, item.unit && item.value !== '–' ? el('small', {}, ` ${item.unit}`) : null),
      ),
    ),
  );
}

/** A labelled choice; calls back with the value chosen. */
export function choice(label, options, chosen, change) {
  const select = el(
    'select',
    {},
    options.map(([value, text]) => el('option', { value, selected: value === chosen ? '' : null }, text)),
  );
  select.addEventListener('change', () => change(select.value));
  return el('label', { class: 'choice' }, `${label} `, select);
}

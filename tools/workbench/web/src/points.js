// SPDX-License-Identifier: GPL-3.0-or-later
// Positions of the points in a table of distances: AB, BC, AC.
import { el } from '../../../report/web/src/dom.js';
import { button } from './parts.js';

const number = (words) => words.trim().replace(',', '.');
const isNumber = (words) => words.trim() !== '' && Number.isFinite(Number(number(words)));

/** The positions that were typed, by the name of the point: {name: [text for each axis]}. */
export const pointWords = (typed) =>
  [...typed].filter(([, values]) => values.every(isNumber)).map(([name, values]) => `${name}=${values.map(number).join(',')}`);

/** What the program says of points without positions, in the words of the page: the fields are below. */
export const pointsOnPage = (message) =>
  message.replace('(--nominal FILE)', '(its name in the field "nominal")').replace(/ and give(?: --point "[^"]+")+/, ' below');

/**
 * A row of fields for each point: its commanded position. `points`: {names, axes} of the program. `typed`: a Map of what was
 * typed; `change()` is called when all positions are numbers.
 */
export function pointFields({ names, axes }, typed, change) {
  const known = (name) => {
    if (typed.get(name)?.length !== axes.length)
      typed.set(
        name,
        axes.map(() => ''),
      );
    return typed.get(name);
  };
  [...typed.keys()].filter((name) => !names.includes(name)).forEach((name) => typed.delete(name));
  const missing = el('p', { class: 'error', role: 'alert', hidden: '' });
  const read = button(
    'Take these positions',
    () => {
      const open = names.flatMap((name) => axes.filter((_, k) => !isNumber(known(name)[k])).map((axis) => `${axis.name} of ${name}`));
      missing.hidden = !open.length;
      missing.textContent = `No number yet: ${open.join(', ')}. (Z of a printed square: the height of the layer, such as 0.2.)`;
      if (!open.length) change();
    },
    { id: 'take-points' },
  );
  const row = (name) =>
    el(
      'tr',
      { 'data-point': name },
      el('td', { class: 'text' }, name),
      axes.map((axis, k) => {
        const input = el('input', {
          type: 'text',
          inputmode: 'decimal',
          size: '8',
          value: known(name)[k],
          'aria-label': `${axis.name} of the point ${name}`,
          'data-axis': axis.name,
        });
        input.addEventListener('input', () => {
          known(name)[k] = input.value;
        });
        return el('td', {}, input);
      }),
    );
  return el(
    'div',
    { id: 'points' },
    el('h3', {}, 'Positions of the points'),
    el(
      'p',
      { class: 'note' },
      'The position in the machine at which each point was commanded (of a printed square: the corners in the slicer).',
    ),
    el(
      'table',
      {},
      el(
        'thead',
        {},
        el(
          'tr',
          {},
          el('th', { class: 'text' }, 'point'),
          axes.map((axis) => el('th', {}, `${axis.name} [${axis.unit}]`)),
        ),
      ),
      el('tbody', {}, names.map(row)),
    ),
    el('div', { class: 'controls' }, read),
    missing,
  );
}

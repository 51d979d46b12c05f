// SPDX-License-Identifier: GPL-3.0-or-later
import { el } from '../../../report/web/src/dom.js';
import { freeName, Refused, run } from './api.js';
import { button, guarded } from './parts.js';
import { store } from './store.js';

export const kNames =
  'The columns may have other names: a1 or joint_1 instead of the names in the machine file. The program compares the names and numbers, and writes a new measurement file.';

const kNoAxes =
  'No column is the position of an axis. If these are points that an instrument measured, choose "points of a laser tracker" in the field "read as".';

const kByHand =
  'The program does not find the columns of the axes. Press "Choose the columns by hand": there, write the name of an axis in the place of the name of its column.';

/** The assignment of columns that a refusal proposes, as words of an option; empty: it proposes none, or not all of it. */
export const wordsProposed = (message, option = 'column') => {
  const words = [...message.matchAll(new RegExp(`--${option} (?:"([^"]+)"|'([^']+)'|(\\S+))`, 'g'))]
    .map(([, ...one]) => one.find((word) => word !== undefined))
    .filter((one) => one.includes('='));
  return words.some((one) => one.includes('HEADING')) ? [] : words;
};

/** An assignment to confirm: [name, heading], and the button that takes it. */
export const confirmed = (pairs, take, id) => [
  el(
    'ul',
    {},
    pairs.map(([name, heading]) => el('li', {}, `${name}: "${heading}"`)),
  ),
  button('This assignment is right', take, { id }),
];

/** The words of an option as [name, heading]. */
export const pairsOf = (words) => words.map((one) => [one.replace(/=.*$/, ''), one.replace(/^[^=]*=/, '')]);

/**
 * A button that writes a new measurement file whose joints have the names of the machine. `done(output)`: called with its name.
 * `error`: where a refusal is shown; `byHand`: a button beside it; `prefix`: of the ids.
 */
export function byMachine(file, { error, byHand = null, done, prefix = '' }) {
  const answers = el('div', {});
  const read = (column) =>
    guarded(error, async () => {
      const output = freeName(`${file.replace(/\.[^.]*$/, '')}_read`, '.csv');
      try {
        await run({ command: 'import table', file, ...(column.length ? { column } : {}), machine: store.machine, output });
      } catch (why) {
        if (!(why instanceof Refused) || column.length) throw why;
        doubt(wordsProposed(why.message));
        return;
      }
      await done(output);
    });
  /** The program is not sure which column is which axis: the user confirms its assignment. */
  const doubt = (columns) => {
    const readings = columns.some((one) => /^[xyz]\W/.test(one));
    if (!columns.length || readings) {
      error.replaceChildren(el('p', { class: 'error', role: 'alert' }, readings ? kNoAxes : kByHand));
      return;
    }
    error.replaceChildren();
    answers.replaceChildren(
      el('p', { class: 'note', role: 'status' }, 'As many columns may be the axes, in the order of the machine file:'),
      ...confirmed(pairsOf(columns), () => read(columns), `${prefix}assignment-is-right`),
    );
  };
  const byName = button('Read the columns as the axes of the machine', () => read([]), { id: `${prefix}by-machine` });
  return el('div', {}, el('div', { class: 'controls' }, byName, byHand), answers);
}

// SPDX-License-Identifier: GPL-3.0-or-later
import { el } from '../../../report/web/src/dom.js';
import { freeName, Refused, run } from './api.js';
import { button, gate, guarded, panel, refusalWords } from './parts.js';
import { kDeclareBed } from './instrument.js';
import { on, store } from './store.js';

/** Columns that the refusal of rows asks for: [name[unit]]; the file that lacks them. */
function asked(refusal) {
  const file = refusal?.match(/^(.+?):\d+: /)?.[1];
  return { file, columns: [...(refusal?.matchAll(/--set "([^"=]+)=POSITION"/g) ?? [])].map((one) => one[1]) };
}

const kNames =
  'The columns may have other names: a1 or joint_1 instead of the names in the machine file. The program compares the names and numbers, and writes a new measurement file.';

const kByHand =
  'The program does not find the columns of the axes. Press "Choose the columns by hand": there, write the name of an axis in the place of the name of its column.';

/** The assignment of columns to axes that a refusal proposes, as words of the option column. */
const proposed = (message) =>
  [...message.matchAll(/--column (?:"([^"]+)"|'([^']+)'|(\S+))/g)]
    .map(([, ...words]) => words.find((one) => one !== undefined))
    .filter((one) => one.includes('=') && !one.includes('HEADING'));

const number = (id, label, size) => el('input', { type: 'text', inputmode: 'decimal', id, 'aria-label': label, size });
const value = (input) => input.value.trim().replace(',', '.');

/**
 * Why the chosen rows cannot be read. Where axes of the machine have no column: fields for where they stood, and for the
 * uncertainty of the readings; both become columns of a new measurement file. `choose(machine, measurements)`;
 * `byTable(file, done)` asks for the meaning of the columns of a file.
 */
export function stoodPanel(choose, byTable) {
  const room = el('div', { id: 'stood-room' }),
    error = el('div', {});
  /** A new machine file with the touched object of the refusal: NAME:TYPE. */
  const declare = () => {
    const [, name, type] = store.refusal.match(/name="([^"]+)" type="([^"]+)"/) ?? [null, 'bed', 'plane'];
    const field = el('input', { type: 'text', id: 'declare-artefact', value: `${name}:${type}`, 'aria-label': 'artefact', size: '14' });
    const add = button(
      'Declare it',
      () =>
        guarded(error, async () => {
          const output = freeName(`${store.machine.replace(/\.[^.]*$/, '')}_touched`, '.xml');
          await run({ command: 'set', machine: store.machine, artefact: [field.value.trim()], output });
          await choose(output, store.measurements);
        }),
      { id: 'declare' },
    );
    return el('div', { class: 'controls' }, el('label', { class: 'choice' }, 'artefact (name:type) ', field), add);
  };
  const instead = (file, outputs) =>
    choose(
      store.machine,
      store.measurements.flatMap((one) => (one === file ? outputs : [one])),
    );
  /** A new measurement file whose joints have the names of the machine. */
  const byMachine = (file) => {
    const answers = el('div', { class: 'controls' });
    const read = (column) =>
      guarded(error, async () => {
        const output = freeName(`${file.replace(/\.[^.]*$/, '')}_read`, '.csv');
        const { machine } = store;
        try {
          await run({ command: 'import table', file, ...(column.length ? { column } : {}), machine, output });
        } catch (why) {
          if (!(why instanceof Refused) || column.length) throw why;
          doubt(why, proposed(why.message));
          return;
        }
        await instead(file, [output]);
      });
    const byName = button('Read the columns as the axes of the machine', () => read([]), { id: 'by-machine' });
    /** The program is not sure which column is which axis: the user confirms its assignment. */
    const doubt = (why, columns) => {
      if (!columns.length) {
        error.replaceChildren(el('p', { class: 'error', role: 'alert' }, kByHand));
        return;
      }
      error.replaceChildren(
        el('p', { class: 'note', role: 'status' }, 'As many columns may be the axes, in the order of the machine file:'),
        el(
          'ul',
          {},
          columns.map((one) => el('li', {}, `${one.replace(/=.*$/, '')}: "${one.replace(/^[^=]*=/, '')}"`)),
        ),
      );
      answers.replaceChildren(button('This assignment is right', () => read(columns), { id: 'assignment-is-right' }));
    };
    const byHand = button('Choose the columns by hand', () => byTable(file, (outputs) => instead(file, outputs)), {
      class: 'quiet',
      id: 'by-hand',
    });
    return el('div', {}, el('div', { class: 'controls' }, byName, byHand), answers);
  };
  const draw = () => {
    const { file, columns } = asked(store.refusal);
    if (!store.refusal) return room.replaceChildren();
    const words = el('p', { class: 'error', role: 'alert' }, refusalWords(store.refusal));
    if (file && /--machine MACHINE/.test(store.refusal))
      return room.replaceChildren(panel(`No axis of the machine has a column in ${file}`, el('p', {}, kNames), error, byMachine(file)));
    if (!columns.length || !file)
      return room.replaceChildren(
        panel(
          'These rows cannot be read',
          words,
          ...(/the machine file has no <artefact>/.test(store.refusal) ? [el('p', {}, kDeclareBed), error, declare()] : []),
        ),
      );
    const fields = columns.map((column) => [column, number(`stood-${column.replace(/\W.*/, '')}`, `${column} stood at`, '8')]);
    const u = number('stood-u', 'standard uncertainty of the readings, um', '5');
    const add = button(
      'Add to every row',
      () =>
        guarded(error, async () => {
          const set = fields.map(([column, input]) => `${column}=${value(input)}`);
          if (value(u)) set.push(`u[um]=${value(u)}`);
          const output = freeName(`${file.replace(/\.[^.]*$/, '')}_with_axes`, '.csv');
          await run({ command: 'import table', file, set, output });
          await choose(
            store.machine,
            store.measurements.map((one) => (one === file ? output : one)),
          );
        }),
      { id: 'stood-add' },
    );
    const ready = () => {
      const open = fields.filter(([, input]) => !Number.isFinite(parseFloat(value(input)))).map(([column]) => column);
      gate(add, open.length ? `State a number for ${open.join(', ')} first` : null);
    };
    for (const [, input] of fields) input.addEventListener('input', ready);
    ready();
    return room.replaceChildren(
      panel(
        `Where did the other axes stand in ${file}?`,
        el('p', {}, 'The machine has axes without a column in this file. If they stood still, state their positions.'),
        el(
          'div',
          { class: 'controls' },
          fields.map(([column, input]) => el('label', { class: 'choice' }, `${column} `, input)),
          el('label', { class: 'choice', title: 'if the file has no column u; may stay empty' }, 'standard uncertainty u [um] ', u),
          add,
        ),
        error,
      ),
    );
  };
  on('rows', draw);
  draw();
  return room;
}

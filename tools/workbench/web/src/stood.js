// SPDX-License-Identifier: GPL-3.0-or-later
import { el } from '../../../report/web/src/dom.js';
import { freeName, run } from './api.js';
import { byMachine, kNames } from './joints.js';
import { button, gate, guarded, panel, refusalWords } from './parts.js';
import { kDeclareBed } from './instrument.js';
import { on, store } from './store.js';

/** Columns that the refusal of rows asks for: [name[unit]]; the file that lacks them. */
function asked(refusal) {
  const file = refusal?.match(/^(.+?):\d+: /)?.[1];
  return { file, columns: [...(refusal?.matchAll(/--set "([^"=]+)=POSITION"/g) ?? [])].map((one) => one[1]) };
}

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
  const byNames = (file) => {
    const byHand = button('Choose the columns by hand', () => byTable(file, (outputs) => instead(file, outputs)), {
      class: 'quiet',
      id: 'by-hand',
    });
    return byMachine(file, { error, byHand, done: (output) => instead(file, [output]) });
  };
  const draw = () => {
    const { file, columns } = asked(store.refusal);
    if (!store.refusal) return room.replaceChildren();
    const words = el('p', { class: 'error', role: 'alert' }, refusalWords(store.refusal));
    if (file && /--machine MACHINE/.test(store.refusal))
      return room.replaceChildren(panel(`No axis of the machine has a column in ${file}`, el('p', {}, kNames), error, byNames(file)));
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
  on('rows', () => {
    draw();
    // The other panels are drawn anew too: the question is looked for when they are.
    if (room.childElementCount) requestAnimationFrame(() => room.scrollIntoView({ block: 'nearest' }));
  });
  draw();
  return room;
}

// SPDX-License-Identifier: GPL-3.0-or-later
import { el } from '../../../report/web/src/dom.js';
import { freeName, run } from './api.js';
import { kTypes, machineChoice } from './machines.js';
import { moreOptions, option } from './options.js';
import { button, guarded, panel } from './parts.js';
import { kReflector } from './reflector.js';
import { on, store } from './store.js';

/** The panel that makes a machine file; texts name it. */
export const kMakeOne = 'Make one by type and travels';

/** Makes a machine file and an empty survey: `vernier new`. */
function newMachine(choose) {
  const error = el('div', {});
  const axes = el('input', { type: 'text', id: 'new-axes', class: 'term', 'aria-label': 'axes', spellcheck: 'false', value: kTypes[0][2] });
  const name = el('input', { type: 'text', id: 'new-name', 'aria-label': 'name', value: 'machine', maxlength: '60' });
  const drawing = el('pre', { class: 'source', hidden: '' });
  let type = 'gantry';
  const kind = machineChoice(type, (chosen, usual) => {
    type = chosen;
    axes.value = usual;
  });
  const options = moreOptions('new', ['type', 'axis', 'name', 'reflector', 'output', 'measurements']);
  const reflector = el('input', { type: 'checkbox', id: 'new-reflector' });
  const make = button(
    'Make it',
    () =>
      guarded(error, async () => {
        const stem = name.value.trim().replace(/[^\w-]+/g, '_') || 'machine';
        const output = freeName(stem, '.xml'),
          survey = freeName(`${stem}_survey`, '.csv');
        const axis = axes.value.split(/\s+/).filter(Boolean);
        const { result } = await run({
          command: 'new',
          type,
          ...(axis.length ? { axis } : {}),
          ...(name.value.trim() ? { name: name.value.trim() } : {}),
          ...options.values(),
          ...(reflector.checked ? { reflector: true } : {}),
          output,
          measurements: survey,
        });
        drawing.hidden = false;
        drawing.textContent = `${result.drawing}\n\n${output}, and ${survey}: positions to be measured, with empty cells for the readings`;
        await choose(output, store.measurements);
      }),
    { id: 'make-machine' },
  );
  return [
    kind,
    el(
      'div',
      { class: 'controls' },
      el('label', { class: 'choice' }, 'axes, with their travel in mm or deg ', axes),
      el('label', { class: 'choice' }, 'name ', name),
      el('label', { class: 'choice', title: option('new', 'reflector').help }, reflector, ` ${kReflector}`),
      make,
    ),
    options.element,
    drawing,
    error,
  ];
}

/** What to do first, as long as there is nothing to work on. */
export function beginPanel(choose) {
  const made = newMachine(choose);
  const steps = el('ol', { id: 'begin-steps' });
  const summary = el('summary', {});
  const made_panel = el('details', { id: 'new-machine' }, summary, made);
  const root = panel('Begin', steps, made_panel);
  root.id = 'begin';
  const draw = () => {
    const machine = Boolean(store.machine),
      rows = store.measurements.length > 0;
    const item = (done, words) => el('li', { class: done ? 'done' : null }, words);
    steps.replaceChildren(
      item(
        rows,
        'What was measured: drop any spreadsheet (.xlsx, .csv, .txt), file of a ball bar or an interferometer (.b5r, .rtl) or measurement file above.',
      ),
      item(machine, 'Which machine: drop its machine file (.xml) or the description of a robot (.urdf), or make one below.'),
      item(false, 'Then go to Compare: where the model fails, and from there along the path at the top.'),
    );
    // Rows that this machine cannot read may need another one.
    steps.hidden = machine && rows && !store.refusal;
    root.querySelector('h2').hidden = steps.hidden;
    summary.textContent = `${machine ? 'Another machine file?' : 'No machine file yet?'} ${kMakeOne}`;
    made_panel.open ||= rows && !machine;
  };
  on('project', draw);
  on('rows', draw);
  draw();
  return root;
}

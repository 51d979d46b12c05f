// SPDX-License-Identifier: GPL-3.0-or-later
// For a control without a board: its tables, a corrected part program, and the map of what is left.
import { el } from '../../../report/web/src/dom.js';
import { number } from '../../../report/web/src/data.js';
import { fileAddress, freeName, run } from './api.js';
import { reportHead } from './handover.js';
import { optionFields } from './options.js';
import { button, gate, guarded, kFitSquare, kOfSquare, panel, programWords } from './parts.js';
import { choose } from './rows.js';
import { emit, on, store } from './store.js';
import { beforeFits, fitThatMade, urdfOf } from './uses.js';

const kNoMachine = 'Choose a machine at the top first';
const stemOf = (name) => name.replace(/.*\//, '').replace(/\.[^.]*$/, '');

/** A link that saves a file of the project under its own name; a report is opened. */
const fileLink = (name) =>
  el(
    'a',
    /\.html$/i.test(name)
      ? { href: fileAddress(name), target: '_blank', rel: 'noopener' }
      : { href: fileAddress(name), download: name.replace(/.*\//, '') },
    name,
  );

/** What is not in the files, with the fields of this page. */
const onPage = (what) =>
  what
    .replace(/with --steps X,Y,Z/g, 'in the field "steps" (such as 40,40,8)')
    .replace(/--touches FILE gives/g, 'the field "touches" gives');

const um = (one) => (Number.isFinite(one.um) ? ` (up to ${number(one.um, 3)} µm)` : ' (size unknown)');

/**
 * The fit that measures the squareness and the scales of X and Y with the distances of a printed square, where the last fit had
 * too many errors for them: of the machine file of that fit, and of the chosen measurements. null: none, or the history does not have that fit.
 */
function fitAgain(offered) {
  const made = offered && fitThatMade(store.machine);
  if (!made) return null;
  // The chosen measurements may be those of the last fit, read again with their uncertainties.
  const before = { machine: beforeFits(made.machine), meas: store.measurements.length ? [...store.measurements] : made.meas };
  const error = el('div', {});
  const fit = button(
    kFitSquare,
    () =>
      guarded(error, async () => {
        const output = freeName(`${stemOf(before.machine)}-fitted`, '.xml');
        await run({ command: 'fit', ...before, ...offered, output });
        await choose(output, store.measurements);
        error.replaceChildren(el('p', { class: 'note', role: 'status' }, `${output} is fitted and chosen: press "Write the files" again.`));
      }),
    { id: 'fit-again' },
  );
  return el(
    'div',
    { class: 'controls' },
    `If the distances of a printed square were measured, they determine the squareness and the scales of X and Y: of ${before.machine} the other errors stay as they are. The fit is of ${before.meas.join(', ')}.`,
    fit,
    error,
  );
}

/** What a command printed, and its files. What the format left out is said with the success, not below it. */
function outcome(box, { text, result }, files, words) {
  const left = result?.left_out ?? [];
  const again = fitAgain(result?.fit_again);
  // The command names its files too; here they are links. What it offers is a button.
  const lines = programWords(text)
    .split('\n')
    .filter(
      (line) => line.trim() && !files.includes(line.trim()) && !line.startsWith('left out: ') && !(again && line.startsWith(kOfSquare)),
    );
  box.replaceChildren(
    left.length
      ? el(
          'div',
          { class: 'error', role: 'alert' },
          'These errors of the machine are not in the files:',
          el(
            'ul',
            { id: 'left-out' },
            left.map((one) => el('li', {}, `${onPage(one.what)}${um(one)}`)),
          ),
        )
      : '',
    again ?? '',
    el('p', { class: 'verdict', role: 'status' }, words),
    lines.length ? el('pre', { class: 'source wrap' }, lines.join('\n')) : '',
    el(
      'ul',
      { class: 'files' },
      files.map((name) => el('li', {}, fileLink(name))),
    ),
  );
  box.scrollIntoView({ block: 'nearest' });
}

/** Whenever a machine is chosen or the fields change: why the button cannot be pressed. */
function gated(node, why) {
  const now = () => gate(node, store.machine ? why() : kNoMachine);
  on('rows', now);
  now();
  return now;
}

function controlPanel() {
  const formats = store.commands.filter((one) => one.name.startsWith('export '));
  const error = el('div', { id: 'export-error' }),
    result = el('div', { id: 'export-result' }),
    options = el('div', { class: 'controls', id: 'export-options' });
  const format = el(
    'select',
    { id: 'export-format', 'aria-label': 'control' },
    el('option', { value: '' }, 'choose the control or the format'),
    formats.map((one) => el('option', { value: one.name.slice('export '.length) }, one.help)),
  );
  let fields = null,
    filled_for = null;
  const write = button(
    'Write the files',
    () =>
      guarded(error, async () => {
        result.replaceChildren();
        const command = `export ${format.value}`;
        const folder = formats.find((one) => one.name === command).options.find((one) => one.name === 'output').kind === 'writes-folder';
        const output = freeName(`${format.value}-${stemOf(store.machine)}`, folder ? '' : '.csv');
        const state = await run({ command, machine: store.machine, ...fields.values(), output });
        const files = [...state.result.files].sort((a, b) => /readme/i.test(b) - /readme/i.test(a));
        outcome(
          result,
          state,
          files,
          `${files.length === 1 ? 'One file is' : `${files.length} files are`} written${folder ? ` into the folder ${output} of the project` : ''}. ` +
            `${files.some((name) => /readme/i.test(name)) ? 'README says how the control reads the files. ' : ''}Press a name to save the file.`,
        );
        store.exported = store.machine;
        store.leftOut = (state.result.left_out ?? []).map((one) => onPage(one.what));
        emit('uploaded');
      }),
    { id: 'do-export' },
  );
  /** The URDF of the machine that is chosen: its frames are those that the user knows. */
  const fillOriginal = () => {
    filled_for = store.machine;
    if (format.value === 'urdf') fields.fill({ original: [''], tip: [''], ...urdfOf(store.machine) });
  };
  /** The rotation_distance of X, Y and Z in a printer.cfg of the project, which the scales of Klipper need. */
  const fillSteps = async (mine) => {
    for (const { name } of store.files.filter((one) => /\.cfg$/i.test(one.name) && !one.name.includes('/'))) {
      const words = await (await fetch(fileAddress(name))).text();
      const found = ['x', 'y', 'z'].map(
        (axis) => words.match(new RegExp(`^\\[stepper_${axis}\\][^[]*?^rotation_distance\\s*[:=]\\s*([\\d.]+)`, 'm'))?.[1],
      );
      if (fields === mine && found.every(Boolean) && !mine.values().steps) mine.fill({ steps: [found.join(',')] });
    }
  };
  on('rows', () => filled_for !== store.machine && fillOriginal());
  const now = gated(write, () => (format.value ? null : 'Choose the control or the format first'));
  format.addEventListener('change', () => {
    fields = format.value ? optionFields(`export ${format.value}`, ['machine', 'output']) : null;
    fillOriginal();
    options.replaceChildren(...(fields?.elements ?? []));
    if (format.value === 'klipper') fillSteps(fields);
    error.replaceChildren();
    result.replaceChildren();
    now();
  });
  return panel(
    'Files for a control',
    el(
      'p',
      {},
      'Writes the corrections of the machine that is chosen at the top in the format of its control. The machine has to meet the rules of ',
      el('a', { href: '#board' }, 'Safe to run?'),
      ', or you accept those that it does not meet. Heights of a printer that follow the touches of its probe are written without these rules.',
    ),
    el('div', { class: 'controls' }, format, write),
    options,
    error,
    result,
  );
}

/** A command with one output of its own: its fields, a button, what came out. */
function commandPanel({ command, title, words, label, id, given, more = () => ({}), output, said }) {
  const error = el('div', {}),
    result = el('div', { id: `${id}-result` });
  const act = button(
    label,
    () =>
      guarded(error, async () => {
        result.replaceChildren();
        const values = fields.values();
        const name = output(values);
        const state = await run({ command, machine: store.machine, ...values, ...more(), output: name });
        outcome(result, state, [name], said);
      }),
    { id: `do-${id}` },
  );
  let now = () => {};
  const fields = optionFields(command, ['machine', 'output', ...given], () => now());
  const lacking = () => {
    const names = fields.required();
    return names.length ? `State ${names.map((one) => `"${one}"`).join(', ')} first` : null;
  };
  now = gated(act, lacking);
  return panel(
    title,
    el('p', {}, words),
    el('div', { class: 'controls' }, fields.elements),
    el('div', { class: 'controls' }, act),
    error,
    result,
  );
}

export function exportView(root) {
  root.append(
    controlPanel(),
    commandPanel({
      command: 'correct',
      title: 'Correct a part program or positions',
      words:
        'For a control without tables: writes a part program (RS-274) or a table of positions of the project (path) with the correction.',
      label: 'Correct',
      id: 'correct',
      given: [],
      output: ({ path }) => freeName(`${path.replace(/\.[^.]*$/, '')}_corrected`, path.match(/\.[^./]*$/)?.[0] ?? ''),
      said: 'The corrected file is written. Press its name to save it.',
    }),
    commandPanel({
      command: 'map',
      title: 'Map of the error',
      words:
        'A report: the error over the working volume and the uncertainty of this error, without and with the correction of a machine file.',
      label: 'Make the map',
      id: 'map',
      given: ['header', 'language'],
      more: reportHead,
      output: () => freeName(`map-${stemOf(store.machine)}`, '.html'),
      said: 'The report is written. Press its name to open it.',
    }),
  );
  return { show() {} };
}

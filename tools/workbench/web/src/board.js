// SPDX-License-Identifier: GPL-3.0-or-later
import { el, table } from '../../../report/web/src/dom.js';
import { number } from '../../../report/web/src/data.js';
import { fileAddress, freeName, getJson, run } from './api.js';
import { budgetFigure } from './charts.js';
import { livePanel } from './live.js';
import { moreOptions, option } from './options.js';
import { safetyPanel } from './safety.js';
import { button, gate, guarded, panel } from './parts.js';
import { emit, on, store } from './store.js';

/** Needs an axis and a weight; prints a key for a person. */
const kNotHere = ['weight', 'identify'];

const folders = () => [
  ...new Set(store.files.filter((file) => /\/machine\.vimg$/.test(file.name)).map((file) => file.name.replace(/\/machine\.vimg$/, ''))),
];

function fill(select, names, chosen, none) {
  select.replaceChildren(
    ...(none ? [el('option', { value: '' }, none)] : []),
    ...names.map((name) => el('option', { value: name, selected: name === chosen ? '' : null }, name)),
  );
}

function differenceWords(diff) {
  const change = (sign, list) => list.map((name) => el('li', {}, `${sign} ${name}`));
  const rows = (diff.corrections ?? []).map((one) => [
    one.axis,
    number(one.rms, 4),
    number(one.max, 4),
    one.unit,
    Object.entries(one.at)
      .map(([axis, at]) => `${axis} ${number(at, 5)}`)
      .join(', '),
  ]);
  return [
    el(
      'p',
      { 'data-same': diff.same },
      diff.same ? `The same equation: ${diff.a.fingerprint}.` : `${diff.b.fingerprint} runs there, ${diff.a.fingerprint} would.`,
    ),
    el('ul', {}, change('+', diff.only_a), change('−', diff.only_b)),
    diff.why_not ? el('p', {}, `Corrections are not compared: ${diff.why_not}.`) : null,
    rows.length
      ? table(
          `How far the corrections differ, over ${diff.poses} poses of the whole range`,
          [
            { name: 'axis', left: true },
            { name: 'rms' },
            { name: 'largest' },
            { name: 'unit', left: true },
            { name: 'largest at', left: true },
          ],
          rows,
        )
      : null,
  ].filter(Boolean);
}

export function boardView(root) {
  const error = el('div', { id: 'board-error' }),
    budget = el('div', { id: 'budget' }),
    difference = el('div', { id: 'difference' }),
    slots = el('p', { id: 'slots', role: 'status' });
  const image = el('select', { id: 'image', 'aria-label': 'image' }),
    key = el('select', { id: 'key', 'aria-label': 'key' }),
    other = el('select', { 'aria-label': 'other image' });
  const url = el('input', { type: 'text', id: 'board-url', value: 'tcp://127.0.0.1:1502', 'aria-label': 'board', spellcheck: 'false' });
  const compileOptions = moreOptions('compile', ['machine', 'output']),
    uploadOptions = moreOptions('upload', ['dir', 'confirm', 'revert', 'to', 'key']);
  const signed = () => (key.value ? { key: key.value } : {});
  const draw = () => {
    gate(compile, store.machine ? null : 'Choose a machine at the top first');
    for (const node of [upload, diff]) gate(node, folders().length ? null : 'There is no image yet: press Compile first');
    const keys = store.files.filter((file) => file.kind === 'key' && file.name.endsWith('.key')).map((file) => file.name);
    fill(image, folders(), image.value || folders().at(-1), folders().length ? null : 'no image yet');
    fill(key, keys, key.value || keys[0], keys.length ? null : 'no key yet');
    fill(other, folders(), other.value, 'the image that the board runs');
  };
  const step = (label, act, attributes = {}) => button(label, () => guarded(error, act), attributes);
  const compile = step(
    'Compile',
    async () => {
      const output = freeName(`image-${store.machine.replace(/.*\//, '').replace(/\.xml$/i, '')}`, '');
      const { result } = await run({ command: 'compile', machine: store.machine, ...compileOptions.values(), output });
      draw();
      image.value = output;
      const summary = el(
        'p',
        { id: 'bound' },
        `bound ${number(result.bound_um, 4)} µm, ${result.operations} operations a tick, ${result.tables} tables, ${result.image_bytes} bytes: `,
        el('a', { href: fileAddress(`${output}/equation.cpp`) }, 'the same as C++'),
      );
      summary.dataset.bound = result.bound_um;
      summary.dataset.fingerprint = result.fingerprint;
      budget.replaceChildren(budgetFigure(result, store.compare?.noise_um), summary);
    },
    { id: 'compile' },
  );
  const diff = step(
    'What would change?',
    async () => {
      const { result } = await run({
        command: 'image-diff',
        dir: image.value,
        ...(other.value ? { with: other.value } : { to: url.value, ...signed() }),
      });
      difference.replaceChildren(...differenceWords(result));
    },
    { class: 'quiet', id: 'diff' },
  );
  const showSlots = ({ result }) => {
    slots.textContent = result.trial
      ? `${result.trial} on trial, ${number(result.trial_left_s, 3)} s left: confirm it or it goes back to ${result.confirmed ?? 'none'}`
      : `${result.confirmed ?? 'no image'} is confirmed`;
    store.uploaded = Boolean(result.confirmed);
    emit('uploaded');
    Object.assign(slots.dataset, { confirmed: result.confirmed ?? '', trial: result.trial ?? '' });
  };
  const makeKey = step(
    'Make a key',
    async () => {
      await run({ command: 'keys', output: freeName('keys', '') });
      draw();
    },
    { class: 'quiet', id: 'make-key' },
  );
  const upload = step(
    'Upload (on trial)',
    async () => showSlots(await run({ command: 'upload', dir: image.value, ...uploadOptions.values(), to: url.value, key: key.value })),
    { id: 'upload' },
  );
  const confirm = step('Confirm', async () => showSlots(await run({ command: 'upload', confirm: true, to: url.value, ...signed() })), {
    id: 'confirm',
  });
  const revert = step('Revert', async () => showSlots(await run({ command: 'upload', revert: true, to: url.value, ...signed() })), {
    class: 'quiet',
    id: 'revert',
  });
  const tell = (what) =>
    step(what, () => run({ command: 'board', what, to: url.value, ...signed() }), {
      class: 'quiet',
      id: `board-${what}`,
    });
  on('project', draw);
  on('rows', draw);
  on('safety', () => {
    // What is not met can be accepted in a field of Compile.
    if (store.safety && !store.safety.ok) compileOptions.element.open = true;
  });
  draw();
  const safety = safetyPanel();
  root.append(
    error,
    safety.element,
    panel(
      'Compile',
      el(
        'p',
        {},
        'An image is for a board that corrects the machine while it moves. For the tables of a control, or a file for a robot or a printer, go to ',
        el('a', { href: '#export' }, 'Export'),
        '.',
      ),
      el('div', { class: 'controls' }, compile),
      compileOptions.element,
      budget,
    ),
    panel(
      'Board',
      el('div', { class: 'controls' }, image, url, key, makeKey),
      el('div', { class: 'controls' }, diff, el('span', {}, 'against ', other)),
      difference,
      el(
        'div',
        { class: 'controls' },
        upload,
        confirm,
        revert,
        ...option('board', 'what')
          .words.filter((what) => !kNotHere.includes(what))
          .map(tell),
      ),
      uploadOptions.element,
      slots,
    ),
    livePanel(() => url.value, getJson),
  );
  return { show: safety.look };
}

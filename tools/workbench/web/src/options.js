// SPDX-License-Identifier: GPL-3.0-or-later
import { el } from '../../../report/web/src/dom.js';
import { on, store } from './store.js';

/** What the program declares of an option that the page may use: {name, kind, list, required, help, words, low, high, default}. */
export const option = (command, name) => store.commands.find((one) => one.name === command).options.find((one) => one.name === name);

/** The name of an option as its field has it. */
export const fieldName = (name) => name.replaceAll('-', ' ');

/** The form of a value that is several numbers, as the help of its option states it: " (40,40,8)". */
const formOf = (one) => one.help.match(/form( [-\d.,]+)[;)]/)?.[1].replace(/ (.*)/, ' ($1)') ?? '';

/** An input for an option. Its `value()` is that of a request; undefined: not given. `fill(words)` enters the words of a command. */
function input(one) {
  const common = { 'data-option': one.name, 'aria-label': one.name, title: one.help };
  if (one.kind === 'flag') {
    const node = el('input', { ...common, type: 'checkbox' });
    return { node, value: () => node.checked || undefined, fill: () => (node.checked = true) };
  }
  if (one.words && one.list) {
    const boxes = one.words.map((word) =>
      el('input', { type: 'checkbox', value: word, 'data-word': word, 'aria-label': `${one.name} ${word}` }),
    );
    const node = el(
      'span',
      { class: 'words', 'data-option': one.name, role: 'group', 'aria-label': one.name, title: one.help },
      boxes.map((box, i) => el('label', {}, box, ` ${one.words[i]}`)),
    );
    return {
      node,
      value: () => {
        const marked = boxes.filter((box) => box.checked).map((box) => box.value);
        return marked.length ? marked : undefined;
      },
      fill: (given) => boxes.forEach((box) => (box.checked = given.includes(box.value))),
    };
  }
  const number = one.kind === 'number' || one.kind === 'count';
  if (one.words) {
    const node = el(
      'select',
      common,
      el('option', { value: '' }, one.default ?? ''),
      ...one.words.map((word) => el('option', { value: word }, word)),
    );
    return {
      node,
      value: () => (node.value ? (number ? Number(node.value) : node.value) : undefined),
      fill: ([word]) => (node.value = word),
    };
  }
  const single = number && !one.list;
  const limits = single ? { min: one.low ?? (one.kind === 'count' ? 0 : null), max: one.high, step: one.kind === 'count' ? 1 : 'any' } : {};
  const files = one.kind.startsWith('reads') ? { list: 'files-of-project' } : {};
  const node = el('input', {
    ...common,
    ...limits,
    ...files,
    type: single ? 'number' : 'text',
    placeholder: one.default,
    spellcheck: 'false',
  });
  const read = (word) => (number ? Number(word.replace(',', '.')) : word);
  return {
    node,
    fill: (given) => (node.value = given.join('; ')),
    value: () => {
      const words = node.value.trim();
      if (!words) return undefined;
      return one.list ? words.split(/\s*;\s*/).map(read) : read(words);
    },
  };
}

/**
 * Fields for the options of a command but those that the page gives in another way: their names, help, allowed words, types
 * and ranges are those of the program. `change` is called with each change. {elements, values(): the part of a request, fill({option:
 * [words]}): enters what a command of the history was given}.
 */
export function optionFields(command, given, change = () => {}) {
  const all = store.commands.find((one) => one.name === command).options;
  const fields = all
    .filter((one) => !given.includes(one.name))
    .map((one) => {
      const { name } = one,
        { node, value, fill } = input(one);
      node.addEventListener('change', change);
      return {
        name,
        value,
        fill,
        required: one.required,
        label: el(
          one.list && one.words ? 'div' : 'label',
          { class: 'choice', title: one.help },
          `${fieldName(name)}${one.list && !one.words ? ' (; between two)' : formOf(one)} `,
          node,
        ),
      };
    });
  return {
    elements: fields.map((one) => one.label),
    /** Names of fields that have to be filled in and are empty. */
    required: () => fields.filter((one) => one.required && one.value() === undefined).map((one) => fieldName(one.name)),
    fill: (words) => fields.forEach((one) => words[one.name] && one.fill(words[one.name])),
    values: () => Object.fromEntries(fields.map((one) => [one.name, one.value()]).filter(([, value]) => value !== undefined)),
  };
}

/** The same, folded away. */
export function moreOptions(command, given) {
  const fields = optionFields(command, given);
  return {
    element: el(
      'details',
      { class: 'options', 'data-command': command },
      el('summary', {}, `options of ${command}`),
      el('div', { class: 'controls' }, fields.elements),
    ),
    values: fields.values,
  };
}

/** The names that fields for files offer. */
export function fileNames() {
  const list = el('datalist', { id: 'files-of-project' });
  on('project', () => list.replaceChildren(...store.files.map((file) => el('option', { value: file.name }))));
  return list;
}

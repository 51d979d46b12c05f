// SPDX-License-Identifier: GPL-3.0-or-later
import { el } from '../../../report/web/src/dom.js';
import { chart } from '../../../report/web/src/chart.js';
import { getJson, named, Refused } from './api.js';
import { fieldName } from './options.js';
import { kReflector } from './reflector.js';
import { store } from './store.js';

export function button(label, act, attributes = {}) {
  const node = el('button', { type: 'button', ...attributes }, label);
  node.addEventListener('click', async () => {
    node.disabled = true;
    try {
      await act(node);
    } finally {
      node.disabled = Boolean(node.dataset.why);
    }
  });
  return node;
}

/** A button that cannot be pressed says why; `why` null: it can be pressed. */
export function gate(node, why) {
  node.dataset.own ??= node.dataset.why ? '' : node.title;
  node.disabled = Boolean(why);
  node.title = why ?? node.dataset.own;
  if (why) node.dataset.why = why;
  else delete node.dataset.why;
}

export const panel = (title, ...children) => el('section', { class: 'panel' }, title ? el('h2', {}, title) : null, ...children);

export const kNoSubject = 'Choose a machine and measurements at the top first';

/** Attributes of a button that a machine and rows have to be chosen for. */
export const needsSubject = { 'data-needs-subject': '', 'data-why': kNoSubject, title: kNoSubject, disabled: '' };

/** What a fit says of a tool point that is not known. */
const kTool = /State the tool \(vernier new --tool\), or fit it: --free ([\w,]+)/;
const toolWords = (whole, names) =>
  `State the tool in the field "tool" of a new machine file, or fit it: write ${names} into the field "free" of the options of fit`;

/** The button beside the rules of the safety sheet. */
export const kMeasuredTravel = 'Reduce the travel to the measured range';

/** How the sentence begins that offers the fit of a printed square in the words of the terminal. */
export const kOfSquare = 'To measure squareness and scales ';

/** The button that fits what a printed square shows, under Add and under Export. */
export const kFitSquare = 'Fit the squareness and these scales alone';

/** The button that adds stations to a table; behind these words the axis and the distance. */
export const kAddStations = 'Add stations: ';

/** Notes and explanations of a result in the words of the page. */
export const programWords = (words) =>
  words
    ?.replace(kTool, toolWords)
    .replace(/: vernier set \S+ --reflector -o NEW\.xml declares it/g, ': press "Declare the reflector"')
    .replace(/; --bed none leaves the bed out/g, '; the word none in the field "bed" leaves the bed out')
    .replace(/with --steps (\S+), export klipper/g, 'with $1 in the field "steps", export klipper')
    .replace(/ \(vernier set --measured-travel\)/g, ` (press "${kMeasuredTravel}" under "Safe to run?")`)
    .replace(/declare it in the machine file \(vernier set MACHINE --reflector\)/g, `press "${kReflector}"`)
    .replace(
      / \(option --directions from-order of vernier import\)/g,
      ' under Project: press "read differently" beside the file, and choose "from-order" in the field "directions"',
    )
    .replace(
      / \(import printer --series N reads the touches of one survey\)/g,
      ' (under Project, "read differently" beside the file and the number of one survey in the field "series" reads the touches of this survey)',
    )
    .replace(
      / \(vernier import printer LOG --series N, or PRINTER\.CFG --profile NAME\) in the place of --at/g,
      ' (under Project, "read differently" beside the file of the touches: the number of the survey in the field "series", or the name of the mesh in the field "profile"), and leave the field "at" empty',
    )
    .replace(
      /fit a machine file of vernier new --errors square, or fit the machine file from before the last fit again with --hold "([^"]+)" --free (\S+)/g,
      'make a new machine file with "square" in the field "errors" and fit it, or fit the machine file from before the last fit again with $1 in the field "hold" and $2 in the field "free" of the options of fit',
    )
    .replace(/ \(vernier set MACHINE --stations (\S+) -o NEW\)/g, ` (the button "${kAddStations}$1", in Add after a fit)`)
    .replace(
      / \(import table:? --set "([^"]+)"\)/g,
      (whole, column) =>
        ` under Project: press "read differently" beside the file, and write ${column} into the field "set"${
          column.startsWith('u[') ? ' (of touches of a printer: its number in µm into the field "u")' : ''
        }`,
    )
    .replace(
      /fit --hold NAME, such as --hold "([^"]+)"/g,
      'fit again under Parameters with NAME, such as $1, in the field "hold" of the options of fit',
    )
    .replace(/fit --hold "([^"]+)"/g, 'fit again under Parameters with $1 in the field "hold" of the options of fit');

/** The machine has no field in any panel: it is chosen at the top of the page. */
const atTheTop = (message) =>
  message
    .replace(/ \(--machine MACHINE\)/g, ' (choose it at the top)')
    .replace(/requires --machine\b/g, 'requires a machine (choose it at the top)')
    .replace(/--machine\b/g, 'the choice of a machine at the top');

/** A message of a command in the words of the page: an option that has a field is called by the field. `typed`: the command. */
export function pageWords(said, typed) {
  const message = programWords(said);
  const command = store.commands
    .filter((one) => `${typed ?? ''} `.startsWith(`vernier ${one.name} `))
    .sort((a, b) => b.name.length - a.name.length)[0];
  // A whole command is for the terminal.
  if (!command || /\bvernier [a-z]/.test(message)) return message;
  const has = (name) => command.options.some((one) => one.name === name);
  const accepted = atTheTop(message).replace(/;((?: --accept [\w-]+)+) overrides\s*$/, (whole, list) =>
    has('accept')
      ? `. If you accept this, mark ${list
          .trim()
          .split(/\s*--accept /)
          .filter(Boolean)
          .map((rule) => `"${rule}"`)
          .join(', ')} in the field "accept".`
      : whole,
  );
  // What is chosen among several is stated in the panel of the import.
  const asksFor = (whole, name) =>
    has(name) ? `press "Read it differently" and write its number into the field "${fieldName(name)}"` : whole;
  const field = (name) => `the field "${fieldName(name)}"`;
  // The option is the word in doubt, or has a value: --offset=X,Y is a list, whose field has "; " between two values.
  return (
    accepted
      .replace(/\bgive --([a-z][\w-]*) with its number/g, asksFor)
      .replace(/"--([a-z][\w-]*)": /g, (whole, name) => (has(name) ? `${field(name)}: ` : whole))
      .replace(/--([a-z][\w-]*)=([^\s,;()]+(?:,[^\s,;()]+)*)/g, (whole, name, value) =>
        has(name) ? `"${value.replaceAll(',', '; ')}" in ${field(name)}` : whole,
      )
      // A quoted value, or one of the words of the option.
      .replace(/--([a-z][\w-]*) ("[^"]+"|[a-z][\w-]*)/g, (whole, name, value) => {
        const { words } = command.options.find((one) => one.name === name) ?? {};
        return has(name) && (value.startsWith('"') || words?.includes(value))
          ? `${value.startsWith('"') ? value : `"${value}"`} in ${field(name)}`
          : whole;
      })
      // What stands for a value is no word of a message.
      .replace(/--([a-z][\w-]*)(?: (?:FILE|NAME|NUMBER)\b)?/g, (whole, name) => (has(name) ? field(name) : whole))
  );
}

/** Why rows cannot be read, in the words of the page: a command for the terminal becomes the panel of Project that runs it. */
export const refusalWords = (refusal) =>
  refusal
    .replace(
      /: vernier import table .*? --machine MACHINE\.xml -o NEW\.csv/,
      ': under Project, press "Read the columns as the axes of the machine"',
    )
    .replace(/: vernier import table .*? -o NEW\.csv/, ' under Project')
    .replace(/give the folder of the image \(--images [A-Z]+\)/, 'take the folder of the image into the folder of the project');

/** What stands where there is nothing to show yet: what to choose, or why the chosen rows cannot be read. */
export const nothingYet = () =>
  store.refusal
    ? el('p', { class: 'error', role: 'alert' }, refusalWords(store.refusal), ' ', el('a', { href: '#project' }, 'Project'))
    : el(
        'p',
        { class: 'note empty' },
        'Choose a machine and measurements at the top, or take files in under ',
        el('a', { href: '#project' }, 'Project'),
        '.',
      );

/** A chart of the plotting library with its exports. */
export const figure = (label, options, caption = null) =>
  el('figure', {}, chart(label, options), caption ? el('figcaption', {}, caption) : null);

/** An error in its box: the words, and where they name a line of a file, that line. */
export async function showError(box, error) {
  if (!(error instanceof Refused)) throw error;
  // A place is a file of the project and a line; the address of a board (tcp://host:1502) only looks like one.
  const where = [...error.message.matchAll(/([^\s:"]+):(\d+): /g)].find(([, name]) => named(name));
  box.replaceChildren(el('p', { class: 'error', role: 'alert' }, pageWords(error.message, error.job?.command)));
  if (!where) return;
  try {
    const context = await getJson('/api/lines', { name: where[1], line: where[2] });
    if (!context.lines.length) return; // a workbook: its rows are no lines
    box.append(
      el(
        'pre',
        { class: 'source' },
        context.lines.map((text, i) => {
          const number = context.first + i;
          return el('span', { class: number === Number(where[2]) ? 'bad' : null }, `${String(number).padStart(6)}  ${text}\n`);
        }),
      ),
    );
  } catch {
    /* The file was not kept: its words are all there is. */
  }
}

/** Shows the error of a job where it belongs instead of failing silently. */
export async function guarded(box, act) {
  box.replaceChildren();
  try {
    return await act();
  } catch (error) {
    await showError(box, error);
    return null;
  }
}

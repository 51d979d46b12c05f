// SPDX-License-Identifier: GPL-3.0-or-later
import { el } from '../../../report/web/src/dom.js';
import { freeName, run } from './api.js';
import { kMakeOne } from './begin.js';
import { option, optionFields } from './options.js';
import { button, guarded, pageWords, panel } from './parts.js';

export const kDeclareBed = `A machine file for these touches declares the bed. If yours does not: for a new machine file, "${kMakeOne}" below, options of new, write bed:plane into the field "artefact". For the chosen machine file, "These rows cannot be read", "Declare it".`;

/**
 * Imports a file by a kind of `vernier import` that needs no table of columns: at once where it needs no further options, else its
 * options are asked for. `done(measurement)` is called with the name of the measurement file. `asks`: the options are asked for
 * although none is missing. `earlier`: an import whose options the fields begin with.
 */
export async function importInstrument(box, kind, name, done, asks = false, earlier = null) {
  const command = `import ${kind}`,
    error = el('div', {}),
    fields = optionFields(command, ['file', 'files', 'output']);
  if (earlier?.kind === kind) fields.fill(earlier.given);
  const file = option(command, 'file') ? { file: name } : { files: [name] };
  const act = () =>
    guarded(error, async () => {
      const output = freeName(`${name.replace(/\.[^.]*$/, '')}_read`, '.csv');
      const { text } = await run({ command, ...file, ...fields.values(), output });
      box.replaceChildren(
        panel(
          null,
          el('p', { id: 'imported' }, `${name}: read into `, el('strong', {}, output), '.'),
          el('pre', { class: 'source wrap' }, pageWords(text.trim(), `vernier ${command} `)),
          kind === 'printer' ? el('p', { class: 'note' }, kDeclareBed) : null,
          button('Read it differently', ask, { class: 'quiet', id: 'read-differently' }),
        ),
      );
      await done(output);
      return true;
    });
  const later = (label) => button(label, () => box.replaceChildren(), { class: 'quiet' });
  function ask() {
    // No option makes touches of a configuration without a saved mesh.
    if (/has no touches/.test(error.textContent))
      return box.replaceChildren(
        panel(`There is nothing to import in ${name}`, error, el('p', {}, 'The file stays in the project.'), later('Close')),
      );
    return box.replaceChildren(
      panel(
        `How is ${name} to be read?`,
        error,
        el('div', { class: 'controls' }, fields.elements),
        el('div', { class: 'controls' }, button('Import', act, { id: 'do-import' }), later('Not now')),
      ),
    );
  }
  const missing = fields.required();
  if (missing.length || asks) {
    ask();
    if (!missing.length) return;
    error.replaceChildren(el('p', { class: 'note' }, `State ${missing.map((one) => `"${one}"`).join(', ')}.`));
    return;
  }
  box.replaceChildren(error);
  if (!(await act())) ask();
}

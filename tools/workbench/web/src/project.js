// SPDX-License-Identifier: GPL-3.0-or-later
import { el } from '../../../report/web/src/dom.js';
import { fileAddress, freeName, getJson, postJson, putFile, refresh, run } from './api.js';
import { beginPanel } from './begin.js';
import { optionFields } from './options.js';
import { button, panel, showError } from './parts.js';
import { loadRows } from './rows.js';
import { importSheet } from './sheet.js';
import { stoodPanel } from './stood.js';
import { on, store } from './store.js';

const kKinds = {
  machine: 'machine',
  measurement: 'measurement',
  sheet: 'spreadsheet, to be imported',
  instrument: 'instrument file, to be imported',
  report: 'report',
  image: 'image',
  key: 'key',
  other: '',
};
const size = (bytes) => (bytes < 10000 ? `${bytes} B` : bytes < 1e7 ? `${Math.round(bytes / 1000)} kB` : `${Math.round(bytes / 1e6)} MB`);

/** Choose what everything else is about. */
export async function choose(machine, measurements) {
  store.machine = machine;
  store.measurements = measurements;
  try {
    localStorage.setItem(`chosen:${store.folder}`, JSON.stringify({ machine, measurements }));
  } catch {
    /* private mode */
  }
  await loadRows();
}

const kSheet = /\.(csv|xlsx|txt|tsv|dat|asc)$/i;
// What a CSV is, by its name and time: asked once.
const kinds = new Map();

/** Is it a measurement file, or a table that has to be read into one? */
async function isSheet(name) {
  if (!/\.csv$/i.test(name)) return kSheet.test(name);
  const file = store.files.find((one) => one.name === name);
  const key = `${name} ${file?.modified_s} ${file?.bytes}`;
  if (!kinds.has(key))
    kinds.set(
      key,
      getJson('/api/kind', { name }).catch(() => ({ kind: 'measurement' })),
    );
  return (await kinds.get(key)).kind === 'sheet';
}

/** The kind of `vernier import` that reads a file of the project without further options. */
const importerOf = (name) => store.files.find((one) => one.name === name)?.importer;

/** Makes a measurement of a file of the project, as its kind asks for. `beside`: measurements to use with it. */
async function importFile(name, box, repair, beside = []) {
  const done = (output) => choose(store.machine, [...beside, output]);
  const kind = importerOf(name);
  if (kind) {
    const output = freeName(name.replace(/\.[^.]*$/, ''), '.csv');
    const fields = kind === 'ballbar' ? { files: [name], ...repair } : { file: name };
    await run({ command: `import ${kind}`, ...fields, output });
    return done(output);
  }
  return importSheet(box, name, done);
}

/** A dropped file becomes part of the project; what is no measurement file yet is imported. `beside`: measurements to use with it. */
async function take(file, repair, box, beside) {
  const bytes = await file.arrayBuffer();
  const name = file.name.replace(/[\\/:]/g, '_').replace(/^[.\-~ ]+/, '');
  await putFile(name, bytes);
  await refresh();
  if (/\.xml$/i.test(name)) return choose(name, store.measurements);
  if (/\.urdf$/i.test(name)) {
    const stem = name.replace(/\.[^.]*$/, ''),
      output = freeName(stem, '.xml');
    await run({ command: 'new', type: 'robot', urdf: name, output, measurements: freeName(`${stem}_survey`, '.csv') });
    return choose(output, store.measurements);
  }
  if (importerOf(name) || (kSheet.test(name) && (await isSheet(name)))) return importFile(name, box, repair, beside);
  if (/\.csv$/i.test(name)) return choose(store.machine, [...beside, name]);
  return null;
}

/** Shows the line of a dropped file that could not be read: it was not kept, so its text comes from the browser. */
async function showBadLine(box, file, message) {
  const where = message.match(/:(\d+): /);
  box.replaceChildren(el('p', { class: 'error', role: 'alert' }, message));
  if (!where || file.size > 64 << 20) return;
  const lines = (await file.text()).split('\n'),
    at = Number(where[1]);
  box.append(
    el(
      'pre',
      { class: 'source' },
      lines.slice(Math.max(0, at - 3), at + 2).map((text, i) => {
        const number = Math.max(0, at - 3) + i + 1;
        return el('span', { class: number === at ? 'bad' : null }, `${String(number).padStart(6)}  ${text.slice(0, 400)}\n`);
      }),
    ),
  );
}

function fileRow(file, importIt) {
  const usable = { machine: 'use', measurement: 'use', sheet: 'import', instrument: 'import' }[file.kind];
  const act = !usable
    ? null
    : button(
        usable,
        () => {
          if (usable === 'import') return importIt(file.name);
          return file.kind === 'machine' ? choose(file.name, store.measurements) : choose(store.machine, [file.name]);
        },
        { class: 'quiet' },
      );
  const also =
    file.kind === 'measurement' && store.measurements.length && !store.measurements.includes(file.name)
      ? button('use too', () => choose(store.machine, [...store.measurements, file.name]), { class: 'quiet' })
      : null;
  const chosen = file.name === store.machine || store.measurements.includes(file.name);
  return el(
    'tr',
    { class: chosen ? 'chosen' : null },
    el('td', { class: 'text' }, el('a', { href: fileAddress(file.name), target: '_blank', rel: 'noopener' }, file.name)),
    el('td', { class: 'text' }, kKinds[file.kind] ?? ''),
    el('td', { class: 'num' }, size(file.bytes)),
    el('td', { class: 'text' }, act, ' ', also),
  );
}

function history() {
  const box = el('div', { id: 'history' });
  const act = (what) => async () => {
    await postJson('/api/history', { do: what });
    await refresh();
  };
  const draw = () => {
    const items = store.history.map((entry) => el('li', { class: entry.undone ? 'undone' : null }, el('code', {}, entry.command)));
    box.replaceChildren(items.length ? el('ol', {}, items) : el('p', { class: 'note' }, 'Nothing was done yet.'));
  };
  on('project', draw);
  draw();
  return panel(
    'History',
    box,
    el(
      'div',
      { class: 'controls' },
      button('Undo', act('undo'), { class: 'quiet', id: 'undo' }),
      button('Redo', act('redo'), { class: 'quiet', id: 'redo' }),
      el('a', { href: fileAddress('history.sh'), download: 'history.sh' }, 'history.sh'),
      el('span', { class: 'note' }, 'does it all again: a shell script of these commands. Undone steps stay out of it; their files stay.'),
    ),
  );
}

export function projectView(root) {
  const error = el('div', { id: 'drop-error' }),
    box = el('div', { id: 'import-box' });
  const repair = optionFields('import ballbar', ['files', 'output']);
  const pick = el('input', { type: 'file', multiple: '', id: 'file-input', 'aria-label': 'Files to take into the project' });
  const zone = el(
    'div',
    { class: 'drop', id: 'drop' },
    el(
      'p',
      {},
      'Drop what was measured (.csv, .xlsx, .txt, files of an instrument) and machine files (.xml, .urdf) here, or choose them: ',
    ),
    pick,
    repair.elements,
  );
  const takeAll = async (files) => {
    error.replaceChildren();
    // Measurements of one drop belong together: two instruments at one machine.
    const before = new Set(store.measurements);
    for (const file of files) {
      try {
        const beside = store.measurements.filter((name) => !before.has(name));
        await take(file, repair.values(), box, beside);
      } catch (why) {
        await showBadLine(error, file, why.message);
        return;
      }
    }
  };
  pick.addEventListener('change', async () => {
    await takeAll([...pick.files]);
    pick.value = '';
  });
  document.addEventListener('dragover', (event) => {
    event.preventDefault();
    zone.classList.add('over');
  });
  document.addEventListener('dragleave', () => zone.classList.remove('over'));
  document.addEventListener('drop', (event) => {
    event.preventDefault();
    zone.classList.remove('over');
    if (event.dataTransfer?.files.length) takeAll([...event.dataTransfer.files]);
  });
  const files = el('tbody', { id: 'files' });
  const again = async (name) => {
    error.replaceChildren();
    await importFile(name, box, repair.values()).catch((why) => showError(error, why));
  };
  let drawing = 0;
  const draw = async () => {
    const mine = ++drawing;
    files.replaceChildren(...store.files.map((file) => fileRow(file, again)));
    const known = await Promise.all(
      store.files.map(async (file) => (file.kind === 'measurement' && (await isSheet(file.name)) ? { ...file, kind: 'sheet' } : file)),
    );
    if (mine === drawing) files.replaceChildren(...known.map((file) => fileRow(file, again)));
  };
  on('project', draw);
  on('rows', draw);
  draw();
  root.append(
    panel('Take in', zone, error),
    box,
    stoodPanel(choose),
    beginPanel(choose),
    panel(
      'Files',
      el(
        'div',
        { class: 'scroll' },
        el(
          'table',
          {},
          el(
            'thead',
            {},
            el(
              'tr',
              {},
              ['name', 'is', 'size', ''].map((name) => el('th', { class: 'text' }, name)),
            ),
          ),
          files,
        ),
      ),
    ),
    history(),
  );
  return { show() {} };
}

// SPDX-License-Identifier: GPL-3.0-or-later
import { el } from '../../../report/web/src/dom.js';
import { deleteFile, fileAddress, freeName, getJson, postJson, putFile, refresh, run } from './api.js';
import { beginPanel } from './begin.js';
import { importInstrument } from './instrument.js';
import { optionFields } from './options.js';
import { button, guarded, panel, showError } from './parts.js';
import { kReflector } from './reflector.js';
import { lintPanel } from './lint.js';
import { choose } from './rows.js';
import { importSheet } from './sheet.js';
import { stoodPanel } from './stood.js';
import { on, store } from './store.js';
import { adviceOn, forget, importThatMade, kindAction, kindOf, kindOfName, kindWords, readInto, sourceOf } from './uses.js';

const size = (bytes) => (bytes < 10000 ? `${bytes} B` : bytes < 1e7 ? `${Math.round(bytes / 1000)} kB` : `${Math.round(bytes / 1e6)} MB`);

/** Chooses measurements in the place of others; the next call, in the place of those that this one has chosen. */
function inPlaceOf(replaced) {
  let old = replaced;
  return (outputs) => {
    const at = store.measurements.findIndex((one) => old.includes(one)),
      chosen = store.measurements.filter((one) => !old.includes(one) && !outputs.includes(one));
    chosen.splice(at < 0 ? chosen.length : at, 0, ...outputs);
    old = outputs;
    return choose(store.machine, chosen);
  };
}

/** Chooses measurements in the place of others, which one press chooses again: two instruments can have measured one machine. */
async function chooseInstead(measurements, box) {
  const before = store.measurements.filter((one) => !measurements.includes(one));
  await choose(store.machine, measurements);
  if (!before.length) return;
  const together = () => {
    note.remove();
    return choose(store.machine, [...new Set([...before, ...store.measurements])]);
  };
  const note = el(
    'div',
    { class: 'controls chosen-instead' },
    el('span', { class: 'note', role: 'status' }, `Chosen in the place of ${before.join(', ')}.`),
    button('Use all of them together', together, { class: 'quiet', id: 'use-together' }),
  );
  box.append(note);
}

/**
 * Makes a measurement of a file of the project, as its kind asks for. `beside`: measurements to use with it; `again`: a table is
 * shown although it can be read without help, because it was read before, and may have another sheet to read.
 */
async function importFile(name, kind, box, repair, { beside, again }) {
  const done = (output) => chooseInstead([...beside, output], box);
  if (kind === 'printer') return importInstrument(box, 'printer', name, done);
  if (kind === 'trace') return importInstrument(box, 'ballbar-trace', name, done);
  if (kind === 'instrument') {
    const { importer } = store.files.find((one) => one.name === name);
    const output = freeName(name.replace(/\.[^.]*$/, ''), '.csv');
    const fields = importer === 'ballbar' ? { files: [name], ...repair } : { file: name };
    await run({ command: `import ${importer}`, ...fields, output });
    return done(output);
  }
  // Later sheets, and a sheet that is read differently, come beside what was chosen in the meantime.
  let later = null;
  return importSheet(
    box,
    name,
    (outputs) => {
      if (later) return later(outputs);
      later = inPlaceOf(outputs);
      return chooseInstead([...beside, ...outputs], box);
    },
    again,
    again ? importThatMade(readInto(name)[0]) : null,
  );
}

/** The questions without an answer: {words, node, end()}. */
const asked_now = new Set();
const questionAbout = (name) => [...asked_now].find((one) => one.words.startsWith(`${name}: `));

/**
 * Asks in a box, with a button for each answer [label, value]; the first answer is the usual one, the last one changes nothing. The
 * question stays until it is answered.
 */
function question(box, words, answers) {
  return new Promise((answered) => {
    const end = (value) => {
      asked_now.delete(one);
      node.remove();
      answered(value);
    };
    const node = el(
      'div',
      { class: 'question', role: 'alertdialog', 'aria-label': words },
      el('p', {}, words),
      el(
        'div',
        { class: 'controls' },
        answers.map(([label, value], i) => button(label, () => end(value), { class: i ? 'quiet' : null, 'data-answer': value })),
      ),
    );
    const one = { words, node, end: () => end(answers.at(-1)[1]) };
    asked_now.add(one);
    box.append(node);
    show(node);
  });
}

function show(node) {
  node.querySelector('button').focus();
  node.scrollIntoView({ block: 'nearest' });
}

/** A machine file for the description of a robot; which of several end links is the tool, and what is measured, is asked in a box. */
async function machineOfRobot(name, ask) {
  const open = questionAbout(name);
  if (open) return show(open.node);
  const stem = name.replace(/\.[^.]*$/, ''),
    { ends } = await getJson('/api/robot', { name }),
    // The usual name of the tool's link (ROS-Industrial) first.
    order = [...ends.filter((one) => one === 'tool0'), ...ends.filter((one) => one !== 'tool0')];
  let link = null;
  if (order.length > 1) {
    link = await question(ask, `${name}: the arm has several end links. Which of them carries the tool that is measured?`, [
      ...order.map((one) => [one, one]),
      ['Not now', ''],
    ]);
    if (!link) return null;
  }
  const tip = link ? { tip: link } : {};
  const measured = await question(ask, `${name}: what does the instrument measure at the tool?`, [
    [`${kReflector}: the fit finds it`, 'reflector'],
    [`The point of ${link ?? order[0] ?? 'the last link'} itself, or one whose place I state later`, 'point'],
    ['Not now', ''],
  ]);
  if (!measured) return null;
  const reflector = measured === 'reflector' ? { reflector: true } : {};
  const output = freeName(stem, '.xml');
  await run({ command: 'new', type: 'robot', urdf: name, ...tip, ...reflector, output, measurements: freeName(`${stem}_survey`, '.csv') });
  return choose(output, store.measurements);
}

/** Uses a file of the project: chooses it, or makes a measurement or a machine file of it. `ask`: the box for a question. */
async function use(name, kind, { box, repair, ask, beside = [], again = false }) {
  if (kind === 'machine') return choose(name, store.measurements);
  if (kind === 'robot') return machineOfRobot(name, ask);
  if (kind === 'measurement') return chooseInstead([...beside, name], box);
  return importFile(name, kind, box, repair, { beside, again });
}

/** Does a command of the history read a file or write it? */
const inHistory = (name, what) =>
  store.history.some((one) => !one.undone && (one.outputs ?? []).includes(name) === (what === 'written') && one.command.includes(name));

const kNotAgain = ' Commands of the history used it: history.sh then does not make the same files again.';

/** The name under which a dropped file is kept; null: it is not to be kept. */
async function nameToKeep(file, ask) {
  const name = file.name.replace(/[\\/:]/g, '_').replace(/^[.\-~ ]+/, '');
  if (!store.files.some((one) => one.name === name)) return { name, replace: false };
  const other = freeName(name.replace(/\.[^.]*$/, ''), name.match(/\.[^.]*$/)?.[0] ?? '');
  const answer = await question(
    ask,
    `${name}: the project has a file of this name. Replace it?${inHistory(name, 'read') ? kNotAgain : ''}`,
    [
      ['Replace', 'replace'],
      [`Keep both, the new one as ${other}`, 'both'],
      ['Do not take it in', 'none'],
    ],
  );
  if (answer === 'none') return null;
  return answer === 'both' ? { name: other, replace: false } : { name, replace: true };
}

/** Deletes a file of the project after a question. */
async function deleteAsked(name, ask) {
  const words = inHistory(name, 'written')
    ? ' A command of the history wrote it: history.sh makes it again.'
    : inHistory(name, 'read')
      ? kNotAgain
      : '';
  const answer = await question(ask, `Delete ${name}? It cannot be brought back.${words}`, [
    ['Delete', 'delete'],
    ['Keep it', 'keep'],
  ]);
  if (answer !== 'delete') return;
  await deleteFile(name);
  await refresh();
  if (name === store.machine || store.measurements.includes(name))
    await choose(
      name === store.machine ? '' : store.machine,
      store.measurements.filter((one) => one !== name),
    );
}

/** A dropped file becomes part of the project; what is no measurement file yet is imported. `beside`: measurements to use with it. */
async function take(file, { repair, boxOf, beside, ask, notes }) {
  const kept = await nameToKeep(file, ask);
  if (!kept) return;
  const { name } = kept;
  await putFile(name, await file.arrayBuffer(), kept.replace);
  forget(name);
  questionAbout(name)?.end(); // of the file that was replaced
  await refresh();
  const kind = await kindOfName(name),
    advice = adviceOn(kind);
  if (!advice) {
    await use(name, kind, { box: boxOf(name), repair, ask, beside });
    return;
  }
  const note = el('p', { class: 'note', role: 'status', 'data-advice': name }, `${name} ${advice} `);
  if (!kindAction(kind) && ['workbook', 'unused'].includes(kind))
    note.append(
      button(
        'Delete it',
        async () => {
          await deleteFile(name);
          note.remove();
          await refresh();
        },
        { class: 'quiet' },
      ),
    );
  notes.append(note);
}

/** Shows the line of a dropped file that could not be read: it was not kept, so its text comes from the browser. */
async function showBadLine(box, file, message) {
  const where = message.match(/:(\d+): /);
  box.replaceChildren(el('p', { class: 'error', role: 'alert' }, message));
  // The rows of a workbook are no lines.
  if (!where || file.size > 64 << 20 || /\.(xlsx|xls|ods)$/i.test(file.name)) return;
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

function fileRow(file, kind, act) {
  const { name } = file,
    label = kindAction(kind);
  const also =
    kind === 'measurement' && store.measurements.length && !store.measurements.includes(name)
      ? button('use too', () => choose(store.machine, [...store.measurements, name]), { class: 'quiet' })
      : null;
  const differently =
    kind === 'measurement' ? button('read differently', () => act.differently(name), { class: 'quiet differently' }) : null;
  const chosen = name === store.machine || store.measurements.includes(name);
  const made = label === 'import' ? readInto(name) : [];
  // A report is opened; anything else is saved under its name.
  const link = kind === 'report' ? { target: '_blank', rel: 'noopener' } : { download: name.replace(/.*\//, '') };
  return el(
    'tr',
    { class: chosen ? 'chosen' : null, 'data-file': name, 'data-kind': kind },
    el('td', { class: 'text' }, el('a', { href: fileAddress(name), ...link }, name)),
    el('td', { class: 'text' }, made.length ? kindWords(kind).replace('to be imported', `read into ${made.join(', ')}`) : kindWords(kind)),
    el('td', { class: 'num' }, size(file.bytes)),
    el(
      'td',
      { class: 'text' },
      label ? button(made.length ? 'import again' : label, () => act.use(name, kind), { class: 'quiet use' }) : null,
      ' ',
      also,
      ' ',
      differently,
      ' ',
      button('delete', () => act.remove(name), { class: 'quiet delete', 'aria-label': `delete ${name}` }),
    ),
  );
}

function history() {
  const box = el('div', { id: 'history' });
  const error = el('div', {});
  const act = (what) => () =>
    guarded(error, async () => {
      await postJson('/api/history', { do: what });
      await refresh();
    });
  const draw = () => {
    const items = store.history.map((entry) => el('li', { class: entry.undone ? 'undone' : null }, el('code', {}, entry.command)));
    box.replaceChildren(items.length ? el('ol', {}, items) : el('p', { class: 'note' }, 'Nothing was done yet.'));
  };
  on('project', draw);
  draw();
  return panel(
    'History',
    error,
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
  const error = el('div', {}),
    questions = el('div', {}),
    notes = el('div', { id: 'drop-notes' }),
    box = el('div', { id: 'import-box' });
  const repair = optionFields('import ballbar', ['files', 'output']);
  /** Another panel has made what was refused here: the refusal is out of date. */
  const chooseAnew = (machine, measurements) => {
    error.replaceChildren();
    return choose(machine, measurements);
  };
  const pick = el('input', { type: 'file', multiple: '', id: 'file-input', 'aria-label': 'Files to take into the project' });
  const zone = el(
    'div',
    { class: 'drop', id: 'drop' },
    el(
      'p',
      {},
      'Drop what was measured (.csv, .xlsx, .txt, files of an instrument, printer.cfg or klippy.log of a 3D printer) and machine files (.xml, .urdf) here, or choose them: ',
    ),
    pick,
    repair.elements,
  );
  /** Each file has a box of its own: the sheets and notes of a workbook stay beside those of the next file. */
  const boxOf = (name) => {
    const old = [...box.children].find((one) => one.dataset.of === name);
    const own = el('div', { 'data-of': name });
    own.addEventListener('change', () => {
      own.dataset.typed = 'yes';
    });
    old?.remove();
    box.prepend(own);
    return own;
  };
  const takeAll = async (files) => {
    error.replaceChildren();
    notes.replaceChildren();
    // Sheets that nobody has imported yet stay within reach, and so do the answers that were typed for a file that asks.
    for (const one of [...box.children])
      if (!one.querySelector('.other-sheets') && !(one.dataset.typed && one.querySelector('#do-import'))) one.remove();
    // Measurements of one drop belong together: two instruments at one machine.
    const before = new Set(store.measurements);
    for (const file of files) {
      try {
        const beside = store.measurements.filter((name) => !before.has(name));
        await take(file, { repair: repair.values(), boxOf, beside, ask: questions, notes });
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
  const asked = el('div', { id: 'file-error' });
  const byTable = async (name, done, earlier = null) => {
    const own = boxOf(name);
    await importSheet(own, name, done, true, earlier);
    own.scrollIntoView({ block: 'nearest' });
  };
  const act = {
    // What was dropped is read again with the answers of the first time, not the table that was made of it.
    differently: async (name) => {
      const source = sourceOf(name),
        earlier = source === name ? null : importThatMade(name),
        instead = inPlaceOf([name]);
      const kind = source === name ? 'sheet' : await kindOfName(source);
      if (kind === 'sheet' || kind === 'measurement') return byTable(source, instead, earlier);
      const { importer } = store.files.find((one) => one.name === source);
      const own = boxOf(source);
      await importInstrument(
        own,
        kind === 'trace' ? 'ballbar-trace' : (importer ?? kind),
        source,
        (output) => instead([output]),
        true,
        earlier,
      );
      return own.scrollIntoView({ block: 'nearest' });
    },
    use: async (name, kind) => {
      error.replaceChildren();
      const own = boxOf(name),
        again = readInto(name).length > 0;
      await use(name, kind, { box: own, repair: repair.values(), ask: questions, again }).catch((why) => showError(error, why));
      // The panel that asks about a file is above the table.
      if (own.childElementCount) own.scrollIntoView({ block: 'nearest' });
    },
    remove: (name) => guarded(asked, () => deleteAsked(name, asked)),
  };
  let drawing = 0;
  const draw = async () => {
    const mine = ++drawing;
    const known = await Promise.all(store.files.map(async (file) => [file, await kindOf(file)]));
    if (mine === drawing) files.replaceChildren(...known.map(([file, kind]) => fileRow(file, kind, act)));
  };
  on('project', draw);
  on('rows', draw);
  draw();
  root.append(
    panel('Take in', zone, el('div', { id: 'drop-error' }, questions, error), notes),
    box,
    stoodPanel(chooseAnew, byTable),
    beginPanel(chooseAnew),
    panel(
      'Files',
      asked,
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
    lintPanel(),
    history(),
  );
  return { show() {} };
}

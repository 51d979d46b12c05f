// SPDX-License-Identifier: GPL-3.0-or-later
import { choice, el } from '../../../report/web/src/dom.js';
import { freeName, postJson, run } from './api.js';
import { button, guarded, panel } from './parts.js';
import { store } from './store.js';

/** Columns that only the import of a tracker or of a probe understands. */
const kTracker = new Set(['rX', 'rY', 'rZ', 'qw', 'qx', 'qy', 'qz']),
  kProbe = new Set(['mx', 'my', 'mz', 'nx', 'ny', 'nz']);
const kReadAs = [
  ['table', 'a spreadsheet'],
  ['tracker', 'points of a laser tracker'],
  ['probe', 'touches of a probe'],
];

function likely(preview) {
  const names = preview.columns.map((one) => one.name);
  if (preview.workbook) return 'table';
  if (names.filter((name) => kProbe.has(name)).length >= 3) return 'probe';
  return names.some((name) => kTracker.has(name)) ? 'tracker' : 'table';
}

const withUnit = (one) => `${one.name}${one.unit ? `[${one.unit}]` : ''}`;

/** The fields of `vernier import` for what stands on the panel. */
function request(name, kind, wishes, preview) {
  const separator = preview.separator === 'blanks' ? 'space' : preview.separator;
  if (kind === 'table')
    return {
      command: 'import',
      kind,
      files: [name],
      ...(wishes.separator ? { separator: wishes.separator } : {}),
      ...(wishes.decimal ? { decimal: wishes.decimal } : {}),
      ...(wishes.sheet ? { sheet: wishes.sheet } : {}),
      ...(wishes.unit ? { unit: wishes.unit } : {}),
      ...(wishes.columns.length ? { columns: wishes.columns } : {}),
      ...(wishes.deviations.length ? { deviations: wishes.deviations } : {}),
      ...(wishes.leave.length ? { leave: wishes.leave } : {}),
      ...(wishes.checkEvery ? { check_every: wishes.checkEvery } : {}),
    };
  return {
    command: 'import',
    kind,
    files: [name],
    separator,
    decimal: preview.decimal,
    skip: (preview.heading_line ?? 1) - 1,
    header: true,
    columns: preview.columns.filter((one) => one.use === 'column').map((one) => `${one.heading}=${withUnit(one)}`),
    ...(wishes.checkEvery ? { check_every: wishes.checkEvery } : {}),
  };
}

/** One column: its heading, its first cells, and what it is; a change is a wish. */
function columnRow(column, k, preview, change) {
  const use = choice(
    '',
    [
      ['column', 'is'],
      ['deviation', 'deviation of'],
      ['left', 'left out'],
    ],
    column.use,
    () => tell(),
  );
  use.querySelector('select').setAttribute('aria-label', `use of column ${k + 1}`);
  const input = (value, label, size) => {
    const node = el('input', { type: 'text', value, size, 'aria-label': `${label} of column ${k + 1}`, spellcheck: 'false' });
    node.style.minWidth = '0';
    node.addEventListener('change', () => tell());
    return node;
  };
  const name = input(column.name, 'name', 8),
    unit = input(column.unit, 'unit', 5);
  const tell = () => change(k, { use: use.querySelector('select').value, name: name.value.trim(), unit: unit.value.trim() });
  return el(
    'tr',
    { 'data-column': column.name },
    el('td', { class: 'text' }, column.heading),
    el(
      'td',
      { class: 'text note' },
      preview.rows
        .slice(0, 3)
        .map((row) => row[k])
        .join('  '),
    ),
    el('td', {}, use, ' ', name, ' ', unit),
    el('td', { class: 'text note' }, column.why),
  );
}

/**
 * Takes a spreadsheet, a tracker's or a probe's table: what is understood without help is imported at once, what is not is
 * asked for here. `done(measurement)` is called with the name of the measurement file.
 */
export async function importSheet(box, name, done) {
  const wishes = { separator: '', decimal: '', sheet: '', unit: '', checkEvery: 0, columns: [], deviations: [], leave: [] };
  const said = new Map();
  let kind = null,
    turn = 0;
  const error = el('div', {});
  const ask = () =>
    postJson('/api/sheet', {
      name,
      machine: store.machine,
      ...Object.fromEntries(Object.entries(wishes).filter(([, value]) => typeof value === 'string' && value)),
      columns: wishes.columns,
      deviations: wishes.deviations,
      leave: wishes.leave,
    });
  const doImport = (preview) =>
    guarded(error, async () => {
      const output = freeName(`${name.replace(/\.[^.]*$/, '')}_read`, '.csv');
      await run({ ...request(name, kind, wishes, preview), output });
      box.replaceChildren(panel(null, el('p', { id: 'imported' }, `${name}: ${preview.how}. Read into `, el('strong', {}, output), '.')));
      await done(output);
    });
  const assign = () => {
    for (const list of ['columns', 'deviations', 'leave']) wishes[list] = [];
    for (const [k, one] of said) {
      if (one.use === 'left') wishes.leave.push(String(k + 1));
      else if (one.use === 'deviation') wishes.deviations.push(`${withUnit(one)}=${k + 1}`);
      else wishes.columns.push(`${withUnit(one)}=${k + 1}`);
    }
    return draw();
  };
  const wish = (key) => (value) => {
    wishes[key] = value;
    return draw();
  };
  async function draw(preview = null) {
    const mine = ++turn;
    error.replaceChildren();
    const now = preview ?? (await guarded(error, ask));
    if (mine !== turn) return null; // asked anew in the meantime
    if (!now) return box.replaceChildren(error);
    kind ??= likely(now);
    const go = button('Import', () => doImport(now), { id: 'do-import' });
    go.disabled = kind === 'table' && now.message !== null;
    const units = ['', 'mm', 'um', 'm', 'deg', 'inch'].map((one) => [one, one || 'as written']);
    box.replaceChildren(
      panel(
        `What is in ${name}?`,
        el('p', { id: 'how-read' }, now.how),
        now.message && kind === 'table' ? el('p', { class: 'error', role: 'alert', id: 'sheet-message' }, now.message) : null,
        el(
          'div',
          { class: 'controls' },
          choice('read as', kReadAs, kind, (value) => {
            kind = value;
            return draw(now);
          }),
          choice(
            'decimal sign',
            [
              ['', 'guessed'],
              ['comma', 'comma'],
              ['point', 'point'],
            ],
            wishes.decimal,
            wish('decimal'),
          ),
          choice(
            'columns separated by',
            [
              ['', 'guessed'],
              ['semicolon', ';'],
              ['comma', ','],
              ['tab', 'tab'],
              ['space', 'blanks'],
            ],
            wishes.separator,
            wish('separator'),
          ),
          choice('unit where a heading has none', units, wishes.unit, wish('unit')),
          choice(
            'kept from the fit as check rows',
            [
              ['0', 'none'],
              ['4', 'every 4th'],
              ['5', 'every 5th'],
            ],
            String(wishes.checkEvery),
            (value) => {
              wishes.checkEvery = Number(value);
            },
          ),
        ),
        el(
          'div',
          { class: 'scroll' },
          el(
            'table',
            { id: 'sheet-columns' },
            el(
              'thead',
              {},
              el(
                'tr',
                {},
                ['heading', 'first cells', 'what it is', ''].map((words) => el('th', { class: 'text' }, words)),
              ),
            ),
            el(
              'tbody',
              {},
              now.columns.map((column, k) =>
                columnRow(column, k, now, (at, one) => {
                  said.set(at, one);
                  return assign();
                }),
              ),
            ),
          ),
        ),
        now.csv.length ? el('pre', { class: 'source', 'aria-label': 'first rows of the measurement file' }, now.csv.join('\n')) : null,
        el(
          'div',
          { class: 'controls' },
          go,
          button('Not now', () => box.replaceChildren(), { class: 'quiet' }),
        ),
        error,
      ),
    );
    return null;
  }
  box.replaceChildren(error);
  const first = await guarded(error, ask);
  if (!first) return;
  kind = likely(first);
  if (first.message === null && kind === 'table') await doImport(first);
  else await draw(first);
}

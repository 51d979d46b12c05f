// SPDX-License-Identifier: GPL-3.0-or-later
import { choice, el } from '../../../report/web/src/dom.js';
import { freeName, getJson, postJson, Refused, run } from './api.js';
import { byMachine, confirmed, kNames, pairsOf, wordsProposed } from './joints.js';
import { optionFields } from './options.js';
import { button, gate, guarded, pageWords, panel, showError } from './parts.js';
import { pointFields, pointsOnPage, pointWords } from './points.js';
import { choose } from './rows.js';
import { declareReflector, kReflector } from './reflector.js';
import { on, store } from './store.js';

/** Columns that only the import of a tracker or of a probe understands. */
const kTracker = new Set(['rX', 'rY', 'rZ', 'qw', 'qx', 'qy', 'qz']),
  kProbe = new Set(['mx', 'my', 'mz', 'nx', 'ny', 'nz']);
const kReadAs = [
  ['table', 'a spreadsheet'],
  ['tracker', 'points of a laser tracker'],
  ['probe', 'touches of a probe'],
];

/** The unit of a tracker's points whose headings have none: a proposal, which the panel shows. */
const kUsualUnit = 'mm';

/** Words above the names of points. */
const kPointName = /^(name|point|punkt|punktname|id)$/i;

/** The columns of points without headings, in the order x, y, z; before them their names, if the first column has words. */
function pointsWithoutHeadings(preview) {
  const isNumber = (cell) => cell.trim() !== '' && Number.isFinite(Number(cell.trim().replace(',', '.')));
  // Names that are numbers count the points, in whatever order; coordinates have decimals.
  const whole = (cell) => /^\d+$/.test(cell.trim()),
    names = new Set(preview.rows.map((row) => row[0].trim()));
  const counts =
    names.size > 1 &&
    names.size === preview.rows.length &&
    preview.rows.every((row) => whole(row[0])) &&
    preview.rows.some((row) => row.slice(1).some((cell) => !whole(cell)));
  const first = preview.rows.every((row) => isNumber(row[0])) && !(preview.columns.length === 4 && counts) ? 0 : 1;
  const right = preview.columns.length === first + 3 && preview.rows.every((row) => row.slice(first).every(isNumber));
  if (!right) return [];
  return [
    ...['x', 'y', 'z'].map((name, k) => [first + k, { use: 'column', name, unit: kUsualUnit }]),
    ...(first ? [[0, { use: 'column', name: 'point', unit: '' }]] : []),
  ];
}

/**
 * The columns of points without positions of the axes, as a tracker writes them (Name, X, Y, Z): [[column, {use, name, unit}]];
 * empty: not such a table. Without a machine, or of a machine with axes of these names, the user must have said that it is one (`stated`).
 */
function pointsOfATracker(preview, axes, stated = false) {
  const named = (name) => !stated && axes.some((axis) => axis.name.toLowerCase() === name.toLowerCase());
  const asked = axes.length > 0 || stated;
  if (asked && !preview.workbook && preview.heading_line == null && !['x', 'y', 'z'].some(named)) return pointsWithoutHeadings(preview);
  const xyz = preview.columns.map((one, k) => [k, one]).filter(([, one]) => /^[xyz]$/i.test(one.name));
  const rest = preview.columns.length - xyz.length;
  if (!asked || preview.workbook || xyz.length !== 3 || rest > 2 || preview.columns.some((one) => named(one.name))) return [];
  const names = preview.columns.map((one, k) => [k, one]).filter(([, one]) => kPointName.test(one.name));
  return [
    ...xyz.map(([k, one]) => [k, { use: 'column', name: one.name.toLowerCase(), unit: one.unit || kUsualUnit }]),
    ...names.slice(0, 1).map(([k]) => [k, { use: 'column', name: 'point', unit: '' }]),
  ];
}

/** Of joints alone, and not of three: four columns of numbers can be neither its positions nor readings along an axis. */
const isRobot = (axes) => axes.length > 3 && axes.every(({ unit }) => unit === 'deg');

function likely(preview, axes) {
  const names = preview.columns.map((one) => one.name);
  if (preview.workbook) return 'table';
  if (pointsOfATracker(preview, axes).length) return 'tracker';
  if (names.filter((name) => kProbe.has(name)).length >= 3) return 'probe';
  return names.some((name) => kTracker.has(name)) ? 'tracker' : 'table';
}

const withUnit = (one) => `${one.name}${one.unit ? `[${one.unit}]` : ''}`;

const kWhereItStood =
  'Where did the machine stand at each point? In the field "nominal", choose the file of the project with the positions of the axes: one row for each point, with the names of the points or in the same order.';

/** What the table of columns and the preview say; all other options of the import have fields. */
const kInTable = ['file', 'output', 'column', 'deviation', 'leave', 'sheet', 'machine', 'point'];
const kOfPreview = [...kInTable, 'header'];
/** The unit in which the program found that the points agree with their positions; undefined: in none. */
const unitOfPoints = (message) => message.match(/With the points in \[(\w+)\] in the place of \[\w+\] they agree/)?.[1];
/** A refusal that ends with a call for the terminal: the words before the call. */
const beforeTheCall = (message) =>
  message
    .replace(
      /: if the columns are x, y and z of the points, give: .*$/s,
      ': state them in the table. If nothing else was measured, give each other column a name of your own.',
    )
    .replace(/: write x\[(\w+)\], y\[\w+\], z\[\w+\](?:, give: vernier import .*)?$/s, ': press "The points are in $1".')
    .replace(/, give: vernier import .*$/s, ', press "This assignment is right".')
    .replace(
      / with a heading of the list in the place of HEADING (\(.*\)), and the unit of the values: vernier import .*$/s,
      ' $1, in the field "nominal column", such as joint_1[deg]=A1; joint_2[deg]=A2',
    );

/** How the text is read: with another answer of these the preview is another. */
const kOfText = ['separator', 'decimal', 'skip', 'comment'];
const ofText = (values) => Object.fromEntries(Object.entries(values).filter(([name]) => kOfText.includes(name)));

/** The name of a sheet as a part of the name of a file. */
const inFileName = (sheet) => sheet.replace(/[\s/\\:]+/g, '_');

/** What the program says of a spreadsheet, in the words of the table of columns. */
function onPage(whole) {
  const message = whole.replace(
    /If they are points that an instrument measured.* is the LIST of this command/,
    'If they are points that an instrument measured, choose "points of a laser tracker" in the field "read as". If they are positions of the axes, choose this file in the field "nominal" of the points',
  );
  if (/\bvernier [a-z]/.test(message)) return message;
  const words = pointsOnPage(message)
    .replace(/; --preview shows.*$/, '')
    .replace(/ \(for all columns of this machine: --deviation [^)]*\)/, '')
    .replace(/--column "([^"=]+)=([^"]+)"/g, '"$2" is $1')
    .replace(/--deviation "([^"=]+)=([^"]+)"/g, '"$2" is a deviation of $1')
    .replace(/--leave\b/g, '"left out"');
  return pageWords(words, 'vernier import table');
}

/** The axes of a machine file: [{name, unit}]; empty if they cannot be read. */
const axesOf = (machine) =>
  getJson('/api/names', { machine }).then(
    ({ names }) => names.filter((one) => one.what === 'axis position'),
    () => [],
  );

/** The options of an import without the preview's help: a tracker's and a probe's table. `typed`: the fields of the text. */
function ofPreview(preview, typed) {
  // A table without headings has none: the first point must not be taken for them.
  const named = preview.heading_line != null;
  return {
    separator: preview.separator === 'blanks' ? 'space' : preview.separator,
    decimal: preview.decimal,
    skip: named ? preview.heading_line - 1 : (typed.skip ?? 0),
    header: named,
    column: preview.columns
      .map((one, k) => ({ ...one, source: named ? one.heading : k + 1 }))
      .filter((one) => one.use === 'column')
      .map((one) => `${one.source}=${withUnit(one)}`),
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
  const tell = () => {
    // "x[mm]" in the field of the name, as messages write it, is a name and its unit.
    const both = name.value.match(/^\s*([^[\]]*?)\s*\[([^\]]*)\]\s*$/);
    if (both) {
      [, name.value, unit.value] = both;
    }
    change(k, { use: use.querySelector('select').value, name: name.value.trim(), unit: unit.value.trim() });
  };
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
 * asked for here. `handOver(measurements)` is called with the names of the measurement files: one for each sheet that was imported.
 * `asks`: the meaning of the columns is asked for although nothing is missing. `earlier`: an import of this file (importThatMade)
 * whose answers the fields and the table of columns begin with.
 */
export async function importSheet(box, name, handOver, asks = false, earlier = null) {
  const said = new Map(),
    points = new Map(), // typed positions of points, by name
    read_into = new Map(), // the measurement file of each sheet that was imported
    tables = new Set(); // the sheets to import; two sheets that are read as one table count as one
  let kind = null,
    proposed = false, // a unit that no heading states
    axes = [], // of the chosen machine
    sheet = '', // of a workbook; empty: the program's choice
    turn = 0,
    machine_of_earlier = '',
    remembered = earlier;
  const error = el('div', {});
  const forms = Object.fromEntries(
    kReadAs.map(([one]) => [
      one,
      optionFields(`import ${one}`, one === 'table' ? kInTable : kOfPreview, ({ currentTarget: field }) => {
        if (one === 'table' || kOfText.includes(field.dataset.option)) draw();
      }),
    ]),
  );
  /** The table of columns as options of `import table`. */
  const columns = () => {
    const lists = { leave: [], deviation: [], column: [] };
    for (const [k, one] of said) {
      if (one.use === 'left') lists.leave.push(String(k + 1));
      else lists[one.use].push(`${withUnit(one)}=${k + 1}`);
    }
    return Object.fromEntries(Object.entries(lists).filter(([, list]) => list.length));
  };
  const ofSheet = () => (sheet ? { sheet } : {});
  /** The positions of the points of distances, in the order of the axes of the machine. */
  const ofPoints = () => {
    const point = pointWords(points);
    return point.length ? { point } : {};
  };
  const ask = () =>
    postJson('/api/sheet', {
      name,
      machine: store.machine,
      ...ofSheet(),
      ...(kind === null || kind === 'table' ? forms.table.values() : ofText(forms[kind].values())),
      ...columns(),
      ...ofPoints(),
    }).catch((why) => {
      why.message = onPage(why.message);
      throw why;
    });
  /** Points that are no tool points of the machine file: the reflector is declared, and the points are read again. */
  const offerReflector = (preview) => {
    if (/press "A reflector/.test(error.textContent) && store.machine)
      error.append(
        button(
          kReflector,
          () =>
            guarded(error, async () => {
              await choose(await declareReflector(), store.measurements);
              await doImport(preview);
            }),
          { id: 'import-reflector' },
        ),
      );
  };
  /** Columns of the list of nominal positions that probably are the axes: the button writes them into the field, and goes on. */
  const offerColumns = (preview, assigned) => {
    if (!assigned.length) return;
    error.append(
      ...confirmed(
        pairsOf(assigned),
        () => {
          const field = forms[kind].elements.map((one) => one.querySelector('[data-option="nominal-column"]')).find(Boolean);
          field.value = assigned.join('; ');
          return doImport(preview);
        },
        'nominal-is-right',
      ),
    );
    error.scrollIntoView({ block: 'nearest' });
  };
  /** Points that agree with their positions in another unit: the button states it, and goes on. */
  const offerUnit = (preview) => {
    const unit = unitOfPoints(error.textContent);
    if (!unit) return;
    const go = button(
      `The points are in ${unit}`,
      () => {
        const in_unit = preview.columns.map((one) => (one.use === 'column' && /^[xyz]$/.test(one.name) ? { ...one, unit } : one));
        for (const k of said.keys()) said.set(k, { ...said.get(k), unit: in_unit[k].unit });
        return doImport({ ...preview, columns: in_unit });
      },
      { id: 'unit-is-right' },
    );
    error.append(go);
    error.scrollIntoView({ block: 'nearest' });
  };
  const doImport = async (preview) => {
    const assigned = await importNow(preview);
    offerReflector(preview);
    offerUnit(preview);
    offerColumns(preview, assigned ?? []);
  };
  const importNow = (preview) =>
    guarded(error, async () => {
      const several = preview.sheets.length > 1;
      const output = freeName(`${name.replace(/\.[^.]*$/, '')}_${several && sheet ? inFileName(sheet) : 'read'}`, '.csv');
      const options = kind === 'table' ? { ...ofSheet(), ...columns(), ...ofPoints() } : {};
      // The preview has read the text with the answers of the fields, and knows the rest.
      const values = { ...forms[kind].values(), ...(kind === 'table' ? {} : ofPreview(preview, forms[kind].values())) };
      // The list of nominal positions, and the position of a point, have the axes of the machine.
      const of = store.machine || machine_of_earlier,
        machine = (values.nominal || options.point) && of ? { machine: of } : {};
      let text = '';
      try {
        ({ text } = await run({ command: `import ${kind}`, file: name, ...options, ...values, ...machine, output }));
      } catch (why) {
        if (!(why instanceof Refused)) throw why;
        const assigned = wordsProposed(why.message, 'nominal-column');
        why.message = beforeTheCall(why.message);
        await showError(error, why);
        return assigned;
      }
      // What a tracker's import assumed and how it joined the points: the table of columns has said all of the others.
      const said_by = kind === 'table' ? [] : text.split('\n').filter((line) => line.trim() && !line.startsWith(`${output}: `));
      box.replaceChildren(
        panel(
          null,
          el('p', { id: 'imported' }, `${name}: ${onPage(preview.how)}. Read into `, el('strong', {}, output), '.'),
          said_by.map((line) => el('p', { class: 'note import-note' }, line)),
          button('Read it differently', () => draw(preview), { class: 'quiet', id: 'read-differently' }),
          others(preview),
        ),
      );
      read_into.set(preview.sheet, output);
      await handOver([...read_into.values()]);
      return [];
    });
  /** A button for each sheet with a table that was not imported yet: the command line reads each by a call of its own. */
  const others = (preview) => {
    if (!tables.size) [preview.sheet, ...preview.tables_beside].forEach((one) => tables.add(one));
    const left = [...tables].filter((one) => one !== preview.sheet && !read_into.has(one));
    if (!left.length || kind !== 'table') return null;
    return el(
      'div',
      { class: 'controls other-sheets' },
      el('span', {}, 'The workbook has more sheets with tables:'),
      left.map((one) =>
        button(
          `Import sheet "${one}" too`,
          () => {
            sheet = one;
            said.clear();
            return begin();
          },
          { class: 'quiet', 'data-sheet': one },
        ),
      ),
    );
  };
  /** The answer to a doubt, as --column and --deviation on the command line: the column is what it seems to be. */
  const confirmations = (now) =>
    now.columns.map((column, k) =>
      column.doubt && kind === 'table'
        ? button(
            `"${column.heading}" is right as ${column.use === 'deviation' ? 'a deviation of ' : ''}${withUnit(column)}`,
            () => {
              said.set(k, { use: column.use, name: column.name, unit: column.unit });
              return draw();
            },
            { class: 'quiet', 'data-confirms': column.heading },
          )
        : null,
    );
  const sheets = (now) => {
    const node = choice(
      'sheet',
      now.sheets.map((one) => [one, one]),
      now.sheet,
      (value) => {
        sheet = value;
        said.clear();
        return draw();
      },
    );
    node.querySelector('select').id = 'sheet-of-workbook';
    return node;
  };
  /** Where no column has the name of an axis of the machine: the program compares the names itself. */
  const byAxes = (now) => {
    const isAxis = ({ name: column }) => axes.some((axis) => axis.name === column);
    if (!now.message || now.robot || kind !== 'table' || !axes.length || now.columns.some(isAxis)) return null;
    const done = async (output) => {
      box.replaceChildren(panel(null, el('p', { id: 'imported' }, `${name}: read into `, el('strong', {}, output), '.')));
      await handOver([output]);
    };
    return el('div', {}, el('p', { class: 'note' }, kNames), byMachine(name, { error, done, prefix: 'sheet-' }));
  };
  /** The log of a robot: its joints in the order of the axes, and its point. */
  const ofRobot = (now) =>
    now.robot?.length && kind === 'table'
      ? el(
          'div',
          { id: 'sheet-robot' },
          ...confirmed(
            now.robot.map((one) => [withUnit(one), now.columns[one.column].heading]),
            () => {
              for (const { column, name: meaning, unit } of now.robot) said.set(column, { use: 'column', name: meaning, unit });
              return draw();
            },
            'sheet-assignment-is-right',
          ),
        )
      : null;
  const later = () => button('Not now', () => box.replaceChildren(), { class: 'quiet' });
  /** The button of an import that cannot be done yet, with the reason. */
  const notYet = () => {
    const go = button('Import', () => {}, { id: 'do-import' });
    gate(go, 'The table cannot be read yet: the message above says why');
    return go;
  };
  let read = null; // the last preview that could be read
  // What cannot be read at all may be read with other options: another line, table or sheet.
  const refused = () =>
    box.replaceChildren(
      panel(
        `What is in ${name}?`,
        error,
        el('div', { class: 'controls' }, read?.sheets.length > 1 ? sheets({ ...read, sheet }) : null, forms.table.elements),
        el('div', { class: 'controls' }, notYet(), later()),
      ),
    );
  async function draw(preview = null) {
    const mine = ++turn;
    error.replaceChildren();
    const now = preview ?? (await guarded(error, ask));
    if (mine !== turn) return null; // asked anew in the meantime
    // A wrong word in a field of the table: the table stays, so that the word can be corrected.
    if (!now) return box.querySelector('#sheet-columns') ? null : refused();
    read = now;
    kind ??= likely(now, axes);
    const go = button('Import', () => doImport(now), { id: 'do-import' });
    gate(go, kind === 'table' && now.message !== null ? 'State what is missing first: the message above names it' : null);
    box.replaceChildren(
      panel(
        `What is in ${name}?`,
        el('p', { id: 'how-read' }, onPage(now.how)),
        axes.length
          ? el(
              'p',
              { class: 'note', id: 'axes-of-machine' },
              `Axes of the machine: ${axes.map((one) => `${one.name} [${one.unit}]`).join(', ')}.`,
            )
          : null,
        now.message && kind === 'table' ? el('p', { class: 'error', role: 'alert', id: 'sheet-message' }, onPage(now.message)) : null,
        now.message ? el('div', { class: 'controls', id: 'sheet-confirmations' }, confirmations(now)) : null,
        now.points && kind === 'table' ? pointFields(now.points, points, () => draw()) : null,
        now.points ? null : byAxes(now),
        maybePoints(now),
        ofRobot(now),
        kind === 'tracker' && axes.length && !now.columns.some((one) => axes.some((axis) => axis.name === one.name))
          ? el('p', { class: 'note', id: 'where-it-stood' }, kWhereItStood)
          : null,
        kind === 'tracker' && proposed
          ? el(
              'p',
              { class: 'note', id: 'proposed-unit' },
              now.heading_line == null
                ? `The list has no headings: x, y and z in this order, in ${kUsualUnit}, are proposed. Correct them if they are others.`
                : `The headings of the point have no unit: ${kUsualUnit} is proposed. Correct it if it is another.`,
            )
          : null,
        el(
          'div',
          { class: 'controls' },
          choice('read as', kReadAs, kind, (value) => {
            kind = value;
            return kind === 'tracker' && !said.size ? asPoints(now) : draw(now);
          }),
          kind === 'table' && now.sheets.length > 1 ? sheets(now) : null,
          forms[kind].elements,
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
                  return draw();
                }),
              ),
            ),
          ),
        ),
        now.csv.length ? el('pre', { class: 'source', 'aria-label': 'first rows of the measurement file' }, now.csv.join('\n')) : null,
        el('div', { class: 'controls' }, go, later()),
        error,
      ),
    );
    return null;
  }
  /**
   * Reads the columns as points of a tracker: words above them that name no coordinate are a title, and no headings. False: they
   * are no such points, and nothing is changed. `stated`: as for pointsOfATracker.
   */
  async function pointsAreFound(now, stated) {
    propose(now, stated);
    const known = ({ name: word }) => /^[xyz]$/i.test(word) || kTracker.has(word) || axes.some((axis) => axis.name === word);
    if (!said.size && !now.workbook && now.heading_line != null && !now.columns.some(known)) {
      const before = kind;
      kind = 'tracker';
      forms.tracker.fill({ skip: [String(now.heading_line)] });
      const below = await ask().catch(() => null);
      if (below) propose(below, stated);
      if (!said.size) {
        kind = before;
        forms.tracker.fill({ skip: [''] });
      }
    }
    return said.size > 0;
  }
  /** Shows the columns as points of a tracker. */
  async function asPoints(now) {
    kind = 'tracker';
    return draw((await pointsAreFound(now, true)) ? null : now);
  }
  /** What a table that is not understood can be beside positions of the axes. */
  const maybePoints = (now) =>
    now.message && kind === 'table' && axes.length && !now.workbook && !now.robot?.length && !now.points
      ? el(
          'div',
          { class: 'controls' },
          'If these are points that an instrument measured:',
          button('Read them as points of a laser tracker', () => asPoints(now), { class: 'quiet', id: 'sheet-as-points' }),
        )
      : null;
  /** What the columns of a tracker's points probably are. */
  function propose(preview, stated) {
    for (const [k, one] of pointsOfATracker(preview, axes, stated)) {
      said.set(k, one);
      proposed ||= one.unit !== preview.columns[k].unit;
    }
  }
  /** The answers of an earlier import, but for those of the columns. */
  function recall({ kind: read_as, given }) {
    kind = read_as;
    forms[kind].fill(given);
    sheet = given.sheet?.[0] ?? '';
    machine_of_earlier = given.machine?.find((one) => store.files.some((file) => file.name === one)) ?? '';
    for (const [, point, values] of (given.point ?? []).map((one) => one.match(/^(.*)=(.*)$/) ?? []))
      if (values) points.set(point, values.split(','));
  }
  /** What the columns were in an earlier import: "X[mm]=HEADING" of a spreadsheet, "HEADING=x[mm]" of points and touches. */
  function recallColumns({ given }, preview) {
    const at = (source) => {
      const named = preview.columns.findIndex((one) => one.heading === source);
      return named < 0 ? Number(source) - 1 : named;
    };
    const tell = (source, use, meaning = '') => {
      const [, column, unit = ''] = meaning.match(/^(.*?)(?:\[(.*)\])?$/);
      if (preview.columns[at(source)]) said.set(at(source), { use, name: column, unit });
    };
    for (const one of given.leave ?? []) tell(one, 'left');
    for (const use of ['column', 'deviation'])
      for (const one of given[use] ?? []) {
        const between = kind === 'table' ? one.indexOf('=') : one.lastIndexOf('='),
          [before, after] = [one.slice(0, between), one.slice(between + 1)];
        if (kind === 'table') tell(after, use, before);
        else tell(before, use, after);
      }
    if (kind !== 'table' && said.size)
      preview.columns.forEach((one, k) => one.use === 'column' && !said.has(k) && said.set(k, { use: 'left', name: '', unit: '' }));
  }
  /** Imports the table or sheet at once if nothing is missing, else asks. */
  async function begin() {
    if (store.machine) axes = await axesOf(store.machine);
    error.replaceChildren();
    box.replaceChildren(error);
    const recalled = remembered;
    remembered = null; // it does not hold for another sheet of the workbook
    if (recalled) recall(recalled);
    const first = await guarded(error, ask);
    if (!first) {
      kind = null;
      return refused();
    }
    if (recalled) recallColumns(recalled, first);
    else {
      kind = likely(first, axes);
      if (kind === 'tracker') propose(first);
      else if (kind === 'table' && first.message !== null && isRobot(axes) && (await pointsAreFound(first, false))) kind = 'tracker';
    }
    if (said.size) return draw();
    return first.message === null && kind === 'table' && !asks ? doImport(first) : draw(first);
  }
  // A machine that was chosen after the table was dropped has axes to compare with.
  on('rows', async () => {
    if (axes.length || !store.machine || !box.querySelector('#sheet-columns')) return;
    axes = await axesOf(store.machine);
    await draw();
  });
  await begin();
}

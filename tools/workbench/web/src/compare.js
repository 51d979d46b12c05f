// SPDX-License-Identifier: GPL-3.0-or-later
import { choice, el, tiles } from '../../../report/web/src/dom.js';
import { number, printed } from '../../../report/web/src/data.js';
import { withReflector } from './add.js';
import { getJson, run } from './api.js';
import { handoverPanel } from './handover.js';
import { button, gate, guarded, nothingYet, panel, programWords } from './parts.js';
import { redrawAll } from './plot.js';
import { polarPlot } from './polar.js';
import { kReflector, needsReflector } from './reflector.js';
import { along, chosenLines, compared, lineWords, loadRows } from './rows.js';
import { pointKey, scatter } from './scatter.js';
import { histogram, sorted, spreadWords } from './spread.js';
import { emit, on, select, selection, store } from './store.js';
import { rowTable } from './table.js';
import { vectorPlot } from './vectors.js';

const kMatrixAtOnce = 12;

let kind = 0;
const group = () => store.rows?.kinds[Math.min(kind, store.rows.kinds.length - 1)];
const um = (label, value, strong) => ({ label, value: number(value, 4), unit: 'µm', strong });

/** The numbers of the command's JSON, as they are. */
function figures(result) {
  const box = tiles([
    um('rms, fit rows', result.rms_um, true),
    um('rms, check rows', result.check_rms_um, true),
    um('max', result.max_um),
    um('noise', result.noise_um),
    { label: 'observations', value: String(result.n_obs) },
    { label: 'rows left out', value: String(result.n_excluded) },
  ]);
  box.dataset.rms = result.rms_um;
  box.dataset.checkRms = result.check_rms_um;
  box.id = 'compare-figures';
  return box;
}

const capital = (words) => words[0].toUpperCase() + words.slice(1);

/** What the command added or assumed: set-ups, a noise that no file states. */
const notes = (result) => (result.notes ?? []).map((one) => el('p', { class: 'note' }, printed(programWords(one))));

function findings(result) {
  const list = (result.findings ?? [])
    .slice(0, 8)
    .map((one) =>
      el(
        'li',
        {},
        printed(one.sentence),
        el('small', {}, ` ${number(100 * one.share_alone, 3)} % alone, ${number(100 * one.share_after, 3)} % beyond the others`),
      ),
    );
  return list.length
    ? el('ol', { class: 'findings' }, list)
    : el('p', { class: 'note', id: 'no-findings' }, printed(`${capital(result.structure.no_findings)}.`));
}

function matrix() {
  const plots = store.rows.columns.map((column) =>
    scatter(`residual against ${column.name}`, {
      height: 168,
      name: `residual_${column.name}`,
      data: () => ({
        x: along(group(), column),
        y: group().value,
        row: group().row,
        u: group().u,
        check: store.rows.row_check,
        overlay: null,
      }),
      words: () => ({ title: `${column.name}${column.unit ? ` [${column.unit}]` : ''}` }),
    }),
  );
  const grid = el(
    'div',
    { class: 'matrix' },
    plots.slice(0, kMatrixAtOnce).map((plot) => plot.element),
  );
  const rest = plots.slice(kMatrixAtOnce);
  const more = rest.length
    ? button(
        `${rest.length} more columns`,
        (node) => {
          grid.append(...rest.map((plot) => plot.element));
          node.remove();
          redrawAll();
        },
        { class: 'quiet' },
      )
    : null;
  return { element: el('div', {}, grid, more), reset: () => plots.forEach((plot) => plot.reset()) };
}

function probability() {
  const plot = scatter('normal probability plot', {
    height: 230,
    name: 'probability',
    data: () => {
      const one = sorted(group());
      return { x: one.value, y: one.score, row: one.row, check: store.rows.row_check, overlay: null };
    },
    words: () => ({ title: 'normal probability', x: `residual ${group().kind} [${group().unit}]`, y: 'normal score' }),
  });
  return plot;
}

const kNoRows = 'Choose rows first: drag in a plot, or press rows of the table';

/** Leave the chosen rows out, with a reason; put them back. */
function exclusion(error) {
  const reason = el('input', { type: 'text', placeholder: 'why? (kept with each row)', 'aria-label': 'reason', maxlength: '200' });
  const count = el('strong', { id: 'chosen-count' }, '0');
  const list = el('div', { id: 'excluded-list' });
  const target = (name) => (/\.kept\.csv$/.test(name) ? name : `${name.replace(/\.csv$/i, '')}.kept.csv`);
  const change = (name, fields) =>
    guarded(error, async () => {
      const output = target(name);
      await run({ command: 'exclude', meas: name, ...fields, output });
      store.measurements = store.measurements.map((one) => (one === name ? output : one));
      select(new Uint8Array(store.rows.n_rows));
      await loadRows();
    });
  const exclude = button(
    'Leave out',
    async () => {
      for (const [name, lines] of chosenLines())
        await change(name, { lines: lineWords(lines), reason: reason.value.replace(/"/g, '') || 'by hand' });
    },
    { id: 'exclude' },
  );
  const fill = async () => {
    const items = [];
    for (const name of store.measurements) {
      const { excluded } = await getJson('/api/excluded', { name });
      const byReason = new Map();
      for (const one of excluded) byReason.set(one.reason, [...(byReason.get(one.reason) ?? []), one.line]);
      for (const [why, lines] of byReason) {
        items.push(
          el(
            'li',
            {},
            `${name}, ${lines.length} rows (lines ${lineWords(lines).slice(0, 60)}): ${why} `,
            button('put back', () => change(name, { lines: lineWords(lines), restore: true }), { class: 'quiet restore' }),
          ),
        );
      }
    }
    list.replaceChildren(items.length ? el('ul', {}, items) : el('span', { class: 'note' }, 'no row is left out by hand'));
  };
  on('selection', () => {
    count.textContent = String(selection.count);
    gate(exclude, selection.count ? null : kNoRows);
  });
  gate(exclude, kNoRows);
  guarded(list, fill);
  return el(
    'div',
    {},
    el(
      'div',
      { class: 'controls' },
      el('span', {}, count, ' rows chosen'),
      button('none', () => select(new Uint8Array(selection.rows.length)), { class: 'quiet' }),
      reason,
      exclude,
    ),
    list,
  );
}

export function compareView(root) {
  const error = el('div', {}),
    numbers = el('div', { id: 'compare-numbers' }),
    where = el('div', {}),
    linked = el('div', {});
  let table = null,
    charts = [];
  const datum = el('input', { type: 'checkbox', id: 'datum', checked: '' });
  datum.addEventListener('change', () => {
    store.datum = datum.checked;
    loadRows();
  });
  const datumWords = el(
    'label',
    { class: 'choice', title: 'Offsets and turns of the set-up are no failure of the model. Nothing else is fitted.' },
    datum,
    ' fit how the instrument stood first',
  );
  where.classList.add('findings-room');
  root.append(
    error,
    panel('How well', el('div', { class: 'controls' }, datumWords), numbers),
    panel('Where it fails', where),
    linked,
    handoverPanel(),
  );
  async function numbersOf() {
    numbers.replaceChildren(el('p', { class: 'note' }, 'comparing …'));
    const asked = JSON.stringify(compared());
    const state = await guarded(error, () => run({ command: 'compare', ...compared() }));
    if (!state || asked !== JSON.stringify(compared())) return;
    store.compare = state.result;
    numbers.replaceChildren(figures(state.result), ...notes(state.result));
    where.replaceChildren(findings(state.result));
    if (/reflector/.test(state.result.structure.no_findings ?? '') && needsReflector())
      where.append(button(kReflector, () => guarded(error, withReflector), { class: 'quiet', id: 'compare-reflector' }));
    emit('compared');
  }
  function build() {
    linked.replaceChildren();
    where.replaceChildren();
    store.compare = null;
    if (!store.rows) {
      numbers.replaceChildren(nothingYet());
      return;
    }
    kind = 0;
    const { rows } = store;
    const words = el('p', { class: 'note' }, spreadWords(group()));
    const grid = matrix(),
      bars = histogram('histogram of the residuals', 230, group),
      normal = probability();
    table = rowTable(300);
    const kinds = choice(
      'residual of',
      rows.kinds.map((one, k) => [String(k), `${one.kind} [${one.unit}]`]),
      '0',
      (value) => {
        kind = Number(value);
        words.textContent = spreadWords(group());
        grid.reset();
        normal.reset();
        redrawAll();
        bars.plot.redraw();
      },
    );
    const polar = rows.circular.slice(0, 3).map((circle) => polarPlot(circle));
    charts = [bars, ...polar].map((one) => one.plot);
    linked.append(
      panel('In space', el('div', { class: 'beside-equal' }, vectorPlot(rows.circular.length ? 380 : 420).element, polar)),
      panel(
        'Against everything',
        el('div', { class: 'controls' }, kinds),
        words,
        pointKey(),
        grid.element,
        el(
          'p',
          { class: 'note hands' },
          'Drag: choose rows, Ctrl adds to the choice. Shift-drag or arrow keys: move. + and − or the wheel (while in focus): zoom. 0 or double click: the whole. Escape: choose nothing.',
        ),
      ),
      panel('How they scatter', el('div', { class: 'beside-equal' }, bars, normal.element)),
      panel('Rows', exclusion(error), table.element),
    );
    table.draw();
    redrawAll();
    numbersOf();
  }
  on('rows', build);
  on('selection', () => {
    table?.draw();
    const { started } = selection;
    for (const one of charts) one.redraw();
    redrawAll(() => {
      document.body.dataset.redrawMs = (performance.now() - started).toFixed(1);
    });
  });
  build();
  return { show: redrawAll };
}

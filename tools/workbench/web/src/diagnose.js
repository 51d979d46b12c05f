// SPDX-License-Identifier: GPL-3.0-or-later
import { choice, el, table } from '../../../report/web/src/dom.js';
import { number } from '../../../report/web/src/data.js';
import { next, title, verdict } from '../../../report/web/src/diagnosis.js';
import { fileAddress, freeName, run } from './api.js';
import { addEffect, stationButtons, withReflector } from './add.js';
import { ladderFigure } from './charts.js';
import { moreOptions } from './options.js';
import { showExplanation } from './overlay.js';
import { button, guarded, needsSubject, nothingYet, panel, programWords, showError } from './parts.js';
import { redrawAll } from './plot.js';
import { along, measured, valuesOf } from './rows.js';
import { scatter } from './scatter.js';
import { emit, on, store } from './store.js';
import { vectorPlot } from './vectors.js';

const text = (value) => (value === null || value === undefined ? '' : String(value));

/** What a candidate says for itself. */
function evidence(one) {
  const values = (one.parameters ?? [])
    .map((p) => `${p.name} = ${number(p.value, 4)}${Number.isFinite(p.std) ? ` ± ${number(p.std, 2)}` : ''} ${text(p.unit)}`)
    .join('; ');
  return el(
    'ul',
    {},
    [
      ['In the chain', text(one.label)],
      ['Term', one.term],
      ['Fitted', values],
      ['Signature', one.signature],
      ['Exposed by', one.exposed_by],
      ['Known impostors', (one.impostors ?? []).join(', ')],
      ['Not distinguished from', (one.confounded_with ?? []).join(', ')],
      ['Not accepted', one.why_not],
    ]
      .filter(([, words]) => words)
      .map(([name, words]) => el('li', {}, `${name}: ${words}`)),
    el('li', {}, el('code', {}, `vernier add '${one.add}'`)),
  );
}

function candidateTable(result, error, details) {
  const row = (one) => {
    const line = el(
      'tr',
      { tabindex: '0', 'data-add': one.add, class: one.accepted ? 'chosen' : null },
      el('td', { class: 'text' }, title(one)),
      [
        number(one.rms_after_um, 4),
        number(one.check_rms_after_um, 4),
        `${number(100 * one.share, 3)} %`,
        number(one.p_value, 2),
        number(one.score, 4),
      ].map((words) => el('td', { class: 'num' }, words)),
      el(
        'td',
        {},
        button('Add', () => addEffect(one.add, error), { class: 'quiet add-candidate' }),
      ),
    );
    const enter = () => {
      details.replaceChildren(el('h3', {}, title(one)), one.title ? el('p', {}, one.title) : null, evidence(one));
      details.dataset.candidate = one.add;
      store.hovered = one;
      showExplanation(
        one.add,
        () => emit('overlay'),
        (why) => showError(error, why),
      );
    };
    line.addEventListener('pointerenter', enter);
    line.addEventListener('focus', enter);
    return line;
  };
  const head = ['cause', 'rms after [µm]', 'check [µm]', 'share', 'chance', 'score', ''];
  return el(
    'div',
    { class: 'scroll' },
    el(
      'table',
      { id: 'candidates' },
      el(
        'thead',
        {},
        el(
          'tr',
          {},
          head.map((name, i) => el('th', { class: i > 0 ? 'num' : 'text' }, name)),
        ),
      ),
      el('tbody', {}, result.candidates.map(row)),
    ),
  );
}

const rms = (values) => Math.sqrt(values.reduce((sum, one) => sum + one * one, 0) / Math.max(1, values.length));

/** The residual over what drives the candidate that is looked at, with what it would explain. */
function overlayPlot() {
  const group = () => {
    const dof = text(store.hovered?.dof).toLowerCase();
    return store.rows.kinds.find((one) => one.kind === dof) ?? store.rows.kinds[0];
  };
  const column = () => {
    // What the term depends on, an axis' plain position last.
    const words = new Set(text(store.hovered?.term).match(/[A-Za-z_]\w*/g) ?? []);
    const used = store.rows.columns.filter((one) => words.has(one.name)).sort((a, b) => (a.kind === 'axis') - (b.kind === 'axis'));
    return used[0] ?? store.rows.columns.find((one) => one.name === store.hovered?.axis) ?? store.rows.columns[0];
  };
  return scatter('residual and what the candidate would explain', {
    height: 330,
    name: 'explained',
    data: () => {
      if (!store.rows) return null;
      const one = group();
      const over = store.overlay ? valuesOf(one, store.overlay.explained) : null;
      return {
        x: along(one, column()),
        y: store.overlay ? valuesOf(one, store.overlay.before) : one.value,
        row: one.row,
        u: one.u,
        check: store.rows.row_check,
        overlay: over,
      };
    },
    words: () => ({
      x: `${column().name} [${column().unit}]`,
      y: `${group().kind} [${group().unit}]`,
      title: store.overlay
        ? `residual of the fitted model; laid over: ${store.overlay.label}`
        : `residual before the fit, rms ${number(rms(group().value), 3)} ${group().unit}`,
    }),
  });
}

function planPanel(result, error) {
  const names = result.candidates.map((one) => one.add);
  if (names.length < 2) return null;
  let [a, b] = names;
  const options = result.candidates.map((one) => [one.add, title(one)]);
  const box = el('div', { id: 'plan' });
  const more = moreOptions('plan', ['machine', 'meas', 'separate', 'gcode', 'output']);
  const ask = button(
    'What would I have to measure to be sure?',
    () =>
      guarded(error, async () => {
        const output = freeName('plan', '.csv'),
          gcode = freeName('plan', '.nc');
        const { result: plan } = await run({
          command: 'plan',
          machine: store.machine,
          meas: store.measurements,
          separate: [a, b],
          ...more.values(),
          output,
          gcode,
        });
        const rows = plan.rows ?? [];
        const axes = Object.keys(rows[0]?.axes ?? {}),
          inputs = Object.keys(rows[0]?.inputs ?? {});
        const columns = [
          { name: '#' },
          ...axes.map((name) => ({ name })),
          ...axes.map((name) => ({ name: `dir ${name}` })),
          { name: 'feed' },
          ...inputs.map((name) => ({ name })),
        ];
        const line = (row, i) => [
          i + 1,
          ...axes.map((name) => number(row.axes[name], 6)),
          ...axes.map((name) => text(row.dir[name])),
          number(row.feed, 4),
          ...inputs.map((name) => number(row.inputs[name], 4)),
        ];
        box.replaceChildren(
          el('p', {}, plan.sentence),
          rows.length ? table(`${rows.length} points to measure next`, columns, rows.map(line)) : '',
          el('p', {}, el('a', { href: fileAddress(output) }, output), ' · ', el('a', { href: fileAddress(gcode) }, gcode)),
        );
      }),
    { id: 'ask-plan' },
  );
  return panel(
    'Measure next',
    next(result),
    el(
      'div',
      { class: 'controls' },
      choice('tell', options, a, (value) => {
        a = value;
      }),
      choice('from', options, b, (value) => {
        b = value;
      }),
      ask,
    ),
    more.element,
    box,
  );
}

export function diagnoseView(root) {
  const error = el('div', {}),
    box = el('div', { id: 'diagnosis' });
  const options = moreOptions('diagnose', ['machine', 'meas', 'images', 'header', 'language', 'output']);
  const go = button(
    'Diagnose: what is missing?',
    () =>
      guarded(error, async () => {
        const { result } = await run({ command: 'diagnose', ...measured(), ...options.values() });
        store.diagnosis = result;
        store.diagnosed.add(store.measurements.join('|'));
        show(result);
        emit('diagnosed');
      }),
    { id: 'run-diagnose', ...needsSubject },
  );
  let explained = null;
  on('overlay', () => {
    if (explained) explained.reset();
    else redrawAll();
  });
  function show(result) {
    const details = el(
      'div',
      { id: 'evidence' },
      el('p', { class: 'note' }, 'Point at a candidate, or go to it with the Tab key: what it rests on, and what it would explain.'),
    );
    const words = el('div', {}, verdict({ ...result, explanation: programWords(result.explanation) }));
    words.dataset.verdict = result.verdict;
    words.id = 'verdict';
    const plots = [overlayPlot(), vectorPlot(300, 'Residual vectors and what the candidate would explain')];
    box.replaceChildren(
      panel(
        'Verdict',
        words,
        /--reflector/.test(result.explanation)
          ? button('Declare the reflector', () => guarded(error, withReflector), { id: 'declare-reflector' })
          : null,
        ...stationButtons(result.explanation, error),
        ladderFigure(result),
      ),
      panel(
        'Candidates',
        result.candidates.length ? candidateTable(result, error, details) : el('p', { class: 'note' }, 'None.'),
        details,
        el(
          'p',
          { class: 'note', id: 'which-residual' },
          'The figures above are those of fitted models. Until a candidate is chosen, the plots show the residual before the fit; then that of the fitted model.',
        ),
        el(
          'div',
          { class: 'beside-equal' },
          plots.map((plot) => plot.element),
        ),
      ),
      planPanel(result, error) ?? '',
    );
    [explained] = plots;
    redrawAll();
  }
  root.append(error, panel(null, el('div', { class: 'controls' }, go), options.element), box);
  on('rows', () => {
    box.replaceChildren(store.rows ? '' : nothingYet());
    store.diagnosis = explained = null;
    emit('diagnosed');
  });
  box.append(nothingYet());
  return { show: redrawAll };
}

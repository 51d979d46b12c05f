// SPDX-License-Identifier: GPL-3.0-or-later
import { el, section, table, tiles } from './dom.js';
import { number, readData } from './data.js';
import { circleTable, polarPlot } from './polar.js';
import { byKind, residualMatrix, unitOf } from './matrix.js';
import { curves, histogram, ladder } from './plots.js';
import { volume } from './volume.js';
import { candidates, causes, falling, next, pictures, simulated, verdict } from './diagnosis.js';
import { failure, findingList } from './failure.js';
import { t, useCatalogue } from './translate.js';

const root = document.getElementById('report');

function summary(result) {
  const angles = !Number.isFinite(result.rms_um) && Number.isFinite(result.rms_urad);
  const of = (key) => (angles ? result[`${key}_urad`] : result[`${key}_um`]);
  const um = (label, key, hint, strong) => ({ label, value: number(of(key), 4), unit: angles ? 'µrad' : 'µm', hint, strong });
  const count = (label, value) => ({ label, value: value === undefined || value === null ? '–' : String(value) });
  const items = [
    um('rms, fit rows', 'rms', 'root mean square of measured − model over the fit rows', true),
    um('rms, check rows', 'check_rms', 'the same over rows that no fit has seen', true),
    um('max, fit rows', 'max'),
    um('max, check rows', 'check_max'),
    um('noise', 'noise', 'of the measurement: from its stated uncertainty or from repeats'),
  ];
  if (!angles && Number.isFinite(result.rms_urad)) items.push({ label: 'rms, rotations', value: number(result.rms_urad, 4), unit: 'µrad' });
  items.push(count('observations', result.n_obs), count('rows excluded', result.n_excluded));
  return tiles(items);
}

function parameterTable(parameters) {
  const notes = parameters.some((one) => one.note);
  return table(
    'Parameters',
    [
      { name: 'name', left: true },
      { name: 'value' },
      { name: 'std. uncertainty' },
      { name: 'unit', left: true },
      ...(notes ? [{ name: 'meaning', left: true }] : []),
    ],
    parameters.map((one) => [one.name, number(one.value, 6), number(one.std, 2), one.unit ?? '', ...(notes ? [one.note ?? ''] : [])]),
  );
}

function worstTable(detail) {
  const manyFiles = new Set(detail.worst.map((one) => one.file)).size > 1;
  const role = (one) => one.role ?? (detail.row_check ? (detail.row_check[one.row] ? 'check' : 'fit') : '');
  const rows = detail.worst.map((one) => [
    ...(manyFiles ? [one.file] : []),
    one.line,
    one.run ?? '',
    one.kind,
    role(one),
    number(one.residual, 5),
    unitOf(one),
  ]);
  return table(
    'Largest residuals',
    [
      ...(manyFiles ? [{ name: 'file', left: true }] : []),
      { name: 'line in the file' },
      { name: 'run', left: true },
      { name: 'observation', left: true },
      { name: 'role', left: true },
      { name: 'residual' },
      { name: 'unit', left: true },
    ],
    rows,
  );
}

const circles = (list) => list.map((circle) => el('div', { class: 'beside' }, polarPlot(circle), el('div', {}, circleTable(circle))));
const histograms = (detail) =>
  [...new Set(byKind(detail.observations).map((group) => group.unit))].map((unit) => histogram(detail, unit)).filter(Boolean);
const listOf = (notes) =>
  el(
    'ul',
    {},
    notes.map((note) => el('li', {}, note)),
  );

function thinned(detail) {
  return detail.thinned
    ? el(
        'p',
        { class: 'note' },
        `${detail.thinned.kept} of ${detail.thinned.of} observations are drawn: one in ${detail.thinned.step}, and the worst.` +
          ' The numbers above are of all.',
      )
    : null;
}

const fieldProse = (field) =>
  el(
    'p',
    {},
    'Deviation of the tool point that the model states, actual minus nominal, over the declared axis ranges, ' +
      `in workpiece coordinates: at most ${number(field.max_um, 4)} µm, rms ${number(field.rms_um, 4)} µm. Drag or use the arrow keys to turn it.`,
  );

function failing(result, note) {
  const parts = failure(result);
  if (parts.length) section(root, 'Where it fails', parts, note ? el('p', { class: 'note' }, note) : null);
}

/** Section that is left out where it would be empty. */
function optional(title, parts) {
  const list = [parts].flat().filter(Boolean);
  if (list.length) section(root, title, list);
}

function diagnosis(result) {
  const { detail } = result;
  section(root, 'Verdict', verdict(result).filter(Boolean));
  optional('Possible causes', causes(result));
  optional('Ladder', falling(result));
  section(root, 'Candidates', candidates(result));
  optional('Measure next', next(result));
  failing(result, 'Of the fitted model: its free parameters have had their chance.');
  if (detail?.observations) section(root, 'Residuals', thinned(detail), residualMatrix(detail, result.findings));
  if (result.notes?.length) section(root, 'Notes', listOf(result.notes));
}

function improvement(result) {
  optional('The error falls', falling(result));
  optional('Residuals before and after', pictures(result));
  optional('In the control loop', simulated(result));
  if (result.verdict) section(root, 'At the end', verdict(result).filter(Boolean));
  for (const step of result.steps ?? []) {
    section(
      root,
      step.title ?? 'Step',
      (step.prose ?? []).map((text) => el('p', {}, text)),
      step.explanation ? el('p', {}, step.explanation) : null,
      step.findings ? findingList(step.findings) : null,
      step.candidates ? candidates(step) : null,
    );
  }
  if (result.candidates?.length) section(root, 'Candidates', candidates(result));
  optional('Measure next', next(result));
  failing(result, 'Of the model at the end.');
  if (result.detail?.observations) section(root, 'Residuals', thinned(result.detail), residualMatrix(result.detail, result.findings));
  if (result.parameters?.length) section(root, 'Parameters', parameterTable(result.parameters));
  if (result.notes?.length) section(root, 'Notes', listOf(result.notes));
}

function comparison(result) {
  const detail = result.detail;
  section(root, 'Summary', summary(result), (result.notes?.length ?? 0) ? listOf(result.notes) : null);
  failing(result, 'Nothing has been fitted here: a wrong offset, squareness or scale is a failure too, which a fit would remove.');
  if (detail?.circular?.length) section(root, 'Circle', circles(detail.circular));
  if (detail?.observations) {
    section(root, 'Residuals', thinned(detail), residualMatrix(detail, result.findings));
    section(root, 'Distribution', histograms(detail));
  }
  if (result.field) section(root, 'Error field', fieldProse(result.field), volume(result.field));
  else if (result.field_note) section(root, 'Error field', el('p', {}, result.field_note));
  if (detail?.worst?.length) section(root, 'Worst rows', worstTable(detail));
  if (result.parameters?.length) section(root, 'Parameters', parameterTable(result.parameters));
}

function part(one) {
  section(
    root,
    one.title,
    (one.prose ?? []).map((text) => el('p', {}, text)),
    one.numbers?.length
      ? tiles(one.numbers.map((item) => ({ ...item, value: typeof item.value === 'number' ? number(item.value, 4) : (item.value ?? '–') })))
      : null,
    one.field ? volume(one.field) : null,
    one.ladder?.length ? ladder(one.ladder) : null,
    (one.tables ?? []).map((entry) =>
      table(
        entry.caption,
        entry.columns.map((name, i) => ({ name, left: typeof entry.rows[0]?.[i] === 'string' })),
        entry.rows.map((row) => row.map((cell) => (typeof cell === 'number' ? number(cell, 5) : (cell ?? '–')))),
      ),
    ),
    one.parameters?.length ? parameterTable(one.parameters) : null,
    (one.plots ?? []).map(curves),
    one.detail?.circular?.length ? circles(one.detail.circular) : null,
    one.detail?.observations ? [thinned(one.detail), residualMatrix(one.detail), histograms(one.detail)] : null,
    one.notes?.length ? listOf(one.notes) : null,
  );
}

const data = readData();
useCatalogue(data.result.catalogue);
// What the program wrote into the page before this script ran.
document.title = t(document.title);
for (const node of document.querySelectorAll('nav[aria-label]')) node.setAttribute('aria-label', t(node.getAttribute('aria-label')));
for (const node of document.querySelectorAll('header h1, header dt, a.skip')) node.textContent = t(node.textContent);
const pages = { compare: comparison, diagnose: diagnosis, improve: improvement };
if (pages[data.type]) pages[data.type](data.result);
else for (const one of data.result.sections) part(one);
// What is folded away on the screen cannot be unfolded on paper.
addEventListener('beforeprint', () => {
  for (const folded of document.querySelectorAll('details:not([open])')) {
    folded.open = true;
    folded.dataset.folded = 'yes';
  }
});
addEventListener('afterprint', () => {
  for (const unfolded of document.querySelectorAll('details[data-folded]')) {
    unfolded.open = false;
    delete unfolded.dataset.folded;
  }
});
document.documentElement.dataset.ready = 'yes';

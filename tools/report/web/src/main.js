import { el, section, table, tiles } from './dom.js';
import { number, readData } from './data.js';
import { circleTable, polarPlot } from './polar.js';
import { byKind, residualMatrix, unitOf } from './matrix.js';
import { curves, histogram, ladder } from './plots.js';
import { volume } from './volume.js';

const root = document.getElementById('report');

function summary(result) {
  const um = (label, value, hint, strong) => ({ label, value: number(value, 4), unit: 'µm', hint, strong });
  const count = (label, value) => ({ label, value: value === undefined || value === null ? '–' : String(value) });
  const items = [
    um('rms, fit rows', result.rms_um, 'root mean square of measured − model over the fit rows', true),
    um('rms, check rows', result.check_rms_um, 'the same over rows that no fit has seen', true),
    um('max, fit rows', result.max_um), um('max, check rows', result.check_max_um),
    um('noise', result.noise_um, 'of the measurement: from its stated uncertainty or from repeats'),
  ];
  if (Number.isFinite(result.rms_urad)) items.push({ label: 'rms, rotations', value: number(result.rms_urad, 4), unit: 'µrad' });
  items.push(count('observations', result.n_obs), count('rows excluded', result.n_excluded));
  return tiles(items);
}

function parameterTable(parameters) {
  return table('Parameters', [{ name: 'name', left: true }, { name: 'value' }, { name: 'std. uncertainty' }, { name: 'unit', left: true }],
    parameters.map((one) => [one.name, number(one.value, 6), number(one.std, 2), one.unit ?? '']));
}

function worstTable(detail) {
  const manyFiles = new Set(detail.worst.map((one) => one.file)).size > 1;
  const role = (one) => one.role ?? (detail.row_check ? (detail.row_check[one.row] ? 'check' : 'fit') : '');
  const rows = detail.worst.map((one) => [...(manyFiles ? [one.file] : []), one.line, one.run ?? '', one.kind, role(one), number(one.residual, 5), unitOf(one.kind)]);
  return table('Largest residuals', [...(manyFiles ? [{ name: 'file', left: true }] : []), { name: 'line in the file' }, { name: 'run', left: true },
    { name: 'observation', left: true }, { name: 'role', left: true }, { name: 'residual' }, { name: 'unit', left: true }], rows);
}

const circles = (list) => list.map((circle) => el('div', { class: 'beside' }, polarPlot(circle), el('div', {}, circleTable(circle))));
const histograms = (detail) => [...new Set(byKind(detail.observations).map((group) => group.unit))].map((unit) => histogram(detail, unit)).filter(Boolean);
const listOf = (notes) => el('ul', {}, notes.map((note) => el('li', {}, note)));

function thinned(detail) {
  return detail.thinned ? el('p', { class: 'note' }, `${detail.thinned.kept} of ${detail.thinned.of} observations are drawn: one in ${detail.thinned.step}, and the worst.`
    + ' The numbers above are of all.') : null;
}

const fieldProse = (field) => el('p', {}, 'Deviation of the tool point that the model states, actual minus nominal, over the declared axis ranges, '
  + `in workpiece coordinates: at most ${number(field.max_um, 4)} µm, rms ${number(field.rms_um, 4)} µm. Drag or use the arrow keys to turn it.`);

function comparison(result) {
  const detail = result.detail;
  section(root, 'Summary', summary(result), (result.notes?.length ?? 0) ? listOf(result.notes) : null);
  if (detail?.circular?.length) section(root, 'Circle', circles(detail.circular));
  if (detail?.observations) {
    section(root, 'Residuals', thinned(detail), residualMatrix(detail));
    section(root, 'Distribution', histograms(detail));
  }
  if (result.field) section(root, 'Error field', fieldProse(result.field), volume(result.field));
  else if (result.field_note) section(root, 'Error field', el('p', {}, result.field_note));
  if (detail?.worst?.length) section(root, 'Worst rows', worstTable(detail));
  if (result.parameters?.length) section(root, 'Parameters', parameterTable(result.parameters));
}

function part(one) {
  section(root, one.title, (one.prose ?? []).map((text) => el('p', {}, text)),
    one.numbers?.length ? tiles(one.numbers.map((item) => ({ ...item, value: typeof item.value === 'number' ? number(item.value, 4) : item.value ?? '–' }))) : null,
    one.field ? volume(one.field) : null,
    one.ladder?.length ? ladder(one.ladder) : null,
    (one.tables ?? []).map((entry) => table(entry.caption, entry.columns.map((name, i) => ({ name, left: typeof entry.rows[0]?.[i] === 'string' })),
      entry.rows.map((row) => row.map((cell) => (typeof cell === 'number' ? number(cell, 5) : cell ?? '–'))))),
    one.parameters?.length ? parameterTable(one.parameters) : null,
    (one.plots ?? []).map(curves),
    one.detail?.circular?.length ? circles(one.detail.circular) : null,
    one.detail?.observations ? [thinned(one.detail), residualMatrix(one.detail), histograms(one.detail)] : null,
    one.notes?.length ? listOf(one.notes) : null);
}

const data = readData();
if (data.type === 'compare') comparison(data.result);
else for (const one of data.result.sections) part(one);
document.documentElement.dataset.ready = 'yes';

// SPDX-License-Identifier: GPL-3.0-or-later
import { el, table } from './dom.js';
import { number } from './data.js';
import { unitOf } from './matrix.js';
import { volume } from './volume.js';

const percent = (share) => (Number.isFinite(share) ? `${number(100 * share, 3)} %` : '–');
const capital = (text) => (text ? text[0].toUpperCase() + text.slice(1) : '');
const chance = (p) => (p === 0 || p < 1e-12 ? '< 1e−12' : number(p, 2));

/** Sentences first, the strongest on top; each with what it explains. */
export function findingList(findings, structure) {
  if (!findings?.length)
    return el(
      'p',
      {},
      structure?.no_findings
        ? `${capital(structure.no_findings)}.`
        : 'No column, pair, run or order of rows explains the residual beyond chance.',
    );
  return el(
    'ol',
    { class: 'findings' },
    findings.map((one) =>
      el(
        'li',
        {},
        el('span', { class: 'bar', style: `--share:${Math.max(0, Math.min(1, one.share_after ?? 0))}` }),
        el(
          'span',
          {},
          `${capital(one.sentence)}. `,
          el(
            'small',
            {},
            `${percent(one.share_alone)} of the variance of ${one.observation} alone, ${percent(one.share_after)} beyond the other findings` +
              `${Number.isFinite(one.rms_um) ? `; rms ${number(one.rms_um, 3)} ${unitOf(one)}` : ''}; chance ${chance(one.p_value)}`,
          ),
        ),
      ),
    ),
  );
}

/** Share of the variance that each column explains, as a table of kinds against columns, and how to read it. */
function shareTable(shares, findings) {
  const kinds = [...new Set(shares.map((one) => one.observation))];
  const columns = [...new Set(shares.map((one) => one.column))];
  const at = new Map(shares.map((one) => [`${one.observation} ${one.column}`, one]));
  const best = (column) => Math.max(...kinds.map((kind) => at.get(`${kind} ${column}`)?.share_alone ?? 0));
  columns.sort((a, b) => best(b) - best(a));
  const named = new Set(findings.flatMap((one) => [one.column, one.second_column].map((column) => `${one.observation} ${column}`)));
  const cell = (kind, column) => {
    const one = at.get(`${kind} ${column}`);
    if (!one) return '';
    return `${percent(one.share_alone)} / ${percent(one.share_after)}${one.p_value < 0.01 ? ' *' : ''}${named.has(`${kind} ${column}`) ? ' found' : ''}`;
  };
  return [
    table(
      'Share of the variance that each column explains',
      [{ name: 'column', left: true }, ...kinds.map((kind) => ({ name: kind }))],
      columns.map((column) => [column, ...kinds.map((kind) => cell(kind, column))]),
    ),
    el(
      'p',
      { class: 'note' },
      'Of each residual, by a smooth curve over the column: alone / beyond the findings that do not name it. * rarer than 1 in 100 by chance, all tries counted.',
    ),
  ];
}

/** Mean residual vectors over the volume, where they stand out of chance. */
function picture(cells) {
  const points = cells.filter((one) => one.count > 0);
  if (points.length < 2) return null;
  const size = (v) => Math.hypot(...v);
  const sure = points.filter((one) => size(one.mean_um) > 3 * one.noise_um).length;
  return [
    el('h3', {}, 'In the volume', el('small', {}, ` mean residual of the fit rows in ${points.length} cells`)),
    volume({
      axes: [],
      counts: [],
      point_mm: points.map((one) => one.point_mm),
      deviation_um: points.map((one) => one.mean_um),
      max_um: Math.max(...points.map((one) => size(one.mean_um))),
    }),
    el(
      'p',
      { class: 'note' },
      `${sure} of ${points.length} means are longer than three times what chance leaves of them. At the mean tool point of each cell, in machine coordinates; lengths count along the bar, deviations along their normal.`,
    ),
  ];
}

function repeats(structure) {
  const rows = [];
  const um = (value) => `${number(value, 4)} µm`;
  if (Number.isFinite(structure.pure_error_um)) {
    rows.push(
      ['scatter of repeats (rows at equal conditions)', um(structure.pure_error_um)],
      ['lack of fit beyond it', um(structure.lack_of_fit_um)],
      ['chance of so much lack of fit', chance(structure.lack_of_fit_p)],
    );
  } else if (Number.isFinite(structure.neighbour_error_um))
    rows.push(['no repeats; scatter between nearest rows (at most that much is noise)', um(structure.neighbour_error_um)]);
  if (Number.isFinite(structure.chi_p)) rows.push(['chance of so large a residual, if the stated u is right', chance(structure.chi_p)]);
  rows.push(['chance of so much structure in pure noise', chance(structure.omnibus_p)]);
  if (structure.omnibus_by) rows.push(['the test that says most', structure.omnibus_by]);
  if (structure.outliers > 0) rows.push(['readings beyond 5 robust spreads', String(structure.outliers)]);
  return table(
    'Repeats, chance and outliers',
    [
      { name: '', left: true },
      { name: '', left: true },
    ],
    rows,
  );
}

/** Everything about where a model fails: parts for one section. */
export function failure(result) {
  const { findings, structure } = result;
  if (!findings && !structure) return [];
  return [
    findingList(findings, structure),
    structure ? repeats(structure) : null,
    structure?.shares?.length ? shareTable(structure.shares, findings ?? []) : null,
    structure?.cells?.length ? picture(structure.cells) : null,
  ]
    .flat()
    .filter(Boolean);
}

// SPDX-License-Identifier: GPL-3.0-or-later
import { getBlob, Refused } from './api.js';
import { emit, select, selection, store } from './store.js';

const kAcross = { x: 0, y: 1, z: 2 };

/** Observations of one kind, side by side: {kind, unit, index (among all), row, value}. */
function byKind(observations) {
  const counts = new Uint32Array(observations.kinds.length);
  const rotations = new Set(observations.rotations);
  for (const kind of observations.kind) ++counts[kind];
  const groups = observations.kinds.map((kind, k) => ({
    kind,
    unit: rotations.has(kind) ? 'µrad' : 'µm',
    index: new Uint32Array(counts[k]),
    row: new Uint32Array(counts[k]),
    u: new Float32Array(counts[k]),
    value: new Float32Array(counts[k]),
  }));
  const next = new Uint32Array(groups.length);
  for (let i = 0; i < observations.kind.length; ++i) {
    const group = groups[observations.kind[i]],
      at = next[observations.kind[i]]++;
    group.index[at] = i;
    group.row[at] = observations.row[i];
    group.u[at] = observations.u[i];
    group.value[at] = observations.residual[i];
  }
  return groups.filter((group) => group.index.length > 0);
}

/** Residual vector of each row, µm: its x, y, z, and its length or d along the direction of these. */
function vectors(rows) {
  const v = [0, 1, 2].map(() => new Float32Array(rows.n_rows));
  for (const group of rows.kinds) {
    if (group.unit !== 'µm') continue;
    const k = kAcross[group.kind];
    for (let i = 0; i < group.row.length; ++i) {
      const row = group.row[i];
      if (k !== undefined) v[k][row] += group.value[i];
      else for (let j = 0; j < 3; ++j) v[j][row] += group.value[i] * rows.direction[j][row];
    }
  }
  return v;
}

const sizeOf = (v) => {
  const size = new Float32Array(v[0].length);
  for (let i = 0; i < size.length; ++i) size[i] = Math.hypot(v[0][i], v[1][i], v[2][i]);
  return size;
};

/** Puts other residuals (of all observations) in the place of those that are shown. */
export function setResiduals(rows, residual) {
  rows.observations.residual = residual;
  rows.kinds = byKind(rows.observations);
  rows.vector = vectors(rows);
  rows.size = sizeOf(rows.vector);
}

/** Values of all observations as a group shows them. */
export function valuesOf(group, all) {
  const values = new Float32Array(group.index.length);
  for (let i = 0; i < values.length; ++i) values[i] = all[group.index[i]];
  return values;
}

/** A column's values as the observations of a group see them; kept. */
export function along(group, column) {
  group.seen ??= new Map();
  if (!group.seen.has(column)) {
    const values = new Float32Array(group.row.length);
    for (let i = 0; i < values.length; ++i) values[i] = column.data[group.row[i]];
    group.seen.set(column, values);
  }
  return group.seen.get(column);
}

/** Does a column vary (and is no long way that stands for "not recorded")? */
function varies(column) {
  const first = column.data[0];
  for (const value of column.data) if (value !== first && value < 1e8) return true;
  return false;
}

/** For requests to the reader of files. */
export const subject = () => ({ machine: store.machine, measurements: store.measurements });
/** For commands that read rows as a fit does: what a board had added to them is found in the project's images. */
export const measured = () => ({ machine: store.machine, meas: store.measurements, ...(store.rows?.corrected ? { images: '.' } : {}) });
/** The same for the comparison. */
export const compared = () => ({ ...measured(), ...(store.datum ? { datum: true } : {}) });

const noReadings = () =>
  `${store.measurements.join(', ')}: there are no readings in these rows yet, only positions. Take in what was measured, under Project.`;

const chosen = () => [store.machine, ...store.measurements].join('\n');

/** Loads the machine and rows that are chosen; everything else follows from the event. Rows that cannot be read: `refusal`. */
export async function loadRows() {
  const asked = chosen();
  store.refusal = null;
  let rows = null;
  if (store.machine && store.measurements.length) {
    try {
      rows = await getBlob('/api/rows', {
        machine: store.machine,
        measurement: store.measurements,
        ...(store.datum ? { datum: '1' } : {}),
      });
      // A plan, or a file for readings to come: there is nothing to show, and no chart has a kind to draw.
      if (!rows.observations.kind.length) throw new Refused(noReadings());
    } catch (why) {
      if (!(why instanceof Refused)) throw why;
      rows = null;
      if (asked === chosen()) store.refusal = why.message;
    }
  }
  if (asked !== chosen()) return; // chosen anew in the meantime
  if (!rows) {
    store.rows = null;
    emit('rows');
    return;
  }
  rows.columns = rows.columns.filter(varies);
  setResiduals(rows, rows.observations.residual);
  const same = store.rows && store.rows.n_rows === rows.n_rows;
  store.rows = rows;
  store.overlay = null;
  if (!same) select(new Uint8Array(rows.n_rows));
  emit('rows');
}

/** Lines of the chosen rows in each measurement file: [[file name, [lines]]]. */
export function chosenLines() {
  const { rows } = store;
  const lists = rows.files.map((name) => [name, []]);
  for (let i = 0; i < rows.n_rows; ++i) if (selection.rows[i]) lists[rows.row_file[i]][1].push(rows.row_line[i]);
  return lists.filter(([, lines]) => lines.length);
}

/** 3,4,5,9 as "3-5,9". */
export function lineWords(lines) {
  const parts = [];
  for (let i = 0; i < lines.length;) {
    let j = i;
    while (j + 1 < lines.length && lines[j + 1] === lines[j] + 1) ++j;
    parts.push(i === j ? `${lines[i]}` : `${lines[i]}-${lines[j]}`);
    i = j + 1;
  }
  return parts.join(',');
}

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

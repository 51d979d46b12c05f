// SPDX-License-Identifier: GPL-3.0-or-later
// What the views share, and how they hear of a change. Events: project, rows, selection, overlay, diagnosis, job.
const listeners = new Map();

export const store = {
  folder: '',
  version: '',
  files: [],
  history: [],
  machine: '',
  measurements: [],
  rows: null,
  compare: null,
  diagnosis: null,
  overlay: null,
};

export const selection = { rows: new Uint8Array(0), count: 0 };

export function on(event, call) {
  if (!listeners.has(event)) listeners.set(event, []);
  listeners.get(event).push(call);
}

export function emit(event) {
  for (const call of listeners.get(event) ?? []) call();
}

/** rows: 1 for each row that is chosen. */
export function select(rows) {
  const start = performance.now();
  selection.rows = rows;
  let count = 0;
  for (let i = 0; i < rows.length; ++i) count += rows[i];
  selection.count = count;
  selection.started = start;
  emit('selection');
}

// SPDX-License-Identifier: GPL-3.0-or-later
// What the views share, and how they hear of a change. Events: project, rows, parameters, selection, overlay, compared,
// diagnosed, steps, safety, uploaded, view, job.
const listeners = new Map();

export const store = {
  folder: '',
  version: '',
  files: [],
  commands: [], // what the page may run, as the program declares it: options.js
  history: [],
  machine: '',
  measurements: [],
  rows: null,
  compare: null,
  diagnosis: null,
  overlay: null,
  datum: true, // the set-up is fitted before anything is compared
  parameters: [],
  refusal: null, // why the chosen rows cannot be read
  steps: [], // what was tried in this session, in order: {label, machine, rms_um, check_rms_um, noise_um}
  safety: null,
  uploaded: false,
  exported: '', // the machine of which files for a control were written
  leftOut: [], // what these files do not correct
  diagnosed: new Set(), // measurements that were asked what is missing
  visited: new Set(), // views that were looked at
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

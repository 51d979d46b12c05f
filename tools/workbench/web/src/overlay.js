// SPDX-License-Identifier: GPL-3.0-or-later
import { postBlob } from './api.js';
import { setResiduals, subject } from './rows.js';
import { redrawAll } from './plot.js';
import { store } from './store.js';

const known = new Map();
let wanted = null;

/** Lays what a candidate would explain over the residuals; null takes it away. Asked once for each candidate. */
export async function showExplanation(add, changed = redrawAll, failed = () => {}) {
  wanted = add;
  if (add === null) {
    store.overlay = null;
    changed();
    return;
  }
  const key = JSON.stringify([subject(), add]);
  if (!known.has(key)) known.set(key, postBlob('/api/explain', { ...subject(), add }));
  try {
    const answer = await known.get(key);
    if (wanted !== add) return;
    store.overlay = answer;
    changed();
  } catch (error) {
    known.delete(key);
    if (wanted === add) failed(error);
  }
}

/** The rows with one part of an overlay ('before' or 'explained') as their residual; kept. */
export function twinOf(overlay, part) {
  overlay.twins ??= {};
  if (!overlay.twins[part]) {
    const twin = { ...store.rows, observations: { ...store.rows.observations } };
    setResiduals(twin, overlay[part]);
    overlay.twins[part] = twin;
  }
  return overlay.twins[part];
}

// SPDX-License-Identifier: GPL-3.0-or-later
import { el } from '../../../report/web/src/dom.js';
import { chart } from '../../../report/web/src/chart.js';
import { getJson, Refused } from './api.js';
import { store } from './store.js';

export function button(label, act, attributes = {}) {
  const node = el('button', { type: 'button', ...attributes }, label);
  node.addEventListener('click', async () => {
    node.disabled = true;
    try {
      await act(node);
    } finally {
      node.disabled = node.hasAttribute('data-needs-subject') && !store.rows;
    }
  });
  return node;
}

export const panel = (title, ...children) => el('section', { class: 'panel' }, title ? el('h2', {}, title) : null, ...children);

/** Attributes of a button that a machine and rows have to be chosen for. */
export const needsSubject = { 'data-needs-subject': '', disabled: '' };

/** What stands where there is nothing to show yet: what to choose, or why the chosen rows cannot be read. */
export const nothingYet = () =>
  store.refusal
    ? el('p', { class: 'error', role: 'alert' }, store.refusal, ' ', el('a', { href: '#project' }, 'Project'))
    : el(
        'p',
        { class: 'note empty' },
        'Choose a machine and measurements at the top, or take files in under ',
        el('a', { href: '#project' }, 'Project'),
        '.',
      );

/** A chart of the plotting library with its exports. */
export const figure = (label, options, caption = null) =>
  el('figure', {}, chart(label, options), caption ? el('figcaption', {}, caption) : null);

/** An error in its box: the words, and where they name a line of a file, that line. */
export async function showError(box, error) {
  if (!(error instanceof Refused)) throw error;
  const where = error.message.match(/([^\s:"]+):(\d+): (?:"(.*?)": )?/);
  box.replaceChildren(el('p', { class: 'error', role: 'alert' }, error.message));
  if (!where) return;
  try {
    const context = await getJson('/api/lines', { name: where[1], line: where[2] });
    box.append(
      el(
        'pre',
        { class: 'source' },
        context.lines.map((text, i) => {
          const number = context.first + i;
          return el('span', { class: number === Number(where[2]) ? 'bad' : null }, `${String(number).padStart(6)}  ${text}\n`);
        }),
      ),
    );
  } catch {
    /* The file was not kept: its words are all there is. */
  }
}

/** Shows the error of a job where it belongs instead of failing silently. */
export async function guarded(box, act) {
  box.replaceChildren();
  try {
    return await act();
  } catch (error) {
    await showError(box, error);
    return null;
  }
}

// SPDX-License-Identifier: GPL-3.0-or-later
import { el } from '../../../report/web/src/dom.js';

let box = null;

/** A few lines beside the pointer. */
export function showTip(event, lines) {
  if (box === null) {
    box = el('div', { class: 'tip', id: 'tip', role: 'tooltip' });
    document.body.append(box);
  }
  box.hidden = false;
  box.replaceChildren(...lines.map((line) => el('div', {}, line)));
  const { width, height } = box.getBoundingClientRect();
  const left = event.clientX + 14 + width > document.documentElement.clientWidth ? event.clientX - 14 - width : event.clientX + 14;
  const top = event.clientY + 14 + height > document.documentElement.clientHeight ? event.clientY - 14 - height : event.clientY + 14;
  box.style.left = `${Math.max(0, left)}px`;
  box.style.top = `${Math.max(0, top)}px`;
}

export function hideTip() {
  if (box !== null) box.hidden = true;
}

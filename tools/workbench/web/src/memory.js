// SPDX-License-Identifier: GPL-3.0-or-later
// What was done on the way, kept for as long as the page stays open: a reload begins where one was.
import { emit, on, store } from './store.js';

const key = () => `way:${store.folder}`;

function keep() {
  const way = { steps: store.steps, uploaded: store.uploaded, diagnosed: [...store.diagnosed], visited: [...store.visited] };
  try {
    sessionStorage.setItem(key(), JSON.stringify(way));
  } catch {
    /* private mode, or full */
  }
}

/** Takes back what was kept of this folder, then keeps what comes. The folder has to be known. */
export function rememberTheWay() {
  let way = null;
  try {
    way = JSON.parse(sessionStorage.getItem(key()));
  } catch {
    /* private mode, or not ours */
  }
  if (Array.isArray(way?.steps)) {
    // What is on disk no more was no step of this project.
    const there = (name) => store.files.some((file) => file.name === name);
    store.steps.push(...way.steps.filter((step) => there(step.machine)));
    store.uploaded = way.uploaded === true;
    store.diagnosed = new Set(way.diagnosed);
    for (const view of way.visited ?? []) store.visited.add(view);
    emit('steps');
  }
  for (const event of ['steps', 'diagnosed', 'uploaded', 'view']) on(event, keep);
}

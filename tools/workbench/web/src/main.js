// SPDX-License-Identifier: GPL-3.0-or-later
import { redrawCharts } from '../../../report/web/src/chart.js';
import { el } from '../../../report/web/src/dom.js';
import { number } from '../../../report/web/src/data.js';
import { addView } from './add.js';
import { cancel, getJson, job, refresh } from './api.js';
import { boardView } from './board.js';
import { compareView } from './compare.js';
import { diagnoseView } from './diagnose.js';
import { fleetView } from './fleet.js';
import { guide } from './guide.js';
import { rememberTheWay } from './memory.js';
import { exportView } from './export.js';
import { gate, kNoSubject } from './parts.js';
import { redrawAll } from './plot.js';
import { projectView } from './project.js';
import { choose } from './rows.js';
import { fileNames } from './options.js';
import { emit, on, store } from './store.js';
import { measurementFiles } from './uses.js';

const kViews = [
  ['project', 'Project', projectView],
  ['compare', 'Compare', compareView],
  ['diagnose', 'Diagnose', diagnoseView],
  ['add', 'Add and watch', addView],
  ['board', 'Compile and upload', boardView],
  ['export', 'Export', exportView],
  ['fleet', 'Fleet', fleetView],
];

const views = new Map();

function show(id) {
  const name = views.has(id) ? id : 'project';
  for (const [one, view] of views) {
    view.root.hidden = one !== name;
    view.link.setAttribute('aria-current', one === name ? 'page' : 'false');
  }
  // A page begins at its top, wherever the one before was read.
  if (document.body.dataset.view !== name) document.documentElement.scrollTop = 0;
  document.body.dataset.view = name;
  store.visited.add(name);
  emit('view');
  views.get(name).view.show();
  redrawAll();
  // A hidden chart has no width: the window or the colours may have changed since it was drawn.
  redrawCharts();
}

/** The machine and the measurements that everything is about. */
function subjectBar() {
  const machine = el('select', { id: 'machine', 'aria-label': 'machine' }),
    rows = el('select', { id: 'measurement', 'aria-label': 'measurement' });
  const fill = (select, kind, names, chosen) => {
    if (chosen && !names.includes(chosen)) names.push(chosen);
    select.replaceChildren(
      el('option', { value: '' }, `choose a ${kind}`),
      ...names.map((name) => el('option', { value: name, selected: name === chosen ? '' : null }, name)),
    );
    select.title = chosen ?? '';
  };
  let drawing = 0;
  const draw = async () => {
    const mine = ++drawing;
    const names = store.files.filter((file) => file.kind === 'machine').map((file) => file.name);
    fill(machine, 'machine', names, store.machine);
    // A spreadsheet that is still to be imported is no measurement.
    const measured = await measurementFiles();
    if (mine === drawing) fill(rows, 'measurement', measured, store.measurements.join(' + '));
  };
  machine.addEventListener('change', () => choose(machine.value, store.measurements));
  rows.addEventListener('change', () => choose(store.machine, rows.value ? rows.value.split(' + ') : []));
  on('project', draw);
  on('rows', draw);
  // What has to have a machine and rows cannot be pressed without.
  on('rows', () => {
    document.body.dataset.subject = store.rows ? 'yes' : 'no';
    for (const node of document.querySelectorAll('[data-needs-subject]')) gate(node, store.rows ? null : kNoSubject);
  });
  return el('span', { class: 'subject' }, machine, rows);
}

/** The command behind what was done last: to copy, with its progress and a way to end it. */
function commandBar() {
  const words = el('code', { id: 'command', tabindex: '0' }),
    state = el('span', { id: 'job-state', role: 'status' });
  const meter = el('progress', { max: '1', value: '0', hidden: '' });
  const stop = el('button', { type: 'button', class: 'quiet', id: 'cancel', hidden: '' }, 'Cancel');
  stop.addEventListener('click', cancel);
  const copy = el('button', { type: 'button', class: 'quiet' }, 'Copy');
  copy.addEventListener('click', () => navigator.clipboard?.writeText(words.textContent));
  on('job', () => {
    const one = job.current ?? job.last;
    words.textContent = one.command;
    meter.hidden = stop.hidden = one.state !== 'running';
    meter.value = one.fraction;
    // Exit status 2 is an answer, not a failure: a tolerance or a limit is not met.
    const saysNo = one.state === 'failed' && one.exit === 2;
    const ended = saysNo ? 'done, the answer is no' : one.state;
    state.textContent =
      one.state === 'running' ? `${Math.round(100 * one.fraction)} % ${one.step}` : `${ended}, ${number(one.seconds, 2)} s`;
    state.dataset.state = saysNo ? 'no' : one.state;
  });
  return el('footer', {}, el('span', { class: 'prompt' }, '$'), words, copy, meter, state, stop);
}

function themeButton() {
  const node = el('button', { type: 'button', class: 'quiet', id: 'theme', title: 'light or dark' }, '◐');
  const dark = () =>
    (document.documentElement.dataset.theme ?? (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light')) === 'dark';
  node.addEventListener('click', () => {
    document.documentElement.dataset.theme = dark() ? 'light' : 'dark';
    redrawCharts();
    redrawAll();
  });
  return node;
}

function remembered() {
  try {
    return JSON.parse(localStorage.getItem(`chosen:${store.folder}`)) ?? {};
  } catch {
    return {};
  }
}

async function start() {
  store.commands = await getJson('/api/commands');
  await refresh();
  const title = el('strong', {}, 'Vernier');
  const nav = el('nav', { 'aria-label': 'Steps' });
  const main = el('main', {}),
    way = guide();
  document.body.append(
    el('a', { class: 'skip', href: '#main' }, 'to the content'),
    el(
      'header',
      {},
      title,
      el('span', { class: 'note folder', title: `${store.folder}, Vernier ${store.version}` }, store.folder),
      nav,
      subjectBar(),
      way.show,
      themeButton(),
    ),
    way.root,
    main,
    commandBar(),
    fileNames(),
  );
  main.id = 'main';
  for (const [id, name, build] of kViews) {
    const root = el('div', { id: `view-${id}`, class: 'view' });
    const link = el('a', { href: `#${id}` }, name);
    nav.append(link);
    main.append(root);
    views.set(id, { root, link, view: build(root) });
  }
  rememberTheWay();
  addEventListener('hashchange', () => show(location.hash.slice(1)));
  show(location.hash.slice(1));
  const old = remembered(),
    there = (name) => store.files.some((file) => file.name === name);
  const machines = store.files.filter((file) => file.kind === 'machine'),
    rows = await measurementFiles();
  await choose(
    there(old.machine) ? old.machine : machines.length === 1 ? machines[0].name : '',
    old.measurements?.every(there) && old.measurements.length ? old.measurements : rows.length === 1 ? rows : [],
  );
  document.body.dataset.ready = 'yes';
}

matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => redrawAll());
start().catch((error) => document.body.append(el('p', { class: 'error' }, error.message)));

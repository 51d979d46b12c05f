// SPDX-License-Identifier: GPL-3.0-or-later
import { el, table } from '../../../report/web/src/dom.js';
import { number } from '../../../report/web/src/data.js';
import { run } from './api.js';
import { button, gate, guarded, panel } from './parts.js';
import { on, store } from './store.js';

const left = (name) => ({ name, left: true });
const day = (time) => (time ? time.replace('T', ' ').replace('Z', '') : '');

// Of the state that `vernier fleet status` tells.
const heardWord = { online: 'online', stale: 'STALE', away: 'AWAY' };

function machinesTable(status, due) {
  const heard = new Map(status.machines.map((one) => [one.machine, one]));
  // Those that are only heard of stand in both lists: what is heard enters a machine.
  const rows = due.machines.map((one) => {
    const live = heard.get(one.machine);
    return [
      one.machine,
      live ? (heardWord[live.state] ?? live.state) : 'never heard',
      live ? (live.online ? live.mode : `last: ${live.mode}`) : '',
      live && live.fault !== 'none' ? live.fault : '',
      live?.image ?? '',
      live ? day(live.at) : '',
      one.due ? one.why : '',
      day(one.checked_at),
      one.verdict,
    ];
  });
  return table(
    `${rows.length} machines, the most overdue first; times in UTC`,
    ['machine', 'heard', 'mode', 'fault', 'image', 'newest sample', 'due for a check', 'last check', 'verdict'].map(left),
    rows,
  );
}

/** What one quantity does over the fleet, in a sentence each. */
function driftWords(drift) {
  const name = `${drift.quantity}: `;
  if (!drift.judged) return [`${name}too few data (${drift.machines} machines, ${drift.times} times)`];
  const words = drift.own.map(
    (one) => `${name}${one.machine} drifts by itself, ${number(one.per_day, 3)} ± ${number(one.std, 2)} ${drift.unit} a day`,
  );
  if (drift.common)
    words.unshift(
      `${name}${drift.machines - drift.own.length} machines change alike, by ${number(drift.common_swing, 3)} ${drift.unit}: look for a common cause`,
    );
  return words.length ? words : [`${name}nothing drifts (${drift.machines} machines, ${drift.times} times)`];
}

export function fleetView(root) {
  const error = el('div', { id: 'fleet-error' }),
    machines = el('div', { id: 'fleet-machines' }),
    drifts = el('ul', { id: 'fleet-drifts' }),
    batches = el('ul', { id: 'fleet-batches' });
  const registry = el('input', {
    type: 'text',
    id: 'fleet-registry',
    'aria-label': 'registry',
    placeholder: 'fleet.db, or postgresql://…',
    spellcheck: 'false',
  });
  on('project', () => {
    const there = store.files.find((file) => file.name === 'fleet.db');
    if (!registry.value && there) registry.value = there.name;
  });
  const ready = () => gate(look, registry.value.trim() ? null : 'State the registry first: a file of the project, or postgresql://…');
  const ask = async (what) => (await run({ command: `fleet ${what}`, registry: registry.value })).result;
  const look = button(
    'Look',
    () =>
      guarded(error, async () => {
        const status = await ask('status'),
          due = await ask('due'),
          alike = await ask('alike'),
          booked = (await ask('answers')).answers;
        machines.replaceChildren(machinesTable(status, due));
        drifts.replaceChildren(...alike.quantities.flatMap(driftWords).map((text) => el('li', {}, text)));
        if (!alike.quantities.length) drifts.replaceChildren(el('li', {}, 'no readings of checks yet'));
        batches.replaceChildren(
          ...[...new Set(booked.map((one) => one.name))].map((name) =>
            el('li', {}, `${name}: ${booked.filter((one) => one.name === name).length} answers`),
          ),
        );
      }),
    { id: 'fleet-look' },
  );
  registry.addEventListener('input', ready);
  on('project', ready);
  ready();
  root.append(
    error,
    panel('Machines', el('div', { class: 'controls' }, el('label', { class: 'choice' }, 'registry ', registry), look), machines),
    panel('What drifts', drifts),
    panel('Batches', batches),
  );
  return { show() {} };
}

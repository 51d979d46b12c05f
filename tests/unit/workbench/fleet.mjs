// SPDX-License-Identifier: GPL-3.0-or-later
// fleet.mjs WHICH BIN SOURCE [PICTURES]: the page of the fleet over a registry in the project: who is due, what drifts, batches, and what it
// says of a registry that is none. In a real headless browser, as journey.mjs.
import { execFileSync } from 'node:child_process';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import assert from 'node:assert/strict';
import { bin, data, folder, journey, json, picture, text, vernier, view } from './rig.mjs';

const fleet = (...words) =>
  execFileSync(vernier, ['fleet', ...words], { cwd: folder, stdio: 'ignore', env: { ...process.env, VERNIER_REGISTRY: 'fleet.db' } });

async function seen(page) {
  // GIVEN three machines with four checks each, a booked batch, and one machine that nobody has checked
  writeFileSync(join(folder, 'm.xml'), data('real/nist_probe/machine.xml'), 'latin1');
  writeFileSync(join(folder, 'rows.csv'), data('real/nist_probe/meas.csv'), 'latin1');
  json('fit', 'm.xml', 'rows.csv', '-o', 'fitted.xml');
  execFileSync(vernier, ['check', 'fitted.xml', 'rows.csv', '--history', 'h.json', '--json', 'check.json'], {
    cwd: folder,
    stdio: 'ignore',
  });
  for (const machine of ['VMC-1', 'VMC-2', 'VMC-3']) {
    fleet('add', machine, '--check-days', '7');
    for (const at of ['2026-01-05', '2026-01-12', '2026-01-19', '2026-01-26'])
      fleet('check', machine, '--result', 'check.json', '--history', 'h.json', '--at', at);
  }
  fleet('add', 'New-one', '--check-days', '7');
  for (const machine of ['VMC-1', 'VMC-2']) writeFileSync(join(folder, `${machine}.csv`), data('real/nist_probe/meas.csv'), 'latin1');
  fleet('batch', 'night', '--machine', 'VMC-1', '--machine', 'VMC-2', 'compare', 'fitted.xml', '{machine}.csv');
  for (const machine of ['VMC-1', 'VMC-2']) fleet('task', 'night', machine);
  fleet('collect', 'night');
  // WHEN somebody looks at the fleet
  await view(page, 'fleet');
  await page.evaluate(
    "(() => { const one = document.getElementById('fleet-registry'); one.value = 'fleet.db'; one.dispatchEvent(new Event('input')); })()",
  );
  await page.click('#fleet-look');
  await page.until("document.querySelectorAll('#fleet-batches li').length === 1", 'the answers', 60);
  // THEN the page has what the commands answer
  const due = json('fleet', 'due', '--registry', 'fleet.db').machines;
  const shown = await page.evaluate(
    "[...document.querySelectorAll('#fleet-machines tbody tr')].map((row) => [...row.children].map((cell) => cell.textContent))",
  );
  assert.deepEqual(
    shown.map((row) => [row[0], row[6], row[8]]),
    due.map((one) => [one.machine, one.due ? one.why : '', one.verdict]),
  );
  assert.ok(shown.some((row) => row[0] === 'New-one' && row[6] === 'never checked' && row[1] === 'never heard'));
  const alike = json('fleet', 'alike', '--registry', 'fleet.db').quantities;
  assert.ok(alike.length > 0 && alike.every((one) => one.judged));
  assert.equal(await page.evaluate("document.querySelectorAll('#fleet-drifts li').length"), alike.length);
  assert.ok((await text(page, '#fleet-drifts')).includes('nothing drifts (3 machines, 4 times)'));
  assert.equal(await text(page, '#fleet-batches'), 'night: 2 answers');
  await picture(page, 'fleet');
  // AND a registry that is none is named
  await page.evaluate(
    "(() => { const one = document.getElementById('fleet-registry'); one.value = 'rows.csv'; one.dispatchEvent(new Event('input')); })()",
  );
  await page.click('#fleet-look');
  await page.until("document.querySelector('#fleet-error .error')", 'the error', 60);
  assert.ok((await text(page, '#fleet-error')).includes('rows.csv'));
}

assert.ok(bin);
await journey({ seen }, { seen: /rows\.csv/ });

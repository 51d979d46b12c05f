// SPDX-License-Identifier: GPL-3.0-or-later
// journey.mjs WHICH BIN SOURCE [PICTURES]: the workbench as a person uses it, in a real headless browser; what the page
// shows is compared with what the command gives. PICTURES: a folder that gets a picture of each view. Prints
// "journey: Skipped, ..." where there is no browser.
import { execFileSync } from 'node:child_process';
import { copyFileSync, existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import assert from 'node:assert/strict';
import {
  attribute,
  bin,
  board,
  data,
  done,
  folder,
  journey,
  json,
  near,
  picture,
  pictures,
  source,
  started,
  text,
  top,
  view,
} from './rig.mjs';

/** The numbers of Compare against those of the command that the page shows. */
async function checkCompare(page, machine, rows) {
  await view(page, 'compare');
  await page.until(
    `document.getElementById('command').textContent === 'vernier compare ${machine} ${rows} --datum' && document.getElementById('compare-figures')`,
    'the numbers of compare',
  );
  const wanted = json('compare', machine, rows, '--datum');
  // What stood there before goes when the numbers of this command come.
  await page.until(
    `Math.abs(Number(document.getElementById('compare-figures')?.dataset.rms) - ${wanted.rms_um}) <= 1e-9 * ${Math.max(1, wanted.rms_um)}`,
    `the rms of ${rows}`,
  );
  near(await attribute(page, '#compare-figures', 'checkRms'), wanted.check_rms_um, 'check rms');
  assert.ok((await text(page, '#compare-figures')).includes(Number(wanted.rms_um.toPrecision(4)).toString()), 'the rms is readable');
  return wanted;
}

/** From an image to a correction that runs on a board. */
async function bringToBoard(page, axes) {
  await view(page, 'board');
  await page.until("document.querySelector('#safety tbody tr')", 'the sheet before anything is compiled');
  await page.click('#compile');
  await page.until("document.getElementById('bound')", 'the bound', 60);
  const image = await page.evaluate("document.getElementById('image').value");
  const bound = JSON.parse(readFileSync(join(folder, image, 'bound.json')));
  near(await attribute(page, '#bound', 'bound'), bound.bound_um, 'proved bound');
  await page.click('#make-key');
  await done(page, 'vernier keys');
  const url = await board(axes, 'keys');
  await page.type('#board-url', url);
  await page.click('#upload');
  await done(page, `vernier upload ${image} --to ${url} --key keys/vernier.key`);
  await page.until(`document.getElementById('slots').dataset.trial === '${bound.fingerprint}'`, 'the image on trial');
  assert.equal(json('status', '--to', url).trial, bound.fingerprint);
  await page.click('#confirm');
  await page.until(`document.getElementById('slots').dataset.confirmed === '${bound.fingerprint}'`, 'the confirmed image');
  assert.equal(json('status', '--to', url).confirmed, bound.fingerprint);
  await page.click('#diff');
  await page.until("document.querySelector('#difference [data-same]')", 'the difference');
  assert.equal(await attribute(page, '#difference [data-same]', 'same'), 'true');
  await page.click('#watch');
  await page.until("Number(document.getElementById('live-state').dataset.rate) >= 10", 'ten pictures a second', 20);
  await page.until("document.getElementById('live-state').dataset.mode === 'active'", 'the board to be active', 20);
  await new Promise((wait) => setTimeout(wait, pictures ? 6000 : 500));
  await picture(page, 'board', '#slots');
  await picture(page, 'live', '#watch');
  await picture(page, 'compile', '#compile');
  await goesStale(page, started.at(-1));
}

/** A board that falls silent is not shown as if it were well. */
async function goesStale(page, silent) {
  assert.ok(!(await page.evaluate("document.querySelector('.stale')")), 'a board that speaks is not stale');
  silent.kill('SIGSTOP');
  await page.until("document.querySelector('.stale') && document.querySelector('#live-state.error')", 'the live view to turn red', 20);
  assert.ok((await text(page, '#live-state')).includes('what is shown is old'), 'it says so');
  silent.kill('SIGCONT');
  await page.until("document.getElementById('watch').textContent === 'Watch' || !document.querySelector('.stale')", 'an end or news', 20);
  if ((await text(page, '#watch')) === 'Stop') await page.click('#watch');
}

/** Rows within a part of the histogram, as many as its bins count. */
async function chooseInHistogram(page) {
  const bars = '[role=img][aria-label^="histogram"]';
  await page.evaluate(`document.querySelector('${bars}').scrollIntoView({ block: 'center' })`);
  await page.until(`document.querySelector('${bars} canvas')`, 'the histogram');
  const [x, y, w, h] = await page.evaluate(
    `(() => { const b = document.querySelector('${bars}').getBoundingClientRect(); return [b.left, b.top, b.width, b.height]; })()`,
  );
  await page.drag([x + 58 + (w - 74) / 2, y + h / 2], [x + w - 17, y + h / 2]);
  await page.until("Number(document.getElementById('chosen-count').textContent) > 0", 'the rows of the upper half');
  const [count, sum] = await page.evaluate(
    `(() => { const [, chosen] = document.querySelector('${bars}').options().option.series; return [Number(document.getElementById('chosen-count').textContent), chosen.data.reduce((all, [, one]) => all + one, 0)]; })()`,
  );
  assert.ok(count > 20 && count < 220, `about half of the 240 rows: ${count}`);
  assert.equal(sum, count);
}

/** The chosen rows are the same in all views, and can be left out with a reason and put back. */
async function brushAndExclude(page, rows) {
  await chooseInHistogram(page);
  await page.evaluate("document.querySelector('.matrix canvas').scrollIntoView({ block: 'center' })");
  const box = await page.evaluate(
    "(() => { const b = document.querySelector('.matrix canvas').getBoundingClientRect(); return [b.left, b.top, b.width, b.height]; })()",
  );
  await page.drag([box[0] + 52, box[1] + 20], [box[0] + box[2] * 0.5, box[1] + box[3] - 34]);
  await page.until("Number(document.getElementById('chosen-count').textContent) > 0", 'a choice of rows');
  const count = Number(await text(page, '#chosen-count'));
  await picture(page, 'compare_matrix', '.matrix');
  await page.evaluate("document.querySelector('.rows').scrollTop = 0");
  await page.type('input[aria-label="reason"]', 'door was open');
  await page.click('#exclude');
  const kept = rows.replace(/\.csv$/, '.kept.csv');
  await page.until(`document.getElementById('measurement').value === '${kept}'`, 'the rows to be left out');
  const listed = json('exclude', kept);
  assert.equal(listed.excluded.length, count);
  assert.ok(listed.excluded.every((one) => one.reason === 'door was open'));
  const parts = await page.until("document.querySelector('#excluded-list li')?.textContent", 'the list of excluded rows');
  assert.ok(parts.includes(`${count} rows`) && parts.includes('door was open'), parts);
  await page.click('#excluded-list .restore');
  await page.until("document.querySelector('#excluded-list').textContent.includes('no row is left out')", 'the rows to come back');
  assert.equal(readFileSync(join(folder, kept), 'latin1'), readFileSync(join(folder, rows), 'latin1'));
  await page.choose('#machine', await page.evaluate("document.getElementById('machine').value"));
  await page.choose('#measurement', rows);
}

/** A plot can be saved, and no view is wider than a small screen. */
async function exports(page) {
  await page.evaluate(
    '(() => { const make = URL.createObjectURL; URL.createObjectURL = (blob) => { window.saved = blob; return make.call(URL, blob); }; })()',
  );
  const press = (label) =>
    page.evaluate(
      `[...document.querySelector('.matrix figure').querySelectorAll('.exports button')].find((one) => one.textContent === '${label}').click()`,
    );
  await press('SVG');
  const svg = await page.evaluate('window.saved.text()');
  assert.ok(
    svg.startsWith('<svg ') && svg.endsWith('</svg>') && (svg.match(/h0/g) ?? []).length === 240,
    'one dot for each of the 240 rows',
  );
  await press('PNG');
  await page.until("window.saved.type === 'image/png' && window.saved.size > 1000", 'the PNG');
  for (const name of ['project', 'compare', 'diagnose', 'add', 'board', 'fleet']) {
    await view(page, name);
    assert.ok(await page.evaluate('document.documentElement.scrollWidth <= innerWidth'), `${name} fits 1280 px`);
  }
}

async function ballbar(page) {
  await page.drop([
    { name: 'xy.b5r', text: data('ballbar/ur10e_xy_100mm.b5r') },
    { name: 'circle.xml', text: readFileSync(join(source, 'tables/machines/xy_ball_bar.xml'), 'utf8') },
  ]);
  await page.until(
    "document.getElementById('machine').value === 'circle.xml' && document.getElementById('measurement').value === 'xy.csv'",
    'the import',
  );
  await picture(page, 'project');
  await checkCompare(page, 'circle.xml', 'xy.csv');
  await page.until("document.querySelectorAll('[role=img][aria-label^=Polar]').length === 1", 'the polar plot');
  await page.evaluate("document.querySelector('[role=img][aria-label^=Polar]').scrollIntoView({ block: 'center' })");
  const polar = await page.evaluate(
    "(() => { const b = document.querySelector('[role=img][aria-label^=Polar]').getBoundingClientRect(); return [b.left + b.width / 2, b.top + b.height / 2, Math.min(b.width, b.height) / 2]; })()",
  );
  await page.drag([polar[0] + 0.8 * polar[2], polar[1] - 5], [polar[0] + 0.1 * polar[2], polar[1] - 0.8 * polar[2]]);
  await page.until("Number(document.getElementById('chosen-count').textContent) > 100", 'the rows of a sector');
  await picture(page, 'polar', '[role=img][aria-label^=Polar]');
  // Lines beyond the file's own are refused where they are: the dropped file with a word that is no number.
  await view(page, 'project');
  await page.drop([{ name: 'bad.csv', text: 'X[mm],x[mm]\n1,2\n3,4,5\n' }]);
  await page.until("document.querySelector('#drop-error .bad')", 'the error at the line');
  assert.ok((await text(page, '#drop-error .error')).startsWith('bad.csv:3: '));
  assert.ok((await text(page, '#drop-error .bad')).includes('3,4,5'));
  assert.ok(!existsSync(join(folder, 'bad.csv')));
  await view(page, 'add');
  await page.click('#fit');
  await page.until("document.querySelector('#steps .tiles')", 'the first step');
  const fitted = json('fit', 'circle.xml', 'xy.csv');
  near(await attribute(page, '#steps .tiles', 'rms'), fitted.rms_um, 'fitted rms');
  near(await attribute(page, '#steps .tiles', 'checkRms'), fitted.check_rms_um, 'fitted check rms');
  await checkCompare(page, 'circle-fitted.xml', 'xy.csv');
  // This record lost samples: no model helps on its held-out rows, and none of them becomes an image.
  await view(page, 'board');
  await page.until("document.querySelector('#safety tbody tr')", 'the sheet before anything is compiled');
  await page.click('#compile');
  await page.until("document.body.innerText.includes('not safe to run: check-rows')", 'the refusal', 60);
  assert.ok(!(await page.evaluate("document.getElementById('bound')")), 'no bound of an image that was refused');
}

async function survey(page) {
  const hidden = 'hidden/bridge_lag_cyclic';
  await page.drop([
    { name: 'model.xml', text: data(`${hidden}/model.xml`) },
    { name: 'survey.csv', text: data(`${hidden}/survey.csv`) },
  ]);
  await page.until(
    "document.getElementById('machine').value === 'model.xml' && document.getElementById('measurement').value === 'survey.csv'",
    'the files',
  );
  await checkCompare(page, 'model.xml', 'survey.csv');
  await brushAndExclude(page, 'survey.csv');
  await exports(page);
  await view(page, 'diagnose');
  await page.click('#run-diagnose');
  await page.until(
    "document.getElementById('command').textContent.startsWith('vernier diagnose') && document.getElementById('job-state').dataset.state === 'running'",
    'the diagnosis to be at work',
  );
  await page.click('#cancel');
  await page.until("document.getElementById('job-state').dataset.state === 'cancelled'", 'the end of what was cancelled', 10);
  await page.click('#run-diagnose');
  await page.until("document.getElementById('verdict')", 'the verdict', 120);
  const wanted = json('diagnose', 'model.xml', 'survey.csv');
  assert.equal(await attribute(page, '#verdict', 'verdict'), wanted.verdict);
  const shown = await page.evaluate("[...document.querySelectorAll('#candidates tbody tr')].map((row) => row.dataset.add)");
  assert.deepEqual(
    shown,
    wanted.candidates.map((one) => one.add),
  );
  await page.evaluate("document.querySelector('#candidates tbody tr').focus()");
  assert.equal(await attribute(page, '#evidence', 'candidate'), wanted.candidates[0].add);
  assert.ok((await text(page, '#evidence')).includes(wanted.candidates[0].signature));
  assert.ok((await text(page, '#which-residual')).includes('before the fit'), 'the plots and the figures say which residual they show');
  await picture(page, 'diagnose', '#verdict');
  await new Promise((wait) => setTimeout(wait, 1500));
  await picture(page, 'candidates', '#candidates');
  await page.click('#ask-plan');
  await page.until("document.querySelector('#plan p')", 'the plan', 120);
  assert.ok(existsSync(join(folder, 'plan.csv')) && existsSync(join(folder, 'plan.nc')));
  await picture(page, 'plan', '#plan');
  // The first step of the ladder, by the keyboard alone; then the second by its name.
  await page.evaluate("document.querySelector('#candidates .add-candidate').focus()");
  await page.key('Enter');
  await page.until(
    "document.querySelectorAll('#steps canvas').length === 1 && document.getElementById('machine').value === 'model-added-fitted.xml'",
    'the effect to be added',
    120,
  );
  near(await attribute(page, '#steps .tiles', 'rms'), json('fit', 'model-added.xml', 'survey.csv').rms_um, 'rms with the effect');
  await page.click('#show-catalogue');
  const known = json('effects').map((one) => one.id);
  await page.until("document.querySelector('#catalogue tbody tr')", 'the catalogue');
  assert.deepEqual(await page.evaluate("[...document.querySelectorAll('#catalogue tbody tr')].map((row) => row.dataset.add)"), known);
  await page.click('#show-catalogue');
  await page.type('#effect', 'backlash:axis=Y');
  await page.click('#add-effect');
  await page.until("document.getElementById('machine').value === 'model-added-2-fitted.xml'", 'a wrong effect', 120);
  await page.click('#undo-step');
  await page.until(
    "document.getElementById('machine').value === 'model-added-fitted.xml' && document.querySelectorAll('#history .undone').length === 2",
    'the step to be taken back',
  );
  assert.ok(!readFileSync(join(folder, 'history.sh'), 'utf8').includes('model-added-2'), 'what was undone is not replayed');
  await page.type('#effect', wanted.ladder[2].add);
  await page.click('#add-effect');
  await page.until("document.getElementById('machine').value === 'model-added-3-fitted.xml'", 'the second effect', 120);
  const last = await page.evaluate("document.getElementById('machine').value");
  const compared = json('compare', last, 'survey.csv');
  await page.until(
    `Math.abs(Number(document.querySelector('#steps .tiles').dataset.checkRms) - ${compared.check_rms_um}) < 1e-3`,
    'the last step to be drawn',
  );
  // The fits start elsewhere than the ladder's, and what the data do not determine stays where it started: a few per cent.
  assert.ok(
    compared.check_rms_um < 1.05 * wanted.ladder[2].check_rms_um,
    `held-out ${compared.check_rms_um}, the ladder promised ${wanted.ladder[2].check_rms_um}`,
  );
  assert.ok(compared.check_rms_um < 0.45 * wanted.ladder[0].check_rms_um, 'the error has fallen');
  await picture(page, 'add');
  await tune(page, last);
  await checkCompare(page, last, 'survey.csv');
  await bringToBoard(page, [
    ['X', 0, 600],
    ['Y', 0, 400],
    ['Z', -300, 0],
  ]);
  // The script of the history does it all again, to the last byte.
  const again = join(top, 'again');
  execFileSync('mkdir', [again]);
  for (const name of ['model.xml', 'survey.csv', 'history.sh']) copyFileSync(join(folder, name), join(again, name));
  execFileSync('sh', ['history.sh'], { cwd: again, env: { ...process.env, PATH: `${bin}:${process.env.PATH}` }, stdio: 'ignore' });
  assert.equal(readFileSync(join(again, last), 'latin1'), readFileSync(join(folder, last), 'latin1'));
}

/** A slider moves the residual at once; a term of one's own is checked while it is written. */
async function tune(page, machine) {
  const parameter = await page.evaluate("document.getElementById('parameter').value");
  const before = Number(json('compare', machine, 'survey.csv', '--datum').rms_um);
  await page.evaluate("(() => { const s = document.getElementById('slider'); s.value = '0.5'; s.dispatchEvent(new Event('input')); })()");
  await page.until("document.getElementById('slider-figures').dataset.rms", 'the residual to follow');
  assert.ok(Number(await attribute(page, '#slider-figures', 'rms')) > before, `${parameter} moved by hand`);
  await picture(page, 'by_hand', '#slider');
  await page.type('#term', 'k*(T_column-20)*Q');
  await page.until("document.getElementById('term-check').dataset.ok === 'false'", 'the unknown name to be named');
  assert.ok((await text(page, '#term-check')).includes('Q'));
  await page.type('#term', 'k*(X-300)*Y');
  await page.until("document.getElementById('term-check').dataset.ok === 'true'", 'the term to be taken');
  assert.ok((await text(page, '#term-check')).startsWith('k is in 1/mm'));
}

/** Files that mean harm: names and contents are text on the page, and nothing else. */
async function hostile(page) {
  const evil = '<img src=x onerror=window.harmed=1>';
  await page.drop([
    { name: `${evil}.csv`, text: `X[mm],Y[mm],x[mm],run\n1,2,1.001,${evil}\n3,4,3.001,${evil}\n5,9,5.002,b\n` },
    {
      name: 'm.xml',
      text: `<machine name="&lt;script&gt;window.harmed=1&lt;/script&gt;"><variables><static><k value="0" nominal="0" note="x"/></static><machineaxes><X/><Y/></machineaxes></variables><transforms><sixdof n="1" X="X+k" Y="Y"/></transforms></machine>`,
    },
  ]);
  await page.until(`document.getElementById('files').textContent.includes('onerror')`, 'the file with the hostile name');
  await view(page, 'compare');
  await page.until("document.getElementById('compare-figures')", 'the numbers of compare');
  await view(page, 'diagnose');
  await page.click('#run-diagnose');
  await page.until("document.getElementById('verdict') || document.querySelector('#view-diagnose .error')", 'an answer');
  await view(page, 'project');
  await page.drop([
    { name: 'bomb.xml', text: '<!DOCTYPE a [<!ENTITY b "bbbbbbbbbb"><!ENTITY c "&b;&b;&b;&b;&b;&b;">]><machine name="&c;">' },
    { name: 'late.csv', text: 'X[mm]\n1\n' },
  ]);
  await page.until("document.querySelector('#drop-error .error')", 'the refusal');
  assert.equal(await page.evaluate('window.harmed ?? null'), null);
  assert.equal(await page.evaluate("document.querySelectorAll('img, iframe, object, main script').length"), 0);
  // Nothing was asked of any other host.
  const host = await page.evaluate('location.host');
  assert.deepEqual(
    (page.requests ?? []).filter((url) => /^(http|ws)/.test(url) && new URL(url).host !== host),
    [],
  );
  page.complaints = page.complaints.filter((one) => !/422/.test(one)); // the refusals that were asked for
}

await journey({ ballbar, survey, hostile }, { ballbar: /422/ });

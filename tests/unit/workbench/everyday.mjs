// SPDX-License-Identifier: GPL-3.0-or-later
// everyday.mjs WHICH BIN SOURCE [PICTURES]: from files to a corrected machine without a board and without a terminal: the tables of a
// control, a printer, and files that come again, come wrong, or are of no use. In a real headless browser, as journey.mjs.
import { execFileSync } from 'node:child_process';
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import assert from 'node:assert/strict';
import { bin, data, folder, journey, picture, source, text, top, vernier, view } from './rig.mjs';

const quiet = (...words) => execFileSync(vernier, words, { cwd: top, stdio: 'ignore' });
const made = (name) => ({ name, bytes: readFileSync(join(top, name)) });
const command = (page) => text(page, '#command');
const words = (page, selector, part) =>
  page.until(`document.querySelector(${JSON.stringify(selector)})?.textContent.includes(${JSON.stringify(part)})`, `${selector}: ${part}`);
const chosen = (page, machine) => page.until(`document.getElementById('machine').value === ${JSON.stringify(machine)}`, machine);
const measured = (page, name) => page.until(`document.getElementById('measurement').value === ${JSON.stringify(name)}`, name);
const title = (page, selector) => page.evaluate(`document.querySelector(${JSON.stringify(selector)}).title`);
const disabled = (page, selector) => page.evaluate(`document.querySelector(${JSON.stringify(selector)}).disabled`);
const files = (page, id) =>
  page.evaluate(`[...document.querySelectorAll('#${id} .files a')].map((one) => [one.textContent, one.getAttribute('download')])`);

/** Three laser runs of a shop and the fits of two machine files: the second has ranges that nobody measured. */
function shopData() {
  for (const axis of ['X', 'Y', 'Z'])
    quiet(
      'import',
      'table',
      join(source, `tests/data/router/Portal_${axis}.csv`),
      '--set',
      'u[um]=1.2',
      '--check-every',
      '5',
      '-o',
      `${axis}.csv`,
    );
  for (const [name, range] of [
    ['router', 1200],
    ['long', 2400],
  ]) {
    quiet(
      'new',
      'gantry',
      '--axis',
      `X:0:${range}`,
      '--axis',
      'Y:0:800',
      '--axis',
      'Z:-150:0',
      '--errors',
      'positioning',
      '-o',
      `${name}-0.xml`,
    );
    quiet('fit', `${name}-0.xml`, 'X.csv', 'Y.csv', 'Z.csv', '-o', `${name}.xml`);
  }
}

/** The tables of a control for a machine that is safe to run; each format of the program can be had. */
async function tablesOfAControl(page) {
  await page.drop([made('router.xml'), made('X.csv'), made('Y.csv'), made('Z.csv')]);
  await chosen(page, 'router.xml');
  await measured(page, 'X.csv + Y.csv + Z.csv');
  await view(page, 'export');
  assert.ok(await disabled(page, '#do-export'));
  assert.equal(await title(page, '#do-export'), 'Choose the control or the format first');
  const help = execFileSync(vernier, ['completion', 'json'], { maxBuffer: 1 << 24 });
  const formats = JSON.parse(help)
    .map((one) => one.name)
    .filter((name) => name.startsWith('export '))
    .map((name) => name.slice(7));
  assert.deepEqual(
    (await page.evaluate("[...document.getElementById('export-format').options].map((one) => one.value)")).slice(1).sort(),
    formats.sort(),
  );
  await page.choose('#export-format', 'siemens');
  for (const name of ['step', 'tolerance', 'reference', 'numbers', 'leave-out', 'at', 'accept'])
    assert.ok(
      await page.evaluate(`document.querySelector('#export-options [data-option="${name}"]')`.concat(' !== null')),
      `a field for ${name}`,
    );
  await page.click('#do-export');
  await words(page, '#export-result', 'The machine was not measured with these files');
  assert.equal(await command(page), 'vernier export siemens router.xml -o siemens-router');
  quiet('export', 'siemens', join(folder, 'router.xml'), '-o', 'by_hand');
  const names = readdirSync(join(top, 'by_hand'));
  assert.deepEqual((await files(page, 'export-result')).map(([name]) => name).sort(), names.map((name) => `siemens-router/${name}`).sort());
  for (const name of names)
    assert.equal(readFileSync(join(folder, 'siemens-router', name), 'latin1'), readFileSync(join(top, 'by_hand', name), 'latin1'));
  // Each can be saved under its own name.
  const [[name, saved]] = await files(page, 'export-result');
  assert.equal(`siemens-router/${saved}`, name);
  const got = await page.evaluate(`fetch(document.querySelector('#export-result .files a').href).then((one) => one.text())`);
  assert.equal(got, readFileSync(join(folder, name), 'utf8'));
  await picture(page, 'export', '#export-format');
  // A format without a folder; what a format cannot express is told in the words of the page.
  await page.choose('#export-format', 'isg-csv');
  await page.click('#do-export');
  await words(page, '#export-result', 'One file is written');
  assert.ok(existsSync(join(folder, 'isg-csv-router.csv')));
  await page.choose('#export-format', 'grbl');
  await page.click('#do-export');
  await words(page, '#export-error', 'the field "steps"');
  assert.equal(await page.evaluate("document.querySelector('#guide [data-step=upload]').classList.contains('done')"), true);
}

/** A machine that is not safe everywhere: what is not met can be accepted on the page, for an image and for a control. */
async function accepted(page) {
  await view(page, 'project');
  await page.drop([made('long.xml')]);
  await chosen(page, 'long.xml');
  await view(page, 'board');
  await words(page, '#safety-words', 'mark "measured-range", "uncertainty", "disturbed" in the field "accept"');
  assert.ok((await text(page, '#safety-words')).startsWith('Not safe to run: measured-range'), 'said once');
  assert.ok(!(await text(page, '#safety-words')).includes('--accept'));
  await page.click('#compile');
  await words(page, '#board-error', 'in the field "accept"');
  const mark = (view_id, rule) => page.click(`#view-${view_id} [data-option=accept] [data-word=${rule}]`);
  for (const rule of ['measured-range', 'disturbed', 'uncertainty']) await mark('board', rule);
  await picture(page, 'accept', '#compile');
  await page.click('#compile');
  await page.until("document.getElementById('bound')", 'the image', 60);
  assert.ok((await command(page)).includes('--accept uncertainty --accept measured-range --accept disturbed'), await command(page));
  await view(page, 'export');
  await page.choose('#export-format', 'heidenhain');
  await page.click('#do-export');
  await words(page, '#export-error', 'in the field "accept"');
  for (const rule of ['measured-range', 'disturbed', 'uncertainty']) await mark('export', rule);
  await page.click('#do-export');
  await words(page, '#export-result', 'The machine was not measured with these files');
  assert.ok(existsSync(join(folder, 'heidenhain-long')));
  // Or the machine works only where it was measured: the rule then holds.
  await view(page, 'board');
  await page.click('#measured-travel');
  await chosen(page, 'long-travel.xml');
  await words(page, '#safety-words', 'mark "disturbed" in the field "accept"');
  assert.ok(!(await text(page, '#guide-hint')).includes('--'), await text(page, '#guide-hint'));
}

/** A part program with the correction, and the map in German. */
async function programAndMap(page) {
  await page.choose('#machine', 'router.xml');
  await view(page, 'project');
  await page.drop([{ name: 'part.nc', text: 'G21 G90\nG1 X100 Y100 Z-10 F1000\nG1 X600 Y300\nM2\n' }]);
  await words(page, '[data-advice="part.nc"]', 'part program');
  await view(page, 'export');
  assert.ok(await disabled(page, '#do-correct'));
  assert.equal(await title(page, '#do-correct'), 'State "path" first');
  await page.type('#view-export [data-option=path]', 'part.nc');
  await page.evaluate("document.querySelector('#view-export [data-option=path]').dispatchEvent(new Event('change'))");
  await page.click('#do-correct');
  await words(page, '#correct-result', 'The corrected file is written');
  assert.ok(readFileSync(join(folder, 'part_corrected.nc'), 'utf8').includes('X'));
  await view(page, 'compare');
  await page.until("document.getElementById('compare-figures')", 'the comparison');
  await page.choose('#report-language', 'de');
  await view(page, 'export');
  await page.click('#do-map');
  await words(page, '#map-result', 'map-router.html');
  assert.ok(readFileSync(join(folder, 'map-router.html'), 'utf8').includes('"language":"de"'), 'the map is German');
}

/** Three runs are chosen: the report about an axis takes the run along this axis; it is German. */
async function positioning(page) {
  await view(page, 'compare');
  await page.until("document.getElementById('compare-figures')", 'the comparison');
  // A length with its unit, as people write it.
  await page.type('[aria-label="tolerance of A"]', '50 µm');
  await page.click('#handover-positioning');
  await words(page, '#handover-answer', 'Not met');
  assert.ok((await command(page)).startsWith('vernier evaluate iso230-2 X.csv --axis X '), await command(page));
  assert.ok((await command(page)).includes('--tolerance A=50um'), await command(page));
  assert.ok((await command(page)).includes('--language de'), await command(page));
  assert.ok(readFileSync(join(folder, 'iso230-2_X.html'), 'utf8').includes('"language":"de"'), 'the report is German');
}

async function shop(page) {
  shopData();
  await tablesOfAControl(page);
  await accepted(page);
  await programAndMap(page);
  await positioning(page);
  await sheetsOfAWorkbook(page);
  await assumptions(page);
  await pointsOfAMill(page);
}

/** What the program assumed is said in the words of the page, and the file can be read differently. */
async function assumptions(page) {
  await view(page, 'project');
  await page.drop([
    {
      name: 'titled.csv',
      text: 'Abweichungen in µm (Ist - Soll)\nLage: Y=200, Z=-190 mm\nX Soll [mm];Abweichung X\n0;1,5\n100;2,5\n200;4,0\n',
    },
  ]);
  await words(page, '#imported', '"Y[mm]=POSITION" in the field "set"');
  assert.ok(!(await text(page, '#imported')).includes('--'), await text(page, '#imported'));
  assert.ok((await text(page, '[data-file="titled.csv"]')).includes('read into titled_read.csv'), 'what became of the dropped file');
  // The dropped file is read again, with its own headings, not the table that was made of it.
  await page.click('[data-file="titled_read.csv"] .differently');
  await words(page, '#sheet-columns', 'Abweichung X');
}

/** A workbook with a sheet for each axis: every sheet is imported, as the command line can. */
async function sheetsOfAWorkbook(page) {
  await view(page, 'project');
  await page.drop([{ name: 'three_axes.xlsx', bytes: readFileSync(join(source, 'tests/data/sheets/three_axes.xlsx')) }]);
  await measured(page, 'three_axes_read.csv');
  await picture(page, 'everyday_sheets', '.other-sheets');
  // Neither a further file nor another table that is read differently takes the sheets away.
  await page.drop([{ name: 'dial.csv', text: 'X soll;Abweichung X\r\nmm;um\r\n0,00;1,5\r\n100,00;-2,5\r\n200,00;3,0\r\n' }]);
  await measured(page, 'dial_read.csv');
  await page.click('[data-file="dial_read.csv"] .differently');
  await words(page, '#import-box', 'What is in dial.csv?');
  // A spreadsheet that was imported is no measurement, and is not offered as one.
  assert.deepEqual(
    await page.evaluate(
      "[...document.getElementById('measurement').options].map((one) => one.value).filter((one) => one.startsWith('dial'))",
    ),
    ['dial_read.csv'],
  );
  await page.evaluate(
    "[...document.querySelectorAll('[data-of=\"dial.csv\"] button')].find((one) => one.textContent === 'Not now').click()",
  );
  await page.choose('#measurement', 'three_axes_read.csv');
  await measured(page, 'three_axes_read.csv');
  await page.click('.other-sheets [data-sheet="Y"]');
  await measured(page, 'three_axes_read.csv + three_axes_Y.csv');
  await page.click('.other-sheets [data-sheet="Z"]');
  await measured(page, 'three_axes_read.csv + three_axes_Y.csv + three_axes_Z.csv');
  assert.equal(await page.evaluate("document.querySelector('.other-sheets')"), null, 'no sheet is left');
  assert.equal(
    await page.evaluate("document.querySelector('#history li:last-child code').textContent"),
    'vernier import table three_axes.xlsx --sheet Z -o three_axes_Z.csv',
  );
}

/** The files of a printer, from its configuration to a configuration with the correction; the machine file is made on the page. */
async function printer(page) {
  await page.evaluate("document.getElementById('new-machine').open = true");
  await page.type('#new-axes', 'X:0:235 Y:0:235 Z:0:250');
  await page.type('#new-name', 'printer');
  await page.click('#make-machine');
  await chosen(page, 'printer.xml');
  const mesh = Array.from(
    { length: 5 },
    (_, j) => `#*# \t  ${Array.from({ length: 5 }, (__, i) => (0.02 * i - 0.01 * j + 0.003 * i * i).toFixed(6)).join(', ')}\n`,
  ).join('');
  const config = `[printer]\nkinematics: cartesian\n[stepper_x]\nrotation_distance: 40\n[stepper_y]\nrotation_distance: 40\n[stepper_z]\nrotation_distance: 8\n[probe]\nx_offset: -38\ny_offset: -8\n#*# [bed_mesh default]\n#*# version = 1\n#*# points =\n${mesh}#*# x_count = 5\n#*# y_count = 5\n#*# mesh_x_pps = 2\n#*# mesh_y_pps = 2\n#*# algo = bicubic\n#*# tension = 0.2\n#*# min_x = 40.0\n#*# max_x = 180.0\n#*# min_y = 30.0\n#*# max_y = 180.0\n`;
  await page.drop([{ name: 'printer.cfg', text: config }]);
  await measured(page, 'printer_read.csv');
  await words(page, '#import-box', '25 touches of the artefact "bed"');
  assert.equal(
    await page.evaluate("document.querySelector('#history li:last-child code').textContent"),
    'vernier import printer printer.cfg -o printer_read.csv',
  );
  assert.equal(await page.evaluate('document.querySelector(\'[data-file="printer.cfg"]\').dataset.kind'), 'printer');
  await picture(page, 'printer', '#import-box .source');
  // The machine file declares no bed: said with the way to one that does.
  await words(page, '#stood-room', 'write bed:plane into the field "artefact"');
  await page.evaluate("document.querySelector('#begin [data-command=new]').open = true");
  await page.type('#begin [data-option=artefact]', 'bed:plane');
  await page.type('#new-name', 'with_bed');
  await page.click('#make-machine');
  await chosen(page, 'with_bed.xml');
  assert.ok(readFileSync(join(folder, 'with_bed.xml'), 'utf8').includes('<artefact name="bed" type="plane"/>'));
  await page.until("document.getElementById('begin-steps').hidden", 'the rows to be read');
  // The machine file without a bed gets one too.
  const choose = (machine) =>
    page.evaluate(
      `(() => { const one = document.getElementById('machine'); one.value = '${machine}'; one.dispatchEvent(new Event('change', { bubbles: true })); })()`,
    );
  await choose('printer.xml');
  await page.until("document.getElementById('declare')", 'the way to declare the bed');
  await page.click('#declare');
  await chosen(page, 'printer_touched.xml');
  assert.ok(readFileSync(join(folder, 'printer_touched.xml'), 'utf8').includes('<artefact name="bed" type="plane"/>'));
  await choose('with_bed.xml');
  await page.until("document.getElementById('begin-steps').hidden", 'the rows to be read');
  // Read with another offset: the field is there.
  await page.click('#read-differently');
  await page.type('#import-box [data-option=u]', '5');
  await page.type('#import-box [data-option=offset]', '-30; -10');
  await page.click('#do-import');
  await measured(page, 'printer_read-2.csv');
  assert.equal(
    await page.evaluate("document.querySelector('#history li:last-child code').textContent"),
    'vernier import printer printer.cfg --offset -30 --offset -10 --u 5 -o printer_read-2.csv',
  );
  // A log with several surveys says where the number of one is stated.
  const survey = (z, heat) =>
    `Stats ${1000 + heat}.0: heater_bed: target=${heat} temp=${heat}.0\n${[
      [10, 10],
      [100, 10],
      [100, 100],
      [10, 100],
    ]
      .map(([x, y], i) => `probe at ${x}.000,${y}.000 is z=${(z + 0.01 * i).toFixed(6)}\n`)
      .join('')}`;
  await page.drop([
    { name: 'klippy.log', text: `[probe]\nx_offset = -38\ny_offset = -8\nz_offset = 0\n${survey(0, 60)}${survey(0.05, 90)}` },
  ]);
  await words(page, '[data-of="klippy.log"]', 'the field "series"');
  assert.ok(!(await text(page, '[data-of="klippy.log"]')).includes('--'), await text(page, '[data-of="klippy.log"]'));
  // A configuration without a mesh says what is missing, and does not end in silence.
  await page.drop([{ name: 'bare.cfg', text: '[printer]\nkinematics: cartesian\n' }]);
  await words(page, '#import-box .error', 'no configuration with a saved mesh');
  // RepRapFirmware, by the contents of a .csv.
  await page.drop([
    {
      name: 'heightmap.csv',
      text: 'RepRapFirmware height map file v2 generated at 2026-01-01 10:00, min error -0.010, max error 0.030, mean 0.010, deviation 0.010\naxis0,axis1,min0,max0,min1,max1,radius,spacing0,spacing1,num0,num1\nX,Y,20.00,180.00,20.00,180.00,-1.00,80.00,80.00,3,3\n0.010,0.020,0.030\n-0.010,0.000,0.010\n0.000,0.010,0.020\n',
    },
  ]);
  // A height map does not state the offset of its probe: the page asks for it.
  await words(page, '#import-box .error', 'the offset of the probe from the nozzle');
  await page.type('#import-box [data-option=offset]', '0; 0');
  await page.click('#do-import');
  await measured(page, 'heightmap_read.csv');
  await page.choose('#measurement', 'printer_read.csv');
  // A noise that is not known is no number.
  await view(page, 'compare');
  await words(page, '#guide-hint', 'the noise is not known');
  await view(page, 'add');
  await page.click('#fit');
  await chosen(page, 'with_bed-fitted.xml');
  await view(page, 'export');
  await page.choose('#export-format', 'klipper');
  // A probe beside the nozzle touched the bed: without the touches nothing tells the bed from the axes.
  await page.click('#do-export');
  await words(page, '#export-error', 'the field "touches"');
  await page.type('#view-export [data-option=touches]', 'printer_read.csv');
  await page.click('#do-export');
  await words(page, '#export-result', 'klipper-with_bed-fitted/');
  await words(page, '#left-out', 'and the files do not contain it (size unknown)');
  await squareOfAPrinter(page);
}

/** The distances of a printed square and a machine file with all errors: the export offers the fit that measures the skew. */
async function squareOfAPrinter(page) {
  await view(page, 'project');
  await page.choose('#machine', 'with_bed.xml');
  await page.drop([
    {
      name: 'square.csv',
      text: 'point,X[mm],Y[mm],Z[mm],distance[mm],from,u[um]\nA,40,40,0.2,,,10\nB,190,40,0.2,,,10\nC,190,190,0.2,,,10\nD,40,190,0.2,,,10\nA-B,190,40,0.2,150.34,A,10\nB-C,190,190,0.2,149.84,B,10\nC-D,40,190,0.2,150.32,C,10\nD-A,40,40,0.2,149.81,D,10\nA-C,190,190,0.2,212.09,A,10\nB-D,40,190,0.2,212.42,B,10\n',
    },
  ]);
  await measured(page, 'square.csv');
  await page.until("document.body.dataset.subject === 'yes'", 'the rows');
  await view(page, 'add');
  await page.click('#fit');
  await chosen(page, 'with_bed-fitted-2.xml');
  await words(page, '#fit-notes', 'These readings do not determine the squareness beside all other errors');
  assert.equal(await text(page, '#fit-square'), 'Fit the squareness and these scales alone');
  // Fitted once more: what a fit holds are the nominal values of the first machine file, none of a fit before.
  await page.click('#fit');
  await chosen(page, 'with_bed-fitted-3.xml');
  await view(page, 'export');
  await page.choose('#export-format', 'klipper');
  await page.type('#view-export [data-option=touches]', 'printer_read.csv');
  // As printer.cfg has it.
  await page.until("document.querySelector('#view-export [data-option=steps]').value === '40,40,8'", 'the rotation_distance');
  await page.click('#do-export');
  await words(page, '#export-result', 'of with_bed.xml the other errors stay as they are');
  assert.ok(!/vernier (new|fit|import)|--[a-z]/.test(await text(page, '#export-result')), await text(page, '#export-result'));
  await page.click('#fit-again');
  await chosen(page, 'with_bed-fitted-4.xml');
  await words(page, '#export-result', 'press "Write the files" again');
  await page.click('#do-export');
  await words(page, '#export-result', 'squareness XY: the files correct');
  const folder_of = 'klipper-with_bed-fitted-4';
  const [, skew] = readFileSync(join(folder, folder_of, 'vernier.cfg'), 'utf8').match(/xy_skew = (\S+)/);
  // The readings have two decimals over 212 mm: 0.0001 rad.
  assert.ok(Math.abs(Number(skew) + 0.0016) < 1e-4, skew);
  assert.equal(readFileSync(join(folder, folder_of, 'vernier_steppers.cfg'), 'utf8').match(/^rotation_distance/gm).length, 2);
}

/** A square that a printer printed: its sides and diagonals by the names of its corners, without their positions. */
async function caliper(page) {
  await page.evaluate("document.getElementById('new-machine').open = true");
  await page.evaluate("document.querySelector('#begin [data-command=new]').open = true");
  await page.type('#new-axes', 'X:0:235 Y:0:235 Z:0:250');
  await page.choose('#begin [data-option=errors]', 'square');
  await page.type('#new-name', 'square');
  await page.click('#make-machine');
  await chosen(page, 'square.xml');
  await page.drop([{ name: 'caliper.csv', text: 'Strecke;Soll;Ist\nAC;240,42;240,28\nAD;170,00;169,93\nBD;240,42;240,57\n' }]);
  await words(page, '#sheet-message', 'the rows are distances between named points');
  assert.ok(!/--|vernier /.test(await text(page, '#sheet-message')), await text(page, '#sheet-message'));
  const stand = async (point, position) => {
    for (const [axis, value] of Object.entries(position)) await page.type(`#points [data-point="${point}"] [data-axis=${axis}]`, value);
  };
  await stand('A', { X: '30', Y: '30', Z: '0,2' });
  await stand('B', { X: '200', Y: '30', Z: '0,2' });
  await stand('C', { X: '30', Y: '200', Z: '0,2' });
  await stand('D', { X: '200', Y: '200', Z: '0,2' });
  await page.click('#take-points');
  await words(page, '#sheet-message', 'or of C and D are exchanged, all distances agree');
  assert.ok(await page.evaluate("document.getElementById('do-import').disabled"), 'not before the corners are right');
  await stand('C', { X: '200' });
  await stand('D', { X: '30' });
  await page.type('#import-box [data-option=set]', 'u[mm]=0.02');
  await page.click('#take-points');
  await page.until("!document.getElementById('sheet-message') && !document.getElementById('do-import').disabled", 'the corners');
  await picture(page, 'caliper', '#points');
  await page.click('#do-import');
  await measured(page, 'caliper_read.csv');
  assert.equal(
    await page.evaluate("document.querySelector('#history li:last-child code').textContent"),
    "vernier import table caliper.csv --set 'u[mm]=0.02' --point A=30,30,0.2 --point B=200,30,0.2 --point C=200,200,0.2 --point D=30,200,0.2 --machine square.xml -o caliper_read.csv",
  );
  await page.until("document.body.dataset.subject === 'yes'", 'the rows');
  await view(page, 'add');
  await page.click('#fit');
  await chosen(page, 'square-fitted.xml');
  // The squareness of the page touch.
  assert.match(readFileSync(join(folder, 'square-fitted.xml'), 'utf8'), /EC0Y value="0\.00120/);
  await leftOut(page);
  // Where the files of the printer go, and what the scales of a printed part contain.
  await page.choose('#export-format', 'klipper');
  await page.type('#view-export [data-option=steps]', '40,40,8');
  for (const rule of await page.evaluate("[...document.querySelectorAll('#export-options [data-word]')].map((one) => one.dataset.word)"))
    await page.click(`#export-options [data-word="${rule}"]`);
  await page.click('#do-export');
  await words(page, '#export-result', 'write [include vernier_steppers.cfg] into printer.cfg below the sections of the steppers');
  await words(page, '#export-result', 'the shrinkage of its material');
  await denserStations(page);
}

/** A laser whose points are denser than the stations of the only column of the table: the fit has the button that adds stations. */
async function denserStations(page) {
  await view(page, 'project');
  const stations = [0, 200, 400, 600].map((at) => `<station loc="${at}"/>`).join('');
  const rows = [0, 1, 2, 3].flatMap((run) =>
    Array.from(
      { length: 25 },
      (_, i) => `${25 * i},${(25 * i + 0.003 * Math.sin((25 * i) / 40) + 0.0002 * ((i + run) % 3)).toFixed(5)},${run},1`,
    ),
  );
  await page.drop([
    {
      name: 'bench.xml',
      text: `<machine name="bench"><variables><machineaxes><X min="0" max="600"/></machineaxes><comptables><table axis="X" fit="X">${stations}</table></comptables></variables><transforms><sixdof X="X+lXx"/></transforms></machine>`,
    },
    { name: 'laser.csv', text: `X[mm],x[mm],run,u[um]\n${rows.join('\n')}\n` },
  ]);
  await chosen(page, 'bench.xml');
  await measured(page, 'laser.csv');
  await words(page, '#command', 'compare bench.xml');
  await view(page, 'add');
  await page.click('#fit');
  await words(page, '#fit-notes', 'the button "Add stations: X=25"');
  assert.ok(!(await text(page, '#fit-notes')).includes('--stations'));
  await page.click('#fit-notes .add-stations');
  await chosen(page, 'bench-stations-fitted.xml');
  await page.until("document.querySelectorAll('#steps canvas').length === 1", 'the steps');
  assert.equal((readFileSync(join(folder, 'bench-stations-fitted.xml'), 'utf8').match(/<station /g) ?? []).length, 25);
}

/** On a small screen: what a format cannot express stands before the words of success, in sight, and with the last step of the path. */
async function leftOut(page) {
  await page.send('Emulation.setDeviceMetricsOverride', { width: 800, height: 600, deviceScaleFactor: 1, mobile: false });
  await view(page, 'export');
  await page.choose('#export-format', 'axis-csv');
  await page.click('#export-options [data-option="leave-out"]');
  for (const rule of await page.evaluate("[...document.querySelectorAll('#export-options [data-word]')].map((one) => one.dataset.word)"))
    await page.click(`#export-options [data-word="${rule}"]`);
  await page.click('#do-export');
  await words(page, '#left-out', 'position errors');
  assert.ok(
    await page.evaluate(
      "document.getElementById('left-out').compareDocumentPosition(document.querySelector('#export-result .verdict')) & Node.DOCUMENT_POSITION_FOLLOWING",
    ),
    'before the words of success',
  );
  assert.ok(await inSight(page, '#left-out'), 'in sight');
  await words(page, '#guide-hint', 'without: errors outside the tables');
  await picture(page, 'left_out');
  await page.send('Emulation.setDeviceMetricsOverride', { width: 1280, height: 720, deviceScaleFactor: 1, mobile: false });
}

/** Is an element in the part of the window that neither the header nor the footer covers? */
const inSight = (page, selector) =>
  page.until(
    `(() => { const one = document.querySelector(${JSON.stringify(selector)}), box = one.getBoundingClientRect();
      return box.height > 0 && [box.top + 2, box.bottom - 2].every((y) => one.contains(document.elementFromPoint(box.left + 4, y))); })()`,
    `${selector} in sight`,
    5,
  );

/** Waits until a file of the project has a text. */
async function has(name, part) {
  for (let i = 0; i < 200 && !readFileSync(join(folder, name), 'utf8').includes(part); ++i)
    await new Promise((done) => setTimeout(done, 50));
  assert.ok(readFileSync(join(folder, name), 'utf8').includes(part), `${name} has ${part}`);
}

/** A machine that is made after the file was dropped: the question about its other axes is in sight, on a small screen too. */
async function otherAxes(page) {
  await page.send('Emulation.setDeviceMetricsOverride', { width: 800, height: 600, deviceScaleFactor: 1, mobile: false });
  await page.drop([{ name: 'one_axis.csv', text: 'X[mm],x[mm],u[um]\n0,0.001,1\n100,100.002,1\n200,200.004,1\n' }]);
  await measured(page, 'one_axis.csv');
  await page.until("document.getElementById('new-machine').open", 'the way to a machine');
  await page.type('#new-name', 'small');
  await page.click('#make-machine');
  await chosen(page, 'small.xml');
  await words(page, '#stood-room', 'Where did the other axes stand');
  assert.ok(await inSight(page, '#stood-room h2'), 'in sight');
  assert.ok(await inSight(page, '#stood-add'), 'its button too');
  await page.choose('#machine', '');
  await page.send('Emulation.setDeviceMetricsOverride', { width: 1280, height: 720, deviceScaleFactor: 1, mobile: false });
}

/** Files that come again, are taken out, or are of no use: nothing ends in silence or in a refusal without a way on. */
async function again(page) {
  await otherAxes(page);
  // A table with a wrong number, corrected and dropped again under its name.
  await page.drop([{ name: 'dial.csv', text: 'X[mm],x[mm],u[um]\n0,0.001,1\n100,100.002,1\n200,203.004,1\n' }]);
  await measured(page, 'dial.csv');
  await page.drop([{ name: 'dial.csv', text: 'X[mm],x[mm],u[um]\n0,0.001,1\n100,100.002,1\n200,200.004,1\n' }]);
  await words(page, '#drop-error .question', 'the project has a file of this name. Replace it?');
  await picture(page, 'replace', '#drop-error');
  await page.click('#drop-error [data-answer=replace]');
  await has('dial.csv', '200.004');
  // A spreadsheet that became a measurement file, and one that is kept beside.
  await page.drop([{ name: 'dial.csv', text: 'X soll;Abweichung X\r\nmm;um\r\n0,00;1,5\r\n100,00;-2,5\r\n200,00;3,0\r\n' }]);
  await page.click('#drop-error [data-answer=both]');
  await measured(page, 'dial-2_read.csv');
  assert.ok(readFileSync(join(folder, 'dial.csv'), 'utf8').includes('200.004'), 'the other one stays');
  await page.drop([{ name: 'dial.csv', text: 'X[mm],x[mm]\n0,0\n' }]);
  await page.click('#drop-error [data-answer=none]');
  await page.until("!document.querySelector('.question')", 'the question to go');
  assert.ok(readFileSync(join(folder, 'dial.csv'), 'utf8').includes('200.004'), 'not taken in');
  // A replacement with an error replaces nothing.
  await page.drop([{ name: 'dial.csv', text: 'X[mm],x[mm],u[um]\n0,1\n' }]);
  await page.click('#drop-error [data-answer=replace]');
  await words(page, '#drop-error .error', 'dial.csv:2');
  assert.ok(readFileSync(join(folder, 'dial.csv'), 'utf8').includes('200.004'), 'the old file stays');
  // Deleted after a question, which says what the history loses.
  const remove = (name) => page.click(`[data-file="${name}"] .delete`);
  await remove('dial-2.csv');
  await words(page, '#file-error .question', 'history.sh then does not make the same files again');
  await page.click('#file-error [data-answer=keep]');
  assert.ok(existsSync(join(folder, 'dial-2.csv')));
  await remove('dial-2_read.csv');
  await words(page, '#file-error .question', 'history.sh makes it again');
  await page.click('#file-error [data-answer=delete]');
  await page.until(
    "!document.querySelector('[data-file=\"dial-2_read.csv\"]') && document.getElementById('measurement').value === ''",
    'the chosen file to go',
  );
  assert.ok(!existsSync(join(folder, 'dial-2_read.csv')));
  // Of no use: said, with what to do, and deleted in one press.
  await page.drop([
    { name: 'foto.png', text: 'x' },
    { name: 'alt.xls', text: 'x' },
  ]);
  await words(page, '[data-advice="foto.png"]', 'cannot use a file of this kind');
  await words(page, '[data-advice="alt.xls"]', 'save it as .xlsx or as .csv');
  await words(page, '[data-file="foto.png"]', 'the workbench cannot use it');
  await page.click('[data-advice="foto.png"] button');
  await page.until('!document.querySelector(\'[data-file="foto.png"]\')', 'the picture to go');
  // An error in a workbook shows no bytes of the zip file.
  await page.drop([{ name: 'broken.xlsx', text: 'PK\u0003\u0004\u0000\u0000no workbook' }]);
  await words(page, '#import-box', 'broken.xlsx');
  assert.equal(await page.evaluate("document.querySelectorAll('#import-box .source, #drop-error .source').length"), 0);
  // What is not understood is told in the words of the page.
  await page.drop([{ name: 'gauge.csv', text: 'Pos;Anzeige\n0,0;1,5\n100,0;2,5\n200,0;4,0\n' }]);
  await words(page, '#sheet-message', '"Pos" is X[mm]');
  assert.ok(!(await text(page, '#sheet-message')).includes('--'), await text(page, '#sheet-message'));
  await touchesAgain(page);
  await page.drop([{ name: 'gauge2.csv', text: 'Pos;Anzeige\n0,0;1,5\n100,0;2,5\n200,0;4,0\n' }]);
  await words(page, '#sheet-message', '"Pos" is X[mm]');
  // What cannot be pressed says why.
  assert.ok((await title(page, '#do-import')).startsWith('State what is missing first'));
  await view(page, 'compare');
  for (const selector of ['#handover-compare', '#handover-diagnose', '#handover-positioning'])
    assert.equal(await title(page, selector), 'Choose a machine and measurements at the top first', selector);
  await view(page, 'board');
  assert.equal(await title(page, '#upload'), 'There is no image yet: press Compile first');
  await view(page, 'fleet');
  assert.ok((await title(page, '#fleet-look')).startsWith('State the registry first'));
}

/** Touches of a probe again, with the directions of the motion and the radius of the first time. */
async function touchesAgain(page) {
  const rows = [0, 100, 200].map((x) => `${x},0,0,${x},0,0.1,${x},0,0,0,0,1`).join('\n');
  await page.drop([{ name: 'touches.txt', text: `X[mm],Y[mm],Z[mm],mx[mm],my[mm],mz[mm],px[mm],py[mm],pz[mm],nx,ny,nz\n${rows}\n` }]);
  const own = '[data-of="touches.txt"]';
  await page.until(`document.querySelector('${own} [data-option=radius]')`, 'the panel of a probe');
  await page.type(`${own} [data-option=radius]`, '3');
  await page.click(`${own} #do-import`);
  await measured(page, 'touches_read.csv');
  await page.click('[data-file="touches_read.csv"] .differently');
  await page.until(`document.querySelector('${own} [data-option=directions]')`, 'the panel of a probe again');
  assert.equal(await page.evaluate(`document.querySelector('${own} [data-option=radius]').value`), '3');
  await page.choose(`${own} [data-option=directions]`, 'from-order');
  await page.click(`${own} #do-import`);
  await measured(page, 'touches_read-2.csv');
  assert.ok(readFileSync(join(folder, 'touches_read-2.csv'), 'utf8').includes('dirX'));
}

/** The description of a robot becomes a machine file, and a description with its joints comes out. */
async function robot(page) {
  const joint = (k, parent, child, axis, name = `q${k}`) =>
    `<joint name="${name}" type="revolute"><parent link="${parent}"/><child link="${child}"/><origin xyz="0 0 0.4" rpy="0 0 0"/><axis xyz="${axis}"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>`;
  const axes = ['0 0 1', '0 1 0', '0 1 0', '0 0 1', '0 1 0', '0 0 1'];
  const links = axes.map((_, k) => `<link name="l${k + 1}"/>`).join('');
  await page.drop([
    {
      name: 'arm.urdf',
      text: `<robot name="arm"><link name="l0"/>${links}${axes.map((one, k) => joint(k + 1, `l${k}`, `l${k + 1}`, one)).join('')}</robot>`,
    },
  ]);
  // What is measured is asked before there is a machine file: a reflector has no place in the description of a robot.
  await words(page, '#drop-error .question', 'A reflector is on the flange at a place that nobody measured');
  await picture(page, 'robot_measured', '#drop-error');
  // The question stays until it is answered, whatever is dropped in the meantime.
  await page.drop([{ name: 'foto.png', text: 'x' }]);
  await words(page, '[data-advice="foto.png"]', 'cannot use a file of this kind');
  await page.drop([{ name: 'torn.urdf', text: '<robot' }]);
  await words(page, '#drop-error .error', 'torn.urdf');
  await page.click('[data-file="arm.urdf"] .use');
  await page.until(
    "document.querySelectorAll('#drop-error .question').length === 1 && !document.querySelector('#drop-error .error')",
    'one question',
  );
  await words(page, '#drop-error .question', 'arm.urdf: what does the instrument measure at the tool?');
  await page.click('#drop-error [data-answer=point]');
  await chosen(page, 'arm.xml');
  assert.ok(!readFileSync(join(folder, 'arm.xml'), 'utf8').includes('<ToolShift'));
  assert.equal(await page.evaluate('document.querySelector(\'[data-file="arm.urdf"]\').dataset.kind'), 'robot');
  await view(page, 'export');
  await page.choose('#export-format', 'urdf');
  assert.equal(await page.evaluate('document.querySelector(\'#export-options [data-option="original"]\').value'), 'arm.urdf');
  await page.click('#do-export');
  await words(page, '#export-result', 'the joints of arm.urdf are those of the machine file');
  await words(page, '#export-result', 'difference from the machine file at 1000 poses');
  assert.deepEqual(await files(page, 'export-result'), [['urdf-arm/robot.urdf', 'robot.urdf']]);
  assert.ok(readFileSync(join(folder, 'urdf-arm/robot.urdf'), 'utf8').includes('q6'));
  await jointsOfOtherNames(page);
  await unknownTool(page);
  await pointsAndPositions(page);
  await logWithoutUnits(page);
  await numberedPointsOfARobot(page);
  await noReadingsYet(page);
  await jointsOfTheirOwn(
    page,
    (names) =>
      `<robot name="own"><link name="l0"/>${links}${axes.map((one, k) => joint(k + 1, `l${k}`, `l${k + 1}`, one, names[k])).join('')}</robot>`,
  );
  await severalEnds(
    page,
    (ends) =>
      `<robot name="arm"><link name="l0"/>${links}${axes.map((one, k) => joint(k + 1, `l${k}`, `l${k + 1}`, one)).join('')}${ends}</robot>`,
  );
}

const turned = (axis, angle, [x, y, z]) => {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return axis === 'z' ? [c * x - s * y, s * x + c * y, z] : [c * x + s * z, y, c * z - s * x];
};

/** Joints and point, in deg and mm, of poses of the arm of this journey, whose joints turn about z y y z y z. */
const posesOf = (place) =>
  Array.from({ length: 40 }, (_, i) => {
    const angles = Array.from({ length: 6 }, (__, k) => ((i * (37 + 11 * k) + k * 23) % 150) - 75);
    const point = [...'zyyzyz'].reduceRight(
      (at, axis, k) => turned(axis, (angles[k] * Math.PI) / 180, at).map((one, j) => one + (j === 2 ? 400 : 0)),
      place,
    );
    return { angles, point };
  });

const kReflectorPlace = [30, -20, 118];

/** The same as a measurement file, with a reflector that no file names. */
const reflectorPoses = () =>
  `${['q1', 'q2', 'q3', 'q4', 'q5', 'q6'].map((one) => `${one}[deg],`).join('')}x[mm],y[mm],z[mm],u[um]\n${posesOf(kReflectorPlace)
    .map(({ angles, point }, i) => [...angles, ...point.map((one, j) => (one + 0.01 * Math.sin(7 * i + 3 * j)).toFixed(4)), 10].join(','))
    .join('\n')}\n`;

/**
 * A robot whose joints have names of their own, the log of its control (A1 to A6, and the position that the control computed), and
 * a tracker's list without headings: every way on is a button, and no file is edited.
 */
async function jointsOfTheirOwn(page, arm) {
  const kJoints = ['turret', 'shoulder', 'elbow', 'forearm', 'wrist', 'flange'];
  const control = posesOf([0, 0, 0]),
    reflector = posesOf(kReflectorPlace);
  const log = (value) =>
    `Name;A1;A2;A3;A4;A5;A6;X;Y;Z\n${control
      .map(({ angles, point }, i) => [`P${i + 1}`, ...angles.map(value), ...point.map((one) => one.toFixed(3))].join(';'))
      .join('\n')}\n`;
  await view(page, 'project');
  await page.drop([{ name: 'own.urdf', text: arm(kJoints) }]);
  await page.click('#drop-error [data-answer=reflector]');
  await chosen(page, 'own.xml');
  await page.drop([{ name: 'control.csv', text: log((one) => one) }]);
  const ofLog = '[data-of="control.csv"]';
  await words(page, `${ofLog} #sheet-message`, 'the control probably computed it from the joints, and it is no measurement');
  assert.deepEqual(await page.evaluate(`[...document.querySelectorAll('${ofLog} #sheet-robot li')].map((one) => one.textContent)`), [
    ...kJoints.map((one, k) => `${one}[deg]: "A${k + 1}"`),
    'x[mm]: "X"',
    'y[mm]: "Y"',
    'z[mm]: "Z"',
  ]);
  await picture(page, 'robot_log', `${ofLog} .panel`);
  await page.click(`${ofLog} #sheet-assignment-is-right`);
  await page.until(
    `document.querySelector('${ofLog} .source')?.textContent.includes('turret[deg],shoulder[deg]')`,
    'the joints in the table',
  );
  const list = reflector.map(({ point }) => point.map((one) => one.toFixed(4)).join('\t')).join('\n');
  await page.drop([{ name: 'list.txt', text: `${list}\n` }]);
  const own = '[data-of="list.txt"]';
  await words(page, `${own} #proposed-unit`, 'The list has no headings: x, y and z in this order, in mm, are proposed');
  assert.deepEqual(await page.evaluate(`[...document.querySelectorAll('${own} [aria-label^="name of column"]')].map((one) => one.value)`), [
    'x',
    'y',
    'z',
  ]);
  await page.type(`${own} [data-option=nominal]`, 'control.csv');
  await page.click(`${own} #do-import`);
  await words(page, `${own} .error`, 'the joints are in [deg]');
  await words(page, `${own} li:last-of-type`, 'flange[deg]: "A6"');
  assert.ok(!/vernier import|--[a-z]/.test(await text(page, `${own} .error`)), await text(page, `${own} .error`));
  await picture(page, 'robot_nominal', `${own} .error`);
  await page.click(`${own} #nominal-is-right`);
  await measured(page, 'list_read.csv');
  assert.ok(readFileSync(join(folder, 'list_read.csv'), 'utf8').startsWith('turret[deg],shoulder[deg],'));
  // Joints in radians under a statement of degrees: the unit is named, and taken by the same button.
  await page.drop([{ name: 'radians.csv', text: log((one) => ((one * Math.PI) / 180).toFixed(6)) }]);
  await page.drop([{ name: 'list2.txt', text: `${list}\n` }]);
  const second = '[data-of="list2.txt"]';
  await words(page, `${second} #where-it-stood`, 'Where did the machine stand at each point?');
  await page.type(`${second} [data-option=nominal]`, 'radians.csv');
  await page.type(`${second} [data-option=nominal-column]`, kJoints.map((one, k) => `${one}[deg]=A${k + 1}`).join('; '));
  await page.click(`${second} #do-import`);
  await words(page, `${second} .error`, 'write [rad], press "This assignment is right"');
  await page.click(`${second} #nominal-is-right`);
  await measured(page, 'list2_read.csv');
  assert.ok(readFileSync(join(folder, 'list2_read.csv'), 'utf8').startsWith('turret[rad],shoulder[rad],'));
}

/** The points of a tracker and the positions of the joints in two files: the page knows the columns, and asks for the other file. */
async function pointsAndPositions(page) {
  const rows = reflectorPoses()
    .trim()
    .split('\n')
    .slice(1)
    .map((line) => line.split(','));
  const text_of = (head, cells) => `${head}\n${rows.map((row, i) => [`P${i + 1}`, ...cells(row)].join(';')).join('\n')}\n`;
  await view(page, 'project');
  await page.choose('#machine', 'arm.xml');
  await page.drop([
    { name: 'positions.csv', text: text_of(`Punkt;${[1, 2, 3, 4, 5, 6].map((k) => `q${k} [deg]`).join(';')}`, (row) => row.slice(0, 6)) },
    { name: 'points.txt', text: text_of('Name;X [mm];Y [mm];Z [mm]', (row) => row.slice(6, 9)) },
  ]);
  const own = '[data-of="points.txt"]';
  await words(page, `${own} #where-it-stood`, 'Where did the machine stand at each point?');
  assert.deepEqual(await page.evaluate(`[...document.querySelectorAll('${own} [aria-label^="name of column"]')].map((one) => one.value)`), [
    'point',
    'x',
    'y',
    'z',
  ]);
  await page.type(`${own} [data-option=nominal]`, 'positions.csv');
  await page.type(`${own} [data-option=set]`, 'u[um]=20');
  // The machine file has no place of a reflector: the refusal has the button that declares it and reads the points again.
  await page.click(`${own} #do-import`);
  await words(page, `${own} .error`, 'press "A reflector is on the flange at a place that nobody measured"');
  assert.ok(!(await text(page, `${own} .error`)).includes('vernier set'), await text(page, `${own} .error`));
  await page.click(`${own} #import-reflector`);
  await measured(page, 'points_read.csv');
  await page.until("document.body.dataset.subject === 'yes'", 'the rows');
  await readDifferently(page, own);
  // A page begins at its top.
  await page.evaluate('scrollTo(0, 500)');
  await view(page, 'compare');
  await page.until("document.getElementById('compare-figures') && scrollY === 0", 'the comparison from its top');
  await view(page, 'add');
  await page.click('#fit');
  // The fit says where the reflector is, in the frame of the last link of the description.
  await words(page, '#fit-notes', 'mm in the frame of the link l6 of the URDF');
}

/** The points again with the directions of the motion: every other answer is that of the first time. */
async function readDifferently(page, own) {
  const field = (name) => page.evaluate(`document.querySelector('${own} [data-option="${name}"]')?.value ?? null`);
  const names = `[...document.querySelectorAll('${own} [aria-label^="name of column"]')].map((one) => one.value)`;
  await page.click('[data-file="points_read.csv"] .differently');
  await page.until(`document.querySelector('${own} [data-option="directions"]')`, 'the field "directions"');
  assert.equal(await page.evaluate(`document.querySelector('${own} select:has(option[value=tracker])').value`), 'tracker');
  for (const [name, value] of [
    ['nominal', 'positions.csv'],
    ['set', 'u[um]=20'],
    ['separator', 'semicolon'],
    ['decimal', 'point'],
    ['directions', ''],
  ])
    assert.equal(await field(name), value, name);
  assert.deepEqual(await page.evaluate(names), ['point', 'x', 'y', 'z']);
  await page.choose(`${own} [data-option=directions]`, 'from-order');
  await page.click(`${own} #do-import`);
  // The new file is chosen in the place of the old one.
  await measured(page, 'points_read-2.csv');
  const [, old] = readFileSync(join(folder, 'points_read.csv'), 'utf8').split('\n');
  const [head, row] = readFileSync(join(folder, 'points_read-2.csv'), 'utf8').split('\n');
  assert.ok(/,dirq1,.*,dirq6/.test(head), head);
  assert.deepEqual(row.split(',').slice(0, 10), old.split(',').slice(0, 10));
  // A third time from the same panel: again one file in the place of the other, with the directions of the second time.
  await page.click(`${own} #read-differently`);
  await page.until(`document.querySelector('${own} #do-import')`, 'the panel');
  assert.equal(await field('directions'), 'from-order');
  await page.click(`${own} #do-import`);
  await measured(page, 'points_read-3.csv');
  await page.until("document.body.dataset.subject === 'yes'", 'the rows');
}

/** Of a mill a tracker's X, Y and Z have the names of its axes: the page says what the file may be, and one choice makes it points. */
async function pointsOfAMill(page) {
  await view(page, 'project');
  await page.choose('#machine', 'router.xml');
  // Before a machine is chosen too.
  await page.choose('#machine', '');
  await page.drop([
    { name: 'early.txt', text: 'Name X Y Z\nP1 2275.8380 5.7876 276.3618\nP2 2085.2766 -176.1341 353.5287\nP3 2001.1 -99.5 300.2\n' },
  ]);
  await page.choose('[data-of="early.txt"] select:has(option[value=tracker])', 'tracker');
  await page.until(`document.querySelector('[data-of="early.txt"] #proposed-unit')`, 'x, y and z');
  await page.choose('#machine', 'router.xml');
  await words(page, '[data-of="early.txt"] #where-it-stood', 'Where did the machine stand at each point?');
  await page.drop([{ name: 'mill_points.txt', text: 'Punkt;X;Y;Z\nP1;2275,8380;5,7876;276,3618\nP2;2085,2766;-176,1341;353,5287\n' }]);
  const own = '[data-of="mill_points.txt"]';
  await words(page, `${own} #sheet-message`, 'choose "points of a laser tracker" in the field "read as"');
  assert.ok(!/vernier import|--[a-z]/.test(await text(page, `${own} #sheet-message`)), await text(page, `${own} #sheet-message`));
  await page.choose(`${own} select:has(option[value=tracker])`, 'tracker');
  await words(page, `${own} #proposed-unit`, 'mm is proposed');
  await words(page, `${own} #where-it-stood`, 'Where did the machine stand at each point?');
  assert.deepEqual(await page.evaluate(`[...document.querySelectorAll('${own} [aria-label^="name of column"]')].map((one) => one.value)`), [
    'point',
    'x',
    'y',
    'z',
  ]);
  // A line above points without headings: the field "skip" is the command's too.
  const places = [
    [100, 200, -50],
    [900, 200, -50],
    [500, 600, -100],
    [300, 300, -20],
    [700, 500, -120],
  ];
  const list = (cells, head = '') => `${head}${places.map((row, i) => [`Q${i + 1}`, ...cells(row)].join(';')).join('\n')}\n`;
  await page.drop([{ name: 'mill_list.csv', text: list((row) => row, 'Punkt;X [mm];Y [mm];Z [mm]\n') }]);
  await page.drop([
    { name: 'titled.txt', text: list((row) => row.map((one, k) => (one + 1000 * k).toFixed(4)), 'Messung der Fraese, 5 Punkte, in mm\n') },
  ]);
  const titled = '[data-of="titled.txt"]';
  await page.choose(`${titled} select:has(option[value=tracker])`, 'tracker');
  await page.type(`${titled} [data-option=skip]`, '1');
  await page.type(`${titled} [data-option=nominal]`, 'mill_list.csv');
  await page.until(`document.querySelector('${titled} [data-option=comment]')`, 'the field of comments');
  // Points whose names are numbers, below a title with as many words as a row has cells.
  await page.drop([
    {
      name: 'numbered.txt',
      text: `Roboter Zelle 4 Kalibrierung\n${places.map((row, i) => `${i + 1}  ${row.map((one) => (one + 2000).toFixed(4)).join('  ')}`).join('\n')}\n`,
    },
  ]);
  const numbered = '[data-of="numbered.txt"]';
  // Four columns of numbers can be a test along an axis too: the page asks with a button.
  await page.click(`${numbered} #sheet-as-points`);
  await page.until(`document.querySelector('${numbered} #proposed-unit')`, 'the proposal for points without headings');
  assert.deepEqual(
    await page.evaluate(`[...document.querySelectorAll('${numbered} [aria-label^="name of column"]')].map((one) => one.value)`),
    ['point', 'x', 'y', 'z'],
  );
  assert.equal(await page.evaluate(`document.querySelector('${numbered} [data-option=skip]').value`), '1');
}

/** Points of a robot with numbers as names, below a title: they are no positions of joints, so that the page reads them as points at once. */
async function numberedPointsOfARobot(page) {
  await view(page, 'project');
  await page.choose('#machine', 'arm-set.xml');
  const rows = reflectorPoses()
    .trim()
    .split('\n')
    .slice(1)
    .map((line) => line.split(','));
  await page.drop([
    {
      name: 'poses.txt',
      text: `Punkt;${rows[0]
        .slice(0, 6)
        .map((_, k) => `A${k + 1}[deg]`)
        .join(';')}\n${rows.map((row, i) => [i + 1, ...row.slice(0, 6)].join(';')).join('\n')}\n`,
    },
    {
      name: 'zelle.txt',
      text: `Roboter Zelle 4 Kalibrierung\n${rows
        .map((row, i) => [i + 1, ...row.slice(6, 9)].join('  '))
        .toReversed()
        .join('\n')}\n`,
    },
  ]);
  const own = '[data-of="zelle.txt"]';
  await words(page, `${own} #where-it-stood`, 'Where did the machine stand at each point?');
  assert.equal(await page.evaluate(`document.querySelector('${own} [data-option=skip]').value`), '1');
  await page.type(`${own} [data-option=nominal]`, 'poses.txt');
  await page.click(`${own} #do-import`);
  await measured(page, 'zelle_read.csv');
  // Joined by the numbers, not by the rows; and beside what was chosen before, with one press.
  assert.ok(!(await text(page, own)).includes('joined by row number'), await text(page, own));
  await page.click(`${own} #use-together`);
  await page.until("document.getElementById('measurement').value.endsWith(' + zelle_read.csv')", 'both files');
}

/** The same as a controller and a tracker write them: no units, a decimal comma, the points in another order. */
async function logWithoutUnits(page) {
  const rows = reflectorPoses()
    .trim()
    .split('\n')
    .slice(1)
    .map((line, i) => [`P${i + 1}`, ...line.split(',').map((one) => one.replace('.', ','))]);
  await view(page, 'project');
  await page.choose('#machine', 'arm-set.xml');
  await page.drop([
    { name: 'log.txt', text: `Name;A1;A2;A3;A4;A5;A6\n${rows.map((row) => row.slice(0, 7).join(';')).join('\n')}\n` },
    {
      name: 'tracker.txt',
      text: `Name;X;Y;Z\n${rows
        .toReversed()
        .map((row) => [row[0], ...row.slice(7, 10)].join(';'))
        .join('\n')}\n`,
    },
  ]);
  const own = '[data-of="tracker.txt"]';
  await words(page, `${own} #proposed-unit`, 'mm is proposed');
  await page.type(`${own} [data-option=nominal]`, 'log.txt');
  // How the text is read can be corrected, as on the command line; the preview follows.
  await page.choose(`${own} [data-option=decimal]`, 'comma');
  await page.until(`document.querySelector('${own} .source')?.textContent.includes('point,x[mm],y[mm],z[mm]')`, 'the preview');
  await page.click(`${own} #do-import`);
  await measured(page, 'tracker_read.csv');
  await words(
    page,
    `${own} .import-note:last-of-type`,
    'log.txt: the columns of the joints (A1 ...) have no unit: they are read in degrees',
  );
  // The same points in metres, without a unit: mm is proposed, the program finds m, and one press goes on.
  const metres = rows.map((row) => [row[0], ...row.slice(7, 10).map((one) => (Number(one.replace(',', '.')) / 1000).toFixed(7))].join(';'));
  await page.drop([{ name: 'metres.txt', text: `Name;X;Y;Z\n${metres.join('\n')}\n` }]);
  const other = '[data-of="metres.txt"]';
  await words(page, `${other} #proposed-unit`, 'mm is proposed');
  await page.type(`${other} [data-option=nominal]`, 'positions.csv');
  await page.click(`${other} #do-import`);
  await words(page, `${other} .error`, 'With the points in [m] in the place of [mm] they agree within');
  await words(page, `${other} .error`, 'press "The points are in m"');
  assert.ok(!/vernier import|--[a-z]/.test(await text(page, `${other} .error`)), await text(page, `${other} .error`));
  await page.click(`${other} #unit-is-right`);
  await measured(page, 'metres_read.csv');
  await page.choose('#measurement', 'tracker_read.csv');
  await page.until("document.body.dataset.subject === 'yes'", 'the rows');
  // What a check of the files says reaches who has no command line.
  await words(page, '#lint', 'no check rows in the file');
  assert.ok(!/ --[a-z]|vernier [a-z]/.test(await text(page, '#lint')), await text(page, '#lint'));
}

/** A file for readings to come can be chosen: every view says that it has none. */
async function noReadingsYet(page) {
  const plan = reflectorPoses()
    .split('\n')
    .map((line, i) => (line ? `${line.split(',').slice(0, 6).join(',')},${i ? ',,' : 'x[mm],y[mm],z[mm]'}` : ''));
  await view(page, 'project');
  await page.drop([{ name: 'a_plan.csv', text: plan.join('\n') }]);
  await measured(page, 'a_plan.csv');
  await words(page, '#stood-room', 'there are no readings in these rows yet');
  await view(page, 'compare');
  await words(page, '#view-compare .error', 'there are no readings in these rows yet');
}

/** A fit with an unknown tool says so on the page, and a button fits the tool point too. */
async function unknownTool(page) {
  await view(page, 'project');
  await page.drop([{ name: 'reflector.csv', text: reflectorPoses() }]);
  await measured(page, 'reflector.csv');
  await page.choose('#machine', 'arm.xml');
  await page.until("document.body.dataset.subject === 'yes'", 'the rows');
  // A residual far above u that depends on no column is no noise: the comparison says so, with the way on.
  await view(page, 'compare');
  await words(page, '#view-compare', 'times the noise');
  await page.until("document.getElementById('compare-reflector')", 'the way to declare the reflector');
  await view(page, 'add');
  await page.until("!document.getElementById('reflector').hidden", 'the reflector before any fit');
  await page.click('#reflector');
  await chosen(page, 'arm-set-fitted.xml');
  await page.until("document.getElementById('reflector').hidden && document.body.dataset.subject === 'yes'", 'one reflector is enough');
  await page.choose('#machine', 'arm.xml');
  await page.until("document.body.dataset.subject === 'yes'", 'the rows');
  await page.click('#fit');
  await words(page, '#fit-notes', 'The tool point of the machine file is probably not that of the measurement');
  assert.ok(!/--free|vernier new/.test(await text(page, '#fit-notes')), await text(page, '#fit-notes'));
  await picture(page, 'robot_tool', '#fit');
  // Or the reflector is declared: the set-up has its place, and the axes do not correct it.
  await page.click('#fit-reflector');
  await page.until("[...document.querySelectorAll('#history code')].some((one) => one.textContent.includes('--reflector'))", 'set');
  await chosen(page, 'arm-set-2-fitted.xml');
  assert.ok(readFileSync(join(folder, 'arm-set-2-fitted.xml'), 'utf8').includes('<ToolShift'));
  await page.choose('#machine', 'arm.xml');
  await page.until("document.body.dataset.subject === 'yes'", 'the rows');
  await page.click('#fit');
  await words(page, '#fit-notes', 'The tool point of the machine file is probably not that of the measurement');
  await page.click('#fit-tool');
  await page.until(
    "[...document.querySelectorAll('#history code')].some((one) => one.textContent.includes('--free TPX,TPY,TPZ'))",
    'the fit of the tool point',
  );
  await chosen(page, 'arm-fitted-3.xml');
  await page.until("document.getElementById('fit-notes').textContent === ''", 'the note to go');
}

/** An arm with a tool and a camera: the page asks which of them is measured. */
async function severalEnds(page, arm) {
  const end = (name, x) =>
    `<link name="${name}"/><joint name="to_${name}" type="fixed"><parent link="l6"/><child link="${name}"/><origin xyz="${x} 0 0.1"/></joint>`;
  const two = arm(end('camera', '0.05') + end('tool0', '0'));
  await view(page, 'project');
  await page.drop([{ name: 'two.urdf', text: two }]);
  await words(page, '#drop-error .question', 'several end links');
  assert.deepEqual(await page.evaluate("[...document.querySelectorAll('#drop-error button')].map((one) => one.textContent)"), [
    'tool0',
    'camera',
    'Not now',
  ]);
  await picture(page, 'robot_ends', '#drop-error');
  await page.click('#drop-error [data-answer=""]');
  await page.until("!document.querySelector('.question')", 'the question to go');
  // The button in the table of files asks the same.
  await page.click('[data-file="two.urdf"] .use');
  await page.click('#drop-error [data-answer="tool0"]');
  await page.click('#drop-error [data-answer="reflector"]');
  await chosen(page, 'two.xml');
  assert.ok((await text(page, '#history')).includes('vernier new robot --urdf two.urdf --tip tool0 --reflector -o two.xml'));
  assert.ok(readFileSync(join(folder, 'two.xml'), 'utf8').includes('<ToolShift'));
  assert.equal(await text(page, '#drop-error'), '');
  // A refusal of a drop goes when another panel has made what was refused.
  await page.drop([{ name: 'broken.urdf', text: '<robot' }]);
  await words(page, '#drop-error .error', 'broken.urdf');
  await page.choose('#measurement', '');
  await page.evaluate("document.getElementById('new-machine').open = true");
  await page.type('#new-name', 'other');
  await page.click('#make-machine');
  await chosen(page, 'other.xml');
  assert.equal(await text(page, '#drop-error'), '');
}

/** Poses of the arm at six joint positions each, with headings of the user's own. */
const poses = (headings) =>
  `${headings.map((one) => `${one} [deg]`).join(';')};x [mm];y [mm];z [mm]\n${Array.from(
    { length: 12 },
    (_, i) => `${Array.from({ length: 6 }, (__, k) => ((i * 37 + k * 23) % 90) - 45).join(';')};${100 + i};${200 - i};${1500 + 2 * i}`,
  ).join('\n')}\n`;

const kOwnNames = ['alpha', 'beta', 'gamma', 'wrist_1', 'wrist_2', 'wrist_3'];

/** Tables whose joints have other names than those of the machine file: every way on is a button. */
async function jointsOfOtherNames(page) {
  const noTerminal = async () => {
    for (const name of ['compare', 'diagnose', 'project']) {
      await view(page, name);
      // The history shows commands.
      const said = await page.evaluate(
        `(() => { const one = document.getElementById('view-${name}').cloneNode(true); one.querySelector('#history')?.remove(); return one.textContent; })()`,
      );
      assert.ok(!/vernier import|--[a-z]/.test(said), `${name}: ${said.match(/.{0,80}(vernier import|--[a-z]).{0,80}/)?.[0]}`);
    }
  };
  const readings = (name) => readFileSync(join(folder, name), 'utf8').split('\n')[0];
  const named = readFileSync(join(folder, 'arm.xml'), 'utf8').match(/<machineaxes>\s*<(\w+)/)[1];
  await view(page, 'project');
  await page.drop([{ name: 'numbered.csv', text: poses(['a1', 'a2', 'a3', 'a4', 'a5', 'a6']) }]);
  await measured(page, 'numbered_read.csv');
  await words(page, '#stood-room', 'No axis of the machine has a column in numbered_read.csv');
  await view(page, 'compare');
  await words(page, '#view-compare .error', 'press "Read the columns as the axes of the machine"');
  await noTerminal();
  await page.click('#by-machine');
  await measured(page, 'numbered_read_read.csv');
  await page.until("document.getElementById('stood-room').textContent === '' && document.body.dataset.subject === 'yes'", 'the rows');
  assert.ok(readings('numbered_read_read.csv').startsWith(`${named}[deg],`), readings('numbered_read_read.csv'));
  // Names that say nothing: the assignment in the order of the machine file is shown, and confirmed.
  await page.drop([{ name: 'greek.csv', text: poses(kOwnNames) }]);
  await measured(page, 'greek_read.csv');
  await page.click('#by-machine');
  await words(page, '#stood-room', `${named}: "alpha[deg]"`);
  await noTerminal();
  await picture(page, 'robot_columns', '#assignment-is-right');
  await page.click('#assignment-is-right');
  await measured(page, 'greek_read_read.csv');
  await page.until("document.body.dataset.subject === 'yes'", 'the rows');
  // A controller's log without units, beside the machine: no column is guessed one by one.
  const log = poses(['A1', 'A2', 'A3', 'A4', 'A5', 'A6'])
    .replaceAll(/ \[(deg|mm)\]/g, '')
    .replace(';x;y;z', ';X;Y;Z');
  await page.drop([{ name: 'log.csv', text: log }]);
  await words(page, '#sheet-message', '');
  await words(page, '#sheet-robot', 'x[mm]: "X"');
  await page.click('#sheet-assignment-is-right');
  await page.until(
    "!document.getElementById('sheet-robot') && !document.getElementById('do-import')?.disabled",
    'the assignment of the log',
  );
  await page.click('#do-import');
  await measured(page, 'log_read.csv');
  await page.until("document.body.dataset.subject === 'yes'", 'the rows');
  assert.ok(readings('log_read.csv').startsWith(`${named}[deg],`), readings('log_read.csv'));
  // One of the columns is of no use: the others are named by hand, and the table says how the axes are called.
  await page.drop([{ name: 'five.csv', text: poses(kOwnNames).replace('wrist_3 [deg]', 'wrist_3 [s]') }]);
  await measured(page, 'five_read.csv');
  await page.click('#by-machine');
  await words(page, '#stood-room .error', 'Press "Choose the columns by hand"');
  await noTerminal();
  await page.click('#by-hand');
  await words(page, '#axes-of-machine', `${named} [deg]`);
  assert.ok(await page.evaluate("document.querySelectorAll('#sheet-columns tbody tr').length >= 9"), 'its columns');
}

/** A small screen with a long formula, and paper: nothing is wider than the page, no number is divided. */
async function looks(page) {
  const sum = Array.from({ length: 40 }, (_, i) => `+k*X*${i + 1}`).join('');
  await page.drop([
    {
      name: 'm.xml',
      text: `<machine name="m"><variables><static><k value="0" nominal="0" unit="1"/></static><machineaxes><X min="0" max="100"/></machineaxes></variables><transforms><sixdof n="1" X="X${sum}"/></transforms></machine>`,
    },
    { name: 'rows.csv', text: 'X[mm],x[mm],u[um]\n0,0.001,1\n50,50.002,1\n100,100.004,1\n' },
  ]);
  await measured(page, 'rows.csv');
  const screen = (media, width) =>
    Promise.all([
      page.send('Emulation.setDeviceMetricsOverride', { width, height: 600, deviceScaleFactor: 1, mobile: false }),
      page.send('Emulation.setEmulatedMedia', { media }),
    ]);
  await screen('', 800);
  for (const name of ['add', 'export', 'project']) {
    await view(page, name);
    await page.until("document.querySelectorAll('#term-place option').length > 0", 'the places of a term');
    assert.ok(await page.evaluate('document.documentElement.scrollWidth <= innerWidth'), `${name} fits 800 px`);
  }
  await view(page, 'board');
  await page.until("document.querySelector('#safety tbody tr')", 'the sheet');
  for (const media of ['', 'print']) {
    await screen(media, 740);
    const lines = await page.evaluate(
      "[...document.querySelectorAll('#safety td.num, #safety th, #safety td.answer')].map((one) => { const r = document.createRange(); r.selectNodeContents(one); return [one.textContent, new Set([...r.getClientRects()].map((b) => Math.round(b.top))).size]; })",
    );
    assert.ok(lines.length > 30);
    for (const [words_of, count] of lines) assert.ok(count <= Math.max(1, words_of.split(' ').length), `"${words_of}" on ${count} lines`);
  }
  // On paper the rows are there, and nothing that only hands can use.
  await screen('', 1280);
  await view(page, 'compare');
  await page.until("document.querySelector('.rows-inner > div')", 'the rows');
  await screen('print', 740);
  assert.ok(await page.evaluate("document.querySelector('.rows').offsetHeight > 40"), 'rows on paper');
  assert.ok(await page.evaluate("[...document.querySelectorAll('.hands')].every((one) => one.offsetHeight === 0)"), 'no buttons on paper');
  await screen('', 1280);
  // What contradicts its unit or its direction is refused beside its columns, where the answer is given.
  await view(page, 'project');
  for (const [name, text_of, wanted] of [
    ['units.csv', 'Soll X [um];Abw. X [mm]\n0;0,0\n100;3,2\n200;5,4\n300;9,1\n', 'probably exchanged'],
    ['dir.csv', 'X [mm];x [mm];Richtung\n9;9,1;+\n4;4,1;+\n0;0,1;+\n0;0,2;-\n4;4,2;-\n9;9,2;-\n', 'contradict the order of the rows'],
  ]) {
    await page.drop([{ name, text: text_of }]);
    await page.until(`document.getElementById('sheet-message')?.textContent.includes(${JSON.stringify(wanted)})`, wanted);
    assert.ok(await page.evaluate("document.querySelectorAll('#sheet-columns tbody tr').length >= 2"), `${name}: its columns`);
  }
  // A doubtful unit is confirmed without a change of the file.
  await page.drop([{ name: 'sure.csv', text: 'Soll X [mm];Abw. X [mm]\n0;0,0\n100;3,2\n200;5,4\n300;9,1\n400;13,9\n' }]);
  await words(page, '#sheet-message', 'half of the deviations');
  assert.ok(!(await text(page, '#sheet-message')).includes('--'), await text(page, '#sheet-message'));
  await page.click('[data-confirms="Abw. X [mm]"]');
  await page.until("!document.getElementById('sheet-message') && !document.getElementById('do-import').disabled", 'the confirmed table');
  // A name with its unit, as messages write it; a wrong unit leaves the columns, so that it can be corrected.
  await page.drop([{ name: 'bare.csv', text: 'A1;X [mm]\n10,1;0\n20,2;100\n30,3;200\n' }]);
  await page.until("document.querySelectorAll('#sheet-columns tbody tr').length === 2", 'its columns');
  const cell = (label) => `#sheet-columns tbody tr:nth-child(1) input[aria-label^="${label}"]`;
  const enter = async (label, word) => {
    await page.type(cell(label), word);
    await page.evaluate(`document.querySelector(${JSON.stringify(cell(label))}).dispatchEvent(new Event('change', { bubbles: true }))`);
  };
  await enter('unit', 'foo');
  await words(page, '#import-box', 'unknown unit');
  assert.equal(await page.evaluate("document.querySelectorAll('#sheet-columns tbody tr').length"), 2, 'the columns stay');
  await enter('name', 'x[mm]');
  await page.until("document.querySelector('#import-box pre')?.textContent.includes('x[mm],X[mm]')", 'the name and its unit');
  // What cannot be read at all has its buttons too.
  await page.drop([{ name: 'words.csv', text: 'AC = eins\nBD = zwei\n' }]);
  await page.until("document.querySelectorAll('#import-box button').length === 2", 'the buttons of the refusal');
  assert.deepEqual(await page.evaluate("[...document.querySelectorAll('#import-box button')].map((one) => one.textContent)"), [
    'Import',
    'Not now',
  ]);
  // A table of another instrument beside a table: what is said of both stays.
  await page.drop([
    { name: 'one.csv', text: 'X soll [mm];Abweichung X [um]\n0,0;1,5\n100,0;2,5\n200,0;4,0\n' },
    { name: 'two.csv', text: 'X soll [mm];Abweichung X [um]\n0,0;1,5\n100,0;2,5\n200,0;4,0\n' },
  ]);
  await words(page, '#import-box', 'two.csv: ');
  await words(page, '#import-box', 'one.csv: ');
  // The name of the folder is whole.
  assert.ok(
    await page.evaluate("(() => { const one = document.querySelector('.folder'); return one.scrollWidth <= one.clientWidth; })()"),
    'the name of the folder',
  );
}

assert.ok(bin && data);
await journey(
  { shop, printer, caliper, robot, again, looks },
  { shop: /422/, printer: /422/, caliper: /422/, robot: /422/, again: /422/, looks: /422/ },
);

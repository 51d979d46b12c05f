// SPDX-License-Identifier: GPL-3.0-or-later
// first_hour.mjs WHICH BIN SOURCE [PICTURES]: what a person meets who has never seen the workbench: nothing to work on, files as
// they came, a machine that does not exist yet, a small screen, the dark, paper. In a real headless browser, as journey.mjs.
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import assert from 'node:assert/strict';
import { attribute, bin, data, folder, journey, json, picture, pictures, source, text, top, vernier, view } from './rig.mjs';

const bytes = (name) => readFileSync(join(source, 'tests/data', name));
const measurement = (name) =>
  `document.getElementById('measurement').value === ${JSON.stringify(name)} && document.body.dataset.ready === 'yes'`;
const disabled = (page, selector) => page.evaluate(`document.querySelector(${JSON.stringify(selector)}).disabled`);
const steps = (page) =>
  page.evaluate("[...document.querySelectorAll('#guide li')].map((one) => [one.dataset.step, one.classList.contains('done')])");

async function emulate(page, { width = 1280, height = 720, media = '', dark = false }) {
  await page.send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 1, mobile: false });
  await page.send('Emulation.setEmulatedMedia', {
    media,
    features: [{ name: 'prefers-color-scheme', value: dark ? 'dark' : 'light' }],
  });
}

/** Nothing there: it says what to do, and nothing can be pressed that needs what is not there. */
async function nothingYet(page) {
  assert.ok((await text(page, '#begin-steps')).includes('drop any spreadsheet'), 'the page says how to begin');
  for (const name of ['compare', 'diagnose', 'add', 'board', 'export', 'fleet']) {
    await view(page, name);
    assert.equal(await page.evaluate("document.querySelectorAll('.view:not([hidden]) .error:not(:empty)').length"), 0, `${name}: no error`);
  }
  for (const selector of ['#run-diagnose', '#fit', '#add-effect']) assert.ok(await disabled(page, selector), `${selector} waits`);
  assert.ok((await text(page, '#view-diagnose')).includes('Choose a machine and measurements'));
  assert.deepEqual(
    (await steps(page)).map(([, done]) => done),
    [false, false, false, false, false, false, false],
  );
  await view(page, 'project');
  await picture(page, 'first_empty');
}

/** A German spreadsheet, a workbook and a tracker's table become measurements as they are dropped. */
async function filesAsTheyCame(page) {
  await page.drop([{ name: 'Portal_X.csv', bytes: bytes('router/Portal_X.csv') }]);
  await page.until(measurement('Portal_X_read.csv'), 'the German spreadsheet to be read');
  const command = await page.evaluate("document.querySelector('#history code').textContent");
  assert.equal(command, 'vernier import table Portal_X.csv -o Portal_X_read.csv');
  execFileSync(vernier, ['import', 'table', 'Portal_X.csv', '-o', join(top, 'by_hand.csv')], { cwd: folder, stdio: 'ignore' });
  assert.equal(readFileSync(join(folder, 'Portal_X_read.csv'), 'latin1'), readFileSync(join(top, 'by_hand.csv'), 'latin1'));
  assert.ok((await text(page, '#imported')).includes('decimal comma'), 'how it was read is said');
  await page.until("document.getElementById('files').textContent.includes('spreadsheet, read into Portal_X_read.csv')", 'what it is');
  // A heading that means nothing: asked for, not guessed.
  await page.drop([{ name: 'dial.csv', text: 'Pos;Anzeige\r\n0,0;1,5\r\n100,0;2,5\r\n200,0;4,0\r\n' }]);
  await page.until("document.getElementById('sheet-message')", 'what is missing to be said');
  assert.ok(await disabled(page, '#do-import'));
  await picture(page, 'first_columns', '#sheet-columns');
  const say = async (k, use, name, unit) => {
    await page.choose(`#sheet-columns tbody tr:nth-child(${k}) select`, use);
    for (const [label, value] of [
      ['name', name],
      ['unit', unit],
    ]) {
      const field = `#sheet-columns tbody tr:nth-child(${k}) input[aria-label^="${label}"]`;
      await page.until(`document.querySelector(${JSON.stringify(field)})`, field);
      await page.evaluate(
        `(() => { const one = document.querySelector(${JSON.stringify(field)}); one.value = ${JSON.stringify(value)}; one.dispatchEvent(new Event('change')); })()`,
      );
      await page.until(
        `document.querySelector(${JSON.stringify(field)})?.value === ${JSON.stringify(value)}`,
        'the panel to be drawn anew',
      );
    }
  };
  await say(1, 'column', 'X', 'mm');
  await say(2, 'deviation', 'X', 'um');
  await page.until("!document.getElementById('do-import').disabled", 'it to be understood');
  await page.click('#do-import');
  await page.until(measurement('dial_read.csv'), 'the dial gauge to be read');
  assert.ok(readFileSync(join(folder, 'dial_read.csv'), 'utf8').includes('200.004'), 'position plus deviation');
  // A workbook, and a tracker's table with quaternions.
  execFileSync(vernier, ['new', 'gantry', '--axis', 'X:0:100', '--axis', 'Y:0:100', '-o', 'm.xml', '--measurements', 'w.xlsx'], {
    cwd: top,
    stdio: 'ignore',
  });
  await page.drop([{ name: 'empty.xlsx', bytes: readFileSync(join(top, 'w.xlsx')) }]);
  await page.until("document.getElementById('how-read')?.textContent.includes('workbook')", 'the workbook to be opened');
  await page.drop([{ name: 'points.txt', text: 'X[mm] x[mm] y[mm] z[mm] qw qx qy qz\n0 0.01 0 0 1 0 0 0\n50 50.02 0 0 1 0 0 0\n' }]);
  await page.until("document.querySelector('#import-box h2')?.textContent.includes('points.txt')", 'the tracker to be asked about');
  await page.click('#do-import');
  await page.until(measurement('points_read.csv'), 'the tracker to be read');
  assert.ok(readFileSync(join(folder, 'points_read.csv'), 'utf8').includes('rx[deg]'), 'quaternions became rotation vectors');
}

/** No machine file: made on the page, for the measurements that are there. */
async function aMachineOfOnesOwn(page) {
  await page.choose('#measurement', 'Portal_X_read.csv');
  await page.until("document.getElementById('new-machine').open", 'the form');
  // By its picture; the axes that are usual for it stand ready.
  await page.evaluate("document.querySelector('input[name=machine-type][value=arm]').click()");
  assert.ok((await page.evaluate("document.getElementById('new-axes').value")).startsWith('X:0:4000'));
  await page.evaluate("document.querySelector('input[name=machine-type][value=gantry]').click()");
  await picture(page, 'first_machine', '#new-machine');
  await page.type('#new-axes', 'X:0:1200 Y:0:800 Z:-150:0');
  await page.type('#new-name', 'router');
  await page.click('#make-machine');
  await page.until("document.getElementById('machine').value === 'router.xml'", 'the machine file');
  assert.ok(existsSync(join(folder, 'router_survey.csv')));
  await page.until("document.getElementById('begin-steps').hidden", 'the beginning to be over');
  await view(page, 'compare');
  await page.until("document.getElementById('compare-figures')", 'the comparison');
  // The set-up is fitted before anything is compared: no offset of the instrument stands for a failure.
  const fitted = json('compare', 'router.xml', 'Portal_X_read.csv', '--datum').rms_um;
  assert.ok(Math.abs(Number(await attribute(page, '#compare-figures', 'rms')) - fitted) < 1e-9 * fitted);
  assert.deepEqual((await steps(page)).slice(0, 4), [
    ['data', true],
    ['model', true],
    ['fails', true],
    ['missing', false],
  ]);
}

/** A run along one axis, on a machine of three: the page asks where the others stood. A cover sheet, two instruments, a robot. */
async function axesThatStood(page) {
  const machine = await page.evaluate("document.getElementById('machine').value");
  const rows = await page.evaluate("document.getElementById('measurement').value");
  await view(page, 'project');
  await page.drop([{ name: 'laser_x.csv', text: 'X[mm],x[mm]\n0,0.001\n300,300.004\n600,600.009\n900,900.011\n' }]);
  await page.until("document.getElementById('stood-Y')", 'the page to ask where Y stood');
  await page.type('#stood-Y', '400');
  await page.type('#stood-Z', '-50,5');
  await page.type('#stood-u', '0,5');
  await picture(page, 'first_axes', '#stood-room .controls');
  await page.click('#stood-add');
  await page.until(measurement('laser_x_with_axes.csv'), 'the file with all axes');
  assert.ok(readFileSync(join(folder, 'laser_x_with_axes.csv'), 'utf8').includes('0,0.001,400,-50.5,0.5'));
  await view(page, 'compare');
  await page.until("document.getElementById('compare-figures')", 'the comparison');
  await view(page, 'project');
  await page.drop([{ name: 'cover.xlsx', bytes: bytes('sheets/cover.xlsx') }]);
  await page.until(
    "document.getElementById('imported')?.textContent.includes('sheet \"Daten\" of Deckblatt, Daten')",
    'the sheet behind the cover',
  );
  await page.click('#read-differently');
  await page.choose('#sheet-of-workbook', 'Deckblatt');
  await page.until(
    "document.querySelector('#import-box .error')?.textContent.includes('no column of the table is a reading')",
    'the cover to be refused',
  );
  // Fitted, without check rows: the sheet states what the fit did not have.
  execFileSync(vernier, ['fit', machine, 'laser_x_with_axes.csv', '-o', join(top, 'plain.xml')], { cwd: folder, stdio: 'ignore' });
  await page.drop([{ name: 'plain.xml', bytes: readFileSync(join(top, 'plain.xml')) }]);
  await page.until("document.getElementById('machine').value === 'plain.xml'", 'the fitted machine');
  await view(page, 'board');
  await page.until("document.querySelector('#safety tbody tr')", 'the sheet');
  const sheet = await text(page, '#view-board');
  assert.ok(sheet.includes('Is the set-up of the instrument kept out of the axes?') && !sheet.includes('no fit wrote this file'), sheet);
  assert.equal(await page.evaluate("document.querySelector('#safety [data-rule=check-rows] .answer').textContent"), 'not known');
  await view(page, 'project');
  const whole = (name) => ({ name, text: 'X[mm],Y[mm],Z[mm],x[mm]\n0,1,-2,0.001\n300,1,-2,300.004\n600,1,-2,600.009\n' });
  await page.drop([whole('one.csv'), whole('two.csv')]);
  await page.until(measurement('one.csv + two.csv'), 'two instruments together');
  const link = (name) => `<link name="${name}"/>`;
  await page.drop([
    {
      name: 'arm.urdf',
      text: `<robot name="arm">${['base', 'l1', 'tip'].map(link).join('')}
        <joint name="J1" type="revolute"><parent link="base"/><child link="l1"/><axis xyz="0 0 1"/><limit lower="-3" upper="3"/></joint>
        <joint name="J2" type="revolute"><parent link="l1"/><child link="tip"/><origin xyz="0.4 0 0.1"/><axis xyz="0 1 0"/><limit lower="-2" upper="2"/></joint>
        </robot>`,
    },
  ]);
  await page.click('#drop-error [data-answer=point]');
  await page.until("document.getElementById('machine').value === 'arm.xml'", 'the machine file of the robot');
  await page.choose('#measurement', rows);
  await page.choose('#machine', machine);
  await view(page, 'compare');
  await page.until("document.getElementById('compare-figures')", 'the comparison');
}

/** A report with a head, a tolerance and its verdict; one that is not met is an answer and no error. */
async function handOver(page) {
  await page.until("!document.getElementById('handover-positioning').disabled", 'the reports');
  for (const [selector, words] of [
    ['#header-company', 'Muster & Sohn'],
    ['#header-serial-number', '4711'],
  ]) {
    await page.type(selector, words);
    await page.evaluate(`document.querySelector('${selector}').dispatchEvent(new Event('change'))`);
  }
  await page.type('input[aria-label="tolerance of A"]', '50');
  await page.type('input[aria-label^="its uncertainty"]', '3');
  await page.click('#handover-positioning');
  await page.until("document.querySelector('#handover-links a')", 'the report');
  const report = readFileSync(join(folder, 'iso230-2_X.html'), 'utf8');
  assert.ok(report.includes('Muster &amp; Sohn') && report.includes('<dd>4711</dd>'), 'its head');
  assert.ok(report.includes('not met'), 'its verdict');
  await page.until("document.getElementById('handover-answer').textContent.startsWith('Not met: ')", 'the verdict on the page');
  assert.equal(await attribute(page, '#job-state', 'state'), 'no', 'a missed tolerance is an answer, not a failure');
  assert.equal(await page.evaluate("document.querySelectorAll('.view:not([hidden]) .error:not(:empty)').length"), 0);
}

async function begin(page) {
  await nothingYet(page);
  await filesAsTheyCame(page);
  await aMachineOfOnesOwn(page);
  await handOver(page);
  await axesThatStood(page);
}

/** What is shown of a model: uncertainties and what they rest on, legend and words of a point, the sheet, names of the shop. */
async function shown(page) {
  await page.drop([
    { name: 'model.xml', text: data('hidden/bridge_lag_cyclic/model.xml') },
    { name: 'survey.csv', text: data('hidden/bridge_lag_cyclic/survey.csv') },
  ]);
  await page.until(`document.getElementById('machine').value === 'model.xml' && ${measurement('survey.csv')}`, 'the files');
  await view(page, 'add');
  await page.click('#fit');
  await page.until("document.getElementById('machine').value === 'model-fitted.xml'", 'the fit', 60);
  await page.until("document.querySelectorAll('#parameters tr[data-from=convention]').length > 0", 'the parameters');
  const known = json('fit', 'model.xml', 'survey.csv').parameters;
  const rows = await page.evaluate(
    "[...document.querySelectorAll('#parameters tr')].map((row) => [row.children[0].textContent, row.children[2].textContent, row.dataset.from])",
  );
  for (const one of known) {
    const row = rows.find(([name]) => name === one.name);
    assert.ok(row, `${one.name} stands in the table`);
    assert.equal(row[2], one.from, one.name);
    assert.ok(Math.abs(Number(row[1].replace('−', '-')) - one.std) < 0.06 * one.std, `${one.name}: ± ${row[1]}, the fit says ${one.std}`);
  }
  await picture(page, 'parameters', '#parameters');
  await view(page, 'compare');
  await page.until("document.querySelector('.matrix canvas')", 'the plots');
  await page.evaluate("document.querySelector('.matrix canvas').scrollIntoView({ block: 'center' })");
  assert.ok((await text(page, '.key')).includes('check rows'), 'the colours are explained');
  // Along a plot until a point is met.
  const [x, y, w, h] = await page.evaluate(
    "(() => { const b = document.querySelector('.matrix canvas').getBoundingClientRect(); return [b.left, b.top, b.width, b.height]; })()",
  );
  let words = '';
  for (let k = 0; k < 60 && !words; ++k) {
    await page.send('Input.dispatchMouseEvent', { type: 'mouseMoved', x: x + 60 + (k * (w - 80)) / 60, y: y + 18 + (h - 50) / 2 });
    words = await page.evaluate("document.getElementById('tip')?.hidden === false ? document.getElementById('tip').textContent : ''");
  }
  assert.match(words, /survey\.csv, line \d+, run s\d, (fit|check) row.*± 1/s, 'a point tells its row and its uncertainty');
  await view(page, 'board');
  await page.until("document.querySelectorAll('#safety tbody tr').length === 12", 'the sheet');
  assert.equal(await attribute(page, '#safety-words', 'ok'), 'true');
  assert.ok((await text(page, '#safety')).includes('Is the correction known well enough?'));
  // A reload begins where one was.
  const before = await steps(page);
  // The page before it is ready too, and stays for a moment longer.
  await page.evaluate("document.body.dataset.before = 'yes'; location.reload(); 1");
  await page.until(
    "!document.body.dataset.before && document.body.dataset.ready === 'yes' && document.getElementById('machine').value === 'model-fitted.xml'",
    'the page again',
  );
  const kept = (path) => path.filter(([id, done]) => done && id === 'fall').length;
  assert.equal(kept(before), 1, 'the fit is a step of the way');
  // What is behind the user is not drawn as still to do, and the step to do next is after it.
  const way = await page.evaluate(
    "[...document.querySelectorAll('#guide li')].map((one) => [one.classList.contains('done'), one.classList.contains('passed'), one.getAttribute('aria-current') === 'step'])",
  );
  const last = way.findLastIndex(([done]) => done);
  assert.ok(last >= 4, 'the fit is the last step that is done');
  assert.ok(
    way.slice(0, last).every(([done, passed, current]) => (done || passed) && !current),
    JSON.stringify(way),
  );
  assert.equal(kept(await steps(page)), 1, 'and still is after a reload');
  // The path can be left and come back to.
  await page.click('#guide-away');
  assert.ok(await page.evaluate("document.getElementById('guide').hidden"));
  await page.click('#guide-show');
  assert.ok(!(await page.evaluate("document.getElementById('guide').hidden")));
}

/** The fields of a command are its options: no list of the page names them. */
async function optionsOfTheProgram(page) {
  const described = JSON.parse(execFileSync(vernier, ['completion', 'json'], { encoding: 'utf8' }));
  const loss = described.find((one) => one.name === 'fit').options.find((one) => one.name === 'loss');
  await view(page, 'add');
  const field = "details[data-command=fit] [data-option='loss']";
  const [words, help] = await page.evaluate(
    `(() => { const one = document.querySelector(${JSON.stringify(field)}); return [[...one.options].map((word) => word.value), one.title]; })()`,
  );
  assert.deepEqual(words, ['', ...loss.words]);
  assert.equal(help, loss.help);
  await page.choose(field, 'huber');
  await page.click('#fit');
  await page.until(
    "document.querySelector('#history')?.textContent.includes('vernier fit model.xml survey.csv --loss huber -o model-fitted.xml')",
    'the fit with that loss',
    60,
  );
}

/** Small screens, the dark, and paper: nothing is cut, nothing is unreadable. */
async function everywhere(page) {
  await page.drop([
    { name: 'model.xml', text: data('hidden/bridge_lag_cyclic/model.xml') },
    { name: 'survey.csv', text: data('hidden/bridge_lag_cyclic/survey.csv') },
  ]);
  await page.until(measurement('survey.csv'), 'the files');
  for (const [width, height, dark] of [
    [800, 600, false],
    [800, 600, true],
    [1100, 720, false],
    [1280, 720, true],
  ]) {
    await emulate(page, { width, height, dark });
    for (const name of ['project', 'compare', 'diagnose', 'add', 'board', 'export', 'fleet']) {
      await view(page, name);
      await new Promise((wait) => setTimeout(wait, 300));
      assert.ok(await page.evaluate('document.documentElement.scrollWidth <= innerWidth'), `${name} fits ${width} px`);
      // What is chosen and where one can go stays in sight.
      for (const selector of ['#machine', '#measurement', `header nav a[href="#${name}"]`]) {
        const box = await page.evaluate(
          `(() => { const b = document.querySelector(${JSON.stringify(selector)}).getBoundingClientRect(); return [b.left, b.right, innerWidth]; })()`,
        );
        assert.ok(box[0] >= 0 && box[1] <= box[2] && box[1] > box[0], `${selector} is in sight at ${width} px: ${box}`);
      }
      if (pictures) await picture(page, `${name}_${width}${dark ? '_dark' : ''}`);
    }
  }
  // A usual name of a file is not cut: its width beside that of the list, which has an arrow.
  for (const width of [1100, 1200, 1280]) {
    await emulate(page, { width });
    const room = await page.evaluate(`(() => {
      const list = document.getElementById('measurement'), was = list.value, one = new Option('abnahme_read-2.csv');
      list.add(one);
      list.value = one.value;
      const pen = document.createElement('canvas').getContext('2d');
      pen.font = getComputedStyle(list).font;
      const room = list.getBoundingClientRect().width - pen.measureText(one.text).width;
      one.remove();
      list.value = was;
      return room;
    })()`);
    assert.ok(room >= 24, `the name of a file at ${width} px has ${room} px beside it`);
  }
  await emulate(page, {});
  await optionsOfTheProgram(page);
  await view(page, 'compare');
  await page.until("document.getElementById('compare-figures')", 'the comparison');
  // Letter and A4: more than one page, and no picture lost.
  for (const [name, paperWidth, paperHeight] of [
    ['a4', 8.27, 11.69],
    ['letter', 8.5, 11],
  ]) {
    const { data: pdf } = await page.send('Page.printToPDF', { paperWidth, paperHeight, printBackground: true });
    const printed = Buffer.from(pdf, 'base64');
    assert.ok(printed.toString('latin1').match(/\/Type\s*\/Page\b/g).length >= 2, `${name} has pages`);
    if (pictures) writeFileSync(join(pictures, `workbench_${name}.pdf`), printed);
  }
  await emulate(page, { media: 'print', dark: true });
  await page.evaluate("dispatchEvent(new Event('beforeprint'))");
  assert.equal(await page.evaluate('getComputedStyle(document.body).backgroundColor'), 'rgb(255, 255, 255)', 'white paper in the dark too');
  assert.equal(await page.evaluate("getComputedStyle(document.querySelector('footer')).display"), 'none');
  await page.evaluate("dispatchEvent(new Event('afterprint'))");
}

assert.ok(bin);
// The refusals that axesThatStood asks for: an answer of the program, and no exception of the page.
await journey({ begin, shown, everywhere }, { begin: /status of 422 .*\/api\/(rows|sheet)/ });

// SPDX-License-Identifier: GPL-3.0-or-later
import { choice, el, table, tiles } from '../../../report/web/src/dom.js';
import { number, printed } from '../../../report/web/src/data.js';
import { fileAddress, freeName, getJson, postBlob, postJson, refresh, run } from './api.js';
import { fallingFigure } from './charts.js';
import { button, gate, guarded, kAddStations, kFitSquare, kOfSquare, needsSubject, panel, programWords, showError } from './parts.js';
import { moreOptions } from './options.js';
import { parameterPanel } from './parameters.js';
import { redrawAll } from './plot.js';
import { declareReflector, kReflector, needsReflector, stemOf } from './reflector.js';
import { along, choose, compared, loadRows, measured, setResiduals, subject } from './rows.js';
import { scatter } from './scatter.js';
import { emit, on, store } from './store.js';
import { termPanel } from './term.js';
import { beforeFits } from './uses.js';

const { steps } = store;

/** Beside the button that fits a printed square. */
const kSquareAlone =
  'These readings do not determine the squareness beside all other errors. If the distances of a printed square were measured, they determine the squareness and the scales of X and Y alone:';

const unfitted = (machine) => machine.replace(/(-fitted(-\d+)?)?\.xml$/i, '');

function note(label, machine, result) {
  steps.push({ label, machine, rms_um: result.rms_um, check_rms_um: result.check_rms_um, noise_um: result.noise_um });
  emit('steps');
}

/** Fits a machine into a new file; what came out is a step. */
async function fitInto(machine, label, options = {}) {
  const output = freeName(`${unfitted(machine)}-fitted`, '.xml');
  document.getElementById('fit-notes').replaceChildren(); // those of another fit
  const { result } = await run({ command: 'fit', ...measured(), machine, ...options, output });
  note(label, output, result);
  await choose(output, store.measurements);
  notesOfFit(machine, label, options, result.notes ?? [], result.fit_again);
  return result;
}

/** What the fit says beside its figures; a tool point that is not known is fitted with a button. */
function notesOfFit(machine, label, options, notes, again) {
  const box = document.getElementById('fit-notes');
  const square = again?.hold?.length;
  box.replaceChildren(
    ...notes
      .map((one) => (square && one.startsWith(kOfSquare) ? kSquareAlone : printed(programWords(one))))
      .map((one) => el('p', { class: 'note', role: 'status' }, one)),
  );
  if (square)
    box.append(
      el(
        'div',
        { class: 'controls' },
        button(kFitSquare, () => guarded(box, () => fitInto(beforeFits(machine), 'squareness and scales alone', again)), {
          id: 'fit-square',
        }),
      ),
    );
  const denser = stationButtons(notes.join(' '), document.getElementById('add-error'));
  if (denser.length) box.append(el('div', { class: 'controls' }, denser));
  if (notes.length) box.scrollIntoView({ block: 'nearest' });
  const free = notes.map((one) => one.match(/fit it: --free ([\w,]+)/)).find(Boolean);
  if (!free) return;
  const more = { ...options, free: [...(options.free ?? []), free[1]] };
  const fit = button('Fit the tool point too', () => guarded(box, () => fitInto(machine, `${label}, with its tool point`, more)), {
    id: 'fit-tool',
  });
  const reflector = button(kReflector, () => guarded(box, withReflector), { id: 'fit-reflector' });
  box.append(el('div', { class: 'controls' }, fit, reflector));
}

/** Declares the reflector in a new machine file, and fits it. */
export async function withReflector() {
  const output = await declareReflector();
  location.hash = '#add';
  await fitInto(output, 'with a reflector at an unknown place');
}

/**
 * Changes the machine that is chosen, in a new file, and fits it: before and after on the same scale. `change`: a command and its
 * options; `said(result)`: the name of the step.
 */
async function changeAndFit(stem, change, said) {
  const before = store.machine;
  if (steps.at(-1)?.machine !== before) await fitInto(before, 'the model, fitted');
  const output = freeName(stem(before), '.xml');
  const { result } = await run({ ...change, machine: store.machine, output });
  await fitInto(output, said(result));
}

/** Adds an effect. */
export async function addEffect(effect, error) {
  location.hash = '#add';
  await guarded(error ?? document.getElementById('add-error'), () =>
    changeAndFit(
      (name) => `${stemOf(name)}-added`,
      { command: 'add', effect },
      (result) => `+ ${result.said ?? result.label}`,
    ),
  );
}

/** Gives a table more stations. */
async function addStations(words) {
  location.hash = '#add';
  await changeAndFit(
    (name) => `${unfitted(name)}-stations`,
    { command: 'set', stations: [words] },
    () => `with stations ${words}`,
  );
  document
    .getElementById('fit-notes')
    .append(
      el(
        'p',
        { class: 'note' },
        'Keep the stations unless the rms of the held-out rows is larger by more than a tenth with them; otherwise press "Take the last step back".',
      ),
    );
}

/** A button for each table that a text of a command names as too coarse. */
export const stationButtons = (text, error) =>
  [...new Set([...text.matchAll(/vernier set MACHINE --stations (\S+) -o NEW/g)].map((one) => one[1]))].map((words) =>
    button(`${kAddStations}${words}`, () => guarded(error, () => addStations(words)), { class: 'quiet add-stations' }),
  );

/** Before and after, on fit and on held-out rows; the last step can be taken back. */
function stepsPanel() {
  const box = el('div', { id: 'steps' });
  const undo = button(
    'Take the last step back',
    async () => {
      const last = steps.pop();
      for (const name of [last.machine, last.machine.replace(/-fitted(-\d+)?\.xml$/, '.xml')]) {
        const entry = [...store.history].reverse().find((one) => !one.undone);
        if (!entry?.outputs?.includes(name)) continue;
        await postJson('/api/history', { do: 'undo' });
        await refresh();
      }
      emit('steps');
      if (steps.length) await choose(steps.at(-1).machine, store.measurements);
    },
    { class: 'quiet', id: 'undo-step' },
  );
  const draw = () => {
    gate(undo, steps.length < 2 ? 'There is no step to take back' : null);
    const last = steps.at(-1);
    const um = (label, value) => ({ label, value: number(value, 4), unit: 'µm', strong: true });
    const figures = last
      ? tiles([um('rms, fit rows', last.rms_um), um('rms, held-out rows', last.check_rms_um), um('noise', last.noise_um)])
      : null;
    if (figures) Object.assign(figures.dataset, { rms: last.rms_um, checkRms: last.check_rms_um });
    box.replaceChildren(
      ...(last
        ? [fallingFigure(steps, last.noise_um), figures]
        : [el('p', { class: 'note' }, 'Fit the model, then add what a diagnosis names, or a term of your own.')]),
    );
    redrawAll();
  };
  on('steps', draw);
  draw();
  return panel(
    'Watch the error fall',
    box,
    el(
      'div',
      { class: 'controls' },
      undo,
      el('a', { href: fileAddress('history.sh'), download: 'history.sh' }, 'history.sh'),
      el('span', { class: 'note' }, 'does all of this again'),
    ),
  );
}

/** One parameter at a time by hand: the residual follows while the slider moves. */
function sliderPanel(error) {
  let parameters = [],
    chosen = null,
    busy = false,
    waiting = false,
    base = null;
  const select = el('select', { id: 'parameter', 'aria-label': 'parameter' }),
    slider = el('input', { type: 'range', min: '-1', max: '1', step: '0.002', value: '0', id: 'slider', 'aria-label': 'value' });
  const value = el('output', { id: 'slider-value' }),
    numbers = el('span', { id: 'slider-figures', class: 'note' }),
    span = el('select', { 'aria-label': 'range' });
  const box = el('div', {});
  let plot = null;
  const spans = [1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1, 10];
  span.append(...spans.map((one) => el('option', { value: one, selected: one === 0.1 ? '' : null }, `± ${one}`)));
  const now = () => chosen.value + Number(slider.value) * Number(span.value);
  async function follow() {
    if (!chosen || !store.rows) return;
    value.textContent = `${number(now(), 7)} ${chosen.unit}`;
    if (busy) {
      waiting = true;
      return;
    }
    busy = true;
    const start = performance.now();
    try {
      const answer = await postBlob('/api/predict', { ...subject(), datum: store.datum, values: { [chosen.name]: now() } });
      setResiduals(store.rows, answer.residual);
      numbers.textContent = `rms ${number(answer.rms_um, 4)} µm on fit rows, ${number(answer.check_rms_um, 4)} µm on held-out rows`;
      Object.assign(numbers.dataset, { rms: answer.rms_um, ms: (performance.now() - start).toFixed(1) });
      redrawAll();
      error.replaceChildren();
    } catch (why) {
      await showError(error, why); // the value is none that the model can have
    } finally {
      busy = false;
      if (waiting) {
        waiting = false;
        follow();
      }
    }
  }
  const pick = (name) => {
    chosen = parameters.find((one) => one.name === name) ?? null;
    slider.value = '0';
    if (!chosen) return;
    const scale = Math.abs(chosen.value) || (chosen.unit === 'rad' ? 1e-4 : 0.1);
    span.value = String(spans.find((one) => one >= scale) ?? 10);
    value.textContent = `${number(chosen.value, 7)} ${chosen.unit}`;
  };
  select.addEventListener('change', () => pick(select.value));
  slider.addEventListener('input', follow);
  span.addEventListener('change', follow);
  const keep = button(
    'Keep this value',
    () =>
      guarded(error, async () => {
        const output = freeName(`${stemOf(store.machine)}-set`, '.xml');
        await run({ command: 'set', machine: store.machine, values: [`${chosen.name}=${now()}`], output });
        const { result } = await run({ command: 'compare', ...compared(), machine: output });
        note(`${chosen.name} by hand`, output, result);
        await choose(output, store.measurements);
      }),
    { class: 'quiet', id: 'keep-value' },
  );
  const back = button(
    'Back',
    async () => {
      slider.value = '0';
      await loadRows();
    },
    { class: 'quiet' },
  );
  async function build() {
    box.replaceChildren();
    parameters = store.rows
      ? await getJson('/api/parameters', {
          machine: store.machine,
          measurement: store.measurements,
          ...(store.datum ? { datum: '1' } : {}),
        }).catch(() => [])
      : [];
    select.replaceChildren(...parameters.map((one) => el('option', { value: one.name }, one.name)));
    pick(parameters[0]?.name);
    if (!store.rows) return;
    base = store.rows.columns[0];
    const columns = choice(
      'against',
      store.rows.columns.map((one, k) => [String(k), one.name]),
      '0',
      (k) => {
        base = store.rows.columns[Number(k)];
        plot.reset();
      },
    );
    let kind = 0;
    const kinds = choice(
      'residual of',
      store.rows.kinds.map((one, k) => [String(k), one.kind]),
      '0',
      (k) => {
        kind = Number(k);
        plot.reset();
      },
    );
    plot = scatter('residual while a parameter moves', {
      height: 260,
      name: 'by_hand',
      data: () => {
        const one = store.rows?.kinds[kind];
        return one ? { x: along(one, base), y: one.value, row: one.row, u: one.u, check: store.rows.row_check, overlay: null } : null;
      },
      words: () => ({ x: `${base.name} [${base.unit}]`, y: `${store.rows.kinds[kind].kind} [${store.rows.kinds[kind].unit}]` }),
    });
    box.append(el('div', { class: 'controls' }, kinds, columns), plot.element);
    redrawAll();
  }
  on('rows', build);
  build();
  return panel('By hand', el('div', { class: 'controls' }, select, slider, value, span, keep, back, numbers), box);
}

export function addView(root) {
  const error = el('div', { id: 'add-error' });
  const options = moreOptions('fit', ['machine', 'meas', 'images', 'output']);
  const fit = button('Fit the model', () => guarded(error, () => fitInto(store.machine, 'the model, fitted', options.values())), {
    id: 'fit',
    ...needsSubject,
  });
  const improve = button(
    'Walk the whole ladder',
    () =>
      guarded(error, async () => {
        const output = freeName('better', '');
        const { result } = await run({ command: 'improve', ...measured(), yes: true, output });
        for (const step of result.ladder)
          note(step.said ?? step.label ?? step.effect ?? 'the model', step.machine, { ...step, noise_um: result.noise_um });
        const last = result.ladder.at(-1)?.machine;
        if (last) await choose(last, store.measurements);
        improve.after(
          ' ',
          el('a', { href: fileAddress(`${output}/improve.html`), target: '_blank', rel: 'noopener' }, `${output}/improve.html`),
        );
      }),
    { class: 'quiet', ...needsSubject },
  );
  const effect = el('input', { type: 'text', class: 'term', 'aria-label': 'effect', placeholder: 'backlash:axis=X', id: 'effect' });
  const add = button('Add and fit', () => addEffect(effect.value.trim(), error), { class: 'quiet', id: 'add-effect', ...needsSubject });
  const reflector = button(kReflector, () => guarded(error, withReflector), {
    class: 'quiet',
    id: 'reflector',
    hidden: '',
    title: 'The fit then estimates the place, and does not take it for an error of the machine',
  });
  on('parameters', () => {
    reflector.hidden = !needsReflector();
  });
  const catalogue = el('div', { id: 'catalogue' });
  const list = button(
    'Catalogue',
    () =>
      guarded(error, async () => {
        if (catalogue.childElementCount) {
          catalogue.replaceChildren();
          return;
        }
        const { result } = await run({ command: 'effects' });
        const columns = ['effect', 'what', 'term', 'signature', 'exposed by'].map((name) => ({ name, left: true }));
        catalogue.replaceChildren(
          table(
            'Effects that can be added',
            columns,
            result.map((one) => [one.id, one.title, one.formula, one.signature, one.exposed_by]),
          ),
        );
        catalogue.querySelectorAll('tbody tr').forEach((row, i) => {
          row.tabIndex = 0;
          row.dataset.add = result[i].id;
          row.addEventListener('click', () => {
            effect.value = `${result[i].id}:axis=`;
            effect.focus();
          });
          row.addEventListener('keydown', (event) => {
            if (event.key === 'Enter') row.click();
          });
        });
      }),
    { class: 'quiet', id: 'show-catalogue' },
  );
  root.append(
    error,
    el('div', { id: 'fit-notes' }),
    panel(null, el('div', { class: 'controls' }, fit, reflector, improve, effect, add, list), options.element, catalogue),
    stepsPanel(),
    parameterPanel(),
    sliderPanel(error),
    termPanel((term) => addEffect(term, error)),
  );
  return { show: redrawAll };
}

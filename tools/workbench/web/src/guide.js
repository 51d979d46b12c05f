// SPDX-License-Identifier: GPL-3.0-or-later
import { el } from '../../../report/web/src/dom.js';
import { number } from '../../../report/web/src/data.js';
import { refusedRule } from './safety.js';
import { on, store } from './store.js';

const um = (value) => `${number(value, 3)} µm`;

function askWhatIsMissing() {
  if (!store.compare) return 'Ask what is missing.';
  const { rms_um, noise_um } = store.compare;
  if (!Number.isFinite(noise_um)) return `The residual of the model is ${um(rms_um)}, the noise is not known: ask what is missing.`;
  return rms_um > noise_um
    ? `The residual of the model is ${um(rms_um)}, the noise ${um(noise_um)}: ask what is missing.`
    : `The residual of the model (${um(rms_um)}) is not larger than the noise (${um(noise_um)}): ask whether anything is missing.`;
}

const isUnexplained = () => store.diagnosis?.verdict === 'unexplained';

/** What to do after the diagnosis: to add what it named, or only to fit. */
function afterDiagnosis() {
  const named = store.diagnosis?.candidates.some((one) => one.accepted) ?? true;
  if (named) return 'Fit, add what was named, and see the error fall on held-out rows.';
  return isUnexplained()
    ? 'An error remains that no known effect explains: measure what the diagnosis proposes, or fit the model as it is.'
    : 'No effect was named: fit the model as it is, then see whether it is safe to run.';
}

/** The correction of a model that is not complete can be safe: the rules do not judge what it leaves. */
function aboutSafety() {
  const [rule] = refusedRule(store.safety);
  return (
    (isUnexplained() ? 'The model is not complete: the correction leaves the error that no known effect explains. ' : '') +
    (rule
      ? `${rule.replace(/[;.]$/, '')}. The page says what to do about it.`
      : 'The rules of the safety sheet say whether the correction may run.')
  );
}

/** The files for a control are of the machine that is chosen; a fit after them makes another machine. */
const isExported = () => store.exported !== '' && store.exported === store.machine;

/** The way from a measurement to a board: [id, name, view, is it done?, what to do: words, or words and links]. */
const kPath = [
  ['data', 'Data', 'project', () => store.measurements.length > 0, () => 'Drop what was measured, in whatever file it came.'],
  ['model', 'Model', 'project', () => Boolean(store.machine), () => 'Drop the machine file, or make one.'],
  [
    'fails',
    'Where it fails',
    'compare',
    () => store.visited.has('compare') && store.compare !== null,
    () => 'See what the model leaves of the readings, and along what.',
  ],
  [
    'missing',
    'What is missing',
    'diagnose',
    () => store.diagnosis !== null || store.diagnosed.has(store.measurements.join('|')),
    askWhatIsMissing,
  ],
  ['fall', 'Watch it fall', 'add', () => store.steps.length > 0, afterDiagnosis],
  ['safe', 'Safe to run?', 'board', () => store.safety?.ok === true && store.safety.rules.every((one) => one.value !== null), aboutSafety],
  [
    'upload',
    'Upload or export',
    'board',
    () => store.uploaded || isExported(),
    () => [
      'With a board: compile, upload on trial, watch, confirm. Without a board: ',
      el('a', { href: '#export' }, 'Export'),
      ' writes the files for the control.',
    ],
  ],
];

/** Steps without which no later one can be done: data and model. */
const kNeeded = 2;

/** The path as a row of steps; each can be gone to at any time, and the whole can be put away. */
export function guide() {
  const list = el('ol', {}),
    hint = el('span', { class: 'note', id: 'guide-hint', role: 'status' });
  const away = el('button', { type: 'button', class: 'quiet', id: 'guide-away', title: 'put the path away' }, '×');
  const root = el('nav', { class: 'guide', id: 'guide', 'aria-label': 'The way' }, list, hint, away);
  const key = 'vernier:guide';
  const remember = (value) => {
    try {
      localStorage.setItem(key, value);
    } catch {
      /* private mode */
    }
  };
  try {
    root.hidden = localStorage.getItem(key) === 'away';
  } catch {
    /* private mode */
  }
  away.addEventListener('click', () => {
    root.hidden = true;
    remember('away');
  });
  const draw = () => {
    // A step before one that is done is behind the user, although its own page was not used: improve fits, diagnoses and
    // adds in one command, and a rule of the safety sheet may be accepted.
    const last = kPath.reduce((found, [, , , done], k) => (done() ? k : found), -1);
    const next = kPath.find(([, , , done], k) => !done() && (k > last || k < kNeeded));
    list.replaceChildren(
      ...kPath.map(([id, name, view, done], k) =>
        el(
          'li',
          {
            class: done() ? 'done' : k < last && k >= kNeeded ? 'passed' : null,
            'data-step': id,
            'aria-current': next?.[0] === id ? 'step' : null,
          },
          el('a', { href: `#${view}` }, `${k + 1} ${name}`),
        ),
      ),
    );
    // The whole list stands under Export.
    const kNamed = 2,
      rest = store.leftOut.length - kNamed;
    const without = [...store.leftOut.slice(0, kNamed), ...(rest > 0 ? [`${rest} more, listed under Export`] : [])].join('; ');
    const written = `The files for the control are written${without ? `, without: ${without}` : ''}.`;
    hint.replaceChildren(...[next ? next[4]() : store.uploaded ? 'The correction runs.' : written].flat());
  };
  for (const event of ['project', 'rows', 'compared', 'diagnosed', 'steps', 'safety', 'uploaded', 'view']) on(event, draw);
  draw();
  const show = el('button', { type: 'button', class: 'quiet', id: 'guide-show', title: 'show the path, or put it away' }, 'Path');
  show.addEventListener('click', () => {
    root.hidden = !root.hidden;
    remember(root.hidden ? 'away' : 'shown');
  });
  return { root, show };
}

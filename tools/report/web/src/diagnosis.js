// SPDX-License-Identifier: GPL-3.0-or-later
import { el, table, tiles } from './dom.js';
import { number, printed } from './data.js';
import { beforeAfter, ladder } from './plots.js';
import { sentencesOf, t } from './translate.js';

const kVerdicts = {
  'missing-effect': (best) => `Missing: ${best ? title(best) : 'an effect'}${best?.effect === 'custom' ? ', no named physics' : ''}`,
  ambiguous: (best, result) => openWords(result) ?? 'One of several effects: these measurements cannot distinguish them',
  unexplained: () => 'Something is missing, and nothing known explains it',
  instrument: () => 'The measurement is the likelier cause, not the machine',
  consistent: (best, result) =>
    isNoiseKnown(result)
      ? 'Nothing is missing: the residual is noise'
      : 'Nothing to add: these readings do not show whether the residual is noise',
};

/** True if u or repeats state the noise of the readings. */
const isNoiseKnown = (result) => Number.isFinite(result.noise_um) || Number.isFinite(result.noise_urad);

/** Of two possible headlines of an ambiguous verdict: the cause is found, and only periods are open; null if the cause is open. */
function openWords(result) {
  const add = result.ladder?.[1]?.add;
  const first = (result.candidates ?? []).find((one) => add && one.add === add);
  const open = (result.candidates ?? []).filter((one) => one.accepted && one.aliases?.length);
  if (!first || first.confounded_with?.length || result.ladder[1].confirmed === false || !open.length) return null;
  const spoken = (one) => printed(result.ladder.find((step) => step.add === one.add)?.said ?? title(one));
  const names = open.map(spoken).join('; ');
  return open.includes(first) ? `Found, but not its period: ${names}` : `Missing: ${title(first)}. The period is open of: ${names}`;
}

/** A figure of lengths in µm, of a measurement of angles alone in µrad: its value and unit under a key without the unit. */
const errorOf = (result, key) =>
  Number.isFinite(result[`${key}_um`]) || !Number.isFinite(result[`${key}_urad`])
    ? { value: result[`${key}_um`], unit: 'µm' }
    : { value: result[`${key}_urad`], unit: 'µrad' };
const error = (label, result, key, strong) => {
  const { value, unit } = errorOf(result, key);
  return { label, value: number(value, 4), unit, strong };
};

/** A text: many sentences as a list below the first one. */
function sentences(text) {
  const kOneParagraph = 3;
  const list = sentencesOf(t(printed(text)));
  if (list.length <= kOneParagraph) return el('p', {}, list.join(' '));
  return [
    el('p', {}, list[0]),
    el(
      'ul',
      {},
      list.slice(1).map((one) => el('li', {}, one)),
    ),
  ];
}

/** The verdict in words, with the numbers it rests on. */
export function verdict(result) {
  const best = result.candidates?.[0];
  const words = (kVerdicts[result.verdict] ?? (() => result.verdict ?? 'no verdict'))(best, result);
  const items = [
    error('rms, fit rows', result, 'rms', true),
    error('rms, check rows', result, 'check_rms', true),
    error('noise', result, 'noise'),
  ];
  if (best && (result.verdict === 'missing-effect' || result.verdict === 'ambiguous')) {
    items.push(error('rms with the first candidate', best, 'rms_after', true), error('… check rows', best, 'check_rms_after', true));
  }
  const second = typeof result.runner_up === 'string' ? result.runner_up : (result.runner_up?.said ?? result.runner_up?.effect);
  return [
    el('p', { class: `verdict ${result.verdict ?? ''}` }, words),
    result.explanation ? sentences(result.explanation) : null,
    tiles(items),
    second
      ? el(
          'p',
          { class: 'note' },
          `Runner-up: ${second}${Number.isFinite(result.runner_up?.score) ? `, score ${number(result.runner_up.score, 4)}` : ''}.`,
        )
      : null,
  ];
}

const stepName = (step, i) =>
  step.said ??
  step.label ??
  (step.effect ? `${i}. + ${step.effect}${step.axis ? ` of ${step.axis}` : ''}` : i === 0 ? 'model as given' : 'fitted');

/** The steps of a ladder, each with a label. */
export const labelled = (result) => (result.ladder ?? []).map((step, i) => ({ ...step, label: stepName(step, i) }));

/** The ladder with the noise floor. */
export function falling(result) {
  const steps = labelled(result);
  if (!steps.length) return null;
  const lengths = steps.some((step) => Number.isFinite(step.rms_um));
  const floor = lengths ? (steps.map((step) => step.noise_um).find(Number.isFinite) ?? result.noise_um) : result.noise_urad;
  return [
    ladder(steps, Number.isFinite(floor) ? floor : null),
    el('p', { class: 'note' }, 'Check rows are no part of any fit: only their fall is a gain.'),
  ];
}

/** What a candidate is called. */
export const title = (one) => printed(one.said ?? `${one.effect}${one.axis ? ` of ${one.axis}` : ''}`);

/** The causes that the data do not reject, if there are several; null if not. */
export function causes(result) {
  const list = result.causes ?? [];
  if (list.length < 2) return null;
  return [
    table(
      'Causes of the first step that the data do not reject, most likely first',
      [{ name: 'cause', left: true }, { name: 'evidence (ln likelihood ratio)' }],
      list.map((one) => [printed(one.description), number(one.evidence, 3)]),
      { whole: true },
    ),
    el(
      'p',
      { class: 'note' },
      `Level ${result.level}: the true cause is rejected at most one time in ${number(1 / (1 - result.level), 3)}.`,
    ),
  ];
}

/** What each candidate would do alone. */
export function candidates(result) {
  const list = result.candidates ?? [];
  if (!list.length) return [el('p', {}, 'No candidate.')];
  const { unit } = errorOf(list[0], 'rms_after');
  const has = (key) => list.some((one) => one[key] !== undefined && one[key] !== null && one[key] !== '');
  const columns = [
    ['cause', true, title],
    [`rms after [${unit}]`, false, (one) => number(errorOf(one, 'rms_after').value, 4)],
    [`check rms after [${unit}]`, false, (one) => number(errorOf(one, 'check_rms_after').value, 4)],
    ['share', false, (one) => (Number.isFinite(one.share) ? `${number(100 * one.share, 3)} %` : '–')],
    ['chance', false, (one) => number(one.p_value, 2)],
    ...(has('score') ? [['score', false, (one) => number(one.score, 4)]] : []),
    ...(list.some((one) => one.confounded_with?.length)
      ? [['not distinguished from', true, (one) => (one.confounded_with ?? []).map(t).join(', ')]]
      : []),
    ...(has('why_not') ? [['why not', true, (one) => one.why_not ?? '']] : []),
  ];
  const values = (one) =>
    (one.parameters ?? [])
      .map((p) =>
        typeof p === 'string'
          ? p
          : `${p.name} = ${number(p.value, 4)}${Number.isFinite(p.std) ? ` ± ${number(p.std, 2)}` : ''} ${p.unit ?? ''}${p.note ? ` (${p.note})` : ''}`,
      )
      .join('; ');
  const detail = (one) =>
    el(
      'details',
      {},
      el('summary', {}, title(one)),
      el(
        'ul',
        {},
        one.label ? el('li', {}, `In the chain: ${one.label}`) : null,
        one.term ? el('li', {}, 'Term: ', el('code', {}, one.term)) : null,
        one.signature ? el('li', {}, `Signature: ${one.signature}`) : null,
        values(one) ? el('li', {}, `Fitted: ${values(one)}`) : null,
        one.impostors?.length ? el('li', {}, `Known impostors: ${one.impostors.join(', ')}`) : null,
        one.why_not ? el('li', {}, `Not named because: ${one.why_not}`) : null,
        one.add ? el('li', {}, 'vernier add ', el('code', {}, one.add)) : null,
      ),
    );
  return [
    table(
      'Candidates, best first: what each would do alone',
      columns.map(([name, left]) => ({ name, left })),
      list.map((one) => columns.map(([, , text]) => text(one))),
      { whole: true },
    ),
    ...list.slice(0, 12).map(detail),
  ];
}

/** Texts, or objects with a sentence, as a list. */
export function next(result) {
  const list = (result.next_measurement ?? []).map((one) => (typeof one === 'string' ? one : (one.sentence ?? JSON.stringify(one))));
  return list.length
    ? el(
        'ul',
        {},
        list.map((text) => el('li', {}, text)),
      )
    : null;
}

const kAtReflector = 'The tool point of this loop is the reflector of the readings: a correction acts at the tool point.';

/** The same ladder in the simulated control loop. */
export function simulated(result) {
  const s = result.simulation;
  if (!s) return null;
  const figures = tiles([
    error('rms without correction, fit rows', s, 'rms_before', true),
    error('rms with correction, fit rows', s, 'rms_after', true),
    error('largest without correction', s, 'max_before'),
    error('largest with correction', s, 'max_after'),
    { label: 'ticks of 1 ms', value: number(s.ticks, 7) },
  ]);
  const notes = [s.tool_point === 'reflector' ? kAtReflector : null, s.note].filter(Boolean);
  return notes.length ? [figures, ...notes.map((note) => el('p', { class: 'note' }, printed(note)))] : figures;
}

/** The residuals before the first and after the last effect. */
export function pictures(result) {
  const list = result.pictures ?? [];
  if (!list.length) return null;
  return [
    el('div', { class: 'pictures' }, list.map(beforeAfter)),
    el(
      'p',
      { class: 'note' },
      'Each point is a reading minus the model: before the first effect was added, and after the last. A pattern before that is gone after is explained.',
    ),
  ];
}

// SPDX-License-Identifier: GPL-3.0-or-later
import { el, table, tiles } from './dom.js';
import { number, printed } from './data.js';
import { ladder } from './plots.js';

const kVerdicts = {
  'missing-effect': (best) => `Missing: ${best ? title(best) : 'an effect'}${best?.effect === 'custom' ? ', no named physics' : ''}`,
  ambiguous: () => 'One of several effects: these measurements cannot tell which',
  unexplained: () => 'Something is missing, and nothing known explains it',
  instrument: () => 'The measurement is the likelier cause, not the machine',
  consistent: () => 'Nothing is missing: the residual is noise',
};

const um = (label, value, strong) => ({ label, value: number(value, 4), unit: 'µm', strong });

/** The verdict in words, with the numbers it rests on. */
export function verdict(result) {
  const best = result.candidates?.[0];
  const words = (kVerdicts[result.verdict] ?? (() => result.verdict ?? 'no verdict'))(best);
  const items = [um('rms, fit rows', result.rms_um, true), um('rms, check rows', result.check_rms_um, true), um('noise', result.noise_um)];
  if (best && (result.verdict === 'missing-effect' || result.verdict === 'ambiguous')) {
    items.push(um('rms with the first candidate', best.rms_after_um, true), um('… check rows', best.check_rms_after_um, true));
  }
  const second = typeof result.runner_up === 'string' ? result.runner_up : (result.runner_up?.said ?? result.runner_up?.effect);
  return [
    el('p', { class: `verdict ${result.verdict ?? ''}` }, words),
    result.explanation ? el('p', {}, printed(result.explanation)) : null,
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
  const floor = steps.map((step) => step.noise_um).find(Number.isFinite) ?? result.noise_um;
  return [
    ladder(steps, Number.isFinite(floor) ? floor : null),
    el('p', { class: 'note' }, 'Check rows are no part of any fit: only their fall is a gain.'),
  ];
}

/** What a candidate is called. */
export const title = (one) => printed(one.said ?? `${one.effect}${one.axis ? ` of ${one.axis}` : ''}`);

/** What each candidate would do alone. */
export function candidates(result) {
  const list = result.candidates ?? [];
  if (!list.length) return [el('p', {}, 'No candidate.')];
  const has = (key) => list.some((one) => one[key] !== undefined && one[key] !== null && one[key] !== '');
  const columns = [
    ['cause', true, title],
    ['term', true, (one) => one.term ?? ''],
    ['rms after [µm]', false, (one) => number(one.rms_after_um, 4)],
    ['check rms after [µm]', false, (one) => number(one.check_rms_after_um, 4)],
    ['share', false, (one) => (Number.isFinite(one.share) ? `${number(100 * one.share, 3)} %` : '–')],
    ['chance', false, (one) => number(one.p_value, 2)],
    ...(has('score') ? [['score', false, (one) => number(one.score, 4)]] : []),
    ['not distinguished from', true, (one) => (one.confounded_with ?? []).join(', ')],
    ...(has('why_not') ? [['why not', true, (one) => one.why_not ?? '']] : []),
  ];
  const values = (one) =>
    (one.parameters ?? [])
      .map((p) =>
        typeof p === 'string'
          ? p
          : `${p.name} = ${number(p.value, 4)}${Number.isFinite(p.std) ? ` ± ${number(p.std, 2)}` : ''} ${p.unit ?? ''}`,
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

/** The same ladder in the simulated control loop. */
export function simulated(result) {
  const s = result.simulation;
  if (!s) return null;
  return tiles([
    um('rms without correction', s.rms_before_um, true),
    um('rms with correction', s.rms_after_um, true),
    um('largest with correction', s.max_after_um),
    { label: 'ticks', value: number(s.ticks, 7) },
  ]);
}

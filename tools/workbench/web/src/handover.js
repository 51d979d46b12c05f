// SPDX-License-Identifier: GPL-3.0-or-later
import { choice, el } from '../../../report/web/src/dom.js';
import { fileAddress, freeName, run } from './api.js';
import { option } from './options.js';
import { button, guarded, needsSubject, panel } from './parts.js';
import { compared, measured } from './rows.js';
import { on, store } from './store.js';

/** What stands at the head of a report; kept in this browser, for a shop writes more than one. */
const kHeader = ['company', 'machine', 'serial number', 'operator', 'instrument', 'date', 'temperature'];
const kKept = 'vernier:header';
const kLanguages = { de: 'Deutsch' };

function kept() {
  try {
    return JSON.parse(localStorage.getItem(kKept)) ?? {};
  } catch {
    return {};
  }
}

/** The measurement files with readings along an axis; `alone`: with no reading along another axis. */
function filesAlong(axis) {
  const { rows } = store,
    name = axis.toLowerCase();
  if (!rows || !axis) return [];
  const kinds = rows.files.map(() => new Set());
  for (const group of rows.kinds) for (const row of group.row) kinds[rows.row_file[row]].add(group.kind);
  return rows.files.map((file, i) => ({ name: file, alone: kinds[i].size === 1, along: kinds[i].has(name) })).filter((file) => file.along);
}

/** The head of a report and its language, as the fields have them: part of a request. */
export function reportHead() {
  const values = kept();
  const list = kHeader.filter((key) => values[key]).map((key) => `${key}=${values[key]}`);
  return { ...(list.length ? { header: list } : {}), ...(values.language ? { language: values.language } : {}) };
}

/** Reports for customers and auditors: with a head, and for an axis with a tolerance and its verdict (ISO 230-2). */
export function handoverPanel() {
  const error = el('div', {}),
    links = el('p', { id: 'handover-links' });
  const values = kept();
  const keep = (key, value) => {
    values[key] = value;
    try {
      localStorage.setItem(kKept, JSON.stringify(values));
    } catch {
      /* private mode */
    }
  };
  const languages = option('compare', 'language').words ?? [];
  const language = choice(
    'language of the reports',
    [['', 'English'], ...languages.map((one) => [one, kLanguages[one] ?? one])],
    values.language ?? '',
    (value) => keep('language', value),
  );
  language.querySelector('select').id = 'report-language';
  const fields = kHeader.map((key) => {
    const input = el('input', {
      type: 'text',
      value: values[key] ?? '',
      'aria-label': key,
      maxlength: '120',
      id: `header-${key.replace(' ', '-')}`,
    });
    input.style.minWidth = '9em';
    input.addEventListener('change', () => keep(key, input.value.trim()));
    return el('label', { class: 'choice' }, `${key} `, input);
  });
  const answer = el('p', { id: 'handover-answer', class: 'verdict', role: 'status' });
  const offer = (name) => links.append(el('a', { href: fileAddress(name), target: '_blank', rel: 'noopener' }, name), ' ');
  const report = (label, id, base, fields_of) =>
    button(
      label,
      () =>
        guarded(error, async () => {
          const output = freeName(base(), '.html');
          answer.textContent = '';
          try {
            await run({ ...fields_of(), ...reportHead(), output });
          } catch (why) {
            // A tolerance that is not met is an answer: the report has the figures.
            if (why.job?.exit !== 2) throw why;
            answer.textContent = `Not met: ${why.message.replace(/^vernier: /, '')}`;
          }
          offer(output);
        }),
      { class: 'quiet', id, ...needsSubject },
    );
  let axis = '',
    run_files = []; // measurements of the run along this axis
  const axes = el('span', {}),
    files = el('span', {});
  const chooseAxis = (value) => {
    axis = value;
    const along = filesAlong(axis),
      alone = along.filter((file) => file.alone).map((file) => file.name),
      all = along.map((file) => file.name);
    const choices = [
      ...new Map([alone, all, ...all.map((name) => [name])].filter((list) => list.length).map((list) => [list.join(' + '), list])),
    ];
    run_files = choices[0]?.[1] ?? store.measurements;
    files.replaceChildren(
      choices.length > 1
        ? choice(
            'measured in',
            choices.map(([words]) => [words, words]),
            choices[0][0],
            (words) => {
              run_files = choices.find(([one]) => one === words)[1];
            },
          )
        : '',
    );
  };
  const micrometres = (label) => {
    const node = el('input', { type: 'text', 'aria-label': label, size: '5', placeholder: 'µm' });
    node.style.minWidth = '0';
    return node;
  };
  const tolerance = micrometres('tolerance of A'),
    uncertainty = micrometres('its uncertainty, k = 2');
  /** A number of micrometres, or with a unit of its own: "50", "50um", "0,05 mm". */
  const length = (input, key) => {
    const words = input.value
      .trim()
      .replace(',', '.')
      .replace(/\s+/g, '')
      .replace(/[µμ]m$/, 'um');
    return words ? { [key]: [`A=${words}${/[a-z]$/i.test(words) ? '' : 'um'}`] } : {};
  };
  on('rows', () => {
    // Axes along which something was measured that has their name in small letters.
    const known = (store.rows?.columns ?? []).filter(
      (one) => one.kind === 'axis' && store.rows.kinds.some((kind) => kind.kind === one.name.toLowerCase()),
    );
    chooseAxis(known[0]?.name ?? '');
    axes.replaceChildren(
      known.length
        ? choice(
            'axis',
            known.map((one) => [one.name, one.name]),
            axis,
            chooseAxis,
          )
        : '',
    );
  });
  const box = panel(
    'Reports to hand over',
    el('div', { class: 'controls' }, fields, language),
    el(
      'div',
      { class: 'controls' },
      report(
        'Comparison',
        'handover-compare',
        () => 'compare',
        () => ({ command: 'compare', ...compared() }),
      ),
      report(
        'What is missing',
        'handover-diagnose',
        () => 'diagnose',
        () => ({ command: 'diagnose', ...measured() }),
      ),
    ),
    el(
      'div',
      { class: 'controls' },
      axes,
      files,
      el('label', { class: 'choice' }, 'tolerance of A ', tolerance),
      el('label', { class: 'choice' }, 'its U (k = 2) ', uncertainty),
      report(
        'Positioning (ISO 230-2)',
        'handover-positioning',
        () => `iso230-2_${axis}`,
        () => ({
          command: 'evaluate iso230-2',
          meas: run_files,
          axis: [axis],
          ...length(tolerance, 'tolerance'),
          ...length(uncertainty, 'uncertainty'),
        }),
      ),
    ),
    answer,
    links,
    error,
  );
  box.classList.add('hands'); // on paper nobody presses a button
  return box;
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Texts of a report in another language: {language, decimal, texts: {English: translation}}. In a text # is a number
// and * any words: both are found again in the translation, in their order.

const kNumber = '[+−-]?\\d[\\d.]*(?:e[+−-]?\\d+)?';
const kNumbers = new RegExp(kNumber, 'g'),
  kOnlyNumber = new RegExp(`^${kNumber}( [%‰°]| [µu]?m|)$`);

const kBetweenSentences = /(?<=[.!?]) (?=[A-Z\d])/;

let exact = new Map(),
  patterns = [],
  decimal = '.';

const local = (number) => number.replace('.', decimal);
const kNumberList = /^[\d.,;+−\- ]+$/;
/** Words in a place: translated as a whole, as a list, or as numbers. */
function inPlace(words) {
  const whole = t(words);
  if (whole !== words) return whole;
  if (kNumberList.test(words)) return words.replace(kNumbers, local);
  return words.split(', ').map(t).join(', ');
}
const escaped = (text) => text.replace(/[.*+?^${}()|[\]\\]/g, '\\$&');

/** A translation with its places filled in. */
function filled(translation, parts) {
  let next = 0;
  return translation.replace(/[#*]/g, (sign) => {
    const part = parts[next++] ?? '';
    return sign === '#' ? local(part) : inPlace(part);
  });
}

function compiled(key, translation) {
  const source = key
    .split(/([#*])/)
    .map((part) => (part === '#' ? `(${kNumber})` : part === '*' ? '(.+?)' : escaped(part)))
    .join('');
  return { form: new RegExp(`^${source}$`, 's'), translation, sentences: /[.!?] [A-Z\d*#]/.test(key) };
}

/** From now on t() translates; without a catalogue every text stays as it is. */
export function useCatalogue(catalogue) {
  if (!catalogue) return;
  decimal = catalogue.decimal ?? '.';
  const entries = Object.entries(catalogue.texts ?? {});
  exact = new Map(entries.filter(([key]) => !key.includes('*')));
  // The longest first: "* over *" fits much.
  patterns = entries
    .filter(([key]) => key.includes('*'))
    .sort(([a], [b]) => b.length - a.length)
    .map(([key, translation]) => compiled(key, translation));
  document.documentElement.lang = catalogue.language ?? 'en';
}

/** The text in the language of the report, or the text itself if the catalogue does not have it. */
export function t(text) {
  if (exact.size === 0 || typeof text !== 'string') return text;
  const [, before, words, after] = /^(\s*)([^]*?)(\s*)$/.exec(text);
  if (words === '') return text;
  return before + translated(words) + after;
}

function translated(words) {
  const whole = matched(words);
  if (whole !== words) return whole;
  const sentences = words.split(kBetweenSentences);
  return sentences.length > 1 ? sentences.map(matched).join(' ') : words;
}

function matched(words) {
  if (exact.has(words)) return exact.get(words);
  if (kOnlyNumber.test(words)) return local(words);
  const key = words.replace(kNumbers, '#');
  if (key !== words && exact.has(key)) return filled(exact.get(key), words.match(kNumbers));
  const withUnit = /^(.+) \[([^\]]*)\]$/.exec(words);
  if (withUnit) return `${t(withUnit[1])} [${withUnit[2]}]`;
  // The words of one sentence stand for no words of the next one.
  const several = kBetweenSentences.test(words);
  for (const { form, translation, sentences } of patterns) {
    const found = several && !sentences ? null : form.exec(words);
    if (found) return filled(translation, found.slice(1));
  }
  return words;
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Texts of a report in another language: {language, decimal, texts: {English: translation}}. In a text # is a number
// and * any words: both are found again in the translation, in their order.

const kNumber = '[+−-]?\\d(?:[\\d.]*\\d)?(?:e[+−-]?\\d+)?';
const kNumbers = new RegExp(kNumber, 'g'),
  kOnlyNumber = new RegExp(`^${kNumber}( [%‰°]| [µu]?m|)$`);

// A sentence begins with a capital letter, a number, the name of a reading, or the name of a file.
const kBetweenSentences = /(?<=[.!?]) (?=[A-Z\d]|distance |\S+\.\w+: the )/;

export const sentencesOf = (text) => text.split(kBetweenSentences);

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
  if (words.includes('; ')) return words.split('; ').map(inPlace).join('; ');
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
  const sentences = sentencesOf(words);
  return sentences.length > 1 ? sentences.map(matched).join(' ') : words;
}

/** The translation of a text that has no pattern with words in it. */
function plain(words) {
  if (exact.has(words)) return exact.get(words);
  if (kOnlyNumber.test(words)) return local(words);
  const key = words.replace(kNumbers, '#');
  if (key !== words && exact.has(key)) return filled(exact.get(key), words.match(kNumbers));
  const withUnit = /^(.+) \[([^\]]*)\]$/.exec(words);
  return withUnit ? `${t(withUnit[1])} [${withUnit[2]}]` : null;
}

/** The longest pattern of a text, as {index, found}. */
function pattern(words) {
  // The words of one sentence stand for no words of the next one.
  const several = kBetweenSentences.test(words);
  for (const [index, { form, sentences }] of patterns.entries()) {
    const found = several && !sentences ? null : form.exec(words);
    if (found) return { index, found };
  }
  return { index: patterns.length, found: null };
}

function matched(words) {
  const known = plain(words);
  if (known !== null) return known;
  const whole = pattern(words);
  // A name at the end of a sentence is the same name: its longer pattern counts, which knows no dot.
  const name = words.endsWith('.') ? words.slice(0, -1) : null;
  if (name !== null && !kBetweenSentences.test(words)) {
    const exactly = whole.found ? null : plain(name);
    if (exactly !== null) return `${exactly}.`;
    const other = pattern(name);
    if (other.index < whole.index) return `${filled(patterns[other.index].translation, other.found.slice(1))}.`;
  }
  return whole.found ? filled(patterns[whole.index].translation, whole.found.slice(1)) : words;
}

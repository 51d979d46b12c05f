// SPDX-License-Identifier: GPL-3.0-or-later
// What a file of the project is, and what a person can do with it.
import { getJson } from './api.js';
import { store } from './store.js';

/** By kind: [words for the table of files, label of its button]. */
const kKinds = {
  machine: ['machine', 'use'],
  measurement: ['measurement', 'use'],
  sheet: ['spreadsheet, to be imported', 'import'],
  instrument: ['instrument file, to be imported', 'import'],
  trace: ['file of Ballbar Trace, to be imported', 'import'],
  printer: ['bed of a 3D printer, to be imported', 'import'],
  robot: ['description of a robot', 'make a machine file'],
  program: ['part program: "Correct" under Export', null],
  report: ['report', null],
  image: ['image', null],
  key: ['key', null],
  history: ['commands of the history', null],
  fleet: ['registry of a fleet: see Fleet', null],
  result: ['part of a result', null],
  workbook: ['cannot be read: save it as .xlsx', null],
  unused: ['the workbench cannot use it', null],
};

export const kindWords = (kind) => kKinds[kind][0];
export const kindAction = (kind) => kKinds[kind][1];

/** The words of a command of the history, without the quotes of a shell. */
const wordsOf = (command) =>
  [...command.matchAll(/(?:'[^']*'|\\.|[^\s'\\])+/g)].map(([word]) => word.replace(/'([^']*)'|\\(.)/g, (_, quoted, one) => quoted ?? one));
const stored = (name) => store.files.some((one) => one.name === name);
/** The imports of the history that read or wrote a file, latest first: {read, written}, of files that are still there. */
const importsOf = (name) =>
  store.history
    .filter((one) => !one.undone && /^import\b/.test(one.name))
    .map((one) => ({
      read: wordsOf(one.command).filter((word) => stored(word) && !(one.outputs ?? []).includes(word) && !/\.xml$/i.test(word)),
      written: (one.outputs ?? []).filter(stored),
    }))
    .filter((one) => one.read.includes(name) || one.written.includes(name))
    .reverse();

/** The file of which an import made this measurement file; the file itself if nothing says so. */
export const sourceOf = (name) => importsOf(name).find((one) => one.written.includes(name) && one.read.length)?.read[0] ?? name;
/**
 * What the last command of the history that wrote a file was given: {name, given: {option: [words]}, words: those without an option,
 * the files}; null: the history has none. `names`: the first words of such commands.
 */
function commandThatMade(file, names) {
  const entry = [...store.history]
    .reverse()
    .find((one) => !one.undone && names.test(one.name) && one.outputs?.some((output) => output === file || file.startsWith(`${output}/`)));
  const declared = store.commands.find((one) => one.name === entry?.name)?.options;
  if (!declared) return null;
  const made = { name: entry.name, given: {}, words: [] },
    rest = wordsOf(entry.command).slice(1 + entry.name.split(' ').length);
  while (rest.length) {
    const word = rest.shift(),
      one = declared.find(({ typed }) => typed && typed === word);
    if (!one) made.words.push(word);
    else (made.given[one.name] ??= []).push(one.kind === 'flag' ? word : rest.shift());
  }
  return made;
}
/** What the last import that wrote a measurement file was given: {kind, given}. */
export function importThatMade(name) {
  const made = commandThatMade(name, /^import\b/);
  return made && { kind: made.name.slice('import '.length), given: made.given };
}
/** Of which files the last fit made a machine file: {machine, meas}, all of them still there; null: the history does not say. */
export function fitThatMade(name) {
  const [machine, ...meas] = commandThatMade(name, /^fit$/)?.words ?? [];
  return meas.length && [machine, ...meas].every(stored) ? { machine, meas } : null;
}
/** The machine file before all fits of which a machine file is the last: a parameter that a further fit holds keeps no value of them. */
export function beforeFits(name) {
  for (let steps = 0; steps < store.history.length; ++steps) {
    const made = fitThatMade(name);
    if (!made) break;
    name = made.machine;
  }
  return name;
}
/** The description of the robot of which the history made a machine file: {original, tip}, words of the options; null: none. */
export function urdfOf(machine) {
  for (let file = machine, steps = 0; file && steps < store.history.length; ++steps) {
    const made = commandThatMade(file, /^(new|fit|set|add|improve)$/);
    const { urdf, tip } = made?.given ?? {};
    if (urdf) return urdf.every(stored) ? { original: urdf, ...(tip ? { tip } : {}) } : null;
    file = made?.words.find((word) => /\.xml$/i.test(word));
  }
  return null;
}
/** The measurement files that imports made of a file. */
export const readInto = (name) => [
  ...new Set(
    importsOf(name)
      .filter((one) => one.read.includes(name))
      .flatMap((one) => one.written),
  ),
];

const kByName = [
  [/\.urdf$/i, 'robot'],
  [/\.json$/i, 'trace'],
  [/\.xlsx$/i, 'sheet'],
  [/\.(xls|ods)$/i, 'workbook'],
  [/\.(cfg|log)$/i, 'printer'],
  [/\.(nc|ngc|gcode|g|tap|mpf|h|cnc)$/i, 'program'],
  [/^history\.sh$/, 'history'],
  [/\.db$/i, 'fleet'],
];
/** The contents say what these are. */
const kAsked = /\.(csv|txt|tsv|dat|asc)$/i;
const kBelongs = ['machine', 'report', 'image', 'key'];

// Asked once for each state of a file.
const known = new Map();

/** The kind of a file of the project; where its contents have to be read for it, they are. */
export async function kindOf(file) {
  if (kBelongs.includes(file.kind)) return file.kind;
  if (file.importer) return 'instrument';
  // A command wrote what is in a folder, but for measurements.
  const inFolder = file.name.includes('/');
  if (inFolder && !/\.csv$/i.test(file.name)) return 'result';
  const byName = kByName.find(([pattern]) => pattern.test(file.name));
  if (byName) return byName[1];
  if (!kAsked.test(file.name)) return 'unused';
  const key = `${file.name} ${file.modified_s} ${file.bytes}`;
  if (!known.has(key))
    known.set(
      key,
      getJson('/api/kind', { name: file.name }).then(
        (answer) => answer.kind,
        () => 'measurement',
      ),
    );
  const kind = await known.get(key);
  if (inFolder && kind !== 'measurement') return 'result';
  // Only a .csv is read as it is by the commands of a measurement.
  return kind === 'measurement' && !/\.csv$/i.test(file.name) ? 'sheet' : kind;
}

/** The names of the files of the project that the commands read as they are. */
export async function measurementFiles() {
  const { files } = store,
    kinds = await Promise.all(files.map(kindOf));
  return files.filter((_, i) => kinds[i] === 'measurement').map((file) => file.name);
}

/** A file was replaced: what it is has to be asked again, though its time and size may be the same. */
export function forget(name) {
  for (const key of [...known.keys()]) if (key.startsWith(`${name} `)) known.delete(key);
}

export const kindOfName = (name) => kindOf(store.files.find((file) => file.name === name) ?? { name, kind: 'other' });

const kReads =
  'The workbench reads spreadsheets (.xlsx, .csv, .txt), files of an instrument (.b5r, .rtl), files of a 3D printer (printer.cfg, klippy.log, heightmap.csv), machine files (.xml) and descriptions of robots (.urdf).';
const kAdvice = {
  workbook:
    'is stored, but the workbench cannot read a workbook of this kind. Open the file in your spreadsheet program, save it as .xlsx or as .csv, and drop the new file.',
  unused: `is stored, but the workbench cannot use a file of this kind. ${kReads}`,
  program:
    'is stored. It is a part program: under Export, "Correct" writes it with the correction of the machine, for a control without a table.',
  fleet: 'is stored. It is a registry of a fleet: look at it under Fleet.',
  report: 'is stored. It is a report: its name below opens it.',
  key: 'is stored. It is a key: choose it under Compile and upload.',
  image: 'is stored. It is an image: the workbench uses it for rows that were measured with this correction.',
};
/** What a dropped file is good for that is not used at once; null: it is used at once. */
export const adviceOn = (kind) => kAdvice[kind] ?? null;

#!/usr/bin/env node
// SPDX-License-Identifier: GPL-3.0-or-later
// translate_test.mjs: sentences of diagnose, improve and fit in German, and a pattern that stays in its sentence.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';

globalThis.document = { documentElement: {} };
const { t, useCatalogue } = await import('../../../tools/report/web/src/translate.js');
useCatalogue(JSON.parse(readFileSync(new URL('../../../tools/report/languages/de.json', import.meta.url), 'utf8')));

const german = {
  'The residual is noise: there is nothing to add. ../j1/laser_X.csv: the lengths of this file have no u, and other readings have one. The estimate u = 0.452 µm ± 0.023 is used, from the residual of the file beside the fitted model, which can contain errors of the model (188 degrees of freedom). If you know the standard uncertainty, state it in a column u[µm].':
    'Das Residuum ist Rauschen: es ist nichts hinzuzufügen. ../j1/laser_X.csv: die Längen dieser Datei haben kein u, und andere Messwerte haben eines. Verwendet wird die Schätzung u = 0,452 µm ± 0,023, aus dem Residuum der Datei gegen das angepasste Modell, das Fehler des Modells enthalten kann (188 Freiheitsgrade). Wenn die Standardunsicherheit bekannt ist, geben Sie sie in einer Spalte an: u[µm].',
  'laser_Y.csv: the rotations of this file have no ur, and other readings have one. The estimate ur = 7.3 arcsec +- 0.36 is used, from the repeated readings of the file (170 degrees of freedom).':
    'laser_Y.csv: die Drehungen dieser Datei haben kein ur, und andere Messwerte haben eines. Verwendet wird die Schätzung ur = 7,3 arcsec ± 0,36, aus den wiederholten Messwerten der Datei (170 Freiheitsgrade).',
  'X table: reversal error that builds up, reversal value B 13.4 ± 0.8 µm, complete after a travel of 1.0 ± 1.0 mm':
    'X-Tisch: Umkehrfehler mit Anlaufweg, Umkehrspanne B 13,4 ± 0,8 µm, vollständig nach einem Weg von 1,0 ± 1,0 mm',
  'Missing: X carriage: backlash, reversal value B −8.0 ± 0.3 µm': 'Es fehlt: X-Schlitten: Umkehrspiel, Umkehrspanne B −8,0 ± 0,3 µm',
  'X carriage: thermal growth, by T_bed −11.6 ± 0.4 µm/(m °C)': 'X-Schlitten: Wärmedehnung, durch T_bed −11,6 ± 0,4 µm/(m °C)',
  'Possibly the survey was disturbed: a drift of 273 µm. A missing effect (such as a backlash) can look like this disturbance: vernier diagnose compares the causes.':
    'Möglicherweise war die Messung gestört: eine Drift von 273 µm. Ein fehlender Effekt (etwa ein Umkehrspiel) kann wie diese Störung aussehen: vernier diagnose vergleicht die Ursachen.',
  'X carriage: backlash, reversal value B 8.0 ± 0.3 µm. The BIC of the next best cause, Y carriage: drift of the base or the instrument along X, is higher by 54. Beside it: Y carriage: backlash. With 2 effects the rms of the check rows (held-out rows) changes from 4.966 to 4.857 µm.':
    'X-Schlitten: Umkehrspiel, Umkehrspanne B 8,0 ± 0,3 µm. Das BIC der nächstbesten Ursache, Y-Schlitten: Drift der Grundlage oder des Messgeräts entlang X, ist um 54 höher. Außerdem: Y-Schlitten: Umkehrspiel. Mit 2 Effekten ändert sich der Effektivwert der Prüfzeilen von 4,966 auf 4,857 µm.',
  'A curve between two stations of the table of X can be this error: add stations to the table (vernier set MACHINE --stations X=70 -o NEW), fit and diagnose again, and keep them unless the rms of the check rows is larger by more than a tenth with them.':
    'Eine Kurve zwischen zwei Stützstellen der Tabelle von X kann dieser Fehler sein: fügen Sie der Tabelle Stützstellen hinzu (vernier set MACHINE --stations X=70 -o NEW), passen Sie an und diagnostizieren Sie erneut, und behalten Sie die Stützstellen, sofern der Effektivwert der Prüfzeilen mit ihnen nicht um mehr als ein Zehntel größer ist.',
  'Level 0.95: the true cause is rejected at most one time in 20.':
    'Niveau 0,95: die wahre Ursache wird höchstens einmal in 20 Fällen ausgeschlossen.',
  'X error repeats every 248.6 mm of X with an amplitude of 0.946 um; at positions 50 mm apart, the periods 62.59 and 41.63 mm give the same readings, in all runs.':
    'Fehler in X wiederholt sich alle 248,6 mm von X mit einer Amplitude von 0,946 µm; bei Positionen im Abstand 50 mm ergeben die Perioden 62,59 und 41,63 mm dieselben Ablesungen, in allen Läufen.',
  'Found by the fit: The residual is 3.2 times the noise: the model lacks an effect of 4, 0, 3.62 um in x, y, z.':
    'Bei der Anpassung gefunden: Das Residuum ist das 3,2-Fache des Rauschens: Im Modell fehlt etwas, 4, 0, 3,62 µm in x, y, z.',
  'The residual is larger than the noise, and no effect of the catalogue explains the residual. distance from the artefact falls with T_bed, in proportion (8.82 µm per 10 °C); run moves along with it and would explain as much.':
    'Das Residuum ist größer als das Rauschen, und kein Effekt des Katalogs erklärt es. Abstand vom Objekt fällt mit T_bed, proportional (8,82 µm je 10 °C); Lauf ändert sich mit und würde ebenso viel erklären.',
  'tool: offset of the point. The BIC of the next best cause, joint J6: straightness in a, is higher by 640.':
    'Werkzeug: Versatz des Punkts. Das BIC der nächstbesten Ursache, Gelenk J6: Geradheit in a, ist um 640 höher.',
  'X error drifts with visit, on a curve (15.9 um in all over 0 to 25), in all runs; dirX moves along with it and would explain as much':
    'Fehler in X driftet mit Zeilennummer im Lauf (visit), nicht linear (zusammen 15,9 µm über 0 bis 25), in allen Läufen; dirX ändert sich mit und würde ebenso viel erklären',
  'X table: backlash and Z carriage: drift of the base or the instrument along X cannot be separated by 60 points of any admissible pose, approach direction, speed, time or input: these points reach a non-centrality of 2.98, but 21.1 is required.':
    'X-Tisch: Umkehrspiel und Z-Schlitten: Drift der Grundlage oder des Messgeräts entlang X lassen sich mit 60 Punkten in keiner zulässigen Stellung, Anfahrrichtung, Geschwindigkeit, Zeit oder Eingangsgröße unterscheiden: diese Punkte erreichen eine Nichtzentralität von 2,98; nötig ist 21,1.',
};
for (const [english, translation] of Object.entries(german)) assert.equal(t(english), translation);

// Every effect of the catalogue, at every part of a machine, in every form that its name can have.
const catalogue = readFileSync(new URL('../../../tools/effects/catalogue.txt', import.meta.url), 'utf8');
const entries = (key) =>
  catalogue
    .split('\n')
    .filter((line) => line.startsWith(`${key} `))
    .map((line) => line.slice(key.length + 1));
const short = entries('short'),
  ids = entries('effect');
const kEnglish = /carriage|table|head|joint|frame|workpiece|tool|along|about|, by|period|position|axis|transform|of the point/;
let names = 0;
for (const what of short) {
  for (const part of ['X carriage', 'Y table', 'C head', 'joint J2', 'frame', 'tool', 'workpiece'])
    for (const where of ['', ' along Y', ' about Z', ...(part === 'joint J2' ? [' in th'] : [])])
      for (const by of ['', ', by T_bed', ', by T1 - T2'])
        for (const size of ['', ' −12.5 ± 0.3 µm', ...(/carriage|table|head/.test(part) ? [' 1.5 ± 0.3 µm, period 10.0 ± 0.1 mm'] : [])]) {
          const name = `${part}: ${what}${where}${by}${size}`;
          assert.equal(kEnglish.exec(t(name)), null, `${name}: ${t(name)}`);
          assert.ok(!what.includes(' ') || !t(name).includes(what), `${name}: ${t(name)}`);
          ++names;
        }
}
for (const id of ids)
  for (const label of [`${id} of X in X of workpiece transform 2`, `${id} in rY of workpiece transform 12`])
    assert.ok(/^In der Kette: .*Werkstücktransformation \d+$/.test(t(`In the chain: ${label}`)), t(`In the chain: ${label}`));
console.log(`translate_test: ${Object.keys(german).length} texts, ${names} names of effects`);

#!/usr/bin/env node
// SPDX-License-Identifier: GPL-3.0-or-later
// translate_test.mjs: sentences of diagnose, improve and fit in German, and a pattern that stays in its sentence.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';

globalThis.document = { documentElement: {} };
const { t, useCatalogue } = await import('../../../tools/report/web/src/translate.js');
useCatalogue(JSON.parse(readFileSync(new URL('../../../tools/report/languages/de.json', import.meta.url), 'utf8')));

const german = {
  'Missing: X carriage: backlash, reversal value B −8.0 ± 0.3 µm': 'Es fehlt: X-Schlitten: Umkehrspiel, Umkehrspanne B −8,0 ± 0,3 µm',
  'X carriage: thermal growth, by T_bed −11.6 ± 0.4 µm/(m °C)': 'X-Schlitten: Wärmedehnung, durch T_bed −11,6 ± 0,4 µm/(m °C)',
  'Possibly the survey was disturbed: a drift of 273 µm. A missing effect (such as a backlash) can look like this disturbance: vernier diagnose compares the causes.':
    'Möglicherweise war die Messung gestört: eine Drift von 273 µm. Ein fehlender Effekt (etwa ein Umkehrspiel) kann wie diese Störung aussehen: vernier diagnose vergleicht die Ursachen.',
  'X carriage: backlash, reversal value B 8.0 ± 0.3 µm. The BIC of the next best cause, Y carriage: drift of the base or the instrument along X, is higher by 54. Beside it: Y carriage: backlash. With 2 effects the rms of the check rows (held-out rows) changes from 4.966 to 4.857 µm.':
    'X-Schlitten: Umkehrspiel, Umkehrspanne B 8,0 ± 0,3 µm. Das BIC der nächstbesten Ursache, Y-Schlitten: Drift der Grundlage oder des Messgeräts entlang X, ist um 54 höher. Außerdem: Y-Schlitten: Umkehrspiel. Mit 2 Effekten ändert sich der Effektivwert der Prüfzeilen von 4,966 auf 4,857 µm.',
};
for (const [english, translation] of Object.entries(german)) assert.equal(t(english), translation);
console.log(`translate_test: ${Object.keys(german).length} texts`);

#!/usr/bin/env node
// SPDX-License-Identifier: GPL-3.0-or-later
// legend_test.mjs: curves of one colour and different styles (mean, mean +- 2 s, runs) have different swatches.
import assert from 'node:assert/strict';
import { legendEntries } from '../../../tools/report/web/src/legend.js';

const of = (name, style) => ({ name, colour: 0, ...(style ? { style } : {}) });
const entries = legendEntries({
  y: [of('mean'), of('mean ± 2 s', 'dashed'), of('mean ± 2 s', 'dashed'), of('runs', 'points'), of('runs', 'points')],
});
assert.deepEqual(
  entries.map((one) => one.name),
  ['mean', 'mean ± 2 s', 'runs'],
);
assert.equal(new Set(entries.map((one) => one.icon)).size, 3);
console.log('legend_test: three swatches');

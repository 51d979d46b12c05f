// SPDX-License-Identifier: GPL-3.0-or-later
// A reflector on the tool at a place that nobody measured: a part of the set-up, no error of the machine.
import { freeName, run } from './api.js';
import { store } from './store.js';

export const kReflector = 'A reflector is on the flange at a place that nobody measured';

/** A machine's name without what earlier steps have put behind it: model-added-2-fitted.xml is of model. */
export const stemOf = (machine) => machine.replace(/(-(added|set)(-\d+)?)?(-fitted(-\d+)?)?\.xml$/i, '');

/**
 * Points are measured, the machine file has no place of a reflector, and an axis turns: with linear axes alone the place is a
 * part of the zero of the points.
 */
export const needsReflector = () =>
  store.rows?.columns.some((one) => one.kind === 'axis' && one.unit === 'deg') &&
  ['x', 'y', 'z'].every((kind) => store.rows?.kinds.some((one) => one.kind === kind)) &&
  store.parameters.length > 0 &&
  !store.parameters.some((one) => one.name.startsWith('ToolShift'));

/** A new machine file of the chosen machine whose fit estimates the place; returns its name. */
export async function declareReflector() {
  const output = freeName(`${stemOf(store.machine)}-set`, '.xml');
  await run({ command: 'set', machine: store.machine, reflector: true, output });
  return output;
}

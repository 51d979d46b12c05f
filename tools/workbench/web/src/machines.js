// SPDX-License-Identifier: GPL-3.0-or-later
import { el } from '../../../report/web/src/dom.js';
import { option } from './options.js';

/**
 * The usual kinds of machines: [type, what carries what, axes to begin with, picture]. A picture is made of boxes [x, y, w, h],
 * moving ones marked m, circles [x, y, r] and lines [x0, y0, x1, y1 ...] on a field of 100 by 70.
 */
const kBed = { box: [8, 60, 84, 5] };
const kBridge = [kBed, { box: [16, 22, 5, 38], m: 1 }, { box: [79, 22, 5, 38], m: 1 }, { box: [14, 18, 72, 6], m: 1 }];
const kRam = [
  { box: [44, 15, 13, 13], m: 1 },
  { box: [48, 28, 5, 14], m: 1 },
];
const kColumn = [
  { box: [72, 8, 12, 52] },
  { box: [44, 14, 28, 12], m: 1 },
  { box: [49, 26, 6, 10], m: 1 },
  { box: [22, 50, 44, 5], m: 1 },
  { box: [30, 55, 28, 5] },
  kBed,
];
export const kTypes = [
  ['gantry', 'Gantry, router: the beam goes along Y, the bed stands', 'X:0:600 Y:0:400 Z:-150:0', [...kBridge, ...kRam]],
  [
    'bridge',
    'Bridge: as a gantry, usually a measuring machine',
    'X:0:600 Y:0:800 Z:-400:0',
    [...kBridge, ...kRam, { circle: [50.5, 45, 2] }],
  ],
  ['column', 'Knee mill: table along X and Y, head along Z', 'X:0:500 Y:0:300 Z:-300:0', kColumn],
  ['c-frame', 'C frame: table along X and Y, spindle along Z', 'X:0:500 Y:0:300 Z:-300:0', [...kColumn, { box: [44, 4, 40, 6] }]],
  [
    'head-head',
    'Five axes, both turning ones in the head',
    'X:0:2000 Y:0:1000 Z:-500:0 C:-180:180 A:-100:100',
    [...kBridge, ...kRam, { circle: [50.5, 46, 5] }, { line: [50.5, 46, 58, 56] }],
  ],
  [
    'head-table',
    'Five axes, one in the head, one under the part',
    'X:0:800 Y:0:600 Z:-500:0 B:-100:100 C:0:360:wrap',
    [...kBridge, ...kRam, { circle: [50.5, 45, 4] }, { box: [34, 55, 32, 5], m: 1 }],
  ],
  [
    'table-table',
    'Five axes, both under the part',
    'X:0:600 Y:0:500 Z:-450:0 A:-100:30 C:0:360:wrap',
    [
      kBed,
      { box: [72, 8, 12, 52] },
      ...kColumn.slice(1, 3),
      { circle: [28, 50, 4] },
      { circle: [62, 50, 4] },
      { line: [28, 50, 28, 56, 62, 56, 62, 50] },
    ],
  ],
  [
    'arm',
    'Horizontal arm along Y on a column',
    'X:0:4000 Y:-1500:0 Z:0:2000',
    [kBed, { box: [18, 8, 8, 52], m: 1 }, { box: [26, 24, 52, 6], m: 1 }, { circle: [80, 27, 2] }],
  ],
  [
    'robot',
    'Robot with six joints (lengths of a UR10e; for yours drop its description, .urdf)',
    '',
    [
      kBed,
      { box: [24, 48, 16, 12] },
      { line: [32, 48, 26, 22, 60, 14, 78, 30] },
      { circle: [32, 48, 3] },
      { circle: [26, 22, 3] },
      { circle: [60, 14, 3] },
      { circle: [78, 30, 2] },
    ],
  ],
];

const kSvg = 'http://www.w3.org/2000/svg';
function shape(name, attributes) {
  const node = document.createElementNS(kSvg, name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  return node;
}

function picture(parts) {
  const svg = shape('svg', { viewBox: '0 0 100 70', class: 'machine', 'aria-hidden': 'true' });
  for (const { box, circle, line, m } of parts) {
    if (box) svg.append(shape('rect', { x: box[0], y: box[1], width: box[2], height: box[3], class: m ? 'moves' : '' }));
    if (circle) svg.append(shape('circle', { cx: circle[0], cy: circle[1], r: circle[2], class: 'moves' }));
    if (line) svg.append(shape('polyline', { points: line.join(' ') }));
  }
  return svg;
}

/** A choice among the machines by their pictures; calls back with [type, axes]. */
export function machineChoice(chosen, change) {
  // A type without a picture is offered too: the program knows how to make it.
  const types = option('new', 'type').words.map((name) => kTypes.find(([type]) => type === name) ?? [name, name, '', []]);
  return el(
    'div',
    { class: 'machines', role: 'radiogroup', 'aria-label': 'type of machine' },
    types.map(([type, words, axes, parts]) => {
      const input = el('input', { type: 'radio', name: 'machine-type', value: type, checked: type === chosen ? '' : null });
      input.addEventListener('change', () => change(type, axes));
      return el('label', { class: 'machine-type', title: words }, input, picture(parts), el('span', {}, words));
    }),
  );
}

// SPDX-License-Identifier: GPL-3.0-or-later
import { colours } from './chart.js';
import { choice, el } from './dom.js';
import { number } from './data.js';

// Dark to light through green, readable on light and dark paper alike.
export const kStops = [
  [59, 82, 139],
  [33, 145, 140],
  [94, 201, 98],
  [243, 176, 26],
  [220, 68, 44],
];

function shade(share) {
  const at = Math.min(0.9999, Math.max(0, share)) * (kStops.length - 1);
  const i = Math.floor(at);
  const mix = (k) => Math.round(kStops[i][k] + (at - i) * (kStops[i + 1][k] - kStops[i][k]));
  return `rgb(${mix(0)},${mix(1)},${mix(2)})`;
}

/** Middle and half diagonal of the points. */
function frame(points) {
  const low = [0, 1, 2].map((k) => Math.min(...points.map((p) => p[k])));
  const high = [0, 1, 2].map((k) => Math.max(...points.map((p) => p[k])));
  return { low, high, middle: low.map((v, k) => (v + high[k]) / 2), reach: Math.hypot(...low.map((v, k) => high[k] - v)) / 2 || 1 };
}

/** Index of a node along one of the swept axes; the first axis runs fastest. */
function layerOf(field, node, axis) {
  let index = node;
  for (let k = 0; k < axis; ++k) index = Math.floor(index / field.counts[k]);
  return index % field.counts[axis];
}

/** The edges of the box. */
function drawBox(pen, project, box, c) {
  const corner = (bits) => [0, 1, 2].map((k) => ((bits >> k) & 1 ? box.high[k] : box.low[k]));
  pen.strokeStyle = c.soft;
  pen.lineWidth = 0.6;
  for (let bits = 0; bits < 8; ++bits) {
    for (let k = 0; k < 3; ++k) {
      if ((bits >> k) & 1) continue;
      const a = project(corner(bits));
      const b = project(corner(bits | (1 << k)));
      pen.beginPath();
      pen.moveTo(a[0], a[1]);
      pen.lineTo(b[0], b[1]);
      pen.stroke();
    }
  }
}

/** Names and ends of the axes, after the arrows and on paper of their own: arrows must not cross them. */
function drawLabels(pen, project, box, c) {
  pen.fillStyle = c.ink;
  pen.strokeStyle = c.panel;
  pen.lineWidth = 4;
  pen.lineJoin = 'round';
  pen.font = '13px system-ui, sans-serif';
  ['x', 'y', 'z'].forEach((name, k) => {
    if (box.high[k] === box.low[k]) return;
    const end = box.low.slice();
    end[k] = box.high[k] + 0.09 * box.reach;
    const at = project(end);
    const label = [`${name} ${number(box.high[k], 5)} mm`, at[0] - 10, at[1] + 4];
    pen.strokeText(...label);
    pen.fillText(...label);
  });
}

function drawArrow(pen, from, to, colour) {
  const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
  pen.strokeStyle = pen.fillStyle = colour;
  pen.lineWidth = 1.6;
  pen.beginPath();
  pen.arc(from[0], from[1], 1.7, 0, 2 * Math.PI);
  pen.fill();
  if (length < 1) return;
  const [ux, uy] = [(to[0] - from[0]) / length, (to[1] - from[1]) / length];
  const head = Math.min(7, 0.45 * length);
  pen.beginPath();
  pen.moveTo(from[0], from[1]);
  pen.lineTo(to[0], to[1]);
  pen.moveTo(to[0] - head * (ux + 0.5 * uy), to[1] - head * (uy - 0.5 * ux));
  pen.lineTo(to[0], to[1]);
  pen.lineTo(to[0] - head * (ux - 0.5 * uy), to[1] - head * (uy + 0.5 * ux));
  pen.stroke();
}

/** A ring of one standard uncertainty: what the arrow's end may be off. */
function drawRing(pen, at, radius, colour) {
  pen.strokeStyle = colour;
  pen.lineWidth = 0.8;
  pen.setLineDash([2, 2]);
  pen.beginPath();
  pen.arc(at[0], at[1], radius, 0, 2 * Math.PI);
  pen.stroke();
  pen.setLineDash([]);
}

/** A patch of the working volume in the colour of its deviation. */
function drawPatch(pen, at, size, colour) {
  pen.fillStyle = colour;
  pen.beginPath();
  pen.arc(at[0], at[1], size, 0, 2 * Math.PI);
  pen.fill();
}

/** The vectors of a field, turned by hand: {axes, counts, point_mm[][3], deviation_um[][3], max_um}, std_um[] where a
 * fit said how well it knows them. Where that is no better than half the deviation, the arrow is grey and ringed.
 * after_um[][3]: what a correction leaves, drawn at the same scale. */
export function volume(field) {
  const box = frame(field.point_mm);
  const view = { turn: -0.62, tilt: 0.42, zoom: 1, gain: 1, layer: 'all', only: 'all', as: 'arrows', model: 'before' };
  const canvas = el('canvas', {
    tabindex: '0',
    role: 'img',
    style: 'width:100%;touch-action:none;cursor:grab;display:block',
    'aria-label': `Deviation vectors at ${field.point_mm.length} points, at most ${number(field.max_um, 4)} µm`,
  });
  const size = { width: 0, height: 0 };
  const project = ([x, y, z]) => {
    const [dx, dy, dz] = [x - box.middle[0], y - box.middle[1], z - box.middle[2]];
    const [right, away] = [Math.cos(view.turn) * dx - Math.sin(view.turn) * dy, Math.sin(view.turn) * dx + Math.cos(view.turn) * dy];
    const up = Math.cos(view.tilt) * dz + Math.sin(view.tilt) * away;
    const scale = (view.zoom * 0.43 * Math.min(size.width, 1.35 * size.height)) / box.reach;
    return [size.width / 2 + scale * right, size.height / 2 - scale * up, Math.cos(view.tilt) * away - Math.sin(view.tilt) * dz];
  };
  /** Half of the distance between neighbours, so that the patches of a layer touch. */
  const patchSize = () => {
    const most = Math.max(2, ...field.counts);
    const scale = (view.zoom * 0.43 * Math.min(size.width, 1.35 * size.height)) / box.reach;
    return Math.max(3, (0.5 * scale * Math.max(...box.high.map((v, k) => v - box.low[k]))) / (most - 1));
  };
  const shown = () => {
    const all = field.point_mm.map((_, i) => i);
    if (view.layer === 'all') return all;
    const [axis, layer] = view.layer.split(':').map(Number);
    return all.filter((i) => layerOf(field, i, axis) === layer);
  };
  function draw() {
    const c = colours();
    const ratio = devicePixelRatio || 1;
    size.width = canvas.clientWidth || 900;
    size.height = Math.max(320, Math.min(620, 0.6 * size.width));
    canvas.style.height = `${size.height}px`;
    canvas.width = Math.round(size.width * ratio);
    canvas.height = Math.round(size.height * ratio);
    const pen = canvas.getContext('2d');
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, size.width, size.height);
    drawBox(pen, project, box, c);
    const longest = field.max_um > 0 ? (view.gain * 0.16 * box.reach) / field.max_um : 0;
    const keep = (v) => (view.only === 'all' ? v : v.map((one, k) => (k === Number(view.only) ? one : 0)));
    const nodes = shown().map((i) => ({
      from: project(field.point_mm[i]),
      point: field.point_mm[i],
      v: keep((view.model === 'after' ? field.after_um : field.deviation_um)[i]),
      std: view.model === 'after' ? 0 : (field.std_um?.[i] ?? 0),
    }));
    const patch = patchSize();
    nodes.sort((a, b) => b.from[2] - a.from[2]);
    for (const { from, point, v, std } of nodes) {
      const to = project(point.map((one, k) => one + longest * v[k]));
      const known = std <= 0.5 * Math.hypot(...v);
      if (view.as === 'colours') {
        drawPatch(pen, from, patch, shade(field.max_um > 0 ? Math.hypot(...v) / field.max_um : 0));
        continue;
      }
      drawArrow(pen, from, to, known ? shade(field.max_um > 0 ? Math.hypot(...v) / field.max_um : 0) : c.soft);
      if (!known) {
        const edge = project(point.map((one, k) => one + longest * (v[k] + (k === 0 ? std : 0))));
        drawRing(pen, to, Math.hypot(edge[0] - to[0], edge[1] - to[1]), c.soft);
      }
    }
    drawLabels(pen, project, box, c);
  }
  function turn(dx, dy) {
    view.turn += 0.008 * dx;
    view.tilt = Math.max(-1.57, Math.min(1.57, view.tilt + 0.008 * dy));
    draw();
  }
  let held = null;
  canvas.addEventListener('pointerdown', (event) => {
    held = [event.clientX, event.clientY];
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener('pointermove', (event) => {
    if (held === null) return;
    turn(event.clientX - held[0], event.clientY - held[1]);
    held = [event.clientX, event.clientY];
  });
  canvas.addEventListener('pointerup', () => {
    held = null;
  });
  canvas.addEventListener('pointercancel', () => {
    held = null;
  });
  canvas.addEventListener('keydown', (event) => {
    const step = { ArrowLeft: [-12, 0], ArrowRight: [12, 0], ArrowUp: [0, -12], ArrowDown: [0, 12] }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    turn(...step);
  });
  const layers = [['all', 'whole volume']];
  field.axes.forEach((name, k) => {
    for (let i = 0; field.axes.length > 1 && i < field.counts[k]; ++i)
      layers.push([`${k}:${i}`, `${name}: layer ${i + 1} of ${field.counts[k]}`]);
  });
  const set = (key) => (value) => {
    view[key] = value;
    draw();
  };
  const steps = (list) => list.map((one) => [String(one), `× ${one}`]);
  const legend = el(
    'div',
    { class: 'key' },
    '0',
    el('span', {
      style: `width:140px;height:10px;border-radius:3px;background:linear-gradient(90deg,${kStops
        .map((_, i) => shade(i / (kStops.length - 1)))
        .join(',')})`,
    }),
    `${number(field.max_um, 4)} µm`,
    field.std_um ? el('span', {}, `grey, ringed: not known to half of itself (worst ${number(field.max_std_um, 3)} µm)`) : null,
  );
  const controls = el(
    'div',
    { class: 'controls' },
    field.after_um
      ? choice(
          'error',
          [
            ['before', 'without correction'],
            ['after', 'with correction'],
          ],
          'before',
          set('model'),
        )
      : null,
    choice(
      'as',
      [
        ['arrows', 'arrows'],
        ['colours', 'colours'],
      ],
      'arrows',
      set('as'),
    ),
    choice('show', layers, 'all', set('layer')),
    choice(
      'component',
      [
        ['all', 'all'],
        ['0', 'x'],
        ['1', 'y'],
        ['2', 'z'],
      ],
      'all',
      set('only'),
    ),
    choice('arrows', steps([0.5, 1, 2, 4, 8]), '1', (value) => set('gain')(Number(value))),
    choice('zoom', steps([0.75, 1, 1.5, 2, 3]), '1', (value) => set('zoom')(Number(value))),
    legend,
  );
  new ResizeObserver(draw).observe(canvas.parentElement ?? document.documentElement);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', draw);
  requestAnimationFrame(draw);
  return el('figure', {}, controls, canvas);
}

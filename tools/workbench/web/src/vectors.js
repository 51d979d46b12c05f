// SPDX-License-Identifier: GPL-3.0-or-later
import { el, choice } from '../../../report/web/src/dom.js';
import { number } from '../../../report/web/src/data.js';
import { kStops } from '../../../report/web/src/volume.js';
import { Plot, redrawAll } from './plot.js';
import { kNone } from './scatter.js';
import { selection, store } from './store.js';
import { twinOf } from './overlay.js';

const kShades = 32;
const kBoth = [
  [44, 103, 201],
  [140, 160, 190],
  [170, 170, 170],
  [214, 150, 110],
  [214, 90, 30],
];

function ramp(stops) {
  return Array.from({ length: kShades }, (_, i) => {
    const at = Math.min(stops.length - 1.0001, (i / (kShades - 1)) * (stops.length - 1)),
      k = Math.floor(at);
    return `rgb(${[0, 1, 2].map((j) => Math.round(stops[k][j] + (at - k) * (stops[k + 1][j] - stops[k][j]))).join(',')})`;
  });
}
const kMagnitude = ramp(kStops),
  kSigned = ramp(kBoth);

function bounds(point) {
  const low = [],
    high = [];
  for (const list of point) {
    let [a, b] = [Infinity, -Infinity];
    for (const value of list) {
      if (value < a) a = value;
      if (value > b) b = value;
    }
    low.push(a);
    high.push(b);
  }
  return { low, high, middle: low.map((v, k) => (v + high[k]) / 2), reach: Math.hypot(...low.map((v, k) => high[k] - v)) / 2 || 1 };
}

/** 99th percentile: one outlier does not shrink all the others. */
function typical(size) {
  const sorted = Float32Array.from(size).sort();
  return sorted[Math.floor(0.99 * (sorted.length - 1))] || 1;
}

/** Residual vectors where the tool was: rotate by dragging or with the arrow keys, zoom with + and -. */
export function vectorPlot(height, label = 'Residual vectors in the working volume') {
  const view = { turn: -0.6, tilt: 0.45, zoom: 1, gain: 1, colour: 'size' };
  let kept = null,
    step = 1,
    calm = null;
  const prepare = () => {
    // With an overlay: the residual of the fitted model, which it explains a part of.
    const rows = store.overlay ? twinOf(store.overlay, 'before') : store.rows;
    if (kept?.rows !== rows || kept.residual !== rows.observations.residual) {
      const n = rows.n_rows;
      kept = {
        rows,
        residual: rows.observations.residual,
        box: bounds(rows.point),
        typical: typical(rows.size),
        ax: new Float32Array(n),
        ay: new Float32Array(n),
        bx: new Float32Array(n),
        by: new Float32Array(n),
        colour: new Uint8Array(n),
      };
    }
    return kept;
  };
  const camera = (pen, box) => {
    const scale = (0.62 * Math.min(pen.width, pen.height) * view.zoom) / box.reach;
    const [cos, sin, up, down] = [Math.cos(view.turn), Math.sin(view.turn), Math.cos(view.tilt), Math.sin(view.tilt)];
    // Right and up on the screen as linear functions of x, y, z.
    return {
      right: [cos * scale, -sin * scale, 0],
      up: [down * sin * scale, down * cos * scale, up * scale],
      cx: pen.width / 2,
      cy: pen.height / 2,
    };
  };
  const strokesOf = (k, cam, v, length) => {
    const { middle } = k.box,
      [X, Y, Z] = k.rows.point;
    for (let i = 0; i < X.length; i += step) {
      const [x, y, z] = [X[i] - middle[0], Y[i] - middle[1], Z[i] - middle[2]];
      k.ax[i] = cam.cx + cam.right[0] * x + cam.right[1] * y;
      k.ay[i] = cam.cy - (cam.up[0] * x + cam.up[1] * y + cam.up[2] * z);
      k.bx[i] = k.ax[i] + length * (cam.right[0] * v[0][i] + cam.right[1] * v[1][i]);
      k.by[i] = k.ay[i] - length * (cam.up[0] * v[0][i] + cam.up[1] * v[1][i] + cam.up[2] * v[2][i]);
    }
  };
  const shadesOf = (k, v, size) => {
    const part = { x: 0, y: 1, z: 2 }[view.colour];
    for (let i = 0; i < k.colour.length; ++i) {
      const share = part === undefined ? size[i] / k.typical : 0.5 + (0.5 * v[part][i]) / k.typical;
      k.colour[i] = Math.max(0, Math.min(kShades - 1, Math.floor(share * kShades)));
    }
  };
  const drawBox = (pen, cam, box, c) => {
    const corner = (k) => [0, 1, 2].map((j) => ((k >> j) & 1 ? box.high : box.low)[j] - box.middle[j]);
    const place = (p) => [
      cam.cx + cam.right[0] * p[0] + cam.right[1] * p[1],
      cam.cy - (cam.up[0] * p[0] + cam.up[1] * p[1] + cam.up[2] * p[2]),
    ];
    for (let a = 0; a < 8; ++a)
      for (let j = 0; j < 3; ++j) if (!((a >> j) & 1)) pen.line([...place(corner(a)), ...place(corner(a | (1 << j)))], c.line, 1);
    const most = Math.max(...[0, 1, 2].map((j) => box.high[j] - box.low[j]));
    ['x', 'y', 'z'].forEach((name, j) => {
      // A direction without extent has its corner on that of the others, and its text would lie over theirs.
      if (!(box.high[j] - box.low[j] > 1e-3 * most)) return;
      const [x, y] = place(corner(1 << j));
      pen.text(x, y - 8, `${name} ${number(box.high[j], 4)} mm`, { colour: c.soft, align: 'center' });
    });
  };
  const plot = new Plot(label, {
    height,
    name: 'residual_vectors',
    paint(pen, c) {
      if (!store.rows?.n_rows) return;
      const k = prepare();
      const cam = camera(pen, k.box);
      drawBox(pen, cam, k.box, c);
      const area = { x: 0, y: 0, w: pen.width, h: pen.height };
      const length = (view.gain * 0.12 * k.box.reach) / k.typical;
      const v = k.rows.vector;
      strokesOf(k, cam, v, length);
      shadesOf(k, v, k.rows.size);
      if (selection.count) for (let i = 0; i < k.colour.length; ++i) if (!selection.rows[i]) k.colour[i] = kNone;
      const dimmed = selection.count ? k.colour.map((shade) => (shade === kNone ? 0 : kNone)) : null;
      if (dimmed) pen.strokes(area, k.ax, k.ay, k.bx, k.by, dimmed, [c.line], step);
      pen.strokes(area, k.ax, k.ay, k.bx, k.by, k.colour, view.colour === 'size' ? kMagnitude : kSigned, step);
      if (store.overlay) {
        strokesOf(k, cam, twinOf(store.overlay, 'explained').vector, length);
        pen.strokes(area, k.ax, k.ay, k.bx, k.by, k.colour.fill(0), [c.ccw], step);
      }
      pen.text(
        8,
        pen.height - 12,
        `colours to ${number(k.typical, 3)} µm${store.overlay ? ', laid over: what the candidate would explain' : ''}`,
        { colour: c.soft },
      );
    },
  });
  const turn = (dx, dy) => {
    view.turn += 0.008 * dx;
    view.tilt = Math.max(-1.57, Math.min(1.57, view.tilt + 0.008 * dy));
    // While it turns some of very many are enough; all of them when it comes to rest.
    step = Math.max(1, Math.floor((store.rows?.n_rows ?? 0) / 20000));
    plot.draw();
    step = 1;
    clearTimeout(calm);
    if ((store.rows?.n_rows ?? 0) > 20000) calm = setTimeout(() => plot.draw(), 150);
  };
  let held = null;
  plot.canvas.addEventListener('pointerdown', (event) => {
    held = [event.clientX, event.clientY];
    plot.canvas.setPointerCapture(event.pointerId);
  });
  plot.canvas.addEventListener('pointermove', (event) => {
    if (held === null) return;
    turn(event.clientX - held[0], event.clientY - held[1]);
    held = [event.clientX, event.clientY];
  });
  for (const end of ['pointerup', 'pointercancel'])
    plot.canvas.addEventListener(end, () => {
      held = null;
    });
  plot.canvas.addEventListener('keydown', (event) => {
    const act = {
      ArrowLeft: () => turn(-12, 0),
      ArrowRight: () => turn(12, 0),
      ArrowUp: () => turn(0, -12),
      ArrowDown: () => turn(0, 12),
      '+': () => {
        view.zoom *= 1.15;
        plot.draw();
      },
      '-': () => {
        view.zoom /= 1.15;
        plot.draw();
      },
    }[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  });
  const set = (key) => (value) => {
    view[key] = key === 'colour' ? value : Number(value);
    redrawAll();
  };
  const steps = [0.25, 0.5, 1, 2, 4, 8].map((one) => [String(one), `× ${one}`]);
  plot.element.prepend(
    el(
      'div',
      { class: 'controls' },
      choice(
        'colour',
        [
          ['size', 'magnitude'],
          ['x', 'x'],
          ['y', 'y'],
          ['z', 'z'],
        ],
        'size',
        set('colour'),
      ),
      choice('arrows', steps, '1', set('gain')),
      choice('zoom', steps, '1', set('zoom')),
    ),
  );
  return plot;
}

// SPDX-License-Identifier: GPL-3.0-or-later
import { polarPlot as shown } from '../../../report/web/src/polar.js';
import { dragged } from './drag.js';
import { select, selection, store } from './store.js';

const series = (type, colour, data) => ({
  type,
  coordinateSystem: 'polar',
  silent: true,
  showSymbol: false,
  z: 8,
  data,
  color: colour,
  symbolSize: 3,
});
const turned = (deg) => ((deg % 360) + 360) % 360;

/** The ball-bar plot of the reports; drag across a sector: choose its rows. */
export function polarPlot(circle) {
  let rays = [];
  const figure = shown(circle, (least, c) => {
    const chosen = selection.count
      ? circle.runs.flatMap((run) =>
          Array.from(run.row).flatMap((row, i) => (selection.rows[row] ? [[Math.max(run.measured_um[i], least), run.angle_deg[i]]] : [])),
        )
      : [];
    return [
      series('scatter', c.accent2, chosen),
      ...rays.map((deg) =>
        series('line', c.accent2, [
          [least, deg],
          [0, deg],
        ]),
      ),
    ];
  });
  const { plot } = figure;
  dragged(
    plot,
    (event) => plot.valueAt(event, 'polarIndex')?.[1] ?? null,
    (from, to) => {
      rays = from === null ? [] : [from, to];
      plot.redraw();
    },
    (from, to) => {
      // The shorter way round between the two rays.
      const [first, wide] = turned(to - from) > 180 ? [to, turned(from - to)] : [from, turned(to - from)];
      const rows = new Uint8Array(store.rows.n_rows);
      if (wide > 0.5)
        for (const run of circle.runs)
          run.row.forEach((row, i) => {
            if (turned(run.angle_deg[i] - first) <= wide) rows[row] = 1;
          });
      select(rows);
    },
  );
  return figure;
}

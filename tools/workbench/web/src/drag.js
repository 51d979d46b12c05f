// SPDX-License-Identifier: GPL-3.0-or-later

/**
 * Drags on a chart of the plotting library: `at(event)` is the value under the pointer or null, `show(from, to)` is called
 * while it moves (null, null: no more), `done(from, to)` at the end.
 */
export function dragged(chart, at, show, done) {
  let from = null;
  chart.addEventListener('pointerdown', (event) => {
    if (event.button !== 0 || event.target.closest('button')) return;
    from = at(event);
    if (from !== null) chart.setPointerCapture(event.pointerId);
  });
  chart.addEventListener('pointermove', (event) => {
    if (from !== null) show(from, at(event));
  });
  chart.addEventListener('pointerup', (event) => {
    if (from === null) return;
    const start = from;
    from = null;
    show(null, null);
    done(start, at(event));
  });
  chart.addEventListener('pointercancel', () => {
    from = null;
    show(null, null);
  });
}

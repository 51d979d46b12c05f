// SPDX-License-Identifier: GPL-3.0-or-later

/** The entries of a legend: curves of one colour differ in their style, and so do their swatches. */
export function legendEntries(plotted) {
  const icon = { dashed: 'path://M0,2h5v2h-5zM6.5,2h5v2h-5zM13,2h5v2h-5z', points: 'circle' };
  const icons = new Map(plotted.y.map((one) => [one.name, icon[one.style] ?? 'roundRect']));
  return Array.from(icons, ([name, shape]) => ({ name, icon: shape }));
}

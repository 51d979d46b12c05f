#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of README: the residual of a bridge machine before and after `improve`.

  tools/docs/img/before_after.py build/release/bin/vernier > tools/docs/img/before_after.svg

The machine and its survey are those of tools/docs/tutorial.md. A test compares the picture of the repository with the
picture that this script makes.
"""

import csv
import json
import subprocess
import sys
import tempfile
from pathlib import Path

SURVEY = Path(__file__).resolve().parents[3] / "tests/data/hidden/bridge_lag_cyclic/survey.csv"
TRAVELS = ("--axis", "X:0:600", "--axis", "Y:0:400", "--axis", "Z:-300:0")
WIDTH, HEIGHT, TOP = 190, 215, 65  # of one panel, in pixels
LARGEST_um = 15  # a larger residual is drawn at the edge
COLOURS = {"fit": "#2468c9", "check": "#d9731a"}


def run(*arguments):
    subprocess.run([str(a) for a in arguments], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def residuals(vernier, machine, folder):
    """The rms of the check rows in um, and for each observation (row, name, residual in um, role)."""
    table, result = folder / "residuals.csv", folder / "compare.json"
    run(vernier, "compare", machine, SURVEY, "--residuals", table, "--json", result)
    with table.open(encoding="utf-8") as file:
        rows = [(int(r["row"]), r["observation"], 1e3 * float(r["residual"]), r["role"]) for r in csv.DictReader(file)]
    return json.loads(result.read_text(encoding="utf-8"))["check_rms_um"], rows


def panel(left, title, axis, positions, rows, observation):
    """One plot of a residual against a column of the survey."""
    low, high = min(positions), max(positions)
    middle, right = TOP + HEIGHT / 2, left + WIDTH
    per_um = HEIGHT / 2 / LARGEST_um
    lines = [f'<rect x="{left}" y="{TOP}" width="{WIDTH}" height="{HEIGHT}" fill="#ffffff" stroke="#c9d0d9"/>']
    for level in (-10, 0, 10):
        y = middle - per_um * level
        colour = "#8a94a3" if level == 0 else "#e6e9ee"
        lines.append(f'<line x1="{left}" x2="{right}" y1="{y:.1f}" y2="{y:.1f}" stroke="{colour}"/>')
        lines.append(f'<text x="{left - 6}" y="{y + 4:.1f}" text-anchor="end">{level}</text>')
    for row, name, residual_um, role in rows:
        if name != observation:
            continue
        x = left + 4 + (WIDTH - 8) * (positions[row - 1] - low) / (high - low)
        y = middle - per_um * max(-LARGEST_um, min(LARGEST_um, residual_um))
        lines.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.4" fill="{COLOURS[role]}"/>')
    centre = left + WIDTH / 2
    lines.append(f'<text x="{centre}" y="57" text-anchor="middle" font-weight="600">{title}</text>')
    lines.append(f'<text x="{centre}" y="297" text-anchor="middle" fill="#5a6675">{axis}</text>')
    return lines


def main():
    vernier = Path(sys.argv[1]).resolve()
    with SURVEY.open(encoding="utf-8") as file:
        survey = list(csv.DictReader(file))
    x_mm = [float(row["X[mm]"]) for row in survey]
    speed_mm_s = [float(row["vZ[mm/s]"]) for row in survey]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run(vernier, "new", "bridge", *TRAVELS, "--tool", "20,-30,-120", "-o", folder / "machine.xml")
        run(vernier, "improve", folder / "machine.xml", SURVEY, "-o", folder / "better", "--yes")
        models = sorted((folder / "better").glob("*.xml"))
        before_um, before = residuals(vernier, models[0], folder)
        after_um, after = residuals(vernier, models[-1], folder)
    picture = [
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 940 330" font-family="system-ui, DejaVu Sans, sans-serif" '
        'font-size="13" fill="#1c2430">',
        "<!-- Made by tools/docs/img/before_after.py. -->",
        '<rect width="940" height="330" fill="#f6f7f9"/>',
        '<text x="20" y="24" font-size="15" font-weight="600">Residual of the model of a bridge machine, µm: '
        "fit rows blue, check rows (held out) orange</text>",
        *panel(50, "before: x", "X, mm", x_mm, before, "x"),
        *panel(270, "before: z", "speed of Z, mm/s", speed_mm_s, before, "z"),
        *panel(520, "after: x", "X, mm", x_mm, after, "x"),
        *panel(740, "after: z", "speed of Z, mm/s", speed_mm_s, after, "z"),
        '<text x="490" y="180" text-anchor="middle" font-size="26" fill="#2468c9">→</text>',
        f'<text x="255" y="318" text-anchor="middle">fitted geometry: check rows {before_um:.2f} µm rms</text>',
        '<text x="725" y="318" text-anchor="middle">+ cyclic error of X and lag of Z, found and added: '
        f"{after_um:.2f} µm rms</text>",
        "</svg>",
    ]
    sys.stdout.write("\n".join(picture) + "\n")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""make_square.py FOLDER: four balls of a square of unknown errors, touched in four orientations (README.md)."""
import math
import random
import sys

SQUARENESS_RAD, U_MM, DRAWING_MM = 60e-6, 0.0005, 0.03
BALLS = ((0, 0), (300, 0), (300, 300), (0, 300))


def main():
    rng = random.Random(3804)
    balls = [(x + rng.gauss(0, DRAWING_MM), y + rng.gauss(0, DRAWING_MM)) for x, y in BALLS]
    lines = ["X[mm],Y[mm],on,setup,u[um]"]
    for deg in (0, 90, 180, 270):
        turn = math.radians(deg + rng.gauss(0, 0.02))
        for _ in range(4):
            for i, (bx, by) in enumerate(balls):
                x = 250 + math.cos(turn) * (bx - 150) - math.sin(turn) * (by - 150)
                y = 250 + math.sin(turn) * (bx - 150) + math.cos(turn) * (by - 150)
                lines.append(f"{x + y * SQUARENESS_RAD + rng.gauss(0, U_MM):.5f},{y + rng.gauss(0, U_MM):.5f},"
                             f"P{i},at{deg},{1e3 * U_MM}")
    with open(f"{sys.argv[1]}/square.csv", "w", newline="\n") as out:
        out.write("\n".join(lines) + "\n")


main()

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""make.py FOLDER: the spreadsheets of a router's positioning test as a German Excel saves them (README.md)."""
import math
import random
import sys

TRAVEL = {"X": 1200.0, "Y": 800.0, "Z": 150.0}
SCALE = {"X": 55e-6, "Y": -30e-6, "Z": 20e-6}  # mm/mm
BACKLASH_MM = {"X": 0.024, "Y": 0.0, "Z": 0.0}  # forward mean less backward mean, with the sign reversed
NOISE_MM = 0.0012
REST = {"X": 600.0, "Y": 400.0, "Z": -75.0}


def targets(axis, rng):
    """Thirteen, their steps uneven by up to a quarter, as ISO 230-2 asks: a period of the screw is not hidden by them."""
    step = TRAVEL[axis] * 0.96 / 12
    low = 0.02 * TRAVEL[axis] - (TRAVEL[axis] if axis == "Z" else 0)
    return [round(low + i * step + rng.uniform(-0.25, 0.25) * step * (0 < i < 12), 2) for i in range(13)]


def german(value, digits):
    return f"{value:.{digits}f}".replace(".", ",")


def sheet(axis, rng):
    others = [name for name in TRAVEL if name != axis]
    lines = [
        f"Positioniergenauigkeit Portalfräse PF-1200, Achse {axis};;;;;;",
        "Laserinterferometer, Messunsicherheit 1 µm;;;;;;",
        ";;;;;;",
        f"Lauf;Richtung;{axis} soll;Abweichung {axis};{others[0]};{others[1]};Temp. Raum",
        ";;mm;µm;mm;mm;°C",
    ]
    points = targets(axis, rng)
    for run in (1, 2):
        for sense, order in (("+", points), ("-", points[::-1])):
            for at in order:
                error = SCALE[axis] * at + 0.004 * math.sin(2 * math.pi * at / (1.7 * TRAVEL[axis]))
                error += (-0.5 if sense == "+" else 0.5) * BACKLASH_MM[axis] + rng.gauss(0, NOISE_MM)
                warm = 21.2 + 0.1 * run + rng.uniform(-0.05, 0.05)
                cells = [f"{run}", sense, german(at, 2), german(1000 * error, 1), german(REST[others[0]], 0),
                         german(REST[others[1]], 0), german(warm, 1)]
                lines.append(";".join(cells))
    return "\r\n".join(lines) + "\r\n"


def main():
    rng = random.Random(2302)
    for axis in TRAVEL:
        with open(f"{sys.argv[1]}/Portal_{axis}.csv", "wb") as out:
            out.write(sheet(axis, rng).encode("cp1252"))


main()

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""make.py FOLDER: three surveys by touching (README.md). The kinematics are written here, not taken from Vernier."""
import math
import random
import sys

# UR10e: d and a in mm, alpha in deg; the flange carries a ball 150 mm out.
D = [180.7, 0.0, 0.0, 174.15, 119.85, 116.55]
A = [0.0, -612.7, -571.55, 0.0, 0.0, 0.0]
ALPHA = [90.0, 0.0, 0.0, 90.0, -90.0, 0.0]
TOOL_MM = 150.0
SOCKETS = {"A": (600.0, -200.0, 100.0), "B": (600.0, 100.0, 250.0), "C": (750.0, -50.0, 300.0)}
U_SOCKET_MM = 0.02

TWIST_DEG, SAG_MM, U_NOZZLE_MM = 0.08, -0.15, 0.01  # printer
BED = (0.3, -0.0015, 0.0008)  # height in mm, slopes along X and Y

SQUARENESS_DEG, SCALE_X, SCALE_Y = -0.0034, 40e-6, -25e-6  # mill: -59 urad
RING_MM, TIP_MM, U_TOUCH_MM = 50.0, 3.0, 0.0005
RING_AT = (210.0, 160.0)


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def rotation(axis, deg):
    c, s = math.cos(math.radians(deg)), math.sin(math.radians(deg))
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    m = [[float(r == k) for k in range(4)] for r in range(4)]
    m[i][i] = m[j][j] = c
    m[i][j], m[j][i] = -s, s
    return m


def move(x, z):
    return [[1, 0, 0, x], [0, 1, 0, 0], [0, 0, 1, z], [0, 0, 0, 1]]


class Robot:
    """The arm with errors of its joint zeros, lengths and twists, and of parallelism about y."""

    def __init__(self, rng):
        self.zero = [rng.gauss(0, 0.05) for _ in range(6)]
        self.d = [d + rng.gauss(0, 0.3) * (d != 0) for d in D]
        self.a = [a + rng.gauss(0, 0.3) * (i < 5) for i, a in enumerate(A)]
        self.alpha = [t + rng.gauss(0, 0.05) * (i < 5) for i, t in enumerate(ALPHA)]
        self.beta = [rng.gauss(0, 0.05) * (i in (1, 2)) for i in range(6)]

    def point(self, q):
        m = move(0, 0)
        for i in range(6):
            for step in (rotation(2, q[i] + self.zero[i]), move(self.a[i], self.d[i]),
                         rotation(0, self.alpha[i]), rotation(1, self.beta[i])):
                m = product(m, step)
        return [m[r][2] * TOOL_MM + m[r][3] for r in range(3)]

    def reach(self, q, goal):
        """Joint angles near q at which the ball is at the goal: Newton steps of least norm; None: not reached."""
        for _ in range(60):
            at = self.point(q)
            off = [g - p for g, p in zip(goal, at)]
            if max(map(abs, off)) < 1e-8:
                return q
            slope = []
            for i in range(6):
                moved = q[:i] + [q[i] + 1e-4] + q[i + 1:]
                slope.append([(b - a) / 1e-4 for a, b in zip(at, self.point(moved))])
            normal = [[sum(s[r] * s[c] for s in slope) for c in range(3)] for r in range(3)]
            weight = solve(normal, off)
            step = [sum(s[r] * weight[r] for r in range(3)) for s in slope]
            short = min(1.0, 30 / max(map(abs, step)))
            q = [a + short * b for a, b in zip(q, step)]
        return None


def solve(a, b):
    """Cramer's rule for three unknowns."""
    def det(m):
        return sum(m[0][i] * (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3])
                   for i in range(3))
    whole = det(a)
    return [det([[b[r] if c == k else a[r][c] for c in range(3)] for r in range(3)]) / whole for k in range(3)]


def sockets(rng):
    robot = Robot(rng)
    lines = ["J1[deg],J2[deg],J3[deg],J4[deg],J5[deg],J6[deg],same,distance[mm],from,role,u[mm]"]
    for label, count in (("A", 20), ("B", 20), ("C", 8)):
        done = 0
        while done < count:
            start = [rng.uniform(*limits) for limits in
                     ((-40, 40), (-110, -40), (40, 120), (-140, -20), (-130, -50), (-180, 180))]
            q = robot.reach(start, [c + rng.gauss(0, U_SOCKET_MM) for c in SOCKETS[label]])
            if q is None or max(map(abs, q)) > 360:
                continue
            first = label == "B" and done == 0
            length = f"{math.dist(SOCKETS['A'], SOCKETS['B']):.3f}" if first else ""
            lines.append(",".join([f"{a:.4f}" for a in q] +
                                  [label, length, "1" if first else "", "check" if label == "C" else "",
                                   f"{U_SOCKET_MM}"]))
            done += 1
    return lines


def bed(rng):
    lines = ["X[mm],Y[mm],Z[mm],on,u[mm]"]
    for _ in range(2):
        for y in (10, 60, 110, 160, 210):
            for x in (10, 60, 110, 160, 210):
                turn = math.radians(TWIST_DEG * (y - 110) / 220)
                sag = SAG_MM * (1 - ((x - 110) / 110) ** 2)
                # The nozzle is at x cos, z - x sin of the turn, and on the bed there.
                height = BED[0] + BED[1] * x * math.cos(turn) + BED[2] * y
                z = height + x * math.sin(turn) - sag + rng.gauss(0, U_NOZZLE_MM)
                lines.append(f"{x},{y},{z:.4f},bed,{U_NOZZLE_MM}")
    return lines


def ring(rng):
    lines = ["X[mm],Y[mm],Z[mm],on,u[um]"]
    for _ in range(3):
        for k in range(24):
            angle = 2 * math.pi * k / 24
            far = RING_MM - TIP_MM + rng.gauss(0, U_TOUCH_MM)
            x, y = RING_AT[0] + far * math.cos(angle), RING_AT[1] + far * math.sin(angle)
            # Axes: the tool is at X (1 + sx) - Y (1 + sy) c, Y (1 + sy).
            ay = y / (1 + SCALE_Y)
            ax = (x + y * math.radians(SQUARENESS_DEG)) / (1 + SCALE_X)
            lines.append(f"{ax:.5f},{ay:.5f},-120,ring,{1e3 * U_TOUCH_MM}")
    return lines


def main():
    for seed, name, make in ((3801, "sockets", sockets), (3802, "bed", bed), (3803, "ring", ring)):
        with open(f"{sys.argv[1]}/{name}.csv", "w", newline="\n") as out:
            out.write("\n".join(make(random.Random(seed))) + "\n")


main()

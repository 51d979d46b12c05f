#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""make.py FOLDER: poses of a board that a camera on a robot sees (README.md). The kinematics are written here,
not taken from Vernier."""
import math
import random
import sys

# UR10e: d and a in mm, alpha in deg; the tool point of the machine file is 150 mm out of the flange.
D = [180.7, 0.0, 0.0, 174.15, 119.85, 116.55]
A = [0.0, -612.7, -571.55, 0.0, 0.0, 0.0]
ALPHA = [90.0, 0.0, 0.0, 90.0, -90.0, 0.0]
TOOL_MM = 150.0
MOUNTING = (62.0, -18.0, -95.0, 4.0, -7.0, 91.0)  # camera in the frame of the tool: X Y Z rX rY rZ
MIDDLE = (20.0, -85.0, 85.0, -90.0, -85.0, 10.0)  # the camera looks at the board from half a metre
SPAN = (50.0, 30.0, 40.0, 60.0, 60.0, 120.0)
U_MM, U_RAD = 0.1, 0.2e-3
POSES, CHECKS = 40, 10


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def rotation(axis, deg):
    c, s = math.cos(math.radians(deg)), math.sin(math.radians(deg))
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    m = [[float(r == k) for k in range(4)] for r in range(4)]
    m[i][i] = m[j][j] = c
    m[i][j], m[j][i] = -s, s
    return m


def move(x, y, z):
    return [[1.0, 0.0, 0.0, x], [0.0, 1.0, 0.0, y], [0.0, 0.0, 1.0, z], [0.0, 0.0, 0.0, 1.0]]


def chain(*motions):
    m = move(0, 0, 0)
    for one in motions:
        m = product(m, one)
    return m


def six(x, y, z, a, b, c):
    return chain(move(x, y, z), rotation(0, a), rotation(1, b), rotation(2, c))


def inverse(m):
    t = [[m[j][i] for j in range(3)] for i in range(3)]
    return [t[i] + [-sum(t[i][k] * m[k][3] for k in range(3))] for i in range(3)] + [[0.0, 0.0, 0.0, 1.0]]


def vector(m):
    """Rotation vector, rad; no rotation of this survey is near half a turn."""
    cosine = max(-1.0, min(1.0, (m[0][0] + m[1][1] + m[2][2] - 1) / 2))
    angle = math.acos(cosine)
    if angle < 1e-12:
        return [0.0, 0.0, 0.0]
    scale = angle / (2 * math.sin(angle))
    return [scale * (m[2][1] - m[1][2]), scale * (m[0][2] - m[2][0]), scale * (m[1][0] - m[0][1])]


class Robot:
    """The arm with errors of its joint zeros, lengths and twists, and of parallelism about y."""

    def __init__(self, rng):
        self.zero = [rng.gauss(0, 0.05) for _ in range(6)]
        self.d = [d + rng.gauss(0, 0.3) * (d != 0) for d in D]
        self.a = [a + rng.gauss(0, 0.3) * (i < 5) for i, a in enumerate(A)]
        self.alpha = [t + rng.gauss(0, 0.05) * (i < 5) for i, t in enumerate(ALPHA)]
        self.beta = [rng.gauss(0, 0.05) * (i in (1, 2)) for i in range(6)]

    def tool(self, q):
        steps = []
        for i in range(6):
            steps += [rotation(2, q[i] + self.zero[i]), move(self.a[i], 0, self.d[i]),
                      rotation(0, self.alpha[i]), rotation(1, self.beta[i])]
        return chain(*steps, move(0, 0, TOOL_MM))


def survey(rng):
    robot = Robot(rng)
    mounting = six(*MOUNTING)
    board = chain(robot.tool(MIDDLE), mounting, move(0, 0, 500), rotation(2, 25), rotation(1, 12))
    lines = ["q1_rad,q2_rad,q3_rad,q4_rad,q5_rad,q6_rad,"
             "tvec_x_m,tvec_y_m,tvec_z_m,rvec_x_rad,rvec_y_rad,rvec_z_rad,role"]
    while len(lines) <= POSES + CHECKS:
        q = [round(m + rng.uniform(-s, s), 3) for m, s in zip(MIDDLE, SPAN)]
        seen = product(inverse(chain(robot.tool(q), mounting)), board)
        at = [seen[r][3] for r in range(3)]
        far = math.sqrt(sum(c * c for c in at))
        if not 250 < far < 1000 or at[2] < math.cos(math.radians(25)) * far:
            continue
        if abs(sum(seen[r][2] * at[r] for r in range(3))) < 0.5 * far or seen[0][0] + seen[1][1] + seen[2][2] < -0.8:
            continue
        noise = [math.degrees(rng.gauss(0, U_RAD)) for _ in range(3)]
        turned = chain(rotation(0, noise[0]), rotation(1, noise[1]), rotation(2, noise[2]), seen)
        cells = [f"{math.radians(a):.7f}" for a in q] + [f"{1e-3 * (c + rng.gauss(0, U_MM)):.7f}" for c in at]
        cells += [f"{c:.7f}" for c in vector(turned)]
        lines.append(",".join(cells + ["check" if len(lines) > POSES else "fit"]))
    return lines


def main():
    with open(f"{sys.argv[1]}/solvepnp.csv", "w", newline="\n") as out:
        out.write("\n".join(survey(random.Random(3901))) + "\n")


main()

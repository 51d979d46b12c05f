#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""make.py FOLDER: an R-test of a table with two rotary axes (README.md). The kinematics are written here, not taken from
Vernier."""
import math
import random
import sys

MACHINE = """<machine name="tilting_table">
<variables>
<static>
<xB value="0" nominal="0" unit="mm"/> <zB value="0" nominal="0" unit="mm"/>
<rxB value="0" nominal="0" unit="deg"/> <rzB value="0" nominal="0" unit="deg"/>
<xC value="0" nominal="0" unit="mm"/> <yC value="0" nominal="0" unit="mm"/>
<rxC value="0" nominal="0" unit="deg"/> <ryC value="0" nominal="0" unit="deg"/>
<BaseShift/>
</static>
<machineaxes>
<X rotary="false" min="-400" max="400"/> <Y rotary="false" min="-400" max="400"/> <Z rotary="false" min="-200" max="400"/>
<B rotary="true" min="-100" max="100"/> <C rotary="true" min="-360" max="360"/>
</machineaxes>
</variables>
<transforms branch="workpiece">
<sixdof n="1" X="xB" Z="zB" rX="rxB" rZ="rzB"/>
<sixdof n="2" rY="B"/>
<sixdof n="3" X="xC" Y="yC" rX="rxC" rY="ryC"/>
<sixdof n="4" rZ="C"/>
</transforms>
<transforms branch="tool">
<sixdof n="1" X="X"/>
<sixdof n="2" Y="Y"/>
<sixdof n="3" Z="Z"/>
</transforms>
</machine>
"""
TRUTH = {"xB": 0.012, "zB": -0.018, "rxB": 0.0023, "rzB": -0.0201, "xC": 0.031, "yC": -0.044, "rxC": 0.0042, "ryC": -0.0057}
SPHERE_MM = (120.0, 0.0, 80.0)  # on the table
NOISE_MM = 0.001


def turn(axis, deg, v):
    c, s = math.cos(math.radians(deg)), math.sin(math.radians(deg))
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    out = list(v)
    out[i], out[j] = c * v[i] - s * v[j], s * v[i] + c * v[j]
    return out


def shift(by, v):
    return [a + b for a, b in zip(v, by)]


def of_machine(e, b, c, v):
    """A point of the table in the frame of the machine."""
    v = turn(2, c, v)
    v = shift((e["xC"], e["yC"], 0), turn(0, e["rxC"], turn(1, e["ryC"], v)))
    v = turn(1, b, v)
    return shift((e["xB"], 0, e["zB"]), turn(0, e["rxB"], turn(2, e["rzB"], v)))


def of_table(e, b, c, v):
    """A point of the machine in the frame of the table."""
    v = turn(2, -e["rzB"], turn(0, -e["rxB"], shift((-e["xB"], 0, -e["zB"]), v)))
    v = turn(1, -b, v)
    v = turn(1, -e["ryC"], turn(0, -e["rxC"], shift((-e["xC"], -e["yC"], 0), v)))
    return turn(2, -c, v)


folder = sys.argv[1]
random.seed(11)
nominal = {name: 0.0 for name in TRUTH}
with open(folder + "/machine.xml", "w", encoding="ascii") as file:
    file.write(MACHINE)
with open(folder + "/rtest.csv", "w", encoding="ascii") as file:
    file.write("B [deg],C [deg],X [mm],Y [mm],Z [mm],dX [um],dY [um],dZ [um]\n")
    for b in (-60, -30, 0, 30, 60):
        for c in range(0, 360, 30):
            position = [round(x, 4) for x in of_machine(nominal, b, c, SPHERE_MM)]
            seen = of_table(TRUTH, b, c, position)
            d = [1000 * (s - p + random.gauss(0, NOISE_MM)) for s, p in zip(seen, SPHERE_MM)]
            file.write(",".join(str(v) for v in (b, c)) + "," + ",".join(f"{v:.4f}" for v in position) + ","
                       + ",".join(f"{v:.2f}" for v in d) + "\n")

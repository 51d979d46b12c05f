#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Linear tests with a hidden cyclic error: what does `vernier diagnose` name?

Each survey is a test of one axis as ISO 230-2 describes it: 13 targets at uneven distances, five approaches from
both sides, u 1 um. Hidden: a cyclic error of 4 um with the period of a screw or a scale, or nothing. The axis,
the targets, the period and the noise are drawn here, without code of Vernier. With --beside each survey also has
a lead error of 20 to 100 um/m and a reversal error of 3 to 10 um, as most axes have; the lead error and the reversal
error must then be named too.
    linear_test_rates.py BIN [--surveys N] [--seed SEED] [--beside] [--keep DIR]
"""
import argparse, json, math, os, random, re, subprocess, sys, tempfile
from concurrent.futures import ThreadPoolExecutor

PERIODS_mm = [2, 4, 5, 5.08, 6, 8, 10, 12, 16, 20, 25]
TARGETS, APPROACHES, AMPLITUDE_um, U_um = 13, 5, 4.0, 1.0

MACHINE = """<machine name="axis"><variables><static><c value="0" unit="mm"/></static>
  <machineaxes><X rotary="false" min="0" max="{length}"/></machineaxes></variables>
  <transforms branch="tool"><sixdof n="1" X="X+c" Y="0" Z="0" rX="0" rY="0" rZ="0"/></transforms></machine>
"""


def survey(draw, folder, hidden, beside):
    length = round(draw.uniform(300, 1500))
    step = length / (TARGETS - 1)
    period = draw.choice(PERIODS_mm)
    phase = draw.uniform(0, 2 * math.pi)
    lead = draw.choice((-1, 1)) * draw.uniform(20, 100) * 1e-3 if beside else 0  # um/mm
    reversal = draw.choice((-1, 1)) * draw.uniform(3, 10) if beside else 0  # um
    # ISO 230-2, 4.3.2: P_i = (i - 1) p + r, with a random r within the expected period of a cyclic error.
    reach = min(step / 3, 10)
    targets = [min(length, max(0, round(i * step + draw.uniform(-reach, reach), 3))) for i in range(TARGETS)]
    # Other errors that repeat at the targets: a smooth curve, or another error at each target.
    waves = [draw.gauss(0, AMPLITUDE_um / 2) for _ in range(4)]
    places = {x: draw.gauss(0, AMPLITUDE_um / math.sqrt(2)) for x in targets}
    lines = ["X[mm],dirX,x[mm],u[um],run,t[s]"]
    second = 0
    for run in range(APPROACHES):
        for x, side in [(x, 1) for x in targets] + [(x, -1) for x in targets[::-1]]:
            error = lead * x + reversal * side / 2
            if hidden == "cyclic":
                error += AMPLITUDE_um * math.sin(2 * math.pi * x / period + phase)
            if hidden == "curve":
                error += sum(a * math.cos(math.pi * m * x / length) for m, a in enumerate(waves, 2))
            if hidden == "places":
                error += places[x]
            second += 20
            lines.append(f"{x:.3f},{side},{x + 1e-3 * (error + draw.gauss(0, U_um)):.6f},{U_um:g},r{run + 1},{second}")
    os.makedirs(folder, exist_ok=True)
    with open(f"{folder}/model.xml", "w") as f:
        f.write(MACHINE.format(length=length))
    with open(f"{folder}/survey.csv", "w") as f:
        f.write("\n".join(lines) + "\n")
    return period


def periods_of(answer):
    """Periods of the first causes and of the steps of the stepwise model."""
    texts = [step.get("add") or "" for step in answer.get("ladder", []) if step.get("certain")]
    return ([c.get("period", {}).get("value", 0) for c in answer.get("causes", []) if c["effect"] == "cyclic-error"] +
            [float(found[1]) for found in (re.search(r"^cyclic-error:.*start\.p=([\d.e+-]+)", text) for text in texts) if found])


def named_beside(answer):
    """Does the ladder contain the lead error and the reversal error?"""
    return {"scale-error", "backlash"} <= {step.get("effect") for step in answer.get("ladder", []) if step.get("certain")}


def judged(answer, period, beside):
    """right, in the list, wrong and sure, ambiguous without it, or the verdict itself."""
    periods = periods_of(answer)
    if period == 0:  # no cyclic error is hidden
        return "cyclic error named" if periods and answer["verdict"] == "missing-effect" else answer["verdict"]
    found = any(abs(one / period - 1) < 0.01 for one in periods)
    if answer["verdict"] == "missing-effect":
        if found:
            return "right" if not beside or named_beside(answer) else "incomplete"
        return "incomplete" if beside and not periods else "wrong and sure"
    if answer["verdict"] == "ambiguous":
        return "in the list" if found else "ambiguous without it"
    return answer["verdict"]


def diagnosed(binary, folder):
    done = subprocess.run([f"{binary}/vernier", "diagnose", f"{folder}/model.xml", f"{folder}/survey.csv", "--json", "-"],
                          capture_output=True, text=True, timeout=600)
    return json.loads(done.stdout) if done.returncode in (0, 2) and done.stdout else {"verdict": f"exit {done.returncode}"}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("binary")
    parser.add_argument("--surveys", type=int, default=60)
    parser.add_argument("--nothing", type=int, default=12, help="surveys with nothing hidden beside these")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--beside", action="store_true", help="a lead error and a reversal error beside the cyclic error")
    parser.add_argument("--hidden", choices=("cyclic", "curve", "places"), default="cyclic",
                        help="what is hidden: a cyclic error, a smooth curve or another error at each target")
    parser.add_argument("--keep")
    o = parser.parse_args()
    root = o.keep or tempfile.mkdtemp(prefix="linear_tests_")
    cases = []
    for i in range(o.surveys + o.nothing):
        folder, hidden = f"{root}/{i:03}", o.hidden if i < o.surveys else None
        period = survey(random.Random(1000003 * o.seed + i), folder, hidden, o.beside)
        cases.append((folder, period if hidden == "cyclic" else 0 if hidden else None))
    with ThreadPoolExecutor(2) as pool:
        answers = list(pool.map(lambda case: diagnosed(o.binary, case[0]), cases))
    counts, false = {}, {}
    for (folder, period), answer in zip(cases, answers):
        kind = answer["verdict"] if period is None else judged(answer, period, o.beside)
        table = false if period is None else counts
        table[kind] = table.get(kind, 0) + 1
        if kind not in ("right", "in the list", "consistent"):
            said = "; ".join(f"{c['effect']} {c.get('period', {}).get('value', '')}" for c in answer.get("causes", []))
            print(f"{folder}: hidden {period or 'nothing'} -> {kind}: {said[:160]}")
    print(f"seed {o.seed}: {o.surveys} linear tests, hidden: {o.hidden}: " +
          ", ".join(f"{k} {v}" for k, v in sorted(counts.items())))
    print(f"{o.nothing} with nothing hidden: " + ", ".join(f"{k} {v}" for k, v in sorted(false.items())))


if __name__ == "__main__":
    sys.exit(main())

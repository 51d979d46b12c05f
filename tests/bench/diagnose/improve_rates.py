#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What `vernier improve` does to a machine at poses that it never saw.

Each machine is a gantry of `vernier new` with smooth errors of its guides, which its tables can hold, and one or two
errors that the model lacks: of the catalogue, or outside it. A tracker reads 5 x 5 x 4 targets in two runs, u 2 um, at
20 to 24 degC. `fit` and `improve` use these rows. Both machine files are then compared with 400 poses without noise in
the whole box, between the targets, at 18 to 26 degC. The machine, the errors, the survey and the noise are drawn here,
without code of Vernier.
    improve_rates.py BIN [--surveys N] [--seed SEED] [--keep DIR]
"""
import argparse, json, math, os, random, statistics, subprocess, sys, tempfile
from concurrent.futures import ThreadPoolExecutor

U_um, POSES = 2.0, 400


def curve(draw, low, high, size):
    """A smooth function of one position, um."""
    a = [draw.gauss(0, size / m) for m in range(1, 4)]
    return lambda q: sum(k * math.cos(math.pi * m * (q - low) / (high - low)) for m, k in enumerate(a, 1))


def guides(draw, box):
    """Positioning and straightness errors and small rotations of each axis, um at the tool point."""
    own = [[curve(draw, *box[axis], draw.uniform(1, 6)) for _ in range(3)] for axis in range(3)]
    return lambda row: [sum(own[axis][i](row["q"][axis]) for axis in range(3)) for i in range(3)]


def along(i, function):
    return lambda row: [function(row) if k == i else 0 for k in range(3)]


def errors_in_the_catalogue(draw, box):
    axis = draw.randrange(3)
    low, high = box[axis]
    size = draw.uniform(6, 25)
    period = draw.uniform(0.06, 0.3) * (high - low)
    phase = draw.uniform(0, 6.28)
    return draw.choice([
        ("cyclic error", along(axis, lambda r: size * math.sin(6.2832 * r["q"][axis] / period + phase))),
        ("backlash", along(axis, lambda r: size / 2 * r["dir"][axis])),
        ("growth", along(axis, lambda r: size / 4 * (r["T"] - 22) * (r["q"][axis] - low) / (high - low) * 2)),
        ("growth of the base", along(draw.randrange(3), lambda r: size / 3 * (r["T"] - 22))),
        ("squareness by heat", along(2, lambda r: size / 4 * (r["T"] - 22) * (r["q"][0] - box[0][0]) / (box[0][1] - box[0][0]))),
        ("lag", along(axis, lambda r: size * r["v"][axis] / 50)),
    ])


def errors_outside(draw, box):
    axis, i = draw.randrange(3), draw.randrange(3)
    other = (axis + 1) % 3
    unit = lambda r, k: (r["q"][k] - box[k][0]) / (box[k][1] - box[k][0])
    size = draw.uniform(6, 25)
    a, b = draw.uniform(0.2, 0.8), draw.uniform(0.2, 0.8)
    width = draw.uniform(0.1, 0.35)
    days = {}
    return draw.choice([
        ("bump", along(i, lambda r: size * math.exp(-((unit(r, axis) - a) ** 2 + (unit(r, other) - b) ** 2) / width ** 2))),
        ("product of three positions", along(i, lambda r: 4 * size * unit(r, 0) * unit(r, 1) * unit(r, 2))),
        ("twisted field", along(i, lambda r: size * math.sin(3 * unit(r, axis) + 4 * unit(r, other) * unit(r, axis)))),
        ("jump at a joint of the guide", along(i, lambda r: size * (unit(r, axis) > a))),
        ("cyclic error that grows", along(axis, lambda r: 2 * size * unit(r, axis) * math.sin(6.2832 * unit(r, axis) / width))),
        ("load that nobody logged", along(i, lambda r: days.setdefault(r["run"] + str(int(4 * r["t"])), draw.gauss(0, size / 2)))),
        ("heat with memory", along(axis, lambda r: size / 3 * (r["T"] - 22) * (1 - math.exp(-3 * r["t"])) * unit(r, other))),
    ])


def reading(row, parts, noise):
    total = [sum(values) for values in zip(*(part(row) for part in parts))]
    return [q + 1e-3 * (e + noise()) for q, e in zip(row["q"], total)]


def csv(rows, u):
    lines = ["X[mm],Y[mm],Z[mm],dirX,dirY,dirZ,vX[mm/s],vY[mm/s],vZ[mm/s],T[degC],x[mm],y[mm],z[mm],u[um],run,t[s]"]
    for row, xyz in rows:
        lines.append(",".join([f"{q:.4f}" for q in row["q"]] + [str(d) for d in row["dir"]] + [f"{v:.3f}" for v in row["v"]] +
                              [f"{row['T']:.2f}"] + [f"{c:.7f}" for c in xyz] + [f"{u:g}", row["run"], f"{row['s']:.0f}"]))
    return "\n".join(lines) + "\n"


def poses(draw, box, targets, run, temperatures):
    rows, before = [], None
    for n, q in enumerate(targets):
        step = [a - b for a, b in zip(q, before or [0, 0, 0])]
        way = math.sqrt(sum(s * s for s in step)) or 1
        feed = draw.choice([10, 50, 150])
        t = n / max(1, len(targets) - 1)
        low, high = temperatures
        rows.append({"q": q, "dir": [1 if s >= 0 else -1 for s in step], "v": [feed * s / way for s in step], "run": run,
                     "t": t, "s": 20 * n, "T": round(low + (high - low) * (0.5 - 0.5 * math.cos(math.pi * t)) + draw.gauss(0, 0.1), 2)})
        before = q
    return rows


def machine(binary, folder, draw):
    box = [(0, draw.choice([400, 600, 900])), (0, draw.choice([300, 500, 800])), (0, draw.choice([200, 300]))]
    words = [w for name, (low, high) in zip("XYZ", box) for w in ("--axis", f"{name}:{low}:{high}")]
    subprocess.run([f"{binary}/vernier", "new", "gantry", *words, "-o", f"{folder}/given.xml"], check=True, capture_output=True)
    text = open(f"{folder}/given.xml").read()
    if "<inputs>" not in text:
        text = text.replace("<machineaxes>", '<inputs><T unit="degC" reference="22"/></inputs>\n    <machineaxes>', 1)
    text = text.replace('<TPZ value="-100"', '<TPZ value="0"')
    open(f"{folder}/model.xml", "w").write(text)
    return box


def one(binary, folder, seed):
    draw = random.Random(seed)
    os.makedirs(folder, exist_ok=True)
    box = machine(binary, folder, draw)
    outside = draw.random() < 0.5
    hidden = [(errors_outside if outside else errors_in_the_catalogue)(draw, box)]
    if draw.random() < 0.3:
        hidden.append(errors_in_the_catalogue(draw, box))
    parts = [guides(draw, box)] + [part for _, part in hidden]
    grid = [[low + (high - low) * i / (n - 1) for i in range(n)] for (low, high), n in zip(box, (5, 5, 4))]
    rows = []
    for run in ("1", "2"):
        targets = [[x, y, z] for z in grid[2] for y in grid[1] for x in grid[0]]
        draw.shuffle(targets)
        rows += poses(draw, box, targets, run, draw.choice([(20, 24), (24, 20), (20, 22), (22, 24)]))
    for n, row in enumerate(rows):
        row["s"] = 20 * n + (3600 if row["run"] == "2" else 0)
    with open(f"{folder}/survey.csv", "w") as f:
        f.write(csv([(row, reading(row, parts, lambda: draw.gauss(0, U_um))) for row in rows], U_um))
    fresh = poses(draw, box, [[draw.uniform(*limits) for limits in box] for _ in range(POSES)], "1", (18, 26))
    with open(f"{folder}/fresh.csv", "w") as f:
        f.write(csv([(row, reading(row, parts, lambda: 0)) for row in fresh], 0.1))

    def run(*words):
        done = subprocess.run([f"{binary}/vernier", *words], capture_output=True, text=True, timeout=900)
        if done.returncode != 0:
            raise RuntimeError(f"{words[0]}: exit {done.returncode}: {done.stderr.strip()[:300]}")
        return done.stdout

    def rms(xml):
        return json.loads(run("compare", xml, f"{folder}/fresh.csv", "--json", "-"))["rms_um"]

    name = " + ".join(name for name, _ in hidden)
    try:
        run("fit", f"{folder}/model.xml", f"{folder}/survey.csv", "-o", f"{folder}/fitted.xml")
        answer = json.loads(run("improve", f"{folder}/model.xml", f"{folder}/survey.csv", "-o", f"{folder}/improved", "--yes",
                                "--json", "-"))
        steps = [step["add"].split(":")[0] for step in answer.get("steps", answer.get("ladder", [])) if step.get("add")]
        last = max(f for f in os.listdir(f"{folder}/improved") if f.endswith(".xml"))  # the steps are numbered
        return name, outside, rms(f"{folder}/fitted.xml"), rms(f"{folder}/improved/{last}"), steps
    except RuntimeError as trouble:
        return name, outside, None, None, [str(trouble)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("binary")
    parser.add_argument("--surveys", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep")
    o = parser.parse_args()
    root = o.keep or tempfile.mkdtemp(prefix="improve_")
    ratios, worse, failed = [], [], 0
    with ThreadPoolExecutor(2) as pool:
        results = pool.map(lambda i: one(o.binary, f"{root}/{i:03}", 1000003 * o.seed + i), range(o.surveys))
        for i, (name, outside, before, after, steps) in enumerate(results):
            if before is None:
                failed += 1
                print(f"{i:03} {name}: {steps[0]}")
                continue
            ratio = after / before
            ratios.append(ratio if steps else None)
            if ratio > 1 and steps:
                worse.append(ratio)
            print(f"{i:03} {'outside' if outside else 'catalogue'}, {name}: {before:.2f} -> {after:.2f} um at new poses "
                  f"({ratio:.3f}); added: {', '.join(steps) or 'nothing'}", flush=True)
    changed = [r for r in ratios if r is not None]
    print(f"seed {o.seed}: {len(ratios)} machines, {failed} refused; {len(changed)} changed by improve, "
          f"median ratio {statistics.median(changed) if changed else float('nan'):.2f}; "
          f"worse at new poses {len(worse)}, largest ratio {max(worse, default=1):.3f}")


if __name__ == "__main__":
    sys.exit(main())

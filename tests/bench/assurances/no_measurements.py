#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Generator of no: machines, data and noise of its own, with truths that are NO (or YES), against the assurances of vernier.

Own chain arithmetic in numpy (eval of the expressions that are written into the machine file), own noise, seeded.
Per assurance it counts false yes (target: none of 40, at most 1 %) and true yes (target: at least 95 %).
    no_measurements.py BIN [--seeds N] [--first SEED] [--only NAME[,NAME]] [--keep DIR]
NAME: check quiet scatter conformity conformity-no (conformity-none: part of conformity) compile pose (with compile) fit. Exit status 1 where a target is missed.
"""
import argparse, json, math, os, re, shutil, subprocess, sys, tempfile, time
import xml.etree.ElementTree as ET
import numpy as np

AX = "XYZ"
COLS = ["X", "Y", "Z", "rX", "rY", "rZ"]
D = math.pi / 180


# ------------------------------------------------------------------ chain
class Machine:
    """statics {name: [value, free, unit]}, tables {axis: (stations, values n x 6 in mm/deg, fitted columns)}."""

    def __init__(self, statics, tables, trans, axes, inputs=None, tools=None, instrument=None):
        self.statics, self.tables, self.trans, self.axes = statics, tables, trans, axes
        self.inputs, self.tools, self.fns = inputs or {}, tools or {}, {}
        self.interp = "linear"

    def copy(self):
        m = Machine({k: list(v) for k, v in self.statics.items()}, {a: (s.copy(), v.copy(), c) for a, (s, v, c) in self.tables.items()},
                    [dict(t) for t in self.trans], dict(self.axes), dict(self.inputs), dict(self.tools))
        m.fns = dict(self.fns)
        return m

    def env(self, q, nominal):
        n = len(q["X"])
        e = {"sin": lambda a: np.sin(np.asarray(a) * D), "cos": lambda a: np.cos(np.asarray(a) * D)}
        for k, (v, free, _) in self.statics.items():
            e[k] = 0.0 if nominal and free else v
        for i, ref in self.inputs.items():
            e[i] = q.get(i, np.full(n, float(ref)))
        for a in AX:
            e[a] = q[a]
            e["dir" + a] = q.get("dir" + a, np.zeros(n))
            for j, c in enumerate(["l%sx", "l%sy", "l%sz", "r%sx", "r%sy", "r%sz"]):
                if a in self.tables and not nominal:
                    s, v, _ = self.tables[a]
                    e[c % a] = np.interp(q[a], s, v[:, j])
                else:
                    e[c % a] = np.zeros(n)
        return e

    def point(self, q, nominal=False, tool=(0, 0, 0)):
        e, n = self.env(q, nominal), len(q["X"])
        p = np.tile(np.array(tool, float), (n, 1))
        for t in reversed(self.trans):
            val = {c: (np.asarray(eval(t[c], {"__builtins__": {}}, e), float) * np.ones(n) if c in t else np.zeros(n)) for c in COLS}
            x, y, z = p.T
            c, s = np.cos(val["rZ"] * D), np.sin(val["rZ"] * D)
            x, y = c * x - s * y, s * x + c * y
            c, s = np.cos(val["rY"] * D), np.sin(val["rY"] * D)
            x, z = c * x + s * z, -s * x + c * z
            c, s = np.cos(val["rX"] * D), np.sin(val["rX"] * D)
            y, z = c * y - s * z, s * y + c * z
            p = np.stack([x + val["X"], y + val["Y"], z + val["Z"]], 1)
        if not nominal:                                     # what is in the truth and in no model, mm at the tool point
            for k, f in self.fns.items():
                p = p + f(q)
        return p

    def dev(self, q, tool=(0, 0, 0)):
        return self.point(q, tool=tool) - self.point(q, True, tool)

    def xml(self, path, values=False):
        o = ['<machine name="m"><variables><static>']
        for k, (v, free, unit) in self.statics.items():
            if free:
                o.append(f'<{k} value="{v if values else 0!r}" nominal="0" unit="{unit}"/>')
            else:
                o.append(f'<{k} value="{v!r}" unit="{unit}" Hide="true"/>')
        o.append('<BaseShift X="0" Y="0" Z="0" rX="0" rY="0" rZ="0"/></static><machineaxes>')
        for a, (lo, hi) in self.axes.items():
            o.append(f'<{a} rotary="false" min="{lo}" max="{hi}" maxcorrection="0.5" maxslew="5"/>')
        o.append("</machineaxes>")
        if self.inputs:
            o.append("<inputs>" + "".join(f'<{i} unit="degC" reference="{r}"/>' for i, r in self.inputs.items()) + "</inputs>")
        if self.tables:
            o.append("<comptables>")
            for a, (s, v, c) in self.tables.items():
                o.append(f'<table axis="{a}" interpolation="linear" fit="{c}">')
                for k, loc in enumerate(s):
                    o.append(f'<station loc="{loc!r}" ' .replace("np.float64(", "").replace(")", "") +
                             " ".join(f'{cc}="{float(v[k, j]) if values else 0.0!r}"' for j, cc in enumerate(COLS)) + "/>")
                o.append("</table>")
            o.append("</comptables>")
        if self.tools:
            o.append("<tools>" + "".join(f'<{k} X="{t[0]}" Y="{t[1]}" Z="{t[2]}"/>' for k, t in self.tools.items()) + "</tools>")
        o.append('</variables><transforms branch="tool">')
        for i, t in enumerate(self.trans):
            o.append(f'<sixdof n="{i + 1}" ' + " ".join(f'{c}="{x}"' for c, x in t.items()) + "/>")
        o.append("</transforms></machine>")
        open(path, "w").write("\n".join(o).replace("+-", "-") + "\n")

    def fitted(self, path):
        """this machine with the values of a file that fit wrote"""
        m, root = self.copy(), ET.parse(path).getroot()
        m.fns = {}
        st = {e.tag: e for e in root.iter("static").__next__()}
        for k in m.statics:
            m.statics[k][0] = float(st[k].get("value"))
        for t in root.iter("table"):
            a = t.get("axis")
            s = np.array([float(x.get("loc")) for x in t.findall("station")])
            v = np.array([[float(x.get(c, "0")) for c in COLS] for x in t.findall("station")])
            m.tables[a] = (s, v, m.tables[a][2])
        return m


def rot(v):
    t = np.linalg.norm(v)
    if t < 1e-12:
        return np.eye(3)
    k = v / t
    K = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    return np.eye(3) + math.sin(t) * K + (1 - math.cos(t)) * K @ K


def rigid_off(p, d):
    """deviations d at points p less the best small rigid motion"""
    n = len(p)
    A = np.zeros((3 * n, 6))
    c = p - p.mean(0)
    for i in range(3):
        A[i::3, i] = 1
    A[0::3, 4], A[0::3, 5] = c[:, 2], -c[:, 1]
    A[1::3, 3], A[1::3, 5] = -c[:, 2], c[:, 0]
    A[2::3, 3], A[2::3, 4] = c[:, 1], -c[:, 0]
    b = d.reshape(-1)
    return (b - A @ np.linalg.lstsq(A, b, rcond=None)[0]).reshape(n, 3)


def rms(d):
    return math.sqrt((d ** 2).sum(1).mean())


# ------------------------------------------------------------------ running
class Bench:
    def __init__(self, a):
        self.bin = os.path.join(a.bin, "vernier") if os.path.isdir(a.bin) else a.bin
        self.n, self.first, self.keep = a.seeds, a.first, a.keep
        self.dir = a.keep or tempfile.mkdtemp(prefix="no_")
        os.makedirs(self.dir, exist_ok=True)
        self.rows, self.bad, self.crash = [], 0, []

    def path(self, *p):
        return os.path.join(self.dir, *p)

    def run(self, *args, js=None):
        args = [str(x) for x in args]
        if js:
            if os.path.exists(js):
                os.remove(js)
            args += ["--json", js]
        try:
            r = subprocess.run([self.bin] + args, capture_output=True, text=True, timeout=60)
            rc, err = r.returncode, r.stderr
        except subprocess.TimeoutExpired:
            rc, err = 124, "timeout"
        if rc in (1, 70, 124) or rc < 0:
            self.crash.append((rc, " ".join(args), err[:300]))
        out = None
        if js and os.path.exists(js):
            txt = open(js).read()
            out = json.loads(txt)
            if re.search(r"\b(nan|inf|infinity)\b", txt, re.I):
                self.crash.append(("nan", " ".join(args), ""))
        return rc, out, err

    def line(self, what, bad, of, target, ok, note=""):
        self.rows.append((what, f"{bad}/{of}", target, "ok" if ok else "MISSED", note))
        if not ok:
            self.bad += 1
        print(f"{what:58s} {bad:5d}/{of:<5d} {100.0 * bad / max(of, 1):6.1f} %  target {target:22s} {'ok' if ok else 'MISSED'}  {note}", flush=True)

    def false_yes(self, what, l):
        b = [k for k, y in l if y]
        self.line(what + ": false yes", len(b), len(l), "<= 1 %", len(b) <= 0.01 * len(l), ("at " + " ".join(map(str, b[:6]))) if b else "")

    def true_yes(self, what, l):
        b = [k for k, y in l if not y]
        self.line(what + ": true yes", len(l) - len(b), len(l), ">= 95 %", len(b) <= 0.05 * len(l), ("not at " + " ".join(map(str, b[:6]))) if b else "")


def csv(path, q, y, u=1.0, roles=None, run=None, readings="xyz", extra=None, mask=None):
    """y: measured points, mm; u in um; mask: bool n x 3 of what is read"""
    names = [k for k in q]
    head = [f"{k}[mm]" if k in AX else (k if k.startswith("dir") else f"{k}[degC]") for k in names]
    head += [f"{c}[mm]" for c in readings] + ["u[um]"] + (["run"] if run is not None else []) + (["role"] if roles is not None else [])
    with open(path, "w") as f:
        f.write(",".join(head) + "\n")
        for i in range(len(y)):
            r = [f"{q[k][i]:.6f}" if not k.startswith("dir") else f"{int(q[k][i])}" for k in names]
            r += [(f"{y[i]['xyz'.index(c)]:.7f}" if mask is None or mask[i]["xyz".index(c)] else "") for c in readings] + [f"{u:g}"]
            if run is not None:
                r.append(run[i])
            if roles is not None:
                r.append(roles[i])
            f.write(",".join(r) + "\n")


def setup(g, angle=None, far=800.0):
    v = g.normal(size=3)
    v /= np.linalg.norm(v)
    a = g.uniform(0, 180) if angle is None else angle
    return rot(v * a * D), g.uniform(-far, far, 3)


def read(m, q, su, g, u=1.0, tool=(0, 0, 0)):
    p = m.point(q, tool=tool) @ su[0].T + su[1]
    return p + g.normal(size=p.shape) * u * 1e-3


def random_q(m, g, n, dirs=True, **inputs):
    q = {a: np.round(g.uniform(*m.axes[a], n), 3) for a in AX}
    if dirs:
        for a in AX:
            q["dir" + a] = g.choice([-1.0, 1.0], n)
    for k, v in inputs.items():
        q[k] = np.array(v, float) * np.ones(n)
    return q


def draw_axes(g):
    return {"X": (0, int(g.choice([400, 600, 800]))), "Y": (0, int(g.choice([300, 400, 500]))), "Z": (-int(g.choice([200, 300, 400])), 0)}


ST = {"SX": [0., True, ""], "SY": [0., True, ""], "SZ": [0., True, ""], "EC0Y": [0., True, "rad"], "EA0Z": [0., True, "rad"],
      "EB0Z": [0., True, "rad"], "BX": [0., True, "mm"], "BY": [0., True, "mm"], "TPZ": [-100., False, "mm"]}


def static_machine(g):
    return Machine({k: list(v) for k, v in ST.items()}, {}, [
        {"X": "-EC0Y*Y", "Y": "Y+SY*Y+BY*dirY"}, {"X": "X+SX*X+BX*dirX"}, {"X": "EB0Z*Z", "Y": "-EA0Z*Z", "Z": "Z+SZ*Z"}, {"Z": "TPZ"}], draw_axes(g))


def table_machine(g, cols="X Y Z rX rY rZ", step=None, tool=-100.):
    ax = draw_axes(g)
    t = {}
    for a in AX:
        lo, hi = ax[a]
        n = max(2, round((hi - lo) / (step or 150))) + 1
        t[a] = (np.linspace(lo, hi, n), np.zeros((n, 6)), cols)
    s = {"EC0Y": [0., True, "rad"], "EA0Z": [0., True, "rad"], "EB0Z": [0., True, "rad"], "TPZ": [tool, False, "mm"]}
    r = lambda a: {"rX": f"r{a}x", "rY": f"r{a}y", "rZ": f"r{a}z"} if "r" in cols else {}
    return Machine(s, t, [
        {"X": "lYx-EC0Y*Y", "Y": "Y+lYy", "Z": "lYz", **r("Y")}, {"X": "X+lXx", "Y": "lXy", "Z": "lXz", **r("X")},
        {"X": "lZx+EB0Z*Z", "Y": "lZy-EA0Z*Z", "Z": "Z+lZz", **r("Z")}, {"Z": "TPZ"}], ax)


def true_values(m, g, size=5e-3, ang=5e-4, square=3e-5):
    t = m.copy()
    for k, v in t.statics.items():
        if v[1]:
            v[0] = g.normal() * (square if v[2] in ("rad", "") else 3e-3 if v[2] == "mm" else 1.0)
    for a, (s, v, c) in t.tables.items():
        for j, cc in enumerate(COLS):
            if cc in c.split():
                v[:, j] = g.normal(size=len(s)) * (ang if cc[0] == "r" else size)
    return t


def roles(n, every=4):
    return ["check" if i % every == every - 1 else "fit" for i in range(n)]


# ------------------------------------------------------------------ check
def fit_small(b, g, tag, kind):
    m = static_machine(g) if kind == 0 else table_machine(g, "X", 200) if kind == 1 else table_machine(g, "X Y Z", 200)
    if kind:
        m.statics["BX"] = [0., True, "mm"]
        m.trans[1]["X"] += "+BX*dirX"
    t = true_values(m, g)
    m.xml(b.path(tag + ".xml"))
    q = random_q(m, g, 60 if kind == 0 else 120)
    csv(b.path(tag + ".csv"), q, read(t, q, setup(g), g), roles=roles(len(q["X"])))
    rc, j, err = b.run("fit", b.path(tag + ".xml"), b.path(tag + ".csv"), "-o", b.path(tag + "_f.xml"), js=b.path(tag + "_f.json"))
    return (m, t) if rc == 0 else None


def check_poses(m, g, last):
    k = "volume" if last else g.choice(["lineX", "lineY", "lineZ", "volume"])
    n = int(g.integers(15, 21)) if last else int(g.integers(8, 13))
    q = random_q(m, g, n)
    if k != "volume":
        a = k[-1]
        for o in AX:
            if o != a:
                q[o] = np.full(n, np.round(g.uniform(*m.axes[o]), 3))
        q[a] = np.round(np.linspace(*m.axes[a], n), 3)
    if not last and g.random() < 0.5:
        for a in AX:
            q["dir" + a] = np.ones(n)
    return q, k


def change(t, g, kind, size):
    c = t.copy()
    if kind == "scale":
        a = g.choice(list(AX))
        lo, hi = t.axes[a]
        s = size * 1e-3 * g.choice([-1, 1]) / (hi - lo)
        j = AX.index(a)
        for i, tr in enumerate(c.trans):
            d = a
            if d in tr and re.match(rf"{a}\b", tr[d].strip()):
                tr[d] += f"+CH*{a}"
        c.statics["CH"] = [s, True, ""]
        return c, f"scale {a} {size:g} um"
    if kind == "square":
        k = g.choice(["EC0Y", "EA0Z", "EB0Z"])
        lo, hi = t.axes["Y" if k == "EC0Y" else "Z"]
        size = max(size, 12e3 / (hi - lo))                               # 12 um over the travel at least: well above five standard deviations
        c.statics[k][0] += size * 1e-6 * g.choice([-1, 1])
        return c, f"{k} {size:.0f} urad"
    if "BX" in c.statics:
        c.statics["BX"][0] += 4e-3 * g.choice([-1, 1])
    return c, "reversal X 8 um"


def one_history(b, seed, kind, fa):
    """kind: none, scale10, scale20, square, reversal. -> (last verdict, any earlier alarm, text)"""
    g = np.random.default_rng([seed, {"none": 0, "scale10": 1, "scale20": 2, "square": 3, "reversal": 4}[kind], 101])
    tag = f"ck_{kind}_{seed}"
    r = fit_small(b, g, tag, seed % 3)
    if r is None:
        return None
    m, t = r
    n = int(g.integers(3, 7))
    when = int(g.integers(0, n))
    c, text = (t, "nothing") if kind == "none" else change(t, g, {"scale10": "scale", "scale20": "scale"}.get(kind, kind),
                                                        {"scale10": 10, "scale20": 20, "square": g.uniform(30, 60), "reversal": 8}[kind])
    hist = b.path(tag + ".hist")
    if os.path.exists(hist):
        os.remove(hist)
    verdicts, holds = [], []
    for k in range(n):
        q, what = check_poses(m, g, k == n - 1)
        csv(b.path(f"{tag}_{k}.csv"), q, read(c if kind != "none" and k >= when else t, q, setup(g), g))
        rc, j, err = b.run("check", b.path(tag + "_f.xml"), b.path(f"{tag}_{k}.csv"), "--history", hist, "--label", f"c{k}",
                           *(["--false-alarms", fa] if fa else []), js=b.path(f"{tag}_{k}.json"))
        verdicts.append(j["verdict"] if j else f"exit {rc}")
        holds.append(bool(j and j["assurance"]["holds"]))
    return verdicts, holds, f"{text} from check {when} of {n}"


def do_check(b):
    for kind in ("scale10", "scale20", "square", "reversal"):
        l, rep = [], 0
        for s in range(b.first, b.first + b.n):
            r = one_history(b, s, kind, 0.05 if s % 2 else None)
            if r is None:
                continue
            v, h, text = r
            l.append((s, v[-1] == "valid" or h[-1]))
            rep += v[-1] == "changed"
            if l[-1][1]:
                print("   ", s, kind, text, v)
        b.false_yes(f"check, {kind}", l)
        b.line(f"check, {kind}: reported as `changed`", rep, len(l), ">= 95 %", rep >= 0.95 * len(l))


def do_quiet(b):
    n = max(60, b.n)
    for fa in (None, 0.05):
        l, last = [], []
        for s in range(b.first, b.first + n // 2 if fa is None else b.first + n):
            r = one_history(b, s + (500000 if fa else 0), "none", fa)
            if r is None:
                continue
            alarm = any(x not in ("valid", "too-little") for x in r[0])
            l.append(alarm)
            last.append((s, r[0][-1] == "valid" and r[1][-1]))
            if alarm:
                print("    quiet", s, r[0])
        rate = fa or 0.01
        lim = rate * len(l) + 2.33 * math.sqrt(rate * len(l)) + 0.5
        b.line(f"check, quiet histories, rate {rate}: alarms", sum(l), len(l), f"<= {lim:.1f} (99 %)", sum(l) <= lim)
        b.true_yes(f"check, quiet, last check, rate {rate}", last)


def do_scatter(b):
    """single quiet checks: the chance that `scatter` tells must be below p in a share p at most; loud checks must not be valid"""
    low, loud, alarms = {}, {"line": [], "volume": []}, {}
    for s in range(b.first, b.first + max(12, b.n // 2)):
        g = np.random.default_rng([s, 105])
        r = fit_small(b, g, "sc", s % 3)
        if r is None:
            continue
        m, t = r
        for k in ("X", "Y", "Z", "volume") * 2:
            n = int(g.integers(10, 16))
            q = random_q(m, g, n)
            if k != "volume":
                for o in AX:
                    q[o] = np.full(n, np.round(g.uniform(*m.axes[o]), 3))
                q[k] = np.round(np.linspace(*m.axes[k], n), 3)
            name = "line" if k != "volume" else k
            for real in (1.0, 4.0):
                csv(b.path("sc_k.csv"), q, read(t, q, setup(g), g, real), 1.0)
                rc, j, err = b.run("check", b.path("sc_f.xml"), b.path("sc_k.csv"), js=b.path("sc_k.json"))
                if j is None:
                    continue
                if real == 1.0:
                    low.setdefault(name, []).append(j["noise_p"] is not None and j["noise_p"] < 0.05)
                    alarms.setdefault(name, []).append(j["verdict"] in ("instrument", "changed"))
                else:
                    loud[name].append((f"{s}{k}", j["verdict"] == "valid"))
    for k, l in low.items():
        lim = 0.05 * len(l) + 2.33 * math.sqrt(0.05 * len(l)) + 0.5
        b.line(f"check, quiet, {k}: chance of the scatter below 5 %", sum(l), len(l), f"<= {lim:.1f} (99 %)", sum(l) <= lim)
        l = alarms[k]
        lim = 0.01 * len(l) + 2.33 * math.sqrt(0.01 * len(l)) + 0.5
        b.line(f"check, quiet, {k}: single checks, alarms at 0.01", sum(l), len(l), f"<= {lim:.1f} (99 %)", sum(l) <= lim)
    for k, l in loud.items():
        b.false_yes(f"check, readings 4 times as loud as u, {k}", l)


# ------------------------------------------------------------------ conformity
def truth_functions(g, m, lack):
    f = {}
    if lack == "smooth":
        parts = []
        for i in range(9):
            a, d = AX[i // 3], i % 3
            parts.append((a, d, g.uniform(60, 160), g.uniform(0, 2 * math.pi), g.uniform(0.5, 1.5) * 1e-3))

        def smooth(q):
            o = np.zeros((len(q["X"]), 3))
            for a, d, L, ph, am in parts:
                o[:, d] += am * np.sin(2 * math.pi * q[a] / L + ph)
            return o
        f["smooth"] = smooth
    if lack == "wave":
        a = AX[g.integers(3)]
        L, ph, am = g.uniform(4, 12), g.uniform(0, 2 * math.pi), g.uniform(1, 2) * 1e-3

        def wave(q):
            o = np.zeros((len(q["X"]), 3))
            o[:, AX.index(a)] = am * np.sin(2 * math.pi * q[a] / L + ph)
            return o
        f["wave"] = wave
    return f


def point_values(m, fm, t, P, tool=(0, 0, 0)):
    """2 |deviation| at points P of a part (places count from all of them), um: uncorrected, corrected"""
    q = {a: P[:, i] - (m.statics["TPZ"][0] + tool[2] if a == "Z" else 0) for i, a in enumerate(AX)}
    d0 = t.dev(q, tool)
    qc = {a: q[a] - fm.dev(q, tool)[:, i] for i, a in enumerate(AX)}
    d1 = t.point(qc, tool=tool) - m.point(q, True, tool)
    return [2e3 * np.linalg.norm(rigid_off(P, d), axis=1) for d in (d0, d1)]


def do_conformity_no(b):
    """models that are wrong where nothing was measured: a tool that no reading had, an alias between targets; false `conforms` with the correction"""
    for kind in ("tool-cold", "grid-jitter", "grid-few"):
        fc, conf, cov = [], 0, []
        for s in range(b.first, b.first + max(10, b.n // 4)):
            g = np.random.default_rng([s, COMPILE.index(kind), 1, 505])
            m, t, q, ro, mask, T, tools = compile_case(g, kind, True)
            tag = f"pn_{kind}_{s}"
            rc, j, err = fit_case(b, tag, m, t, q, read(t, q, setup(g), g), ro, mask)
            if rc:
                continue
            fm, tool, k = m.fitted(b.path(tag + "_f.xml")), tools[-1], 4
            lo = np.array([m.axes[a][0] for a in AX], float)
            hi = np.array([m.axes[a][1] for a in AX], float)
            P = np.round(lo + g.uniform(0.05, 0.95, (k, 3)) * (hi - lo) + [0, 0, m.statics["TPZ"][0] + tool[2]], 3)
            tv = point_values(m, fm, t, P, tool)[1]
            tol = tv * g.uniform(0.4, 1.6, k) * 1e-3
            with open(b.path(tag + "_p.csv"), "w") as f:
                f.write("feature,kind,x,y,z,position\n" + "".join(f"p{i},point,{P[i,0]:.3f},{P[i,1]:.3f},{P[i,2]:.3f},{tol[i]:.6f}\n" for i in range(k)))
            rc, j, err = b.run("part", "conformity", b.path(tag + "_f.xml"), b.path(tag + "_p.csv"), "--tool", ",".join(map(str, tool)), js=b.path(tag + "_p.json"))
            if j is None:
                continue
            for c in j["characteristics"]:
                i, r = int(c["feature"][1:]), c["corrected"]
                cov.append(r["interval_um"][0] <= tv[i] <= r["interval_um"][1])
                if r["verdict"] == "conforms":
                    conf += 1
                    if tv[i] > tol[i] * 1e3:
                        fc.append((s, c["feature"], round(tv[i], 1), round(tol[i] * 1e3, 1)))
        b.line(f"conformity, model wrong ({kind}): false `conforms`", len(fc), conf, "<= 1 %", len(fc) <= 0.01 * conf, str(fc[:2]))
        b.line(f"conformity, model wrong ({kind}): interval", int(sum(cov)), len(cov), ">= 90 %", sum(cov) >= 0.9 * len(cov))


def do_conformity(b, lacks=("none", "smooth", "wave")):
    for lack in lacks:
        cov = {"uncorrected": [], "corrected": []}
        conf, fc, notsure, bc, fbc, ncov = 0, [], 0, 0, [], {"size": [], "form": []}
        for s in range(b.first, b.first + (b.n if lack == "none" else max(10, b.n // 2))):
            g = np.random.default_rng([s, {"none": 0, "smooth": 1, "wave": 2}[lack], 202])
            tag = f"pc_{lack}_{s}"
            m = table_machine(g)
            t = true_values(m, g)
            if lack != "none":
                t.fns = truth_functions(g, m, lack)
            m.xml(b.path(tag + ".xml"))
            n = int(g.integers(150, 301))
            q = random_q(m, g, n, dirs=False)
            csv(b.path(tag + ".csv"), q, read(t, q, setup(g), g), roles=roles(n, 5))
            rc, j, err = b.run("fit", b.path(tag + ".xml"), b.path(tag + ".csv"), "-o", b.path(tag + "_f.xml"), js=b.path(tag + "_f.json"))
            if rc:
                continue
            fm = m.fitted(b.path(tag + "_f.xml"))
            lo = np.array([m.axes[a][0] for a in AX], float)
            hi = np.array([m.axes[a][1] for a in AX], float)
            k = 4
            size = g.uniform(0.3, 0.9) * (hi - lo)
            c0 = lo + g.uniform(0, 1, 3) * (hi - lo - size)
            P = np.round(c0 + g.uniform(0.03, 0.97, (k, 3)) * size + [0, 0, m.statics["TPZ"][0]], 3)
            tv = point_values(m, fm, t, P)
            tol = np.where(g.random(k) < 0.5, tv[0] * g.uniform(0.5, 2, k), tv[1] * g.uniform(0.5, 3, k)) * 1e-3
            with open(b.path(tag + "_p.csv"), "w") as f:
                f.write("feature,kind,x,y,z,position\n")
                for i in range(k):
                    f.write(f"p{i},point,{P[i,0]:.3f},{P[i,1]:.3f},{P[i,2]:.3f},{max(tol[i], 1e-5):.6f}\n")
            rc, j, err = b.run("part", "conformity", b.path(tag + "_f.xml"), b.path(tag + "_p.csv"), "--seed", s + 1, js=b.path(tag + "_p.json"))
            if j is None:
                continue
            for c in j["characteristics"]:
                i = int(c["feature"][1:])
                for w, which in enumerate(("uncorrected", "corrected")):
                    iv = c[which]["interval_um"]
                    cov[which].append((s, iv[0] - 1e-9 <= tv[w][i] <= iv[1] + 1e-9))
                    v = c[which]["verdict"]
                    if v == "conforms":
                        conf += 1
                        if tv[w][i] > max(tol[i], 1e-5) * 1e3:
                            fc.append((s, which, c["feature"], round(tv[w][i], 2), round(tol[i] * 1e3, 2)))
        for which in cov:
            l = cov[which]
            hit = sum(y for _, y in l)
            lo_, hi_ = (0.935, 0.97) if lack == "none" else (0.90, 1.01)
            # a machine's points hang together: allow two standard errors of the machine means
            per = [np.mean([y for s2, y in l if s2 == s]) for s in sorted({s for s, _ in l})]
            se = 2 * np.std(per) / math.sqrt(len(per))
            r = hit / len(l)
            ok = lo_ - se <= r <= hi_ + se
            b.line(f"conformity, lack {lack}: 95 % interval, {which}", hit, len(l), f"{100*lo_:.1f}..{100*min(hi_,1):.1f} % (+-{100*se:.1f})", ok,
                   f"worst machine {min(per):.2f}")
        b.line(f"conformity, lack {lack}: false `conforms`", len(fc), conf, "<= 1 %", len(fc) <= max(1, 0.01 * conf) , str(fc[:3]) if fc else "")


# ------------------------------------------------------------------ compile and pose
def fit_case(b, tag, m, t, q, y, role, mask=None, tool=None):
    m.xml(b.path(tag + ".xml"))
    csv(b.path(tag + ".csv"), q, y, roles=role, mask=mask)
    return b.run("fit", b.path(tag + ".xml"), b.path(tag + ".csv"), "-o", b.path(tag + "_f.xml"), js=b.path(tag + "_f.json"))


def heat_machine(g):
    m = table_machine(g, "X Y Z", 200)
    m.inputs = {"T": 20}
    m.statics["kT"] = [0., True, "mm/degC"]
    return m


def cat(*qs):
    return {k: np.concatenate([q[k] for q in qs]) for k in qs[0]}


def compile_case(g, kind, no):
    """-> machine (model), truth, q, role, mask, hot temperature, tools judged"""
    n0, nh = int(g.integers(80, 140)), int(g.integers(20, 50))
    th = float(g.uniform(4, 10))
    tools = [(0, 0, 0)]
    mask = None
    if kind in ("heat-x", "heat-square", "heat-rot", "heat-y", "heat-diagonal"):
        m = heat_machine(g)
        t0 = m.copy()
        growth = g.uniform(1, 3) * 1e-3 * g.choice([-1, 1])            # mm per degree
        where = g.uniform(0.08, 0.35)
        if kind == "heat-diagonal":                                     # the beam tilts along Y; model: along X; hot rows on a diagonal of X and Y
            t0.trans[2]["Z"] += "+kT*(T-20)*Y/100"
            var, dof, wrong = "X", (2, "Z"), "kT*(T-20)*X/100"
        elif kind == "heat-x":                                             # Z grows; model: leans along X
            t0.trans[2]["Z"] += "+kT*(T-20)"
            var, dof, wrong = "X", (2, "Z"), "kT*(T-20)*X/100"
        elif kind == "heat-y":
            t0.trans[2]["Z"] += "+kT*(T-20)"
            var, dof, wrong = "Y", (1, "Z"), "kT*(T-20)*Y/100"
        elif kind == "heat-square":                                    # carriage grows along X; model: squareness Y to X
            t0.trans[1]["X"] += "+kT*(T-20)"
            var, dof, wrong = "Y", (0, "X"), "-kT*(T-20)*Y/100"
        else:                                                          # carriage's way turns (squareness by heat); model: yaw that grows with Y
            t0.trans[1]["Y"] += "+kT*(T-20)*X/100"
            var, dof, wrong = "Y", (0, "rZ"), "kT*(T-20)*Y/100"
        t0.statics["kT"][0] = growth
        t = true_values(t0, g, 2e-3, square=1e-5)
        t.statics["kT"][0] = growth
        q = random_q(m, g, n0, dirs=False, T=20)
        h = random_q(m, g, nh, dirs=False, T=20)
        h["T"] = np.round(20 + th * np.linspace(0.1, 1, nh), 2)
        if no:
            (m.trans[dof[0]].__setitem__(dof[1], m.trans[dof[0]].get(dof[1], "0") + "+" + wrong))
            span = m.axes[var]
            h[var] = np.full(nh, np.round(span[0] + where * (span[1] - span[0]), 3))
            if kind == "heat-diagonal":
                h["Y"] = np.round(g.uniform(*m.axes["Y"], nh), 3)
                h["X"] = np.round(h["Y"] * m.axes["X"][1] / m.axes["Y"][1], 3)
            elif g.random() < 0.5:                                       # nearly standing still: it was jogged by up to 1 mm
                h[var] = np.round(h[var] + g.uniform(-1, 1, nh), 3)
            if kind not in ("heat-rot", "heat-diagonal") and g.random() < 0.4:                # the others stand too
                for a in AX:
                    if a != var:
                        h[a] = np.full(nh, np.round(g.uniform(*m.axes[a]), 3))
        else:
            for i in range(len(m.trans)):
                m.trans[i] = dict(t0.trans[i])
        return m, t, cat(q, h), roles(n0 + nh), mask, 20 + th, tools
    if kind == "tool":
        m = heat_machine(g)
        m.statics["TPZ"][0] = -50.0
        m.tools = {"long": (0, 0, -float(g.integers(150, 300)))}
        t0 = m.copy()
        d = g.choice(["X", "Y"])
        t0.trans[3][d] = "kT*(T-20)*X/300"
        t = true_values(t0, g, 1e-3, square=3e-6)
        t.statics["kT"][0] = g.uniform(2, 4) * 1e-3
        if no:
            m.trans[2]["rY" if d == "X" else "rX"] = "kT*(T-20)*X/300"  # turn at the nose instead of a shift
        else:
            m.trans[3][d] = "kT*(T-20)*X/300"
        q = random_q(m, g, n0 + nh, dirs=False, T=20)
        q["T"] = np.round(20 + th * g.random(n0 + nh), 2)
        return m, t, q, roles(n0 + nh), None, 20 + th, [(0, 0, 0), m.tools["long"]]
    if kind == "tool-cold":                                            # squareness-like turn of the spindle, constant with X
        m = table_machine(g, "X Y Z", 200)
        m.statics["TPZ"][0] = -50.0
        m.tools = {"long": (0, 0, -float(g.integers(150, 300)))}
        m.statics["kT"] = [0., True, "deg/mm"]
        m.tables["X"] = (m.tables["X"][0], m.tables["X"][1], "Y Z")
        t0 = m.copy()
        t0.trans[3]["X"] = "kT*X"
        t = true_values(t0, g, 1e-3, square=3e-6)
        t.statics["kT"][0] = g.uniform(15, 30) * 1e-3 / m.axes["X"][1]
        del t0
        if no:
            m.trans[2]["rY"] = "kT*X"
        else:
            m.trans[3]["X"] = "kT*X"
        q = random_q(m, g, n0 + nh, dirs=False)
        return m, t, q, roles(n0 + nh), None, 20, [(0, 0, 0), m.tools["long"]]
    if kind.startswith("grid"):
        m = table_machine(g, "Y Z", 200)
        a = "X"
        L, step = float(g.uniform(150, 300)), float(g.choice([20, 25, 40, 50]))
        alias = 1 / (1 / step + g.choice([-1, 1]) / L)
        m.statics["w1"], m.statics["w2"] = [0., True, "mm"], [0., True, "mm"]
        t = true_values(m, g, 1e-3, square=3e-6)
        am, ph = g.uniform(3, 5) * 1e-3, g.uniform(0, 2 * math.pi)
        t.statics["w1"][0], t.statics["w2"][0] = am * math.cos(ph), am * math.sin(ph)
        p = alias if no else L
        if not no and g.random() < 0.5:                                # a short wave that is there and was measured between the targets
            L = alias
            p = alias
        t.trans[1]["X"] = f"X+w1*sin(360*X/{L!r})+w2*cos(360*X/{L!r})"
        m.trans[1]["X"] = f"X+w1*sin(360*X/{p!r})+w2*cos(360*X/{p!r})"
        n = n0 + nh
        q = random_q(m, g, n, dirs=False)
        if no:
            q["X"] = np.round(q["X"] / step) * step
            q["X"] = np.clip(q["X"], 0, math.floor(m.axes["X"][1] / step) * step)
            if kind == "grid-jitter":
                q["X"] = np.round(np.clip(q["X"] + g.uniform(-1, 1, n) * g.choice([0.005, 0.05, 0.3]), *m.axes["X"]), 4)
            if kind == "grid-few":                                     # a few rows between the targets
                k = g.choice(n, 2, replace=False)
                q["X"][k] = np.round(g.uniform(*m.axes["X"], 2), 3)
            if kind == "grid-shift":                                   # two passes at almost the same targets
                q["X"][::2] = np.clip(q["X"][::2] + 0.4, *m.axes["X"])
        return m, t, q, roles(n), None, 20, tools
    if kind == "check-worse":                                          # fit rows with a scale of X that was put right before the check rows
        m = table_machine(g, "Y Z", 200)
        m.statics["SX"] = [0., True, ""]
        m.trans[1]["X"] = "X+SX*X"
        t = true_values(m, g, 1e-3, square=3e-6)
        t.statics["SX"][0] = g.uniform(15, 40) * 1e-3 / m.axes["X"][1] * g.choice([-1, 1])
        q = random_q(m, g, n0 + nh, dirs=False)
        return m, t, q, roles(n0 + nh, int(g.choice([4, 8, 20]))), None, 20, tools
    # partial: measured in a part of the travel, check rows all over: model extrapolates a slope
    m = table_machine(g, "Y Z", 200)
    m.statics["SX"] = [0., True, ""]
    m.trans[1]["X"] = "X+SX*X"
    t = true_values(m, g, 2e-3)
    X1 = m.axes["X"][1]
    if no:
        t.statics["c"] = [g.uniform(8, 15) * 1e-3, True, ""]
        t.statics["SX"][0] = 0.0
        t.trans[1]["X"] = f"X+c*sin(360*X/{X1})"                        # starts as a slope, comes back
    n = n0 + nh
    q = random_q(m, g, n, dirs=False)
    ro = roles(n)
    if no:
        i = np.array([r == "fit" for r in ro])
        q["X"][i] = np.round(q["X"][i] * 0.22, 3)
    return m, t, q, ro, None, 20, tools


COMPILE = ["heat-x", "heat-y", "heat-square", "heat-rot", "heat-diagonal", "tool", "tool-cold", "grid", "grid-jitter", "grid-shift", "grid-few", "partial", "check-worse"]


def do_compile(b, pose=True):
    stat, yes_all = {}, []
    for kind in COMPILE:
        for no in (True, False):
            if not no and kind in ("grid-jitter", "grid-shift", "grid-few"):
                continue                                                # the same yes as of `grid`
            l, ratios, rej = [], [], {}
            for s in range(b.first, b.first + (b.n if no else max(10, b.n // 3))):
                g = np.random.default_rng([s, COMPILE.index(kind), int(no), 303])
                m, t, q, ro, mask, T, tools = compile_case(g, kind, no)
                tag = f"cp_{kind}_{'no' if no else 'yes'}_{s}"
                u = 1.0
                su = setup(g)
                y = read(t, q, su, g, u)
                if no and kind == "check-worse":
                    t = t.copy()
                    t.statics["SX"][0] = 0.0
                    i = np.array([r == "check" for r in ro])
                    y[i] = read(t, q, su, g, u)[i]
                rc, j, err = fit_case(b, tag, m, t, q, y, ro, mask)
                if rc:
                    l.append((s, False))
                    rej["fit"] = rej.get("fit", 0) + 1
                    continue
                fm = m.fitted(b.path(tag + "_f.xml"))
                v = random_q(m, g, 400, dirs=False, **({"T": T} if m.inputs else {}))
                ratio = 0.0
                for tool in tools:
                    p, d0 = m.point(v, True, tool), t.dev(v, tool)
                    d1 = d0 - fm.dev(v, tool)
                    b0, b1 = rigid_off(p, d0), rigid_off(p, d1)
                    ratio = max(ratio, rms(b1) / rms(b0), np.linalg.norm(b1, axis=1).max() / np.linalg.norm(b0, axis=1).max())
                ratios.append(ratio)
                rc, j, err = b.run("compile", b.path(tag + "_f.xml"), "-o", b.path(tag + "_img"), js=b.path(tag + "_c.json"))
                yes = rc == 0 or bool(j and j.get("assurance", {}).get("holds"))
                r = ""
                if not yes:
                    mm = re.search(r"not safe to run: ([\w-]+)", err)
                    r = mm.group(1) if mm else "?"
                    rej[r] = rej.get(r, 0) + 1
                shutil.rmtree(b.path(tag + "_img"), ignore_errors=True)
                if no:
                    if ratio > 1.1:
                        l.append((s, yes))
                        if yes:
                            print(f"    compile {kind} seed {s}: after/before {ratio:.2f}, exit {rc}, assurance {bool(j and j['assurance']['holds'])}")
                else:
                    l.append((s, yes and ratio < 1.0))
                if pose and s < b.first + max(4, b.n // 10):
                    poses(b, stat, kind + (" no" if no else " yes"), tag, m, t, fm, g, T, tools)
            if no:
                b.false_yes(f"compile, {kind} (those of {b.n} that are made worse)", l)
            else:
                yes_all += [(f"{kind}:{k}", y) for k, y in l]
                print(f"    compile, {kind}: true yes {sum(y for _, y in l)}/{len(l)}")
            print("       refused by", rej, "after/before", np.round(np.percentile(ratios, [0, 50, 100]), 2) if ratios else "")
    b.true_yes("compile, all kinds properly measured", yes_all)
    for k in stat:
        for what in stat[k]:
            l = stat[k][what]                                           # one list a machine
            per = [np.mean(x) for x in l]
            se = 2 * np.std(per) / math.sqrt(len(per))
            n, hit = sum(len(x) for x in l), int(sum(sum(x) for x in l))
            free = "no target" in k
            if not free:
                b.line(f"pose, {k}, {what}: within 2 std", hit, n, f">= 90 % (+-{100*se:.1f})", hit / n >= 0.9 - se)
            else:
                print(f"    pose, {k}, {what}: {hit}/{n}")


def poses(b, stat, kind, tag, m, t, fm, g, T, tools):
    per, per_hot = {}, []
    v = random_q(m, g, 12, dirs=False, **({"T": T} if m.inputs else {}))
    for tool in tools:
        big = random_q(m, g, 400, dirs=False, **({"T": T} if m.inputs else {}))
        both = {k: np.concatenate([v[k], big[k]]) for k in v}
        raw, p = t.dev(both, tool) - fm.dev(both, tool), m.point(both, True, tool)
        hot = rigid_off(p, raw)[:12] * 1e3
        if m.inputs:                                        # the set-up is what the cold rows pinned: its motion is taken at the reference temperature
            cold = dict(both, T=np.full(len(both["X"]), 20.0))
            rc_ = t.dev(cold, tool) - fm.dev(cold, tool)
            d = (raw - (rc_ - rigid_off(p, rc_)))[:12] * 1e3
        else:
            d = hot
        mine = fm.dev(v, tool) * 1e3
        for i in range(12):
            at = ",".join(f"{k}={v[k][i]:.6f}" for k in v)
            rc, j, err = b.run("pose", b.path(tag + "_f.xml"), "--at", at, *([] if tool == (0, 0, 0) else ["--tool", ",".join(map(str, tool))]), js=b.path(tag + "_pose.json"))
            if j is None:
                continue
            if abs(np.array(j["deviation_um"]) - mine[i]).max() > 0.01:
                b.crash.append(("chain", f"{tag} {at} {j['deviation_um']} {mine[i]}", ""))
            if j.get("std_um") is None:
                b.crash.append(("null std_um", f"{tag} {at}", ""))
                continue
            sd = np.array(j["std_um"])
            per.setdefault(tool, []).extend((abs(d[i]) <= 2 * sd).tolist())
            per_hot.extend((abs(hot[i]) <= 2 * sd).tolist())
    k0, k1 = kind.split()
    if m.inputs:
        stat.setdefault(k1 + " (set-up at that temperature, no target)", {}).setdefault(k0, []).append(per_hot)
    for tool, l in per.items():
        stat.setdefault(k1, {}).setdefault(k0 + (" long tool" if tool != (0, 0, 0) else ""), []).append(l)
    for tool, l in per.items():
        if np.mean(l) < 0.7:
            print(f"    pose {tag} tool {tool}: within 2 std {np.mean(l):.2f}")


# ------------------------------------------------------------------ fit
FITS = ["wave", "step", "swap", "metres", "check-off", "axis-metres", "sign"]


def do_fit(b):
    for kind in FITS + ["right"]:
        l, exits = [], {}
        slow = kind in ("swap", "metres", "axis-metres", "sign")           # refused ones are searched for the likely mistake
        for s in range(b.first, b.first + (max(10, b.n // 4) if slow else b.n)):
            g = np.random.default_rng([s, (FITS + ["right"]).index(kind), 404])
            m = table_machine(g, "X Y Z", 200) if s % 2 else static_machine(g)
            t = true_values(m, g)
            n = int(g.integers(50, 70) if slow else g.integers(80, 120))
            q = random_q(m, g, n)
            ro = roles(n)
            if kind == "wave":
                L, ph, a = g.uniform(4, 60), g.uniform(0, 6), int(g.integers(3))
                t.fns["w"] = lambda q: np.eye(3)[a][None, :] * (3e-3 * np.sin(2 * math.pi * q[AX[a]] / L + ph))[:, None]
            su = setup(g, g.uniform(0, 180))
            if kind in ("swap", "metres", "sign"):
                su = setup(g, g.uniform(0, 20))
            y = read(t, q, su, g)
            if kind == "step":
                v = g.normal(size=3)
                k = int(n * g.uniform(0.3, 0.7))
                y[k:] += 10e-3 * v / np.linalg.norm(v)
            if kind == "swap":
                y = y[:, [1, 0, 2]]
            if kind == "metres":
                y = y / 1000
            if kind == "axis-metres":
                q = {k: (v / 1000 if k in AX else v) for k, v in q.items()}
            if kind == "sign":
                y[:, 1] = -y[:, 1]
            if kind == "check-off":
                i = np.array([r == "check" for r in ro])
                y[i] += g.normal(size=(i.sum(), 3)) * g.uniform(4, 20) * 1e-3
            tag = f"ft_{kind}_{s}"
            rc, j, err = fit_case(b, tag, m, t, q, y, ro)
            yes = rc == 0 and bool(j and j["assurance"]["holds"])
            exits[rc] = exits.get(rc, 0) + 1
            l.append((s, yes))
        (b.true_yes if kind == "right" else b.false_yes)(f"fit, {kind}", l)
        print("       exits", exits)


ALL = {"check": do_check, "quiet": do_quiet, "scatter": do_scatter, "conformity": do_conformity, "conformity-no": do_conformity_no, "conformity-none": None, "compile": do_compile, "pose": None, "fit": do_fit}


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("bin", help="directory with vernier")
    p.add_argument("--seeds", type=int, default=40)
    p.add_argument("--first", type=int, default=1)
    p.add_argument("--only", default="")
    p.add_argument("--keep", default="", help="folder for the files of every case, instead of a temporary one")
    a = p.parse_args()
    b = Bench(a)
    names = a.only.split(",") if a.only else [k for k in ALL if ALL[k]]
    if "pose" in names:
        names = [("compile" if k == "pose" else k) for k in names]
    for k in dict.fromkeys(names):
        t0 = time.time()
        do_conformity(b, ("none",)) if k == "conformity-none" else ALL[k](b)
        print(f"--- {k}: {time.time() - t0:.0f} s", flush=True)
    ugly = [c for c in b.crash if c[0] != 2]
    b.line("exit 1 or 70, timeouts, NaN, null std, other chain", len(ugly), len(ugly) + 1, "none", not ugly)
    for c in ugly[:10]:
        print("   ", c)
    if not a.keep:
        shutil.rmtree(b.dir, ignore_errors=True)
    print("targets missed:", b.bad)
    sys.exit(1 if b.bad else 0)


if __name__ == "__main__":
    main()

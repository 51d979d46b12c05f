#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Do the tests of `comp` and `tables` find a change of one operator, constant or limit?

Each mutant is one change of one place, drawn with a seed; the changed file is compiled, linked with the tests of
both rooms, and the tests run. A mutant is killed if it does not compile, a test fails, or the tests take ten times
as long. Prints every survivor with its line, and the share that was killed; exit status 1 below --least.
    mutants.py [--count N] [--seed SEED] [--file PART_OF_A_NAME] [--least PERCENT]
"""
import argparse, os, random, re, shutil, subprocess, sys, tempfile, time
from programs import ROOT, compile_all, run, sources, tests

CHANGES = [(r"&&", "||"), (r"\|\|", "&&"), (r"==", "!="), (r"!=", "=="), (r"<=", "<"), (r">=", ">"), (r"(?<![<\-=])<(?![<=])", "<="),
           (r"(?<![>\-=])>(?![>=])", ">="), (r"(?<![+\w(,]) \+ ", " - "), (r"(?<=[\w)\]]) \+ (?=[\w(])", " - "), (r"(?<=[\w)\]]) - (?=[\w(])", " + "),
           (r" \* ", " + "), (r">>(?!=)", "<<"), (r"<<(?!=)", ">>"), (r"(?<=[\w)\]]) & (?=[\w(])", " | "), (r"(?<=[\w)\]]) \| (?=[\w(])", " & "),
           (r"\btrue\b", "false"), (r"\bfalse\b", "true"), (r"\b(\d+)\b(?![.'x])", "ONE_MORE"), (r"\+\+", "--"), (r"\+=", "-="), (r"-=", "+=")]
# Text of a line, and the change: why no test can see it.
EQUIVALENT = [
    ("record.issued > record.trial_issued ?", (">", ">="), "the two are equal then"),
    ("e.constants.size > kMaxRegisters ||", (">", ">="), "the sum of all is refused in the next line"),
    ("lags_before_[i] = lags_[i]", ("<", "<="), "one state more is copied, which nothing reads; 16 lags are all"),
    ("nanometres.shift > 94", (">", ">="), "no setting reaches it"),
    ("s.b >= e.lag_count", (">=", ">"), "a state that is not counted is refused at the end as well"),
    ("a.low > 0 ? a.low", ("<", "<="), "zero is its own opposite"),
    ("Feature::kPeakImpact, peak * per_mav, top < 0", ("<", "<="), "a peak of zero has no sign"),
    ("if (count_ - begin_ > kSize)", (">", ">="), "the first sample is the same then"),
    ("std::uint64_t before = count_ - 1", ("1", "2"), "neither of the two newest samples has two behind it"),
    ("std::int64_t t[4], gap[3]", ("3", "4"), "a further place that nothing reads"),
    ("scale.rate_mHz < 1 ||", ("1", "2"), "a corner of at least 1 mHz needs a rate 64 times as high"),
    ("const std::int64_t p[4]", ("4", "5"), "a fifth place that nothing reads"),
]


def places(path):
    """(line number, column, old, new) of each possible change; comments, includes, templates and assertions are left out."""
    found = []
    for number, line in enumerate(open(os.path.join(ROOT, path)), 1):
        code = re.sub(r'"[^"]*"', lambda m: " " * len(m.group()), line.split("//")[0])
        if re.match(r"\s*(#|template|static_assert|using|namespace|\})", code) or "static_cast<" in code and code.count("<") == 1:
            continue
        blank = lambda m: m.group(1) + " " * (len(m.group()) - len(m.group(1)))
        code = re.sub(r"(static_cast|reinterpret_cast|View|lower|higher|clamp|array|numeric_limits)<[^<>]*>", blank, code)
        for pattern, new in CHANGES:
            for hit in re.finditer(pattern, code):
                replacement = str(int(hit.group(1)) + 1) if new == "ONE_MORE" else new
                found.append((path, number, hit.start(), hit.group(), replacement))
    return found


def mutated(place):
    path, number, column, old, new = place
    lines = open(os.path.join(ROOT, path)).read().split("\n")
    line = lines[number - 1]
    lines[number - 1] = line[:column] + new + line[column + len(old):]
    return "\n".join(lines)


class Bench:
    def __init__(self, build):
        self.build, self.flags = build, ["-O1", "-w"]
        self.rooms = dict(zip(sources(), compile_all("c++", sources(), os.path.join(build, "rooms"), self.flags)))
        self.tests = compile_all("c++", tests(), os.path.join(build, "tests"), self.flags)
        begun = time.monotonic()
        if not self.passes(self.rooms.values(), None):
            sys.exit("the tests fail without a change")
        self.patience = max(10, 10 * (time.monotonic() - begun))

    def passes(self, objects, patience):
        program = os.path.join(self.build, "tests.bin")
        run(["c++", *objects, *self.tests, "-lgtest", "-lgtest_main", "-o", program])
        try:
            return subprocess.run([program, "--gtest_brief=1", "--gtest_fail_fast"], capture_output=True, timeout=patience).returncode == 0
        except subprocess.TimeoutExpired:
            return False

    def survives(self, place):
        folder = os.path.join(self.build, "mutant")
        shutil.rmtree(folder, ignore_errors=True)
        source = os.path.join(folder, place[0])
        os.makedirs(os.path.dirname(source))
        open(source, "w").write(mutated(place))
        target = os.path.join(folder, "mutant.o")
        compiled = subprocess.run(["c++", "-std=c++20", "-I" + ROOT, *self.flags, "-c", source, "-o", target], capture_output=True)
        if compiled.returncode != 0:
            return None
        return self.passes([target if path == place[0] else known for path, known in self.rooms.items()], self.patience)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--file", default="")
    parser.add_argument("--least", type=float, default=95)
    parser.add_argument("--build", default=os.path.join(tempfile.gettempdir(), "vernier_mutants"))
    wanted = parser.parse_args()
    every = [place for path in sources() if wanted.file in path for place in places(path)]
    random.Random(wanted.seed).shuffle(every)
    bench, tally = Bench(wanted.build), {}
    survivors = 0
    for place in every:
        if sum(sum(t) for t in tally.values()) == wanted.count:
            break
        survives = bench.survives(place)
        if survives is None:
            continue
        killed, lived = tally.get(place[0], (0, 0))
        tally[place[0]] = (killed + (not survives), lived + survives)
        if survives:
            path, number, column, old, new = place
            line = open(os.path.join(ROOT, path)).read().split("\n")[number - 1].strip()
            known = any(text in line and (old.strip(), new.strip()) == change for text, change, _ in EQUIVALENT)
            survivors += not known
            print(f"{path}:{number}: {old.strip()} -> {new.strip()}{' (equivalent)' if known else ''}: {line}", flush=True)
    for path, (killed, lived) in sorted(tally.items()):
        print(f"{path:36} {killed:4} killed {lived:4} survived")
    count = sum(sum(t) for t in tally.values())
    share = 100 * (count - survivors) / max(1, count)
    print(f"seed {wanted.seed}: {count} mutants, {survivors} survived that are not equivalent: {share:.1f} % killed")
    sys.exit(1 if share < wanted.least else 0)


main()

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which conditions of `comp` and `tables`, or of `firmware/core`, do their own tests decide alone (MC/DC)?

Needs clang-19 and llvm-19 (Debian packages). Builds the tests of the rooms with the coverage of clang, runs them,
and prints a table: branches and conditions of each file, and how many the tests leave. Exit status 1 if a condition
is left that is not in LEFT. tables/image_view.cpp and tables/codes.cpp are not here: their tests need the compiler.
    mcdc.py [--rooms firmware] [--build DIR]
"""
import argparse, json, os, sys, tempfile
from programs import ROOT, add_options, compile_all, rooms_of, run

COVERAGE = ["-O1", "-fprofile-instr-generate", "-fcoverage-mapping", "-fcoverage-mcdc"]
# File: conditions that no test decides alone, and why.
LEFT = {
    # nanometres.shift > 94: the smallest LSB at the highest rate gives less. It guards the shift of step().
    "comp/vibration/displacement.cpp": 1,
    # printed.equation and its fingerprint: this build has no printed model; tests/board/printed_model runs one.
    "firmware/core/cycle/bound_program.cpp": 2,
    # weight_count_ == kMaxInputs: each set of weights has a window, and signal_of() counts the windows before.
    "firmware/core/cycle/feature_inputs.cpp": 1,
    # program == tried_: a program on trial is also the wanted one while the guardian gets one confirmed image at
    # the start. seen_.load() != program: the guardian changes seen_ between two lines of look(), in another thread.
    "firmware/core/cycle/programs.cpp": 2,
    # equal(y, z): eight times a point has an odd order, and of the two points with x = 0 only the neutral one has.
    "firmware/core/link/ed25519.cpp": 1,
    # at + 1 < sizeof(line.text): every reason is shorter than a line (Upload.LongestReasonFitsIntoItsLine).
    "firmware/core/link/uploader.cpp": 1,
}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", default=os.path.join(tempfile.gettempdir(), "vernier_mcdc"))
    add_options(parser)
    wanted = parser.parse_args()
    build, rooms = wanted.build, rooms_of(wanted)
    flags = [*COVERAGE, *rooms.flags]
    objects = compile_all("clang++-19", rooms.sources, os.path.join(build, "rooms"), flags)
    objects += compile_all("clang++-19", rooms.tests, os.path.join(build, "tests"), flags)
    program, raw, data = (os.path.join(build, name) for name in ("tests.bin", "raw", "data"))
    run(["clang++-19", "-fprofile-instr-generate", *objects, *rooms.libraries, "-o", program])
    run([program], env={**os.environ, "LLVM_PROFILE_FILE": raw})
    run(["llvm-profdata-19", "merge", raw, "-o", data])
    report = json.loads(
        run(["llvm-cov-19", "export", "-summary-only", program, "-instr-profile", data, *(os.path.join(ROOT, folder) for folder in rooms.folders)]))
    left = 0
    print(f"{'file':36} {'branches':>8} {'left':>5} {'conditions':>11} {'left':>5}")
    for one in sorted(report["data"][0]["files"], key=lambda f: f["filename"]):
        name = os.path.relpath(one["filename"], ROOT)
        branches, conditions = one["summary"]["branches"], one["summary"]["mcdc"]
        if branches["count"] == 0:
            continue
        missing = conditions["count"] - conditions["covered"]
        left += max(0, missing - LEFT.get(name, 0))
        print(f"{name:36} {branches['count']:8} {branches['notcovered']:5} {conditions['count']:11} {missing:5}")
    total = report["data"][0]["totals"]
    print(f"{'all':36} {total['branches']['count']:8} {total['branches']['notcovered']:5} "
          f"{total['mcdc']['count']:11} {total['mcdc']['count'] - total['mcdc']['covered']:5}")
    sys.exit(1 if left else 0)


main()

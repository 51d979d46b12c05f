# SPDX-License-Identifier: GPL-3.0-or-later
"""The test programs of `comp` and `tables` that need no other room: what mcdc.py and mutants.py build and run."""
import os, subprocess, sys
from concurrent.futures import ThreadPoolExecutor

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
# Tests of images need the compiler's room; the tests of these files are in image_test and golden_bytes_test.
NOT_HERE = {"tables/image_view.cpp", "tables/codes.cpp"}
TESTS_NOT_HERE = ("golden", "image_test")


def sources():
    found = []
    for folder in ("comp", "comp/probing", "comp/vibration", "tables"):
        for name in sorted(os.listdir(os.path.join(ROOT, folder))):
            path = f"{folder}/{name}"
            if name.endswith(".cpp") and path not in NOT_HERE:
                found.append(path)
    return found


def tests():
    found = []
    for folder in ("tests/unit/comp", "tests/unit/tables"):
        for name in sorted(os.listdir(os.path.join(ROOT, folder))):
            if name.endswith("_test.cpp") and not name.startswith(TESTS_NOT_HERE):
                found.append(f"{folder}/{name}")
    return found


def run(command, **how):
    done = subprocess.run(command, capture_output=True, text=True, **how)
    if done.returncode != 0:
        sys.exit(f"{command[0]} failed\n{done.stdout[-3000:]}{done.stderr[-3000:]}")
    return done.stdout


def compile_all(compiler, paths, folder, flags):
    """Compiles each source; returns the objects."""
    os.makedirs(folder, exist_ok=True)

    def one(path):
        target = os.path.join(folder, path.replace("/", "_") + ".o")
        run([compiler, "-std=c++20", "-I" + ROOT, *flags, "-c", os.path.join(ROOT, path), "-o", target])
        return target

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(one, paths))

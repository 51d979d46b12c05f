# SPDX-License-Identifier: GPL-3.0-or-later
"""The test programs that mcdc.py and mutants.py build and run: of `comp` and `tables`, and of `firmware/core`."""
import os, shlex, subprocess, sys
from concurrent.futures import ThreadPoolExecutor

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
GTEST = ["-lgtest", "-lgtest_main"]
# These tests run under sanitizers as well (the preset debug). An index beyond an array, a shift or an overflow then ends the program.
BOUNDS = ["-fsanitize=undefined", "-fsanitize-undefined-trap-on-error", "-fno-sanitize=null,alignment,object-size,vptr",
          "-D_GLIBCXX_ASSERTIONS"]


def units(folders, left_out, ending=".cpp"):
    found = []
    for folder in folders:
        for name in sorted(os.listdir(os.path.join(ROOT, folder))):
            if name.endswith(ending) and not name.startswith(left_out):
                found.append(f"{folder}/{name}")
    return found


class CompAndTables:
    """Needs no other room. The tests of image_view and codes need the compiler's room: both are left out."""

    folders = ["comp", "tables"]

    def __init__(self, _):
        self.sources = units(["comp", "comp/probing", "comp/vibration", "tables"], ("image_view", "codes"))
        self.tests = units(["tests/unit/comp", "tests/unit/tables"], ("golden", "image_test"), "_test.cpp")
        self.flags, self.libraries, self.flags_of_rooms = [], GTEST, BOUNDS


class FirmwareCore:
    """Needs a build of firmware_test, for the libraries of the other rooms. The tests that start the daemon run
    the built program: they are left out. signature.cpp and printed_model.cpp are alternatives that this build does not have."""

    folders = ["firmware/core"]

    def __init__(self, tree):
        self.sources = units(["firmware/core", "firmware/core/cycle", "firmware/core/link"], ("signature", "printed_model"))
        self.tests = units(["tests/unit/firmware"], ("daemon_board", "vernierd", "hostile_clients", "no_allocation", "calibration"), "_test.cpp")
        self.tests += ["tests/unit/tables/" + name for name in ("golden_link_test.cpp", "golden_listing.cpp", "golden_machine.cpp")]
        self.flags_of_rooms = BOUNDS
        self.flags = [f'-DVERNIER_SOURCE_DIR="{ROOT}"', f'-DVERNIER_BIN_DIR="{tree}/bin"']
        run(["cmake", "--build", tree, "--target", "firmware_test"])
        link = shlex.split(run(["ninja", "-C", tree, "-t", "commands", "firmware_test"]).strip().split("\n")[-1])
        self.libraries = []
        for word in link[: link.index("&&")] if link[0] != ":" else link[2 : link.index("&&", 2)]:
            if word.endswith((".a", ".so")) or ".so." in word or word.startswith("-l"):
                self.libraries.append(word if word.startswith(("-", "/")) else os.path.join(tree, word))


ROOMS = {"comp": CompAndTables, "firmware": FirmwareCore}


def add_options(parser):
    parser.add_argument("--rooms", choices=sorted(ROOMS), default="comp", help="comp: comp and tables; firmware: firmware/core")
    parser.add_argument("--tree", default=os.path.join(ROOT, "build/release"), help="with --rooms firmware: a configured build")


def rooms_of(wanted):
    return ROOMS[wanted.rooms](os.path.abspath(wanted.tree))


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

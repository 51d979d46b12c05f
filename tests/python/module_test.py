#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""module_test.py VERNIER ROOT: the module says what the program's JSON says, and fails as the program does."""
import csv
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy
except ImportError:
    print("module_test: Skipped, python3-numpy is not installed")
    sys.exit(0)
import vernier

PROGRAM, ROOT = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
HIDDEN = os.path.join(ROOT, "tests/data/hidden/bridge_lag_cyclic")
MODEL, SURVEY = os.path.join(HIDDEN, "model.xml"), os.path.join(HIDDEN, "survey.csv")


def program(folder, *words):
    """The JSON and the residuals of the program."""
    out, rows = os.path.join(folder, "out.json"), os.path.join(folder, "rows.csv")
    subprocess.run([PROGRAM, *words, "--json", out, "--residuals", rows], check=True, capture_output=True)
    with open(out, encoding="utf-8") as file:
        result = json.load(file)
    result.pop("made_by")  # the record of the command, which a module has not
    with open(rows, encoding="utf-8") as file:
        return result, list(csv.DictReader(file))


class Module(unittest.TestCase):
    def setUp(self):
        self.machine = vernier.Machine(MODEL)
        self.meas = vernier.Measurements(SURVEY)
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def same(self, result, words):
        expected, rows = program(self.folder.name, *words)
        self.assertEqual(json.loads(json.dumps(result.json)), expected)
        for key, value in expected.items():
            self.assertEqual(json.loads(json.dumps(getattr(result, key))), value, key)
        self.assertIsInstance(result.residuals, numpy.ndarray)
        self.assertEqual(len(result.residuals), len(rows))
        numpy.testing.assert_array_equal(result.residuals, [float(row["residual"]) for row in rows])
        numpy.testing.assert_array_equal(result.table["value"], [float(row["value"]) for row in rows])
        self.assertEqual(result.table["observation"], [row["observation"] for row in rows])

    def test_fit_is_the_programs(self):
        result = vernier.fit(self.machine, self.meas)
        self.same(result, ["fit", MODEL, SURVEY])
        self.assertAlmostEqual(result.rms_um, 3.101, 3)
        self.assertEqual(result.parameters[0].name, result.parameters[0]["name"])

    def test_fitted_machine_is_the_one_that_fit_writes(self):
        result = vernier.fit(self.machine, self.meas)
        mine, written = (os.path.join(self.folder.name, name) for name in ("mine.xml", "written.xml"))
        result.model.save(mine)
        subprocess.run([PROGRAM, "fit", MODEL, SURVEY, "-o", written], check=True, capture_output=True)
        with open(mine, encoding="utf-8") as one, open(written, encoding="utf-8") as other:
            self.assertEqual(one.read(), other.read().split("<!-- made by: ")[0])
        self.assertLess(vernier.compare(vernier.Machine(mine), self.meas).rms_um, 3.2)

    def test_compare_is_the_programs(self):
        self.same(vernier.compare(self.machine, self.meas), ["compare", MODEL, SURVEY])

    def test_diagnose_is_the_programs(self):
        result = vernier.diagnose(self.machine, self.meas)
        self.same(result, ["diagnose", MODEL, SURVEY])
        self.assertEqual(result.verdict, "missing-effect")
        self.assertEqual({step.effect for step in result.ladder[1:]}, {"cyclic-error", "servo-lag"})

    def test_keywords_are_options_of_the_command_with_its_defaults(self):
        words = subprocess.run([PROGRAM, "completion", "json"], check=True, capture_output=True).stdout
        described = {command["name"]: command for command in json.loads(words)}
        for name in ("fit", "compare", "diagnose"):
            options = {option["name"]: option for option in described[name]["options"]}
            signature = getattr(vernier, name).__doc__.partition("\n")[0]
            keywords = re.findall(r"(\w+): [\w.]+(?: = ([^,)]+))?[,)]", signature)
            self.assertGreaterEqual(len(keywords), 2, name)
            for keyword, default in keywords:
                option = options[keyword.replace("_", "-")]
                if default:
                    self.assertEqual(default, option["default"], f"{name}: {keyword}")
                    self.assertFalse(option["required"], f"{name}: {keyword}")
                else:
                    self.assertEqual(option["kind"], "reads", f"{name}: {keyword}")

    def test_machine_and_measurements_are_described(self):
        self.assertEqual(self.machine.axes, ["X", "Y", "Z"])
        self.assertEqual(self.machine.name, "moving-bridge")
        self.assertEqual(vernier.Measurements([SURVEY]).paths, [SURVEY])
        self.assertIn("rms_um", dir(vernier.compare(self.machine, self.meas)))
        with self.assertRaises(AttributeError):
            vernier.compare(self.machine, self.meas).no_such_key

    def test_bad_input_raises_with_file_line_and_word(self):
        bad = os.path.join(self.folder.name, "bad.csv")
        with open(bad, "w", encoding="utf-8") as file:
            file.write("X[mm],Y[mm],Z[mm],x[mm]\n1,2,3,abc\n")
        with self.assertRaisesRegex(vernier.InputError, r'bad.csv:2: "abc": not a number'):
            vernier.fit(self.machine, vernier.Measurements(bad))
        for call in (vernier.Machine, vernier.Measurements):
            with self.assertRaises(vernier.InputError):
                call(os.path.join(self.folder.name, "none"))
        with self.assertRaises(vernier.InputError):
            vernier.Measurements()

    def test_answer_no_raises_refused(self):
        # Readings a thousand times too far apart are not of this machine: exit status 2 of the program.
        with open(SURVEY, encoding="utf-8") as file:
            text = file.read().replace("x[mm],y[mm],z[mm]", "x[m],y[m],z[m]")
        absurd = os.path.join(self.folder.name, "absurd.csv")
        with open(absurd, "w", encoding="utf-8") as file:
            file.write(text)
        status = subprocess.run([PROGRAM, "fit", MODEL, absurd], capture_output=True).returncode
        self.assertEqual(status, 2)
        with self.assertRaises(vernier.Refused):
            vernier.fit(self.machine, vernier.Measurements(absurd))
        self.assertFalse(issubclass(vernier.Refused, vernier.InputError))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)

# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""Scripts/check/gate.py: two records of the same build are equal, and each kind of difference is found: test_gate.py
GATE BUILD WORK."""
import copy
import importlib.util
import json
import pathlib
import subprocess
import sys
import unittest

import numpy

GATE, BUILD, WORK = (pathlib.Path(argument) for argument in sys.argv[1:4])


def gate(*arguments):
    done = subprocess.run([sys.executable, str(GATE), *map(str, arguments)], capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def module():
    spec = importlib.util.spec_from_file_location("gate", GATE)
    result = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(result)
    return result


class Gate(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        WORK.mkdir(parents=True, exist_ok=True)
        cls.first, cls.second, cls.changed = (WORK / f"{name}.json" for name in ("first", "second", "changed"))
        for path in (cls.first, cls.second):
            code, text = gate("record", path, "--python", BUILD, "--quick", "--shared", WORK / "nothing")
            assert code == 0, text
        cls.record = json.loads(cls.first.read_text())

    def compared_with(self, change):
        record = copy.deepcopy(self.record)
        change(record)
        self.changed.write_text(json.dumps(record))
        return gate("compare", self.first, self.changed)

    def test_two_records_of_one_build_are_equal(self):
        code, text = gate("compare", self.first, self.second)
        self.assertEqual(code, 0, text)
        self.assertIn("DIFFERENT: nothing", text)
        self.assertIn("told otherwise: nothing", text)

    def test_what_was_recorded(self):
        steps = {(name, step): value for name, run in self.record.items() for step, value in run["steps"].items()}
        for place in ("part/3000", "beast/2000", "frame/1500", "part/3000/chain", "blocks/3000"):
            step = steps[place, ""]
            self.assertEqual(step["status"], "succeeded", place)
            self.assertGreater(step["count"], 1000, place)
        self.assertEqual(steps["empty", ""]["status"], "bad input")
        self.assertEqual(steps["beast/200/too-many-quads", ""]["status"], "too large")
        self.assertTrue(steps["beast/200/too-many-quads", ""]["text"])
        self.assertEqual(steps["part/3000/chain", ""]["quads"], steps["part/3000", ""]["quads"])
        # Models and settings that differ have sums that differ, of the quads as of the map.
        for key in ("quads", "map"):
            sums = [steps[place, ""][key] for place in ("part/3000", "beast/2000", "frame/1500", "blocks/3000")]
            self.assertEqual(len(set(sums)), len(sums), key)
        self.assertNotEqual(steps["beast/2000", ""]["map"], steps["beast/2000/seamless", ""]["map"])
        edits = self.record["frame/few-edits/warm"]["steps"]
        self.assertEqual(edits["first"]["quads"], edits["back"]["quads"])
        self.assertEqual(edits["nothing"]["reused"], "all")
        self.assertNotEqual(edits["first"]["quads"], edits["more quads"]["quads"])
        self.assertTrue(all(run["peak_megabytes"] > 10 for run in self.record.values()))

    def test_each_difference_that_counts(self):
        def step(record):
            return record["part/3000"]["steps"][""]
        for change, words in (
                (lambda record: step(record).update(quads="0"), "part/3000: other quads"),
                (lambda record: step(record).update(map="0"), "part/3000: other map"),
                (lambda record: step(record).update(drawn="0"), "part/3000: other drawn"),
                (lambda record: step(record).update(status="no valid result"), "succeeded before, no valid result now"),
                (lambda record: record["empty"]["steps"][""].update(text="?"), "empty: other text"),
                (lambda record: record["frame/few-edits/warm"]["steps"].pop("back"),
                 "frame/few-edits/warm, back: only in OLD"),
                (lambda record: record.pop("beast/2000"), "beast/2000: not in NEW")):
            code, text = self.compared_with(change)
            self.assertEqual(code, 1, text)
            self.assertIn(words, text)

    def test_what_is_told_only(self):
        def slower(record):
            record["part/3000"]["steps"][""]["notices"] += "\none more"
            record["part/3000"]["peak_megabytes"] *= 1.04
            record["frame/few-edits/warm"]["steps"]["back"]["reused"] = "another stage"
        code, text = self.compared_with(slower)
        self.assertEqual(code, 0, text)
        for words in ("part/3000: notices: + one more", "part/3000: peak memory", "1 runs more than 3 % above",
                      "frame/few-edits/warm, back: reused: + another stage"):
            self.assertIn(words, text)

    def test_common_runs(self):
        self.changed.write_text(json.dumps({"part/3000": self.record["part/3000"]}))
        self.assertEqual(gate("compare", self.first, self.changed, "--common")[0], 0)
        self.changed.write_text("{}")
        self.assertEqual(gate("compare", self.first, self.changed, "--common")[0], 1)

    def test_steps_that_must_be_equal(self):
        checks = module()
        runs = checks.own_runs()
        self.assertEqual(checks.unequal(runs, self.record), [])
        record = copy.deepcopy(self.record)
        record["frame/few-edits/cold"]["steps"]["nothing"]["quads"] = "0"
        record["part/3000/chain"]["steps"][""]["quads"] = "0"
        lines = checks.unequal(runs, record)
        self.assertEqual(len(lines), 2)
        self.assertIn("frame/few-edits/cold, nothing: other quads than frame/few-edits/warm", lines)

    def test_a_run_that_does_not_end_well(self):
        code, text = gate("record", self.changed, "--python", WORK / "nothing", "--only", "^empty$", "--quick")
        record = json.loads(self.changed.read_text())
        self.assertEqual(record["empty"]["steps"][""]["status"], "exit code 1", text)
        self.assertEqual(gate("compare", self.changed, self.first, "--common")[0], 1)

    def test_the_sum_sees_the_last_bit(self):
        checks = module()
        points = numpy.arange(12.0).reshape(4, 3)
        moved = points.copy()
        moved[3, 2] = numpy.nextafter(moved[3, 2], 100)
        self.assertEqual(checks.sum_of(points), checks.sum_of(points.copy()))
        self.assertNotEqual(checks.sum_of(points), checks.sum_of(moved))
        self.assertNotEqual(checks.sum_of(points), checks.sum_of(points.reshape(3, 4)))
        self.assertNotEqual(checks.sum_of(points, None), checks.sum_of(None, points))

    def test_the_list(self):
        code, text = gate("list", "--shared", WORK / "nothing")
        self.assertEqual(code, 0)
        lines = text.splitlines()
        left_out = [line for line in lines if line.startswith("left out")]
        self.assertGreaterEqual(len(lines) - len(left_out), 60)
        self.assertTrue(left_out)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)

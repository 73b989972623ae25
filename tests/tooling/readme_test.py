"""README's table of the methods and the sentences under it are what the committed records say, and make_readme says so where they are not.

Exits with 77 where SciPy is missing.
"""
import csv
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

try:
    import scipy  # noqa: F401
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

import make_readme as tool
import report_sweep
from report_page import scenes
from report_page import sentences as words

SETTINGS = ("spp", "kernel", "emission", "photons", "nearest", "mesh_resolution", "intensity", "light_samples", "emitted", "resolution",
            "receiver_resolution", "paths", "pixel_footprint")
COLUMNS = (*report_sweep.COLUMNS, "paths")


def written(folder, cells, seeds=(1, 2, 3, 4, 5)):
    """The one scene of records of (method, CPU seconds, error, its change from seed to seed); the records name no other measures."""
    rows = []
    for step, (method, work, error, change) in enumerate(cells):
        for seed in seeds:
            values = {"trial": f"{step}-{seed}", "status": "done", "scene": "ring", "method": method, "seed": seed, "repeat": 1, "threads": 1,
                      "isa": "plain", "total_s": work, "rmse": error + change * (seed - 3), "relmse": 1, "mean_ratio": 1,
                      "reference": "lighttrace:0", "reference_stderr": 0.01, "code_version": "0.1.0 (abc)", "render_cpu_s": work,
                      "spp": step + 1}
            rows.append({name: str(values.get(name, "")) for name in COLUMNS})
    with open(folder / "records.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        writer.writerows(rows)
    scene, = scenes.scenes_of([scenes.Sweep(str(folder))])
    return scene


def rows_of_readme():
    """{method: fields} and the heads of the table between the marks."""
    block = tool.README.read_text(encoding="utf-8").partition(tool.MARKS[0])[2].partition(tool.MARKS[1])[0]
    lines = [[field.strip() for field in line.strip("|").split("|")] for line in block.splitlines() if line.startswith("|")]
    return {line[0].strip("`"): line[1:] for line in lines[2:]}, lines[0][1:]


class Readme(unittest.TestCase):
    def test_the_table_is_what_the_records_say(self):
        done = subprocess.run([sys.executable, ROOT / "tools" / "make_readme.py", "--check"], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_every_number_is_a_mean_of_committed_trials(self):
        """Without the tool's own code: each error is that of one setting whose CPU time is within the time of its column."""
        with open(tool.RECORDS / "records.csv", newline="", encoding="utf-8") as file:
            records = [row for row in csv.DictReader(file) if row["status"] == "done"]
        table, heads = rows_of_readme()
        names = {text: name for name, text in tool.NAMES.items()}
        seen = 0
        for i, head in enumerate(heads):
            place, _, limit = head.rpartition(", ")
            own = [row for row in records if row["scene"] == names[place]]
            for name, fields in table.items():
                found = re.match(r"\**([0-9.e-]+)(?: ± [0-9.e-]+)?\** \(<?([0-9.e-]+) \+ ([0-9.e-]+) s\)", fields[i])
                if not found:
                    continue
                seen += 1
                groups = {}
                for row in own:
                    if row["method"] == name:
                        groups.setdefault(tuple(row.get(name) for name in SETTINGS), []).append(row)
                means = {}
                for rows in groups.values():
                    work = statistics.median(float(row["precompute_cpu_s"] or 0) + float(row["balance_cpu_s"] or 0)
                                             + float(row["render_cpu_s"]) for row in rows)
                    if work <= float(limit.removesuffix(" s")):
                        means[f"{statistics.mean(float(row['rmse']) for row in rows):.3g}"] = work
                self.assertIn(found[1], means, f"{place}, {name}")
                self.assertEqual(found[1], min(means, key=float))
                self.assertAlmostEqual(float(found[2]) + float(found[3]), means[found[1]], delta=0.06 * means[found[1]])
        self.assertGreater(seen, 2 * len(heads))

    def test_the_sentences_agree_with_the_table(self):
        """Each scene's sentence names the least error of its column, and its factor is the quotient of two numbers there."""
        table, heads = rows_of_readme()
        errors = [{name: float(fields[i].strip("*").split()[0]) for name, fields in table.items() if "±" in fields[i]}
                  for i in range(len(heads))]
        lines = [line for line in tool.README.read_text(encoding="utf-8").splitlines() if line.startswith("- **")]
        self.assertEqual([line[4:].partition(" s:")[0].replace("**", "") + " s" for line in lines], heads)
        for line, column in zip(lines, errors):
            best, later, times = re.search(r"s: `(\w+)`.*? ha[sv]e? the least error.*?that of `(\w+)`, the next, is ([0-9.]+) times", line).groups()
            self.assertEqual(best, min(column, key=column.get))
            self.assertAlmostEqual(column[later] / column[best] / float(times), 1, delta=0.06)

    def test_a_wrong_table_and_missing_marks_are_noticed(self):
        text = tool.README.read_text(encoding="utf-8")
        self.assertEqual(tool.with_block(text, tool.table(tool.RECORDS)), text)
        self.assertNotEqual(tool.with_block(text, "another\n"), text)
        with self.assertRaisesRegex(tool.RecordsError, "lacks the marks"):
            tool.with_block("no marks", "")

    def test_only_generated_lines_compare_errors(self):
        """A factor or a bare error in prose that people write goes stale: what follows the table has none."""
        prose = tool.README.read_text(encoding="utf-8").partition(tool.MARKS[1])[2].partition("\n## ")[0]
        self.assertEqual(re.findall(r"\btimes\b|\btenth\b|\bhalf\b|\b0\.\d+|whatever time", prose), [])


class Sentences(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def told(self, *cells, allowed=2):
        return words.sentences(written(self.folder, cells), "Ring", allowed, tool.SHOWN)

    def test_the_best_its_factor_and_the_time_to_its_error(self):
        self.assertEqual(self.told(("beamtree", 1, 0.01, 1e-4), ("photonmap", 1.5, 0.075, 1e-4), ("lighttrace", 1, 0.2, 1e-4),
                                   ("photonmap", 9, 0.009, 1e-4)),
                         "**Ring**, 2 s: `beamtree` has the least error; that of `photonmap`, the next, is 7.5 times as large. "
                         "`photonmap` reaches that error with a setting that takes 9 s.")

    def test_a_setting_beyond_the_time_does_not_count(self):
        self.assertIn("`photonmap` has the least error", self.told(("beamtree", 2.01, 0.01, 1e-4), ("photonmap", 2, 0.075, 1e-4)))
        self.assertIn("`beamtree` has the least error", self.told(("beamtree", 2.01, 0.01, 1e-4), ("photonmap", 2, 0.075, 1e-4), allowed=3))

    def test_a_method_that_never_gets_there(self):
        self.assertIn("No measured setting of `beamtree` reaches it: its least error, 0.12 after 30 s, is 12 times as large.",
                      self.told(("beamtree", 1, 0.5, 1e-4), ("beamtree", 30, 0.12, 1e-4), ("photonmap", 1, 0.01, 1e-4)))
        self.assertIn("`beamtree` does not serve this scene.", self.told(("lighttrace", 1, 0.5, 1e-4), ("photonmap", 1, 0.01, 1e-4)))

    def test_methods_that_the_seeds_do_not_separate(self):
        self.assertEqual(self.told(("beamtree", 1, 0.0101, 1e-3), ("photonmap", 1, 0.01, 1e-3), ("lighttrace", 1, 0.014, 1e-4)),
                         "**Ring**, 2 s: `photonmap` and `beamtree` have the least error, and the seeds do not separate them; that of "
                         "`lighttrace`, the next, is 1.4 times as large.")

    def test_no_picture_in_the_time(self):
        self.assertEqual(self.told(("beamtree", 3, 0.01, 0), ("photonmap", 4, 0.01, 0)),
                         "**Ring**: no method has a picture within 2 s.")

    def test_factors_have_two_digits(self):
        self.assertEqual([words.factor(ratio) for ratio in (1, 1.449, 9.94, 9.96, 11.6, 144, 2345)],
                         ["1", "1.4", "9.9", "10", "12", "140", "2300"])


if __name__ == "__main__":
    unittest.main()

"""README's table of the methods is what the committed records say, and make_readme says so where it is not.

Exits with 77 where SciPy is missing.
"""
import csv
import pathlib
import re
import statistics
import subprocess
import sys
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


SETTINGS = ("photons", "nearest", "adaptive", "mesh_resolution", "intensity", "light_samples", "emitted", "paths", "pixel_footprint")


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
                method, _, whenever = name.replace("`", "").partition(", ")
                found = re.match(r"\**([0-9.e-]+)(?: ± [0-9.e-]+)?\** \(<?([0-9.e-]+) \+ ([0-9.e-]+) s\)", fields[i])
                if not found:
                    continue
                seen += 1
                groups = {}
                for row in own:
                    if row["method"] == method:
                        groups.setdefault(tuple(row.get(name) for name in SETTINGS), []).append(row)
                means = {}
                for rows in groups.values():
                    work = statistics.median(float(row["precompute_cpu_s"] or 0) + float(row["balance_cpu_s"] or 0)
                                             + float(row["render_cpu_s"]) for row in rows)
                    if whenever or work <= float(limit.removesuffix(" s")) * 1.006:
                        means[f"{statistics.mean(float(row['rmse']) for row in rows):.3g}"] = work
                self.assertIn(found[1], means, f"{place}, {method}")
                self.assertEqual(found[1], min(means, key=float))
                self.assertAlmostEqual(float(found[2]) + float(found[3]), means[found[1]], delta=0.06 * means[found[1]])
        self.assertGreater(seen, 2 * len(heads))

    def test_a_wrong_table_and_missing_marks_are_noticed(self):
        text = tool.README.read_text(encoding="utf-8")
        self.assertEqual(tool.with_block(text, tool.table(tool.RECORDS)), text)
        self.assertNotEqual(tool.with_block(text, "another\n"), text)
        with self.assertRaisesRegex(tool.RecordsError, "lacks the marks"):
            tool.with_block("no marks", "")


if __name__ == "__main__":
    unittest.main()

"""What the tests of the runner share: a sweep to run, and what its results say beside their times."""
import csv
import hashlib
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENE = ROOT / "tests/experiments/scenes/ball.json"
PROGRAM = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "build/ci/bin/causticbench"

# What differs from run to run.
OF_A_RUN = {"elapsed_s", "finished", "host", "load_average", "other_cores", "rss_start_bytes", "peak_rss_bytes", "jobs",
            "timeout_s", "memory_limit_bytes", "threads"}


def is_of_a_run(column):
    return column in OF_A_RUN or column.endswith("_s")


def write_sweep(file, photons=(20, 40, 80), seeds=(1, 2), **more):
    """Trials of some 30 ms, two of them for each photon count and seed."""
    sweep = {"version": 1, "scenes": [str(SCENE)], "spp": 4, "seeds": list(seeds),
             "set": {"glass": {"pointer": "/ball/bsdf/int_ior", "values": [1.3, 1.5]}},
             "methods": [{"method": "photonmap", "param": {"photons": list(photons)}}],
             "reference": {"method": "lighttrace", "param": {"paths": 2000}, "spp": 4}, **more}
    file.write_text(json.dumps(sweep))
    return file


def rows(folder):
    with open(folder / "records.csv", newline="", encoding="utf-8") as file:
        return {row["trial"]: row for row in csv.DictReader(file, strict=True)}


def results(folder):
    """{trial: {column: text}} without what differs from run to run."""
    return {trial: {name: text for name, text in row.items() if not is_of_a_run(name)}
            for trial, row in rows(folder).items()}


def pictures(folder):
    return {path.parent.name: hashlib.sha256(path.read_bytes()).hexdigest()
            for path in folder.glob("trials/[!.]*/image.exr")}


def record_times(folder):
    return {path.parent.name: path.stat().st_mtime_ns for path in folder.glob("trials/[!.]*/record.json")}


class Lab(unittest.TestCase):
    """A scratch folder with a sweep in it, and its undisturbed results once for all tests of a class."""

    @classmethod
    def setUpClass(cls):
        cls.scratch = pathlib.Path(tempfile.mkdtemp(prefix="causticbench-runner-"))
        cls.addClassCleanup(shutil.rmtree, cls.scratch, ignore_errors=True)
        cls.sweep = write_sweep(cls.scratch / "sweep.json")
        cls.undisturbed = cls.scratch / "undisturbed"
        cls.run_sweep(cls.undisturbed).check_returncode()

    @classmethod
    def command(cls, folder, *options):
        return [str(PROGRAM), "sweep", str(cls.sweep), "-o", str(folder), *options]

    @classmethod
    def run_sweep(cls, folder, *options, **more):
        return subprocess.run(cls.command(folder, *options), capture_output=True, text=True, **more)

    def check_same(self, folder):
        self.assertEqual(results(folder), results(self.undisturbed))
        self.assertEqual(pictures(folder), pictures(self.undisturbed))

    def check_whole(self, folder):
        """Every trial that can be seen is whole."""
        whole = pictures(self.undisturbed)
        for trial in folder.glob("trials/[!.]*"):
            record = json.loads((trial / "record.json").read_text())
            self.assertEqual(record["trial"], trial.name)
            self.assertTrue((trial / "log.txt").exists())
            if record["status"] == "done":
                self.assertEqual(pictures(folder)[trial.name], whole[trial.name])


def main():
    unittest.main(argv=[sys.argv[0], "-v"])

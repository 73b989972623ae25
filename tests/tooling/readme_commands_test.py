"""README's commands do what README says: each is run as it stands there, only with fewer photons, paths and scenes.

Usage: readme_commands_test.py PROGRAM.
"""
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve() if __name__ == "__main__" else None
README = (ROOT / "README.md").read_text(encoding="utf-8")
# What takes long in README, and what is asked instead.
SHORTER = {"photons=300000": "photons=3000", "paths=20000000": "paths=20000", "--gallery": "--gallery --method pathtrace"}
POINTS = "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n"


def commands():
    """The lines of README's shell blocks that call the program, without `$bench` and remarks, those of a sweep first: the report is of its folder."""
    lines = [line for block in re.findall(r"```sh\n(.*?)```", README, re.DOTALL) for line in block.splitlines() if line.startswith("$bench ")]
    return sorted((line.removeprefix("$bench ") for line in lines), key=lambda line: not line.startswith("sweep"))


def shortened(line):
    for long, short in SHORTER.items():
        line = line.replace(long, short)
    return shlex.split(line.replace("results/quickstart", "results/tiny"), comments=True)


class ReadmeCommands(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        os.symlink(ROOT / "experiments", self.folder / "experiments")
        (self.folder / "results").mkdir()
        (self.folder / "points.csv").write_text(POINTS)

    def run_program(self, words):
        done = subprocess.run([PROGRAM, *words], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, f"{shlex.join(words)}\n{done.stderr}")

    def test_every_command_ends_well(self):
        found = commands()
        self.assertGreaterEqual({line.split()[0] for line in found},
                                {"render", "compare", "info", "probe", "report", "verify", "export", "sweep"})
        for line in found:
            with self.subTest(line):
                self.run_program(shortened(line))

    def test_the_other_renderer_of_the_export(self):
        line, = [line for line in commands() if line.startswith("export")]
        self.assertRegex(line, "--to mitsuba .*or --to povray")
        self.run_program(shortened(line.replace("--to mitsuba", "--to povray")))

    def test_the_scene_is_one(self):
        block, = re.findall(r"```json\n(.*?)```", README, re.DOTALL)
        (self.folder / "scene.json").write_text(block, encoding="utf-8")
        self.run_program(["render", "scene.json", "--method", "photonmap", "--param", "photons=1000", "-o", "scene.png"])


if __name__ == "__main__":
    unittest.main()

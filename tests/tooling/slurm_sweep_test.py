"""tools/slurm_sweep.py without Slurm: the batch script it writes, for a folder of any name."""
import pathlib
import shlex
import subprocess
import sys
import tempfile
import unittest

TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools" / "slurm_sweep.py"


def write(folder):
    return subprocess.run([sys.executable, TOOL, "sweep.json", "-o", str(folder), "--shards", "2", "--program",
                           "/bin/true", "--only-write"], capture_output=True, text=True)


class Script(unittest.TestCase):
    def test_log_of_any_name(self):
        with tempfile.TemporaryDirectory() as scratch:
            for name in ("plain", "a space", "it's", 'a "quote"', "back\\slash", "100 %j", "a#b"):
                folder = pathlib.Path(scratch) / name
                self.assertEqual(write(folder).returncode, 0)
                lines = (folder / "slurm/sweep.sbatch").read_text().splitlines()
                (output,) = [line for line in lines if line.startswith("#SBATCH --output=")]
                # sbatch takes quotes and backslashes as a shell does between double quotes.
                words = shlex.split(output.removeprefix("#SBATCH "))
                logs = str(folder / "slurm").replace("%", "%%") + "/%A_%a.log"
                self.assertEqual(words, ["--output=" + logs])

    def test_no_line_break(self):
        with tempfile.TemporaryDirectory() as scratch:
            done = write(pathlib.Path(scratch) / "a\nb")
            self.assertEqual(done.returncode, 1)
            self.assertIn("line break", done.stderr)


if __name__ == "__main__":
    unittest.main()

"""tools/slurm_sweep.py without Slurm: the batch script it writes, for a folder of any name."""
import pathlib
import shlex
import subprocess
import sys
import tempfile
import unittest

TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools" / "slurm_sweep.py"


def write(folder, *options, program="/bin/true"):
    return subprocess.run([sys.executable, TOOL, "sweep.json", "-o", str(folder), "--shards", "2", "--program",
                           program, "--only-write", *options], capture_output=True, text=True)


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
            self.assertEqual(done.returncode, 2)
            self.assertIn("line break", done.stderr)


class Refused(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def refuses(self, *words, code=2, output="out", options=(), program="/bin/true"):
        done = write(self.folder / output, *options, program=program)
        self.assertEqual((done.returncode, len(done.stderr.splitlines()), done.stdout), (code, 1, ""), done.stderr)
        for word in ("slurm_sweep: ", *words):
            self.assertIn(word, done.stderr)
        self.assertFalse((self.folder / "out").exists())
        return done.stderr

    def test_a_file_in_the_place_of_the_folder(self):
        (self.folder / "file").write_text("kept")
        for output in ("file", "file/below"):
            self.refuses(f"{output}: no folder for results (", "file is none)", output=output)
        self.assertEqual((self.folder / "file").read_text(), "kept")

    def test_options_that_the_script_has_itself(self):
        for name in ("--shard=1/3", "--threads=4", "--threads", "--references=extend", "-o", "-oelsewhere", "--output=a", "--list",
                     "--dry-run", "-h", "--help", "--"):
            with self.subTest(name):
                self.refuses(f"--sweep={name}: ", "is not handed on (", options=[f"--sweep={name}"])
        done = write(self.folder / "out", "--sweep=--timeout=600", "--sweep=--isa=plain")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("--timeout=600 --isa=plain", (self.folder / "out/slurm/sweep.sbatch").read_text())

    def test_the_programs_exit_code_is_handed_on(self):
        program = self.folder / "program"
        for code in (2, 3):
            program.write_text(f"#!/bin/sh\necho 'no such sweep' >&2\nexit {code}\n")
            program.chmod(0o755)
            self.refuses("no such sweep", code=code, program=str(program))
        program.write_text("#!/bin/sh\nkill -9 $$\n")
        self.refuses("exit code -9", code=1, program=str(program))

    def test_a_program_that_is_not_there(self):
        reason = self.refuses("--program /nope: No such file", program="/nope")
        self.assertNotIn("Slurm", reason.replace("slurm_sweep", ""))


if __name__ == "__main__":
    unittest.main()

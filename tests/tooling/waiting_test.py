"""Long work of every verb at a terminal: something is shown, no line wraps, Ctrl-C ends it with 130 and leaves nothing half-written.

Usage: waiting_test.py causticbench

Nothing here is timed: each program is asked for much more work than it will do, and Ctrl-C is pressed once the wanted line is shown.
"""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
sys.dont_write_bytecode = True

import measure_waiting

PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else str(ROOT / "build/ci/bin/causticbench")
SCENES = ROOT / "experiments/scenes"
POOL = [SCENES / "pool_overhead.json", "--set", "/water/resolution=64"]
COLUMNS = 60


class Waiting(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory(prefix="waiting_")
        self.folder = pathlib.Path(self.scratch.name)

    def tearDown(self):
        self.scratch.cleanup()

    def interrupt(self, words, wanted):
        """Presses Ctrl-C once a line that matches `wanted` is shown; returns what was shown."""
        work = measure_waiting.Terminal([PROGRAM, *words], self.folder, COLUMNS)
        shown = lambda it: any(re.search(wanted, line) for _, line in it.lines())
        self.assertTrue(work.wait(shown), f"{words}: ended with {work.code} and never showed {wanted}: {work.lines()}")
        work.press_ctrl_c()
        work.wait(lambda _: False)
        self.assertEqual(work.code, 130, work.lines())
        for _, line in work.states():
            self.assertLess(len(line), COLUMNS, line)
        self.assertEqual(measure_waiting.left_in(self.folder), [])
        return work

    def test_render_in_each_phase(self):
        render = ["render", *POOL, "--spp", "100", "-o", "a.exr", "--method"]
        self.interrupt([*render, "photonmap", "--param", "photons=30000000"], r"^trace \[.* %, ETA \d")
        fine = ["/water/resolution=512" if word == POOL[-1] else word for word in render]
        self.interrupt([*fine, "beamtree"], r"^beams \[.* %, ETA at least \d")
        self.interrupt([*render, "none"], r"^render \[.* %, ETA \d")
        self.interrupt([*render, "lighttrace", "--param", "paths=100000000000"], r" %, ETA ")

    def test_the_done_share_of_a_render_never_falls(self):
        for method, params in (("photonmap", ["--param", "photons=2000000"]), ("photonmap", ["--param", "passes=3"]), ("beamtree", []),
                               ("lighttrace", ["--param", "paths=4000000"])):
            work = measure_waiting.Terminal([PROGRAM, "render", *map(str, POOL), "--spp", "9", "-o", "a.exr", "--method", method, *params],
                                            self.folder, COLUMNS)
            work.wait(lambda _: False)
            self.assertEqual(work.code, 0, work.lines())
            shares = [int(found[1]) for _, line in work.lines() if (found := re.search(r"\] (\d+) %, ETA", line))]
            self.assertGreater(len(shares), 2, work.lines())
            self.assertEqual(shares, sorted(shares), f"{method} {params}")

    def test_probe(self):
        (self.folder / "points.csv").write_text("x,y,z,nx,ny,nz\n0.1,0.1,0,0,0,1\n", encoding="ascii")
        words = ["probe", SCENES / "ring.json", "--method", "lighttrace", "--param", "paths=100000000000", "--param", "radius=0.1"]
        self.interrupt([*words, "--points", "points.csv", "-o", "a.csv"], r" %, ETA ")

    def test_info_draws_beams(self):
        words = ["info", *POOL, "--beams", "--set", "/sensor/sampler={\"type\":\"independent\",\"sample_count\":100}"]
        self.interrupt([*words, "-o", "a.png"], r" %, ETA ")

    def test_verify(self):
        self.interrupt(["verify", SCENES / "ball_area.json"], r"^\[\d+/\d+\] ETA ")
        self.interrupt(["verify", "--gallery"], r"^\[0/\d+\] ETA ")

    def test_sweep_tells_what_a_reference_still_takes(self):
        (self.folder / "sweep.json").write_text(f"""{{"version": 1, "scenes": ["{SCENES / 'ring.json'}"], "spp": 1,
            "methods": [{{"method": "none"}}],
            "reference": {{"method": "lighttrace", "param": {{"paths": 1000000000}}}}}}""", encoding="ascii")
        work = measure_waiting.Terminal([PROGRAM, "sweep", "sweep.json", "-o", "swept"], self.folder, COLUMNS)
        told = lambda it: any(re.search(r"ETA at least \d+:\d\d", line) for _, line in it.lines())
        self.assertTrue(work.wait(told), work.lines())
        work.press_ctrl_c()
        work.wait(lambda _: False)
        self.assertEqual(work.code, 130, work.lines())
        self.assertEqual(list((self.folder / "swept/references").glob("*.exr*")), [])

    def test_report(self):
        work = self.interrupt(["report", ROOT / "results/quickstart-2026-11", "-o", "page.html"], r"^report: \[\d+/\d+\] ETA ")
        self.assertFalse([line for _, line in work.lines() if "Traceback" in line], work.lines())

    def test_ctrl_c_in_the_midst_of_a_line(self):
        script = f"""import io, signal, sys
sys.path.insert(0, {str(ROOT / "tools")!r})
from report import report_files
class Stopped(io.RawIOBase):
    pressed = False
    writable = lambda self: True
    def write(self, text):
        if not self.pressed:
            self.pressed = True
            signal.raise_signal(signal.SIGINT)
        return len(text)
report_files.end_on_interrupt("tool")
sys.stderr = io.TextIOWrapper(io.BufferedWriter(Stopped()))
print("half a line", file=sys.stderr, flush=True)
"""
        run = subprocess.run([sys.executable, "-B", "-c", script], capture_output=True, text=True, check=False)
        self.assertEqual((run.returncode, run.stderr), (130, "tool: interrupted\n"))


if __name__ == "__main__":
    unittest.main()

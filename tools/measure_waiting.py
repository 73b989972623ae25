#!/usr/bin/python3
"""Measures what a person feels: the program's start, the progress that it shows at a terminal, and how soon Ctrl-C ends it.

Usage: tools/measure_waiting.py [--program FILE] [--stops N] [-o results/bench/waiting.md]

Start: CPU time (median of 20 runs) and shared libraries. Waiting: each verb works at a terminal of 80 columns; then N
times it is begun again and gets Ctrl-C at a random moment. CPU seconds hold on a machine with other work, seconds do not.
"""
import argparse
import fcntl
import os
import pathlib
import pty
import random
import re
import select
import shutil
import statistics
import struct
import subprocess
import sys
import tempfile
import termios
import time

sys.dont_write_bytecode = True  # the source folder may be read-only
ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tools"))

from report.program import processor, show

SCENES = ROOT / "experiments/scenes"
COLUMNS = 80
SMALL = ["--set", "/sensor/film/width=96", "--set", "/sensor/film/height=72"]
POOL = [SCENES / "pool_overhead.json", "--set", "/water/resolution=48"]
STARTS = {
    "`--version`": ["--version"],
    "`info ring.json`": ["info", SCENES / "ring.json"],
    "`info ball.json` (a PNG texture)": ["info", SCENES / "ball.json"],
    "`render ring.json`, 64 x 48, `none`, EXR and PNG": [
        "render", SCENES / "ring.json", "--method", "none", "--spp", "1", "--set", "/sensor/film/width=64",
        "--set", "/sensor/film/height=48", "-o", "a.exr", "-o", "a.png"],
    "`sweep tiny.json`, all done": ["sweep", ROOT / "experiments/sweeps/tiny.json", "-o", "tiny"],
}
WAITS = {
    "`render`, photonmap": ["render", *POOL, *SMALL, "--method", "photonmap", "--param", "photons=1000000", "-o", "a.exr"],
    "`render`, beamtree": ["render", *POOL, *SMALL, "--method", "beamtree", "--param", "intensity=refined", "-o", "a.exr"],
    "`render`, causticpolygons": ["render", *POOL, *SMALL, "--method", "causticpolygons", "-o", "a.exr"],
    "`render`, lighttrace": ["render", *POOL, *SMALL, "--method", "lighttrace", "--param", "paths=300000", "-o", "a.exr"],
    "`probe`, lighttrace": ["probe", SCENES / "ring.json", "--method", "lighttrace", "--param", "paths=300000", "--param", "radius=0.05",
                            "--points", "points.csv", "-o", "a.csv"],
    "`info --beams`": ["info", *POOL, *SMALL, "--beams", "-o", "a.png"],
    "`info`, a mesh of 245,000 triangles": ["info", "mesh.json"],
    "`export`, the same mesh": ["export", "mesh.json", "--to", "mitsuba", "-o", "exported"],
    "`verify` a scene": ["verify", ROOT / "tests/experiments/scenes/ball.json", "--method", "photonmap"],
    "`sweep`": ["sweep", ROOT / "experiments/sweeps/tiny.json", "-o", "swept"],
    "`report`": ["report", "tiny", "-o", "report.html"],
}


class Terminal:
    """A program at work at a terminal; what it answers goes nowhere."""

    def __init__(self, words, folder, columns=COLUMNS):
        self.begun = time.monotonic()
        words = [os.path.abspath(words[0]), *map(str, words[1:])]
        self.process, self.end = pty.fork()
        if self.process == 0:
            try:
                os.chdir(folder)
                os.dup2(os.open("/dev/null", os.O_WRONLY), sys.stdout.fileno())
                os.execv(words[0], words)
            finally:
                os._exit(127)
        fcntl.ioctl(self.end, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        self.written = []  # (seconds, text)
        self.code = self.used = None

    def wait(self, until):
        """Reads what is written until until(self) is true or the program has ended; False when it has ended."""
        while not until(self):
            if select.select([self.end], [], [], 0.01)[0]:
                try:
                    text = os.read(self.end, 1 << 16).decode(errors="replace")
                except OSError:  # the other end is closed
                    text = ""
                if text:
                    self.written.append((self.seconds(), text))
                    continue
            process, status, used = os.wait4(self.process, os.WNOHANG)
            if process:
                self.code, self.used = os.waitstatus_to_exitcode(status), used
                os.close(self.end)
                return False
        return True

    def press_ctrl_c(self):
        os.write(self.end, b"\x03")

    def seconds(self):
        return time.monotonic() - self.begun

    def cpu(self):
        """CPU seconds so far, with those of children that have ended."""
        if self.used:
            return self.used.ru_utime + self.used.ru_stime
        fields = pathlib.Path(f"/proc/{self.process}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
        return sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")

    def lines(self):
        """(seconds, line) of all that was shown."""
        return [(at, line) for at, text in self.written for line in re.split(r"\r\x1b\[K|\r?\n", text) if line]

    def states(self):
        """Lines that are painted over: what is at work."""
        return [(at, line) for at, line in self.lines() if re.search(r"\.\.\.$|\d %|ETA", line)]


def left_in(folder):
    """Files that an interrupted program left behind, but those by which a sweep goes on."""
    return sorted(str(path.relative_to(folder)) for path in pathlib.Path(folder).rglob("*")
                  if path.is_file() and path.relative_to(folder).parts[0] not in ("swept", *PREPARED))


PREPARED = ("points.csv", "mesh.json", "mesh.obj", "tiny")


def prepare(folder):
    random.seed(1)
    points = (f"{random.uniform(0.1, 0.5)},{random.uniform(0.1, 0.5)},0,0,0,1" for _ in range(200))
    (folder / "points.csv").write_text("x,y,z,nx,ny,nz\n" + "\n".join(points) + "\n", encoding="ascii")
    n = 350
    rows = [f"v {i / n:.6f} {j / n:.6f} {0.01 * ((i * j) % 7):.6f}" for j in range(n + 1) for i in range(n + 1)]
    rows += [f"f {a} {a + 1} {a + n + 2} {a + n + 1}" for j in range(n) for a in range(j * (n + 1) + 1, j * (n + 1) + n + 1)]
    (folder / "mesh.obj").write_text("\n".join(rows) + "\n", encoding="ascii")
    (folder / "mesh.json").write_text("""{"sensor": {"type": "perspective"},
        "light": {"type": "point", "position": [0, 0, 5], "intensity": 5},
        "m": {"type": "obj", "filename": "mesh.obj", "bsdf": {"type": "diffuse"}}}""", encoding="ascii")


def start_row(name, words, program, folder):
    command = [str(word) for word in (program, *words)]
    used = []
    for _ in range(21):  # the first makes what the others find done
        process = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        if status:
            sys.exit(f"measure_waiting: {' '.join(command)}: ended with {os.waitstatus_to_exitcode(status)}")
        used.append(1000 * (usage.ru_utime + usage.ru_stime))
    loader = subprocess.run(command, cwd=folder, env={**os.environ, "LD_DEBUG": "files"}, stdout=subprocess.DEVNULL,
                            stderr=subprocess.PIPE, text=True, check=True).stderr
    process = loader.split("calling init:")[0].rsplit("\n", 1)[-1].strip()  # the first, not its children
    libraries = len(re.findall(rf"{process}\s+calling init:", loader)) if process else loader.count("calling init:")
    return f"| {name} | {statistics.median(used[1:]):.1f} | {libraries} |"


def eta_error(work):
    """Median of |ETA - what it took| over what it took, of lines with 2 s or more to go that tell of the whole command."""
    errors = []
    for at, line in work.states():
        found = re.search(r"ETA (?:(\d+):)?(\d+):(\d\d)", line)
        if not found:
            continue
        hours, minutes, seconds = (int(part or 0) for part in found.groups())
        told = 3600 * hours + 60 * minutes + seconds
        left = work.seconds_in_all - at
        if left >= 2:
            errors.append(abs(told - left) / left)
    return f"{100 * statistics.median(errors):.0f} % of {len(errors)}" if errors else "-"


def wait_row(name, words, program, folder, stops):
    work = Terminal([program, *words], folder)
    work.wait(lambda _: False)
    if work.code != 0:
        sys.exit(f"measure_waiting: {name}: ended with {work.code}: {work.lines()[-1:]}")
    work.seconds_in_all = work.seconds()
    shown = [at for at, _ in work.states()]
    silence = max(b - a for a, b in zip([0, *shown], [*shown, work.seconds_in_all])) / work.seconds_in_all
    wide = max((len(line) for _, line in work.states()), default=0)
    delays, codes, left = [], set(), set()
    for _ in range(stops):
        clear(folder)
        stopped = Terminal([program, *words], folder)
        moment = random.uniform(0.02, 0.9) * work.cpu()
        if not stopped.wait(lambda it: it.cpu() >= moment):
            continue  # faster than the first
        before, at = stopped.cpu(), stopped.seconds()
        stopped.press_ctrl_c()
        stopped.wait(lambda _: False)
        delays.append((stopped.cpu() - before, stopped.seconds() - at))
        codes.add(stopped.code)
        left.update(left_in(folder))
    clear(folder)
    cpu, wall = (f"{max(values):.2f}" for values in zip(*delays)) if delays else ("-", "-")
    return (f"| {name} | {work.cpu():.1f} | {shown[0] if shown else work.seconds_in_all:.1f} | {100 * silence:.0f} % | {wide} | "
            f"{eta_error(work)} | {cpu} | {wall} | {', '.join(map(str, sorted(codes)))} | {', '.join(sorted(left)) or '-'} |")


def clear(folder):
    for path in folder.iterdir():
        if path.name not in PREPARED:
            shutil.rmtree(path) if path.is_dir() else path.unlink()


def table(program, stops):
    with tempfile.TemporaryDirectory(prefix="waiting_") as scratch:
        folder = pathlib.Path(scratch)
        prepare(folder)
        yield "# Waiting\n"
        version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout.strip()
        yield (f"By `tools/measure_waiting.py --stops {stops}`; {version}; {processor()}, "
               f"{os.cpu_count()} processors, load average {os.getloadavg()[0]:.0f}.\n")
        yield "| start | CPU ms | shared libraries |\n|---|---|---|"
        for name, words in STARTS.items():
            yield start_row(name, words, program, folder)
        yield (f"\nAt a terminal of {COLUMNS} columns; Ctrl-C {stops} times, at random moments. *First*: seconds until something is "
               "shown; *silence*: the longest stretch without news, of the whole time; *ETA*: median of its error, where it is of the "
               "whole command and 2 s or more were to go; *Ctrl-C*: the longest until the end, in CPU seconds of the program and seconds on the wall.\n")
        yield ("| verb | CPU s | first | silence | widest line | ETA off by | Ctrl-C CPU s | wall s | exit code | left behind |\n"
               "|---|---|---|---|---|---|---|---|---|---|")
        for name, words in WAITS.items():
            yield wait_row(name, words, program, folder, stops)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--program", default=str(ROOT / "build/release/bin/causticbench"))
    parser.add_argument("--stops", type=int, default=10, metavar="N")
    parser.add_argument("-o", "--output", metavar="FILE", type=pathlib.Path)
    chosen = parser.parse_args()
    if chosen.stops < 1:
        parser.error("--stops: at least 1")
    show(table(os.path.abspath(chosen.program), chosen.stops), chosen.output)


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Measures what the runner adds to a sweep's trials: time of a trivial trial beside that of `causticbench --version`,
memory of the runner as trials go by, and the time of a finished sweep started again, listed and merged.

Usage: bench_runner.py [--trials N] [--program PATH] [-o DIR]     writes DIR/runner.json and runner.md (results/bench)
"""
import argparse
import json
import os
import pathlib
import resource
import shlex
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
SEEDS, VALUES = 10, 10


def write_sweep(folder, trials):
    """So many trials of a picture of 16 x 12 pixels without a caustic, in 100 cells."""
    repeats = -(-trials // (SEEDS * VALUES))
    file = folder / "trivial.json"
    file.write_text(json.dumps({
        "version": 1, "scenes": [str(ROOT / "tests/experiments/scenes/ball.json")], "spp": 1,
        "seeds": list(range(1, SEEDS + 1)), "repeats": repeats, "methods": [{"method": "none"}],
        "set": {"glass": {"pointer": "/ball/bsdf/int_ior", "values": [1.1 + 0.1 * i for i in range(VALUES)]}}}))
    return file, SEEDS * VALUES * repeats


def timed(command):
    """Wall and CPU seconds of a command that must succeed, its children included."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
    wall, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    return {"wall_s": wall, "cpu_s": after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime}


def resident(process):
    for line in pathlib.Path(f"/proc/{process}/status").read_text().splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1]) * 1024
    return 0


def watched(command, folder, trials):
    """As timed(), and the runner's memory after each tenth of the trials."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    memory = []
    with open(folder / "progress.txt", "wb") as log:
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=log)
    while process.poll() is None:
        text = (folder / "progress.txt").read_bytes()
        done = text.count(b"\n")
        if done >= trials * (len(memory) + 1) // 10 and len(memory) < 9:
            memory.append({"trials": done, "bytes": resident(process.pid)})
        time.sleep(0.1)
    if process.returncode != 0:
        sys.exit(f"bench_runner: the sweep failed: {(folder / 'progress.txt').read_text()[-500:]}")
    wall, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    return {"wall_s": wall, "cpu_s": after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime}, memory


def forgetful(command, folder):
    """As timed(), with every record to read."""
    (folder / ".table").unlink()
    return timed(command)


def measure(program, trials):
    version = [timed([program, "--version"]) for _ in range(11)]
    with tempfile.TemporaryDirectory(prefix="bench-runner-") as scratch:
        folder = pathlib.Path(scratch)
        sweep, trials = write_sweep(folder, trials)
        command = [program, "sweep", str(sweep), "-o", str(folder / "out")]
        run, memory = watched(command, folder, trials)
        finished = {
            "started again": [timed(command) for _ in range(3)],
            "started again without `.table`": [forgetful(command, folder / "out") for _ in range(3)],
            "`--list`": [timed(command + ["--list"]) for _ in range(3)],
            "`--dry-run`": [timed(command + ["--dry-run"]) for _ in range(3)],
            "`merge` into another folder": [timed([program, "merge", str(folder / "out"), "-o", str(folder / "all")])]}
    median = lambda runs: {key: statistics.median(one[key] for one in runs) for key in runs[0]}
    version, finished = median(version), {name: median(runs) for name, runs in finished.items()}
    per_trial = {key: value / trials for key, value in run.items()}
    return {"trials": trials, "version": version, "sweep": run, "per_trial": per_trial,
            "per_trial_over_version": {key: per_trial[key] / version[key] for key in version},
            "memory": memory, "finished": finished, "processors": len(os.sched_getaffinity(0)),
            "load": os.getloadavg()[0]}


def report(result, command):
    memory = result["memory"]
    growth = (memory[-1]["bytes"] - memory[0]["bytes"]) / (memory[-1]["trials"] - memory[0]["trials"])
    rows = [("`causticbench --version`", result["version"]), ("one of the trials", result["per_trial"]),
            ("... over `--version`", result["per_trial_over_version"]),
            *((f"a finished sweep: {name}", values) for name, values in result["finished"].items())]
    table = "\n".join(f"| {name} | {values['wall_s']:.3f} | {values['cpu_s']:.3f} |" for name, values in rows)
    return f"""# What the runner costs

{result['trials']} trials of 16 × 12 pixels without a caustic, one at a time, each in a process of its own; everything that
the sweep did is divided among them. {result['processors']} processors, load {result['load']:.1f} when it ended. Made by

    {command}

| | wall [s] | CPU [s] |
|---|---|---|
{table}

The runner's own memory grew from {memory[0]['bytes'] / 1e6:.1f} MB after {memory[0]['trials']} trials to \
{memory[-1]['bytes'] / 1e6:.1f} MB after {memory[-1]['trials']}: {growth:.0f} bytes a trial.
"""


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("Usage: ")[1])
    parser.add_argument("--trials", type=int, default=10000)
    parser.add_argument("--program", default=str(ROOT / "build/release/bin/causticbench"))
    parser.add_argument("-o", "--output", type=pathlib.Path, default=ROOT / "results/bench")
    options = parser.parse_args()
    result = measure(options.program, options.trials)
    command = "tools/bench_runner.py " + shlex.join(sys.argv[1:])
    (options.output / "runner.json").write_text(json.dumps(dict(result, command=command), indent=1) + "\n")
    (options.output / "runner.md").write_text(report(result, command.strip()))
    print(report(result, command.strip()))


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Runs a sweep as an array of Slurm jobs: writes the batch script, submits it, and says how to put the shards together.

Usage: slurm_sweep.py SWEEP.json... -o DIR --shards N [--at-once K] [--cpus-per-task C] [--program PATH]
                      [--sbatch=OPTION]... [--sweep=OPTION]... [--only-write]

Shard i goes to DIR/shards/i, and all shards share DIR/references, which a first job renders. The N tasks are submitted as
arrays that the cluster's MaxArraySize allows, one after the other, of which at most K tasks run at a time. Each
trial gets the C processors of its task (SLURM_CPUS_PER_TASK). A task that is requeued or submitted again goes on where
it stopped. Options of sbatch and of the sweep are handed on: --sbatch=--partition=long --sweep=--timeout=600.
Exit codes: 0 done, 1 Slurm refuses, 2 bad input or usage; that of the program where it refuses the sweep.
"""
import argparse
import pathlib
import re
import shlex
import subprocess
import sys

sys.dont_write_bytecode = True  # the source folder may be read-only

from report.report_files import no_folder

SCRIPT = """#!/bin/bash
#SBATCH --job-name={name}
#SBATCH --output={log}
#SBATCH --open-mode=append
#SBATCH --requeue
#SBATCH --cpus-per-task={cpus}
# One task: shard OFFSET + its number in the array, or without an array the references.
set -euo pipefail
program={program}
common=({common} --threads "${{SLURM_CPUS_PER_TASK:-1}}")
if [ -z "${{SLURM_ARRAY_TASK_ID:-}}" ]; then
    exec "$program" "${{common[@]}}" -o {references} --references only
fi
shard=$((OFFSET + SLURM_ARRAY_TASK_ID))
exec "$program" "${{common[@]}}" -o {shards}/"$shard" --shard "$shard/{count}"
"""


# Of the sweep, with what says the same here: a script has its own, and what only tells runs no trial.
NOT_HANDED_ON = {
    "-o": "-o DIR", "--output": "-o DIR", "--shard": "--shards N", "--threads": "--cpus-per-task C",
    "--references": "the first job renders them", "--list": "causticbench sweep", "--dry-run": "causticbench sweep",
    "-h": "causticbench sweep", "--help": "causticbench sweep", "--": "the script adds options of its own",
}


class SlurmError(Exception):
    """One line for the user, and the exit code."""

    def __init__(self, reason, code=2):
        super().__init__(reason)
        self.code = code


def run(command):
    """What one of Slurm's commands prints."""
    try:
        done = subprocess.run(command, capture_output=True, text=True)
    except OSError as error:
        raise SlurmError(f"{command[0]}: {error.strerror} (is Slurm installed?)", 1) from error
    if done.returncode != 0:
        raise SlurmError(f"{shlex.join(command)}: {done.stderr.strip() or done.stdout.strip()}", 1)
    return done.stdout


def try_sweep(options):
    """A mistake in the sweep is reported here, not by a thousand tasks."""
    command = [str(options.program), "sweep", *options.sweep_files, "-o", options.output, "--list", *options.sweep]
    try:
        done = subprocess.run(command, capture_output=True, text=True)
    except OSError as error:
        raise SlurmError(f"--program {options.program}: {error.strerror} (tools/build.sh release causticbench)") from error
    if done.returncode != 0:
        code = done.returncode if done.returncode > 0 else 1  # below 0: killed by a signal
        raise SlurmError(f"{shlex.join(command)}: {done.stderr.strip() or done.stdout.strip() or f'exit code {done.returncode}'}", code)


def require_own(words):
    """Refuses options of the sweep that the script has itself, or that run nothing."""
    for word in words:
        name = word.partition("=")[0] if word.startswith("--") else word[:2]
        if name in NOT_HANDED_ON:
            raise SlurmError(f"--sweep={word}: {name} is not handed on ({NOT_HANDED_ON[name]})")


def require_folder(path):
    if above := no_folder(path):
        raise SlurmError(f"-o {path}: no folder for results ({above} is none)")


def largest_index():
    """The largest index that a task of an array may have."""
    found = re.search(r"^MaxArraySize\s*=\s*(\d+)", run(["scontrol", "show", "config"]), re.MULTILINE)
    if not found:
        raise SlurmError("scontrol show config does not tell MaxArraySize", 1)
    return int(found.group(1)) - 1


def log_name(folder):
    """The logs' name as sbatch reads it in a script: its own words for numbers, then quotes and backslashes."""
    text = str(folder).replace("%", "%%") + "/%A_%a.log"
    if "\n" in text:
        raise SlurmError(f"-o {str(folder)!r}: sbatch takes no folder with a line break in its name")
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def arrays(shards, largest):
    """(offset, tasks) of the arrays that number the shards from 1."""
    return [(offset, min(largest, shards - offset)) for offset in range(0, shards, largest)]


def write(options):
    """Writes what the jobs need below DIR; returns the batch script."""
    folder = pathlib.Path(options.output).absolute()
    shards = [folder / "shards" / str(i) for i in range(1, options.shards + 1)]
    (folder / "references").mkdir(parents=True, exist_ok=True)
    (folder / "slurm").mkdir(exist_ok=True)
    for shard in shards + [folder / "slurm" / "references"]:
        shard.mkdir(parents=True, exist_ok=True)
        if not (shard / "references").exists():
            (shard / "references").symlink_to(folder / "references")
    files = [str(pathlib.Path(file).absolute()) for file in options.sweep_files]
    script = folder / "slurm" / "sweep.sbatch"
    script.write_text(SCRIPT.format(
        name="causticbench", log=log_name(folder / "slurm"), cpus=options.cpus_per_task,
        program=shlex.quote(str(pathlib.Path(options.program).absolute())),
        common=shlex.join(["sweep"] + files + options.sweep),
        references=shlex.quote(str(folder / "slurm" / "references")),
        shards=shlex.quote(str(folder / "shards")), count=options.shards))
    return script


def submit(options, script):
    """Submits the references and then the arrays, each after the one before; returns the jobs' numbers."""
    jobs = []
    for offset, tasks in [(None, None)] + arrays(options.shards, largest_index()):
        command = ["sbatch", "--parsable"] + options.sbatch
        if jobs:
            command.append(f"--dependency=afterany:{jobs[-1]}")
        if tasks:
            limit = f"%{options.at_once}" if options.at_once else ""
            command += [f"--array=1-{tasks}{limit}", f"--export=ALL,OFFSET={offset}"]
        jobs.append(run(command + [str(script)]).strip().split(";")[0])
    return jobs


def positive(text):
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text}: expected a whole number from 1 on")
    return int(text)


def parse(arguments):
    root = pathlib.Path(__file__).resolve().parent.parent
    parser = argparse.ArgumentParser(usage=__doc__.split("Usage: ")[1], allow_abbrev=False)
    parser.add_argument("sweep_files", nargs="+")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--shards", type=positive, required=True)
    parser.add_argument("--at-once", type=positive)
    parser.add_argument("--cpus-per-task", type=positive, default=1)
    parser.add_argument("--program", default=root / "build/release/bin/causticbench")
    parser.add_argument("--sbatch", action="append", default=[])
    parser.add_argument("--sweep", action="append", default=[])
    parser.add_argument("--only-write", action="store_true")
    options = parser.parse_args(arguments)
    for name in ("sbatch", "sweep"):  # some versions of argparse make [] of the word --
        setattr(options, name, [word if isinstance(word, str) else "--" for word in getattr(options, name)])
    return options


def main(arguments):
    options = parse(arguments)
    require_own(options.sweep)
    require_folder(options.output)
    try_sweep(options)
    script = write(options)
    print(f"script  {script}")
    if not options.only_write:
        for job in submit(options, script):
            print(f"job     {job}")
    print(f"then    {shlex.quote(str(options.program))} merge {shlex.quote(options.output)}/shards/* "
          f"-o {shlex.quote(options.output)}/all")


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except SlurmError as error:
        print(f"slurm_sweep: {error}", file=sys.stderr)
        sys.exit(error.code)
    except OSError as error:
        print(f"slurm_sweep: {error.filename}: {error.strerror}", file=sys.stderr)
        sys.exit(1)

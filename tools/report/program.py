"""The release build of causticbench, as the measuring tools run it: sweeps, and the line on where they ran."""
import json
import os
import pathlib
import platform
import subprocess
import sys

from report import records

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BENCH = ROOT / "build" / "release" / "bin" / "causticbench"
OWN = ROOT / "out"  # the user's own runs, not in git


class Program:
    def __init__(self, tool, path=BENCH):
        if not path.exists():
            raise records.RecordsError(f"{path}: not there (tools/build.sh release causticbench)")
        self.tool, self.path = tool, str(path)

    def run(self, *words, **options):
        """What it prints to a pipe; raises ChildProcessError where it fails."""
        status = subprocess.run([self.path, *map(str, words)], cwd=ROOT, stdin=subprocess.DEVNULL, text=True, **options)
        if status.returncode != 0:
            raise ChildProcessError(f"{' '.join(map(str, words[:2]))}: exit code {status.returncode}")
        return status.stdout

    def sweep(self, name, folder, keep, *words):
        """Runs experiments/sweeps/NAME.json into the folder; `keep` takes the trials that are there."""
        print(f"{self.tool}: {name}", file=sys.stderr, flush=True)
        self.run("sweep", ROOT / "experiments" / "sweeps" / f"{name}.json", "-o", folder, *words,
                 *([] if keep else ["--force"]), stdout=sys.stderr)


def exit_code(tool, run):
    """Runs run(): 0 done, 1 a run failed, 2 bad input, each but the first with one line; 130 interrupted."""
    try:
        run()
    except (records.RecordsError, json.JSONDecodeError) as error:
        print(f"{tool}: {error}", file=sys.stderr)
        return 2
    except (ChildProcessError, ImportError, OSError) as error:
        print(f"{tool}: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


def output_folder(chosen, usual):
    """The folder of -o, seen from where the user called the script, which changes the working folder; else the usual one."""
    return (pathlib.Path(os.environ.get("CAUSTICS_CALLED_FROM", ".")) / chosen if chosen else usual).resolve()


def show(lines, output=None):
    """Prints a page's lines as they come; the whole page goes to `output`, where one is given."""
    text = []
    for line in lines:
        print(line, flush=True)
        text.append(line + "\n")
    if output:
        output.write_text("".join(text), encoding="utf-8")


def processor():
    """The processor's name, or the machine's kind where the system does not give one."""
    lines = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    return next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), platform.machine())


def machine(folders):
    """One line on where and in which state the times of these sweeps were taken."""
    found = [json.loads((folder / "environment.json").read_text(encoding="utf-8")) for folder in folders]
    loads = [float(each["load"].split()[0]) for each in found]
    first = found[0]
    commits = ", ".join(dict.fromkeys(each["commit"] for each in found))
    return (f"{first['cpu']}, {first['threads_available']} threads, {first['compiler']}, commit {commits}; load "
            f"average {min(loads):.1f} to {max(loads):.1f} while the sweeps began ({first['date'][:10]}).")

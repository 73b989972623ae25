"""The tests that judge mutants: GoogleTest programs by their labels in ctest, how long each test takes and which sites it
reaches."""
import json
import re
import subprocess
from dataclasses import dataclass, field


@dataclass
class Test:
    name: str
    program: str
    filter: str
    seconds: float = 0
    since: float = 0  # when it was first tried
    reached: frozenset = field(default_factory=frozenset)


def listed(build, labels):
    """The tests that have one of the labels and none of those that say where they run, as ctest lists them."""
    shown = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1"], check=True, capture_output=True,
                           text=True).stdout
    tests = []
    for entry in json.loads(shown)["tests"]:
        own = {label for p in entry.get("properties", ()) if p["name"] == "LABELS" for label in p["value"]}
        command = entry.get("command", [""])
        if own & labels and own <= labels and len(command) > 1 and command[1].startswith("--gtest_filter="):
            tests.append(Test(entry["name"], command[0], command[1].split("=", 1)[1]))
    return tests


def try_out(test, sandbox, most):
    """Runs a test without a mutant and notes time and reach; None, or why it cannot judge."""
    note = sandbox.folder.parent / f"{sandbox.folder.name}.reached"
    note.unlink(missing_ok=True)
    note.touch()
    code, output = sandbox.run([test.program, f"--gtest_filter={test.filter}"], most,
                               CAUSTICS_MUTANTS_REACHED=str(note))
    if code is None:
        return f"takes over {most:g} s"
    if code != 0:
        return "fails without a mutant: " + output[-300:]
    took = re.search(r"^\[       OK \] .*\((\d+) ms\)$", output, re.MULTILINE)
    if not took:
        return "is skipped"
    test.seconds = max(int(took[1]), 1) / 1000
    test.reached = frozenset(map(int, note.read_text(encoding="utf-8").split()))
    return None

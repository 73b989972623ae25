#!/usr/bin/python3
"""kill -9 of a sweep's runner and of its trials, at random moments and at every rename: after going on, the records
are those of an undisturbed run, nothing half-written was taken for whole, and nothing done was done again.

Usage: kill_test.py [PROGRAM [KILL_AT_RENAME.so]]
"""
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time

import lab

KILLS = 50


def children(process):
    try:
        return [int(child) for child in
                pathlib.Path(f"/proc/{process}/task/{process}/children").read_text().split()]
    except OSError:
        return []


class Kills(lab.Lab):
    def go_on(self, folder, before):
        """Runs what is missing; what was done stays as it is."""
        done = self.run_sweep(folder, "--rerun", "failed")
        self.assertEqual(done.returncode, 0, done.stderr)
        after = lab.record_times(folder)
        self.assertEqual({trial: after[trial] for trial in before}, before)
        self.check_same(folder)
        self.assertFalse(list(folder.glob("trials/.*")) + list(folder.glob("*.tmp-*")))

    def done(self, folder):
        rows = {path.parent.name for path in folder.glob("trials/[!.]*/record.json")
                if '"status": "done"' in path.read_text()}
        return {trial: when for trial, when in lab.record_times(folder).items() if trial in rows}

    def test_random_moments(self):
        generator = random.Random(1996)
        started = time.monotonic()
        self.run_sweep(self.scratch / "timed").check_returncode()
        whole_run = time.monotonic() - started
        folder = self.scratch / "killed"
        kills, completed, hits = 0, 0, {"runner": 0, "child": 0}
        while kills < KILLS:
            before = self.done(folder)
            process = subprocess.Popen(self.command(folder, "--rerun", "failed"), stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            wants_child = generator.random() < 0.5
            time.sleep(generator.uniform(0.4 if wants_child else 0, 1) * whole_run)  # it starts without children
            victims = children(process.pid) if wants_child else []
            for victim in victims:
                try:
                    os.kill(victim, signal.SIGKILL)
                    hits["child"] += 1
                except ProcessLookupError:
                    pass
            if not victims and process.poll() is None:
                process.kill()
                hits["runner"] += 1
            kills += 1
            process.wait()
            self.check_whole(folder)
            after = lab.record_times(folder)
            self.assertEqual({trial: after.get(trial) for trial in before}, before, "done again, or lost")
            if len(self.done(folder)) == len(lab.rows(self.undisturbed)):
                self.go_on(folder, self.done(folder))
                shutil.rmtree(folder)
                completed += 1
        self.go_on(folder, self.done(folder))
        print(f"{kills} kills ({hits}), {completed + 1} sweeps completed", file=sys.stderr)
        self.assertGreater(hits["runner"], 5)
        self.assertGreater(hits["child"], 5)

    def test_every_rename(self):
        if len(sys.argv) < 3:
            self.skipTest("needs the library kill_at_rename")
        for after in ("", "1"):
            for count in range(1, 1000):
                folder = self.scratch / f"rename{after}{count}"
                env = dict(os.environ, LD_PRELOAD=sys.argv[2], KILL_AT_RENAME=str(count))
                if after:
                    env["KILL_AFTER"] = after
                killed = self.run_sweep(folder, env=env)
                if killed.returncode == 0:
                    break
                self.check_whole(folder)
                self.go_on(folder, self.done(folder))
                shutil.rmtree(folder)
            print(f"{count - 1} renames", file=sys.stderr)
            self.assertGreater(count, 20, "the renames of 12 trials")


if __name__ == "__main__":
    lab.main()

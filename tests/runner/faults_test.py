#!/usr/bin/python3
"""A full disk, a folder that cannot be written, a trial that crashes: a clear message or row each, and nothing lost.
The same sweep on one and two threads, two at a time, and in three shards: the same pictures and metrics.

Usage: faults_test.py [PROGRAM]
"""
import os
import pathlib
import shlex
import signal
import subprocess
import time

import lab


def in_own_mounts(script):
    """Runs a shell script that may mount, or None where that is not allowed."""
    if subprocess.run(["unshare", "--mount", "true"], capture_output=True).returncode != 0:
        return None
    return subprocess.run(["unshare", "--mount", "bash", "-c", script], capture_output=True, text=True)


class Faults(lab.Lab):
    def test_full_disk(self):
        folder = self.scratch / "disk"
        folder.mkdir()
        sweep = shlex.join(self.command(folder / "out"))
        done = in_own_mounts(f"""
            mount -t tmpfs -o size=300k none {folder} || exit 99
            {sweep}; echo "full $?"
            ls {folder}/out/trials | wc -l
            mount -o remount,size=100m {folder}
            {sweep} --rerun failed; echo "after $?"
            cp -r {folder}/out {self.scratch}/rescued""")
        if done is None or done.returncode == 99:
            self.skipTest("needs leave to mount (root)")
        self.assertIn("full 2", done.stdout, done.stderr)
        self.assertIn("No space left on device", done.stderr)
        self.assertIn("after 0", done.stdout)
        self.check_same(self.scratch / "rescued")

    def test_read_only_folder(self):
        folder = self.scratch / "fixed"
        folder.mkdir()
        done = in_own_mounts(f"""
            mount --bind {folder} {folder} && mount -o remount,ro,bind {folder} || exit 99
            {shlex.join(self.command(folder))}""")
        if done is None or done.returncode == 99:
            self.skipTest("needs leave to mount (root)")
        self.assertEqual(done.returncode, 2)
        self.assertIn(f"{folder}: cannot be written (Read-only file system)", done.stderr)

    def test_without_proc(self):
        folder = self.scratch / "no-proc"
        done = in_own_mounts(f"""
            mount -t tmpfs none /proc || exit 99
            {lab.PROGRAM} --version && {shlex.join(self.command(folder))}; echo "sweep $?"
            {shlex.join(self.command(self.scratch / "limited"))} --memory 1000; echo "limited $?"
            """)
        if done is None or done.returncode == 99:
            self.skipTest("needs leave to mount (root)")
        self.assertIn("sweep 0", done.stdout, done.stderr)
        self.check_same(folder)
        self.assertIn("limited 2", done.stdout)
        self.assertIn("--memory: cannot be held without /proc", done.stderr)

    def test_crash(self):
        sweep = lab.write_sweep(self.scratch / "crash.json", photons=(20,), seeds=(1,), methods=[
            {"method": "none"}, {"method": "photonmap", "param": {"emitted": [100, 2000000000]}}])
        folder = self.scratch / "crash"
        process = subprocess.Popen([str(lab.PROGRAM), "sweep", str(sweep), "-o", str(folder)],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        crashed = 0
        while crashed < 2:  # the two endless trials, one after the other
            time.sleep(0.05)
            logs = list(folder.glob("trials/.tmp-*emitted2000000000*/log.txt"))
            if logs and "trace" in logs[0].read_text():
                children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text()
                os.kill(int(children.split()[0]), signal.SIGSEGV)
                crashed += 1
                while logs[0].exists():
                    time.sleep(0.01)
        errors = process.communicate()[1]
        self.assertEqual(process.returncode, 1)
        rows = lab.rows(folder)
        self.assertEqual(len(rows), 6)
        for trial, row in rows.items():
            endless = row["emitted"] == "2000000000"
            self.assertEqual(row["status"], "failed" if endless else "done")
            if endless:
                self.assertIn("killed by signal 11", row["message"])
                self.assertIn("killed by signal 11", (folder / "trials" / trial / "log.txt").read_text())
                self.assertIn(f"{folder}/trials/{trial}/log.txt", errors)


class SameResults(lab.Lab):
    def test_threads_and_jobs(self):
        for name, options in (("two-threads", ["--threads", "2"]), ("two-jobs", ["--jobs", "2"])):
            self.run_sweep(self.scratch / name, *options).check_returncode()
            self.check_same(self.scratch / name)

    def test_shards(self):
        shards = [self.scratch / f"shard{i}" for i in (1, 2, 3)]
        for i, folder in enumerate(shards, 1):
            self.run_sweep(folder, "--shard", f"{i}/3").check_returncode()
        whole = self.scratch / "whole"
        subprocess.run([str(lab.PROGRAM), "merge", *map(str, shards), "-o", str(whole)], check=True)
        self.check_same(whole)


if __name__ == "__main__":
    lab.main()

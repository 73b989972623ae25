#!/usr/bin/python3
"""A sweep as an array of jobs of a real Slurm of one node: tasks cancelled, run again, put together, give the records of
an unsharded run. Skipped where Slurm is not installed (Debian: slurmctld slurmd slurm-client munge).

Usage: slurm_test.py [PROGRAM]
"""
import os
import shutil
import socket
import subprocess
import sys
import time

import lab

os.environ["PATH"] += ":/usr/sbin"
NEEDED = ("munged", "slurmctld", "slurmd", "sbatch", "scancel", "scontrol", "squeue")

CONFIGURATION = """ClusterName=lab
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.sock
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
AccountingStorageType=accounting_storage/none
SchedulerType=sched/builtin
SchedulerParameters=sched_interval=1,batch_sched_delay=0
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
PriorityType=priority/basic
MpiDefault=none
ReturnToService=2
JobRequeue=1
KillWait=5
MaxArraySize=5
SlurmdParameters=config_overrides
LaunchParameters=disable_send_gids
NodeName=n0 NodeAddr=127.0.0.1 NodeHostname={host} CPUs=2 RealMemory=1000 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP OverSubscribe=NO
"""


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def wait_until(condition, what, seconds=60):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise TimeoutError(what)
        time.sleep(0.1)


class Slurm:
    """A controller and a node of our own on the loopback interface, everything below one folder."""

    def __init__(self, folder):
        self.folder = folder
        self.daemons = []
        for name in ("state", "spool"):
            (folder / name).mkdir(parents=True)
        key = folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o600)
        folder.chmod(0o755)
        user = subprocess.run(["id", "-un"], capture_output=True, text=True, check=True).stdout.strip()
        (folder / "slurm.conf").write_text(CONFIGURATION.format(
            host=socket.gethostname().split(".")[0], user=user, folder=folder, controller_port=free_port(),
            node_port=free_port()))
        version = subprocess.run(["slurmctld", "-V"], capture_output=True, text=True).stdout.split()[-1]
        if int(version.split(".")[0]) >= 23:
            (folder / "cgroup.conf").write_text("CgroupPlugin=disabled\n")
        os.environ["SLURM_CONF"] = str(folder / "slurm.conf")

    def start(self):
        self.daemon("munged", "--foreground", "--force", "--key-file", self.folder / "munge.key", "--socket",
                    self.folder / "munge.sock", "--pid-file", self.folder / "munged.pid", "--seed-file",
                    self.folder / "munge.seed", "--log-file", self.folder / "munged.log")
        wait_until((self.folder / "munge.sock").exists, "munged")
        self.daemon("slurmctld", "-D", "-i")
        wait_until(lambda: "UP" in said("scontrol", "ping"), "slurmctld")
        self.daemon("slurmd", "-D", "-N", "n0")
        wait_until(lambda: said("sinfo", "-h", "-o", "%t").strip() in ("idle", "mix"), "slurmd")

    def daemon(self, *command):
        with open(self.folder / f"{command[0]}.out", "w", encoding="utf-8") as log:
            self.daemons.append(subprocess.Popen([str(word) for word in command], stdout=log, stderr=log))

    def stop(self):
        for daemon in reversed(self.daemons):
            daemon.terminate()
            try:
                daemon.wait(10)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()


def said(*command):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True).stdout


def jobs():
    """Job and task -> state, of the jobs that are not over."""
    return dict(line.split() for line in said("squeue", "-h", "-r", "-o", "%i %T").splitlines())


class SlurmSweep(lab.Lab):
    @classmethod
    def setUpClass(cls):
        missing = [name for name in NEEDED if not shutil.which(name)]
        if missing:
            print(f"slurm_test: skipped: Slurm is not installed ({', '.join(missing)})", file=sys.stderr)
            sys.exit(77)
        super().setUpClass()
        slurm = Slurm(cls.scratch / "slurm")
        cls.addClassCleanup(slurm.stop)
        slurm.start()

    def submit(self, folder, shards, *options):
        done = subprocess.run([str(lab.ROOT / "tools/slurm_sweep.py"), str(self.sweep), "-o", str(folder), "--shards",
                               str(shards), "--program", str(lab.PROGRAM), *options], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        return [line.split()[1] for line in done.stdout.splitlines() if line.startswith("job ")]

    def merge(self, folder, target):
        shards = [str(path) for path in sorted((folder / "shards").iterdir())]
        return subprocess.run([str(lab.PROGRAM), "merge", *shards, "-o", str(target)], capture_output=True, text=True)

    def test_cancelled_and_run_again(self):
        folder = self.scratch / "array"
        # MaxArraySize is 5, so that no index is above 4: six shards take two arrays.
        references, first, second = self.submit(folder, 6, "--at-once", "2")
        cancelled = f"{first}_3"
        subprocess.run(["scancel", cancelled], check=True)
        wait_until(lambda: not jobs(), "the jobs", 120)
        self.assertEqual(len(list((folder / "references").glob("*.exr"))), 2, "the first job makes them for all")
        refused = self.merge(folder, folder / "all")
        self.assertEqual(refused.returncode, 2)
        self.assertFalse((folder / "all").exists())
        self.assertIn(f"{folder}/shards/3", refused.stderr)

        script = folder / "slurm/sweep.sbatch"
        subprocess.run(["sbatch", "--array=3", "--export=ALL,OFFSET=0", str(script)], check=True, capture_output=True)
        wait_until(lambda: not jobs(), "the job", 120)
        merged = self.merge(folder, folder / "all")
        self.assertEqual(merged.returncode, 0, merged.stderr)
        self.check_same(folder / "all")
        self.assertTrue(all(row["threads"] == "1" for row in lab.rows(folder / "all").values()))

    def test_requeued_at_work(self):
        folder = self.scratch / "requeued"
        before = self.sweep
        try:
            type(self).sweep = lab.write_sweep(self.scratch / "slow.json", seeds=range(1, 31))
            job = self.submit(folder, 2, "--cpus-per-task", "2", "--sweep=--timeout=600")[1]
            trials = folder / "shards/1/trials"
            wait_until(lambda: trials.is_dir() and len(list(trials.glob("[!.]*"))) > 2, "some trials", 120)
            kept = lab.record_times(folder / "shards/1")
            subprocess.run(["scontrol", "requeue", f"{job}_1"], check=True)
            wait_until(lambda: jobs().get(f"{job}_1") == "PENDING", "the requeued task")
            held = said("scontrol", "show", "job", f"{job}_1").split("JobId=")[1].split()[0]
            subprocess.run(["scontrol", "update", f"JobId={held}", "StartTime=now"], check=True)
            wait_until(lambda: not jobs(), "the jobs", 180)
            self.assertEqual(self.merge(folder, folder / "all").returncode, 0)
            rows = lab.rows(folder / "all")
            self.assertEqual(len(rows), 180)
            self.assertTrue(all(row["status"] == "done" and row["threads"] == "2" for row in rows.values()))
            after = lab.record_times(folder / "shards/1")
            self.assertEqual({trial: after[trial] for trial in kept}, kept, "done again")
            self.assertIn("interrupted", "".join(log.read_text() for log in (folder / "slurm").glob("*.log")))
        finally:
            type(self).sweep = before


if __name__ == "__main__":
    lab.main()

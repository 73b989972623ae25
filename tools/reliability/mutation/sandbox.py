"""Runs a test program that may be broken in any way: it sees all files but may write only into its own folder, its signals
reach nobody else, its memory and time are limited."""
import os
import resource
import shutil
import signal
import subprocess

MEMORY = 6 << 30  # bytes; more than any test takes
# GoogleTest captures output in /tmp whatever TMPDIR says.
INNER = ('for place in $0; do mount -o remount,bind,ro "$place" || exit 99; done; '
         'mount --bind "$TMPDIR" /tmp || exit 99; exec "$@"')


class Sandbox:
    """A folder in memory and the mounts that are read-only within; needs root, for the mounts."""

    def __init__(self, folder, tree):
        if os.geteuid() != 0:
            raise ValueError("mutants can remove files and send signals: the sandbox they run in needs root")
        self.folder = folder
        holds = subprocess.run(["findmnt", "-n", "-o", "TARGET", "--target", tree], check=True, capture_output=True,
                               text=True).stdout.strip()
        self.mounts = " ".join(dict.fromkeys(["/", holds]))
        self.clean()

    def clean(self):
        if self.folder.exists() and any(self.folder.iterdir()):
            shutil.rmtree(self.folder)
        (self.folder / "tmp").mkdir(parents=True, exist_ok=True)

    def run(self, command, seconds, **environment):
        """Exit code and output; the code is None where the time was over."""
        self.clean()
        inside = ["unshare", "--mount", "--pid", "--fork", "--kill-child", "--mount-proc", "sh", "-c", INNER, self.mounts]
        with subprocess.Popen([*inside, *command], cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, start_new_session=True, preexec_fn=limit_memory,
                              env={**os.environ, "TMPDIR": str(self.folder / "tmp"), **environment}) as process:
            try:
                output = process.communicate(timeout=seconds)[0]
                return process.returncode, output.decode(errors="replace")
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                process.communicate()
                return None, ""


def limit_memory():
    resource.setrlimit(resource.RLIMIT_DATA, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

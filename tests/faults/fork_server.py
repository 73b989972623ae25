"""The program with the library call_faults preloaded: every run is a fork of one process that has loaded all libraries."""
import dataclasses
import os
import pathlib
import select
import signal
import subprocess


@dataclasses.dataclass
class Run:
    """How a run ended."""
    code: int      # exit code, or minus the number of a signal
    hung: bool     # killed after its time
    count: int     # calls of the kind
    fired: int     # calls made to fail
    call: str      # the first of them
    path: str      # and its file
    out: str
    err: str


class ForkServer:
    """Runs of one program, one after the other, on one processor so that the order of calls repeats."""

    def __init__(self, program, library, scratch):
        self.output = pathlib.Path(scratch) / "output"
        environment = dict(os.environ, LD_PRELOAD=str(library), CALL_FAULTS_SERVER="1")
        self.process = subprocess.Popen([str(program)], env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        bufsize=0, preexec_fn=self.stay_on_one_processor)

    @staticmethod
    def stay_on_one_processor():
        os.sched_setaffinity(0, [max(os.sched_getaffinity(0))])

    def begin(self, folder, *arguments, kind="none", nth=0, error=0, sticky=False, root="", trace=""):
        """Starts a run; returns its process."""
        fields = [kind, nth, error, int(sticky), root, trace, self.output, folder, *arguments]
        self.process.stdin.write(("\t".join(str(field) for field in fields) + "\n").encode())
        return int(self.line(60).split()[1])

    def end(self, process, timeout=60):
        """Waits for a run."""
        line, hung = self.line(timeout), False
        if not line:
            hung = True
            os.killpg(process, signal.SIGKILL)
            line = self.line(60)
        _, status, count, fired, call, *path = line.split(" ")
        status = int(status)
        code = os.waitstatus_to_exitcode(status)
        out, err = (pathlib.Path(f"{self.output}{ending}").read_text(errors="replace") for ending in (".out", ".err"))
        return Run(code, hung, int(count), int(fired), call, " ".join(path).strip(), out, err)

    def run(self, folder, *arguments, timeout=60, **fault):
        return self.end(self.begin(folder, *arguments, **fault), timeout)

    def line(self, timeout):
        """An answer; empty when there is none in that time."""
        if not select.select([self.process.stdout], [], [], timeout)[0]:
            return ""
        text = b""
        while not text.endswith(b"\n"):
            part = self.process.stdout.read(1)
            if not part:
                raise RuntimeError("the server of runs has ended")
            text += part
        return text.decode(errors="replace")

    def close(self):
        self.process.stdin.close()
        self.process.wait()

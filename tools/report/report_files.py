"""What the tools that make reports from records share: whole files, and failures reported in one line."""
import os
import signal
import sys
import time

from report import records

PACKAGES = "Debian's python3-matplotlib and python3-scipy"


def write(path, content):
    """Whole files only, whatever stops the program or the machine: a reader never sees half of one."""
    part = f"{path}.part"
    if os.path.islink(part) or os.path.isfile(part):
        os.remove(part)  # of a killed process, or a link that leads elsewhere
    try:
        with open(os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666), "wb") as file:
            file.write(content.encode("utf-8") if isinstance(content, str) else content)
            file.flush()
            os.fsync(file.fileno())  # before it has its name: a disk may take the two in any order
        os.replace(part, path)
    except BaseException:  # Ctrl-C too
        if os.path.isfile(part):
            os.remove(part)
        raise
    folder = os.open(os.path.dirname(path) or ".", os.O_RDONLY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)


def require_place(path):
    """A new file would replace a link, a pipe or a device."""
    if os.path.islink(path):
        raise records.RecordsError(f"{path}: is a symbolic link, which a new file would replace; name the file it leads to")
    if os.path.exists(path) and not os.path.isfile(path):
        raise records.RecordsError(f"{path}: is no regular file, which a new file would replace")
    folder = os.path.dirname(path) or "."
    if not os.path.isdir(folder):
        raise records.RecordsError(f"{path}: its folder is not there")


def no_folder(path):
    """The path, or the first above it that is there, where that is no folder; else None: a folder can be made."""
    above = os.path.abspath(path)
    while not os.path.lexists(above):
        above = os.path.dirname(above)
    return None if os.path.isdir(above) else above


def end_on_interrupt(tool):
    """From now on Ctrl-C ends the program with exit code 130 and one line, wherever it is."""
    def end(*_):
        write_at_once(f"{tool}: interrupted\n")
        raise SystemExit(130)
    signal.signal(signal.SIGINT, end)


def write_at_once(text):
    """Past Python's buffer of standard error, which Ctrl-C may find half-written and then refuses to take more."""
    try:
        os.write(2, text.encode("utf-8", "replace"))
    except OSError:  # nobody listens
        pass


class Progress:
    """One line on a terminal about the work on `steps` things of about the same cost; elsewhere nothing."""

    def __init__(self, tool, steps):
        self.tool, self.steps, self.done, self.shown = tool, steps, 0, 0
        self.start = time.monotonic()
        self.terminal = sys.stderr.isatty()

    def step(self, what):
        """Another thing is begun."""
        now = time.monotonic()
        if self.terminal and now - self.shown > 0.2:
            self.shown = now
            left = (now - self.start) / self.done * (self.steps - self.done) if self.done else None
            eta = "-" if left is None else f"{int(left) // 60}:{int(left) % 60:02}"
            line = f"{self.tool}: [{self.done}/{self.steps}] ETA {eta}, {what}"
            self.write(line[:os.get_terminal_size(sys.stderr.fileno()).columns - 1])
        self.done += 1

    def end(self):
        """Nothing stays of the line."""
        if self.terminal:
            self.write("")

    @staticmethod
    def write(line):
        write_at_once(f"\r\033[K{line}")


def report(tool, what, output, make):
    """Runs make(); returns the exit code: 0 done, 2 bad input. `what` is the part that needs a package."""
    try:
        make()
    except records.RecordsError as error:
        return fail(tool, error)
    except ImportError as error:
        return fail(tool, f"{error}: {what} need {PACKAGES} (run by /usr/bin/python3)")
    except OSError as error:
        return fail(tool, f"{error.filename or output}: {error.strerror}")
    return 0


def fail(tool, reason):
    print(f"{tool}: {reason}", file=sys.stderr)
    return 2

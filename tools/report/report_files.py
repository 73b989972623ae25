"""What the tools that make reports from records share: whole files, and failures reported in one line."""
import os
import sys

from report import records

PACKAGES = "Debian's python3-matplotlib and python3-scipy"


def write(path, text):
    """Whole files only, whatever stops the program or the machine: a reader never sees half of one."""
    part = f"{path}.part"
    try:
        with open(part, "w", encoding="utf-8", newline="\n") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())  # before it has its name: a disk may take the two in any order
        os.replace(part, path)
    except OSError:
        if os.path.isfile(part):
            os.remove(part)
        raise
    folder = os.open(os.path.dirname(path) or ".", os.O_RDONLY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)


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

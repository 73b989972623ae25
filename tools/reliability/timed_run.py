"""A program's output and the processor seconds that it took."""

import resource
import subprocess


def timed_run(command):
    """Standard output, and user seconds of the processor. Raises CalledProcessError for an exit code other than 0."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    result = subprocess.run(command, check=True, capture_output=True, text=True)
    return result.stdout, resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before

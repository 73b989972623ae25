"""A program's output and the processor seconds that it took."""

import resource
import subprocess


def timed_run(command):
    """Standard output, and user seconds of the processor. Raises CalledProcessError for an exit code other than 0."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    result = subprocess.run(command, check=True, capture_output=True, text=True)
    return result.stdout, resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def processor_seconds(command):
    """User and system seconds of the processor. Raises CalledProcessError for an exit code other than 0."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

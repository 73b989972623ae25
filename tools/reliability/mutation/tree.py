"""The copy of the sources that holds all mutants at once, and its build."""
import re
import shutil
import subprocess

from mutation import schemata
from mutation.drawing import rewritten, without_lines

HOOK = "target_sources(caustics_core PRIVATE \"${PROJECT_SOURCE_DIR}/mutant.cpp\")  # the mutants' switch\n"


class Tree:
    """A copy of what git knows of the sources at `path`, built by preset ci; files are written only where they differ, so
    that a build that is there goes on."""

    def __init__(self, root, path, jobs):
        self.root, self.path, self.jobs = root, path, jobs
        self.build = path / "build" / "ci"

    def copy(self):
        names = subprocess.run(["git", "ls-files", "-z"], cwd=self.root, check=True, capture_output=True, text=True).stdout
        for name in filter(None, names.split("\0")):
            source = self.root / name
            if source.is_file() and write(self.path / name, source.read_bytes()):
                shutil.copymode(source, self.path / name)

    def plant(self, sites, names):
        """Writes the rewritten files and the switch."""
        count = max(site.number for site in sites) + 1
        write(self.path / "mutant.h", schemata.HEADER.encode())
        write(self.path / "mutant.cpp", schemata.SOURCE.replace("@COUNT@", str(count)).encode())
        core = self.root / "core" / "CMakeLists.txt"
        write(self.path / "core" / "CMakeLists.txt", core.read_bytes() + HOOK.encode())
        for name in names:
            own = [site for site in sites if site.file == name]
            text = (self.root / name).read_bytes()
            write(self.path / name, rewritten(text, own) if own else text)

    def configure(self):
        """What a parser of the sources needs: the compiler's commands and the generated header."""
        for command in (["cmake", "--preset", "ci"], ["ninja", "-C", self.build, "caustics_build_info_header"]):
            subprocess.run(command, cwd=self.path, check=True, stdout=subprocess.DEVNULL)

    def compile(self, sites, names, targets):
        """Builds until nothing fails; the sites that are left when those in lines with errors are gone."""
        while True:
            self.plant(sites, names)
            done = subprocess.run(["ninja", "-C", self.build, "-k", "0", "-j", str(self.jobs), *targets],
                                  capture_output=True, text=True)
            if done.returncode == 0:
                return sites
            left = self.without_errors(sites, done.stdout)
            if len(left) == len(sites):
                raise ValueError(f"the tree is not built: {done.stdout[-3000:]}")
            print(f"{len(sites) - len(left)} mutants are not compiled by the tree's compiler", flush=True)
            sites = left

    def without_errors(self, sites, output):
        lines = {}
        for name, line in re.findall(rf"^{re.escape(str(self.path))}/(\S+?):(\d+):\d+: (?:error|note|.*required)", output,
                                     re.MULTILINE):
            lines.setdefault(name, set()).add(int(line))
        return [site for site in sites if site.file not in lines or without_lines([site], lines[site.file])]


def write(path, content):
    """Whether the file was another one before."""
    if path.exists() and path.read_bytes() == content:
        return False
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)
    return True

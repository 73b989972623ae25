"""Tests that pip installs every package by version and hashes, from files that name no registry."""
import pathlib
import re
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
FILES = sorted((ROOT / "tools").glob("*-requirements.txt"))
PYTHONS = ("Python 3.11", "Python 3.13")  # of Debian 12 and 13


def packages(text):
    """{package==version: its hashes}; raises ValueError for a line of another form."""
    found = {}
    for line in re.sub(r"\\\n", " ", re.sub(r"(?m)^#.*\n", "", text)).splitlines():
        name, *hashes = line.split()
        if not re.fullmatch(r"[a-z0-9.-]+==[0-9][0-9a-z.]*", name) or not hashes:
            raise ValueError(f"not pinned by version and hash: {line}")
        for each in hashes:
            if not re.fullmatch(r"--hash=sha256:[0-9a-f]{64}", each):
                raise ValueError(f"no hash: {line}")
        found[name] = hashes
    return found


class Requirements(unittest.TestCase):
    def test_every_package_has_its_version_and_hashes(self):
        self.assertEqual([file.name for file in FILES], ["crosscheck-requirements.txt", "flip-requirements.txt", "format-requirements.txt"])
        for file in FILES:
            text = file.read_text(encoding="utf-8")
            self.assertTrue(packages(text), file.name)
            for python in PYTHONS:
                self.assertIn(python.split()[1], text, file.name)

    def test_what_is_not_pinned_is_found(self):
        digest = "--hash=sha256:" + 64 * "a"
        self.assertEqual(packages(f"# words\nnumpy==2.1 \\\n    {digest}\n"), {"numpy==2.1": [digest]})
        for line in ("numpy", "numpy>=1.24", "numpy==2.1", f"numpy>=2 {digest}", "numpy==2.1 --hash=md5:abc", "--index-url host"):
            with self.assertRaises(ValueError, msg=line):
                packages(line + "\n")

    def test_one_version_of_a_package_serves_all_files(self):
        versions = {}
        for file in FILES:
            for name in packages(file.read_text(encoding="utf-8")):
                project, _, version = name.partition("==")
                versions.setdefault(project, set()).add(version)
        self.assertEqual({project: each for project, each in versions.items() if len(each) > 1}, {}, "they share one .venv")

    def test_pip_installs_from_these_files_alone(self):
        names = {f"tools/{file.name}" for file in FILES}
        listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", "--", "*.sh", "*.py", "*.md", ".ci/run"],
                                cwd=ROOT, capture_output=True, text=True, check=True).stdout
        installs = {}
        for path in filter(None, listed.split("\0")):
            file = ROOT / path
            if file.is_file() and file != pathlib.Path(__file__).resolve():
                text = re.sub(r"\s*\n#?\s*", " ", file.read_text(encoding="utf-8"))
                installs |= {(path, words): None for words in re.findall(r"pip3? install ((?:-\S+ )*\S+)", text)}
        self.assertTrue(installs)
        for path, words in installs:
            self.assertIn(words.split()[-1].strip("`)'\",.;"), names | {"$wanted"}, path)


if __name__ == "__main__":
    unittest.main()

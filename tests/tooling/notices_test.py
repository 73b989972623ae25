"""notices_test.py BUILD: what `cmake --install` leaves has LICENSE and THIRD-PARTY.md, which names every library of its programs."""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 else ROOT / "build" / "ci"
HEADERS = ("Eigen", "nlohmann_json", "CLI11")  # libraries that leave no file to link with


def named(text):
    """{file name without its version: its row} of the table."""
    rows = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| ") and line.count("|") == 6]
    return {name: row for row in rows[1:] for name in re.findall(r"`([^`]+)`", row[1])} | {row[0]: row for row in rows[1:]}


def stem(library):
    """libpng16 of libpng16.so.16, libOpenEXR of libOpenEXR-3_1.so.30, ld-linux of ld-linux-x86-64.so.2."""
    return re.sub(r"(-[\d_.]+|-x86-64|-aarch64)?\.so.*$", "", pathlib.Path(library).name)


def linked(program):
    """The libraries that a program or module names."""
    dynamic = subprocess.run(["readelf", "-d", program], capture_output=True, text=True, check=True).stdout
    return re.findall(r"\(NEEDED\).*\[(.*)\]", dynamic)


def loaded(program):
    """The libraries that come with a program as it starts."""
    told = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout
    return [line.split()[0] for line in told.splitlines() if "linux-vdso" not in line]


class Notices(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.prefix = pathlib.Path(cls.folder.name)
        subprocess.run(["cmake", "--install", BUILD, "--prefix", cls.prefix], check=True, capture_output=True)
        cls.notices = next(cls.prefix.rglob("THIRD-PARTY.md"))
        cls.rows = named(cls.notices.read_text(encoding="utf-8"))

    def installed_programs(self):
        files = [path for path in self.prefix.rglob("*") if path.is_file() and not path.is_symlink()]
        found = [path for path in files if path.read_bytes()[:4] == b"\x7fELF"]
        self.assertIn("causticbench", [path.name for path in found])
        return found

    def test_the_licence_and_the_notices_are_installed(self):
        for name in ("LICENSE", "THIRD-PARTY.md"):
            self.assertEqual((self.notices.parent / name).read_bytes(), (ROOT / name).read_bytes())

    def test_every_library_that_a_program_is_linked_with_is_named(self):
        for program in self.installed_programs():
            for library in linked(program) + (loaded(program) if program.name == "causticbench" else []):
                self.assertIn(stem(library), self.rows, f"{program.name} is linked with {library}")

    def test_libraries_of_headers_alone_are_named(self):
        for name in HEADERS:
            self.assertIn(name, self.rows)

    def test_every_row_has_a_licence_and_where_its_text_stands(self):
        for name, row in self.rows.items():
            self.assertEqual(len(row), 5, name)
            self.assertTrue(all(field.strip() for field in row), name)


if __name__ == "__main__":
    unittest.main()

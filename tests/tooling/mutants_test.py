"""tools/reliability/mutation: which places are sites, what they become, and that one program holds all mutants."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "tools" / "reliability"))

try:
    from clang.cindex import Index

    from mutation import drawing, page, schemata
    from mutation.sites import Finder, Site
    from mutation.suite import Test
    from mutation.trial import Trials
    Index.create()
except Exception as missing:
    # The library is looked for by the first call, and what it raises is a class of the module that may be missing.
    if not isinstance(missing, ImportError) and type(missing).__name__ != "LibclangError":
        raise
    print(f"skipped: no clang.cindex (Debian: python3-clang): {missing}")
    sys.exit(77)

SOURCE = """#include <algorithm>
#include <cstdio>
static_assert(1 + 1 == 2);
enum Kind { kind = 4 };
constexpr int twice(int x) { return 2 * x; }
int shifted(int x, int by = 3) { return x + by; }
double least(double x, double y) { return std::min(x, y); }
bool inside(double x) { return x < 8 &&
    x > -x; }
bool above(double x, double y) { return x < y; }
int main() {
    int sum = 0;  // not 0
    sum += shifted(
        twice(2), 5);
    switch (sum) { case 9: sum = sum - 1; }
    if (!inside(sum)) std::printf("%d ", sum);
    std::printf("%g %d\\n", least(2, 3), above(1, sum));
}
"""

class Mutants(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.file = self.folder / "small.cpp"
        self.file.write_text(SOURCE, encoding="utf-8")
        unit = Index.create().parse(str(self.file), ["-std=c++20"], options=drawing.OPTIONS)
        self.sites = Finder(unit, self.file, "small.cpp").sites

    def test_what_the_compiler_must_know_is_no_site(self):
        lines = {site.line for site in self.sites}
        self.assertFalse(lines & {1, 2, 3, 4, 5})
        self.assertEqual([site.after for site in self.sites if site.line == 6], ["x - by"])
        self.assertNotIn("10", [site.after for site in self.sites if site.line == 15])  # the label of a case

    def test_each_operator_finds_its_places(self):
        self.assertEqual({site.operator for site in self.sites},
                         {"relation", "arithmetic", "logic", "condition", "constant", "deletion", "sign", "min-max"})
        of_reals = [site.after for site in self.sites if site.line == 10]
        self.assertEqual(of_reals, ["x >= y"])  # a tie of two computed reals tells nothing
        self.assertIn("x <= 8", [site.after for site in self.sites if site.line == 8])

    def test_constants_are_moved_to_others(self):
        self.assertEqual(schemata.constants("7U"), ["8U", "6U"])
        self.assertEqual(schemata.constants("0"), ["1"])
        self.assertEqual(schemata.constants("0.0F"), ["1.0F"])
        self.assertEqual(schemata.constants("1e-3"), ["2 * 1e-3", "0.0"])
        self.assertEqual(schemata.constants("true"), ["false"])

    def test_drawn_sites_are_disjoint_and_the_same_by_the_same_seed(self):
        draws = [drawing.disjoint([[site] for site in self.sites], 5, 100) for _ in range(2)]
        self.assertEqual(draws[0], draws[1])
        for i, site in enumerate(draws[0]):
            self.assertEqual(site.number, i)
            self.assertFalse(any(site.meets(other) for other in draws[0][:i]))

    def test_lines_keep_their_numbers(self):
        for site in self.sites:
            text = drawing.rewritten(self.file.read_bytes(), [site]).decode().split("#line 1\n")[1]
            self.assertEqual(text.count("\n"), SOURCE.count("\n"), site)

    def test_one_program_is_every_mutant(self):
        wanted = [("arithmetic", "x - by"), ("min-max", "std::max(x, y)"), ("relation", "x >= y"), ("deletion", "")]
        sites = [next(site for site in self.sites if (site.operator, site.after) == what) for what in wanted]
        for number, site in enumerate(sites):
            site.number = number
        program = self.build(sites)
        self.assertEqual(self.said(program), "8 2 1")
        said = [self.said(program, CAUSTICS_MUTANT=str(number)) for number in range(4)]
        self.assertEqual(said, ["-1 2 0", "8 3 1", "8 2 0", "0 2 0"])
        note = self.folder / "reached"
        self.said(program, CAUSTICS_MUTANTS_REACHED=str(note))
        self.assertEqual(note.read_text(encoding="utf-8").split(), ["0", "1", "2", "3"])

    def build(self, sites):
        text = drawing.rewritten(self.file.read_bytes(), sites)
        (self.folder / "mutant.h").write_text(schemata.HEADER, encoding="utf-8")
        (self.folder / "mutant.cpp").write_text(schemata.SOURCE.replace("@COUNT@", str(len(sites))), encoding="utf-8")
        (self.folder / "all.cpp").write_bytes(text)
        program = self.folder / "program"
        subprocess.run(["c++", "-std=c++20", f"-I{self.folder}", self.folder / "all.cpp", self.folder / "mutant.cpp", "-o",
                        program], check=True)
        return program

    def said(self, program, **environment):
        done = subprocess.run([program], check=True, capture_output=True, text=True, env={**os.environ, **environment})
        return done.stdout.strip()


class Answers:
    """A sandbox whose tests fail as they are told; notes the filters it was asked for."""

    def __init__(self, failing):
        self.failing = failing
        self.asked = []

    def run(self, command, _, **_environment):
        names = command[1].split("=")[1].split(":")
        self.asked += names
        failed = [name for name in names if name in self.failing]
        return (1, f"[  FAILED  ] {failed[0]} (1 ms)\n") if failed else (0, "")


class Rounds(unittest.TestCase):
    SITES = [Site("core/a.cpp", 7 + n, n, n + 1, "constant", "1", "a | b", "", n) for n in range(3)]

    def trials(self, box, budget, *names, since=0):
        tests = [Test(f"unit.{name}", "unit", name, 1, since if name == "New.one" else 0, frozenset({0, 1})) for name in names]
        return Trials(tests, box, budget)

    def test_what_survived_is_asked_what_it_was_not_asked_before(self):
        first = self.trials(Answers([]), 1, "Old.one", "Old.two").judge(self.SITES[0])
        self.assertEqual((first["status"], first["asked"], first["reaching"], first["round"]), ("survived", 1, 2, 1))
        self.assertIsNone(self.trials(Answers([]), 1, "Old.one", "Old.two").judge(self.SITES[0], first))
        box = Answers(["New.one"])
        later = self.trials(box, 1, "Old.one", "Old.two", "New.one", since=first["at"] + 1).judge(self.SITES[0], first)
        self.assertEqual(box.asked, ["New.one"])
        self.assertEqual((later["status"], later["by"], later["round"]), ("killed", "unit.New.one", 2))
        self.assertIsNone(self.trials(box, 9, "Old.one").judge(self.SITES[0], later))
        box = Answers([])
        longer = self.trials(box, 9, "Old.one", "Old.two").judge(self.SITES[0], first)
        self.assertEqual(sorted(box.asked), ["Old.one", "Old.two"])
        self.assertIsNone(self.trials(box, 99, "Old.one", "Old.two").judge(self.SITES[0], longer))

    def test_the_page_tells_what_came_of_each(self):
        trials = self.trials(Answers(["Old.one"]), 9, "Old.one")
        rows = [trials.judge(site) for site in self.SITES]
        rows[1].update(status="survived", by="")
        text = page.text(self.SITES, rows, {1: ("equivalent", "A sum of one.")})
        self.assertIn("| folder | tried | killed at first | killed since | equivalent | not reached |\n", text)
        self.assertIn("| core | 3 | 1 |  | 1 | 1 |\n", text)
        self.assertIn("| 1 | core/a.cpp:8 | `1` | `a \\| b` | equivalent | A sum of one. |", text)
        self.assertNotIn("core/a.cpp:7", text)

    def test_words_on_mutants_are_read_whole(self):
        with tempfile.NamedTemporaryFile("w+", suffix=".tsv") as file:
            file.write("# no.\tclass\treason\n4\topen\tWhy.\n5\topen\n")
            file.flush()
            with self.assertRaisesRegex(ValueError, "5\topen"):
                page.words(pathlib.Path(file.name))


if __name__ == "__main__":
    unittest.main()

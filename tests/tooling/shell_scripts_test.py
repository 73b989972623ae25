"""The shell scripts from outside, with programs of the test's own where they would install, build or fetch."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPTS = [ROOT / ".ci" / "run", *sorted((ROOT / "tools").glob("*.sh"))]


class Sandbox(unittest.TestCase):
    """A folder with copies of scripts and with programs that go before those of the machine."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, lines):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("#!/bin/bash\n" + lines + "\n")
        path.chmod(0o755)

    def copy(self, name):
        (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, self.folder / name)

    def run_script(self, name, *arguments, **environment):
        path = f"{self.folder}/programs:{os.environ['PATH']}"
        return subprocess.run(["bash", self.folder / name, *arguments], text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, env={**os.environ, "PATH": path, "CI": "", **environment})


class AllScripts(unittest.TestCase):
    def test_parse_and_can_be_run(self):
        for script in SCRIPTS:
            self.assertEqual(subprocess.run(["bash", "-n", script]).returncode, 0, script)
            self.assertTrue(os.access(script, os.X_OK), script)


    def test_refuse_a_wrong_word_without_a_build(self):
        for name, *words in (("reproduce", "nosuchpaper"), ("reproduce", "--nope"), ("reproduce", "--only", "nosuchsection"),
                             ("reproduce", "chen2011", "--only", "counts"), ("reproduce", "--qick"), ("reproduce", "--smoke", "--full"),
                             ("duel", "--nope"), ("duel", "--only", "nosuchscene"), ("duel", "--jobs", "0"), ("duel", "--smoke", "--keep"),
                             ("quickstart", "--nope"), ("quickstart", "--force", "extra"), ("quickstart", "--jobs")):
            said = self.run_unbuilt(name, *words)
            self.assertEqual((said.returncode, said.stdout), (2, ""), words)
            self.assertIn(words[-1], said.stderr, words)
        self.assertIn("prism", self.run_unbuilt("reproduce", "chen2011", "--only", "nosuchsection").stderr)
        self.assertIn("lens, crystal", self.run_unbuilt("duel", "--only", "nosuchscene").stderr)

    def run_unbuilt(self, name, *words):
        return subprocess.run(["bash", f"tools/{name}.sh", *words], cwd=ROOT, text=True, capture_output=True, env={**os.environ, "CAUSTICS_BENCH": ""})

    def test_list_what_they_run_without_a_build(self):
        listed = self.run_unbuilt("reproduce", "--list", "chen2011")
        self.assertEqual((listed.returncode, listed.stderr), (0, ""))
        self.assertIn("  prism\n  crystal\n", listed.stdout)
        self.assertNotIn("  counts\n", listed.stdout, "a section of another paper")
        listed = self.run_unbuilt("duel", "--list")
        self.assertEqual((listed.returncode, listed.stderr), (0, ""))
        self.assertIn("lens: plano-convex lens\n", listed.stdout)

    def test_tell_of_themselves_without_a_build(self):
        for name in ("reproduce", "duel", "quickstart"):
            for option in ("-h", "--help"):
                said = subprocess.run(["bash", f"tools/{name}.sh", option], cwd=ROOT, text=True, capture_output=True)
                self.assertEqual((said.returncode, said.stderr), (0, ""), name)
                self.assertTrue(said.stdout.startswith(f"{name}.sh ["), said.stdout)


class SetUp(Sandbox):
    """tools/setup.sh where apt-get fails in the lines of `failing`, each tried in turn."""

    def run_setup(self, apt_get):
        self.copy("tools/setup.sh")
        self.write("programs/dpkg-query", "echo not-installed")
        self.write("programs/id", "echo 0")
        self.write("programs/sleep", "")
        self.write("programs/apt-get", f'echo "$*" >>{self.folder}/calls\ncalls=$(wc -l <{self.folder}/calls)\n{apt_get}')
        done = self.run_script("tools/setup.sh", "bonus")
        return done, (self.folder / "calls").read_text().splitlines()

    def test_installs_what_is_named_as_well(self):
        done, calls = self.run_setup("")
        self.assertEqual((done.returncode, len(calls)), (0, 4), done.stdout)
        self.assertTrue(calls[-1].endswith(" bonus"), calls[-1])

    def test_fetches_again(self):
        done, calls = self.run_setup('[ "$calls" -ge 3 ]')
        self.assertEqual((done.returncode, len(calls)), (0, 6), done.stdout)

    def test_gives_up_fetching_with_a_code_of_its_own(self):
        for what, count in (("update", 3), ("--download-only", 5)):
            with self.subTest(what):
                (self.folder / "calls").unlink(missing_ok=True)
                done, calls = self.run_setup(f'[[ "$*" != *{what}* ]]')
                self.assertEqual((done.returncode, len(calls)), (75, count), done.stdout)
                self.assertIn("setup: 'apt-get", done.stdout)

    def test_a_package_that_does_not_exist_is_no_matter_of_fetching(self):
        done, _ = self.run_setup('[[ "$*" != *--simulate* ]]')
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("setup: apt-get cannot install: ", done.stdout)


class FreshDebian(Sandbox):
    def refusal(self, *arguments):
        self.copy("tools/fresh_debian.sh")
        done = self.run_script("tools/fresh_debian.sh", *arguments)
        self.assertEqual(len(done.stdout.splitlines()), 1, done.stdout)
        return done.returncode, done.stdout

    def test_wants_a_release_and_a_line(self):
        self.assertEqual(self.refusal("trixie"), (2, "fresh_debian: usage: tools/fresh_debian.sh RELEASE LINE...\n"))

    def test_refuses_what_is_no_release(self):
        self.assertEqual(self.refusal("../13", "true")[0], 2)

    def test_says_that_only_root_can(self):
        self.write("programs/id", "echo 1000")
        self.assertEqual(self.refusal("trixie", "true"), (69, "fresh_debian: only root can make a chroot\n"))

    def test_says_which_program_is_missing(self):
        self.write("programs/id", "echo 0")
        for name in ("bash", "dirname"):
            (self.folder / "programs" / name).symlink_to(shutil.which(name))
        self.copy("tools/fresh_debian.sh")
        done = subprocess.run([shutil.which("bash"), self.folder / "tools/fresh_debian.sh", "trixie", "true"], text=True,
                              stderr=subprocess.PIPE, env={"PATH": f"{self.folder}/programs"})
        self.assertEqual((done.returncode, done.stderr), (69, "fresh_debian: needs the Debian package debootstrap\n"))


class Reproduce(Sandbox):
    """tools/reproduce.sh and tools/duel.sh with a build and a tool that only say what they are asked."""

    def reproduced(self, *words, script="reproduce.sh", tool="reproduce.py", **environment):
        self.copy(f"tools/{script}")
        self.write("tools/build.sh", 'echo "build $*"')
        (self.folder / "tools" / tool).write_text("import sys\nprint(*sys.argv[1:])\n")
        return self.run_script(f"tools/{script}", *words, **environment).stdout.splitlines()

    def test_builds_and_hands_its_words_on(self):
        self.assertEqual(self.reproduced("jensen1996", "--quick", CAUSTICS_BENCH=""),
                         ["--check jensen1996 --quick", "build release causticbench",
                          "--program build/release/bin/causticbench jensen1996 --quick"])

    def test_takes_a_program_that_is_there(self):
        self.assertEqual(self.reproduced(CAUSTICS_BENCH="/a/program"), ["--program /a/program"])

    def test_says_where_it_was_called_from(self):
        self.copy("tools/reproduce.sh")
        (self.folder / "tools/reproduce.py").write_text("import os\nprint(os.environ['CAUSTICS_CALLED_FROM'])\n")
        self.assertEqual(self.run_script("tools/reproduce.sh", CAUSTICS_BENCH="/a/program").stdout.strip(), os.getcwd())

    def test_what_runs_nothing_needs_no_build(self):
        for words in (["--list"], ["--pages"], ["--compare"], ["--check", "--full"]):
            self.assertEqual(self.reproduced(*words, CAUSTICS_BENCH=""), [" ".join(words)])
        for words in (["--list"], ["--page"]):
            self.assertEqual(self.reproduced(*words, script="duel.sh", tool="measure_duel.py", CAUSTICS_BENCH=""), [" ".join(words)])

    def test_the_duel_does_the_same(self):
        duel = lambda *words, **environment: self.reproduced(*words, script="duel.sh", tool="measure_duel.py", **environment)
        self.assertEqual(duel("--quick", CAUSTICS_BENCH=""),
                         ["--check --quick", "build release causticbench",
                          "--program build/release/bin/causticbench --quick"])
        self.assertEqual(duel(CAUSTICS_BENCH="/a/program"), ["--program /a/program"])


class ContinuousIntegration(Sandbox):
    """.ci/run over scripts that end with given exit codes."""

    CLOSING = "100% tests passed, 0 tests failed out of "

    def run_ci(self, test=0, setup=0, build=0, fresh=0, **environment):
        self.copy(".ci/run")
        self.write("tools/test.sh", f'[ $# = 0 ] && echo {self.CLOSING}800 || echo "test $*"; exit {test}')
        self.write("tools/setup.sh", f"exit {setup}")
        self.write("tools/build.sh", f"echo build $*; exit {build}")
        self.write("tools/fresh_debian.sh", f'echo fresh "$@"; echo {self.CLOSING}500; exit {fresh}')
        done = self.run_script(".ci/run", **environment)
        return done.returncode, done.stdout

    def test_runs_all_parts_and_closes_with_the_whole_suite(self):
        code, text = self.run_ci()
        self.assertEqual(code, 0, text)
        self.assertRegex(text, r"test -R \S*report_browser.*\n")
        self.assertIn("build clang\n", text)
        self.assertRegex(text, "fresh (trixie|bookworm) ")
        for command in ("tools/quickstart.sh", "tools/reproduce.sh --smoke", "tools/duel.sh --smoke"):
            self.assertIn(f" {command} ", text, "what README promises on a fresh Debian")
        closing = [line for line in text.splitlines() if "tests passed" in line]
        self.assertEqual(closing[-1], self.CLOSING + "800")
        self.assertNotIn("NOT CHECKED", text)

    def test_ends_at_the_first_failure(self):
        for failing, absent in (("test", "build clang"), ("build", "fresh "), ("fresh", "NOT CHECKED")):
            with self.subTest(failing):
                code, text = self.run_ci(**{failing: 8})
                self.assertEqual(code, 8, text)
                self.assertNotIn(absent, text)

    def test_says_loudly_what_could_not_be_fetched(self):
        for failing in ({"setup": 75}, {"fresh": 75}):
            code, text = self.run_ci(**failing)
            self.assertEqual(code, 0, text)
            self.assertRegex(text, "######## NOT CHECKED: Debian (trixie|bookworm) ")
            self.assertEqual(self.run_ci(**failing, CI="true")[0], 75, "continuous integration checks everything")

    def test_lets_no_test_go_without_its_packages(self):
        self.assertEqual(self.run_ci(test=75)[0], 75)

    def test_asks_for_a_chroot_where_it_is_called_continuous_integration(self):
        self.assertEqual(self.run_ci(fresh=69, CI="true")[0], 69)
        code, text = self.run_ci(fresh=69)
        self.assertEqual(code, 0, text)
        self.assertIn("NOT CHECKED: Debian ", text)


if __name__ == "__main__":
    unittest.main()

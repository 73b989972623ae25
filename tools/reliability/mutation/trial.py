"""One mutant against the tests that reach it, until one of them notices or the budget is spent."""
import re
import time
from collections import Counter, defaultdict

FIRST_SLICE = 0.2  # seconds of tests; the next slices are twice as long each
START = 0.1  # seconds to start a program


class Trials:
    """Remembers which tests notice mutants of which file: they are asked first."""

    def __init__(self, tests, sandbox, budget):
        self.tests, self.sandbox, self.budget = tests, sandbox, budget
        self.kills = defaultdict(Counter)

    def judge(self, site, last=None):
        """The result as a dict: status (killed, survived, unreached), by which test, how many tests, seconds, and the
        round. With the result of the round before, None where there is nothing more to ask."""
        tests = [test for test in self.tests if site.number in test.reached]
        reaching = len(tests)
        if last:
            if last["status"] == "killed":
                return None
            if last["asked"] == last["reaching"] or last["budget"] >= self.budget:
                tests = [test for test in tests if test.since > last["at"]]
            if not tests:
                return None
        begin, asked, killer = time.monotonic(), 0, ""
        for some in slices(self.by_promise(site, tests), self.budget):
            asked += len(some)
            killer = self.run(site, some)
            if killer:
                self.remember(site, killer)
                break
        status = "killed" if killer else "survived" if reaching else "unreached"
        if last and len(tests) < reaching:
            asked += last["asked"]
        return {"number": site.number, "status": status, "by": killer, "reaching": reaching, "asked": asked,
                "budget": self.budget, "seconds": round(time.monotonic() - begin, 2), "at": time.time(),
                "round": last["round"] + 1 if last else 1}

    def by_promise(self, site, tests):
        """Cheap and narrow tests first, and those that noticed other mutants of the file."""
        known = self.kills[site.file]
        return sorted(tests, key=lambda test: (test.seconds + 0.01) * len(test.reached) ** 0.5 / (1 + 4 * known[test.name]))

    def remember(self, site, killer):
        if killer:
            self.kills[site.file][killer] += 1

    def run(self, site, tests):
        """The test that notices, "" where none does; all tests are of one program."""
        names = ":".join(test.filter for test in tests)
        most = 5 + 10 * (START + sum(test.seconds for test in tests))
        code, output = self.sandbox.run([tests[0].program, f"--gtest_filter={names}", "--gtest_fail_fast"], most,
                                        CAUSTICS_MUTANT=str(site.number))
        if code == 0:
            return ""
        if code == 99:
            raise ValueError("the sandbox cannot be made: " + output)
        prefix = tests[0].name[:-len(tests[0].filter)]
        failed = re.search(r"^\[  FAILED  \] (\w\S*\.[^\s,]+)", output, re.MULTILINE)
        if failed:
            return prefix + failed[1]
        begun = re.findall(r"^\[ RUN      \] (\S+)", output, re.MULTILINE)
        return prefix + (begun[-1] if begun else tests[0].filter)


def slices(tests, budget):
    """Lists of tests of one program each, longer and longer, in the given order, within so many seconds in all."""
    spent, length, current = 0, FIRST_SLICE, []
    for test in tests:
        if spent + test.seconds > budget:
            continue
        spent += test.seconds
        current.append(test)
        if sum(t.seconds for t in current) >= length:
            yield from by_program(current)
            length, current = 2 * length, []
    yield from by_program(current)


def by_program(tests):
    programs = {}
    for test in tests:
        programs.setdefault(test.program, []).append(test)
    return programs.values()

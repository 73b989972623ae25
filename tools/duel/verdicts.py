"""Whether a hypothesis holds: each case's interval against the region that experiments/duel/hypotheses.json names."""
import dataclasses
import math

from duel.ranges import OUTSIDE, words
from papers.verdict import FAILS, HOLDS, UNDECIDED, UNMEASURED


@dataclasses.dataclass
class Case:
    """What was measured in one case; `low` and `high` end its 95 % interval. A bound has an infinite end, or 0.

    Of a ratio `found` has what makes its interval.
    """
    name: str
    value: float
    low: float
    high: float
    note: str = ""
    found: object = None

    @classmethod
    def of(cls, name, found, note=""):
        return cls(name, found.value, *found.ends(), note, found)

    def is_hidden(self, *places):
        """Whether the truth's own error hides on which side of one of these places it lies."""
        return self.found is not None and any(self.found.is_hidden(place) for place in places)

    def text(self):
        return words(self.value, self.low, self.high)

    def widened(self, outside):
        """The same with an interval that leaves out less."""
        return self if self.found is None else dataclasses.replace(self, **dict(zip(("low", "high"), self.found.ends(outside))))


def ends(region, case):
    """(low, high) of a region in words."""
    region = region["cases"][case] if "cases" in region else region
    if "between" in region:
        return tuple(region["between"])
    return (region["above"], math.inf) if "above" in region else (-math.inf, region["below"])


def is_hidden(case, region):
    """Whether the truth's own error hides on which side of an end of the region the case lies."""
    return case.is_hidden(*ends(region, case.name))


def judge_case(case, region):
    low, high = ends(region, case.name)
    if is_hidden(case, region):
        return UNDECIDED
    if low <= case.low and case.high <= high:
        return HOLDS
    return FAILS if case.high < low or case.low > high else UNDECIDED


def judge(hypothesis, cases, outside=OUTSIDE):
    """The verdict over all cases, and each case's own."""
    own = [judge_case(case.widened(outside), hypothesis["region"]) for case in cases]
    if not own:
        return UNMEASURED, own
    if FAILS in own:
        return FAILS, own
    return (HOLDS if all(each == HOLDS for each in own) else UNDECIDED), own

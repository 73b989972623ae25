"""Whether a hypothesis holds: each case's interval against the region that experiments/duel/hypotheses.json names."""
import dataclasses
import math

from papers.verdict import FAILS, HOLDS, UNDECIDED, UNMEASURED


@dataclasses.dataclass
class Case:
    """What was measured in one case; `low` and `high` end its 95 % interval. A bound has an infinite end."""
    name: str
    value: float
    low: float
    high: float
    note: str = ""

    def text(self):
        if self.low == self.high:
            return f"{self.value:.3g}"
        if self.high == math.inf and self.low == self.value:
            return f"> {self.value:.3g}"
        if self.low == 0 and self.high == self.value:
            return f"< {self.value:.3g}"
        return f"{self.value:.3g} ({self.low:.3g} to {self.high:.3g})"


def ends(region, case):
    """(low, high) of a region in words."""
    region = region["cases"][case] if "cases" in region else region
    if "between" in region:
        return tuple(region["between"])
    return (region["above"], math.inf) if "above" in region else (-math.inf, region["below"])


def judge_case(case, region):
    low, high = ends(region, case.name)
    if low <= case.low and case.high <= high:
        return HOLDS
    return FAILS if case.high < low or case.low > high else UNDECIDED


def judge(hypothesis, cases):
    """The verdict over all cases, and each case's own."""
    own = [judge_case(case, hypothesis["region"]) for case in cases]
    if not own:
        return UNMEASURED, own
    if FAILS in own:
        return FAILS, own
    return (HOLDS if all(each == HOLDS for each in own) else UNDECIDED), own

"""A paper's numbers and claims: experiments/papers/NAME.json, the one place where they are typed."""
import json
import math
import pathlib

from report.records import RecordsError

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = ROOT / "experiments" / "papers"
PUBLISHED = ROOT / "results" / "papers"
NAMES = ("jensen1996", "chuang1995", "chen2011")
REGIONS = ("above", "below", "between", "factor", "at_most")


class Paper:
    """`text` is the file; `number(name)` and `value(claim)` are what the paper prints, and ratios of that."""

    def __init__(self, name):
        self.name = name
        self.text = json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))
        check(self)

    def number(self, name):
        return self.text["numbers"][name]["value"]

    def value(self, claim):
        """What the paper's number in a claim is: a number, a ratio of two, of two such ratios, or None where it is said in words."""
        paper = claim["paper"]
        quotient = lambda names: self.number(names[0]) / self.number(names[1])
        if "ratio" in paper:
            return quotient(paper["ratio"]) / (quotient(paper["over"]) if "over" in paper else 1)
        return self.number(paper["number"]) if "number" in paper else None

    def region(self, claim):
        """(low, high): where ours has to lie for the claim to hold."""
        (kind, bound), = claim["region"].items()
        if kind == "between":
            return tuple(bound)
        if kind == "factor":
            return self.value(claim) / bound, self.value(claim) * bound
        if kind == "above":
            return bound, math.inf
        return -math.inf, bound if kind == "below" else self.value(claim) * bound


def numbers_of(claim):
    """The names of the paper's numbers in a claim."""
    paper = claim["paper"]
    return [*paper.get("ratio", []), *paper.get("over", []), *([paper["number"]] if "number" in paper else [])]


def check(paper):
    """Every number has its place in the paper, every claim its numbers; raises RecordsError."""
    wrong = lambda what: RecordsError(f"experiments/papers/{paper.name}.json: {what}")
    for name, number in paper.text["numbers"].items():
        if not number.get("where") or not isinstance(number.get("value"), (int, float)):
            raise wrong(f'number "{name}": needs a value and the place in the paper, where')
    for each in paper.text.get("not_tested", []):
        if set(each) != {"claim", "where", "reason"}:
            raise wrong(f'not_tested: "{each.get("claim")}" needs claim, where and reason')
    seen = set()
    for claim in paper.text["claims"]:
        name = claim.get("id")
        for key in ("id", "group", "claim", "where", "paper", "unit", "region", "tolerance_from", "from"):
            if key not in claim:
                raise wrong(f'claim "{name}": no key "{key}"')
        if name in seen:
            raise wrong(f'claim "{name}" is there twice')
        seen.add(name)
        for number in numbers_of(claim):
            if number not in paper.text["numbers"]:
                raise wrong(f'claim "{name}": no number "{number}" (known: {", ".join(paper.text["numbers"])})')
        for key in ("by_construction", "missing"):
            if key in claim and not (isinstance(claim[key], str) and claim[key].strip()):
                raise wrong(f'claim "{name}": {key} needs a sentence that says why or what')
        if "by_construction" in claim and "missing" in claim:
            raise wrong(f'claim "{name}": by_construction and missing exclude each other')
        if not isinstance(claim.get("signed", False), bool):
            raise wrong(f'claim "{name}": signed has to be true or false')
        if len(claim["region"]) != 1 or next(iter(claim["region"])) not in REGIONS:
            raise wrong(f'claim "{name}": region has to be one of {", ".join(REGIONS)}')

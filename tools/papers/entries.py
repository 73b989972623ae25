"""The rows of verdicts.json: each claim of a paper beside what was measured for it."""
import math
import statistics

from papers.verdict import UNMEASURED, judge
from papers.words import short


def entries(study, part):
    """One for each claim, in the paper's order; raises where the parts measured something that is no claim, or forgot one."""
    claims = study.paper.text["claims"]
    names = {claim["id"] for claim in claims}
    if names != set(part.measured):
        raise ValueError(f"{study.paper.name}: claims without a measurement: {sorted(names - set(part.measured))}, "
                         f"measurements without a claim: {sorted(set(part.measured) - names)}")
    return [entry(study, claim, part.measured[claim["id"]]) for claim in claims]


def entry(study, claim, measured):
    region = study.paper.region(claim)
    verdict, ends = judge(measured, region)
    theirs = study.paper.value(claim)
    ours = statistics.median(measured.samples) if measured.samples else None
    command, minutes = study.cost(claim["from"])
    is_ratio = "ratio" in claim["paper"]
    parts = [part for part in (measured.top, measured.bottom) if part] or ([measured.samples] if measured.samples else [])
    return {
        "id": claim["id"], "group": claim["group"], "claim": claim["claim"], "where": claim["where"],
        "paper": stated(study.paper, claim), "paper_unit": "" if is_ratio else unit_of(study.paper, claim),
        "paper_ratio": theirs if is_ratio else None, "is_ratio": bool(measured.bottom) or is_ratio,
        "ours": ours, "spread": [min(measured.samples), max(measured.samples)] if measured.samples else None,
        "interval": list(ends) if ends else None, "samples": len(measured.samples), "counted": measured.counted,
        "made_of": [{"median": statistics.median(part), "least": min(part), "greatest": max(part)} for part in parts],
        "made_of_unit": measured.unit, "unit": claim["unit"],
        "factor_off": ours / theirs if ours is not None and theirs else None,
        "region": shown(region), "tolerance_from": claim["tolerance_from"], "verdict": verdict,
        "command": command if verdict != UNMEASURED else "", "minutes": round(minutes, 2) if verdict != UNMEASURED else 0.0,
        "note": measured.note}


def stated(paper, claim):
    """What the paper has: words, a number, or two that are divided; its seconds stand in a table of their own."""
    if "words" in claim["paper"]:
        return claim["paper"]["words"]
    if "number" in claim["paper"]:
        return paper.number(claim["paper"]["number"])
    if any(paper.text["numbers"][name]["unit"] == "s" for name in claim["paper"]["ratio"]):
        return "its seconds, below"
    return " over ".join(short(paper.number(name)) for name in claim["paper"]["ratio"])


def unit_of(paper, claim):
    return paper.text["numbers"][claim["paper"]["number"]].get("unit", "") if "number" in claim["paper"] else ""


def shown(region):
    low, high = region
    if low == high:
        return f"exactly {short(low)}"
    if math.isinf(low):
        return f"at most {short(high)}"
    return f"at least {short(low)}" if math.isinf(high) else f"{short(low)} to {short(high)}"

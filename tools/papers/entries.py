"""The rows of verdicts.json: each claim of a paper beside what was measured for it."""
import math
import statistics

from papers import verdict
from papers.verdict import UNMEASURED, judge, unmeasured
from papers.words import short


def entries(study, part, earlier=None):
    """One for each claim, in the paper's order. Where only some sections ran, `earlier` has {id: entry} of the others.

    Raises where the parts measured something that is no claim, or, without `earlier`, forgot one.
    """
    claims = study.paper.text["claims"]
    names = {claim["id"] for claim in claims}
    forgotten = names - set(part.measured) if earlier is None else set()
    if forgotten or set(part.measured) - names:
        raise ValueError(f"{study.paper.name}: claims without a measurement: {sorted(forgotten)}, "
                         f"measurements without a claim: {sorted(set(part.measured) - names)}")
    return [of_claim(study, claim, part.measured.get(claim["id"]), (earlier or {}).get(claim["id"])) for claim in claims]


def of_claim(study, claim, measured, earlier):
    if measured is None and earlier:
        return again(study.paper, claim, earlier)
    return entry(study, claim, measured or unmeasured(f"not run yet (tools/reproduce.sh {study.paper.name})"))


def entry(study, claim, measured):
    found, ends = judge(measured, study.paper.region(claim), claim.get("signed", False))
    ours = statistics.median(measured.samples) if measured.samples else None
    cost = study.cost(claim["from"] if found != UNMEASURED else [])
    parts = [part for part in (measured.top, measured.bottom) if part] or ([measured.samples] if measured.samples else [])
    return said(study.paper, claim, ours, bool(measured.bottom)) | {
        "ours": ours, "spread": [min(measured.samples), max(measured.samples)] if measured.samples else None,
        "interval": list(ends) if ends else None, "samples": len(measured.samples), "values": measured.samples, "counted": measured.counted,
        "made_of": [summary(part) for part in parts], "beside": {what: summary(part) for what, part in measured.beside.items()},
        "made_of_unit": measured.unit, "verdict": verdict.of_claim(found, claim), "section": measured.section,
        "command": cost.command, "again": f"tools/reproduce.sh {study.paper.name} --only {measured.section}" if measured.samples else "",
        "minutes": round(cost.seconds / 60, 2), "megabytes": round(cost.bytes / 1e6, 1), "note": measured.note}


def summary(samples):
    return {"median": statistics.median(samples), "least": min(samples), "greatest": max(samples), "values": samples}


def again(paper, claim, earlier):
    """An earlier run's measurement beside what the claim says now, with its interval and verdict from the kept values."""
    measured = verdict.Measured(earlier["values"], counted=earlier["counted"])
    found, ends = judge(measured, paper.region(claim), claim.get("signed", False))
    return earlier | said(paper, claim, earlier["ours"], earlier["is_ratio"]) | {
        "beside": earlier.get("beside", {}), "interval": list(ends) if ends else None, "verdict": verdict.of_claim(found, claim)}


def said(paper, claim, ours, is_quotient):
    """The part of a row that comes from the paper, and how far ours is off."""
    theirs, is_ratio = paper.value(claim), "ratio" in claim["paper"]
    return {
        "id": claim["id"], "group": claim["group"], "claim": claim["claim"], "where": claim["where"],
        "paper": stated(paper, claim), "paper_unit": "" if is_ratio else unit_of(paper, claim),
        "paper_ratio": theirs if is_ratio else None, "is_ratio": is_quotient or is_ratio, "unit": claim["unit"],
        "factor_off": ours / theirs if ours is not None and theirs else None,
        "region": shown(paper.region(claim)), "bounds": [None if math.isinf(end) else end for end in paper.region(claim)], "tolerance_from": claim["tolerance_from"],
        "by_construction": claim.get("by_construction", ""), "missing": claim.get("missing", "")}


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

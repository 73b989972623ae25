"""Jensen 1996, figure 2's rows of the table: photons, trees, N, look-up tables."""
import statistics

import numpy as np

from papers.jensen_ring import preprocess
from papers.part import Part, Table
from papers.verdict import Measured, counted, ratio
from papers.words import spread
from report.records import natural


def table(study):
    trials = study.sweep("figure2")
    few, many = (study.paper.number(name) for name in ("figure2_photons", "figure2_reference_photons"))
    seconds = lambda photons, tree="balanced": trials.column("render_cpu_s", method="photonmap", photons=photons, tree=tree)
    prepare = lambda photons, tree="balanced": preprocess(trials, method="photonmap", photons=photons, tree=tree)
    balance = lambda photons, tree: trials.column("balance_cpu_s", method="photonmap", photons=photons, tree=tree)
    bytes_of = lambda tree: trials.column("map_bytes", method="photonmap", photons=many, tree=tree)[0]
    grown = {tree: ratio(seconds(many, tree), seconds(few, tree), "CPU s") for tree in ("balanced", "unbalanced")}
    inserting = lambda photons: (f"of which building the tree photon by photon is {spread(balance(photons, 'unbalanced'), 'CPU s')}, balancing "
                                 f"{spread(balance(photons, 'balanced'), 'CPU s')}; the rest is tracing")
    unbalanced = ratio(seconds(few, "unbalanced"), seconds(few), "CPU s")
    return Part({
        "ball_unbalanced": unbalanced,
        "ball_doubled": unbalanced,
        "ball_unbalanced_many": ratio(seconds(many, "unbalanced"), seconds(many), "CPU s"),
        "ball_saved": saved(study),
        "ball_growth": grown["balanced"],
        "ball_growth_unbalanced": grown["unbalanced"],
        "ball_flatter": ratio(grown["unbalanced"].samples, grown["balanced"].samples, "times"),
        "ball_preprocess": ratio(prepare(many), prepare(few), "CPU s"),
        "ball_inserting": ratio(prepare(few, "unbalanced"), prepare(few), "CPU s", note=inserting(few)),
        "ball_inserting_many": ratio(prepare(many, "unbalanced"), prepare(many), "CPU s", note=inserting(many)),
        "ball_prepared": ratio(prepare(few), seconds(few), "CPU s"),
        "ball_prepared_many": ratio(prepare(many), seconds(many), "CPU s"),
        "ball_balancing": ratio(balance(many, "balanced"), prepare(many), "CPU s"),
        "ball_megabytes": counted(bytes_of("balanced") / 1e6, "MB", "follows from the paper's photons and the bytes of one"),
        "ball_pointers": counted(bytes_of("unbalanced") / bytes_of("balanced"), "",
                                 f"{bytes_of('unbalanced') / 1e6:.1f} over {bytes_of('balanced') / 1e6:.1f} MB")}, [times_table(trials, few, many)])


def times_table(trials, few, many):
    pick = lambda column, photons, tree: trials.column(column, method="photonmap", photons=photons, tree=tree)
    prepare = lambda photons, tree: preprocess(trials, method="photonmap", photons=photons, tree=tree)
    rows = [[f"{photons:,}", tree, spread(prepare(photons, tree)), spread(pick("balance_cpu_s", photons, tree)),
             spread(pick("render_cpu_s", photons, tree)), f"{pick('map_bytes', photons, tree)[0] / 1e6:.1f}"]
            for photons in (few, many) for tree in ("balanced", "unbalanced")]
    rows.append(["none", "", "", "", spread(trials.column("render_cpu_s", method="none")), ""])
    return Table("figure2", "Figure 2: photons and trees",
                 ["photons", "tree", "preprocess [CPU s]", "of which the tree", "rendering [CPU s]", "MB"], rows,
                 f"{rendering(trials)}; median and range of {len(trials.values('repeat'))} repeats on one thread. Preprocess: photons and tree.")


def rendering(trials, **wanted):
    """How pictures of a sweep are rendered, as words."""
    row = trials.where(method="photonmap", **wanted)[0]
    film = trials.record(row)["scene"]["resolved"]["sensor"]["film"]
    return f"{film['width']} × {film['height']} pixels, {row['spp']} rays a pixel, N = {row['nearest']}"


def saved(study):
    """The share of the rendering that balancing saves: at the N of the table, and over N."""
    trials, many = study.sweep("figure2"), study.paper.number("figure2_reference_photons")
    seconds = lambda tree: trials.column("render_cpu_s", method="photonmap", photons=many, tree=tree)
    bare = trials.column("render_cpu_s", method="none")
    less = [1 - (a - b) / (c - b) for a, b, c in zip(seconds("balanced"), bare, seconds("unbalanced"))]
    found = ratio(seconds("balanced"), seconds("unbalanced"), "CPU s")
    found.samples = [1 - each for each in found.samples]
    return Measured(found.samples, note=f"{spread(seconds('balanced'))} against {spread(seconds('unbalanced'), 'CPU s')}; less the eye pass without "
                    f"caustic, {spread(bare, 'CPU s')}: {spread(less)}; over N: {shares_over_n(study)}")


def over_nearest(study):
    """{N: trials that have it}: the table's N, with its repeats, and others with one each."""
    sweeps = study.sweep("figure2"), study.sweep("figure2_nearest")
    found = {nearest: trials for trials in sweeps for nearest in trials.values("nearest")}
    return {nearest: found[nearest] for nearest in sorted(found, key=natural)}


def shares_over_n(study):
    many = study.paper.number("figure2_reference_photons")
    seconds = lambda trials, nearest, tree: statistics.median(trials.column("render_cpu_s", nearest=nearest, photons=many, tree=tree))
    share = lambda trials, nearest: 1 - seconds(trials, nearest, "balanced") / seconds(trials, nearest, "unbalanced")
    return ", ".join(f"{share(trials, nearest):.3g} at N = {nearest}" for nearest, trials in over_nearest(study).items())


def sensitivity(study):
    few, many = (study.paper.number(name) for name in ("figure2_photons", "figure2_reference_photons"))
    rows = []
    for nearest, trials in over_nearest(study).items():
        seconds = lambda photons, tree: trials.column("render_cpu_s", nearest=nearest, photons=photons, tree=tree)
        over = lambda a, b: ratio(a, b, "").samples
        rows.append([nearest, len(seconds(few, "balanced")), spread(over(seconds(few, "unbalanced"), seconds(few, "balanced"))),
                     spread(over(seconds(many, "unbalanced"), seconds(many, "balanced"))),
                     spread([1 - each for each in over(seconds(many, "balanced"), seconds(many, "unbalanced"))]),
                     spread(over(seconds(many, "balanced"), seconds(few, "balanced"))),
                     spread(over(seconds(many, "unbalanced"), seconds(few, "unbalanced")))])
    return Part(tables=[Table("figure2_nearest", "Figure 2: how much N matters",
                              ["N", "repeats", "unbalanced / balanced, fewer photons", "unbalanced / balanced, more photons", "share saved there",
                               "more / fewer photons, balanced", "more / fewer photons, unbalanced"], rows,
                              f"CPU times of rendering; {few:,} and {many:,} photons, otherwise as in the table above.")],
                facts={"ball_saved_over_n": shares_over_n(study)})


def lookup(study):
    """Rendering with tables of the BRDF over the directions that a photon can have."""
    trials = study.sweep("figure2_tables")
    seconds = lambda tables: trials.column("render_cpu_s", tables=tables)
    difference = np.abs(trials.picture(tables="true")[""] - trials.picture(tables="false")[""]).max() / trials.picture(tables="false")[""].max()
    return Part({"lookup_tables": ratio(seconds("true"), seconds("false"), "CPU s",
                                        note=f"{rendering(trials)}; the pictures, in half floats, differ by {difference:.1g} of their maximum")})


SECTIONS = {"figure2-table": table, "figure2-nearest": sensitivity, "figure2-tables": lookup}

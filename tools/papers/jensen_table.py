"""Jensen 1996, the table: preprocess, memory, look-up tables; trees in two orders of emission, judged by the nodes that searches visit."""
import statistics

import numpy as np

from papers.jensen_ring import preprocess
from papers.part import Part, Table
from papers.verdict import Measured, counted, ratio
from papers.words import spread

ORDERS = {"random": "", "stratified": "_strata"}  # the order of emission, and the end of its claims' names
WORDS = {"random": "at random", "stratified": "stratum by stratum"}
TREES = ("balanced", "unbalanced")
MILLION = 1e6


def table(study):
    trials = study.sweep("figure2")
    few, many = (study.paper.number(name) for name in ("figure2_photons", "figure2_reference_photons"))
    seconds = lambda photons, tree="balanced": trials.column("render_cpu_s", method="photonmap", photons=photons, tree=tree)
    prepare = lambda photons, tree="balanced": preprocess(trials, method="photonmap", photons=photons, tree=tree)
    balance = lambda photons, tree: trials.column("balance_cpu_s", method="photonmap", photons=photons, tree=tree)
    bytes_of = lambda tree: trials.column("map_bytes", method="photonmap", photons=many, tree=tree)[0]
    return Part({
        "ball_preprocess": ratio(prepare(many), prepare(few), "CPU s"),
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


def lookup(study):
    """Rendering with tables of the BRDF over the directions that a photon can have."""
    trials = study.sweep("figure2_tables")
    seconds = lambda tables: trials.column("render_cpu_s", tables=tables)
    difference = np.abs(trials.picture(tables="true")[""] - trials.picture(tables="false")[""]).max() / trials.picture(tables="false")[""].max()
    return Part({"lookup_tables": ratio(seconds("true"), seconds("false"), "CPU s",
                                        note=f"{rendering(trials)}; the pictures, in half floats, differ by {difference:.1g} of their maximum")})


class Searches:
    """Counts and times of the trials of one order of emission: `pick` has a column of a tree and a number of photons."""

    def __init__(self, trials, order, **wanted):
        self.pick = lambda column, tree, **more: trials.column(column, emission=order, tree=tree, **wanted, **more)

    def nodes(self, tree, **more):
        return [each / MILLION for each in self.pick("nodes_visited", tree, **more)]

    def seconds(self, tree, **more):
        return self.pick("render_cpu_s", tree, **more)

    def prepared(self, tree, **more):
        return [a + b for a, b in zip(self.pick("precompute_cpu_s", tree, **more), self.pick("balance_cpu_s", tree, **more))]


def over(top, bottom):
    return [a / b for a, b in zip(top, bottom, strict=True)]


def visits(searches, top, bottom):
    """Nodes visited over nodes visited, with the times of rendering beside; `top` and `bottom` are a tree and what tells its trials."""
    of = lambda column, case: column(case[0], **case[1])
    return ratio(of(searches.nodes, top), of(searches.nodes, bottom), "million nodes",
                 beside={"ratio of CPU times of rendering": over(of(searches.seconds, top), of(searches.seconds, bottom))})


def saved(searches, **photons):
    """The share that balancing saves: of the nodes, and beside it of the rendering."""
    share = lambda column: [1 - each for each in over(column("balanced", **photons), column("unbalanced", **photons))]
    nodes = [searches.nodes(tree, **photons) for tree in TREES]
    return Measured(share(searches.nodes), note=f"{spread(nodes[0])} against {spread(nodes[1])} million nodes",
                    beside={"share of the CPU time of rendering": share(searches.seconds)})


def inserting(searches, **photons):
    """The preprocess with the unbalanced tree over that with the balanced one, with the counter of insertion beside."""
    passed = over(searches.pick("nodes_passed", "unbalanced", **photons), searches.pick("photons_stored", "unbalanced", **photons))
    return ratio(searches.prepared("unbalanced", **photons), searches.prepared("balanced", **photons), "CPU s",
                 beside={"nodes that a photon passes on its way into the unbalanced tree": passed})


def ball(study):
    trials = study.sweep("figure2_orders")
    few, many = ({"photons": study.paper.number(name)} for name in ("figure2_photons", "figure2_reference_photons"))
    part = Part()
    for order, end in ORDERS.items():
        searches = Searches(trials, order)
        grown = {tree: visits(searches, (tree, many), (tree, few)) for tree in TREES}
        unbalanced = visits(searches, ("unbalanced", few), ("balanced", few))
        found = {"ball_unbalanced": unbalanced, "ball_doubled": unbalanced,
                 "ball_unbalanced_many": visits(searches, ("unbalanced", many), ("balanced", many)),
                 "ball_saved": saved(searches, **many), "ball_growth": grown["balanced"], "ball_growth_unbalanced": grown["unbalanced"],
                 "ball_flatter": steeper(grown), "ball_inserting": inserting(searches, **few), "ball_inserting_many": inserting(searches, **many)}
        part.measured |= {f"{name}{end}": each for name, each in found.items()}
    part.tables.append(orders_table(trials, "figure2_orders", "Figure 2: trees over the order of emission", (few, many)))
    part.measured["ball_in_place"] = in_place(trials, few, many)
    part.facts["ball_trees"] = trees(trials, few)
    return part


def in_place(trials, few, many):
    """Memory that the larger map takes beyond the smaller, over its photons' own: 2 where balancing needs a copy."""
    more = lambda column: [a - b for a, b in zip(*(trials.column(column, tree="balanced", **photons) for photons in (many, few)))]
    megabytes = lambda column: [each / 1e6 for each in more(column)]
    return ratio(megabytes("peak_rss_bytes"), megabytes("map_bytes"), "MB", note="peak of resident memory, both orders of emission")


def steeper(grown):
    """The growth with the photons, unbalanced over balanced."""
    found = ratio(grown["unbalanced"].samples, grown["balanced"].samples, "times")
    name, = grown["balanced"].beside
    found.beside = {name: over(grown["unbalanced"].beside[name], grown["balanced"].beside[name])}
    return found


def trees(trials, photons):
    """Nodes visited, unbalanced over balanced, in both orders, as words."""
    found = {order: visits(Searches(trials, order), ("unbalanced", photons), ("balanced", photons)) for order in ORDERS}
    return " and ".join(f"{spread(each.samples)} {WORDS[order]}" for order, each in found.items())


def orders_table(trials, name, title, numbers):
    rows = []
    for order in ORDERS:
        searches = Searches(trials, order)
        for photons in numbers:
            for tree in TREES:
                gathers = searches.pick("gathers", tree, **photons)
                levels = tree_levels(trials, order, tree, photons)
                rows.append([WORDS[order], *(f"{each:,}" for each in photons.values()), tree, levels, spread(over(searches.pick("nodes_visited", tree, **photons), gathers)),
                             spread(searches.seconds(tree, **photons)), spread(searches.prepared(tree, **photons))])
    return Table(name, title, ["photons come", "photons", "tree", "levels", "nodes visited a search", "rendering [CPU s]", "preprocess [CPU s]"], rows,
                 f"{film(trials)}, one value a seed. A tree has a photon at every node. Nodes are counted, so no clock decides; CPU times are further apart than nodes.")


def tree_levels(trials, order, tree, photons):
    """Levels of a tree: those of the balanced one follow from its number of photons."""
    rows = trials.where(emission=order, tree=tree, **photons)
    if tree == "balanced":
        return str(int(float(rows[0]["photons_stored"])).bit_length())
    return spread([trials.record(row)["counters"]["tree_depth"] for row in rows])


def film(trials):
    """How the pictures of a sweep are rendered, as words."""
    row = trials.where(method="photonmap")[0]
    size = trials.record(row)["scene"]["resolved"]["sensor"]["film"]
    return f"{size['width']} × {size['height']} pixels, {row['spp']} rays a pixel, N = {', '.join(trials.values('nearest'))}, {len(trials.values('seed'))} seeds"


def ball_nearest(study):
    """The share of nodes that balancing saves over N, in both orders."""
    photons = {"photons": study.paper.number("figure2_photons")}
    found = {}
    for trials in (study.sweep("figure2_orders_nearest"), study.sweep("figure2_orders")):
        for nearest in trials.values("nearest"):
            for order in ORDERS:
                found[int(nearest), order] = saved(Searches(trials, order, nearest=nearest), **photons)
    rows = [[nearest, WORDS[order], len(each.samples), spread(each.samples), *(spread(some) for some in each.beside.values())]
            for (nearest, order), each in sorted(found.items())]
    table = Table("figure2_orders_nearest", "Figure 2: how much N matters to balancing",
                  ["N", "photons come", "seeds", "share of the nodes saved", "share of the rendering saved [CPU s]"], rows,
                  f"{photons['photons']:,} photons, otherwise as in the table above.")
    over_n = lambda order: ", ".join(f"{statistics.median(found[nearest, order].samples):.3g} at N = {nearest}"
                                     for nearest in sorted({nearest for nearest, _ in found}))
    return Part(tables=[table], facts={"ball_saved_over_n": "; ".join(f"{WORDS[order]} {over_n(order)}" for order in ORDERS)})


def cognac(study):
    trials = study.sweep("figure3_orders")
    photons = {"photons": study.paper.number("figure3_photons")}
    part = Part()
    for order, end in ORDERS.items():
        searches = Searches(trials, order)
        unbalanced = visits(searches, ("unbalanced", photons), ("balanced", photons))
        part.measured |= {f"cognac_unbalanced{end}": unbalanced, f"cognac_doubled{end}": unbalanced,
                          f"cognac_inserting{end}": inserting(searches, **photons)}
    part.tables.append(orders_table(trials, "figure3_orders", "Figure 3: trees over the order of emission", (photons,)))
    part.facts["cognac_trees"] = trees(trials, photons)
    return part


SECTIONS = {"figure2-table": table, "figure2-tables": lookup, "figure2-orders": ball, "figure2-orders-nearest": ball_nearest,
            "figure3-orders": cognac}

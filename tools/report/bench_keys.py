"""What tools/bench_ratios measures: the keys, where their numbers come from, what they must reach."""
import math
import re

from report.paper import Paper

JENSEN = Paper("jensen1996")
FEW, MANY = (str(JENSEN.number(name)) for name in ("figure2_photons", "figure2_reference_photons"))
MESHES = ("pool33k", "pool524k", "ball65k", "ball261k")
BEAMS = ("7442", "131072")


def geometric_mean(values):
    values = list(values)
    if not values:
        raise KeyError("no measurements")
    if len(values) == 1:
        return values[0]  # to the last digit
    return math.exp(sum(math.log(value) for value in values) / len(values))


class Ratio:
    """The geometric mean of counter `above` over counter `below`, over the benchmarks that match."""

    def __init__(self, above, below, *prefixes):
        self.above, self.below, self.prefixes = above, below, prefixes

    def of(self, runs):
        """`runs`: benchmark name -> counters, of one repetition."""
        chosen = [run for name, run in runs.items() if name.startswith(self.prefixes)]
        return geometric_mean(run[self.above] / run[self.below] for run in chosen)


class SpeedUp(Ratio):
    """One thread's time over two threads', as a share of the same ratio of the raw rays."""

    def of(self, runs):
        def gain(run, counter):
            return run[counter + "_1"] / run[counter + "_2"]
        chosen = [run for name, run in runs.items() if name.startswith(self.prefixes)]
        return geometric_mean(gain(run, self.above) / gain(run, self.below) for run in chosen)


class Across:
    """The geometric mean of one counter of benchmark `above` over that of benchmark `below`, over
    pairs of names."""

    def __init__(self, counter, pairs):
        self.counter, self.pairs = counter, pairs
        self.prefixes = tuple(name for pair in pairs for name in pair)

    def of(self, runs):
        return geometric_mean(runs[above][self.counter] / runs[below][self.counter]
                              for above, below in self.pairs if above in runs and below in runs)


class Key:
    """A key of ratios.json, and its single measurements by name (`parts`): its value is the
    geometric mean of those whose names match `headline`, and it meets a mark when every part does.

    Marks are `must` and `goal`; one number for all instruction sets or one by instruction set; `marks`
    gives parts marks of their own. Ratios should be at least the mark, or `at_most`.
    """

    def __init__(self, name, what, program, parts, must=None, goal=None, at_most=False, marks=None,
                 headline="", beside=""):
        self.name, self.what, self.program, self.parts = name, what, program, parts
        self.at_most, self.beside = at_most, beside
        self._headline = re.compile(headline)
        self._marks, self._part_marks = (must, goal), marks or {}

    def marks(self, part, isa):
        """(must, goal) of a part; None where there is no mark."""
        def of_isa(mark):
            return mark.get(isa) if isinstance(mark, dict) else mark
        return tuple(of_isa(mark) for mark in self._part_marks.get(part, self._marks))

    def headline(self, parts):
        """Of the parts that were measured, those that make the key's own value; all when none does."""
        return [part for part in parts if self._headline.search(part)] or list(parts)

    def meets(self, value, mark):
        return value <= mark if self.at_most else value >= mark

    def prefixes(self):
        """Of the benchmarks that the key needs."""
        return sorted({prefix for part in self.parts.values() for prefix in part.prefixes})


def by_isa(avx512, avx2):
    return {"avx512": avx512, "avx2": avx2}


def both(above, below, *prefixes):
    return {"": Ratio(above, below, *prefixes)}


def unbalanced_parts():
    parts = {}
    for count in (FEW, MANY):
        for order in ("random", "shuffled_strata", "r2", "scanline_strata"):
            if (count, order) == (MANY, "scanline_strata"):
                continue  # minutes of inserting, a thousand levels deep
            for caustic in ("a", "b"):
                name = f"{caustic}/{count}/{order}"
                parts[f"queries {name}"] = Ratio("unbalanced", "balanced", f"unbalanced/{name}")
    for count in (FEW, MANY):
        parts[f"rendering {count}"] = Ratio("unbalanced", "balanced", f"rendering/{count}")
    return parts


def beam_parts(above, tile="two_slice_tile"):
    """A peer's time a query over the tree of slices', which answers tiles together."""
    return {f"{order} {beams} {waves}": Ratio(above, tile, f"query/{waves}/{beams}/{order}")
            for order in ("tiles", "random") for beams in BEAMS for waves in ("calm", "folded")}


def beam_marks(few, many):
    """Marks of the tiles' parts by the number of beams; random points are reported."""
    marks = dict(zip(BEAMS, (few, many)))
    return {part: marks[part.split()[1]] if part.startswith("tiles") else (None, None)
            for part in beam_parts("scan")}


def beam_tests():
    return {f"{kind} {beams} {waves}": Ratio(f"two_slice_{kind}_tests", f"hybrid_{kind}_tests",
                                             f"query/{waves}/{beams}/tiles")
            for kind in ("cone", "beam") for beams in BEAMS for waves in ("calm", "folded")}


class Sum(Ratio):
    """The sum of some counters over one."""

    def of(self, runs):
        chosen = [run for name, run in runs.items() if name.startswith(self.prefixes)]
        return geometric_mean(sum(run[one] for one in self.above) / run[self.below] for run in chosen)


def tracing_parts():
    return {f"{emission} {mesh}": Ratio("replay", "trace", f"tracing/{mesh}/{emission}")
            for emission in ("stratified", "random") for mesh in MESHES}


def tracing_marks():
    marks = {"stratified": (0.65, 0.75), "random": (0.5, 0.6)}
    return {part: marks[part.split()[0]] for part in tracing_parts()}


KEYS = [
    Key("balanced_build_vs_nanoflann", "building the balanced tree in place", "kd_tree",
        both("nanoflann", "balanced", "build/"), by_isa(4, 3), 8),
    Key("packed_build_vs_nanoflann", "building the packed tree in place", "kd_tree",
        both("nanoflann", "packed", "build/"), by_isa(8, 5), 16),
    Key("packed_knn_vs_nanoflann", "k nearest, packed tree; nanoflann at its best leaf size", "kd_tree",
        both("nanoflann", "packed", "knn/"), by_isa(8, 4), 13),
    Key("packed_knn_vs_nanoflann_heap", "the same; nanoflann with a binary heap", "kd_tree",
        both("nanoflann_heap", "packed", "knn/"), by_isa(5, 2.5), 8),
    Key("packed_tile_vs_nanoflann", "4x4 tiles of 1280x960 queries, k = 100", "kd_tree",
        both("nanoflann", "packed", "tile/"), by_isa(15, 8), 30),
    Key("balanced_knn_vs_nanoflann", "k = 100 nearest, balanced tree", "kd_tree",
        both("nanoflann", "balanced", *(f"knn/{c}/{n}/100/" for c in "ab" for n in (FEW, MANY))), 1.2, 2),
    Key("query_cost_20x_photons", "time at 5.04 M photons over time at 250 k, k = 100", "kd_tree",
        {"queries packed": Ratio("packed_5M", "packed_250k", "cost/"),
         "queries balanced": Ratio("balanced_5M", "balanced_250k", "cost/"),
         "rendering packed": Ratio("packed_5M", "packed_250k", "rendering/cost"),
         "rendering balanced": Ratio("balanced_5M", "balanced_250k", "rendering/cost")},
        1.5, 1.15, at_most=True, headline="^queries", beside="the paper's renderings: 1.52"),
    Key("unbalanced_vs_balanced", "query time on the fly over balanced, k = 100, and whole renderings",
        "kd_tree", unbalanced_parts(), headline="^queries .*/random$",
        beside="the paper's renderings: 2.08 (250 k), 5.0 (5 M)"),
    Key("shading_vs_tables", "100 photons, Schlick, alpha 0.1; scalar code with tables", "shading",
        both("tables", "ours", "shading/"), by_isa(2, 1.5), 3),
    Key("shading_vs_libm", "the same; scalar code with sinf and cosf", "shading",
        both("libm", "ours", "shading/"), by_isa(6, 3), 10),
    Key("tables_vs_libm", "the parameter `tables`; scalar code with sinf and cosf", "shading",
        both("libm", "ours_tables", "shading/")),
    Key("phong_vs_tables", "the same for Phong, exponent 30; scalar code with tables and powf", "shading",
        both("tables", "ours", "shading_phong/"), 3),
    Key("tracing_vs_raw_embree", "the same rays through nothing but Embree, over photon tracing", "tracing",
        tracing_parts(), marks=tracing_marks()),
    Key("tracing_two_threads", "speed-up by a second thread, as a share of the raw rays' own", "tracing",
        {emission: SpeedUp("trace", "replay", *(f"tracing_threads/{mesh}/{emission}" for mesh in MESHES))
         for emission in ("stratified", "random")}, 0.9, 1),
    Key("stratified_vs_random_emission", "photons per second", "tracing",
        {"": Across("trace", [(f"tracing/{mesh}/random", f"tracing/{mesh}/stratified") for mesh in MESHES])},
        1.5, 2),
    Key("beam_query_vs_brute_force", "a scan of all beams' rays, 8 at a time, over two_slice", "beam_tree",
        beam_parts("scan"), marks=beam_marks((80, 150), (800, 2500)), headline="^tiles"),
    Key("beam_query_vs_slice_scan", "the same scan of rays that are on two planes already", "beam_tree",
        beam_parts("slice_scan"), headline="^tiles"),
    Key("beam_query_vs_embree_point_query", "Embree's boxes with two time steps, rtcPointQuery, over two_slice",
        "beam_tree", beam_parts("embree"), marks=beam_marks((2, 3), (2, 3)), headline="^tiles"),
    Key("two_slice_vs_hybrid", "time a query of the paper's tree over two_slice, point by point and by tiles",
        "beam_tree", {**{f"alone {part}": ratio for part, ratio in beam_parts("hybrid", "two_slice").items()},
                      **beam_parts("hybrid")}, 3, headline="^alone tiles"),
    Key("two_slice_tests_vs_hybrid", "tests a query, point by point, over those of the paper's tree; the same "
        "successes", "beam_tree", beam_tests(), at_most=True, headline="folded$",
        marks={part: (0.5, 0.35) for part in beam_tests() if part.endswith("folded")}),
    Key("beam_build_vs_embree_build", "beams and trees of a mesh over rtcCommitScene of it, 131,072 triangles",
        "beam_tree", {"refracted light": Sum(("beams", "tree"), "embree", "build/"),
                      "reflected light as well": Sum(("beams", "tree", "tree_reflected"), "embree", "build/")},
        10, 4, at_most=True, headline="^refracted"),
    Key("cost_growth_16x_beams", "time a query at 131,072 beams over that at 7,442", "beam_tree",
        {f"{order} {waves}": Ratio("two_slice_131k", "two_slice_7k", f"cost/{waves}/{order}")
         for order in ("tiles", "random") for waves in ("calm", "folded")}, 2, 1.5, at_most=True,
        marks={f"random {waves}": (None, None) for waves in ("calm", "folded")}, headline="^tiles"),
    Key("area_light_trees", "a query through a tree for each of 16 lamp points over one through a tree of all",
        "beam_tree", {"": Ratio("apart", "together", "area/")}),
]

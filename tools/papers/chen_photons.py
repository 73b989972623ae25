"""Chen 2011: n² samples regular and jittered, where rays are needed, roulette against split, searching the tree, filters, maps, shadow photons,
photons shared by power, an ambient term."""
import json
import statistics

import numpy as np

from papers.chen_bowls import reached
from papers.figures import luminance, mean_of, strip
from papers.part import Figure, Part, Table
from papers.verdict import Measured, counted, in_common, interval, ratio
from papers.words import short, spread
from report import exr
from report.records import natural

BLOCK = 8  # pixels
NEAR = 144  # the first row of pixels in which checks are larger than pixels
SEEDS = (1, 2, 3, 4, 5, 6)
STUDY_N = 100  # nearest photons of the study's pictures
FINE = 12  # n of the picture that edges are compared with
POWER_SEEDS = (1, 2, 3)
PHOTONS = 100_000  # for two lamps
BRIGHT, DIM = ({"type": "point", "position": position, "intensity": intensity} for position, intensity in (([0.75, 0.35, 0.75], 3), ([-0.6, 0.5, 0.7], 0.3)))
NO_LAMP = {"type": "ambient", "radiance": 0}


def errors(layers, level):
    """Deviation, from what it should be, of means over blocks in which the checks are finer than a pixel, over that."""
    light = luminance(layers[""])
    rows = light[64:112, :]  # below the horizon, where a pixel covers several checks
    return rows.reshape(rows.shape[0] // BLOCK, BLOCK, -1, BLOCK).mean(axis=(1, 3)) / level - 1


def edges(layers, truth):
    """Root of the mean squared error where single checks are larger than a pixel."""
    return float(np.sqrt((luminance(layers[""] - truth[""])[NEAR:] ** 2).mean()))


def checkers(study, n, jitter, seeds):
    return [exr.read_layers(study.single("sampling", "render", [
        "experiments/papers/scenes/chen_checker.json", "--set", f"/sensor/sampler/jitter={jitter}", "--method", "none", "--spp", str(n * n), "--seed",
        str(seed)], f"n{n}-{jitter}-s{seed}.exr")[0]) for seed in seeds]


def sampling(study):
    seeds = {"false": SEEDS[:1], "true": SEEDS}  # regular samples are the same with every seed
    pictures = {(n, jitter): checkers(study, n, jitter, seeds[jitter]) for n in (1, 2, 3, 4) for jitter in seeds}
    truth = checkers(study, FINE, "false", SEEDS[:1])[0]
    found = {key: [errors(layers, 0.5) for layers in some] for key, some in pictures.items()}
    found[2, "true"] = [errors(layers, 0.5) for layers in study.sweep("moire").pictures()]
    whole = {key: [float(np.sqrt((each**2).mean())) for each in some] for key, some in found.items()}
    shared = {key: in_common(some if key[1] == "true" else 2 * some) for key, some in found.items()}
    at_edges = {key: [edges(layers, truth) for layers in some] for key, some in pictures.items()}
    per_cent = lambda values: spread([100 * each for each in values])
    rows = [[str(n), str(n * n), *[text for jitter in ("false", "true") for text in (
        per_cent(whole[n, jitter]), spread([1e4 * each for each in shared[n, jitter]]), per_cent(at_edges[n, jitter]))]] for n in (1, 2, 3, 4)]
    shown = strip([[(f"n² = {n * n}, {name}", pictures[n, jitter][0][""]) for jitter, name in (("false", "regular"), ("true", "jittered"))]
                   for n in (1, 2, 4)], 1.0)
    pairs = f"{len(shared[2, 'true'])} disjoint pairs of seeds"
    return Part({"moire": counted(shared[2, "false"][0], note="squared error that all seeds share, n = 2: regular samples are the same with every seed"),
                 "jittering": Measured([each / shared[2, "false"][0] for each in shared[2, "true"]], note=f"n = 2, {pairs}; below 0 where noise has it"),
                 "oversampling": ratio(at_edges[4, "true"], at_edges[1, "true"], "rms error of a pixel", note="jittered, where checks are larger than "
                                       f"pixels; regular: {short(at_edges[4, 'false'][0] / at_edges[1, 'false'][0])}")}, [
        Table("sampling", "n² samples a pixel", [
            "n", "samples", "error, regular [%]", "shared [10⁻⁴]", "at edges [%]", "error, jittered [%]", "shared [10⁻⁴]", "at edges [%]"], rows,
              f"A checkerboard to the horizon. Where checks are far finer than a pixel they have to be even grey: deviation of means over {BLOCK} x "
              f"{BLOCK} pixels, and the part of its square that two seeds share (disjoint pairs of {len(SEEDS)} seeds, {len(found[2, 'true'])} at "
              "n = 2): moiré is there again with every seed, noise is not. At edges: rms error of a pixel in the lowest rows, where checks are "
              f"larger than pixels, against {FINE**2} regular samples.")], [
        Figure("sampling", "Regular and jittered samples", "A fine checkerboard to the horizon. Regular samples make patterns of their own "
               "(moiré) where jittered ones make noise.", *shown)])


def interaction(study):
    trials = study.sweep("interaction")
    mean = {how: [float(layers["caustic"].mean()) for layers in trials.pictures(interaction=how)] for how in ("roulette", "split")}
    stack = {how: np.array([layers["caustic"] for layers in trials.pictures(interaction=how)]) for how in mean}
    noise = {how: float(np.sqrt(values.var(axis=0, ddof=1).mean())) for how, values in stack.items()}
    column = lambda name, how: trials.column(name, interaction=how)
    rows = [[how, *[spread(column(name, how)) for name in ("photons_emitted", "photons_stored", "precompute_cpu_s")], f"{noise[how]:.3g}"]
            for how in mean]
    same = ratio(mean["split"], mean["roulette"], "mean caustic")
    low, high = interval(same.samples, False)
    same.note = (f"95 % interval {low:.4f} to {high:.4f}, which {'holds' if low <= 1 <= high else 'does not hold'} 1; the claim is judged by the "
                 "tolerance")
    return Part({"split_same": same}, [Table(
        "interaction", "Roulette and split", ["interaction", "light paths", "photons", "tracing [CPU s]", "noise of a pixel [W/(m² sr)]"], rows,
        f"The bowl, {len(mean['split'])} seeds. Roulette: a photon is reflected or refracted (Jensen); split: both, each weaker (POV-Ray).")])


def search(study):
    """Nodes that searches visit; beside them their time: rendering less that without photons."""
    trials = study.sweep("tree")
    bare = trials.column("render_cpu_s", method="none")
    counts = sorted(trials.values("photons"), key=natural)
    several = sorted(trials.values("nearest"), key=natural)
    seconds = {(count, n): [a - b for a, b in zip(trials.column("render_cpu_s", photons=count, nearest=n), bare)] for count in counts for n in several}
    def visited(count, n):
        own = trials.record(trials.where(photons=count, nearest=n)[0])["counters"]
        return own["nodes_visited"] / own["gathers"]

    times = lambda count, n: [a / b for a, b in zip(seconds[count, n], seconds[counts[0], n])]
    over = lambda count, n: ratio([visited(count, n)], [visited(counts[0], n)], "nodes visited a search", counted=True,
                                  beside={"CPU time of the searches, more over fewer photons": times(count, n)})
    rows = [[n, f"{int(count):,}", f"{visited(count, n):.1f}", short(over(count, n).samples[0]), spread(seconds[count, n]), spread(times(count, n))]
            for n in several for count in counts]
    return Part({"logarithmic": over(counts[-1], several[-1]), "logarithmic_few": over(counts[-1], several[0])}, [Table(
        "tree", "Searching among more photons", ["N", "photons", "nodes visited a search", "over the first", "searches [CPU s]", "over the first"], rows,
        f"160 × 120 pixels, {trials.rows[0]['spp']} rays each, {len(bare)} repeats. Nodes of the balanced tree are counted, and the same on every run. Times: "
        f"rendering less {spread(bare, 'CPU s')} without photons; memory beyond the caches costs time that the count does not have. With N = {several[0]} the "
        f"way down the tree is most of the work, with N = {several[-1]} the gathering.")])


def filters(study):
    trials = study.sweep("filters")
    kinds = ("none", "cone", "gaussian")
    several = sorted(trials.values("nearest"), key=natural)
    main = f"{STUDY_N}"
    error = {(name, n): trials.column("mask_rmse", filter=name, nearest=n) for name in kinds for n in several}
    bare, mapped = (trials.column("rmse", **which) for which in ({"method": "none"}, {"filter": "none", "nearest": main}))
    rows = [[n, name, spread(error[name, n]), spread(trials.column("rmse", filter=name, nearest=n))] for n in several for name in kinds]
    filtered = lambda name, n: ratio(error[name, n], error["none", n], "rmse in the caustic")
    by_n = {name: ", ".join(f"{spread(filtered(name, n).samples)} at N = {n}" for n in several) for name in kinds[1:]}
    part = Part({f"filter_{name}": filtered(name, main) for name in kinds[1:]})
    for name in kinds[1:]:
        part.measured[f"filter_{name}"].note = by_n[name]
    part.measured["realistic"] = ratio(mapped, bare, "rmse against light tracing")
    part.facts["filters_over_n"] = f"rmse of filtered over unfiltered estimates: cone {by_n['cone']}; Gaussian {by_n['gaussian']}"
    part.tables.append(Table(
        "filters", "Filtered estimates", ["N", "filter", "rmse where the caustic is bright [W/(m² sr)]", "rmse everywhere"], rows,
        f"The bowl, 100,000 photons, against light tracing; the claims are judged at N = {STUDY_N}, that of all pictures here. The text names no filter: cone and Gaussian are Jensen's "
        "of 2001."))
    return part


def maps(study):
    trials = study.sweep("maps")
    picture = lambda gather, diffuse: trials.pictures(indirect_gather=gather, indirect_diffuse_bounces=diffuse)
    two, whole, gathered = picture(0, 2), picture(0, 0), picture(8, 0)
    adds = max(float(np.abs(layers[""] - sum(layers[name] for name in ("direct", "specular", "caustic", "indirect"))).max() / layers[""].max())
               for layers in [*two, *whole, *gathered])
    mean = lambda some: [float(layers["indirect"].mean()) for layers in some]
    first = {name: mean_of(gathered, name) for name in gathered[0]}
    by_map = mean_of(whole, "indirect")
    level = float(np.percentile(luminance(first[""]), 97))
    pictures = strip([[("direct", first["direct"]), ("specular: the lamp, seen and mirrored", first["specular"]), ("caustic", first["caustic"])],
                      [("multiple diffuse, gathered", first["indirect"]), ("multiple diffuse, the global map", by_map), ("all", first[""])]], level)
    rows = [["the map, paths end at the second diffuse surface", spread(mean(two))], ["the map, paths end by roulette", spread(mean(whole))],
            ["final gathering, 8 rays", spread(mean(gathered))]]
    return Part({"four_parts": counted(adds, "of the brightest pixel"), "second_hit": ratio(mean(two), mean(whole), "mean indirect light")}, [Table(
        "maps", "Light between diffuse surfaces", ["by", "mean of the layer [W/(m² sr)]"], rows,
        f"{len(gathered)} seeds, 240 × 240 pixels.")], [Figure(
            "maps", "Four parts of the light in a room", "Direct light, specular (only the lamp itself has its own light here: what "
            "mirrors and glass show of the room is in the other layers), caustic (its own map) and multiple diffuse reflections, and their sum, at one "
            f"exposure; means of {len(gathered)} seeds.", *pictures)])


def shadows(study):
    trials = study.sweep("shadows")
    counter = lambda name, rays: [trials.record(row)["counters"][name] for row in trials.where(indirect_shadow_photons=rays)]
    direct = lambda rays: [layers["direct"] for layers in trials.pictures(indirect_shadow_photons=rays)]
    rows = []
    for rays in (20000, 200000):
        traced, spared = counter("shadow_rays", rays), counter("shadow_rays_saved", rays)
        error = [float(np.sqrt(((a - b) ** 2).mean())) for a, b in zip(direct(rays), direct(0))]
        rows.append([f"{rays:,}", spread([100 * s / (s + t) for s, t in zip(spared, traced)]), f"{statistics.median(error):.2g}",
                     spread(trials.column("render_cpu_s", indirect_shadow_photons=rays))])
    without = spread(trials.column("render_cpu_s", indirect_shadow_photons=0))
    return Part({"shadow_photons": ratio([s + t for s, t in zip(spared, traced)], traced, "shadow rays", note="by 200,000 rays of the lamp")}, [Table(
        "shadows", "Shadow photons", ["rays of the lamp", "shadow rays spared [%]", "rms error of the direct light [W/(m² sr)]", "rendering [CPU s]"], rows,
        f"The room under its square lamp, 120 × 120 pixels, 4 samples each; without shadow photons the rendering takes {without} CPU s: in so small a "
        "scene a ray costs less than asking for the nearest twenty photons.")])


def oversampling(study):
    """Squared error times rays: more rays where a pixel scatters, against as many in every pixel."""
    trials = {name: study.sweep(f"oversampling_{name}") for name in ("adaptive", "uniform", "truth")}
    pixels = trials["truth"].picture()[""][..., 0].size
    rays = {name: [each / pixels for each in trials[name].column("camera_rays")] for name in trials}
    squared = {name: [float((luminance(a[""] - b[""]) ** 2).mean()) for a, b in zip(trials[name].pictures(), trials["truth"].pictures())]
               for name in ("adaptive", "uniform")}
    cost = {name: [a * b for a, b in zip(squared[name], rays[name])] for name in squared}
    rows = [[name, spread(rays[name]), spread([each**0.5 for each in squared[name]])] for name in squared]
    return Part({"guided": ratio(cost["adaptive"], cost["uniform"], "squared error × rays", note="directed by the scatter of a pixel, which the caustic's "
                                 "edges raise; the text directs it by the map's photons")}, [Table(
        "oversampling", "Oversampling where it is needed", ["rays", "rays a pixel", "rms error [W/(m² sr)]"], rows,
        "The bowl by one map of 100,000 photons, N = 100, 120 × 90 pixels, three seeds; error against 225 rays a pixel of the same map.")])


def under_two_lamps(study, name, lamps, method, *parameters, seed=1):
    words = ["experiments/scenes/bowl.json", "--set", f"/sun={json.dumps(lamps[0])}", "--set", f"/room={json.dumps(lamps[1])}", "--set",
             "/sensor/film/width=120", "--set", "/sensor/film/height=90", "--spp", "4", "--method", method,
             *[word for each in parameters for word in ("--param", each)], "--seed", str(seed)]
    file, = study.single("power", "render", words, f"{name}-s{seed}.exr")
    return exr.read_layers(file)


def by_photons(study, name, lamps, photons, seed):
    layers = under_two_lamps(study, name, lamps, "photonmap", "kernel=point", "emission=random", f"photons={photons}", f"nearest={STUDY_N}", seed=seed)
    return luminance(layers["caustic"])


def power(study):
    """Two lamps, one ten times as strong: light of one map of both, and of maps of equal numbers of photons, one a lamp, added up."""
    truth = under_two_lamps(study, "lighttrace", (BRIGHT, DIM), "lighttrace", "paths=3000000")
    seen = reached([truth])
    error = lambda light: float(np.sqrt(((light - luminance(truth["caustic"]))[seen] ** 2).mean()))
    shared = [error(by_photons(study, "both", (BRIGHT, DIM), PHOTONS, seed)) for seed in POWER_SEEDS]
    equal = [error(by_photons(study, "bright", (BRIGHT, NO_LAMP), PHOTONS // 2, seed) + by_photons(study, "dim", (NO_LAMP, DIM), PHOTONS // 2, seed))
             for seed in POWER_SEEDS]
    mean = float(luminance(truth["caustic"])[seen].mean())
    per_cent = lambda values: spread([100 * each / mean for each in values])
    return Part({"equal_power": ratio(shared, equal, "rmse of the caustic", note=f"{PHOTONS:,} photons in both, N = {STUDY_N}")}, [Table(
        "power", "Photons for two lamps", ["photons", "rms error of the caustic over its mean [%]"],
        [["of equal power: in proportion to the lamps' power", per_cent(shared)], ["in equal numbers for each lamp", per_cent(equal)]],
        f"The bowl under two point lamps, one {BRIGHT['intensity'] / DIM['intensity']:g} times as strong as the other, 120 × 90 pixels, {PHOTONS:,} stored photons, "
        f"{len(POWER_SEEDS)} seeds, against light tracing. The program always shares photons by power; those in equal numbers are two maps, one of each lamp, whose "
        "light is added.")])


def ambient(study):
    """Photons against ray tracing with an ambient term in the caustic's place, at the strength that comes nearest to light tracing."""
    trials = study.sweep("filters")
    truth = trials.reference(method="none")
    seen = truth["unreached"] == 0
    error = lambda light: float(np.sqrt(((light - truth[""])[seen] ** 2).mean()))
    mapped = [error(layers[""]) for layers in trials.pictures(method="photonmap", filter="none", nearest=STUDY_N)]
    bare = trials.pictures(method="none")
    best = [fitted(layers, truth[""], seen) for layers in bare]
    phong = [error(layers[""] + (factor - 1) * layers["ambient"]) for layers, factor in zip(bare, best)]
    return Part({"realistic_ambient": ratio(mapped, phong, "rmse against light tracing", note=(
        f"the bowl's scene has an ambient light; the term that comes nearest is {spread(best)} times that light; as the scene has it, without the caustic, the "
        f"error is {spread([error(layers['']) for layers in bare])}"))})


def fitted(layers, truth, seen):
    """How many times the ambient layer the picture without caustics needs to come nearest to the truth."""
    of_ambient = layers["ambient"][seen]
    lacking = (truth - layers[""])[seen] + of_ambient
    return float(max(0, (of_ambient * lacking).sum() / (of_ambient**2).sum()))


SECTIONS = {"sampling": sampling, "interaction": interaction, "search": search, "filters": filters, "maps": maps, "shadows": shadows,
            "oversampling": oversampling, "power": power, "ambient": ambient}

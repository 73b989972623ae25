"""Chen 2011: n² samples regular and jittered, where rays are needed, roulette against split, searching the tree, filters, maps, shadow photons."""
import statistics

import numpy as np

from papers.figures import luminance, strip
from papers.part import Figure, Part, Table
from papers.verdict import Measured, counted, ratio
from papers.words import short, spread
from report import exr
from report.records import natural

BLOCK = 8  # pixels


def errors(layers, level):
    """Deviation, from what it should be, of means over blocks in which the checks are finer than a pixel, over that."""
    light = luminance(layers[""])
    rows = light[64:112, :]  # below the horizon, where a pixel covers several checks
    return rows.reshape(rows.shape[0] // BLOCK, BLOCK, -1, BLOCK).mean(axis=(1, 3)) / level - 1


def patterns(some):
    """The error that pictures of two seeds share, squared: a pattern stays, noise does not."""
    return [float((a * b).mean()) for a, b in zip(some, [*some[1:], some[0]])]


def sampling(study):
    found, shown = {}, {}
    for n in (1, 2, 3, 4):
        for jitter in ("false", "true"):
            for seed in (1, 2, 3):
                file, = study.single("sampling", "render", [
                    "experiments/papers/scenes/chen_checker.json", "--set", f"/sensor/sampler/jitter={jitter}", "--method", "none", "--spp",
                    str(n * n), "--seed", str(seed), "--threads", "1"], f"n{n}-{jitter}-s{seed}.exr")
                layers = exr.read_layers(file)
                found.setdefault((n, jitter), []).append(errors(layers, 0.5))
                shown.setdefault((n, jitter), layers[""])
    whole = {key: [float(np.sqrt((each**2).mean())) for each in some] for key, some in found.items()}
    shared = {key: patterns(some) for key, some in found.items()}
    per_cent = lambda values: spread([100 * each for each in values])
    rows = [[str(n), str(n * n), *[text for jitter in ("false", "true") for text in (
        per_cent(whole[n, jitter]), spread([1e4 * each for each in shared[n, jitter]]))]] for n in (1, 2, 3, 4)]
    pictures = strip([[(f"n² = {n * n}, regular", shown[n, "false"]), (f"n² = {n * n}, jittered", shown[n, "true"])] for n in (1, 2, 4)], 1.0)
    once, often = (statistics.fmean(whole[n, "false"]) for n in (1, 4))
    return Part({"moire": Measured([a - b for a, b in zip(shared[2, "false"], shared[2, "true"])],
                                   note="squared error that two seeds share, at n = 2: regular "
                                        f"{spread(shared[2, 'false'])}, jittered {spread(shared[2, 'true'])}"),
                 "oversampling": counted(often / once, "", f"regular: {short(100 * once)} % at n = 1, {short(100 * often)} % at n = 4")}, [
        Table("sampling", "n² samples a pixel", ["n", "samples", "error, regular [%]", "shared [10⁻⁴]", "error, jittered [%]", "shared [10⁻⁴]"], rows,
              f"A checkerboard far finer than a pixel, which has to be even grey: deviation of means over {BLOCK} x {BLOCK} pixels, and the "
              "part of its square that two seeds share: moiré is there again with every seed, noise is not.")], [
        Figure("sampling", "Regular and jittered samples", "A fine checkerboard to the horizon. Regular samples make patterns of their own "
               "(moiré) where jittered ones make noise.", *pictures)])


def interaction(study):
    trials = study.sweep("interaction")
    mean = {how: [float(layers["caustic"].mean()) for layers in trials.pictures(interaction=how)] for how in ("roulette", "split")}
    stack = {how: np.array([layers["caustic"] for layers in trials.pictures(interaction=how)]) for how in mean}
    noise = {how: float(np.sqrt(values.var(axis=0, ddof=1).mean())) for how, values in stack.items()}
    column = lambda name, how: trials.column(name, interaction=how)
    rows = [[how, *[spread(column(name, how)) for name in ("photons_emitted", "photons_stored", "precompute_cpu_s")], f"{noise[how]:.3g}"]
            for how in mean]
    return Part({"split_same": ratio(mean["split"], mean["roulette"], "mean caustic", note="pairs of seeds")}, [Table(
        "interaction", "Roulette and split", ["interaction", "light paths", "photons", "tracing [CPU s]", "noise of a pixel [W/(m² sr)]"], rows,
        f"The bowl, {len(mean['split'])} seeds. Roulette: a photon is reflected or refracted (Jensen); split: both, each weaker (POV-Ray).")])


def search(study):
    trials = study.sweep("tree")
    counts = sorted(trials.values("photons"), key=natural)
    seconds = {count: trials.column("render_cpu_s", photons=count) for count in counts}
    rows = [[f"{int(count):,}", spread(seconds[count]), spread(ratio(seconds[count], seconds[counts[0]], "").samples)] for count in counts]
    return Part({"logarithmic": ratio(seconds[counts[-1]], seconds[counts[0]], "CPU s")}, [Table(
        "tree", "Searching among more photons", ["photons", "rendering [CPU s]", "over the first"], rows,
        f"160 × 120 pixels, N = 50, {len(seconds[counts[0]])} repeats.")])


def filters(study):
    trials = study.sweep("filters")
    error = {name: trials.column("mask_rmse", filter=name) for name in ("none", "cone", "gaussian")}
    bare, mapped = (trials.column("rmse", **which) for which in ({"method": "none"}, {"filter": "none"}))
    rows = [[name, spread(error[name]), spread(trials.column("rmse", filter=name))] for name in error]
    return Part({"filter_cone": ratio(error["cone"], error["none"], "rmse in the caustic"),
                 "filter_gaussian": ratio(error["gaussian"], error["none"], "rmse in the caustic"),
                 "realistic": ratio(mapped, bare, "rmse against light tracing")}, [Table(
        "filters", "Filtered estimates", ["filter", "rmse where the caustic is bright [W/(m² sr)]", "rmse everywhere"], rows,
        "The bowl, N = 200 of 100,000 photons, against light tracing. The text names no filter: cone and Gaussian are Jensen's of 2001.")])


def maps(study):
    trials = study.sweep("maps")
    picture = lambda gather, diffuse: trials.pictures(indirect_gather=gather, indirect_diffuse_bounces=diffuse)
    two, whole, gathered = picture(0, 2), picture(0, 0), picture(8, 0)
    adds = max(float(np.abs(layers[""] - sum(layers[name] for name in ("direct", "specular", "caustic", "indirect"))).max() / layers[""].max())
               for layers in [*two, *whole, *gathered])
    mean = lambda some: [float(layers["indirect"].mean()) for layers in some]
    first = gathered[0]
    level = float(np.percentile(luminance(first[""]), 97))
    pictures = strip([[("direct", first["direct"]), ("specular", first["specular"]), ("caustic", first["caustic"])],
                      [("multiple diffuse, gathered", first["indirect"]), ("the global map", whole[0]["indirect"]), ("all", first[""])]], level)
    rows = [["the map, paths end at the second diffuse surface", spread(mean(two))], ["the map, paths end by roulette", spread(mean(whole))],
            ["final gathering, 8 rays", spread(mean(gathered))]]
    return Part({"four_parts": counted(adds, "of the brightest pixel"), "second_hit": ratio(mean(two), mean(whole), "mean indirect light")}, [Table(
        "maps", "Light between diffuse surfaces", ["by", "mean of the layer [W/(m² sr)]"], rows,
        f"{len(gathered)} seeds, 240 × 240 pixels.")], [Figure(
            "maps", "Four parts of the light in a room", "Direct light, specular, caustic (its own map) and multiple diffuse reflections (the "
            "global map), and their sum.", *pictures)])


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


SECTIONS = {"sampling": sampling, "interaction": interaction, "search": search, "filters": filters, "maps": maps, "shadows": shadows,
            "oversampling": oversampling}

"""Jensen 1996, figure 3 and what its text says of all figures: cognac on sand, its Lambertian twin, one map for many views."""
import json
import statistics

import numpy as np

from papers.figures import is_diffuse, largest_difference, luminance, mean_of, strip
from papers.jensen_table import rendering
from papers.jensen_ring import preprocess
from papers.part import Figure, Part, Table
from papers.verdict import Measured, counted, ratio
from papers.words import spread
from report import exr
from report.records import natural

SCENE = "experiments/scenes/cognac.json"
SIDE = 12  # pixels of a window in which contrast is local
VIEWS = ("of the figure", "from the left", "from the right", "from low down", "from behind", "from behind, left", "from behind, right",
         "from low down, left")


def times(study):
    trials, ball = study.sweep("figure3"), study.sweep("figure2")
    few = study.paper.number("figure2_photons")
    seconds = lambda tree: trials.column("render_cpu_s", tree=tree)
    other = lambda tree: ball.column("render_cpu_s", method="photonmap", photons=few, tree=tree)
    prepare = lambda tree: preprocess(trials, tree=tree)
    trees = trees_over_n(study)
    unbalanced = ratio(seconds("unbalanced"), seconds("balanced"), "CPU s", note=f"over N: {trees}")
    megabytes = [some.column("map_bytes", method="photonmap", tree="balanced", **wanted)[0] / 1e6
                 for some, wanted in ((study.sweep("figure1"), {}), (ball, {"photons": few}), (trials, {}))]
    rows = [[tree, spread(prepare(tree)), spread(trials.column("balance_cpu_s", tree=tree)), spread(seconds(tree)),
             f"{trials.column('map_bytes', tree=tree)[0] / 1e6:.2f}"] for tree in ("balanced", "unbalanced")]
    return Part({
        "cognac_unbalanced": unbalanced,
        "cognac_doubled": unbalanced,
        "cognac_inserting": ratio(prepare("unbalanced"), prepare("balanced"), "CPU s"),
        "cognac_preprocess": ratio(prepare("balanced"), seconds("balanced"), "CPU s"),
        "cognac_slower": ratio(seconds("balanced"), other("balanced")[:len(seconds("balanced"))], "CPU s"),
        "usual_megabytes": Measured(megabytes, unit="MB", counted=True, note="follows from the paper's photons and the bytes of one: figures 1, 2 "
                                    f"and 3 take {', '.join(f'{each:.2f}' for each in megabytes)} MB")}, [
        Table("figure3", "Figure 3: trees", ["tree", "preprocess [CPU s]", "of which the tree", "rendering [CPU s]", "MB"], rows,
              f"{rendering(trials)}, {study.paper.number('figure3_photons'):,} photons.")], [
        picture(study, trials)], {"cognac_trees": trees,
                                  "ball_trees": spread(ratio(other("unbalanced"), other("balanced"), "").samples)})


def trees_over_n(study):
    """Unbalanced over balanced rendering at the table's N and at others, as words."""
    found = {}
    for trials in (study.sweep("figure3"), study.sweep("figure3_nearest")):
        for nearest in trials.values("nearest"):
            seconds = lambda tree: trials.column("render_cpu_s", nearest=nearest, tree=tree)
            found[nearest] = spread(ratio(seconds("unbalanced"), seconds("balanced"), "").samples)
    return ", ".join(f"{found[nearest]} at N = {nearest}" for nearest in sorted(found, key=natural))


def picture(study, trials):
    shown = study.sweep("figure3_picture")
    sand = shown.record(shown.where()[0])["scene"]["resolved"]["sand"]
    return Figure("figure3", "Figure 3: a glass of cognac on fractal sand",
                  f"2 · {2 ** sand['fractal']['levels']}² triangles of sand, alpha {sand['bsdf']['alpha']:g}; three meshes that share rings: glass "
                  "and air, glass and cognac, cognac and air. Beer's law colours the light that goes through. "
                  f"{study.paper.number('figure3_photons'):,} photons; for print {rendering(shown)}; in the table {rendering(trials)}.",
                  *strip([[("", shown.picture()[""])]]))


def twins(study):
    """The sand with alpha 0.6 and Lambert's law from several sides; with clear cognac."""
    trials, clear = study.sweep("figure3_twins"), study.sweep("figure3_clear")
    eyes = [next(row["eye"] for row in trials.rows if json.loads(row["eye"]) == list(eye)) for eye in eyes_of(study)]
    sands = {("alpha 0.6" if "alpha" in row["sand"] else "Lambert"): row["sand"] for row in trials.rows}
    contrast = {(name, eye): [local_contrast(layers) for layers in trials.pictures(sand=sand, eye=eye)]
                for name, sand in sands.items() for eye in eyes}
    ratios = {eye: ratio(contrast["alpha 0.6", eye], contrast["Lambert", eye], "local contrast").samples for eye in eyes}
    middle = [statistics.fmean(ratios[eye]) for eye in eyes]
    rows = [[view, spread(contrast["alpha 0.6", eye]), spread(contrast["Lambert", eye]), spread(ratios[eye])] for view, eye in zip(VIEWS, eyes)]
    over = lambda some, count, **wanted: [statistics.fmean(each) for each in zip(*(
        [redness(layers) for layers in some.pictures(eye=eye, **wanted)] for eye in eyes[:count]))]
    views = len(clear.values("eye"))
    seeds = len(trials.values("seed"))
    extreme = middle.index(min(middle))
    shades = shades_of(study, over(clear, 1), over(trials, 1, sand=sands["alpha 0.6"]))
    pair = f"{sum(each > 1 for each in middle)} of {len(eyes)} views have more contrast with alpha 0.6, ratios {min(middle):.3g} to {max(middle):.3g}"
    return Part({
        "cognac_red": ratio(over(trials, views, sand=sands["alpha 0.6"]), over(clear, views), "red over blue",
                            note=f"one sample a seed, the mean of {views} views"),
        "cognac_flat": ratio(contrast["alpha 0.6", eyes[0]], contrast["Lambert", eyes[0]], "local contrast", note=f"one sample a seed; {pair}"),
        "cognac_flat_views": Measured(middle, note=f"one sample a view, the mean of {seeds} seeds: {pair}")}, [
        Table("figure3_twins", "Figure 3: is the Lambertian sand flat?", ["view", "local contrast, alpha 0.6", "Lambert", "ratio"], rows,
              f"Standard deviation of the logarithm of luminance in windows of {SIDE} x {SIDE} pixels of sand, mean over them; {seeds} seeds.")], [
        twins_figure(trials, clear, sands, eyes, extreme)], {"cognac_shades": shades, "cognac_contrasts": pair})


def twins_figure(trials, clear, sands, eyes, other):
    """Each picture the mean of the seeds."""
    mean = lambda some, **wanted: mean_of(some.pictures(**wanted))
    shown = lambda name, view: mean(trials, sand=sands[name], eye=eyes[view])
    glossy, lambertian = shown("alpha 0.6", other), shown("Lambert", other)
    pictures = strip([[("alpha = 0.6", shown("alpha 0.6", 0)), ("Lambert's law", shown("Lambert", 0)),
                       ("alpha = 0.6, clear cognac", mean(clear, eye=eyes[0]))],
                      [(f"alpha = 0.6, {VIEWS[other]}", glossy), (f"Lambert's law, {VIEWS[other]}", lambertian),
                       ("alpha = 0.6 over Lambert", shade(glossy, lambertian), 1.0)]])
    return Figure("figure3_twins", "Figure 3: its twins",
                  f"The same sand with alpha 0.6 and with Lambert's law, in the figure's view and {VIEWS[other]}, where alpha 0.6 loses most "
                  "contrast; and the glass with clear cognac: without absorption the caustic is white. Last: the ratio of luminances, grey where "
                  f"equal, white where alpha 0.6 is twice as bright or more, black where it is half. Means of {len(trials.values('seed'))} seeds, "
                  f"{rendering(trials)}.", *pictures)


def shade(above, below):
    """The logarithm of a ratio of luminances as grey, for pictures shown at white 1."""
    stops = np.log2(np.maximum(luminance(above), 1e-6) / np.maximum(luminance(below), 1e-6))
    grey = np.clip(0.5 + stops / 2, 0, 1) ** 2.2
    return np.repeat(grey[..., None], 3, axis=2)


def shades_of(study, clear, cognac):
    """Red over blue in the caustic with clear cognac, half and double the absorption, and the scene's own."""
    scene = study.scene(SCENE)
    found = []
    for times in (0.5, 2):
        absorption = json.dumps([times * each for each in scene["cognac"]["bsdf"]["absorption"]])
        changes = [word for mesh in ("inside", "cognac") for word in ("--set", f"/{mesh}/bsdf/absorption={absorption}")]
        file, = study.single("figure3_absorption", "render", [
            SCENE, *changes, "--set", "/sensor/film/width=320", "--set", "/sensor/film/height=240",
            "--spp", "4", "--method", "photonmap", "--param", f"photons={study.paper.number('figure3_photons')}", "--param", "nearest=100"],
            f"times{times}.exr")
        found.append(redness(exr.read_layers(file)))
    return (f"{statistics.median(clear):.3g} with clear cognac, {found[0]:.3g} with half of the absorption, {statistics.median(cognac):.3g} with all "
            f"of it, {found[1]:.3g} with twice as much")


def redness(layers):
    return float(layers["caustic"][..., 0].sum() / layers["caustic"][..., 2].sum())


def eyes_of(study):
    sweep = json.loads((study.sweeps / "jensen1996_figure3_twins.json").read_text(encoding="utf-8"))
    return sweep["set"]["eye"]["values"]


def local_contrast(layers):
    """Mean over windows that see nothing but sand of the deviation of log luminance."""
    sand = is_diffuse(layers)
    light = np.log(np.maximum(luminance(layers[""]), 1e-9))
    found = []
    for y in range(0, light.shape[0] - SIDE + 1, SIDE):
        for x in range(0, light.shape[1] - SIDE + 1, SIDE):
            window = np.s_[y:y + SIDE, x:x + SIDE]
            if sand[window].all():
                found.append(light[window].std())
    return float(np.mean(found))


def tracing(study):
    """What a stored photon costs in figures 1 and 3 over figure 2: paths a photon, and casters' triangles."""
    per_photon = lambda name, **wanted: [a / b for a, b in zip(
        preprocess(study.sweep(name), method="photonmap", tree="balanced", **wanted),
        study.sweep(name).column("photons_stored", method="photonmap", tree="balanced", **wanted))]
    ball = per_photon("figure2", photons=study.paper.number("figure2_photons"))
    return Part({"photon_ring": ratio(per_photon("figure1", alpha=1, max_samples=4)[:len(ball)], ball, "CPU s a photon"),
                 "photon_cognac": ratio(per_photon("figure3"), ball, "CPU s a photon")})


def one_map(study):
    """A map saved with one view and read with another gives the picture of a map traced for that view, bit for bit."""
    scene = "experiments/papers/scenes/jensen_ring.json"
    small = ["--set", "/sensor/film/width=80", "--set", "/sensor/film/height=60"]
    other = ["--set", "/sensor/to_world/0/look_at/origin=[0.3,-1.2,1.4]"]
    method = ["--method", "photonmap", "--param", "nearest=100"]
    photons = ["--param", f"photons={study.paper.number('figure1_photons')}"]
    kept = study.output / "trials" / "views" / "ring.photons"
    kept.parent.mkdir(parents=True, exist_ok=True)
    study.single("views", "render", [scene, *small, *method, *photons, "--param", f"save={kept}"], "first.exr")
    read, = study.single("views", "render", [scene, *small, *other, *method, "--param", f"load={kept}"], "read.exr")
    traced, = study.single("views", "render", [scene, *small, *other, *method, *photons], "traced.exr")
    largest = largest_difference(exr.read_layers(read), exr.read_layers(traced))
    return Part({"view_independent": counted(largest, "W/(m² sr)", "largest difference in any layer")})


SECTIONS = {"figure3": times, "figure3-twins": twins, "tracing": tracing, "one-map": one_map}

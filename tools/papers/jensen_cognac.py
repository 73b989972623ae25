"""Jensen 1996, figure 3 and what its text says of all figures: cognac on sand, its Lambertian twin, one map for many views."""
import json
import statistics

import numpy as np

from papers.figures import luminance, strip
from papers.jensen_ring import preprocess
from papers.part import Figure, Part, Table
from papers.verdict import Measured, counted, ratio
from papers.words import spread

SIDE = 12  # pixels of a window in which contrast is local
VIEWS = ("of the figure", "from the left", "from the right", "from low down", "from behind", "from behind, left", "from behind, right",
         "from low down, left")


def times(study):
    trials = study.sweep("figure3")
    seconds = lambda tree: trials.column("render_cpu_s", tree=tree)
    rows = [[tree, spread(preprocess(trials, tree=tree)), spread(seconds(tree)), f"{trials.column('map_bytes', tree=tree)[0] / 1e6:.2f}"]
            for tree in ("balanced", "unbalanced")]
    return Part({
        "cognac_unbalanced": ratio(seconds("unbalanced"), seconds("balanced"), "CPU s"),
        "cognac_preprocess": ratio(preprocess(trials, tree="balanced"), seconds("balanced"), "CPU s")}, [
        Table("figure3", "Figure 3: trees", ["tree", "preprocess [CPU s]", "rendering [CPU s]", "MB"], rows,
              f"640 × 480 pixels, 4 rays a pixel, {study.paper.number('figure3_photons'):,} photons, N = 100.")], [
        Figure("figure3", "Figure 3: a glass of cognac on fractal sand",
               "2 · 1024² triangles of sand, alpha 0.6; three meshes that share rings: glass and air, glass and cognac, cognac and air. "
               "Beer's law colours the light that goes through. The paper's photons and N = 100; 16 rays a pixel for print, 4 in the table.",
               *strip([[("", study.sweep("figure3_picture").picture()[""])]]))])


def twins(study):
    """The sand with alpha 0.6 and Lambert's law from several sides; with clear cognac."""
    trials, clear = study.sweep("figure3_twins"), study.sweep("figure3_clear")
    eyes = list(dict.fromkeys(row["eye"] for row in trials.rows))
    eyes.sort(key=lambda eye: [json.loads(eye) == list(each) for each in eyes_of(study)].index(True))
    sands = {("alpha 0.6" if "alpha" in row["sand"] else "Lambert"): row["sand"] for row in trials.rows}
    contrast = {(name, eye): [local_contrast(layers) for layers in trials.pictures(sand=sand, eye=eye)]
                for name, sand in sands.items() for eye in eyes}
    ratios = [np.mean(contrast["alpha 0.6", eye]) / np.mean(contrast["Lambert", eye]) for eye in eyes]
    rows = [[view, spread(contrast["alpha 0.6", eye]), spread(contrast["Lambert", eye]), f"{each:.3f}"]
            for view, eye, each in zip(VIEWS, eyes, ratios)]
    red = lambda layers: float(layers["caustic"][..., 0].sum() / layers["caustic"][..., 2].sum())
    shades = lambda some, **wanted: [statistics.fmean(map(red, some.pictures(eye=eye, **wanted))) for eye in clear.values("eye")]
    cognac, water = shades(trials, sand=sands["alpha 0.6"]), shades(clear)
    shown = lambda name, eye: trials.picture(sand=sands[name], eye=eye, seed=1)[""]
    pictures = strip([[("alpha = 0.6", shown("alpha 0.6", eyes[0])), ("Lambert's law", shown("Lambert", eyes[0]))],
                      [("alpha = 0.6, from low down", shown("alpha 0.6", eyes[3])), ("Lambert's law, from low down", shown("Lambert", eyes[3]))],
                      [("clear cognac", clear.picture(eye=eyes[0])[""])]])
    return Part({
        "cognac_red": ratio(cognac, water, "red over blue", note="one sample a view"),
        "cognac_flat": Measured(ratios, note="one sample a view: " + ", ".join(VIEWS))}, [
        Table("figure3_twins", "Figure 3: is the Lambertian sand flat?", ["view", "local contrast, alpha 0.6", "Lambert", "ratio"], rows,
              f"Standard deviation of the logarithm of luminance in windows of {SIDE} x {SIDE} pixels of sand, mean over the windows.")], [
        Figure("figure3_twins", "Figure 3: its twins", "The same sand with alpha 0.6 and with Lambert's law, from two sides, and the glass with "
               "clear cognac: without absorption the caustic is white.", *pictures)])


def eyes_of(study):
    sweep = json.loads((study.sweeps / "jensen1996_figure3_twins.json").read_text(encoding="utf-8"))
    return sweep["set"]["eye"]["values"]


def local_contrast(layers):
    """Mean over windows that see nothing but sand of the deviation of log luminance."""
    sand = (layers["albedo"] < 0.7).all(axis=2) & (layers["albedo"] > 0).all(axis=2)
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
    small = ["--set", "/sensor/film/width=80", "--set", "/sensor/film/height=60", "--threads", "1"]
    other = ["--set", "/sensor/to_world/0/look_at/origin=[0.3,-1.2,1.4]"]
    method = ["--method", "photonmap", "--param", "nearest=100"]
    photons = ["--param", f"photons={study.paper.number('figure1_photons')}"]
    kept = study.output / "trials" / "views" / "ring.photons"
    kept.parent.mkdir(parents=True, exist_ok=True)
    study.single("views", "render", [scene, *small, *method, *photons, "--param", f"save={kept}"], "first.exr")
    read, = study.single("views", "render", [scene, *small, *other, *method, "--param", f"load={kept}"], "read.exr")
    traced, = study.single("views", "render", [scene, *small, *other, *method, *photons], "traced.exr")
    from report import exr
    ours, theirs = exr.read_layers(read), exr.read_layers(traced)
    largest = max(float(np.abs(ours[layer] - theirs[layer]).max()) for layer in ours)
    return Part({"view_independent": counted(largest, "W/(m² sr)", "largest difference in any layer")})


SECTIONS = {"figure3": times, "figure3-twins": twins, "tracing": tracing, "one-map": one_map}

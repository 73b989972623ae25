"""Jensen 1996, figure 3 and what its text says of all figures: cognac on sand, its Lambertian twin, its hue, one map for many views."""
import json
import statistics

import numpy as np

from papers.figures import is_diffuse, largest_difference, luminance, mean_of, strip
from papers.jensen_cardioid import ESTIMATE, PHOTON_MAP
from papers.jensen_table import rendering
from papers.jensen_ring import preprocess
from papers.part import Figure, Part, Table
from papers.verdict import Measured, counted, ratio
from papers.words import spread
from report import exr

SCENE = "experiments/scenes/cognac.json"
RED, BLUE = 0, 2
SIDE = 12  # pixels of a window in which contrast is local
VIEWS = ("of the figure", "from the left", "from the right", "from low down", "from behind", "from behind, left", "from behind, right",
         "from low down, left")


def times(study):
    trials, ball = study.sweep("figure3"), study.sweep("figure2")
    few = study.paper.number("figure2_photons")
    seconds = lambda tree: trials.column("render_cpu_s", tree=tree)
    other = lambda tree: ball.column("render_cpu_s", method="photonmap", photons=few, tree=tree)
    prepare = lambda tree: preprocess(trials, tree=tree)
    megabytes = [some.column("map_bytes", method="photonmap", tree="balanced", **wanted)[0] / 1e6
                 for some, wanted in ((study.sweep("figure1"), {}), (ball, {"photons": few}), (trials, {}))]
    rows = [[tree, spread(prepare(tree)), spread(trials.column("balance_cpu_s", tree=tree)), spread(seconds(tree)),
             f"{trials.column('map_bytes', tree=tree)[0] / 1e6:.2f}"] for tree in ("balanced", "unbalanced")]
    return Part({
        "cognac_preprocess": ratio(prepare("balanced"), seconds("balanced"), "CPU s"),
        "cognac_slower": ratio(seconds("balanced"), other("balanced")[:len(seconds("balanced"))], "CPU s"),
        "usual_megabytes": Measured(megabytes, unit="MB", counted=True, note="follows from the paper's photons and the bytes of one: figures 1, 2 "
                                    f"and 3 take {', '.join(f'{each:.2f}' for each in megabytes)} MB")}, [
        Table("figure3", "Figure 3: trees", ["tree", "preprocess [CPU s]", "of which the tree", "rendering [CPU s]", "MB"], rows,
              f"{rendering(trials)}, {study.paper.number('figure3_photons'):,} photons.")], [
        picture(study, trials)])


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
    seeds = len(trials.values("seed"))
    extreme = middle.index(min(middle))
    pair = f"{sum(each > 1 for each in middle)} of {len(eyes)} views have more contrast with alpha 0.6, ratios {min(middle):.3g} to {max(middle):.3g}"
    return Part({
        "cognac_flat": ratio(contrast["alpha 0.6", eyes[0]], contrast["Lambert", eyes[0]], "local contrast", note=f"one sample a seed; {pair}"),
        "cognac_flat_views": Measured(middle, note=f"one sample a view, the mean of {seeds} seeds: {pair}")}, [
        Table("figure3_twins", "Figure 3: is the Lambertian sand flat?", ["view", "local contrast, alpha 0.6", "Lambert", "ratio"], rows,
              f"Standard deviation of the logarithm of luminance in windows of {SIDE} x {SIDE} pixels of sand, mean over them; {seeds} seeds.")], [
        twins_figure(trials, clear, sands, eyes, extreme)], {"cognac_contrasts": pair})


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
                  "contrast; and the glass with clear cognac. Last: the ratio of luminances, grey where "
                  f"equal, white where alpha 0.6 is twice as bright or more, black where it is half. Means of {len(trials.values('seed'))} seeds, "
                  f"{rendering(trials)}.", *pictures)


def shade(above, below):
    """The logarithm of a ratio of luminances as grey, for pictures shown at white 1."""
    stops = np.log2(np.maximum(luminance(above), 1e-6) / np.maximum(luminance(below), 1e-6))
    grey = np.clip(0.5 + stops / 2, 0, 1) ** 2.2
    return np.repeat(grey[..., None], 3, axis=2)


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
    nearest = ["--param", "nearest=100"]
    traced_anew = [*PHOTON_MAP, *nearest, "--param", f"photons={study.paper.number('figure1_photons')}"]
    kept = study.output / "trials" / "views" / "ring.photons"
    kept.parent.mkdir(parents=True, exist_ok=True)
    study.single("views", "render", [scene, *small, *traced_anew, "--param", f"save={kept}"], "first.exr")
    read, = study.single("views", "render", [scene, *small, *other, *ESTIMATE, *nearest, "--param", f"load={kept}"], "read.exr")
    traced, = study.single("views", "render", [scene, *small, *other, *traced_anew], "traced.exr")
    largest = largest_difference(exr.read_layers(read), exr.read_layers(traced))
    return Part({"view_independent": counted(largest, "W/(m² sr)", "largest difference in any layer")})


def hue(colour):
    """The angle of a colour on the circle of hues [degrees]: red 0, orange 30, yellow 60; from -180 to 180."""
    red, green, blue = colour
    least, most = min(colour), max(colour)
    if most == red:
        return 60 * (green - blue) / (most - least)
    turned = 120 + 60 * (blue - red) / (most - least) if most == green else 240 + 60 * (red - green) / (most - least)
    return (turned + 180) % 360 - 180


def shown(colour):
    """The colour as a screen gives it: its brightest channel full, by the curve of sRGB."""
    share = np.asarray(colour) / max(colour)
    return np.where(share <= 0.0031308, 12.92 * share, 1.055 * share ** (1 / 2.4) - 0.055)


def caustic(layers):
    """The colour of the caustic on the sand: the sum of its light."""
    return layers["caustic"][is_diffuse(layers)].sum(axis=0)


def without_sand(layers):
    """The colour of the light that falls on the sand."""
    sand = is_diffuse(layers)
    return (layers["caustic"][sand] / layers["albedo"][sand]).sum(axis=0)


def colours(study):
    cognac, clear = study.sweep("figure3_colour"), study.sweep("figure3_clear_colour")
    views = cognac.values("eye")
    mean = lambda trials, of: [np.mean(each, axis=0) for each in zip(*([of(layers) for layers in trials.pictures(eye=eye)] for eye in views))]
    angles = lambda trials, of=caustic: [float(hue(colour)) for colour in mean(trials, of)]
    own, without = angles(cognac), angles(clear)
    ratio = lambda trials, channel: [float(colour[RED] / colour[channel]) for colour in mean(trials, caustic)]
    part = Part({
        "cognac_red": Measured([abs(each) for each in own], unit="degrees from red",
                               note=f"orange is at 30 degrees, yellow at 60; one sample a seed, the mean of {len(views)} views",
                               beside={"degrees as a screen shows the colour": [float(hue(shown(colour))) for colour in mean(cognac, caustic)],
                                       "degrees of the light that falls on the sand": angles(cognac, without_sand),
                                       "red over blue": ratio(cognac, BLUE)}),
        "cognac_redder": Measured([a - b for a, b in zip(without, own)], unit="degrees nearer to red",
                                  note=f"{spread(own)} degrees with cognac, {spread(without)} with clear cognac",
                                  beside={"red over blue with clear cognac": ratio(clear, BLUE)})})
    figure = next(eye for eye in views if json.loads(eye) == study.scene(SCENE)["sensor"]["to_world"][0]["look_at"]["origin"])
    of_figure = lambda trials: [caustic(layers) for layers in trials.pictures(eye=figure)]
    part.tables.append(shades_table(study, of_figure(clear), of_figure(cognac)))
    part.facts["cognac_shades"] = "; ".join(f"{name} {angle}" for name, angle, *_ in part.tables[0].rows)
    return part


def shades_table(study, clear, own):
    """Hues over the absorption, from clear to twice the scene's."""
    shades = {"clear cognac": clear, "half of the absorption": [absorbed(study, 0.5)], "all of it": own, "twice as much": [absorbed(study, 2)]}
    rows = [[name, spread([float(hue(each)) for each in some]), spread([float(hue(shown(each))) for each in some]),
             spread([float(each[RED] / each[1]) for each in some]), spread([float(each[RED] / each[BLUE]) for each in some])]
            for name, some in shades.items()]
    return Table("figure3_colour", "Figure 3: the hue of the caustic", ["absorption", "hue [degrees]", "as a screen shows it", "red over green", "red over blue"],
                 rows, "Red is at 0 degrees, orange at 30, yellow at 60. The figure's view. The sand is yellowish, the lamp nearly white.")


def absorbed(study, times):
    """The caustic's colour with so many times the scene's absorption, one seed."""
    scene = study.scene(SCENE)
    absorption = json.dumps([times * each for each in scene["cognac"]["bsdf"]["absorption"]])
    changes = [word for mesh in ("inside", "cognac") for word in ("--set", f"/{mesh}/bsdf/absorption={absorption}")]
    file, = study.single("figure3_absorption", "render", [
        SCENE, *changes, "--set", "/sensor/film/width=160", "--set", "/sensor/film/height=120", "--spp", "4", *PHOTON_MAP, "--param", f"photons={study.paper.number('figure3_photons')}",
        "--param", "nearest=100"], f"times{times}.exr")
    return caustic(exr.read_layers(file))


SECTIONS = {"figure3": times, "figure3-twins": twins, "figure3-colour": colours, "tracing": tracing, "one-map": one_map}

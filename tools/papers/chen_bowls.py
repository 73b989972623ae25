"""Chen 2011: bowls of glass and of cut crystal by three methods; lights; three views by one map; what is seen through the glass; open meshes."""
import json
import subprocess

import numpy as np

from papers.figures import luminance, strip, white
from papers.jensen_ball import Floor
from papers.part import Figure, Part, Table
from papers.verdict import counted, ratio, unmeasured
from papers.words import spread
from report import exr

BOWLS = {"bowl": "glass, n = 1.5", "crystal_bowl": "cut crystal, n = 1.7"}
LAMPS = ("a point", "a disc of 2 cm", "a disc of 6 cm")
CHECKS = '{"type": "checkerboard", "color0": 0.7, "color1": 0.2, "to_uv": [{"scale": [50, 50, 1]}]}'
VIEWS = ("[0.1,-0.62,0.42]", "[-0.55,-0.3,0.35]", "[0.3,-0.25,0.6]")


def columns(study):
    """Both bowls under a point and a disc: ray tracing only, photons, beams."""
    trials = study.sweep("bowls")
    beams = {(scene, lamp): study.sweep(f"beams{suffix}{area}")
             for scene, suffix in (("bowl", ""), ("crystal_bowl", "_crystal")) for lamp, area in (("a point", ""), ("a disc of 2 cm", "_area"))}
    lamps = dict(zip(LAMPS, sorted(trials.values("lamp"), key=disc_size)))
    rows, table, brighter, peak = [], [], [], []
    for scene, what in BOWLS.items():
        for lamp, value in lamps.items():
            bare = trials.picture(scene=scene, lamp=value, method="none")
            photons, tree = trials.where(scene=scene, lamp=value, method="photonmap")[0], beams[scene, lamp].rows[0]
            layers = trials.picture(scene=scene, lamp=value, method="photonmap")
            by_beams = beams[scene, lamp].picture()
            level = white(layers[""])
            rows.append([(f"{what}, {lamp}: ray tracing", bare[""], level), ("photons", layers[""], level), ("beams", by_beams[""], level)])
            table += [row_of(f"{what}, {lamp}", name, row, float(own["caustic"].mean() / layers["caustic"].mean()))
                      for name, row, own in (("photons", photons, layers), ("beams", tree, by_beams))]
            brighter.append(float(layers[""].mean() / bare[""].mean()))
            peak.append(float(layers["caustic"].max() / layers["direct"].max()))
    return Part({"caustics_added": counted(min(brighter), "mean radiance, photons over ray tracing", f"the least of the four; a caustic's brightest pixel "
                                           f"is {min(peak):.1f} to {max(peak):.1f} times the brightest of the direct light")}, [Table(
        "bowls", "The bowls by photons and by beams",
        ["bowl and lamp", "by", "photons or beams", "preprocess [CPU s]", "rendering [CPU s]", "caustic over photons"], table,
        "320 × 240 pixels, 16 rays each with photons, 4 with beams. Photons follow up to 64 events, beams 4, so that light that goes round in "
        "the glass is missing from them; the beams' glass bowl has 48 sectors (24 under the disc), the crystal's inside 24, its light 3 "
        "wavelengths (1 under the disc). Beams take the disc as 4 points.")], [Figure(
            "bowls", "A bowl of glass and one of cut crystal, by three methods, under two lamps", "Ray tracing only has a plain shadow where the "
            "photon map and the beams have the caustic. Under the disc the photons' caustic softens; beams take it as a few points, whose caustics "
            "lie beside each other. Each row at one exposure.", *strip(rows))])


def disc_size(text):
    """Of a lamp in a sweep; a point has none."""
    return json.loads(text).get("to_world", [{"scale": [0]}])[0]["scale"][0]


def row_of(what, name, row, light):
    return [what, name, f"{int(float(row['photons_stored'] or row['beams'])):,}", f"{float(row['precompute_cpu_s']):.2f}",
            f"{float(row['render_cpu_s']):.2f}", f"{light:.3f}"]


def lights(study):
    """How wide the shadow's edge is: the share of the table that sees a part of the lamp."""
    trials = study.sweep("lights")
    lamps = sorted(trials.values("lamp"), key=disc_size)

    scene = json.loads((study.scenes.parents[1] / "scenes" / "bowl.json").read_text(encoding="utf-8"))

    def half_lit(layers):
        share = seen_share(layers, scene)
        return float(((share > 0.1) & (share < 0.9)).sum() / np.isfinite(share).sum())

    soft = {lamp: [half_lit(layers) for layers in trials.pictures(lamp=lamp)] for lamp in lamps}
    rows = [[name, spread([100 * each for each in soft[lamp]], "%")] for name, lamp in zip(LAMPS, lamps)]
    pictures = strip([[(name, trials.picture(lamp=lamp, seed=1)[""]) for name, lamp in zip(LAMPS, lamps)]])
    return Part({"soft_area": ratio(soft[lamps[1]], soft[lamps[0]], "of the table in half-shadow"),
                 "softer": ratio(soft[lamps[2]], soft[lamps[1]], "of the table in half-shadow")}, [Table(
        "lights", "Hard and soft shadows", ["lamp", "share of the table in half-shadow"], rows,
        "Direct light alone, 9 rays a pixel; half-shadow: between 10 % and 90 % of what a point lamp sends there (in closed form).")], [Figure(
            "lights", "Point and area lights",
            "The bowl under lamps of one power: a point, discs of 2 and 6 cm radius. Shadow and caustic soften together.", *pictures)])


def seen_share(layers, scene):
    """How much of the lamp each pixel of the table sees: its light over a point lamp's; NaN elsewhere."""
    table = (layers["albedo"] < 0.7).all(axis=2) & (layers["albedo"] > 0).all(axis=2)
    light = luminance(layers["direct"]) / np.maximum(luminance(layers["albedo"]), 1e-6)
    x, y, z = scene["sun"]["position"]
    points = Floor(layers, scene).points
    distance = np.sqrt((points[..., 0] - x) ** 2 + (points[..., 1] - y) ** 2 + z * z)
    return np.where(table, light * np.pi * distance**3 / (scene["sun"]["intensity"] * z), np.nan)


def views(study):
    """Three views of the crystal bowl by one map."""
    scene = "experiments/scenes/crystal_bowl.json"
    words = [scene, "--set", "/sensor/film/width=320", "--set", "/sensor/film/height=240", "--spp", "16", "--threads", "1", "--method", "photonmap",
             "--param", "nearest=100", "--param", "tree=packed"]
    photons = ["--param", "photons=300000", "--param", "max_bounces=64"]
    kept = study.output / "trials" / "views" / "crystal.photons"
    kept.parent.mkdir(parents=True, exist_ok=True)
    view = lambda origin: ["--set", f"/sensor/to_world/0/look_at/origin={origin}"]
    files = [*study.single("views", "render", [*words, *view(VIEWS[0]), *photons, "--param", f"save={kept}"], "view1.exr")]
    files += [study.single("views", "render", [*words, *view(origin), "--param", f"load={kept}"], f"view{number}.exr")[0]
              for number, origin in enumerate(VIEWS[1:], 2)]
    again, = study.single("views", "render", [*words, *view(VIEWS[2]), *photons], "again.exr")
    read, traced = exr.read_layers(files[2]), exr.read_layers(again)
    largest = max(float(np.abs(read[layer] - traced[layer]).max()) for layer in read)
    return Part({"one_map": counted(largest, "W/(m² sr)", "largest difference in any layer")}, [], [Figure(
        "overview", "Crystal glass: three views by one photon map",
        "The cut bowl of n = 1.7 that disperses light, under a small lamp. The photons are traced once; the second and third view "
        "read the map.", *strip([[("", exr.read_layers(file)[""]) for file in files]]))])


def through(study):
    """How far glass moves what is seen through it: a checkered table with the bowl, and with a bowl of air in its place."""
    trials = study.sweep("through")
    air = trials.pictures(index=1)
    bowl = (trials.picture(index=1.5)["albedo"] > 0.9).all(axis=2)  # glass has an albedo of 1
    moved = lambda index: [float(np.abs(luminance(a[""] - b[""]))[bowl].mean() / luminance(b[""])[bowl].mean())
                           for a, b in zip(trials.pictures(index=index), air)]
    glass, crystal = moved(1.5), moved(1.7)
    shown = strip([[(f"n = {index}", trials.picture(index=index)[""]) for index in (1.5, 1.7)]])
    return Part({"distorts": ratio(crystal, glass, "mean deviation over the light of the table seen without glass")}, [], [Figure(
        "through", "The table seen through the bowl", "A checkered table through one bowl of n = 1.5 and of 1.7: the greater index moves what "
        "is seen farther, and reflects more.", *shown)])


def look(study, name, shapes):
    """A picture of a bowl whose facets bend light by their planes, on a checkered table."""
    changes = ["/sensor/film/width=320", "/sensor/film/height=240", "/sensor/sampler/split_depth=4", f"/table/bsdf/reflectance={CHECKS}",
               *[f"/{shape}/{key}" for shape in shapes for key in ("face_normals=true", "resolution=96")]]
    file, = study.single("difference", "render", [study.scenes / f"chen_{name}.json", *[word for each in changes for word in ("--set", each)], "--method",
                                                  "none", "--param", "shadows=transparent", "--spp", "9", "--threads", "1"], f"{name}.exr")
    return exr.read_layers(file)[""]


def difference(study):
    """A bowl made as a difference, its inner surface turned inside out: what `info` says of it, and of a sound one."""
    told = {}
    for name in ("sound", "inverted"):
        scene = study.scenes / f"chen_{name}.json"
        done = subprocess.run([study.program, "info", str(scene)], capture_output=True, text=True, stdin=subprocess.DEVNULL)
        if done.returncode != 0:
            return Part({"difference": unmeasured(f"info fails: {done.stderr.strip()}")})
        told[name] = [line.strip() for line in done.stdout.splitlines() if "caster" in line and "mesh" in line]
    study.keep("info", ["info", study.scenes / "chen_inverted.json"], 1)
    seen = [(title, look(study, name, shapes)) for name, title, shapes in (
        ("sound", "one closed surface", ("bowl",)), ("inverted", "a difference of two", ("outside", "taken_away")))]
    flawed = {name: any("inwards" in line or "open edges" in line or " lie on " in line for line in lines) for name, lines in told.items()}
    return Part({"difference": counted(float(flawed["inverted"]) - float(flawed["sound"]), "", "info says: " + "; ".join(told["inverted"]))}, [], [
        Figure("difference", "A bowl as one surface and as a difference", "The same bowl as one closed surface, and made of an outside and of what is "
               "taken away, whose faces look inwards: light that enters the glass never leaves it rightly.", *strip([seen]))])


SECTIONS = {"bowls": columns, "lights": lights, "views": views, "through": through, "difference": difference}

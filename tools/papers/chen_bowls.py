"""Chen 2011: bowls of glass and of cut crystal by ray tracing, photons and beams; lights; one map for three views; open meshes."""
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
VIEWS = ("[0.1,-0.62,0.42]", "[-0.55,-0.3,0.35]", "[0.3,-0.25,0.6]")


def columns(study):
    trials = study.sweep("bowls")
    beams = {"bowl": study.sweep("beams"), "crystal_bowl": study.sweep("beams_crystal")}
    bare = lambda scene, shadows: trials.picture(scene=scene, method="none", shadows=shadows)[""]
    photons = {scene: trials.picture(scene=scene, method="photonmap") for scene in BOWLS}
    tree = {scene: beams[scene].picture() for scene in BOWLS}
    rows, table = [], []
    for scene, what in BOWLS.items():
        level = white(photons[scene][""])
        rows.append([(f"{what}: opaque shadows", bare(scene, "opaque"), level), ("transparent shadows", bare(scene, "transparent"), level)])
        rows.append([("photons", photons[scene][""], level), ("beams", tree[scene][""], level)])
        by = {"photons": trials.where(scene=scene, method="photonmap")[0], "beams": beams[scene].where()[0]}
        for name, row in by.items():
            layers = photons[scene] if name == "photons" else tree[scene]
            table.append([what, name, f"{int(float(row['photons_stored'] or row['beams'])):,}", f"{float(row['precompute_cpu_s']):.2f}",
                          f"{float(row['render_cpu_s']):.2f}", f"{layers['caustic'].mean() / photons[scene]['caustic'].mean():.3f}"])
    shadow = {scene: float(bare(scene, "opaque").mean()) for scene in BOWLS}
    light = min(float(photons[scene]["caustic"].max() / trials.picture(scene=scene, method="photonmap")["direct"].max()) for scene in BOWLS)
    brighter = min(float(photons[scene][""].mean()) / shadow[scene] for scene in BOWLS)
    return Part({"caustics_added": counted(brighter, "mean radiance, photons over ray tracing", f"the caustic's brightest pixel is {light:.1f} times "
                                           "the brightest of the direct light, or more")}, [Table(
        "bowls", "The bowls by photons and by beams",
        ["bowl", "by", "photons or beams", "preprocess [CPU s]", "rendering [CPU s]", "caustic over photons"], table,
        "320 × 240 pixels, 25 rays each with photons, 4 with beams. Photons follow up to 64 events, beams 4, so that light that goes round in "
        "the glass is missing from them; the beams' glass bowl has 48 sectors, the crystal's inside 24, and its light 3 wavelengths.")], [Figure(
            "bowls", "A bowl of glass and one of cut crystal", "Above each: ray tracing only, with opaque shadows, and with light that goes straight "
            "through, weakened. Below: caustics by the photon map and by beams. Each bowl at one exposure.", *strip(rows))])


def lights(study):
    """How wide the shadow's edge is: the share of the table that sees a part of the lamp."""
    trials = study.sweep("lights")
    lamps = sorted({row["lamp"] for row in trials.rows}, key=lambda text: json.loads(text).get("to_world", [{"scale": [0]}])[0]["scale"][0])

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
    flawed = {name: any("inwards" in line or "open edges" in line or " lie on " in line for line in lines) for name, lines in told.items()}
    return Part({"difference": counted(float(flawed["inverted"]) - float(flawed["sound"]), "", "info says: " + "; ".join(told["inverted"]))})


SECTIONS = {"bowls": columns, "lights": lights, "views": views, "difference": difference}

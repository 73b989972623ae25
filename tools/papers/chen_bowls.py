"""Chen 2011: bowls of glass and of cut crystal by three methods; lights; three views by one map; what is seen through the glass; open meshes."""
import json
import statistics
import subprocess
import time

import numpy as np

from papers.figures import is_diffuse, largest_difference, luminance, mean_of, strip, white
from papers.jensen_ball import Floor
from papers.part import Figure, Part, Table
from papers.verdict import Measured, counted, ratio, unmeasured
from papers.words import short, spread
from report import exr

BOWLS = {"bowl": "glass, n = 1.5", "crystal_bowl": "cut crystal, n = 1.7"}
SUFFIX = {"bowl": "", "crystal_bowl": "_crystal"}
LAMPS = ("a point", "a disc of 2 cm", "a disc of 6 cm")
CHECKS = '{"type": "checkerboard", "color0": 0.7, "color1": 0.2, "to_uv": [{"scale": [50, 50, 1]}]}'
VIEWS = ("[0.1,-0.62,0.42]", "[-0.55,-0.3,0.35]", "[0.3,-0.25,0.6]")


def columns(study):
    """Both bowls under a point and a disc: ray tracing only, with a plain shadow or light that goes straight through, photons, beams."""
    part = Part()
    rows, table, lighter, peak, scatter = [], [], {}, [], []
    for scene, what in BOWLS.items():
        trials = study.sweep(f"bowls{SUFFIX[scene]}")
        lamps = dict(zip(LAMPS, sorted(trials.values("lamp"), key=disc_size)))
        for lamp, value in lamps.items():
            bare, straight, layers = (trials.pictures(lamp=value, **which) for which in (
                {"shadows": "opaque"}, {"shadows": "transparent"}, {"method": "photonmap"}))
            tree = study.sweep(f"beams{SUFFIX[scene]}{'' if lamp == LAMPS[0] else '_area'}")
            by_beams = tree.picture()
            level = white(mean_of(layers))
            truth = trials.pictures(lamp=value, method="lighttrace")
            seen = reached(truth)
            light = statistics.fmean(caustic_light(each, seen) for each in truth)
            over = lambda pictures: spread([caustic_light(each, seen) / light for each in pictures])
            rows.append([(f"{what}, {lamp}", mean_of(bare), level), ("light straight through glass", mean_of(straight), level),
                         ("photons", mean_of(layers), level), ("beams", by_beams[""], level)])
            table += [photon_row(f"{what}, {lamp}", trials.where(lamp=value, method="photonmap"), over(layers)),
                      beam_row(f"{what}, {lamp}", tree.rows[0], over([by_beams]))]
            scatter.append(spread_of([caustic_light(each, seen) / light for each in truth]))
            lighter[scene, lamp] = [float(a[""].mean() / b[""].mean()) for a, b in zip(layers, bare)]
            peak += [float(each["caustic"].max() / each["direct"].max()) for each in layers]
    least = [min(each) for each in zip(*lighter.values())]
    part.measured["caustics_added"] = Measured(least, unit="mean radiance, photons over ray tracing", note="the least of both bowls under both lamps; a "
                                               f"caustic's brightest pixel is {min(peak):.1f} to {max(peak):.1f} times the brightest of the direct light")
    part.facts["bowls_lighter"] = ", ".join(f"{spread([100 * (each - 1) for each in lighter[scene, LAMPS[0]]], '%')} ({what})"
                                            for scene, what in BOWLS.items())
    part.tables.append(Table(
        "bowls", "The bowls by photons and by beams",
        ["bowl and lamp", "by", "photons or beams", "captured [%]", "of it by photons [%]", "preprocess [CPU s]", "rendering [CPU s]",
         "caustic over light tracing"], table,
        f"320 × 240 pixels, {trials.rows[0]['spp']} rays each, of beams under the disc {tree.rows[0]['spp']}; photons of {len(least)} seeds. Beams follow up to "
        f"{parameter(tree, 'max_bounces')} events, photons {parameter(trials, 'max_bounces', method='photonmap')}. Beams that are too weak to be "
        "followed, and those of polygons too coarse for what they meet, are completed by photons (rest: photons). Captured: share of the light on "
        "glass that beams and these photons carry to its last specular event. Caustic over light tracing: mean light on pixels that see the table "
        f"without glass before it, over the mean of {len(truth)} seeds of light tracing by {int(parameter(trials, 'paths', method='lighttrace')):,} "
        f"paths, which differ by up to {100 * max(scatter):.1f} % from each other. The beams' bowls are coarser meshes. Both bowls without dispersion; "
        f"beams take the disc as {parameter(tree, 'light_samples')} points. Beams are by two threads."))
    part.figures.append(Figure(
        "bowls", "A bowl of glass and one of cut crystal, by ray tracing, photons and beams, under two lamps", "Ray tracing only has a plain shadow, "
        "or weakened light that goes straight through, where the photon map and the beams have the caustic. Under the disc the photons' caustic "
        f"softens; beams take it as {parameter(tree, 'light_samples')} points, whose caustics lie beside each other. Each row at one exposure; ray "
        f"tracing and photons are means of {len(least)} seeds. Without dispersion, which figures overview and glass have.", *strip(rows)))
    return part


def parameter(trials, name, **which):
    return trials.record(trials.where(**which)[0])["method"]["parameters"][name]


def reached(pictures):
    """Pixels that every one of light tracing's pictures serves wholly: they see the table without glass before it."""
    return np.all([is_diffuse(each) & (each["unreached"] == 0) for each in pictures], axis=0)


def caustic_light(layers, seen):
    """Mean of the caustic over the pixels that light tracing serves."""
    return float(luminance(layers["caustic"])[seen].mean())


def spread_of(values):
    """The largest value's distance from the least, over their mean."""
    return (max(values) - min(values)) / statistics.fmean(values)


def photon_row(what, rows, over):
    column = lambda name: spread([float(row[name]) for row in rows])
    return [what, "photons", f"{int(rows[0]['photons_stored']):,}", "", "", column("precompute_cpu_s"), column("render_cpu_s"), over]


def beam_row(what, row, over):
    share = lambda name: short(100 * float(row[name] or 0))
    return [what, "beams", f"{int(row['beams']):,}", share("flux_share_captured"), share("flux_share_rest"), short(float(row["precompute_cpu_s"])),
            short(float(row["render_cpu_s"])), over]


def events(study):
    """The light of paths of few events by photons and by beams of the same mesh, over light tracing's: which method lacks what of it."""
    rows, facts, measured = [], [], {}
    for scene, what in BOWLS.items():
        trials = study.sweep(f"events{SUFFIX[scene]}")
        few, most = (sorted(trials.values("max_bounces"), key=int)[place] for place in (0, -1))
        truth = {count: trials.pictures(method="lighttrace", max_bounces=count) for count in (few, most)}
        seen = reached([*truth[few], *truth[most]])
        caustic = lambda **which: [caustic_light(layers, seen) for layers in trials.pictures(**which)]
        traced = {count: caustic(method="lighttrace", max_bounces=count) for count in truth}
        level = {count: statistics.fmean(own) for count, own in traced.items()}
        over = lambda count, **which: [each / level[count] for each in caustic(**which)]
        photons = {count: caustic(method="photonmap", max_bounces=count) for count in sorted(trials.values("max_bounces"), key=int)}
        for count in truth:
            same = spread([each / level[count] for each in traced[count]])
            rows.append([what, "light tracing", count, "", spread(over(most, method="lighttrace", max_bounces=count)), same])
        for count, own in photons.items():
            share = spread([100 * within(trials.record(row)["counters"]) for row in trials.where(method="photonmap", max_bounces=count)])
            rows.append([what, "photons", count, share, spread([each / level[most] for each in own]),
                         spread([each / level[count] for each in own]) if count in level else ""])
        beams = over(few, method="beamtree")
        captured = f"{short(100 * float(trials.where(method='beamtree')[0]['flux_share_captured']))} captured"
        rows.append([what, "beams", few, captured, spread(over(most, method="beamtree")), spread(beams)])
        of_photons = [each / level[few] for each in photons[few]]
        measured[f"events_beams{SUFFIX[scene]}"] = Measured([each / other for each, other in zip(caustic(method="beamtree"), traced[few])], note=(
            f"over the light of paths of at most {few} events; photons of {few} events, N = {parameter(trials, 'nearest', method='photonmap')}: "
            f"{spread(of_photons)} of it"))
        facts.append(f"{what}: paths of {few} events carry {spread(over(most, method='lighttrace', max_bounces=few))} of the light of those of {most}; of the "
                     f"light of {few} events beams have {spread(beams)}, photons {spread(of_photons)}")
    return Part(measured, [Table(
        "events", "What paths of few events carry", [
            "bowl", "by", "most events", "still within glass, of paths that meet it [%]", f"caustic over light tracing of {most} events",
            "over light tracing of as many events"], rows,
        f"The beams' own meshes under the point lamp, 160 × 120 pixels, {len(beams)} seeds; light tracing by "
        f"{int(parameter(trials, 'paths', method='lighttrace')):,} paths a seed. Means over pixels that see the table without glass before it. "
        f"{'; '.join(facts)}.")],
        facts={"events_cut": "; ".join(facts)})


def within(counters):
    """The share, of the paths that meet glass, that is cut by the number of events."""
    return counters["photons_depth_limited"] / (counters["photons_aimed"] - counters["photons_missed"])


def disc_size(text):
    """Of a lamp in a sweep; a point has none."""
    return json.loads(text).get("to_world", [{"scale": [0]}])[0]["scale"][0]


def lights(study):
    """How wide the shadow's edge is: the share of the table that sees a part of the lamp."""
    trials = study.sweep("lights")
    lamps = sorted(trials.values("lamp"), key=disc_size)
    scene = study.scene("experiments/scenes/bowl.json")

    def half_lit(layers):
        share = seen_share(layers, scene)
        return float(((share > 0.1) & (share < 0.9)).sum() / np.isfinite(share).sum())

    soft = {lamp: [half_lit(layers) for layers in trials.pictures(lamp=lamp)] for lamp in lamps}
    rows = [[name, spread([100 * each for each in soft[lamp]], "%")] for name, lamp in zip(LAMPS, lamps)]
    pictures = strip([[(name, mean_of(trials.pictures(lamp=lamp))) for name, lamp in zip(LAMPS, lamps)]])
    return Part({"soft_area": ratio(soft[lamps[1]], soft[lamps[0]], "of the table in half-shadow"),
                 "softer": ratio(soft[lamps[2]], soft[lamps[1]], "of the table in half-shadow")}, [Table(
        "lights", "Hard and soft shadows", ["lamp", "share of the table in half-shadow"], rows,
        "Direct light alone, 9 rays a pixel; half-shadow: between 10 % and 90 % of what a point lamp sends there (in closed form).")], [Figure(
            "lights", "Point and area lights",
            "The bowl under lamps of one power: a point, discs of 2 and 6 cm radius. Shadow and caustic soften together. Means of "
            f"{len(soft[lamps[0]])} seeds.", *pictures)])


def seen_share(layers, scene):
    """How much of the lamp each pixel of the table sees: its light over a point lamp's; NaN elsewhere."""
    table = is_diffuse(layers)
    light = luminance(layers["direct"]) / np.maximum(luminance(layers["albedo"]), 1e-6)
    x, y, z = scene["sun"]["position"]
    points = Floor(layers, scene).points
    distance = np.sqrt((points[..., 0] - x) ** 2 + (points[..., 1] - y) ** 2 + z * z)
    return np.where(table, light * np.pi * distance**3 / (scene["sun"]["intensity"] * z), np.nan)


def views(study):
    """Three views of the crystal bowl by one map."""
    scene = "experiments/scenes/crystal_bowl.json"
    words = [scene, "--set", "/sensor/film/width=320", "--set", "/sensor/film/height=240", "--spp", "64", "--method", "photonmap",
             "--param", "nearest=100", "--param", "tree=packed"]
    photons = ["--param", "photons=300000", "--param", "max_bounces=64"]
    kept = study.output / "trials" / "views" / "crystal.photons"
    kept.parent.mkdir(parents=True, exist_ok=True)
    view = lambda origin: ["--set", f"/sensor/to_world/0/look_at/origin={origin}"]
    files = [*study.single("views", "render", [*words, *view(VIEWS[0]), *photons, "--param", f"save={kept}"], "view1.exr")]
    files += [study.single("views", "render", [*words, *view(origin), "--param", f"load={kept}"], f"view{number}.exr")[0]
              for number, origin in enumerate(VIEWS[1:], 2)]
    again, = study.single("views", "render", [*words, *view(VIEWS[2]), *photons], "again.exr")
    largest = largest_difference(exr.read_layers(files[2]), exr.read_layers(again))
    return Part({"one_map": counted(largest, "W/(m² sr)", "largest difference in any layer")}, [], [Figure(
        "overview", "Crystal glass: three views by one photon map",
        "The cut bowl of n = 1.7 that disperses light, under a small lamp. The photons are traced once; the second and third view "
        "read the map.", *strip([[("", exr.read_layers(file)[""]) for file in files]]))])


def through(study):
    """How far glass moves what is seen through it: a checkered table with the bowl, and with a bowl of air in its place."""
    trials = study.sweep("through")
    air = trials.pictures(index=1)
    bowl = (trials.picture(index=1.5)["albedo"] > 0.9).all(axis=2)  # glass has an albedo of 1
    pairs = lambda index: [(luminance(a[""])[bowl], luminance(b[""])[bowl]) for a, b in zip(trials.pictures(index=index), air)]
    lost = lambda index: [float(1 - np.corrcoef(a, b)[0, 1]) for a, b in pairs(index)]
    moved = lambda index: [float(np.abs(a - b).mean() / b.mean()) for a, b in pairs(index)]
    glass, crystal = lost(1.5), lost(1.7)
    with_light = spread(ratio(moved(1.7), moved(1.5), "").samples)
    shown = strip([[("without glass", air[0][""])] + [(f"n = {index}", trials.picture(index=index)[""]) for index in (1.5, 1.7)]])
    return Part({"distorts": ratio(crystal, glass, "of the correlation lost", note="1 less the correlation with the view without glass, which neither a "
                                   "weaker nor an added even light changes, over the pixels of the bowl; reflections in it count still. By the mean "
                                   f"deviation, which the reflected light raises, too: {with_light}")}, [], [Figure(
        "through", "The table seen through the bowl", "A checkered table through a bowl of air, and one of n = 1.5 and of 1.7: the greater index "
        "moves what is seen farther, and reflects more.", *shown)])


def look(study, name, shapes):
    """A picture of a bowl whose facets bend light by their planes, on a checkered table."""
    changes = ["/sensor/film/width=320", "/sensor/film/height=240", "/sensor/sampler/split_depth=4", f"/table/bsdf/reflectance={CHECKS}",
               *[f"/{shape}/{key}" for shape in shapes for key in ("face_normals=true", "resolution=96")]]
    file, = study.single("difference", "render", [study.scenes / f"chen_{name}.json", *[word for each in changes for word in ("--set", each)], "--method",
                                                  "none", "--param", "shadows=transparent", "--spp", "36"], f"{name}.exr")
    return exr.read_layers(file)[""]


def difference(study):
    """A bowl made as a difference, its inner surface turned inside out: what `info` says of it, and of a sound one."""
    told, start = {}, time.monotonic()
    for name in ("sound", "inverted"):
        scene = study.scenes / f"chen_{name}.json"
        done = subprocess.run([study.program, "info", str(scene)], capture_output=True, text=True, stdin=subprocess.DEVNULL)
        if done.returncode != 0:
            return Part({"difference": unmeasured(f"info fails: {done.stderr.strip()}")})
        told[name] = [line.strip() for line in done.stdout.splitlines() if "caster" in line and "mesh" in line]
    study.keep("info", ["info", study.scenes / "chen_inverted.json"], time.monotonic() - start)
    seen = [(title, look(study, name, shapes)) for name, title, shapes in (
        ("sound", "one closed surface", ("bowl",)), ("inverted", "a difference of two", ("outside", "taken_away")))]
    flawed = {name: any("inwards" in line or "open edges" in line or " lie on " in line for line in lines) for name, lines in told.items()}
    return Part({"difference": counted(float(flawed["inverted"]) - float(flawed["sound"]), "", "info says: " + "; ".join(told["inverted"]))}, [], [
        Figure("difference", "A bowl as one surface and as a difference", "The same bowl as one closed surface, and made of an outside and of what is "
               "taken away, whose faces look inwards: light that enters the glass never leaves it rightly.", *strip([seen]))])


SECTIONS = {"bowls": columns, "events": events, "lights": lights, "views": views, "through": through, "difference": difference}

"""Jensen 1996, figure 1: the cardioid in a ring at four alphas, its times, and its two physical claims in closed form."""
import math

import numpy as np

from papers.figures import plot, strip, white
from papers.part import Figure, Part, Table
from papers.verdict import Measured, counted, ratio
from papers.words import short, spread
from report.records import natural

ALPHAS = ("1", "0.5", "0.1", "0.01")
RADIUS, LAMP_Y, LAMP_Z, WALL_LOW, WALL_HIGH = 0.5, 0.49, 0.4, 0.001, 0.25  # of experiments/papers/scenes/jensen_ring.json [m]
EYES = {"figure": (0, 1.1, 1.5), "opposite": (0, -1.1, 1.5)}
SCENE = "experiments/papers/scenes/jensen_ring.json"
FIXED, ADAPTIVE = 4, 256  # most samples a pixel


def times(study):
    trials = study.sweep("figure1")
    maps = lambda column, alpha, most, **more: trials.column(column, method="photonmap", alpha=alpha, max_samples=most, **more)
    seconds = lambda alpha, most=ADAPTIVE: maps("render_cpu_s", alpha, most)
    bare = lambda alpha, most: trials.column("render_cpu_s", method="none", alpha=alpha, max_samples=most)
    a_ray = lambda alpha: [s / n * 1e6 for s, n in zip(seconds(alpha), maps("camera_rays", alpha, ADAPTIVE))]
    pixels = study.paper.number("figure1_width") * study.paper.number("figure1_height")
    part = Part()
    for alpha, before in zip(ALPHAS[1:], ALPHAS):
        part.measured[f"ring_time_{alpha}"] = ratio(seconds(alpha), seconds(before), "CPU s")
        part.measured[f"ring_rays_{alpha}"] = ratio(maps("camera_rays", alpha, ADAPTIVE), maps("camera_rays", before, ADAPTIVE), "rays")
    part.measured |= {
        "ring_time": ratio(seconds("0.01"), seconds("1"), "CPU s"),
        "ring_reason": ratio(a_ray("0.01"), a_ray("1"), "CPU µs a ray"),
        "ring_fixed": ratio(seconds("0.01", FIXED), seconds("1", FIXED), "CPU s"),
        "ring_bare": ratio(bare("1", FIXED), seconds("1", FIXED), "CPU s"),
        "ring_preprocess": ratio(preprocess(trials, alpha=1, max_samples=FIXED, method="photonmap"), seconds("1", FIXED), "CPU s"),
        "ring_photons": ratio(variance(trials, "0.01"), variance(trials, "1"), "of the squared caustic", note="by pairs of seeds, at one N"),
        "ring_megabytes": counted(maps("map_bytes", "1", FIXED)[0] / 1e6, "MB"),
    }
    rows = [[alpha, spread([n / pixels for n in maps("camera_rays", alpha, ADAPTIVE)]), spread(seconds(alpha)),
             spread(ratio(seconds(alpha), seconds("1"), "").samples), short(study.paper.number(f"figure1_rendering_{alpha}_s") /
                                                                        study.paper.number("figure1_rendering_1_s")),
             spread(seconds(alpha, FIXED)), spread(ratio(seconds(alpha, FIXED), seconds("1", FIXED), "").samples),
             spread(bare(alpha, ADAPTIVE))] for alpha in ALPHAS]
    part.tables.append(Table(
        "figure1", "Figure 1: the four pictures",
        ["alpha", "rays a pixel, adaptive", "CPU s", "over alpha 1", "the paper's", "CPU s, 4 rays a pixel", "over alpha 1",
         "CPU s without caustic, adaptive"], rows,
        f"{study.paper.number('figure1_photons'):,} photons, N = 100; adaptive: {FIXED} to {ADAPTIVE} rays, until the standard error "
        "is 2 % of the pixel."))
    part.figures += pictures(trials, study.paper.number("figure1_photons"))
    return part


def variance(trials, alpha):
    """Of the caustic between two seeds over its square, each seed with the next."""
    some = [layers["caustic"] for layers in trials.pictures(method="photonmap", alpha=alpha, max_samples=ADAPTIVE)]
    return [float(((a - b) ** 2).mean() / 2 / (((a + b) / 2) ** 2).mean()) for a, b in zip(some, [*some[1:], some[0]])]


def preprocess(trials, **wanted):
    """CPU seconds of tracing photons and building their tree."""
    return [a + b for a, b in zip(trials.column("precompute_cpu_s", **wanted), trials.column("balance_cpu_s", **wanted))]


def pictures(trials, photons):
    shown = {alpha: trials.picture(method="photonmap", alpha=alpha, max_samples=ADAPTIVE, seed=1) for alpha in ALPHAS}
    title = lambda alpha: f"alpha = {alpha}"
    all_light = strip([[(title(alpha), shown[alpha][""]) for alpha in ALPHAS[:2]], [(title(alpha), shown[alpha][""]) for alpha in ALPHAS[2:]]])
    level = white(shown["1"]["caustic"])
    caustic = strip([[(title(alpha), shown[alpha]["caustic"]) for alpha in ALPHAS[:2]],
                     [(title(alpha), shown[alpha]["caustic"]) for alpha in ALPHAS[2:]]], level)
    return [Figure("figure1", "Figure 1: the cardioid as the floor becomes glossy",
                   "A lamp on the edge of a mirror ring; the floor's diffuse-specular component alpha falls from 1 to 0.01. All four at "
                   f"one exposure, {photons:,} photons, N = 100, adaptive sampling. Seen from the lamp's side: from the opposite side "
                   "the lamp's own highlight covers the caustic at small alpha.", *all_light),
            Figure("figure1_caustic", "Figure 1: the caustic alone",
                   "The same pictures without direct light. Where the light of the cardioid arrives along the mirrored viewing ray "
                   "it stays; where it arrives from elsewhere it fades with alpha.", *caustic)]


def sensitivity(study):
    """The time's growth over N: the paper does not give N."""
    trials = study.sweep("figure1_nearest")
    rows, growth = [], []
    for nearest in sorted(trials.values("nearest"), key=natural):
        pick = lambda alpha, most: trials.column("render_cpu_s", nearest=nearest, alpha=alpha, max_samples=most)
        grown = ratio(pick("0.01", ADAPTIVE), pick("1", ADAPTIVE), "").samples
        growth.append(sum(grown) / len(grown))
        rows.append([nearest, spread(pick("1", ADAPTIVE)), spread(pick("0.01", ADAPTIVE)), spread(grown),
                     spread(ratio(pick("0.01", FIXED), pick("1", FIXED), "").samples)])
    table = Table("figure1_nearest", "Figure 1: how much N matters",
                  ["N", "CPU s at alpha 1", "CPU s at alpha 0.01", "ratio, adaptive", "ratio, 4 rays a pixel"], rows,
                  "160 × 120 pixels, otherwise as above.")
    return Part(tables=[table], facts={"ring_growth_over_n": f"{short(min(growth))} to {short(max(growth))} for N = {rows[0][0]} to {rows[-1][0]}"})


def cardioid():
    """Points of the first caustic on the floor: (wall angle, place, direction to the light, direction to the lamp)."""
    for degrees in range(198, 343, 8):
        wall = RADIUS * np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees))])
        way = wall - (0, LAMP_Y)
        s = np.linalg.norm(way)
        normal = -wall / RADIUS
        cosine = -way @ normal / s
        onwards = way / s + 2 * cosine * normal
        further = 1 / (2 / (RADIUS * cosine) - 1 / s)
        if not WALL_LOW < LAMP_Z * further / (s + further) < WALL_HIGH:
            continue
        place = np.append(wall + further * onwards, 0)
        yield degrees, place, unit(np.append(-onwards, LAMP_Z / (s + further))), unit(np.array([0, LAMP_Y, LAMP_Z]) - place)


def unit(v):
    return np.asarray(v) / np.linalg.norm(v)


def schlick(alpha, to_light, to_eye):
    """[J96 (5), (6)] for a floor of reflectance 1."""
    v, w = to_eye[2], to_light[2]
    shadow = lambda c: c / (alpha - alpha * c + c)
    t2 = unit(to_eye + to_light)[2] ** 2
    lobe = alpha / (1 + alpha * t2 - t2) ** 2
    both = shadow(v) * shadow(w)
    return (1 - both) / math.pi + both / (4 * math.pi * v * w) * lobe


def probed(study, points):
    """{(alpha, seed): radiance at each point for each eye}."""
    file = study.output / "trials" / "figure1_probes" / "points.csv"
    file.parent.mkdir(parents=True, exist_ok=True)
    lines = ["x,y,z,nx,ny,nz,wx,wy,wz"]
    for eye in EYES.values():
        for _, place, _, _ in points:
            lines.append(",".join(f"{number:.9g}" for number in (*place, 0, 0, 1, *unit(np.array(eye) - place))))
    file.write_text("\n".join(lines) + "\n")
    found = {}
    for alpha in ALPHAS:
        for seed in range(1, 6 if study.full else 4):
            out, = study.single("figure1_probes", "probe", [
                SCENE, "--set", f"/floor/bsdf/alpha={alpha}", "--method", "photonmap", "--param", "photons=2000000", "--param",
                "nearest=60", "--param", "tree=packed", "--seed", str(seed), "--threads", "1", "--points", str(file)],
                f"alpha{alpha}-s{seed}.csv")
            table = np.genfromtxt(out, delimiter=",", names=True)
            found[alpha, seed] = dict(zip(EYES, np.split(table["radiance_g"], len(EYES))))
    return found


def physics(study):
    """Light on the cardioid runs along its tangent; it fades most where it is farthest from the mirrored viewing ray."""
    points = list(cardioid())
    found = probed(study, points)
    seeds = sorted({seed for _, seed in found})
    shares = {(eye, alpha, seed): found[alpha, seed][eye] / found["1", seed][eye]
              for eye in EYES for alpha in ALPHAS[1:] for seed in seeds}
    law = lambda eye, alpha, which: np.array([
        schlick(float(alpha), point[which], unit(np.array(EYES[eye]) - point[1])) /
        schlick(1, point[which], unit(np.array(EYES[eye]) - point[1])) for point in points])
    off = lambda which, seed: math.sqrt(np.mean([(shares["opposite", alpha, seed] / law("opposite", alpha, which) - 1) ** 2
                                                 for alpha in ALPHAS[1:]]))
    tilt = lambda eye: np.array([math.acos(unit(point[2] + unit(np.array(EYES[eye]) - point[1]))[2]) for point in points])
    fall = lambda eye: [spearman(tilt(eye), shares[eye, "0.01", seed]) for seed in seeds]
    straight = sum(off(3, seed) for seed in seeds) / len(seeds)
    worst = max(abs(shares["opposite", alpha, seed] / law("opposite", alpha, 2) - 1).max() for alpha in ALPHAS[1:] for seed in seeds)
    measured = {
        "ring_tangent": Measured([off(2, seed) for seed in seeds],
                                 note=f"root mean square over {len(points)} points and three alphas; the worst is off by "
                                      f"{100 * worst:.1f} %. Had the light come straight from the lamp, it would be {100 * straight:.0f} %."),
        "ring_fades": Measured(fall("figure"), note=f"from the opposite eye {spread(fall('opposite'))}")}
    degrees = [point[0] for point in points]

    def draw(*axes):
        for ax, eye in zip(axes, ("opposite", "figure")):
            for colour, alpha in zip(("C0", "C1", "C2"), ALPHAS[1:]):
                ax.plot(degrees, law(eye, alpha, 2), color=colour, label=f"alpha {alpha}")
                for seed in seeds:
                    ax.plot(degrees, shares[eye, alpha, seed], "o", color=colour, markersize=3, alpha=0.6)
            ax.set_xlabel("place on the wall that mirrors the light [degrees]")
            ax.set_yscale("log")
            ax.set_title(f"eye at ({', '.join(map(str, EYES[eye]))}) m", loc="left", fontsize=9)
        axes[0].set_ylabel("radiance over that at alpha 1")
        axes[0].legend()

    picture = plot(draw, 8, 3.2, 2)
    return Part(measured, [], [Figure(
        "figure1_tangent", "Figure 1: the light along the cardioid, measured and in closed form",
        "Radiance of the caustic along the cardioid over that at alpha 1. Lines: the BRDF for light that arrives along the tangent of "
        "the cardioid; dots: the photon map, one a seed. From the lamp's side (right) the disc of an estimate spans light of both "
        "branches near the cusp (270 degrees), and a narrow lobe tells.", picture)])


def spearman(x, y):
    ranks = [np.argsort(np.argsort(each)) for each in (x, y)]
    return float(np.corrcoef(*ranks)[0, 1])


SECTIONS = {"figure1": times, "figure1-nearest": sensitivity, "figure1-physics": physics}

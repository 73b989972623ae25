"""Jensen 1996, figure 1's two physical claims in closed form: where the light of the cardioid comes from, and where it fades."""
import math

import numpy as np

from papers.figures import plot
from papers.part import Figure, Part
from papers.verdict import Measured, ratio
from papers.words import spread

# The paper's estimate as words of a command, for the program's own default spreads each photon over a disc; and with it how photons are emitted.
ESTIMATE = ("--method", "photonmap", "--param", "kernel=point")
PHOTON_MAP = (*ESTIMATE, "--param", "emission=random")
ALPHAS = ("1", "0.5", "0.1", "0.01")
RADIUS, LAMP_Y, LAMP_Z, WALL_LOW, WALL_HIGH = 0.5, 0.49, 0.4, 0.001, 0.25  # of experiments/papers/scenes/jensen_ring.json [m]
EYES = {"figure": (0, 1.1, 1.5), "opposite": (0, -1.1, 1.5)}
SCENE = "experiments/papers/scenes/jensen_ring.json"


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
                SCENE, "--set", f"/floor/bsdf/alpha={alpha}", *PHOTON_MAP, "--param", "photons=2000000", "--param", "nearest=60", "--param",
                "tree=packed", "--seed", str(seed), "--points", str(file)],
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
        "ring_fades": Measured(fall("figure"), note=f"from the opposite eye {spread(fall('opposite'))}"),
        "ring_fades_much": ratio(*zip(*(quarters(tilt("figure"), shares["figure", "0.01", seed]) for seed in seeds)), "of the light at alpha 1")}
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
        "branches near the cusp (270 degrees), which a narrow lobe shows.", picture)])


def quarters(tilts, left):
    """Means of what is left of the light over the quarter of the points of the largest tilt, and of the smallest."""
    order, some = np.argsort(tilts), len(tilts) // 4
    return float(left[order[-some:]].mean()), float(left[order[:some]].mean())


def spearman(x, y):
    ranks = [np.argsort(np.argsort(each)) for each in (x, y)]
    return float(np.corrcoef(*ranks)[0, 1])


SECTIONS = {"figure1-physics": physics}

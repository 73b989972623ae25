"""The folded pool seed by seed: bias^2 and variance over N, and bias over the distance to the closed form's folds."""
import json
import math

import numpy as np

from duel import contests, truth
from duel.scores import Scored, write_csv
from report.intervals import student
from report.records import read_rows

NEAREST = (10, 30, 100, 300)
BEAMS, PIXELS = "beamtree", "beamtree, pixels"  # asked at points, and for the squares of pixels
PHOTONS, NEAR, FAR = 100_000, 1.0, (3.0, 6.0)  # photons; pixels from a fold
COLUMNS = ("method", "nearest", "seeds", "bias_square", "variance", "noise", "rms_bias_near", "rms_bias_far", "mean_bias_near", "mean_bias_far")


def settings(scene):
    common = (("filter", "epanechnikov"), *scene.param.items(), ("photons", PHOTONS), ("tree", "packed"))
    maps = [contests.Setting("photonmap", "photonmap", "points", 4, 256, tuple(sorted((*common, ("nearest", n))))) for n in NEAREST]
    beams = (("bound", "two_slice"), ("intensity", "refined"), *scene.param.items())
    return [*maps, contests.Setting(BEAMS, "beamtree", "points", 4, 256, tuple(sorted(beams))),
            contests.Setting(PIXELS, "beamtree", "the pixel", 1, 256, tuple(sorted((*beams, ("footprint", scene.pixel)))))]


def run(race):
    """Writes records/folds.csv and records/folds.json."""
    path = race.output / "records" / "folds.json"
    if path.is_file():
        return
    scene, folder = race.duel.scene("folded"), race.output / "trials" / "folds"
    own, trials = settings(scene), {}
    race.run_sweep(contests.sweep_files(scene, own, race.seeds, race.duel.rules, folder / "sweeps", "folds"), folder)
    scored = Scored(scene, folder)
    for _, row in read_rows(folder / "records.csv")[1]:
        scored.truth_for(row)
        trials.setdefault(contests.setting_of(row, own, scene), []).append(row["trial"])
    away = truth.fold_distance(truth.smooth_pool(scene, folder), scene.size[0])
    biases = {setting: bias(scored, of) for setting, of in trials.items()}
    rows = [{**scored.spread(setting, of), "method": setting.label, "nearest": dict(setting.param).get("nearest", 0),
             **near_and_far(scored, biases[setting].mean(axis=0), away)} for setting, of in trials.items()]
    write_csv(race.output / "records" / "folds.csv", COLUMNS, rows)
    path.write_text(json.dumps(decay(scored, trials, biases, away), indent=1) + "\n", encoding="utf-8")


def bias(scored, trials):
    """Picture minus truth, a picture a seed, means over channels."""
    return np.stack([scored.picture(trial)[0].mean(axis=2) for trial in trials]) - scored.truth.radiance.mean(axis=2)


def bands(away):
    return away <= NEAR, (away >= FAR[0]) & (away <= FAR[1])


def near_and_far(scored, mean, away):
    near, far = bands(away)
    whole = float(scored.truth.radiance.mean())
    return {"rms_bias_near": truth.root(mean[near] ** 2) / whole, "rms_bias_far": truth.root(mean[far] ** 2) / whole,
            "mean_bias_near": float(mean[near].mean()) / whole, "mean_bias_far": float(mean[far].mean()) / whole}


def rms_bias(differences, where):
    """The root mean square of the bias: the mean of two different seeds' differences multiplied, so that noise adds nothing."""
    flat = differences[:, where]
    n = len(flat)
    products = (flat.sum(axis=0) ** 2 - (flat ** 2).sum(axis=0)) / (n * (n - 1))
    return math.sqrt(max(float(products.mean()), 1e-30))


def decay(scored, trials, biases, away):
    """Photon map (N = 100) over the beam tree, at points and for pixels: the far bias over the near one, as was asked for, and the far one alone."""
    near, far = bands(away)
    of = lambda label, n=0: next(biases[setting] for setting in trials if setting.label == label and dict(setting.param).get("nearest", 0) == n)
    photons, points, pixels = of("photonmap", 100), of(BEAMS), of(PIXELS)
    falls = lambda made: rms_bias(made, far) / rms_bias(made, near)
    alone = lambda made: rms_bias(made, far)
    return {"decay": jackknifed(falls, photons, points), "far": jackknifed(alone, photons, points), "far_pixels": jackknifed(alone, photons, pixels),
            "note": f"far over near: photon map {falls(photons):.3g}, beam tree {falls(points):.3g}"}


def jackknifed(measure, top, bottom):
    """[measure(top) / measure(bottom), and the ends of its 95 % interval over the seeds]."""
    seeds = np.arange(len(top))
    ratio = lambda keep: measure(top[keep]) / measure(bottom[keep])
    left = np.log([ratio(np.delete(seeds, i)) for i in seeds])
    n, whole = len(seeds), ratio(seeds)
    spread = math.sqrt((n - 1) / n * float(((left - left.mean()) ** 2).sum()))
    reach = math.exp(student(n - 1) * spread)
    return [whole, whole / reach, whole * reach]

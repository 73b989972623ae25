"""The folded pool seed by seed: bias^2 and variance over N, and bias over the distance to the closed form's folds."""
import json
import math

import numpy as np

from duel import contests, curves, truth
from duel.scores import Scored, write_csv
from report.records import read_rows

NEAREST = (10, 30, 100, 300)
PHOTONS, NEAR, FAR = 100_000, 1.0, (3.0, 6.0)  # photons; pixels from a fold
COLUMNS = ("method", "nearest", "seeds", "bias_square", "variance", "noise", "rms_bias_near", "rms_bias_far", "mean_bias_near", "mean_bias_far")


def settings(scene):
    common = (("filter", "epanechnikov"), *scene.param.items(), ("photons", PHOTONS), ("tree", "packed"))
    maps = [contests.Setting("photonmap", "photonmap", "points", 4, 256, tuple(sorted((*common, ("nearest", n))))) for n in NEAREST]
    beams = (("bound", "two_slice"), ("intensity", "refined"), *scene.param.items())
    return [*maps, contests.Setting("beamtree", "beamtree", "points", 4, 256, tuple(sorted(beams)))]


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
    rows = [{**scored.spread(setting, of), "method": setting.method, "nearest": dict(setting.param).get("nearest", 0),
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
    """The far bias over the near one, photon map (N = 100) over beam tree, with its interval over the seeds (jackknife)."""
    near, far = bands(away)
    of = lambda method, n: next(biases[setting] for setting in trials if setting.method == method and dict(setting.param).get("nearest", 0) == n)
    photons, beams = of("photonmap", 100), of("beamtree", 0)
    ratio = lambda keep: (rms_bias(photons[keep], far) / rms_bias(photons[keep], near)) / (rms_bias(beams[keep], far) / rms_bias(beams[keep], near))
    seeds = np.arange(len(photons))
    whole = ratio(seeds)
    left = np.log([ratio(np.delete(seeds, i)) for i in seeds])
    n = len(seeds)
    spread = math.sqrt((n - 1) / n * float(((left - left.mean()) ** 2).sum()))
    reach = math.exp(curves.student(n - 1) * spread)
    return {"decay": [whole, whole / reach, whole * reach],
            "note": f"far over near: photon map {rms_bias(photons, far) / rms_bias(photons, near):.3g}, beam tree {rms_bias(beams, far) / rms_bias(beams, near):.3g}"}

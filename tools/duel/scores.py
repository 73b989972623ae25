"""Pictures against truths: one record a trial, and bias^2 and variance of each setting.

relmse is the program's: mean over reached pixels and channels of (x - r)^2 / (r^2 + 0.01 mean(r)^2); rmse its plain square root of
mean (x - r)^2. `relmse_noise` and `rmse_noise` are the truth's own errors in the same measures, from its standard error in each pixel.
"""
import csv
import json

import numpy as np

from duel import contests, truth
from report import exr
from report.records import RecordsError

COLUMNS = ("scene", "phase", "method", "label", "settings", "asks", "spp", "seed", "build_s", "query_s", "map_bytes", "peak_bytes",
           "photons_emitted", "photons_stored", "beams", "relmse", "relmse_noise", "rmse", "rmse_noise", "mean", "mean_ratio",
           "code_version", "cpu", "load_average", "trial")
TEXTS = ("scene", "phase", "method", "label", "settings", "asks", "code_version", "cpu", "trial")
CELL_COLUMNS = ("scene", "label", "settings", "seeds", "error", "bias_square", "variance", "noise")


class Truth:
    """Radiance, height x width x 3, its standard error in each pixel, and which pixels count."""

    def __init__(self, radiance, error, reached):
        self.radiance, self.error, self.reached = radiance, error, reached

    @classmethod
    def of_quadrature(cls, scene, folder):
        radiance, error = truth.pool(scene, folder)
        return cls(np.repeat(radiance[:, :, None], 3, axis=2), error, np.ones(radiance.shape, bool))

    @classmethod
    def of_reference(cls, name, folder):
        """The picture that a sweep's column `reference` names: kept beside the trials, or in experiments/references."""
        key = name.partition(":")[2]
        places = [folder / "references" / f"{key}.exr", contests.ROOT / "experiments" / "references" / f"{key}.exr"]
        path = next((place for place in places if place.is_file()), None)
        if path is None:
            raise RecordsError(f"{places[0]}: the reference is not there")
        layers = exr.read_layers(path)
        return cls(layers["caustic"].astype(np.float64), layers["stderr"].astype(np.float64), reached(layers))

    def score(self, picture, mask):
        """(relmse, its noise, rmse, its noise, mean of the truth, ratio of means)."""
        r, x, own = self.radiance[mask], picture[mask], self.error[mask][:, None]
        scale = r ** 2 + 0.01 * float(r.mean()) ** 2
        return (float(np.mean((x - r) ** 2 / scale)), float(np.mean(own ** 2 / scale)), truth.root((x - r) ** 2),
                truth.root(own ** 2), float(r.mean()), float(x.mean() / r.mean()))


def reached(layers):
    return layers["unreached"] == 0 if "unreached" in layers else np.ones(layers["caustic"].shape[:2], bool)


class Scored:
    """The trials of one scene's sweep: rows as COLUMNS, and pictures while they are there."""

    def __init__(self, scene, folder):
        self.scene, self.folder, self.truth = scene, folder, None

    def truth_for(self, row):
        if self.truth is None:
            self.truth = (Truth.of_quadrature(self.scene, self.folder) if self.scene.quadrature()
                          else Truth.of_reference(row["reference"], self.folder))
        return self.truth

    def picture(self, trial):
        layers = exr.read_layers(self.folder / "trials" / trial / "image.exr")
        return layers["caustic"].astype(np.float64), reached(layers)

    def record(self, row, setting, phase):
        truth_here = self.truth_for(row)
        picture, mask = self.picture(row["trial"])
        relmse, noise, rmse, rmse_noise, mean, ratio = truth_here.score(picture, mask & truth_here.reached)
        number = lambda name: float(row[name] or 0)
        return {"scene": self.scene.name, "phase": phase, "method": setting.method, "label": setting.label, "settings": setting.text(),
                "asks": setting.asks, "spp": setting.spp, "seed": int(row["seed"]),
                "build_s": number("precompute_cpu_s") + number("balance_cpu_s"), "query_s": number("render_cpu_s"),
                "map_bytes": number("map_bytes"), "peak_bytes": number("peak_rss_bytes") - number("rss_start_bytes"),
                "photons_emitted": number("photons_emitted"), "photons_stored": number("photons_stored"), "beams": number("beams"),
                "relmse": relmse, "relmse_noise": noise, "rmse": rmse, "rmse_noise": rmse_noise, "mean": mean, "mean_ratio": ratio,
                "code_version": row["code_version"], "cpu": row["cpu"], "load_average": number("load_average"), "trial": row["trial"]}

    def spread(self, setting, trials):
        """bias^2 and variance of a setting in the measure of relmse, over the seeds: mse = bias^2 + variance + noise."""
        pictures, masks = zip(*(self.picture(trial) for trial in trials))
        mask = np.logical_and.reduce([self.truth.reached, *masks])
        r, own = self.truth.radiance[mask], self.truth.error[mask][:, None]
        x = np.stack([picture[mask] for picture in pictures])
        scale = r ** 2 + 0.01 * float(r.mean()) ** 2
        variance = float(np.mean(x.var(axis=0, ddof=1) / scale))
        square, noise = float(np.mean((x - r) ** 2 / scale)), float(np.mean(own ** 2 / scale))
        return {"scene": self.scene.name, "label": setting.label, "settings": setting.text(), "seeds": len(trials),
                "error": max(square - noise, 0) ** 0.5, "bias_square": square - variance - noise, "variance": variance, "noise": noise}


def write_csv(path, columns, rows):
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(f"{path}.part", "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows([number_text(row[name]) for name in columns] for row in rows)
    path.with_name(f"{path.name}.part").replace(path)


def number_text(value):
    if isinstance(value, float):
        return str(int(value)) if value == int(value) and abs(value) < 1e15 else f"{value:.7g}"
    return value


def read_csv(path, texts=TEXTS):
    """Rows with numbers as numbers."""
    if not path.is_file():
        raise RecordsError(f"{path}: not there (run tools/duel.sh)")
    with open(path, newline="", encoding="utf-8") as file:
        return [{name: value if name in texts else json.loads(value) for name, value in row.items()} for row in csv.DictReader(file)]

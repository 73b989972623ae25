"""What pictures are scored against: the caustic's mean over each pixel, its standard error, and the pixels that count.

Pools: the quadrature of tools/pool_truth.py. Ring and ball: splat.cpp, four batches on seeds of their own. Given meshes: `lighttrace`,
with the standard error that it states. All but the last share no code with the program; each is held against `lighttrace`.
"""
import json

import numpy as np

import pool_truth
from peers import contest, contestants
from report import exr

BATCHES = (9001, 9002, 9003, 9004)
SEED, CHECK_SEED = 9000, 8000
CHECK_PATHS = 4_000_000
MASK_SAMPLES = 64
BLOCK = 8  # pixels along a side, where truths are held against lighttrace


class Truth:
    def __init__(self, radiance, error, mask):
        self.radiance, self.error, self.mask = radiance, error, mask

    def score(self, picture):
        """relmse and rmse² over the mean², the truth's own noise in both, and the ratio of means, over the pixels that count."""
        r, x, own = self.radiance[self.mask], picture[self.mask], self.error[self.mask]
        mean = float(r.mean())
        scale = r ** 2 + 0.01 * mean ** 2
        return {"relmse": float(np.mean((x - r) ** 2 / scale)), "relmse_noise": float(np.mean(own ** 2 / scale)),
                "mse": float(np.mean((x - r) ** 2)) / mean ** 2, "mse_noise": float(np.mean(own ** 2)) / mean ** 2,
                "mean_ratio": float(x.mean()) / mean}


def of_scene(scene, programs, folder):
    """(Truth, what the page says of it); kept in the folder."""
    path = folder / f"truth_{scene.name}.npz"
    if not path.exists():
        radiance, error = made(scene, programs)
        check, spread, mask = traced(scene, programs, CHECK_PATHS, CHECK_SEED)
        about = held_against(radiance, error, check, spread, mask) | {"how": how(scene)}
        part = path.with_suffix(".part.npz")
        np.savez(part, radiance=radiance, error=error, mask=mask, about=json.dumps(about))
        part.replace(path)
    with np.load(path) as kept:
        return Truth(kept["radiance"], kept["error"], kept["mask"]), json.loads(str(kept["about"]))


def how(scene):
    if "quadrature" in scene.truth:
        return f"quadrature of {scene.truth['quadrature']}² cells"
    return f"splat of {len(BATCHES)} x {scene.truth['splat']:,}" if "splat" in scene.truth else f"lighttrace, {scene.truth['lighttrace']:,} paths"


def made(scene, programs):
    if "quadrature" in scene.truth:
        path = programs.work / "truth_scene.json"
        path.write_text(json.dumps(scene.resolved()), encoding="utf-8")
        return pool_truth.Pool(path, scene.set["/water/to_world/0/scale/2"]).radiance_with_error(scene.truth["quadrature"])
    if "splat" in scene.truth:
        intensity = contest.lamp(scene.resolved())[1]
        batches = np.stack([intensity * programs.splat_picture(scene, scene.truth["splat"], seed)[1] for seed in BATCHES])
        return batches.mean(axis=0), batches.std(axis=0, ddof=1) / len(BATCHES) ** 0.5
    return traced(scene, programs, scene.truth["lighttrace"], SEED)[:2]


def traced(scene, programs, paths, seed):
    """(radiance, standard error, pixels that see the floor alone) by lighttrace."""
    out = programs.work / "traced.exr"
    programs.timed([programs.bench, "render", contest.ROOT / scene.file, *contestants.sets(scene, ()), "--method", "lighttrace", "--param",
                    "emission=stratified", "--param", f"paths={paths}", "--spp", MASK_SAMPLES, "--seed", seed, "--threads", 1, "-o", out])
    layers = exr.read_layers(out)
    mask = layers["unreached"] == 0 if "unreached" in layers else np.ones(layers["caustic"].shape[:2], bool)
    return layers["caustic"][..., 1].astype(np.float64), layers["stderr"][..., 1].astype(np.float64), mask


def held_against(radiance, error, check, spread, mask):
    """Means' ratio, and root mean square of z over blocks of pixels that all count."""
    side = lambda values: values[:values.shape[0] // BLOCK * BLOCK, :values.shape[1] // BLOCK * BLOCK]
    blocks = lambda values: side(values).reshape(values.shape[0] // BLOCK, BLOCK, -1, BLOCK).sum(axis=(1, 3))
    variance = blocks(spread ** 2 + error ** 2)
    usable = (blocks(mask.astype(float)) == BLOCK ** 2) & (variance > 0)
    z = blocks(check - radiance)[usable] / np.sqrt(variance[usable])
    mean = float(radiance[mask].mean())
    return {"mean": mean, "lighttrace_mean_ratio": float(check[mask].mean()) / mean, "z": float(np.sqrt(np.mean(z ** 2))), "blocks": int(usable.sum()),
            "own_error": float(np.sqrt(np.mean(error[mask] ** 2))) / mean, "pixels": int(mask.sum())}

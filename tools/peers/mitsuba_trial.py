"""One picture by Mitsuba's ptracer: its caustic, and the CPU seconds of the process up to then.

Usage: mitsuba_trial.py SCENE.xml VARIANT SPP SEED DEPTH ROULETTE DIRECT OUT.npz

Paths end at DEPTH surfaces, by roulette from ROULETTE on. Samples a pixel go in passes of at most 2^21 light paths, for memory. With
DIRECT 1 a second run with the same seed ends paths at the first surface: the same light paths' direct light, which is taken away. Its
time does not count.
"""
import resource
import sys

import numpy as np

MOST_PATHS = 1 << 21


def passes(mitsuba, scene, spp, seed):
    width, height = scene.sensors()[0].film().size()
    most = max(1, MOST_PATHS // (width * height))
    total, done = 0, 0
    while done < spp:
        count = min(most, spp - done)
        total = total + count * np.array(mitsuba.render(scene, seed=1000 * seed + done, spp=count), dtype=np.float64)
        done += count
    return total / spp


def main(path, variant, spp, seed, depth, roulette, direct, out):
    import drjit
    import mitsuba

    mitsuba.set_variant(variant)
    mitsuba.set_log_level(mitsuba.LogLevel.Error)
    drjit.set_thread_count(1)
    picture = passes(mitsuba, mitsuba.load_file(path, max_depth=depth, roulette=roulette), int(spp), int(seed))
    used = resource.getrusage(resource.RUSAGE_SELF)
    if int(direct):
        picture = picture - passes(mitsuba, mitsuba.load_file(path, max_depth="2", roulette=roulette), int(spp), int(seed))
    np.savez(out, caustic=picture[..., 1], cpu_s=used.ru_utime + used.ru_stime, version=mitsuba.__version__)


if __name__ == "__main__":
    main(*sys.argv[1:])

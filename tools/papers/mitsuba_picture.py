"""One picture by Mitsuba, run by the Python that has it: mitsuba_picture.py SCENE.xml INTEGRATOR RAYS SEED OUT.npz"""
import resource
import sys

import numpy as np


def main(path, integrator, rays, seed, out):
    import mitsuba

    mitsuba.set_variant("scalar_rgb")
    mitsuba.set_log_level(mitsuba.LogLevel.Error)
    scene = mitsuba.load_file(path, integrator=integrator)
    picture = np.array(mitsuba.render(scene, seed=int(seed), spp=int(rays)), dtype=np.float64)
    used = resource.getrusage(resource.RUSAGE_SELF)
    np.savez_compressed(out, picture=picture, cpu_s=used.ru_utime + used.ru_stime)


if __name__ == "__main__":
    main(*sys.argv[1:])

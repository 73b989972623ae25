"""What is counted instead of raced: tests in trees over casters, lights, diffuse detail and curvature; the eye pass over photons.

Counts are the same on every run and machine; times are CPU seconds.
"""
import json

from duel import contests
from duel.scores import write_csv
from report.records import read_rows

SWEEPS = ("counts_casters", "counts_lights", "counts_floor", "counts_mirror", "counts_photons")
CASTERS = (1, 4, 16, 36, 64, 100)
COUNTERS = ("polygons", "beams", "trees", "height", "cone_point_tests", "beam_point_tests", "beam_point_hits", "beam_polygon_tests",
            "receiver_points", "camera_rays")
COLUMNS = ("sweep", "method", "swept", "repeat", *COUNTERS, "receiver_triangles", "build_s", "query_s", "code_version", "cpu")
TEXTS = ("sweep", "method", "swept", "code_version", "cpu")


def run(race):
    """Writes records/counts.csv."""
    path = race.output / "records" / "counts.csv"
    if path.is_file():
        return
    records = []
    for name in SWEEPS:
        folder = race.output / "trials" / name
        folder.mkdir(parents=True, exist_ok=True)
        sweep = casters_sweep(folder) if name == "counts_casters" else contests.FOLDER / "sweeps" / f"{name}.json"
        race.log(name)
        race.run_sweep([sweep], folder)
        records += [record(name, row, folder) for _, row in read_rows(folder / "records.csv")[1] if row["status"] == "done"]
    write_csv(path, COLUMNS, records)


def casters_sweep(folder):
    """The scene of 100 balls with the first so many of them."""
    scene = json.loads((contests.FOLDER / "scenes" / "casters.json").read_text(encoding="utf-8"))
    balls = [name for name in scene if name.startswith("ball_")]
    files = []
    for count in CASTERS:
        kept = {name: value for name, value in scene.items() if name not in balls[count:]}
        files.append(folder / f"casters_{count}.json")
        files[-1].write_text(json.dumps(kept), encoding="utf-8")
    sweep = {"version": 1, "scenes": [file.name for file in files], "spp": 1,
             "methods": [{"method": "beamtree", "param": {"bound": "hybrid", "mesh_resolution": 8, "max_bounces": 2}}]}
    path = folder / "sweep.json"
    path.write_text(json.dumps(sweep), encoding="utf-8")
    return path


def record(name, row, folder):
    kept = json.loads((folder / "trials" / row["trial"] / "record.json").read_text(encoding="utf-8"))
    counters = kept["counters"]
    number = lambda column: float(row[column] or 0)
    return {"sweep": name, "method": row["method"], "swept": swept(name, row), "repeat": int(row["repeat"]),
            **{each: counters.get(each, number(each) if each in row else 0) for each in COUNTERS},
            "height": number("tree_height"), "receiver_triangles": 2 * 4 ** int(swept(name, row)) if name == "counts_floor" else 0,
            "build_s": number("precompute_cpu_s") + number("balance_cpu_s"), "query_s": number("render_cpu_s"),
            "code_version": row["code_version"], "cpu": row["cpu"]}


def swept(name, row):
    """What the sweep varies, as text."""
    if name == "counts_casters":
        return row["scene"].rpartition("_")[2]
    if name == "counts_floor":
        return str(json.loads(row["floor"])["fractal"]["levels"])
    if name == "counts_mirror":
        amplitude = json.loads(row["waves"])[0]["amplitude"]
        return f"{'concave' if amplitude < 0 else 'convex' if amplitude > 0 else 'flat'} {row['bound']}"
    if name == "counts_lights":
        return row["light_samples"]
    return f"{row['photons']} {row['tree']}".strip() or "none"

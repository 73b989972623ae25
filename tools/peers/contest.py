"""tools/peers/contest.json: scenes, the settings a contestant may choose, and the numbers that the splat is told.

A setting is a tuple of sorted (name, value) pairs. Lengths are metres.
"""
import itertools
import json
import math
import pathlib

import numpy as np

from report.set_scene import SetScene

ROOT = pathlib.Path(__file__).resolve().parents[2]
FILE = pathlib.Path(__file__).resolve().parent / "contest.json"
OURS = ("photonmap", "beamtree")  # the methods compared with the peers
MARGIN = 1.002  # of the cone round a caster


class Scene(SetScene):
    def all_set(self, setting=()):
        """{JSON pointer: value} with the film's size and the setting's mesh, normals and camera samples."""
        chosen = dict(setting)
        mesh = {self.mesh: chosen["mesh"]} if "mesh" in self.text and "mesh" in chosen else {}
        flat = {self.mesh.replace("resolution", "face_normals"): True} if chosen.get("normals") == "face" else {}
        lattice = {"/sensor/sampler/jitter": chosen["jitter"]} if "jitter" in chosen else {}
        return {**super().all_set(), **mesh, **flat, **lattice}


class Contest:
    def __init__(self, path=FILE):
        self.text = json.loads(path.read_text(encoding="utf-8"))
        self.scenes = [Scene(each) for each in self.text["scenes"]]
        self.names = [each["name"] for each in self.text["contestants"]]
        self.titles = {each["name"]: each["title"] for each in self.text["contestants"]}

    def settings(self, scene, name):
        """All of a contestant's search, each once."""
        rows = next(each["rows"] for each in self.text["contestants"] if each["name"] == name)
        found = {}
        for row in rows:
            if scene.kind not in row.get("kinds", [scene.kind]) or row.get("needs", "kind") not in scene.text:
                continue
            own = {key: values for key, values in row.items() if key not in ("kinds", "needs")}
            if "mesh" in scene.text and name in self.text["mesh"]:
                own.setdefault("mesh", [self.text["mesh"][name]])
            for values in itertools.product(*own.values()):
                lengths = [value["pixels"] * scene.pixel if isinstance(value, dict) else value for value in values]
                found.setdefault(tuple(sorted(zip(own, lengths))), None)
        return list(found)


def words(setting):
    """A setting as records and tables name it."""
    shown = lambda value: str(value).lower() if isinstance(value, bool) else f"{value:.4g}" if isinstance(value, float) else str(value)
    return ", ".join(f"{name} {shown(value)}" for name, value in setting)


def lamp(scene):
    """(position, intensity) of a scene's point light, as JSON."""
    light = next(each for each in scene.values() if isinstance(each, dict) and each.get("type") == "point")
    return light["position"], light["intensity"]


def splat_numbers(scene):
    """What splat.cpp reads, for the shape of a scene."""
    text = scene.resolved()
    camera = text["sensor"]["to_world"][0]["look_at"]
    unit = lambda vector: vector / np.linalg.norm(vector)
    eye = np.array(camera["origin"], float)
    forward = unit(np.array(camera["target"]) - eye)
    right = unit(np.cross(forward, camera["up"]))
    floor = text["floor"]
    moved = floor["to_world"][1]["translate"][2] if len(floor["to_world"]) > 1 else 0
    size = floor["to_world"][0]["scale"]
    numbers = [*scene.size, math.tan(math.radians(text["sensor"]["fov"]) / 2), *eye, *right, *np.cross(right, forward), *forward,
               *lamp(text)[0], moved, size[0] if isinstance(size, list) else size, floor["bsdf"]["reflectance"]]
    return [float(each) for each in numbers + SHAPES[scene.shape](text)]


def pool_numbers(text):
    water = text["water"]
    scale = water["to_world"][0]["scale"][2]
    waves = [[scale * wave["amplitude"], *wave["wave_vector"], wave["phase"]] for wave in water["waves"]]
    return [water["bsdf"]["int_ior"] / water["bsdf"]["ext_ior"], *water["half_size"], len(waves), *itertools.chain(*waves)]


def ring_numbers(text):
    ring = text["ring"]
    return [ring["radius"], ring["p0"][2], ring["p1"][2], ring["bsdf"]["bsdf"]["specular_reflectance"]]


def ball_numbers(text):
    ball = text["ball"]
    return [*ball["center"], ball["radius"], ball["bsdf"]["int_ior"] / ball["bsdf"]["ext_ior"]]


SHAPES = {"pool": pool_numbers, "ring": ring_numbers, "ball": ball_numbers}


def outline(around):
    """Points, n x 3, whose hull holds a caster."""
    kind, numbers = next(iter(around.items()))
    if kind == "box":
        steps = [np.linspace(-1, 1, 9)] * 2 + [np.array([-1, 1])]
        return np.stack([grid.ravel() for grid in np.meshgrid(*steps)], axis=1) * numbers
    turn = np.linspace(0, 2 * np.pi, 128, endpoint=False)
    if kind == "cylinder":
        radius, low, high = numbers
        return np.array([(radius * np.cos(t), radius * np.sin(t), z) for t in turn for z in (low, high)])
    tilt = np.linspace(0, np.pi, 65)
    centre, radius = np.array(numbers[:3]), numbers[3]
    return np.array([centre + radius * np.array((np.sin(p) * np.cos(t), np.sin(p) * np.sin(t), np.cos(p))) for p in tilt for t in turn])


def cone(around, lamp_position):
    """(axis, half angle in degrees) of a narrow cone from the lamp round a caster: its axis is led towards the farthest direction,
    by less and less [Badoiu and Clarkson 2003]."""
    ways = outline(around) - np.array(lamp_position)
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    axis = ways.mean(axis=0)
    for step in range(1, 500):
        axis /= np.linalg.norm(axis)
        axis += (ways[np.argmin(ways @ axis)] - axis) / (step + 1)
    axis /= np.linalg.norm(axis)
    return axis, MARGIN * math.degrees(math.acos(np.clip((ways @ axis).min(), -1, 1)))

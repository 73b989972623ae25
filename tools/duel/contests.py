"""experiments/duel: its scenes, the settings that a method may choose, and the sweep files that follow from them.

A *setting* is one combination of a method's parameters, its camera samples a pixel and, where it may choose one, the caster's
mesh. Lengths are metres.
"""
import dataclasses
import itertools
import json
import math
import pathlib

from report.records import RecordsError, canonical
from report.set_scene import SetScene

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = ROOT / "experiments" / "duel"
EXACT, GIVEN = "exact", "given"
SIZES = ("quick", "smoke")  # shorter runs


@dataclasses.dataclass(frozen=True)
class Setting:
    """`label` is the method as tables name it: the paper's cones, and beams that photons complete, run apart from the beam tree's own bound."""
    label: str
    method: str
    asks: str
    spp: int
    mesh: object  # None where the method has no choice
    param: tuple  # sorted (name, value)

    def text(self):
        words = [f"{name} {shown(value)}" for name, value in self.param
                 if name not in ("tree", "bound", "max_bounces", "leaf") or value in ("balanced", "unbalanced")]
        words += [f"mesh {self.mesh}"] if self.mesh is not None else []
        return ", ".join([*words, f"{self.spp} spp"])


def shown(value):
    return {True: "yes", False: "no"}[value] if isinstance(value, bool) else canonical(str(value))


class Scene(SetScene):
    """One scene as it is set; `text` is its entry of scenes.json."""
    def is_base(self):
        return self.text.get("base", False)

    def quadrature(self):
        return "quadrature" in self.truth


class Duel:
    def __init__(self, folder=FOLDER):
        self.folder = folder
        read = lambda name: json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))
        self.rules, self.space, self.text = read("scenes"), read("methods"), read("hypotheses")
        self.scenes = [Scene(each) for each in self.rules["scenes"]]
        self.hypotheses, self.judged = self.text["hypotheses"], read("judged")
        names = [scene.name for scene in self.scenes]
        for size in SIZES:
            unknown = [name for name in self.rules[size]["only"] if name not in names]
            if unknown:
                raise RecordsError(f"scenes.json: {size}: no scene {unknown[0]} (known: {', '.join(names)})")

    def scene(self, name):
        return next(scene for scene in self.scenes if scene.name == name)

    def settings(self, scene):
        """Every setting of the search on a scene, each once."""
        found = {}
        for method in self.space["methods"]:
            for row in method["rows"]:
                if row.get("as", method["method"]) not in scene.text.get("without", []) and allowed(row, scene):
                    for setting in row_settings(method, row, scene):
                        found.setdefault(setting, None)
        return list(found)

    def kept(self, label):
        """The most settings of a method that go on from the search."""
        return next(method.get("keep", 1) for method in self.space["methods"] if method["method"] == label.partition(",")[0])


def allowed(row, scene):
    if row.get("grid", scene.grid) != scene.grid or min(row["spp"]) > scene.text.get("most_spp", math.inf):
        return False
    square = scene.text.get("square", False)
    needs = {None: True, "square pixels": square, "no square pixels": not square, "exact casters": scene.mesh == EXACT,
             "several events": scene.text.get("several_events", False)}
    return needs[row.get("needs")]


def row_settings(method, row, scene):
    label = row.get("as", method["method"])
    own = {**row["param"], **({} if method["method"] == "none" else scene.text.get("param", {}))}
    if "mesh_resolution" in own and scene.mesh != EXACT:
        del own["mesh_resolution"]
    elif "mesh_resolution" in own and "mesh_resolution" in scene.text:
        own["mesh_resolution"] = scene.mesh_resolution
    if method["method"] in ("beamtree", "causticpolygons") and "light_samples" in scene.text:
        own["light_samples"] = scene.light_samples
    values = [[length(value, scene) for value in each] if isinstance(each, list) else [length(each, scene)] for each in own.values()]
    meshes = scene.mesh.get(label, []) if isinstance(scene.mesh, dict) else [None]
    samples = [spp for spp in row["spp"] if spp <= scene.text.get("most_spp", math.inf)]
    for spp, mesh, *chosen in itertools.product(samples, meshes, *values):
        param = tuple(sorted(zip(own, chosen)))
        if any(value > scene.text.get("most", {}).get(name, math.inf) for name, value in param if not isinstance(value, str)):
            continue
        yield Setting(label, method["method"], row.get("asks", method["asks"]), spp, mesh, param)


def length(value, scene):
    return value["pixels"] * scene.pixel if isinstance(value, dict) else value


def sweep_files(scene, settings, seeds, rules, folder, phase):
    """Writes one sweep file for each number of samples and mesh; returns their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    groups = {}
    for setting in settings:
        groups.setdefault((setting.spp, setting.mesh), []).append(setting)
    paths = []
    for (spp, mesh), own in groups.items():
        path = folder / f"{phase}_spp{spp}{'' if mesh is None else f'_mesh{mesh}'}.json"
        path.write_text(json.dumps(sweep(scene, own, seeds, rules), indent=1) + "\n", encoding="utf-8")
        paths.append(path)
    return paths


def sweep(scene, settings, seeds, rules):
    """The reference has a seed of its own: with a trial's it would be made of the same light paths."""
    first = settings[0]
    fixed = dict(scene.all_set())
    if first.mesh is not None:
        fixed[scene.mesh["pointer"]] = first.mesh
    file = ROOT / scene.file
    made = {"version": 1, "scenes": [str(file)],
            "set": {f"set_{i}": {"pointer": pointer, "values": [value]} for i, (pointer, value) in enumerate(fixed.items())},
            "methods": [{"method": each.method, "param": dict(each.param)} if each.param else {"method": each.method} for each in settings],
            "seeds": list(seeds), "spp": first.spp, "threads": rules["threads"]}
    if not scene.quadrature():
        param = {"paths": scene.truth["paths"], "emission": "stratified", **scene.text.get("param", {})}
        made["reference"] = {"method": "lighttrace", "param": param, "seed": rules["reference_seed"], "spp": rules["reference_spp"]}
    return made


def setting_of(row, settings, scene):
    """The setting that made a row of records."""
    names = {name for setting in settings for name, _ in setting.param} - {"nearest", "mesh_resolution", "max_bounces"}
    fits = [each for each in settings if each.method == row["method"] and str(each.spp) == row["spp"] and params_fit(each, row, names)
            and (each.mesh is None or row[mesh_column(scene, each)] == str(each.mesh))]
    if len(fits) != 1:
        raise RecordsError(f"trial {row['trial']}: {len(fits)} settings fit it")
    return fits[0]


def mesh_column(scene, setting):
    pointers = [*scene.all_set(), scene.mesh["pointer"]]
    return f"set_{list(dict.fromkeys(pointers)).index(scene.mesh['pointer'])}"


def params_fit(setting, row, names):
    own = dict(setting.param)
    plain = lambda value: {True: "true", False: "false"}[value] if isinstance(value, bool) else canonical(str(value))
    if any(plain(own[name]) != canonical(row.get(name, "")) for name in ("nearest", "mesh_resolution") if name in own):
        return False
    return all((plain(own[name]) if name in own else "") == canonical(row.get(name, "")) for name in names)

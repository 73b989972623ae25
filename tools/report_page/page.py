"""The page: what it shows as JSON, its pictures, and the one file of HTML, CSS and JavaScript around them."""
import json
import math
import os
import pathlib
import shlex

from report.intervals import student
from report.records import FORMULAS, missed_text, same
from report import exr
from report_page import pictures
from report_page.scenes import COSTS, ERRORS, best_of, rank, seeds_text

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
REFERENCES = (ROOT / "experiments" / "references", ROOT / "references")  # of the source, of an installation
ROUNDING = 1e-9  # of a reference's mean, as the program allows when it takes errors anew
SCRIPTS = ("page", "pixels", "colours", "formulas", "statistics", "plots", "viewer", "strip", "probe", "curves", "table", "main")
WORDS = {
    "rmse": FORMULAS["rmse"], "relmse": FORMULAS["relmse"], "mean_ratio": FORMULAS["mean_ratio"],
    "bias": "bias = mean(x − r) / mean(r)",
    "variance": "variance: sample variance over the seeds (divided by seeds − 1), mean over pixels and channels",
    "leak_energy": "leak_energy = mean of x where r is exactly 0, over mean(r)",
    "mask_rmse": "mask_rmse = √ mean (x − r)² where r ≥ mean(r)",
    "mask_relmse": "mask_relmse = mean (x − r)² / (r² + ε) where r ≥ mean(r),  ε = 0.01 mean(r)²",
    "mask_mean_ratio": "mask_mean_ratio = mean(x) / mean(r) where r ≥ mean(r)",
    "beauty_rmse": "beauty_rmse = √ mean (x − r)² of the whole picture",
    "flip": "flip: mean HDR-FLIP of the reference's beauty beside the same with the trial's caustic",
    "indirect_rmse": "indirect_rmse = √ mean (x − r)² of the indirect layer",
    "indirect_relmse": "indirect_relmse = mean (x − r)² / (r² + ε) of the indirect layer,  ε = 0.01 mean(r)²",
    "indirect_mean_ratio": "indirect_mean_ratio = mean(x) / mean(r) of the indirect layer",
    "work_s": "CPU seconds of build (of indirect light too) and query",
    "build_s": "CPU seconds of the method's precompute pass (photons or beams, and their trees)",
    "query_s": "CPU seconds of the eye pass",
    "indirect_cpu_s": "CPU seconds of the indirect method's precompute pass",
    "total_s": "wall seconds of the whole trial",
    "photons_stored": "photons in the map", "photons_emitted": "light paths started",
    "map_bytes": "bytes of what the method built", "peak_rss_bytes": "most bytes of the process in memory",
}
NAMES = {"work_s": "CPU time", "build_s": "build time", "query_s": "query time",
         "indirect_cpu_s": "indirect light's precompute time", "total_s": "wall time",
         "photons_stored": "stored photons", "photons_emitted": "light paths", "map_bytes": "size of what was built",
         "peak_rss_bytes": "peak memory"}
UNITS = {"rmse": "W m⁻² sr⁻¹", "mask_rmse": "W m⁻² sr⁻¹", "beauty_rmse": "W m⁻² sr⁻¹",
         "indirect_rmse": "W m⁻² sr⁻¹", "variance": "(W m⁻² sr⁻¹)²",
         "work_s": "CPU s", "build_s": "CPU s", "query_s": "CPU s", "indirect_cpu_s": "CPU s", "total_s": "s", "map_bytes": "bytes",
         "peak_rss_bytes": "bytes"}


class Album:
    """The pictures of the page, kept in the order of what is wanted first, until they are as large as the page may be."""

    def __init__(self, most_bytes):
        self.most_bytes, self.bytes, self.about, self.texts, self.left_out = most_bytes, 0, [], [], 0
        self.wanted = 0  # bytes, of those left out too

    def keep(self, values):
        """The number of a picture, or the reason why it is not here."""
        about, text = pictures.packed(values)
        self.wanted += len(text)
        if self.bytes + len(text) > self.most_bytes:
            self.left_out += 1
            return {"hole": f"left out: with it the pictures are larger than {self.most_bytes / 1e6:g} MB (--megabytes)"}
        self.bytes += len(text)
        self.about.append(about)
        self.texts.append(text)
        return len(self.about) - 1

    def leave_out(self, values):
        """Counts a further layer of a picture that is left out."""
        self.wanted += len(pictures.packed(values)[1])

    def megabytes_wanted(self):
        """The --megabytes with which all pictures are kept."""
        return math.ceil(self.wanted / 1e4) / 100


def picture_count(scenes):
    """How many pictures make() looks for."""
    return sum(bool(scene.reference) + sum(len(cell.seeds()) for cell in scene.cells) for scene in scenes)


def make(sweeps, scenes, references, megabytes, tell=lambda picture: None):
    """(the page's text, what to tell the user). `tell` hears of each picture before it is read."""
    album = Album(int(megabytes * 1e6))
    holes = []
    shown = [SceneData(scene, album, references, holes, tell) for scene in scenes]
    seeds = range(max((len(cell.seeds()) for scene in scenes for cell in scene.cells), default=0))
    for keep in (SceneData.keep_seed, SceneData.keep_flip):  # maps after all pictures: they are left out first
        for nth in seeds:
            for scene in shown:
                keep(scene, nth)
    data = {
        "methods": sorted({cell.method for scene in scenes for cell in scene.cells}, key=rank),
        "newest": max((row.get("finished", "") for sweep in sweeps for row in sweep.rows), default=""),
        "tables": [{"folder": sweep.name, "header": sweep.header,
                    "rows": [[row[name] for name in sweep.header] for row in sweep.rows]} for sweep in sweeps],
        "scenes": [scene.data(sweeps) for scene in shown],
        "pictures": album.about,
        "errors": present(ERRORS, "errors", shown), "costs": present(COSTS, "costs", shown),
        "words": WORDS, "names": NAMES, "units": UNITS, "machines": machines(sweeps),
        "student": [student(degrees) for degrees in range(1, 101)], "left_out": album.left_out, "megabytes": megabytes,
        "megabytes_wanted": album.megabytes_wanted(),
    }
    notes = list(holes)
    if album.left_out:
        notes.append(f"{album.left_out} pictures left out to stay within {megabytes:g} MB (--megabytes {album.megabytes_wanted():g} keeps all)")
    return assembled(data, album.texts), notes


def present(columns, kind, shown):
    """The columns that a cell of some scene has."""
    return [name for name in columns if any(name in cell[kind] for scene in shown for cell in scene.cells)]


class SceneData:
    """One scene of the page: its reference's layers and its cells, as JSON."""

    def __init__(self, scene, album, references, holes, tell):
        self.scene, self.album, self.holes, self.tell = scene, album, holes, tell
        self.size, self.rest = None, None
        self.reference = self.read_reference(references) if scene.reference else None
        self.cells = [cell_data(cell) for cell in scene.cells]

    def read_reference(self, folders):
        method, _, key = self.scene.reference.partition(":")
        self.tell(f"the reference of {self.scene.title()}")
        about = {"method": method, "key": key}
        own = [pathlib.Path(sweep) / "references" for sweep in
               dict.fromkeys(cell.sweep.folder for cell in self.scene.cells)]
        path = next((folder / f"{key}.exr" for folder in (*own, *folders) if (folder / f"{key}.exr").is_file()), None)
        if path is None:
            return {**about, "hole": self.hole(f"the reference {key}.exr is in none of the folders of references "
                                               "(--references)")}
        try:
            layers, texts = pictures.read(path)
        except exr.PictureError as error:
            return {**about, "hole": self.hole(f"the reference {key}.exr: {error}")}
        if other := judged_by_another(self.scene, mean_of(layers)):
            return {**about, "hole": self.hole(f"the reference {key}.exr: {other}")}
        self.size, self.rest = layers["caustic"].shape[1:], self.album.keep(layers.pop("rest"))
        settings = [texts.get(f"causticbench.{name}", "") for name in ("method", "parameters", "spp", "seed")]
        about["settings"] = "{} {} --spp {} --seed {}".format(*settings)
        return {**about, "layers": {name: self.album.keep(values) for name, values in layers.items()}}

    def hole(self, reason):
        self.holes.append(f"{self.scene.title()}: {reason}")
        return reason

    def keep_seed(self, nth):
        """Takes up the pictures of each cell's nth seed."""
        for cell, data in zip(self.scene.cells, self.cells):
            if nth < len(cell.seeds()):
                data["pictures"].append(self.picture(cell, cell.seeds()[nth]))

    def keep_flip(self, nth):
        """Takes up the FLIP maps of each cell's nth seed, where there are some."""
        for cell, data in zip(self.scene.cells, self.cells):
            if nth < len(data["pictures"]) and row_of(cell, cell.seeds()[nth]).get("flip"):
                data["pictures"][nth]["flip"] = self.flip(row_of(cell, cell.seeds()[nth]), cell.sweep.folder)

    def flip(self, row, folder):
        """The number of a map, or the reason why there is none."""
        try:
            values = pictures.read_flip(os.path.join(folder, "trials", row["trial"], "flip.exr"), row.get("picture_hash", ""))
            if values.shape[1:] != self.size:
                raise exr.PictureError("its size is not that of the picture")
        except exr.PictureError as error:
            return {"hole": f"the FLIP map of {row['trial']}: {error}"}
        return self.album.keep(values)

    def picture(self, cell, seed):
        row = row_of(cell, seed)
        path = os.path.join(cell.sweep.folder, "trials", row["trial"], "image.exr")
        self.tell(row["trial"])
        found = {"seed": seed, "trial": row["trial"], "hash": row.get("picture_hash", "")}
        try:
            layers, texts = pictures.read(path)
            require_own(texts, row, cell.parameters)
            size = layers["caustic"].shape[1:]
            if self.size is not None and size != self.size:
                raise exr.PictureError(f"{size[1]} x {size[0]} pixels beside others of {self.size[1]} x {self.size[0]}")
        except exr.PictureError as error:
            return {**found, "hole": self.hole(f"the picture of {row['trial']}: {error}")}
        self.size = size
        if self.rest is None:
            self.rest = self.album.keep(layers["rest"])
        if command := texts.get("causticbench.command"):
            options = [word for name in ("threads", "isa") if row.get(name) for word in (f"--{name}", row[name])]
            found["command"] = one_command(command, *options, "-o", f"{row['trial']}.exr")
        kept = self.album.keep(layers["caustic"])
        others = [name for name in ("unreached", "indirect") if name in layers]
        if isinstance(kept, dict):
            for name in others:
                self.album.leave_out(layers[name])
            return {**found, **kept}
        return {**found, "caustic": kept, **{name: self.album.keep(layers[name]) for name in others}}

    def data(self, sweeps):
        cells = self.scene.cells
        tied = best_of(self.scene.scored())
        for cell, data in zip(cells, self.cells):
            data["rows"] = [[sweeps.index(cell.sweep), cell.sweep.place[row["trial"]]] for row in cell.rows]
            data["tied"] = cell in tied
        return {
            "name": self.scene.name, "title": self.scene.title(), "seeds": self.scene.seeds(), "seeds_text": seeds_text(cells),
            "height": self.size[0] if self.size else 0, "width": self.size[1] if self.size else 0,
            "reference": self.reference, "rest": self.rest, "cells": self.cells,
            "contests": [{"seconds": seconds, "seeds": min(len(cell.seeds()) for cell in picks.values()),
                          "seeds_text": seeds_text(picks.values()), "picks": {method: cells.index(cell) for method, cell in picks.items()},
                          "best": [cells.index(cell) for cell in best]}
                         for seconds, picks, best in self.scene.contests()],
            "contest": self.scene.usual_contest(),
            "missed": [f"{cell.label}: {text}" for cell in cells if (text := missed_text(cell.rows))],
            "not_done": [{"trial": row["trial"], "status": row["status"], "method": row["method"],
                          "message": row.get("message", "")}
                         for sweep in {id(cell.sweep): cell.sweep for cell in cells}.values()
                         for row in sweep.left_out if row["scene"] == self.scene.name],
        }


def mean_of(layers):
    """Of a reference's caustic, over the pixels that it reaches and all channels: the records' reference_mean."""
    caustic = layers["caustic"]
    if "unreached" in layers:
        caustic = caustic[:, layers["unreached"][0] == 0]
    return float(caustic.mean(dtype=float)) if caustic.size else 0


def judged_by_another(scene, mean):
    """Whose errors are against another picture than the reference of that mean, as a reason for no maps against it; else None."""
    rows = [row for cell in scene.cells for row in cell.rows]
    others = [row for row in rows if row.get("reference_mean")
              and not math.isclose(float(row["reference_mean"]), mean, rel_tol=ROUNDING)]
    if not others:
        return None
    return (f"the errors of {len(others)} of {len(rows)} trials are against another picture, of mean "
            f"{float(others[0]['reference_mean']):.7g} where this one has {mean:.7g} (run the sweep again, which takes errors anew)")


def require_own(texts, row, parameters):
    """Raises exr.PictureError where a picture says that it is of another method, seed or parameter than its record."""
    said = {name: texts.get(f"causticbench.{name}") for name in ("method", "seed", "spp")}
    own = {name: row.get(name) for name in said}
    try:
        said |= json.loads(texts.get("causticbench.parameters", "{}"))
    except (ValueError, TypeError) as error:
        raise exr.PictureError("its parameters are no JSON object") from error
    # A key of the scene may be swept by the name of a parameter (the mesh_resolution of a pool's water).
    of_scene = values_set(texts.get("causticbench.command", ""))
    own |= {name: value for name, value in parameters.items()
            if name in said and not any(same(value, given) for given in of_scene)}
    for name, value in own.items():
        theirs = said[name] if isinstance(said[name], str) or said[name] is None else json.dumps(said[name])
        if value and theirs and not same(value, theirs):
            raise exr.PictureError(f"it is another trial's, of {name} {theirs} in place of {value}")


def values_set(command):
    """What the picture's command sets of the scene, each value as text."""
    try:
        words = shlex.split(command)
    except ValueError:  # an open quote
        return []
    return [given.partition("=")[2] for word, given in zip(words, words[1:]) if word == "--set"]


def row_of(cell, seed):
    """The first of the cell's records of a seed."""
    return next(row for row in cell.rows if row["seed"] == seed)


def cell_data(cell):
    errors = {name: cell.error(name) for name in ERRORS if cell.error(name)}
    costs = {name: cell.cost(name) for name in COSTS if cell.cost(name) is not None}
    return {"method": cell.method, "label": cell.label, "line": list(cell.line), "parameters": cell.parameters,
            "work_parameter": cell.work_parameter, "seeds": cell.seeds(), "errors": errors, "costs": costs,
            "references_error": reference_error(cell.rows), "pictures": []}


def one_command(command, *words):
    """The command with further words, each one word for a shell: a picture may come from anywhere, so that nothing
    but this program is offered to be run, and no file but the picture is written."""
    try:
        given = shlex.split(command)
    except ValueError as error:  # an open quote
        return f"# the picture's command is broken ({error})"
    if given[:1] != ["causticbench"] or any(word.startswith(("-o", "--output", "save=")) for word in given):
        return "# the picture's command does more than render it"
    return shlex.join([*given, *words])


def reference_error(rows):
    """The standard error of a pixel of the reference [W m⁻² sr⁻¹], or None."""
    row = rows[0]
    return (float(row["reference_stderr"]) * float(row["reference_mean"])
            if row.get("reference_stderr") and row.get("reference_mean") else None)


def machines(sweeps):
    """One line for each sweep: where, when and with what it was measured."""
    lines = []
    for sweep in sweeps:
        done = [row for row in sweep.rows if row["status"] == "done"]
        several = lambda name: ", ".join(dict.fromkeys(row[name] for row in done if row.get(name)))
        loads = sorted(float(row["load_average"]) for row in done if row.get("load_average"))
        words = [several("cpu") or "machine not recorded", f"{several('threads')} threads a trial", several("isa"),
                 f"causticbench {several('code_version')}",
                 f"load average {loads[0]:.1f} to {loads[-1]:.1f}" if loads else "",
                 ", ".join(dict.fromkeys(row["finished"][:10] for row in done if row.get("finished")))]
        lines.append("; ".join(word for word in words if word))
    return lines


def assembled(data, texts):
    """The one file; a `<` in JSON could end its element."""
    text = json.dumps(data, ensure_ascii=False, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    blobs = "\n".join(f'<script type="text/plain" id="p{i}">{blob}</script>' for i, blob in enumerate(texts))
    read = lambda name: (HERE / name).read_text(encoding="utf-8")
    script = "\n".join(read(f"{name}.js") for name in SCRIPTS)
    parts = {"STYLE": read("style.css"), "DATA": f'<script type="application/json" id="data">{text}</script>',
             "SCRIPT": script, "PICTURES": blobs}
    page = read("template.html")
    for name, part in parts.items():
        page = page.replace(f"<!-- {name} -->", part)
    return page

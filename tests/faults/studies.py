"""Small pieces of work for the program, and what must hold of the folders they leave whatever happens meanwhile."""
import csv
import hashlib
import json
import pathlib
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "runner"))
from lab import is_of_a_run  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENE = json.loads((ROOT / "tests/experiments/scenes/ball.json").read_text())
OF_A_MACHINE = ("cpu",)  # empty where /proc cannot be read
LEFT_BY_KILLED = (".tmp-", ".old-", ".part")


def digest(file):
    return hashlib.sha256(file.read_bytes()).hexdigest()


def write_inputs(folder, seeds=(1, 2)):
    """A scene of 4 x 4 pixels, and a sweep of it with a reference: a trial a seed."""
    folder.mkdir(parents=True, exist_ok=True)
    scene = json.loads(json.dumps(SCENE))
    scene["sensor"]["film"].update(width=4, height=4)
    (folder / "scene.json").write_text(json.dumps(scene))
    sweep = {"version": 1, "scenes": ["scene.json"], "spp": 1, "seeds": list(seeds),
             "methods": [{"method": "photonmap", "param": {"photons": 20}}],
             "reference": {"method": "lighttrace", "param": {"paths": 500}, "spp": 1}}
    (folder / "sweep.json").write_text(json.dumps(sweep))


def rows(folder):
    with open(folder / "records.csv", newline="", encoding="utf-8") as file:
        return {row["trial"]: row for row in csv.DictReader(file, strict=True)}


def trials(folder):
    return [path for path in folder.glob("trials/*") if not path.name.startswith(LEFT_BY_KILLED)]


def records(folder):
    """{trial: bytes of its record} of those that are done."""
    found = {}
    for trial in trials(folder):
        record = trial / "record.json"
        if record.exists() and json.loads(record.read_text())["status"] == "done":
            found[trial.name] = record.read_bytes()
    return found


def has_failures(folder):
    return any(json.loads((trial / "record.json").read_text())["status"] != "done" for trial in trials(folder)
               if (trial / "record.json").exists())


def sweep_results(folder):
    """All that a sweep's folder says, without what differs from run to run. A cell's figure is that of its first trial
    that is done, so those of others may be there as well."""
    told = {trial: {name: text for name, text in row.items() if not is_of_a_run(name) and name not in OF_A_MACHINE}
            for trial, row in rows(folder).items()}
    pictures = {str(file.relative_to(folder)): digest(file)
                for pattern in ("trials/[!.]*/image.exr", "references/*") for file in folder.glob(pattern)}
    figure = f"report/figures/{min(told, default='')}.png"
    if (folder / figure).exists():
        pictures[figure] = digest(folder / figure)
    return {"rows": told, "pictures": pictures}


def without_derived(results):
    """Without what is made of pictures, and may be made again."""
    return {**results, **({"rows": {trial: {**row, "variance": ""} for trial, row in results["rows"].items()}}
                          if "rows" in results else {}),
            **({"pictures": {name: picture for name, picture in results["pictures"].items() if "figures/" not in name}}
               if "pictures" in results else {}), **({"report.html": ""} if "report.html" in results else {})}


def leftovers(folder):
    return [str(path) for path in folder.rglob("*") if any(mark in path.name for mark in LEFT_BY_KILLED)]


def half_written(folder, whole):
    """What is wrong with the files of a sweep's folder that have their final names; `whole`: sweep_results()."""
    wrong = []
    for trial in trials(folder):
        try:
            record = json.loads((trial / "record.json").read_text())
            if record["trial"] != trial.name:
                wrong.append(f"{trial.name}: another's record")
            picture = f"trials/{trial.name}/image.exr"
            if record["status"] == "done" and digest(folder / picture) != whole["pictures"][picture]:
                wrong.append(f"{trial.name}: another picture")
        except (OSError, ValueError, KeyError) as error:
            wrong.append(f"{trial.name}: {error!r}")
    for name, picture in whole["pictures"].items():
        if not name.startswith("trials/") and (folder / name).exists() and digest(folder / name) != picture:
            wrong.append(f"{name}: differs")
    for name in ("plan.json", "environment.json"):
        wrong += not_json(folder / name)
    if (folder / "records.csv").exists():
        with open(folder / "records.csv", newline="", encoding="utf-8") as file:
            if any(None in row or None in row.values() for row in csv.DictReader(file, strict=True)):
                wrong.append("records.csv: a row of another length")
    return wrong


def not_json(file):
    try:
        if file.exists():
            json.loads(file.read_text())
    except ValueError as error:
        return [f"{file.name}: {error!r}"]
    return []


class Study:
    """One command, begun in a copy of a folder that is prepared once."""
    name = ""
    arguments = ()
    output = "out"       # what the command makes
    goes_on = True       # the same command completes what was begun

    def prepare(self, server, folder):
        write_inputs(folder)

    def results(self, folder):
        return sweep_results(folder / self.output)

    def wrong(self, folder, whole):
        """What is half-written."""
        out = folder / self.output
        return half_written(out, whole) if out.exists() else []

    def kept(self, folder):
        """What must not be lost."""
        return records(folder / self.output)

    def again(self, folder):
        """The command without faults."""
        return self.arguments

    def is_whole(self, folder, whole):
        """Whether all of it is there."""
        return False

    def discard(self, folder):
        """Makes room for the same command, where it refuses to replace."""


class Sweep(Study):
    name = "sweep"
    arguments = ("sweep", "sweep.json", "-o", "out")

    def again(self, folder):
        failed = has_failures(folder / "out") if (folder / "out").exists() else False
        return (*self.arguments, "--rerun", "failed") if failed else self.arguments


class Resumed(Sweep):
    """With a trial done, one half-written and one about to be replaced."""
    name = "sweep, resumed"

    def prepare(self, server, folder):
        write_inputs(folder, seeds=(1, 2, 3))
        server.run(folder, *self.arguments)
        out = folder / "out/trials"
        first, second, third = sorted(path.name for path in out.iterdir())
        (out / first / "record.json").unlink()
        (out / first).rename(out / f".tmp-{first}")
        (out / second).rename(out / f".old-{second}")


class Forced(Sweep):
    name = "sweep --force"
    arguments = ("sweep", "sweep.json", "-o", "out", "--force")

    def prepare(self, server, folder):
        write_inputs(folder)
        server.run(folder, *Sweep.arguments)

    def kept(self, folder):
        return {}  # either of the two is whole: see half_written()

    def again(self, folder):
        return self.arguments


class Merge(Study):
    name = "merge"
    arguments = ("merge", "1", "2", "-o", "all")
    output = "all"

    def prepare(self, server, folder):
        write_inputs(folder)
        for shard in "12":
            server.run(folder, "sweep", "sweep.json", "-o", shard, "--shard", f"{shard}/2")

    def wrong(self, folder, whole):
        if not (folder / "all").exists():
            return []
        return [] if self.results(folder) == whole else ["all: is there, but not whole"]

    def kept(self, folder):
        return {**records(folder / "1"), **records(folder / "2")}

    def is_whole(self, folder, whole):
        return (folder / "all").exists() and self.results(folder) == whole

    def discard(self, folder):
        shutil.rmtree(folder / "all", ignore_errors=True)


class Files(Study):
    """Makes files, each whole or absent."""
    files = ()

    def results(self, folder):
        return {name: digest(folder / name) for name in self.files}

    def wrong(self, folder, whole):
        return [f"{name}: differs" for name in self.files
                if (folder / name).exists() and digest(folder / name) != whole[name]]

    def kept(self, folder):
        return {}


class Render(Files):
    name = "render"
    arguments = ("render", "scene.json", "--method", "photonmap", "--param", "photons=50", "--spp", "1", "--threads", "1",
                 "-o", "a.exr", "-o", "a.png")
    files = ("a.exr", "a.png")


class SavePhotons(Files):
    name = "photon map saved"
    arguments = (*Render.arguments[:6], "--param", "save=a.photons", "--spp", "1", "--threads", "1", "-o", "a.exr")
    files = ("a.photons", "a.exr")


class LoadPhotons(Files):
    name = "photon map loaded"
    arguments = ("render", "scene.json", "--method", "photonmap", "--param", "load=a.photons", "--spp", "1", "--threads",
                 "1", "-o", "b.exr")
    files = ("b.exr",)

    def prepare(self, server, folder):
        write_inputs(folder)
        server.run(folder, *SavePhotons.arguments)

    def kept(self, folder):
        return {"a.photons": (folder / "a.photons").read_bytes()}


class Reference(Sweep):
    """Only the reference, which all trials will be judged by."""
    name = "reference cached"
    arguments = (*Sweep.arguments, "--references", "only")

    def results(self, folder):
        return {"pictures": {f"references/{file.name}": digest(file) for file in (folder / "out/references").glob("*.exr")}}


class Report(Files):
    name = "report"
    arguments = ("report", "out", "-o", "report.html", "--tables", "tables")

    def prepare(self, server, folder):
        write_inputs(folder)
        server.run(folder, *Sweep.arguments)
        server.run(folder, *self.arguments)
        self.files = ("report.html", *(f"tables/{file.name}" for file in (folder / "tables").iterdir()))
        (folder / "report.html").unlink()
        shutil.rmtree(folder / "tables")

    def kept(self, folder):
        return records(folder / "out")


STUDIES = (Sweep(), Resumed(), Forced(), Merge(), Render(), SavePhotons(), LoadPhotons(), Reference(), Report())

"""A scene of the repository as a contest sets it: an entry of its file of scenes, with `file`, `size` and `set` (JSON pointers)."""
import dataclasses
import json

from report.program import ROOT


@dataclasses.dataclass(frozen=True)
class SetScene:
    text: dict

    def __getattr__(self, name):
        try:
            return self.text[name]
        except KeyError:
            raise AttributeError(name) from None

    def all_set(self):
        """{JSON pointer: value} with the film's size."""
        width, height = self.size
        return {"/sensor/film/width": width, "/sensor/film/height": height, **self.set}

    def resolved(self):
        """The scene's file with its settings and what it includes, as JSON."""
        scene = load(ROOT / self.file)
        for pointer, value in self.all_set().items():
            place = scene
            *way, last = pointer.strip("/").split("/")
            for step in way:
                place = place[int(step) if isinstance(place, list) else step]
            place[int(last) if isinstance(place, list) else last] = value
        return scene


def load(path):
    """A scene's JSON with its {"$include": FILE} put in."""
    return included(json.loads(path.read_text(encoding="utf-8")), path.parent)


def included(value, folder):
    if isinstance(value, dict):
        if "$include" in value:
            return load(folder / value["$include"])
        return {key: included(each, folder) for key, each in value.items()}
    return [included(each, folder) for each in value] if isinstance(value, list) else value

"""Draws disjoint sites from files by a seed, and drops those that clang says cannot be compiled."""
import json
import pathlib
import random
import shlex
from concurrent.futures import ProcessPoolExecutor

from clang.cindex import Diagnostic, Index, TranslationUnit

from mutation import schemata
from mutation.sites import Finder

OPTIONS = TranslationUnit.PARSE_DETAILED_PROCESSING_RECORD


class Parser:
    """Parses files of the sources with the compiler's options in the tree's compile_commands.json."""

    def __init__(self, root, tree, build):
        self.root = root
        commands = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
        self.options = {}
        for entry in commands:
            name = str(pathlib.Path(entry["file"]))
            if name.startswith(f"{tree}/"):
                self.options[name[len(str(tree)) + 1:]] = self.of_command(entry["command"], tree)

    def of_command(self, command, tree):
        words = iter(shlex.split(command)[1:])
        kept = ["-x", "c++", "-Werror=vla", "-ferror-limit=0", f"-I{self.root}"]
        for word in words:
            if word == "-isystem":
                kept += [word, next(words)]
            elif word.startswith(("-D", "-std", "-m")) or (word.startswith("-I") and word != f"-I{tree}"):
                kept.append(word)
        return kept

    def unit_of(self, name):
        """The source that is compiled to see a file: itself, or one that includes the header."""
        if name in self.options:
            return name
        wanted, seen = [name], set()
        while wanted:
            header = wanted.pop(0)
            users = [file for file in sorted(self.root.rglob("*.*")) if file.suffix in (".h", ".cpp")
                     and "build" not in file.parts and f'#include "{header}"' in file.read_text(encoding="utf-8")]
            for user in (str(file.relative_to(self.root)) for file in users):
                if user in self.options and not user.startswith("tests/"):
                    return user
                if user not in seen:
                    seen.add(user)
                    wanted.append(user)
        raise ValueError(f"{name}: no source includes it")

    def parse(self, name, unsaved=()):
        unit = self.unit_of(name)
        return Index.create().parse(str(self.root / unit), self.options[unit], list(unsaved), OPTIONS)

    def places(self, name):
        """Lists of sites, a list a place: the ways to mutate one expression by one operator."""
        unit = self.parse(name)
        broken = [d for d in unit.diagnostics if d.severity >= Diagnostic.Error]
        if broken:
            raise ValueError(f"{name}: {broken[0]}")
        ways = {}
        for site in Finder(unit, self.root / name, name).sites:
            ways.setdefault((site.start, site.end, site.operator), []).append(site)
        return [ways[key] for key in sorted(ways)]

    def compiling(self, name, sites):
        """The sites of a file that are left when those in lines with errors are taken away, again and again."""
        path = str(self.root / name)
        header = (str(self.root / "mutant.h"), schemata.HEADER)
        text = (self.root / name).read_bytes()
        while sites:
            unit = self.parse(name, [(path, rewritten(text, sites).decode()), header])
            errors = [d for d in unit.diagnostics if d.severity >= Diagnostic.Error]
            if not errors:
                break
            left = without_lines(sites, lines_of(errors, path))
            if len(left) == len(sites):
                raise ValueError(f"{name}: {errors[0]}")
            sites = left
        return sites


def draw(parser, names, seed, count, jobs=1):
    """`count` disjoint sites that compile, numbered in the order of drawing (fewer where there are no more), and the
    number of places there are."""
    with ProcessPoolExecutor(jobs) as pool:
        places = [place for found in pool.map(parser.places, names) for place in found]
        chosen = disjoint(places, seed, count + count // 5)
        of_file = {name: [site for site in chosen if site.file == name] for name in names}
        kept = pool.map(parser.compiling, names, of_file.values())
    good = {site.number for sites in kept for site in sites}
    drawn = [site for site in chosen if site.number in good][:count]
    for number, site in enumerate(drawn):
        site.number = number
    return drawn, len(places)


def disjoint(places, seed, count):
    """Sites in random order, one a place, none within another; numbered."""
    dice = random.Random(seed)
    dice.shuffle(places)
    chosen = []
    for place in places:
        site = dice.choice(place)
        if not any(site.meets(other) for other in chosen):
            site.number = len(chosen)
            chosen.append(site)
            if len(chosen) == count:
                break
    return chosen


def lines_of(errors, path):
    """The lines of a rewritten file, as the sources count them, that errors and their notes name."""
    places = [d.location for error in errors for d in (error, *error.children)]
    return {place.line - schemata.PRELUDE.count("\n") for place in places if place.file and place.file.name == path}


def without_lines(sites, lines):
    return [site for site in sites if not lines & set(range(site.line, site.line + site.code.count("\n") + 1))]


def rewritten(text, sites):
    """A file's bytes with every site of it made a schema; its lines keep their numbers."""
    for site in sorted(sites, key=lambda site: -site.start):
        text = text[:site.start] + site.code.replace("@N@", str(site.number)).encode() + text[site.end:]
    return schemata.PRELUDE.encode() + text

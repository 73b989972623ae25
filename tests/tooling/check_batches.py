#!/usr/bin/python3
"""Fails where two sources of one library give their own functions one name.

Sources are compiled eight at a time (CAUSTICS_BATCHES), so that the unnamed namespaces of a batch are one. Two functions of one name
and other parameters are then overloads: a call may go to the neighbour's, without a word. So each name is had once in a library;
declared in a header it may be overloaded. Sources of one instruction set are compiled by themselves and may share names.

Usage: check_batches.py [ROOT]     check the tree at ROOT (default: this one's)
       check_batches.py --self-test
"""
import pathlib
import re
import sys
import tempfile

LIBRARIES = ("core", "photonmap", "beamtree", "experiments")
ALONE = re.compile(r"_(plain|avx2|avx512)\.cpp$")
FUNCTION = re.compile(r"^(?:\[\[\w+\]\] |static |inline |constexpr )*[A-Za-z_][\w:<>,&*\s]*?[\s&*](\w+)\(")
DECLARED = re.compile(r"[\s&*](\w+)\(")
OPENED = re.compile(r"(?:inline )?namespace(?: ([\w:]+))? \{")


def own_functions(text):
    """Names of functions that begin a line within an unnamed namespace, or are static."""
    opened, names = [], set()
    for line in text.splitlines():
        if match := OPENED.match(line):
            opened.append(match[1])
        elif line.startswith("}  // namespace"):
            opened.pop()
        elif (None in opened or line.startswith("static ")) and (match := FUNCTION.match(line)):
            names.add(match[1])
    return names


def shared(root):
    """A line for each name that two sources of a library have."""
    for library in LIBRARIES:
        read = lambda suffix: {file: file.read_text(encoding="utf-8") for file in sorted((root / library).rglob(f"*{suffix}"))}
        declared = {name for text in read(".h").values() for line in text.splitlines() if not line.lstrip().startswith("//")
                    for name in DECLARED.findall(line)}
        first = {}
        for file, text in read(".cpp").items():
            if ALONE.search(file.name):
                continue
            for name in sorted(own_functions(text) - declared):
                other = first.setdefault(name, file)
                if other != file:
                    yield f"{file.relative_to(root)}: {name}() is a function of {other.relative_to(root)}, too: give one of them another name"


def self_test():
    with tempfile.TemporaryDirectory() as scratch:
        root = pathlib.Path(scratch)
        sources = {"a.cpp": "int three(float x) {", "b.cpp": "template <class V>\nstd::string three(const V& v) {", "c.cpp": "double known(int i) {",
                   "d.cpp": "double known(float x) {", "e_avx2.cpp": "int three(int i) {"}
        (root / "core").mkdir()
        (root / "core/known.h").write_text("double known(double x);\n", encoding="utf-8")
        for name, line in sources.items():
            (root / "core" / name).write_text(f"namespace caustics {{\nnamespace {{\n{line}\n}}\n}}  // namespace\n"
                                              "int open(int x) {\n}\n}  // namespace caustics\n", encoding="utf-8")
        found = list(shared(root))
    right = [line.split(":")[0] for line in found] == ["core/b.cpp"]
    print(f"self-test: {'the planted pair was found' if right else f'found {found}'}")
    return 0 if right else 1


def main(arguments):
    if arguments == ["--self-test"]:
        return self_test()
    root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).resolve().parents[2])
    found = list(shared(root))
    print("\n".join(found) if found else "each function of a source's own has a name of its own in its library")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

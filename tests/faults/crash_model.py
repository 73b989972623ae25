"""What a disk may hold after a crash: every change that was not brought to it by fsync may be missing, or cut short.

The model is that of ALICE (Pillai et al., OSDI 2014, section 3), at its strictest: a file's content is brought to the disk
by fsync of the file, and a name by fsync of the folder it is in; a rename happens whole or not at all; nothing else is sure.
States are those after each change of a trace, with at most two of the changes that are not yet sure left out or torn.
"""
import hashlib
import itertools
import os
import pathlib

# Of a write that is not sure: not there; its first half; zeros of its length; its first half, then zeros.
TORN = ("missing", "half", "zeros", "half zeros")


class Node:
    """A file or a folder, whatever it is named."""

    def __init__(self, is_folder, start=b""):
        self.is_folder, self.start, self.changes = is_folder, start, []


class Change:
    """`names`: [(folder, name, node or None)], or the content of `node` from `offset` on; of a truncation no `data`."""

    def __init__(self, what, names=(), node=None, offset=0, data=None):
        self.what, self.names, self.node, self.offset, self.data = what, names, node, offset, data
        self.sure_after = None  # number of changes

    def variants(self):
        return TORN if self.data else TORN[:1]

    def touches(self, node):
        return self.node is node or any(folder is node for folder, _, _ in self.names)


class Trace:
    """The changes below a folder, from a folder as it was before and the file that call_faults wrote."""

    def __init__(self, folder, before):
        """`before`: of snapshot()."""
        self.root, self.names, self.numbers = folder, {}, {}
        self.changes = []
        self.first = {}
        self.contents = {}   # digest -> bytes
        self.known = {}      # what content() has answered
        self.top = self.add("", Node(True), before[""][0])
        for name, (number, content) in sorted(before.items()):
            if name:
                node = self.add(name, Node(content is None, content or b""), number)
                self.first[(self.names[os.path.dirname(name)], os.path.basename(name))] = node

    def add(self, name, node, number):
        self.names[name] = self.numbers[number] = node
        return node

    def read(self, file):
        for line in pathlib.Path(file).read_text().splitlines():
            what, number, names, data = line.split("\t") if line.count("\t") == 3 else self.renamed(line)
            getattr(self, f"read_{what}")(int(number), names, bytes.fromhex(data))
        self.settle()
        return self

    @staticmethod
    def renamed(line):
        what, number, first, second, data = line.split("\t")
        return what, number, (first, second), data

    def place(self, path):
        """The folder and the name in it."""
        name = os.path.relpath(path, self.root)
        name = "" if name == "." else name
        return self.names[os.path.dirname(name)], os.path.basename(name), name

    def name(self, what, path, node):
        folder, last, name = self.place(path)
        self.changes.append(Change(what, [(folder, last, node)]))
        if node is None:
            del self.names[name]
        else:
            self.names[name] = node

    def read_create(self, number, path, _):
        self.numbers[number] = Node(False)
        self.name("create", path, self.numbers[number])

    def read_mkdir(self, number, path, _):
        self.numbers[number] = Node(True)
        self.name("mkdir", path, self.numbers[number])

    def read_nameless(self, number, *_):
        self.numbers[number] = Node(False)

    def read_link(self, number, path, _):
        self.name("link", path, self.numbers[number])

    def read_unlink(self, _, path, __):
        self.name("unlink", path, None)

    read_rmdir = read_unlink

    def read_rename(self, _, paths, __):
        (source, old, was), (target, new, becomes) = (self.place(path) for path in paths)
        node = self.names[was]
        self.changes.append(Change("rename", [(source, old, None), (target, new, node)]))
        for name in [name for name in self.names if name == was or name.startswith(was + "/")]:
            self.names[becomes + name[len(was):]] = self.names.pop(name)

    def read_write(self, number, offset, data):
        self.changes.append(Change("write", node=self.numbers[number], offset=int(offset), data=data))

    def read_truncate(self, number, size, _):
        self.changes.append(Change("truncate", node=self.numbers[number], offset=int(size)))

    def read_sync(self, number, *_):
        node = self.numbers[number]
        for change in self.changes:
            if change.sure_after is None and change.touches(node):
                change.sure_after = len(self.changes)
        self.changes.append(Change("sync", node=node))

    def settle(self):
        for number, change in enumerate(self.changes):
            if change.node is not None and change.what != "sync":
                change.node.changes.append(number)

    def unsure(self, after):
        """Numbers of the changes that may be missing when `after` of them have been made."""
        return [number for number, change in enumerate(self.changes[:after]) if change.what != "sync"
                and (change.sure_after is None or change.sure_after >= after)]

    def states(self, generator, most_pairs):
        """(changes made, {number: variant}): all with one left out, and of those with two at most so many an instant."""
        for after in range(len(self.changes) + 1):
            yield after, {}
            single = [(number, variant) for number in self.unsure(after) for variant in self.changes[number].variants()]
            for number, variant in single:
                yield after, {number: variant}
            pairs = [pair for pair in itertools.combinations(single, 2) if pair[0][0] != pair[1][0]]
            for pair in pairs if len(pairs) <= most_pairs else generator.sample(pairs, most_pairs):
                yield after, dict(pair)

    def tree(self, after, left_out):
        """{name: digest of its content, or None of a folder}."""
        entries = {}
        for (folder, name), node in self.first.items():
            entries.setdefault(folder, {})[name] = node
        for number, change in enumerate(self.changes[:after]):
            if number in left_out:
                continue
            for folder, name, node in change.names:
                if node is None:
                    entries.get(folder, {}).pop(name, None)
                else:
                    entries.setdefault(folder, {})[name] = node
        found = {}
        self.collect(self.top, "", entries, found, after, left_out)
        return found

    def collect(self, folder, above, entries, found, after, left_out):
        for name, node in entries.get(folder, {}).items():
            found[above + name] = None if node.is_folder else self.content(node, after, left_out)
            if node.is_folder and above.count("/") < 8:
                self.collect(node, f"{above}{name}/", entries, found, after, left_out)

    def content(self, node, after, left_out):
        made = tuple((number, left_out.get(number)) for number in node.changes if number < after)
        key = (id(node), made)
        if key not in self.known:
            content = bytearray(node.start)
            for number, variant in made:
                apply(content, self.changes[number], variant)
            self.known[key] = hashlib.sha256(content).digest()
            self.contents[self.known[key]] = bytes(content)
        return self.known[key]


def apply(content, change, variant):
    if variant == "missing":
        return
    size = change.offset
    if change.data is None:
        content[size:] = bytes(max(0, size - len(content)))
        return
    data = change.data
    kept = {"half": len(data) // 2, "zeros": 0, "half zeros": len(data) // 2}.get(variant, len(data))
    data = data[:kept] + (bytes(len(data) - kept) if variant in ("zeros", "half zeros") else b"")
    if len(content) < size:
        content.extend(bytes(size - len(content)))
    content[size:size + len(data)] = data


def snapshot(folder):
    """{name: (number of the file, content, or None of a folder)} of all below a folder, which is ""."""
    found = {"": (os.stat(folder).st_ino, None)}
    for path in pathlib.Path(folder).rglob("*"):
        found[str(path.relative_to(folder))] = (path.stat().st_ino, None if path.is_dir() else path.read_bytes())
    return found


def digest_of(tree):
    """The same for the same names and contents."""
    total = hashlib.sha256()
    for name in sorted(tree):
        total.update(name.encode() + b"\0" + (tree[name] or b"folder"))
    return total.digest()

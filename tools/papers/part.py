"""What one part of a paper's reproduction hands to the page."""
import dataclasses


@dataclasses.dataclass
class Table:
    """`rows` of texts below `heading`; `name` is its file's, `note` stands below it."""
    name: str
    title: str
    heading: list
    rows: list
    note: str = ""
    section: str = ""


@dataclasses.dataclass
class Figure:
    """A picture as PNG and, where it shows radiance, as EXR (bytes)."""
    name: str
    title: str
    caption: str
    png: bytes
    exr: bytes = b""
    section: str = ""


@dataclasses.dataclass
class Part:
    """`measured`: claim id -> Measured; `facts`: words for the texts of PAPER.json in braces."""
    measured: dict = dataclasses.field(default_factory=dict)
    tables: list = dataclasses.field(default_factory=list)
    figures: list = dataclasses.field(default_factory=list)
    facts: dict = dataclasses.field(default_factory=dict)

    def of(self, section):
        """The same, each piece with the section's name: what is made anew with it."""
        for each in (*self.measured.values(), *self.tables, *self.figures):
            each.section = section
        return self

    def add(self, other):
        self.measured.update(other.measured)
        self.tables += other.tables
        self.figures += other.figures
        self.facts.update(other.facts)
        return self

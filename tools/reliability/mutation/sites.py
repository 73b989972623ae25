"""The places of a C++ file that can be mutated, found in clang's syntax tree (Debian: python3-clang-14).

A site is one expression by its exact extent, what it becomes, and the schema that is both: an expression that asks at
run time whether this mutant is on.
"""
import re
from dataclasses import dataclass

from clang.cindex import CursorKind as K
from clang.cindex import TypeKind

from mutation import schemata

LOOPS = (K.FOR_STMT, K.WHILE_STMT, K.DO_STMT, K.CXX_FOR_RANGE_STMT)
# Nothing below these is evaluated at run time, or not where it stands.
CLOSED = {K.STATIC_ASSERT, K.ENUM_DECL, K.PARM_DECL, K.TEMPLATE_NON_TYPE_PARAMETER, K.TYPE_ALIAS_DECL,
          K.TYPEDEF_DECL, K.CXX_UNARY_EXPR}
FUNCTIONS = {K.FUNCTION_DECL, K.CXX_METHOD, K.CONSTRUCTOR, K.DESTRUCTOR, K.CONVERSION_FUNCTION, K.FUNCTION_TEMPLATE}


@dataclass
class Site:
    """One mutant: bytes [start, end) of a file, `before` and `after` in words of C++, `code` with `@N@` for its number."""
    file: str
    line: int
    start: int
    end: int
    operator: str
    before: str
    after: str
    code: str
    number: int = -1

    def meets(self, other):
        return self.file == other.file and self.start < other.end and other.start < self.end


class Finder:
    """All sites of one file of a translation unit, one for each way to mutate an expression."""

    def __init__(self, unit, path, name):
        self.name = name
        self.text = path.read_bytes()
        self.path = str(path)
        self.sites = []
        self.macros = [extent_of(cursor) for cursor in unit.cursor.get_children()
                       if cursor.kind == K.MACRO_INSTANTIATION and self.is_here(cursor)]
        for cursor in unit.cursor.get_children():
            if cursor.kind.is_declaration() and self.is_here(cursor):
                self.visit(cursor, None)

    def is_here(self, cursor):
        file = cursor.location.file
        return file is not None and file.name == self.path

    def source(self, cursor):
        start, end = extent_of(cursor)
        return self.text[start:end].decode()

    def before(self, offset):
        """The last character in front of an offset that is not white space."""
        return self.text[:offset].rstrip()[-1:].decode(errors="replace")

    def after(self, offset):
        return self.text[offset:offset + 200].lstrip()[:1].decode(errors="replace")

    def visit(self, cursor, parent):
        if cursor.kind in CLOSED or is_constant(self, cursor):
            return
        children = list(cursor.get_children())
        if cursor.kind == K.CASE_STMT:
            children = children[1:]
        self.mutate(cursor, children, parent)
        for child in children:
            if cursor.kind == K.IF_STMT and child is children[0] and self.is_constexpr_if(cursor):
                continue
            self.visit(child, cursor)

    def is_constexpr_if(self, cursor):
        return self.source(cursor)[:20].startswith("if constexpr")

    def mutate(self, cursor, children, parent):
        """Adds every mutant of one expression or statement."""
        if cursor.kind == K.COMPOUND_STMT:
            self.delete_statements(cursor, children, parent)
        elif cursor.kind in (K.IF_STMT, K.WHILE_STMT, K.CONDITIONAL_OPERATOR):
            self.negate_condition(cursor, children)
            if cursor.kind != K.CONDITIONAL_OPERATOR:
                self.delete_statements(cursor, children[1:], parent)
        elif cursor.kind in LOOPS:
            self.delete_statements(cursor, children[-1:], parent)
        elif cursor.kind in (K.INTEGER_LITERAL, K.FLOATING_LITERAL, K.CXX_BOOL_LITERAL_EXPR):
            self.change_constant(cursor)
        elif cursor.kind in (K.BINARY_OPERATOR, K.COMPOUND_ASSIGNMENT_OPERATOR) and len(children) == 2:
            self.replace_operator(cursor, *children)
        elif cursor.kind == K.UNARY_OPERATOR and len(children) == 1:
            self.drop_sign(cursor, children[0])
        elif cursor.kind == K.CALL_EXPR:
            self.change_call(cursor)

    def change_call(self, cursor):
        operands = list(cursor.get_arguments())
        if cursor.spelling.startswith("operator"):
            if len(operands) == 2:
                self.replace_operator(cursor, *operands)
            elif len(operands) == 1:
                self.drop_sign(cursor, operands[0])
        elif cursor.spelling in schemata.TWINS:
            self.swap_twin(cursor)

    def add(self, cursor, operator, after, code):
        """A site over the extent of the cursor, unless a macro or a comment is in the way."""
        start, end = extent_of(cursor)
        before = self.text[start:end].decode()
        if cursor.extent.start.file is None or cursor.extent.start.file.name != self.path or end <= start:
            return
        if any(start < last and first < end for first, last in self.macros):
            return
        if "//" in before or "/*" in before or "#" in before:
            return
        self.sites.append(Site(self.name, cursor.extent.start.line, start, end, operator,
                               one_line(before), one_line(after), code))

    def replace_operator(self, cursor, left, right):
        start, end = extent_of(left)[1], extent_of(right)[0]
        between = self.text[start:end].decode()  # with its line ends, for the numbers of lines
        operator = between.strip()
        eigen = "Eigen::" in cursor.type.get_canonical().spelling
        a, b = self.source(left), self.source(right)
        for kind, other in schemata.replacements(operator):
            if kind == "relation" and other[0] == operator[0] and is_tie_of_reals(left, right, a, b):
                continue
            mutated = f"{a} {other} {b}"
            self.add(cursor, kind, mutated,
                     schemata.either(f"({a}) {other} ({b})", f"({a}){between}({b})", eigen and kind == "arithmetic"))

    def drop_sign(self, cursor, operand):
        text, inner = self.source(cursor), self.source(operand)
        if extent_of(operand)[1] != extent_of(cursor)[1]:
            return
        if text.startswith("-") and not text.startswith("--"):
            eigen = "Eigen::" in cursor.type.get_canonical().spelling
            self.add(cursor, "sign", inner, schemata.either(f"({inner})", f"-({inner})", eigen))
        elif text.startswith("!"):
            self.add(cursor, "condition", inner, schemata.either(f"static_cast<bool>({inner})", f"!({inner})"))

    def negate_condition(self, cursor, children):
        if not children or not children[0].kind.is_expression() or self.is_constexpr_if(cursor):
            return
        condition = children[0]
        start, end = extent_of(condition)
        bracketed = self.before(start) == "(" and self.after(end) == ")"
        if bracketed or cursor.kind == K.CONDITIONAL_OPERATOR:
            text = self.source(condition)
            self.add(condition, "condition", f"!({text})", schemata.negated(text))

    def delete_statements(self, cursor, children, parent):
        for child in children:
            if not child.kind.is_expression() or self.after(extent_of(child)[1]) != ";":
                continue
            # A function that only throws at its end has nothing to go on with.
            last_throw = (self.source(child).startswith("throw") and child == children[-1]
                          and (parent is None or parent.kind in FUNCTIONS))
            if not last_throw:
                self.add(child, "deletion", "", schemata.optional(self.source(child)))

    def change_constant(self, cursor):
        start, end = extent_of(cursor)
        text = self.source(cursor)
        in_brackets = (self.before(start), self.after(end))
        if in_brackets in (("<", ">"), ("<", ","), (",", ">"), ("[", "]")) and in_brackets != ("[", "]"):
            return
        for after in schemata.constants(text):
            self.add(cursor, "constant", after, schemata.either(after, text))

    def swap_twin(self, cursor):
        text, twin = self.source(cursor), schemata.TWINS[cursor.spelling]
        mutated, count = re.subn(rf"\b{cursor.spelling}(?=\s*[(<])", twin, text)
        if count == 1:
            eigen = cursor.spelling.startswith("cwise")
            self.add(cursor, "min-max", mutated, schemata.either(mutated, text, eigen))


def extent_of(cursor):
    return cursor.extent.start.offset, cursor.extent.end.offset


def is_tie_of_reals(left, right, a, b):
    """Whether `<` and `<=` differ only where two computed reals are equal: such a mutant would tell nothing."""
    reals = (TypeKind.FLOAT, TypeKind.DOUBLE)
    return (left.type.get_canonical().kind in reals and right.type.get_canonical().kind in reals
            and not any(re.fullmatch(r"[\d.]+[fF]?", text) for text in (a, b)))


def is_constant(finder, cursor):
    """Whether a declaration is known to the compiler, so that nothing in it can ask at run time."""
    if cursor.kind == K.VAR_DECL:
        head = finder.source(cursor).split("=")[0].split("{")[0]
    elif cursor.kind in FUNCTIONS:
        head = finder.source(cursor).split("{")[0]
    else:
        return False
    return re.search(r"\b(constexpr|consteval|constinit)\b", head) is not None


def one_line(text):
    return re.sub(r"\s+", " ", text)

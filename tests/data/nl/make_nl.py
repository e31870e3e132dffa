#!/usr/bin/env python3
"""Writes the .nl files beside it: each stands for something that such a file may hold. Run it in its own folder."""

import math
import struct

OPERATORS = {
    "+": 0, "-": 1, "*": 2, "/": 3, "mod": 4, "^": 5, "less": 6, "min": 11, "max": 12, "abs": 15, "neg": 16, "or": 20, "and": 21, "<": 22,
    "<=": 23, ">=": 28, ">": 29, "not": 34, "if": 35, "tanh": 37, "tan": 38, "sqrt": 39, "sinh": 40, "sin": 41, "log10": 42, "log": 43,
    "exp": 44, "cosh": 45, "cos": 46, "atanh": 47, "atan2": 48, "atan": 49, "asinh": 50, "asin": 51, "acosh": 52, "acos": 53, "sum": 54,
}
LISTS = ("min", "max", "sum")
INF = math.inf


def v(index):
    return ("v", index)


class Text:
    """Lines: a key, numbers parted by blanks, a comment."""

    letter = "g"

    def __init__(self):
        self.bytes = b""

    def line(self, key, *numbers, comment=""):
        words = " ".join(repr(x) if isinstance(x, float) and x != int(x) else str(int(x)) if not isinstance(x, str) else x for x in numbers)
        self.bytes += (key + words + (f"\t# {comment}" if comment else "") + "\n").encode()


class Binary(Text):
    """The same after the head as bytes: floats are numbers of 8, ints of 4."""

    letter = "b"

    def line(self, key, *numbers, comment=""):
        self.bytes += key.encode()
        for x in numbers:
            if isinstance(x, str):
                self.bytes += struct.pack("<i", len(x)) + x.encode()
            else:
                self.bytes += struct.pack("<d", x) if isinstance(x, float) else struct.pack("<i", x)


def references(expression, commons):
    """The variables of an expression, those of its common expressions included."""
    if not isinstance(expression, tuple):
        return set()
    if expression[0] == "v":
        index = expression[1]
        if index in commons:
            linear, inner = commons[index]
            return set(linear) | references(inner, commons)
        return {index}
    return set().union(*(references(e, commons) for e in expression[1:] if not isinstance(e, list)))


def write_expression(out, expression):
    if not isinstance(expression, tuple):
        out.line("n", float(expression))
    elif expression[0] == "v":
        out.line("v", expression[1])
    elif expression[0] == "piecewise":  # slopes and breakpoints by turns, then the variable
        out.line("o", 64)
        out.line("", (len(expression[1]) + 1) // 2)
        for number in expression[1]:
            out.line("n", float(number))
        write_expression(out, expression[2])
    else:
        out.line("o", OPERATORS[expression[0]])
        if expression[0] in LISTS:
            out.line("", len(expression) - 1)
        for operand in expression[1:]:
            write_expression(out, operand)


def write_bounds(out, key, bounds):
    out.line(key)
    for lower, upper in bounds:
        if lower == upper:
            out.line("4", float(lower))
        elif lower > -INF and upper < INF:
            out.line("0", float(lower), float(upper))
        elif upper < INF:
            out.line("1", float(upper))
        elif lower > -INF:
            out.line("2", float(lower))
        else:
            out.line("3")


def write_nl(name, variables, rows=(), objectives=(), commons=None, suffixes=(), multipliers=(), kind=Text):
    """variables: (lower, upper, start); rows: (expression, linear, lower, upper); objectives: (sense, expression, linear), sense 0 or 1;
    commons: {index: (linear, expression)}; suffixes: (kind, name, {index: value}). Nonlinear variables, rows and objectives come first."""
    commons = commons or {}

    def linear_part(expression, linear):
        return {i: float(linear.get(i, 0)) for i in sorted(references(expression, commons) | set(linear))}

    jacobian = [linear_part(e, linear) for e, linear, _, _ in rows]
    gradients = [linear_part(e, linear) for _, e, linear in objectives]
    nonlinear = lambda functions: sum(isinstance(e, tuple) for e in functions)
    used = set().union(*(references(e, commons) for e in [r[0] for r in rows] + [o[1] for o in objectives]), set())
    nonlinear_variables = max(used) + 1 if used else 0

    head = Text()
    head.line(kind.letter, 3, 1, 1, 0, comment="problem " + name)
    head.line(" ", len(variables), len(rows), len(objectives), 0, sum(l == u for _, _, l, u in rows), 0, comment="sizes")
    head.line(" ", nonlinear(r[0] for r in rows), nonlinear(o[1] for o in objectives), comment="nonlinear rows, objectives")
    head.line(" ", 0, 0)
    head.line(" ", nonlinear_variables, nonlinear_variables, nonlinear_variables, comment="nonlinear variables")
    head.line(" ", 0, 0, 1, 0)
    head.line(" ", 0, 0, 0, 0, 0, comment="discrete variables")
    head.line(" ", sum(map(len, jacobian)), sum(map(len, gradients)), comment="non-zeros")
    head.line(" ", 0, 0)
    head.line(" ", len(commons), 0, 0, 0, 0, comment="common expressions")
    out = kind()
    out.bytes = head.bytes

    for suffix_kind, suffix, values in suffixes:
        out.line("S", suffix_kind, len(values), suffix)
        for index, value in values.items():
            out.line("", index, value)
    for index, (linear, expression) in commons.items():
        out.line("V", index, len(linear), 0)
        for i, coefficient in linear.items():
            out.line("", i, float(coefficient))
        write_expression(out, expression)
    for j, row in enumerate(rows):
        out.line("C", j)
        write_expression(out, row[0])
    for k, (sense, expression, _) in enumerate(objectives):
        out.line("O", k, sense)
        write_expression(out, expression)
    if multipliers:
        out.line("d", len(multipliers))
        for j, value in enumerate(multipliers):
            out.line("", j, float(value))
    starts = [(i, start) for i, (_, _, start) in enumerate(variables) if start != 0]
    if starts:
        out.line("x", len(starts))
        for i, start in starts:
            out.line("", i, float(start))
    if rows:
        write_bounds(out, "r", [(l, u) for _, _, l, u in rows])
    write_bounds(out, "b", [(l, u) for l, u, _ in variables])
    out.line("k", len(variables) - 1)
    total = 0
    for i in range(len(variables) - 1):
        total += sum(i in row for row in jacobian)
        out.line("", total)
    for key, parts in (("J", jacobian), ("G", gradients)):
        for j, part in enumerate(parts):
            if part:
                out.line(key, j, len(part))
                for i, coefficient in part.items():
                    out.line("", i, coefficient)
    with open(name + ".nl", "wb") as file:
        file.write(out.bytes)


def garden(name, kind):
    """max x y - 0.1 v^2 with v = x + y + 1, over a range, an equality, a free row and a linear row; z0 stands in linear rows only, w in none."""
    write_nl(
        name,
        variables=[(0, 10, 1.0), (0, INF, 1.5), (-INF, INF, 0.5), (-1, 1, 0.25)],
        commons={4: ({0: 1}, ("+", v(1), 1))},
        rows=[
            (("+", ("^", v(0), 2), ("^", v(1), 2)), {}, 1, 8),                # 1 <= x^2 + y^2 <= 8
            (("*", v(0), v(4)), {}, -INF, INF),                               # free
            (0, {0: 1, 1: -2, 2: 1}, 0, 0),                                   # x - 2 y + z = 0
            (0, {0: 1, 1: 1}, -INF, 3.5),                                     # x + y <= 3.5
        ],
        objectives=[(1, ("-", ("*", v(0), v(1)), ("*", 0.1, ("^", v(4), 2))), {}), (0, 7.5, {2: 1})],
        suffixes=[(0, "priority", {0: 3, 2: 1}), (5, "scale", {1: 2.5})],
        multipliers=[0.5, 0, -1, 0.25],
        kind=kind,
    )


garden("garden", Text)
garden("garden_binary", Binary)
with open("garden.col", "w") as names:
    names.write("width\ndepth\nslack\nunused\n")
with open("garden.row", "w") as names:
    names.write("fence\nshade\nbalance\nbudget\nyield\n")

# Rosenbrock's valley, no row at all.
write_nl(
    "valley",
    variables=[(-INF, INF, -1.2), (-INF, INF, 1.0)],
    objectives=[(0, ("+", ("*", 100, ("^", ("-", v(1), ("^", v(0), 2)), 2)), ("^", ("-", 1, v(0)), 2)), {})],
)
# A point on a circle and a line: rows, no objective.
write_nl(
    "crossing",
    variables=[(-INF, INF, 1.0), (-INF, INF, 0.5)],
    rows=[(("+", ("^", v(0), 2), ("^", v(1), 2)), {}, 4, 4), (0, {0: 1, 1: -1}, 0, 0)],
)
# Three rows that cannot be met together.
write_nl(
    "conflict",
    variables=[(0, 10, 1.0), (0, 10, 2.0)],
    rows=[(("^", v(0), 2), {}, -INF, 1), (0, {0: 1, 1: 1}, -INF, 3), (0, {1: 1}, 4, INF)],
    objectives=[(0, 0, {0: 1, 1: 1})],
)
# min x^3 - y over x <= 2: falls without limit.
write_nl("bottomless", variables=[(-INF, 2, 1.0), (-INF, INF, 0.0)], objectives=[(0, ("^", v(0), 3), {1: -1})])
# log(x) cannot be had at the start; nothing but a bound of the middle of the road would keep x > 0.
write_nl("undefined", variables=[(-INF, INF, -1.0)], objectives=[(0, ("-", v(0), ("log", v(0))), {})])

x, y, z = v(0), v(1), v(2)
write_nl(
    "operators",
    variables=[(0.1, 0.9, 0.4), (0.1, 0.9, 0.7), (1.1, 3, 1.6)],
    rows=[
        (("sum", ("+", x, y), ("-", x, ("*", y, z)), ("/", x, y), ("^", x, y), ("^", y, 3), ("^", 2, z)), {0: 2}, -INF, 100),
        (("sum", ("tanh", x), ("tan", y), ("sqrt", z), ("sinh", x), ("sin", y), ("log10", z), ("log", x), ("exp", y)), {}, -100, 100),
        (("sum", ("cosh", x), ("cos", y), ("atanh", x), ("atan2", y, z), ("atan", z), ("asinh", z), ("asin", x), ("acosh", z), ("acos", y)), {},
         -100, 100),
        (("if", ("and", ("<", x, y), ("not", (">=", x, 5))), ("*", x, y), ("neg", z)), {}, -100, 100),
        (("+", ("max", ("*", x, y), ("exp", z), 1), ("min", ("sin", x), y)), {}, -100, 100),
        (("+", ("abs", ("-", x, z)), ("less", ("*", z, z), x)), {}, -100, 100),
        (("piecewise", [1, 0.25, 2, 0.5, -1], x), {}, -100, 100),
    ],
    objectives=[(0, ("+", ("^", ("-", x, 0.5), 2), ("*", y, ("mod", z, 5))), {})],
)

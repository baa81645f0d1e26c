"""Which sources may share one translation unit.

Usage: source_units.py MOST SOURCE...

Prints one line for each unit: its sources, with semicolons between. Most of the time of a compiler, and of clang-tidy,
goes into what a source includes, so sources of a folder that name nothing alike are joined; a kernel that is compiled
for each instruction set stays alone."""

import pathlib
import re
import sys

# What a source names at the start of a line: functions, constants, types. Macros are what they stand for.
NAMED = re.compile(r"(?<![:\w])(\w+)(?=\(| =|\{)|(?:struct|class|enum) (\w+)")
MACRO = re.compile(r"\b[A-Z][A-Z0-9_]+\(")
ALIAS = re.compile(r"\s*(?:namespace (\w+) =|#define (\w+))")

WORD = re.compile(r"[A-Za-z_]\w*")
NO_CODE = re.compile(r'"(?:[^"\\]|\\.)*"|//.*')


def is_kernel(file):
    """Whether a source includes itself for each instruction set."""
    return "foreach_target.h" in file.read_text()


def names_in(file):
    """What a source may name by itself, and all words in it: what another one names must not be among these."""
    names, words = set(), set()
    for line in file.read_text().splitlines():
        words.update(WORD.findall(NO_CODE.sub(" ", line)))
        if alias := ALIAS.match(line):
            names.update(name for name in alias.groups() if name)
        elif line[:1].isalpha() and not line.startswith("namespace"):
            names.update(name for pair in NAMED.findall(MACRO.sub(" ", line)) for name in pair if name)
    return names, words


def units_of(sources, most):
    """Lists of sources that may share a unit, from a dictionary of what must be alike in one."""
    units = []  # (kind, names, words, files)
    for file in sorted(sources):
        names, words = names_in(file)
        kind = None if is_kernel(file) else (file.parent, sources[file])
        for unit in units:
            if kind and unit[0] == kind and len(unit[3]) < most and not (names & unit[2] or words & unit[1]):
                unit[1].update(names)
                unit[2].update(words)
                unit[3].append(file)
                break
        else:
            units.append((kind, names, words, [file]))
    # The long ones first, so that no processor waits for one at the end.
    return sorted((files for *_, files in units), key=len, reverse=True)


def main():
    sources = {pathlib.Path(name): None for name in sys.argv[2:]}
    for unit in units_of(sources, int(sys.argv[1])):
        print(";".join(map(str, unit)))


if __name__ == "__main__":
    main()

"""Runs clang-tidy over sources of a build, several in one translation unit.

Usage: tidy.py BUILD_DIR SOURCE_DIR FOLDER... [--alone]

Most of clang-tidy's time goes into what a source includes, so sources of a folder that are compiled alike and name
nothing alike share one unit. Kernels that are compiled for each instruction set are checked for one. With `--alone`
each source has a unit of its own, which takes several times as long. Ends with 1 when anything is found."""

import argparse
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

from source_units import is_kernel, units_of

CLANG_TIDY = "clang-tidy-14"
MOST_IN_A_UNIT = 12

def without_files(command):
    """What a source is compiled with, without its name and the object's."""
    kept, words = [], iter(shlex.split(command))
    for word in words:
        if word in ("-o", "-c", "-MF", "-MT"):
            next(words)
        else:
            kept.append(word)
    return tuple(kept)


def members_of(file):
    """The sources of a unit that CMake joined; else the file itself."""
    if file.parent.name != "Unity":
        return [file]
    return [pathlib.Path(name) for name in re.findall(r'^#include "(.*)"', file.read_text(), re.MULTILINE)]


def sources_of(build, folders):
    """Each source below the folders, with how it is compiled."""
    entries = json.loads((build / "compile_commands.json").read_text())
    found = {}
    for entry in entries:
        for file in members_of(pathlib.Path(entry["file"])):
            if any(folder in file.parents for folder in folders):
                found.setdefault(file, (entry["directory"], without_files(entry["command"])))
    return found


def joined(files):
    """The lines of some sources behind each other; what an earlier one includes is not included again."""
    lines, included = [], set()
    for file in files:
        own = file.read_text().splitlines()
        lines += ["" if line.startswith("#include") and line in included else line for line in own]
        included.update(line for line in own if line.startswith("#include"))
    return lines


def write_units(units, sources, folder):
    """Writes the files that clang-tidy sees, and how they are compiled."""
    folder.mkdir(parents=True, exist_ok=True)
    commands = []
    for unit in units:
        directory, command = sources[unit[0]]
        name = str(unit[0])
        arguments = [*command, "-c", name]
        if is_kernel(unit[0]):
            arguments.insert(1, "-DHWY_COMPILE_ONLY_STATIC")
        if len(unit) > 1:
            name = str(folder / f"{unit[0].parent.name}_{unit[0].stem}.cpp")
            pathlib.Path(name).write_text("\n".join(joined(unit)) + "\n")
            arguments = [*command, "-iquote", str(unit[0].parent), "-c", name]
        commands.append({"directory": directory, "file": name, "arguments": arguments})
    (folder / "compile_commands.json").write_text(json.dumps(commands, indent=1))
    return [command["file"] for command in commands]


def in_sources(found, name, unit):
    """Findings with the names and lines of the sources that a unit was joined of."""

    def source_line(match):
        line = int(match[1])
        for file in unit:
            count = len(file.read_text().splitlines())
            if line <= count:
                return f"{file}:{line}:"
            line -= count
        return match[0]

    return re.sub(re.escape(name) + r":(\d+):", source_line, found)


def config_of(source):
    """The settings that hold for a source."""
    return next(folder / ".clang-tidy" for folder in source.parents if (folder / ".clang-tidy").exists())


def check(file, folder, config):
    """What clang-tidy finds in one file; empty when nothing."""
    done = subprocess.run(
        [CLANG_TIDY, "-quiet", "-p", folder, f"--config-file={config}", file],
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode == 0:
        return ""
    return done.stdout or done.stderr or f"{file}: {CLANG_TIDY} ended with {done.returncode} and said nothing\n"


def check_unit(unit, name, sources, folder):
    """What clang-tidy finds in some sources: one by one where they turn out not to go together."""
    config = config_of(unit[0])
    found = check(name, folder, config)
    if len(unit) == 1:
        return found
    if "clang-diagnostic-error" not in found:
        return in_sources(found, name, unit)
    alone = folder / pathlib.Path(name).stem
    write_units([[file] for file in unit], sources, alone)
    return "".join(check(str(file), alone, config) for file in unit)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("folders", nargs="+")
    parser.add_argument("--alone", action="store_true", help="each source in a unit of its own")
    options = parser.parse_args()
    build, source = options.build.resolve(), options.source.resolve()
    sources = sources_of(build, [source / folder for folder in options.folders])
    if not sources:
        print(f"no source of {', '.join(options.folders)} is in {build}/compile_commands.json")
        return 1
    units = units_of(sources, 1 if options.alone else MOST_IN_A_UNIT)
    folder = build / "tidy" / ("_".join(options.folders) + ("_alone" if options.alone else ""))
    names = write_units(units, sources, folder)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = list(
            pool.map(lambda unit, name: check_unit(unit, name, sources, folder), units, names)
        )
    print("".join(found), end="")
    print(f"{len(sources)} sources in {len(units)} units, {sum(map(bool, found))} of them with findings")
    return 1 if any(found) else 0


if __name__ == "__main__":
    sys.exit(main())

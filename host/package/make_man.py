#!/usr/bin/env python3
"""Manual pages made from the help: make_man.py TAKT FOLDER writes takt.1 and takt-COMMAND.1 there.

The help is laid out in columns, so it stays as it is written; the page adds its name, its line of use and its sections.
"""
import pathlib
import re
import subprocess
import sys


def told(takt, *words):
    return subprocess.run([takt, *words], capture_output=True, text=True, check=True).stdout


def escaped(text):
    """A line of text as troff prints it."""
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq")
    return "\\&" + text if text[:1] in (".", "'") else text


def verbatim(lines):
    return [".nf", *map(escaped, lines), ".fi"]


def page(name, version, what, use, sections, others):
    lines = [f'.TH {name.upper()} 1 "" "takt {version}" "takt"', ".SH NAME", f"{escaped(name)} \\- {escaped(what)}", ".SH SYNOPSIS", f".B {escaped(use)}"]
    for title, text in sections:
        lines += [f".SH {title}", *verbatim(text)]
    lines += [".SH SEE ALSO", ", ".join(f".BR {escaped(other)} (1)" for other in others).replace(", .BR", "\n.BR")]
    return "\n".join(lines) + "\n"


def sections_of(text):
    """Use, what it is, and the help's parts."""
    use, what, rest = re.match(r"usage: (.*)\n\ntakt [\w-]+: (.*)\n\noptions:\n(.*)", text, re.S).groups()
    options, _, description = rest.partition("\n\n")
    return use, what, [("OPTIONS", options.splitlines()), ("DESCRIPTION", description.rstrip().splitlines())]


def main():
    takt, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    version = told(takt, "--version").split()[1]
    overview = told(takt, "help")
    commands = [name for name in re.findall(r"^  ([\w-]+) ", overview, re.M) if name != "help"]
    for name in commands:
        use, what, sections = sections_of(told(takt, "help", name))
        (folder / f"takt-{name}.1").write_text(page(f"takt-{name}", version, what, use, sections, ["takt"]))
    sections = [("COMMANDS", overview.partition("commands:\n")[2].rstrip().splitlines()),
                ("SCRIPTED FAULTS", told(takt, "help", "inject").rstrip().splitlines()),
                ("EXIT STATUS", ["0    done, and every check held", "1    a check failed", "2    the input is wrong; a message says what",
                                 "3    the computer refused something", "4    stopped before the program's end by --until"])]
    (folder / "takt.1").write_text(page("takt", version, "run, check and serve part programs for CNC machines", "takt COMMAND [arguments]",
                                        sections, [f"takt-{name}" for name in commands]))


main()

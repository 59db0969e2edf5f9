"""Campaigns as TOML: programs x machines x overrides x faults x plans x samples x seeds."""

from __future__ import annotations

import itertools
import math
import random
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..machine import Machine
from .scenario import Scenario

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

KEYS = {
    "name", "programs", "machines", "overrides", "faults", "plans", "variables", "samples", "seeds", "seed", "until",
}  # fmt: skip


class SpecError(ValueError):
    """The specification is wrong."""


@dataclass(frozen=True)
class Labels:
    """What a scenario is called in results and reports."""

    program: str
    machine: str
    overrides: str
    faults: str
    plan: str
    seed: int
    variables: tuple[tuple[str, float], ...]


@dataclass(frozen=True)
class Planned:
    labels: Labels
    scenario: Scenario


def _choice(given: Any, what: str) -> dict[str, Any]:
    if given is None:
        return {"none": None}
    if not isinstance(given, dict) or not given:
        raise SpecError(f"[{what}] names at least one: NAME = ...")
    return given


def _programs(patterns: Any, folder: Path) -> dict[str, str]:
    found: dict[str, str] = {}
    for pattern in [patterns] if isinstance(patterns, str) else patterns or []:
        if "\n" in pattern:
            found[f"text {len(found) + 1}"] = pattern
            continue
        paths = sorted(folder.glob(pattern)) if not Path(pattern).is_absolute() else [Path(pattern)]
        for path in paths:
            name = str(path.relative_to(folder)) if path.is_relative_to(folder) else str(path)
            found[name] = path.read_text(encoding="utf-8", errors="surrogateescape")
        if not paths:
            raise SpecError(f"programs: nothing is called {pattern} in {folder}")
    if not found:
        raise SpecError("programs = [...] names at least one part program")
    return found


def _machines(given: Any, folder: Path) -> dict[str, str]:
    texts: dict[str, str] = {}
    for name, entry in (given or {"mill": {}}).items():
        wrong = set(entry) - {"file", "set"}
        if wrong:
            raise SpecError(f"[machines] {name}: {', '.join(sorted(wrong))}; known are file and set")
        file = folder / entry["file"] if "file" in entry else None
        texts[name] = Machine(file, entry.get("set")).text if file or entry.get("set") else ""
    return texts


def _axis_of_grid(values: Any, name: str) -> list[float]:
    if not values:
        raise SpecError(f"variables: {name} has no value")
    return [float(v) for v in values]


def latin_hypercube(ranges: Mapping[str, Mapping[str, Any]], samples: int, seed: int) -> list[dict[str, float]]:
    """
    In every variable each of ``samples`` strata once:  u_i = (p_i + r_i) / n,  p a permutation, r uniform in 0 ... 1.
    ``{low, high}``, and ``log = true`` for equal ratios instead of equal differences.
    """
    columns: dict[str, list[float]] = {}
    for name in sorted(ranges):
        low, high, log = ranges[name]["low"], ranges[name]["high"], ranges[name].get("log", False)
        dice = random.Random(f"{seed} {name}")
        order = list(range(samples))
        dice.shuffle(order)
        u = [(p + dice.random()) / samples for p in order]
        if log:
            columns[name] = [low * math.exp(x * math.log(high / low)) for x in u]
        else:
            columns[name] = [low + x * (high - low) for x in u]
    return [{name: column[i] for name, column in columns.items()} for i in range(samples)] if columns else [{}]


def _variables(spec: Mapping[str, Any]) -> list[dict[str, float]]:
    """Every point of the grid with every sample of the hypercube."""
    given = spec.get("variables", {})
    lists = {name: _axis_of_grid(v, name) for name, v in given.items() if isinstance(v, list)}
    ranges = {name: v for name, v in given.items() if isinstance(v, dict)}
    samples = latin_hypercube(ranges, int(spec.get("samples", 1)), int(spec.get("seed", 1)))
    grid = [dict(zip(lists, point)) for point in itertools.product(*lists.values())]
    return [{**point, **sample} for point in grid for sample in samples]


def _storm(given: Mapping[str, Any], dice: random.Random) -> list[tuple[float, float]]:
    """Overrides at random times: ``{changes, within_s, low, high}``."""
    low, high = given.get("low", 0.0), given.get("high", 120.0)
    times = sorted(dice.uniform(0, given["within_s"]) for _ in range(given["changes"]))
    rows = [(round(t, 3), float(round(dice.uniform(low, high)))) for t in times]
    return [*rows, (round(given["within_s"], 3), 100.0)]  # or a program at 0 % would never end


def _filled(text: str, values: Mapping[str, float], seed: int) -> str:
    for name, value in {**values, "seed": seed}.items():
        text = text.replace("{" + name + "}", f"{value:.9g}")
    return text


def _overrides(given: Any, values: Mapping[str, float], seed: int, name: str) -> str:
    if given is None:
        return ""
    if isinstance(given, str):
        return _filled(given, values, seed)
    rows = _storm(given, random.Random(f"{seed} {name}")) if isinstance(given, dict) else given
    return "".join(f"{float(t)!r} {float(p)!r}\n" for t, p in rows)


def _lines(text: str) -> str:
    return text if not text or text.endswith("\n") else text + "\n"


def plan(spec: Mapping[str, Any], folder: Path) -> Iterator[Planned]:
    """All scenarios, in an order that is always the same."""
    wrong = set(spec) - KEYS
    if wrong:
        raise SpecError(f"{', '.join(sorted(wrong))}: known are {', '.join(sorted(KEYS))}")
    programs = _programs(spec.get("programs"), folder)
    machines = _machines(spec.get("machines"), folder)
    overrides = _choice(spec.get("overrides"), "overrides")
    faults = _choice(spec.get("faults"), "faults")
    seeds = spec.get("seeds", 1)
    seeds = range(seeds) if isinstance(seeds, int) else seeds
    for program, machine, override, fault, how, values, seed in itertools.product(
        programs, machines, overrides, faults, spec.get("plans", ["board"]), _variables(spec), seeds
    ):
        sets = tuple(f"{k}={v!r}" for k, v in sorted(values.items()) if "." in k)
        yield Planned(
            Labels(program, machine, override, fault, how, seed, tuple(sorted(values.items()))),
            Scenario(
                program=_lines(_filled(programs[program], values, seed)),
                machine=machines[machine],
                sets=sets,
                overrides=_overrides(overrides[override], values, seed, override),
                faults=_lines(_filled(faults[fault] or "", values, seed)),
                plan=how,
                until=float(spec.get("until", 0)),
            ),
        )


def read(path: Path) -> list[Planned]:
    """The scenarios of a file."""
    try:
        with open(path, "rb") as file:
            return list(plan(tomllib.load(file), path.resolve().parent))
    except (tomllib.TOMLDecodeError, KeyError, TypeError) as error:
        raise SpecError(f"{path}: {error}") from error

"""Campaigns as TOML: programs x machines x overrides x faults x plans x samples x seeds."""

from __future__ import annotations

import itertools
import math
import random
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from typing import Any, Union

from ..errors import InputError
from ..machine import Machine
from .scenario import Scenario

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

KEYS = {
    "programs", "machines", "overrides", "faults", "plans", "variables", "samples", "seeds", "seed", "until", "tools", "dialect",
}  # fmt: skip
PLANS = ("board", "ahead", "exact")
RANGE_KEYS = {"low", "high", "log", "whole"}
STORM_KEYS = {"changes", "within_s", "low", "high"}
OVERRIDE_MAX = 120

Number = Union[int, float]
Point = dict[str, Union[Number, str]]
Key = tuple[Union[str, int], ...]


class SpecError(ValueError):
    """The specification is wrong: ``FILE:LINE: KEY: what is wrong``."""

    def __init__(self, key: Key, text: str, place: str = "") -> None:
        self.key = key
        self.text = text
        super().__init__(f"{place}{'.'.join(map(str, key))}{': ' if key else ''}{text}")


@dataclass(frozen=True)
class Labels:
    """What a scenario is called in results and reports."""

    program: str
    machine: str
    overrides: str
    faults: str
    plan: str
    seed: int
    variables: tuple[tuple[str, Union[Number, str]], ...]


@dataclass(frozen=True)
class Planned:
    labels: Labels
    scenario: Scenario


# ---- what stands in the file, and is of the right kind ----


def _is_number(given: Any) -> bool:
    return isinstance(given, (int, float)) and not isinstance(given, bool) and math.isfinite(given)


def _number(given: Any, key: Key, low: float = -math.inf, high: float = math.inf) -> Number:
    if not _is_number(given) or not low <= given <= high:
        between = f" from {low:g} to {high:g}" if math.isfinite(high) else f", {low:g} or more" if math.isfinite(low) else ""
        raise SpecError(key, f"a number{between} is expected, not {given!r}")
    return given  # type: ignore[no-any-return]


def _whole(given: Any, key: Key, low: int) -> int:
    if not isinstance(given, int) or isinstance(given, bool) or given < low:
        raise SpecError(key, f"a whole number, {low} or more, is expected, not {given!r}")
    return given


def _text(given: Any, key: Key) -> str:
    if not isinstance(given, str):
        raise SpecError(key, f"a text is expected, not {given!r}")
    return given


def _list(given: Any, key: Key) -> list[Any]:
    found = [given] if isinstance(given, str) else given
    if not isinstance(found, list) or not found:
        raise SpecError(key, f"a list of at least one is expected, not {given!r}")
    return found


def _table(given: Any, key: Key, known: set[str] | None = None) -> Mapping[str, Any]:
    if not isinstance(given, dict):
        raise SpecError(key, f"NAME = ... is expected, not {given!r}")
    for name in given:
        if known is not None and name not in known:
            raise SpecError((*key, name), f"is not known here; known are {', '.join(sorted(known))}")
    return given


def _read(path: Path, key: Key) -> str:
    try:
        return path.read_text(encoding="utf-8", errors="surrogateescape")
    except OSError as error:
        raise SpecError(key, f"{path}: {error.strerror}") from error


# ---- its parts ----


def _programs(given: Any, folder: Path) -> dict[str, str]:
    found: dict[str, str] = {}
    for i, pattern in enumerate(_list(given, ("programs",))):
        key = ("programs", i)
        if "\n" in _text(pattern, key):
            found[f"text {len(found) + 1}"] = pattern
            continue
        root = Path(pattern).anchor
        paths = sorted(Path(root or folder).glob(pattern[len(root) :])) if pattern != root else []
        if not paths:
            raise SpecError(key, f"nothing is called {pattern} in {folder}")
        for path in paths:
            name = str(path.relative_to(folder)) if path.is_relative_to(folder) else str(path)
            found[name] = _read(path, key)
    return found


def _machines(given: Any, folder: Path) -> dict[str, str]:
    texts: dict[str, str] = {}
    for name, entry in _table(given, ("machines",)).items():
        key = ("machines", name)
        _table(entry, key, {"file", "set"})
        file = folder / _text(entry["file"], (*key, "file")) if "file" in entry else None
        sets = _table(entry.get("set", {}), (*key, "set"))
        try:
            texts[name] = Machine(file, sets).text if file or sets else ""
        except InputError as error:
            raise SpecError(key, str(error)) from error
    return texts


def _range(given: Any, key: Key) -> Mapping[str, Any]:
    _table(given, key, RANGE_KEYS)
    low, high = (_number(given.get(name), (*key, name)) for name in ("low", "high"))
    if low > high or given.get("log", False) and low <= 0:
        raise SpecError(key, f"low is {low:g} and high {high:g}: low is the smaller, and with log above 0")
    return {"low": low, "high": high, "log": bool(given.get("log", False)), "whole": bool(given.get("whole", False))}


def latin_hypercube(ranges: Mapping[str, Mapping[str, Any]], samples: int, seed: int) -> list[Point]:
    """
    In every variable each of ``samples`` strata once:  u_i = (p_i + r_i) / n,  p a permutation, r uniform in 0 ... 1.
    ``{low, high}``; ``log = true``: equal ratios instead of equal differences; ``whole = true``: rounded.
    """
    columns: dict[str, list[Number]] = {}
    for name in sorted(ranges):
        low, high, log = ranges[name]["low"], ranges[name]["high"], ranges[name].get("log", False)
        dice = random.Random(f"{seed} {name}")
        order = list(range(samples))
        dice.shuffle(order)
        u = [(p + dice.random()) / samples for p in order]
        values = [low * math.exp(x * math.log(high / low)) if log else low + x * (high - low) for x in u]
        columns[name] = [round(v) for v in values] if ranges[name].get("whole", False) else values
    return [{name: column[i] for name, column in columns.items()} for i in range(samples)] if columns else [{}]


def _variables(spec: Mapping[str, Any]) -> list[Point]:
    """Every point of the grid with every sample of the hypercube."""
    lists: dict[str, list[Any]] = {}
    ranges: dict[str, Mapping[str, Any]] = {}
    for name, given in _table(spec.get("variables", {}), ("variables",)).items():
        key = ("variables", name)
        if isinstance(given, dict):
            ranges[name] = _range(given, key)
            continue
        lists[name] = _list(given, key)
        for value in lists[name]:
            if not _is_number(value) and not isinstance(value, str):
                raise SpecError(key, f"numbers or texts are expected, not {value!r}")
    samples = latin_hypercube(ranges, _whole(spec.get("samples", 1), ("samples",), 1), _whole(spec.get("seed", 1), ("seed",), 0))
    grid = [dict(zip(lists, point)) for point in itertools.product(*lists.values())]
    return [{**point, **sample} for point in grid for sample in samples]


def _check_keys(points: Sequence[Point], machines: Mapping[str, str]) -> None:
    """Variables with a point in their names are keys of every machine."""
    for name, value in points[0].items():
        for text in machines.values():
            machine = Machine(text or None)
            if "." not in name or name in machine:
                continue
            try:
                machine[name] = value
            except InputError as error:
                raise SpecError(("variables", name), str(error)) from error


def _storm(given: Mapping[str, Any], dice: random.Random) -> list[tuple[float, float]]:
    """Overrides at random times: ``{changes, within_s, low, high}``."""
    times = sorted(dice.uniform(0, given["within_s"]) for _ in range(given["changes"]))
    rows = [(round(t, 3), float(round(dice.uniform(given["low"], given["high"])))) for t in times]
    return [*rows, (round(given["within_s"], 3), 100.0)]  # or a program at 0 % would never end


def _override(given: Any, key: Key) -> Any:
    """A text, a storm, or rows of (s, %)."""
    if isinstance(given, str):
        return given
    if isinstance(given, dict):
        _table(given, key, STORM_KEYS)
        low = _number(given.get("low", 0), (*key, "low"), 0, OVERRIDE_MAX)
        return {
            "changes": _whole(given.get("changes"), (*key, "changes"), 0),
            "within_s": _number(given.get("within_s"), (*key, "within_s"), 0),
            "low": low,
            "high": _number(given.get("high", OVERRIDE_MAX), (*key, "high"), low, OVERRIDE_MAX),
        }
    if not isinstance(given, list) or any(not isinstance(row, list) or len(row) != 2 for row in given):
        raise SpecError(key, f"rows of [s, %], a text or {{ changes, within_s, low, high }} are expected, not {given!r}")
    return [(_number(t, key, 0), _number(percent, key, 0, OVERRIDE_MAX)) for t, percent in given]


def number_text(value: Number | str) -> str:
    """As a word of a program takes it: without an exponent."""
    return value if isinstance(value, str) else format(Decimal(f"{value:.9g}"), "f")


def _filled(text: str, values: Point) -> str:
    for name, value in values.items():
        text = text.replace("{" + name + "}", number_text(value))
    return text


def _filled_whole(text: str, values: Point, key: Key) -> str:
    """No name of a variable is left in it."""
    filled = _filled(text, values)
    left = re.search(r"\{([\w.]+)\}", filled)
    if left is not None:
        raise SpecError(key, f"{left.group()}: no variable is called so; there are {', '.join(sorted(values))}")
    return filled


def _overrides(given: Any, values: Point, name: str) -> str:
    if isinstance(given, str):
        return _filled_whole(given, values, ("overrides", name))
    rows = _storm(given, random.Random(f"{values['seed']} {name}")) if isinstance(given, dict) else given
    return "".join(f"{float(t)!r} {float(p)!r}\n" for t, p in rows)


def _lines(text: str) -> str:
    return text if not text or text.endswith("\n") else text + "\n"


def _plans(given: Any) -> list[str]:
    for i, how in enumerate(_list(given, ("plans",))):
        if how not in PLANS:
            raise SpecError(("plans", i), f"{', '.join(PLANS)} are known, not {how!r}")
    return _list(given, ("plans",))


def _tools(given: Any, folder: Path) -> str:
    """The table; or ``auto``."""
    name = _text(given, ("tools",))
    return name if name in ("", "auto") else _read(folder / name, ("tools",))


def _seeds(given: Any) -> Sequence[int]:
    if isinstance(given, list) and given:
        return [_whole(seed, ("seeds", i), 0) for i, seed in enumerate(given)]
    return range(_whole(given, ("seeds",), 1))


def plan(spec: Mapping[str, Any], folder: Path) -> Iterator[Planned]:
    """All scenarios, in an order that is always the same."""
    _table(spec, (), KEYS)
    programs = _programs(spec.get("programs"), folder)
    machines = _machines(spec.get("machines") or {"mill": {}}, folder)
    overrides = {k: _override(v, ("overrides", k)) for k, v in _table(spec.get("overrides") or {"none": []}, ("overrides",)).items()}
    faults = {k: _text(v, ("faults", k)) for k, v in _table(spec.get("faults") or {"none": ""}, ("faults",)).items()}
    plans, points, seeds = _plans(spec.get("plans", ["board"])), _variables(spec), _seeds(spec.get("seeds", 1))
    common: dict[str, Any] = {
        "until": float(_number(spec.get("until", 0), ("until",), 0)),
        "tools": _tools(spec.get("tools", ""), folder),
        "dialect": _text(spec.get("dialect", ""), ("dialect",)),
    }
    _check_keys(points, machines)
    for program, machine, override, fault, how, point, seed in itertools.product(
        programs, machines, overrides, faults, plans, points, seeds
    ):
        values: Point = {**point, "seed": seed}
        yield Planned(
            Labels(program, machine, override, fault, how, seed, tuple(sorted(point.items()))),
            Scenario(
                program=_lines(_filled(programs[program], values)),
                machine=machines[machine],
                sets=tuple(f"{k}={v}" for k, v in sorted(point.items()) if "." in k),
                overrides=_overrides(overrides[override], values, override),
                faults=_lines(_filled_whole(faults[fault], values, ("faults", fault))),
                plan=how,
                **common,
            ),
        )


# ---- places in the file ----


def _holds(found: Any, key: Key) -> bool:
    for part in key:
        if not (part in found if isinstance(found, dict) else isinstance(found, list) and isinstance(part, int) and part < len(found)):
            return False
        found = found[part]
    return True


def line_of(text: str, key: Key) -> int:
    """Where the key stands, or what it would stand in: the line behind the longest beginning of the file without it."""
    lines, begin = text.splitlines(), 1
    for n in range(1, len(lines) + 1 if key else 1):
        try:
            found = tomllib.loads("\n".join(lines[:n]))
        except tomllib.TOMLDecodeError:
            continue  # in the middle of a value
        if _holds(found, key):
            return begin
        begin = n + 1
    return line_of(text, key[:-1]) if key else 1


def read(path: Path) -> list[Planned]:
    """The scenarios of a file."""
    try:
        text = path.read_text(encoding="utf-8")
        return list(plan(tomllib.loads(text), path.resolve().parent))
    except SpecError as error:
        raise SpecError(error.key, error.text, f"{path}:{line_of(text, error.key)}: ") from error
    except tomllib.TOMLDecodeError as error:
        found = re.fullmatch(r"(.*) \(at line (\d+), column (\d+)\)", str(error))
        what, place = (found.group(1), f":{found.group(2)}:{found.group(3)}") if found else (str(error), "")
        raise SpecError((), what, f"{path}{place}: ") from error
    except UnicodeDecodeError as error:
        raise SpecError((), f"is no UTF-8: {error.reason} at byte {error.start}", f"{path}: ") from error

"""Scenes as dictionaries: to TOML text, and keys by their path."""

from __future__ import annotations

import json
import math
import os
from typing import Any, Callable, Dict, List, Sequence, Tuple, Union

import numpy as np

from ._checks import names_hint
from .errors import InputError

Path = Union[str, Sequence[Union[str, int]]]

_AXES = {"x": 0, "y": 1, "z": 2}


def _key(name: str) -> str:
    plain = name and all(c.isascii() and (c.isalnum() or c in "-_") for c in name)
    return name if plain else json.dumps(name, ensure_ascii=False)


def _inline(value: Any, path: str, special: Callable[[Any, str], Any]) -> str:
    value = special(value, path)
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if not math.isfinite(value):
            raise InputError(f"{path} is {value}, which is not finite", "give a finite number")
        return repr(value)
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(k)} = {_inline(v, f'{path}.{k}', special)}" for k, v in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_inline(v, f"{path}[{i}]", special) for i, v in enumerate(value)) + "]"
    raise InputError(f"{path} is of the type {type(value).__name__}, which a scene cannot hold",
                     "give text, a number, True or False, a list or a dictionary")


def _is_tables(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and bool(value) and all(isinstance(v, dict) for v in value)


def dump(data: Dict[str, Any], special: Callable[[Any, str], Any] = lambda value, path: value,
         first: Sequence[Tuple[str, Any]] = ()) -> str:
    """TOML text of a scene, with one line per key, so that messages have a line.

    ``special`` replaces values that TOML does not have, by their path. ``first`` are entries of lists, as (key,
    entry), that come before all other tables, in their order, whatever their lists. Raises InputError for
    values that a scene cannot hold.
    """
    lines: List[str] = []

    def table(header: str, content: Dict[str, Any], path: str) -> None:
        lines.extend(["", header])
        lines.extend(f"{_key(k)} = {_inline(v, f'{path}.{k}', special)}" for k, v in content.items())

    for key, value in data.items():
        if not isinstance(value, dict) and not _is_tables(value):
            lines.append(f"{_key(key)} = {_inline(value, key, special)}")
    for key, entry in first:
        if not isinstance(entry, dict):
            raise InputError(f"{key} holds {entry!r}, which is not a dictionary", "give a list of dictionaries")
        table(f"[[{_key(key)}]]", entry, f"{key}.{entry.get('name', '')}")
    written = {id(entry) for _, entry in first}
    for key, value in data.items():
        if _is_tables(value):
            for i, entry in enumerate(value):
                if id(entry) not in written:
                    table(f"[[{_key(key)}]]", entry, f"{key}.{entry.get('name', i)}")
        elif isinstance(value, dict):
            if value and all(isinstance(v, dict) for v in value.values()):
                for name, entry in value.items():
                    table(f"[{_key(key)}.{_key(name)}]", entry, f"{key}.{name}")
            else:
                table(f"[{_key(key)}]", value, key)
    return "\n".join(lines).lstrip("\n") + "\n"


def steps_of(path: Path) -> List[Union[str, int]]:
    """The steps of a path: "part.crystal.surface", or a sequence where names contain dots. Raises InputError
    for others."""
    steps: List[Union[str, int]] = []
    if isinstance(path, str):
        steps += path.split(".")
    elif isinstance(path, (list, tuple)) and all(isinstance(step, (str, int, np.integer)) for step in path):
        steps += [int(step) if isinstance(step, np.integer) else step for step in path]
    if not steps or any(step == "" for step in steps):
        raise InputError(f"{path!r} is not the path of a key", 'write it as "part.crystal.surface"')
    return steps


def _child(node: Any, step: Union[str, int], walked: str) -> Tuple[Any, Union[str, int]]:
    """The container and the key in it to which a step leads. Raises InputError when there is none."""
    if isinstance(node, dict):
        return node, str(step)
    if isinstance(node, list):
        if isinstance(step, str) and step in _AXES and len(node) == 3 and not _is_tables(node):
            return node, _AXES[step]
        if isinstance(step, int) or step.lstrip("-").isdigit():
            if not -len(node) <= int(step) < len(node):
                raise InputError(f"{walked} has {len(node)} elements; there is no number {step}",
                                 "elements count from 0")
            return node, int(step)
        for label in ("name", "surface", "key", "part"):
            for i, entry in enumerate(node):
                if isinstance(entry, dict) and entry.get(label) == step:
                    return node, i
        raise names_hint(f'entry of "{walked}"', step,
                         [str(e.get("name", i)) for i, e in enumerate(node) if isinstance(e, dict)])
    raise InputError(f'"{walked}" is {node!r}, which has no key "{step}"', "end the path there")


def get(data: Dict[str, Any], path: Path) -> Any:
    """The value at a path. Raises InputError for one that does not exist, with the nearest name."""
    node: Any = data
    walked = "the scene"
    for step in steps_of(path):
        holder, key = _child(node, step, walked)
        if isinstance(holder, dict) and key not in holder:
            raise names_hint(f"key of {walked}", key, list(holder))
        node = holder[key]
        walked = str(step) if walked == "the scene" else f"{walked}.{step}"
    return node


def put(data: Dict[str, Any], path: Path, value: Any) -> None:
    """Sets the key at a path; missing tables along it are created. Raises InputError where it leads through a
    value."""
    steps = steps_of(path)
    node: Any = data
    walked = "the scene"
    for step in steps[:-1]:
        holder, key = _child(node, step, walked)
        if isinstance(holder, dict) and key not in holder:
            holder[key] = {}
        node = holder[key]
        walked = str(step) if walked == "the scene" else f"{walked}.{step}"
    holder, key = _child(node, steps[-1], walked)
    holder[key] = value


def remove(data: Dict[str, Any], path: Path) -> None:
    """Removes the key, or the entry, at a path. Raises InputError for one that does not exist."""
    steps = steps_of(path)
    get(data, path)
    node = get(data, steps[:-1]) if len(steps) > 1 else data
    holder, key = _child(node, steps[-1], ".".join(map(str, steps[:-1])))
    del holder[key]

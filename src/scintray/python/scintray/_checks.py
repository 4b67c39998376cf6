"""Checks of arguments: each function returns the value in the form that the library expects, or raises
InputError with the name of the argument, what was found, and a hint."""

from __future__ import annotations

import difflib
import math
import os
from pathlib import Path
from typing import Any, List, Optional, Sequence

import numpy as np

from .errors import InputError

_MOST_WHOLE = 2**64 - 1


def names_hint(kind: str, wanted: Any, names: Sequence[str]) -> InputError:
    """The error of an unknown name, with a hint of the nearest and of the existing ones."""
    near = difflib.get_close_matches(str(wanted), list(names), 1)
    shown: List[str] = list(names)[:8]
    hint = (f'did you mean "{near[0]}"? ' if near else "") + "there are: " + ", ".join(shown) \
        + (", ..." if len(names) > len(shown) else "") if names else "there are none"
    return InputError(f'no {kind} is called "{wanted}"', hint)


def numbers(values: Any, name: str, shape: Sequence[int], unit: str = "") -> np.ndarray:
    """Finite numbers as a contiguous array of doubles. -1 in ``shape`` stands for any length.

    Raises InputError with the name, the shape found and the one expected, and the first value that is not
    finite.
    """
    expected = "(" + ", ".join("n" if n < 0 else str(n) for n in shape) + ("," if len(shape) == 1 else "") + ")"
    try:
        array = np.ascontiguousarray(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError(f"{name} is not an array of numbers: {error}",
                         f"give an array of shape {expected}" + (f" in {unit}" if unit else "")) from error
    if array.ndim != len(shape) or any(n >= 0 and n != m for n, m in zip(shape, array.shape)):
        raise InputError(f"{name} has the shape {array.shape}; expected {expected}",
                         f"give an array of shape {expected}" + (f" in {unit}" if unit else ""))
    wrong = np.argwhere(~np.isfinite(array))
    if len(wrong):
        where = ", ".join(str(i) for i in wrong[0])
        raise InputError(f"{name}[{where}] is {array[tuple(wrong[0])]}, which is not finite"
                         + (f" ({len(wrong)} such values)" if len(wrong) > 1 else ""),
                         "remove or replace values that are not numbers")
    return array


def _plain(value: Any) -> Any:
    """The value as a Python number if it is a NumPy or xarray scalar, or an array without dimensions."""
    array = value if isinstance(value, np.generic) else np.asarray(value) if hasattr(value, "__array__") else None
    return array.item() if array is not None and np.ndim(array) == 0 else value


def _shown(value: Any) -> str:
    """The value as text for a message, 200 characters at most."""
    try:
        text = repr(value)
    except ValueError:  # a whole number of thousands of digits
        return "a number of very many digits"
    return text if len(text) <= 200 else text[:197] + "..."


def number(value: Any, name: str, unit: str = "", *, least: float = -math.inf, above: float = -math.inf,
           below: float = math.inf) -> float:
    """A finite number not below ``least``, above ``above`` and below ``below``; else raises InputError."""
    wanted = "a finite number" + (f" in {unit}" if unit else "")
    for bound, word in ((least, "from"), (above, "above"), (below, "below")):
        if math.isfinite(bound):
            wanted += f", {word} {bound:g}"
    value = _plain(value)
    try:
        found = math.nan if isinstance(value, bool) or not isinstance(value, (int, float)) else float(value)
    except OverflowError:
        found = math.inf
    if not math.isfinite(found):
        raise InputError(f"{name} is {_shown(value)}; expected {wanted}", f"write {name}=1.0, for example")
    if not (found >= least and found > above and found < below):
        raise InputError(f"{name} is {found:g}; expected {wanted}", "give a number in this range")
    return found


def whole(value: Any, name: str, *, least: int = 0, most: int = _MOST_WHOLE) -> int:
    """A whole number from ``least`` to ``most``, which may be written as 1e6; else raises InputError."""
    value = _plain(value)
    if isinstance(value, float) and value.is_integer() and abs(value) <= 2**53:
        value = int(value)
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        to = "" if most == _MOST_WHOLE else f" to {most}"
        raise InputError(f"{name} is {_shown(value)}; expected a whole number from {least}{to or ' on'}",
                         f"write {name}={min(max(least, 1), most)}, for example")
    return value


def whole_or_none(value: Any, name: str, *, least: int = 0, most: int = _MOST_WHOLE) -> Optional[int]:
    return None if value is None else whole(value, name, least=least, most=most)


def positive_integer(value: Any, name: str) -> Optional[int]:
    """None, or a whole number above 0."""
    return whole_or_none(value, name, least=1)


def thread_count(value: Any) -> Optional[int]:
    """None (all cores), or a number of threads."""
    return whole_or_none(value, "threads", least=1, most=4096)


def index_of(value: Any, name: str, count: int) -> int:
    """An index in [0, ``count``); negative ones count from the end. Raises InputError for others."""
    value = _plain(value)
    if isinstance(value, bool) or not isinstance(value, int) or not -count <= value < count:
        raise InputError(f"{name} is {_shown(value)}; expected a whole number from 0 to {count - 1}",
                         f"write {name}=0, for example")
    return value % count


def text_of(value: Any, name: str) -> str:
    if not isinstance(value, str):
        raise InputError(f"{name} is {_shown(value)}; expected text", "write it in quotes")
    return _encoded(value, name)


def _encoded(value: str, name: str) -> str:
    try:
        value.encode("utf-8")
    except UnicodeEncodeError as error:
        raise InputError(f"{name} is {value!r}, which is not Unicode", "give text, or a name, of valid characters") \
            from error
    return value


def flag(value: Any, name: str) -> bool:
    value = _plain(value)
    if not isinstance(value, bool) and value not in (0, 1):
        raise InputError(f"{name} is {_shown(value)}; expected True or False", f"write {name}=True, for example")
    return bool(value)


def one_of(value: Any, name: str, choices: Sequence[str]) -> str:
    if not isinstance(value, str) or value not in choices:
        raise InputError(f"{name} is {_shown(value)}", "it is " + " or ".join(f'"{choice}"' for choice in choices))
    return value


def path_text(value: Any, name: str = "the path") -> str:
    """The path of a file as text; raises InputError for other types and for characters that no path can
    have."""
    if not isinstance(value, (str, os.PathLike)) or not isinstance(os.fspath(value), str):
        raise InputError(f"{name} is {_shown(value)}; expected the path of a file", 'write it as text, "folder/file"')
    if "\0" in os.fspath(value):
        raise InputError(f"{name} is {value!r}, which has a character that no path can have", "remove the character 0")
    return _encoded(os.fspath(value), name)


def path_of(value: Any, name: str = "the path") -> Path:
    return Path(path_text(value, name))


def listed(values: Any, name: str, of: str) -> List[Any]:
    """The elements of a list, tuple or array; raises InputError for others."""
    try:
        if not isinstance(values, (str, bytes, dict)):
            return list(values)
    except TypeError:
        pass
    raise InputError(f"{name} is {_shown(values)}; expected a list of {of}", f"write {name}=[...]")

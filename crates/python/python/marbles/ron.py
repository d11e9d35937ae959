"""Values of Python as RON, the notation of scene files."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from pathlib import PurePath

import numpy as np

from .variant import Value, Variant

# Fields whose dicts have names of the user's own as keys.
MAPS = frozenset({"materials", "palette", "radii"})

# Fields whose sequences are lists; those of others are tuples.
LISTS = frozenset({"clouds", "keep", "keys", "lights", "rotation", "spheres"})

# Fields whose texts are variants if they begin with a capital letter, such as `up="Z"`.
CHOICES = frozenset(
    {
        "attached",
        "axes",
        "color",
        "color_scale",
        "colormap",
        "ease",
        "end",
        "falloff",
        "frame_over",
        "frames",
        "grain",
        "missing",
        "radii",
        "radius_law",
        "up",
        "what",
    }
)

# Fields that are colors.
COLORS = frozenset({"above", "albedo", "ambient", "background", "below", "color", "intensity", "sky"})

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*", re.ASCII)
_CHOICE = re.compile(r"[A-Z][A-Za-z0-9_]*", re.ASCII)
_UNSAFE = re.compile(r'["\\\x00-\x1f\x7f]')
_ESCAPES = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\r": "\\r", "\t": "\\t"}
_DEEPEST = 32  # levels of a value
_LONGEST = 100  # characters of a line


def write(value: Value, field: str = "", path: str | None = None) -> str:
    """A value as RON.

    Args:
        value: Variants, dicts, sequences, arrays, texts, numbers, flags and paths of files.
        field: The field that the value belongs to, which decides between lists and tuples, maps and structures,
            texts and variants.
        path: The place of the value, for messages; the name of the field by default.

    Raises:
        TypeError: A value of another type, or None in a sequence; the message begins with the path.
        ValueError: A number that is not finite, a text that is not Unicode, or a value that is nested too deeply.
    """
    return _write(value, field, field if path is None else path, 0)


def write_scene(fields: Mapping[str, Value]) -> str:
    """A scene as RON, one field a line; fields that are None are left out. Raises what `write` raises."""
    lines = [f"    {name}: {_write_long(value, name)},\n" for name, value in fields.items() if value is not None]
    return f"(\n{''.join(lines)})\n"


def read_string(text: str) -> str | None:
    """The string that a RON text stands for, plain or raw; None if it is none, or has escapes of characters."""
    raw = re.fullmatch(r'r(#*)"(.*)"\1', text, re.DOTALL)
    if raw:
        return raw.group(2)
    if len(text) < 2 or not (text.startswith('"') and text.endswith('"')):
        return None
    if re.search(r"\\[^\"\\nrt]", text.replace("\\\\", "")):
        return None
    known = {escape: character for character, escape in _ESCAPES.items()}
    return re.sub(r"\\.", lambda escape: known[escape.group()], text[1:-1])


def quote(text: str, path: str = "") -> str:
    """A text as a string of RON. Raises ValueError if it is not Unicode."""
    if not text.isascii():
        try:
            text.encode()
        except UnicodeEncodeError:
            raise ValueError(f"{path}: expected a text in Unicode, found {text!r}") from None
    return f'"{_UNSAFE.sub(_escape, text)}"'


def _escape(match: re.Match[str]) -> str:
    character = match.group()
    return _ESCAPES.get(character) or f"\\u{{{ord(character):x}}}"


def _write_long(value: Value, field: str) -> str:
    """A field of a scene: one line, or one line for each item if that is too long."""
    line = write(value, field)
    if len(line) <= _LONGEST or not _items(value):
        return line
    if isinstance(value, Mapping) and field in MAPS:
        items = [_pair(key, item, field, 1) for key, item in value.items() if item is not None]
        return f"{{\n{''.join(f'        {item},{chr(10)}' for item in items)}    }}"
    if field in LISTS and isinstance(value, (Sequence, np.ndarray)):
        items = [_write(item, "", f"{field}[{index}]", 1) for index, item in enumerate(value)]
        return f"[\n{''.join(f'        {item},{chr(10)}' for item in items)}    ]"
    return line


def _items(value: Value) -> int:
    return len(value) if isinstance(value, (Mapping, Sequence, np.ndarray)) and not isinstance(value, str) else 0


def _write(value: object, field: str, path: str, depth: int) -> str:
    if depth > _DEEPEST:
        raise ValueError(f"{path}: expected at most {_DEEPEST} levels, found more")
    if isinstance(value, (np.ndarray, np.generic)):
        if value.dtype == np.uint8 and field in COLORS and value.shape == (3,):
            # As everywhere: bytes are sRGB codes.
            return f'"#{value.tobytes().hex()}"'
        if value.dtype.kind not in "biufUO":
            raise TypeError(f"{path}: expected numbers or texts, found {value.dtype}")
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return _number(value, path)
    if isinstance(value, PurePath):
        return quote(str(value), path)
    if isinstance(value, str):
        return str(value) if field in CHOICES and _CHOICE.fullmatch(value) else quote(value, path)
    if isinstance(value, Variant):
        return _variant(value, path, depth)
    if isinstance(value, Mapping):
        return _mapping(value, field, path, depth)
    if isinstance(value, (Sequence, np.ndarray)) and not isinstance(value, (bytes, bytearray, memoryview)):
        items = [_write(item, "", f"{path}[{index}]", depth + 1) for index, item in enumerate(value)]
        return f"[{', '.join(items)}]" if field in LISTS else f"({', '.join(items)})"
    expected = "a number, a text, a sequence, a dict or a value of marbles"
    raise TypeError(f"{path}: expected {expected}, found {_found(value)}")


def _number(value: float, path: str) -> str:
    if isinstance(value, int):
        if value.bit_length() > 64:
            raise ValueError(f"{path}: expected a whole number of at most 64 bits, found one of {value.bit_length()}")
        return int.__repr__(value)
    if not math.isfinite(value):
        raise ValueError(f"{path}: expected a finite number, found {value}")
    return float.__repr__(value)


def _variant(value: Variant, path: str, depth: int) -> str:
    if not _CHOICE.fullmatch(value.name):
        raise TypeError(f"{path}: expected a name that begins with a capital letter, found {value.name!r}")
    if value.fields:
        return f"{value.name}({_fields(value.fields, path, depth)})"
    if not value.values:
        # `Free()` has brackets, `Pixel` has none.
        return value.name if type(value) is Variant else f"{value.name}()"
    items = [_write(item, "", f"{path}[{index}]", depth + 1) for index, item in enumerate(value.values)]
    return f"{value.name}({', '.join(items)})"


def _mapping(value: Mapping[object, object], field: str, path: str, depth: int) -> str:
    if field in MAPS:
        pairs = [_pair(key, item, field, depth + 1, path) for key, item in value.items() if item is not None]
        return f"{{{', '.join(pairs)}}}"
    name = next(iter(value), None)
    if not (isinstance(name, str) and _CHOICE.fullmatch(name)):
        return f"({_fields(value, path, depth)})"
    if len(value) > 1:
        others = [key for key in value if key != name]
        raise TypeError(f"{path}: expected nothing beside {name!r} in its dict, found {others[0]!r}")
    inner = value[name]
    # Brackets of a structure or a tuple are those of the variant.
    is_one = isinstance(inner, (str, bytes, Variant)) or not isinstance(inner, (Mapping, Sequence, np.ndarray))
    text = _write(inner, "", f"{path}[0]" if is_one else path, depth + 1)
    has_brackets = text.startswith("(")
    return f"{name}{text}" if has_brackets else f"{name}({text})"


def _fields(fields: Mapping[str, object] | Mapping[object, object], path: str, depth: int) -> str:
    written = []
    for key, item in fields.items():
        if not (isinstance(key, str) and _NAME.fullmatch(key)):
            raise TypeError(f"{path}: expected the name of a field, found {key!r}")
        if item is not None:
            written.append(f"{key}: {_write(item, key, f'{path}.{key}' if path else key, depth + 1)}")
    return ", ".join(written)


def _pair(key: object, item: object, field: str, depth: int, path: str | None = None) -> str:
    """A name of the user's own and its value. Whole numbers are names, too."""
    path = field if path is None else path
    if isinstance(key, (int, np.integer)) and not isinstance(key, bool):
        key = str(int(key))
    if not isinstance(key, str):
        raise TypeError(f"{path}: expected names as keys, found {_found(key)}")
    name = quote(key, path)
    return f"{name}: {_write(item, '', f'{path}[{name}]', depth)}"


def _found(value: object) -> str:
    return "None" if value is None else f"an object of the type {type(value).__name__}"

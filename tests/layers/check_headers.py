#!/usr/bin/env python3
"""Checks that every public header includes the headers of the standard library whose names it uses.

usage: check_headers.py REPOSITORY

With this, `./run tidy` can compile each header by itself with the standard library parsed only once.
"""
import pathlib
import re
import sys

# Names by header; names that only help, as std::less in a map, are not listed.
NAMES = {
    "algorithm": "min max sort",
    "array": "array",
    "atomic": "atomic",
    "chrono": "chrono",
    "cmath": "abs sqrt isfinite isnan",
    "complex": "complex",
    "cstddef": "size_t",
    "cstdint": "int64_t uint8_t uint32_t uint64_t",
    "ctime": "time_t",
    "deque": "deque",
    "exception": "exception exception_ptr",
    "filesystem": "filesystem",
    "functional": "function",
    "initializer_list": "initializer_list",
    "limits": "numeric_limits",
    "map": "map",
    "memory": "enable_shared_from_this make_shared make_unique shared_ptr unique_ptr weak_ptr",
    "mutex": "mutex",
    "optional": "nullopt optional",
    "ostream": "ostream",
    "set": "set",
    "span": "span",
    "stdexcept": "runtime_error",
    "string": "string to_string",
    "string_view": "string_view",
    "tuple": "tuple",
    "type_traits": "is_arithmetic_v is_same_v",
    "unordered_map": "unordered_map",
    "unordered_set": "unordered_set",
    "utility": "exchange move pair",
    "variant": "get_if variant",
    "vector": "vector",
}
HEADER_OF = {name: header for header, names in NAMES.items() for name in names.split()}


def missing(text):
    """Headers that a text should include."""
    used = {HEADER_OF[name] for name in re.findall(r"std::(\w+)", re.sub(r"//.*", "", text)) if name in HEADER_OF}
    return sorted(used - set(re.findall(r"#include <(\w+)>", text)))


def main(folder):
    headers = sorted((folder / "include").rglob("*.hpp"))
    found = [f"{path}: #include <{name}>" for path in headers for name in missing(path.read_text(encoding="utf-8"))]
    print("\n".join(found))
    return 1 if found or not headers else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))

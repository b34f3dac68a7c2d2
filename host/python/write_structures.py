# write_structures.py - structures and functions of C for Python and Fortran. SPDX-License-Identifier: MIT
"""write_structures.py [--check] HEADER...

Reads the public headers. The last one is that of the simple layer. Writes its functions, those in ALSO, and the
structures that they take: the whole of _structures.py, and all but the head of fibrad.f90. --check compares instead,
and fails where something would be written."""
import itertools
import pathlib
import re
import sys
import textwrap

PYTHON = pathlib.Path("host/python/fibrad/_structures.py")
FORTRAN = pathlib.Path("host/fortran/fibrad.f90")
BEGIN, END = "    ! ---- of C, by `make structures`\n", "    ! ---- end of what `make structures` writes\n"
ALSO = ["fibrad_version", "fibrad_status_text", "fibrad_why_text", "fibrad_node_emissivity",
        "fibrad_heat_sources_init"]
NUMBERS = {"double": ("c_double", "real(c_double)"), "int": ("c_int", "integer(c_int)"),
           "uint32_t": ("c_uint32", "integer(c_int32_t)"), "uint64_t": ("c_uint64", "integer(c_int64_t)"),
           "size_t": ("c_size_t", "integer(c_size_t)"), "uchar": ("c_ubyte", "integer(c_signed_char)")}

check, headers = sys.argv[1:2] == ["--check"], [name for name in sys.argv[1:] if name != "--check"]
texts = [re.sub(r"(?<!typedef )\bstruct ", "", pathlib.Path(name).read_text(encoding="utf-8")).replace("unsigned char", "uchar")
         for name in headers]


def declared(text, separator):
    """Declarations, as (type, whether const, stars, name, length or None)."""
    found = []
    for one in text.split(separator):
        words = re.match(r"\s*(const )?(\w+)\s+(.*)", one, re.S)
        for each in words[3].split(",") if words else ():
            name, length = re.match(r"[\s*]*(\w+)(?:\[(\w+)\])?", each).groups()
            found.append((words[2], bool(words[1]), each.count("*"), name, limits.get(length, length)))
    return found


source = re.sub(r"/\*.*?\*/", "", "".join(texts), flags=re.S)
limits = dict(re.findall(r"^#define (FIBRAD_\w+) +(\d+)u?$", source, re.M))
structures = {name: declared(fields, ";") for name, fields in
              re.findall(r"^typedef struct (\w+) \{(.*?)^\} \1;", source, re.S | re.M)}
callbacks = {name: (kind, declared(arguments, ",")) for kind, name, arguments in
             re.findall(r"^typedef (\w+ \*?)(\w+)\(([^;]*)\);", source, re.M)}
functions = {}
for text in texts:
    for said, kind, name, arguments in re.findall(
            r"(?:/\*((?:(?!\*/).)*)\*/\s*)?^((?:const )?\w+ \*?)(fibrad_\w+)\(([^;]*)\);", text, re.S | re.M):
        if name in ALSO or text is texts[-1]:
            functions[name] = (said, declared(kind + "result", ";")[0], declared(arguments, ","))

needed = {}  # structures and callbacks, each behind those that it has


def need(declarations):
    for kind, *_ in declarations:
        if kind not in needed and kind in callbacks:
            needed[kind] = callbacks[kind]
        elif kind not in needed and kind in structures:
            need(structures[kind])
            needed[kind] = structures[kind]


for _, _, arguments in functions.values():
    need(arguments)
structures, callbacks = ({name: needed[name] for name in needed if name in all_of} for all_of in (structures, callbacks))


def wrapped(before, items, after="", end="", more=8):
    """BEFORE, a list and AFTER in lines of 120 columns. Each but the last ends with END."""
    text = before.replace(" ", "~") + ", ".join(item.replace(" ", "~") for item in items) + after
    lines = textwrap.wrap(text, 120 - len(end), subsequent_indent=" " * more, break_long_words=False, break_on_hyphens=False)
    return f"{end}\n".join(lines).replace("~", " ") + "\n"


def camel(name):
    return name.removeprefix("fibrad_").title().replace("_", "")


def python_type(kind, constant, stars, name, length):
    if length:
        return f"{NUMBERS[kind][0]} * {length}"
    if kind in callbacks:
        return camel(kind)
    if stars and kind in ("void", "char"):
        return f"c_{kind}_p"
    if stars and kind not in structures and kind not in NUMBERS:  # opaque
        return "c_void_p" if stars == 1 else "POINTER(c_void_p)"
    if stars:
        return f"POINTER({python_type(kind, constant, stars - 1, name, None)})"
    return camel(kind) if kind in structures else NUMBERS[kind][0] if kind in NUMBERS else "None"


def python():
    yield ("# _structures.py - structures and functions of libfibrad.so, by `make structures`. SPDX-License-Identifier: MIT\n"
           "from ctypes import (CFUNCTYPE, POINTER, Structure, c_char_p, c_double, c_int, c_size_t, c_ubyte, c_uint32,\n"
           "                    c_uint64, c_void_p)\nfrom typing import Any\n\n")
    for name, (kind, arguments) in callbacks.items():
        types = [python_type(*one) for one in declared(kind + "result", ";") + arguments]
        yield wrapped(f"{camel(name)}: Any = CFUNCTYPE(", types, ")")
    for name, fields in structures.items():
        yield f"\n\nclass {camel(name)}(Structure):\n"
        yield wrapped("    _fields_ = [", [f'("{field[3]}", {python_type(*field)})' for field in fields], "]", more=16)
    yield "\n\nSTRUCTURES: dict[str, Any] = {\n"
    yield wrapped("    ", [f'"{name}": {camel(name)}' for name in structures], "}", more=4)
    yield "\n# what a function returns, and its arguments\nFUNCTIONS: dict[str, tuple[Any, list[Any]]] = {\n"
    for name, (_, result, arguments) in functions.items():
        yield wrapped(f'    "{name}": ({python_type(*result)}, [', [python_type(*one) for one in arguments], "]),")
    yield "}\n"


def fortran_field(field):
    """The type and the name of a component, with its default."""
    kind, _, stars, own, length = field
    if kind in callbacks:
        return "type(c_funptr)", f"{own} = c_null_funptr"
    if stars:
        return "type(c_ptr)", f"{own} = c_null_ptr"
    if kind in structures:
        return f"type({kind})", own
    return NUMBERS[kind][1], f"{own}{f'({length})' if length else ''} = 0"


def fortran_argument(said, argument):
    """An argument. One that is absent is NULL."""
    kind, constant, stars, name, _ = argument
    intent = f"intent({'in' if constant else 'inout'})"
    if kind == "char":
        return f"character(kind=c_char), intent(in) :: {name}(*)"
    if stars == 2:
        return f"type(c_ptr), intent(out) :: {name}"
    if stars and kind in structures:
        array = "(*)" if f"{name}[" in said else ""
        return f"type({kind}), {intent}, optional :: {name}{array}"
    if stars and kind in NUMBERS:
        return f"{NUMBERS[kind][1]}, {intent}, optional :: {name}(*)"
    return f"{'type(c_ptr)' if stars else NUMBERS[kind][1]}, value :: {name}"


def fortran():
    for name, fields in structures.items():
        yield f"    type, bind(C) :: {name}\n"
        for kind, group in itertools.groupby((fortran_field(field) for field in fields), lambda field: field[0]):
            yield wrapped(f"        {kind} :: ", [one for _, one in group], "", " &", 12)
        yield f"    end type {name}\n\n"
    yield "    interface\n"
    for name, (said, result, arguments) in functions.items():
        kind = "subroutine" if result[:3] == ("void", False, 0) else "function"
        yield wrapped(f"        {kind} {name}(", [argument[3] for argument in arguments], ")~bind(C)", " &", 12)
        yield "            import\n"
        for argument in arguments:
            yield f"            {fortran_argument(said, argument)}\n"
        if kind == "function":
            yield f"            {'type(c_ptr)' if result[2] else NUMBERS[result[0]][1]} :: {name}\n"
        yield f"        end {kind} {name}\n"
    yield "    end interface\n"


old = FORTRAN.read_text(encoding="utf-8")
before, _, rest = old.partition(BEGIN)
wanted = {PYTHON: "".join(python()), FORTRAN: before + BEGIN + "".join(fortran()) + END + rest.partition(END)[2]}
for path, text in wanted.items():
    if check and (not path.exists() or path.read_text(encoding="utf-8") != text):
        sys.exit(f"{path} is not as the headers say: run `make structures`")
    if not check:
        path.write_text(text, encoding="utf-8")

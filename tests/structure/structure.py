"""Rules about the source tree that no compiler checks. Each rule gives the places that break it.

The layering is not written down here: it is read from the table "Map" of docs/architecture.md.
test_structure.py runs every rule over the repository, and over small trees that break them.
"""

import os
import re
from pathlib import Path
from typing import NamedTuple

MAX_FILE_LINES = 700
MAX_FUNCTION_LINES = 40
CODE = {".hpp", ".cpp", ".h", ".c", ".S", ".def", ".re", ".yy"}
CPP = {".hpp", ".cpp"}
TABLES = {".def", ".yy"}  # one entry after the other; as long as what they list
SKIPPED = {".git", "build", ".cache", "__pycache__"}

# Compiled as a part of another layer.
PART_OF = {"grammar": "compiler"}
# Folders whose code runs on the board, and in them the ones that may know a machine.
FREESTANDING = ("vm/", "link/", "runtime-m4/")
MACHINE = ("runtime-m4/boards/", "runtime-m4/port/")
HOST_ONLY = ("runtime-m4/port/host/", "runtime-m4/sim/", "runtime-m4/module_files/")
# Inside runtime-m4/, from the bottom up: what each part may include of it, besides itself. All of that stands further up
# in this list, so no arrow points back. A part is a folder, but for these: the files at the top of runtime-m4/; the
# interface of the processor (port/port.hpp, and the headers of the processor that it brings) and the sources that
# implement it by the kernel; the interface of the board (boards/board.hpp), the chips that several boards have (CHIPS) and the
# boards. A chip's sources find the wiring of the board by ROBOSYNC_BOARD_WIRING.
RUNTIME = {
    "policy": set(),
    "algorithms": set(),
    "module_files": {"algorithms"},
    "port": {"policy"},
    "boards": {"policy"},
    "kernel": {"policy", "port"},
    "port's sources": {"port", "kernel"},
    "guard": {"policy", "boards", "kernel"},
    "drivers": {"policy", "boards", "kernel", "guard"},
    "layers": {"policy", "algorithms", "boards", "kernel", "drivers", "guard"},
    "safety": {"policy", "boards", "kernel", "layers"},
    "runtime": {"algorithms", "boards", "kernel", "guard", "drivers", "layers", "safety"},
    "update": {"policy", "boards", "kernel", "layers", "runtime"},
    "sim": {"policy", "boards", "kernel", "layers", "runtime"},
    "boards/common": {"port", "boards", "kernel", "layers", "runtime", "update"},
    "a chip": {"port", "boards", "kernel", "boards/common"},
    "a board": {"port", "boards", "kernel", "boards/common", "a chip"},
}
CHIPS = {"stm32l4"}
MAY_KNOW_THE_PROCESSOR = {"port", "port's sources", "boards/common", "a chip", "a board"}
# Inside rsc/: the same. What stands in rsc/ itself includes none of them.
TOOL = {
    "verbs": {"device", "trace", "dump", "timeline", "screen", "bridge", "companion", "lsp", "modules"},
    "device": {"trace"},
    "trace": set(),
    "timeline": {"device", "trace"},
    "screen": {"device", "trace"},
    "bridge": {"device", "trace"},
    "companion": {"device", "trace"},
    "dump": set(),
    "modules": {"device"},
    "lsp": set(),
}
# Inside compiler/, in the order of the passes: what each folder may include of it, besides itself.
# What lies in compiler/ itself puts them together and may include all; none may include that.
COMPILER = {
    "source": set(),
    "diagnostics": {"source"},
    "units": {"source", "diagnostics"},
    "syntax": {"source", "diagnostics", "units"},
    "config": {"source", "diagnostics", "units", "syntax"},
    "ir": {"source"},
    "sema": {"source", "diagnostics", "syntax", "units", "config", "ir"},
    "optimize": {"units", "config", "ir"},
    "codegen": {"source", "diagnostics", "units", "config", "ir"},
    "explain": {"source", "diagnostics", "syntax", "units", "config"},
    "test_plan": {"source", "diagnostics", "syntax", "units", "config", "ir", "sema"},
    "query": {"source", "diagnostics", "syntax", "units", "config", "sema", "explain"},
}
# Standard headers that allocate or throw, or need an operating system.
HOSTED_HEADERS = {
    "string", "vector", "map", "set", "unordered_map", "unordered_set", "list", "deque", "memory",
    "functional", "iostream", "sstream", "fstream", "iomanip", "stdexcept", "exception", "thread",
    "mutex", "future", "condition_variable", "regex", "filesystem", "any", "queue", "stack",
}
HARDWARE = re.compile(r"\bvolatile\b|\b0x(40|41|E0)0[0-9A-Fa-f]{5}u?\b")
# Calls of what drives an output; a board implements it.
OUTPUT = re.compile(r"(\.|->)\s*pwm_write\s*\(|\bboard_?(\.|->)\s*(ping|let_go|take_back|enable|spi_open|spi_close)\s*\(")
GUARD = "runtime-m4/guard/"
ASSEMBLER = re.compile(r"\basm\b|\b__asm(__)?\b")
BOARD_COSTS = re.compile(r"runtime-m4/boards/[\w-]+/costs\.def")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
LEFT_OVER = re.compile(r"\b(TODO|FIXME|XXX|HACK)\b")


class Problem(NamedTuple):
    path: str
    line: int
    text: str

    def __str__(self):
        return f"{self.path}:{self.line}: {self.text}"


class Source(NamedTuple):
    path: str  # from the top of the repository
    lines: list

    @property
    def suffix(self):
        return Path(self.path).suffix

    @property
    def top(self):
        return self.path.split("/")[0]


def read_tree(root):
    """Every text file of the repository at `root`."""
    sources = []
    for folder, folders, files in os.walk(root):
        folders[:] = sorted(set(folders) - SKIPPED)
        for file in sorted(files):
            path = Path(folder) / file
            try:
                lines = path.read_text("utf-8").splitlines()
            except UnicodeDecodeError:
                continue  # not text
            sources.append(Source(path.relative_to(root).as_posix(), lines))
    return sources


def read_layers(architecture):
    """{folder: set of folders it may include, or None for all} from the table of the map. A folder inside
    another one may have a row of its own, which then holds for it, and may be what a row allows."""
    layers = {}
    for line in architecture:
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        folders = re.findall(r"`([\w/-]+)/`", cells[0]) if len(cells) == 3 else []
        if len(folders) != 1:
            continue
        allowed = {folders[0], *re.findall(r"`([\w/-]+)/`", cells[2])}
        layers[folders[0]] = None if "all" in cells[2] else allowed
    return layers


def includes(source):
    for number, line in enumerate(source.lines, 1):
        if match := INCLUDE.match(line):
            yield number, match.group(1) == '"', match.group(2)


def layer_of(path, layers):
    """The innermost folder of the map that the file stands in; None outside of it."""
    top = path.split("/")[0]
    path = PART_OF.get(top, top) + path[len(top):]
    inside = [folder for folder in layers if path.startswith(folder + "/")]
    return max(inside, key=len, default=None)


def may_include(allowed, folder):
    """A folder is allowed with all that stands in it."""
    return allowed is None or any(f"{folder}/".startswith(f"{other}/") for other in allowed)


def check_layering(sources, layers):
    """Includes stand from the top of the repository and follow the table of the map."""
    for source in sources:
        layer = layer_of(source.path, layers)
        if source.suffix not in CODE or layer is None:
            continue
        for number, quoted, target in includes(source):
            if not quoted or target.startswith("rsl_"):  # generated from grammar/
                continue
            target_layer = layer_of(target, layers)
            if target_layer is None:
                yield Problem(source.path, number, f'"{target}" does not start at a layer\'s folder')
            elif not may_include(layers[layer], target_layer):
                yield Problem(source.path, number, f"{layer}/ may not include {target_layer}/")


def runtime_part(path):
    """The part of runtime-m4/ (RUNTIME) that a file is in, or None."""
    folders = path.split("/")[1:-1]
    if not folders:
        return Path(path).stem
    if folders[0] == "port":
        return "port's sources" if path.endswith(".cpp") else "port"
    if folders[0] == "boards" and len(folders) > 1:
        return "boards/common" if folders[1] == "common" else "a chip" if folders[1] in CHIPS else "a board"
    return folders[0]


def machine_of(path):
    """The folder of the processor or of the board that a file is for, or None: a chip is for several boards."""
    folders = path.split("/")[1:-1]
    return "/".join(folders) if len(folders) > 1 and folders[1] not in CHIPS | {"common"} else None


def check_runtime_folders(sources):
    """Inside runtime-m4/ no arrow points back, and nobody but a machine knows which one it is."""
    for source in sources:
        if source.top != "runtime-m4" or source.suffix not in CODE:
            continue
        part, machine = runtime_part(source.path), machine_of(source.path)
        if part == "policy":
            continue  # it has a line of its own in the map
        if part not in RUNTIME:
            yield Problem(source.path, 1, f"{part} has no place in the order of runtime-m4/")
            continue
        for number, _, target in includes(source):
            if not target.startswith("runtime-m4/"):
                continue
            other, its_machine = runtime_part(target), machine_of(target)
            if other not in RUNTIME[part] | {part}:
                yield Problem(source.path, number, f"{part} may not include {other}")
            elif its_machine not in (None, machine) and not knows(source.path, part, other):
                yield Problem(source.path, number, f"{target} belongs to one machine")


def knows(path, part, other):
    """May it include a file of `other` that is for one machine only?"""
    return other == "port" and (part in MAY_KNOW_THE_PROCESSOR and machine_of(path) is None
                                or part == "a board")


def check_tool_folders(sources):
    """Inside rsc/ the arrows point from the verbs to what they use, and from there to rsc/ itself."""
    for source in sources:
        parts = source.path.split("/")
        if parts[0] != "rsc" or source.suffix not in CODE:
            continue
        own = parts[1] if len(parts) > 2 else ""
        for number, _, target in includes(source):
            to = target.split("/")
            if to[0] == "rsc" and len(to) > 2 and to[1] not in TOOL.get(own, set()) | {own}:
                yield Problem(source.path, number, f"{own or 'rsc'}/ may not include {to[1]}/")


def check_compiler_folders(sources):
    """Inside compiler/ the arrows follow the passes; a folder that COMPILER does not name is wrong."""
    for source in sources:
        parts = source.path.split("/")
        if parts[0] != "compiler" or len(parts) < 3 or source.suffix not in CODE:
            continue
        if parts[1] not in COMPILER:
            yield Problem(source.path, 1, f"which pass is compiler/{parts[1]}/?")
            continue
        for number, _, target in includes(source):
            to = target.split("/")
            if to[0] != "compiler":
                continue
            if len(to) < 3 or to[1] not in COMPILER[parts[1]] | {parts[1]}:
                yield Problem(source.path, number, f"{parts[1]}/ may not include {target}")


def check_freestanding(sources):
    """What runs on the board uses no header that allocates, throws or needs an operating system."""
    for source in sources:
        if not source.path.startswith(FREESTANDING) or source.path.startswith(HOST_ONLY):
            continue
        for number, quoted, target in includes(source):
            if not quoted and target in HOSTED_HEADERS:
                yield Problem(source.path, number, f"<{target}> is not for code on the board")


def check_hardware(sources):
    """Registers and volatile only in boards/ and port/; in the runtime, assembler too."""
    for source in sources:
        if not source.path.startswith(FREESTANDING) or source.path.startswith(MACHINE):
            continue
        if source.suffix not in CODE:
            continue
        for number, line in enumerate(source.lines, 1):
            # `asm volatile` is about what the compiler may move, not about a register.
            code = re.sub(r'//.*|"[^"]*"|(?<=asm )volatile', "", line.replace("'", ""))
            if HARDWARE.search(code) or source.top == "runtime-m4" and ASSEMBLER.search(code):
                yield Problem(source.path, number, "hardware is touched only in boards/ and port/")


def check_outputs(sources):
    """Nobody drives an output but the output guard."""
    for source in sources:
        if source.suffix not in CODE or source.top == "tests" or source.path.startswith(GUARD):
            continue
        for number, line in enumerate(source.lines, 1):
            if OUTPUT.search(line):
                yield Problem(source.path, number, f"only {GUARD} drives outputs")


def check_head_comments(sources):
    """Each file opens with a comment that says what it is for; a .cpp may leave that to its .hpp."""
    for source in sources:
        is_script = source.top in ("scripts", ".ci") and "." not in Path(source.path).name
        if source.suffix not in CODE | {".py", ".sh", ".ld"} and not is_script:
            continue
        first = next((line.lstrip() for line in source.lines if line.strip() and line[:2] != "#!"), "")
        own_header = f'#include "{source.path.removesuffix("cpp")}hpp"'
        code = ("#include", "#pragma", "#ifndef", "#define")
        comment = first.startswith(("//", "/*", "#", "%{", '"""')) and not first.startswith(code)
        if first and not comment and first != own_header:
            yield Problem(source.path, 1, "no head comment")


def check_file_sizes(sources):
    for source in sources:
        if source.suffix in TABLES:
            continue
        if source.suffix in CODE | {".py", ".sh"} and len(source.lines) > MAX_FILE_LINES:
            yield Problem(source.path, len(source.lines), f"more than {MAX_FILE_LINES} lines")


FUNCTION = re.compile(r"^( {0,2})(?!\s)(?!namespace|class|struct|enum|union|extern|if|for|while|"
                      r"switch|else|do|\}|#|//).*\)[^;=]*\{$")


def check_function_sizes(sources):
    """Functions of the product, as clang-format lays them out; the interpreter's loop is free."""
    for source in sources:
        if source.suffix not in CPP or source.top in ("tests", "bench"):
            continue
        if source.path == "vm/interpreter.cpp":
            continue
        start = 0
        for number, line in enumerate(source.lines, 1):
            if not start and (match := FUNCTION.match(line)):
                start, end = number, match.group(1) + "}"
            elif start and line.startswith(end):
                if number - start + 1 > MAX_FUNCTION_LINES:
                    yield Problem(source.path, start,
                                  f"a function of more than {MAX_FUNCTION_LINES} lines")
                start = 0


def check_lists(sources):
    """Every .def is included: a list that nobody reads is a second place for its facts."""
    included = {target for source in sources for _, _, target in includes(source)}
    for source in sources:
        if BOARD_COSTS.fullmatch(source.path):  # boards/costs.hpp includes that of the board in the preset
            continue
        if source.suffix == ".def" and source.path not in included:
            yield Problem(source.path, 1, "nobody includes this list")


def check_boards(sources):
    """Every board declares its costs: without them, response times cannot be worked out for it."""
    paths = {source.path for source in sources}
    for path in sorted(paths):
        if Path(path).name == "board.cmake" and path.replace("board.cmake", "costs.def") not in paths:
            yield Problem(path, 1, "the board has no costs.def")


def check_left_overs(sources):
    for source in sources:
        if source.suffix not in CODE | {".py", ".sh", ".cmake"} or source.top == "tests":
            continue
        for number, line in enumerate(source.lines, 1):
            if LEFT_OVER.search(line):
                yield Problem(source.path, number, "unfinished")


RULES = {
    "compiler folders": check_compiler_folders,
    "runtime folders": check_runtime_folders,
    "tool folders": check_tool_folders,
    "freestanding": check_freestanding,
    "hardware": check_hardware,
    "outputs": check_outputs,
    "head comments": check_head_comments,
    "file sizes": check_file_sizes,
    "function sizes": check_function_sizes,
    "lists": check_lists,
    "boards": check_boards,
    "left-overs": check_left_overs,
}


def check(root):
    """Every problem of the repository at `root`, by rule."""
    sources = read_tree(root)
    layers = read_layers((Path(root) / "docs/architecture.md").read_text("utf-8").splitlines())
    problems = {"layering": list(check_layering(sources, layers))}
    for name, rule in RULES.items():
        problems[name] = list(rule(sources))
    return problems

"""The rules of structure.py over the repository, and over trees with one planted mistake each."""

import tempfile
import unittest
from pathlib import Path

import structure

ROOT = Path(__file__).resolve().parents[2]
HEAD = "// What it is for.\n"
MAP = """
| folder | what it is | may include |
|---|---|---|
| `grammar/` | tokens | – |
| `compiler/` | RSL to image | `vm/` |
| `vm/` | bytecode | itself |
| `link/` | serial protocol | itself |
| `analysis/` | worst case | `vm/`, `runtime-m4/policy/` |
| `runtime-m4/` | the board | `vm/`, `link/` |
| `runtime-m4/policy/` | pure functions | `vm/` |
| `rsc/` | the tool | all of them |
| `tests/ bench/` | | |
"""


class Repository(unittest.TestCase):
    """The repository as it is breaks no rule."""

    @classmethod
    def setUpClass(cls):
        cls.problems = structure.check(ROOT)

    def test_the_map_is_read(self):
        lines = (ROOT / "docs/architecture.md").read_text("utf-8").splitlines()
        layers = structure.read_layers(lines)
        self.assertEqual(layers["compiler"], {"compiler", "vm"})
        self.assertEqual(layers["runtime-m4"], {"runtime-m4", "vm", "link"})
        self.assertEqual(layers["runtime-m4/policy"], {"runtime-m4/policy", "vm"})
        self.assertEqual(layers["analysis"], {"analysis", "vm", "runtime-m4/policy"})
        self.assertIsNone(layers["rsc"])

    def assert_clean(self, rule):
        found = self.problems[rule]
        self.assertFalse(found, "\n" + "\n".join(map(str, found)))


def repository_test(rule):
    return lambda self: self.assert_clean(rule)


for _rule in ["layering", *structure.RULES]:
    setattr(Repository, "test_" + _rule.replace(" ", "_").replace("-", "_"), repository_test(_rule))


class Planted(unittest.TestCase):
    """Each rule sees the mistake it is there for, and nothing else in that tree."""

    def check(self, files):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in {"docs/architecture.md": MAP, **files}.items():
                path = Path(folder) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, "utf-8")
            problems = structure.check(folder)
        return {rule: [p.path for p in found] for rule, found in problems.items() if found}

    def assert_red(self, rule, name, text):
        self.assertEqual(self.check({name: text}), {rule: [name]})

    def test_a_good_tree_is_clean(self):
        self.assertEqual(self.check({
            "vm/a.hpp": HEAD + "#include <array>\n",
            "vm/list.def": HEAD,
            "vm/a.cpp": '#include "vm/a.hpp"\n',
            "vm/b.cpp": HEAD + '#include "vm/a.hpp"\n#include "vm/list.def"\n',
            "compiler/c.cpp": HEAD + '#include "vm/a.hpp"\n#include <string>\n',
            "compiler/sema/s.cpp": HEAD + '#include "compiler/ir/program.hpp"\n',
            "runtime-m4/kernel/k.cpp": HEAD + '#include "runtime-m4/port/port.hpp"\n',
            "runtime-m4/boards/x/b.cpp": HEAD + "volatile int* p = (int*)0x40004000;\n",
            "runtime-m4/policy/p.hpp": HEAD + '#include "vm/a.hpp"\n',
            "runtime-m4/layers/l.cpp": HEAD + '#include "runtime-m4/policy/p.hpp"\n',
            "analysis/a.cpp": HEAD + '#include "vm/a.hpp"\n#include "runtime-m4/policy/p.hpp"\n',
            "rsc/main.cpp": HEAD + '#include "link/frame.hpp"\n#include "compiler/c.hpp"\n',
            "scripts/go": "#!/bin/sh\n# Goes.\n",
        }), {})

    def test_wrong_includes(self):
        for name, target in [("vm/a.cpp", "link/frame.hpp"), ("link/a.cpp", "vm/image.hpp"),
                             ("compiler/sema/a.cpp", "runtime-m4/runtime.hpp"),
                             ("grammar/rsl.yy", "rsc/main.hpp"), ("compiler/a.hpp", "link/frame.hpp"),
                             ("runtime-m4/layers/a.cpp", "compiler/compiler.hpp"),
                             ("analysis/a.cpp", "runtime-m4/runtime.hpp"),
                             ("analysis/a.cpp", "runtime-m4/layers/concern.hpp"),
                             ("analysis/a.cpp", "compiler/compiler.hpp"),
                             ("analysis/a.cpp", "rsc/program.hpp"),
                             ("runtime-m4/kernel/a.cpp", "analysis/report.hpp"),
                             ("runtime-m4/policy/a.hpp", "link/frame.hpp"),
                             ("runtime-m4/policy/a.hpp", "runtime-m4/port/port.hpp"),
                             ("runtime-m4/policy/a.hpp", "runtime-m4/kernel/time.hpp"),
                             ("vm/a.hpp", "image.hpp"), ("vm/a.hpp", "../link/frame.hpp")]:
            with self.subTest(name=name, target=target):
                self.assert_red("layering", name, f'{HEAD}#include "{target}"\n')

    def test_wrong_arrows_in_the_tool(self):
        for name, target in [("rsc/trace/t.cpp", "rsc/device/client.hpp"), ("rsc/a.cpp", "rsc/dump/dump.hpp"),
                             ("rsc/device/d.hpp", "rsc/verbs/check.hpp"), ("rsc/dump/d.cpp", "rsc/trace/scenario.hpp")]:
            with self.subTest(name=name, target=target):
                self.assert_red("tool folders", name, f'{HEAD}#include "{target}"\n')
        self.assertEqual(self.check({"rsc/verbs/v.cpp": f'{HEAD}#include "rsc/device/client.hpp"\n',
                                     "rsc/device/d.cpp": f'{HEAD}#include "rsc/trace/t.hpp"\n'}), {})

    def test_the_order_of_the_runtime_has_no_cycle(self):
        seen = set()
        for part, may_include in structure.RUNTIME.items():
            self.assertLessEqual(may_include, seen, part)
            seen.add(part)

    def test_wrong_arrows_in_the_runtime(self):
        for name, target in [("runtime-m4/kernel/k.cpp", "runtime-m4/layers/step.hpp"),
                             ("runtime-m4/drivers/d.cpp", "runtime-m4/layers/order.hpp"),
                             ("runtime-m4/layers/s.cpp", "runtime-m4/safety/safety_rules.hpp"),
                             ("runtime-m4/safety/s.cpp", "runtime-m4/runtime.hpp"),
                             ("runtime-m4/runtime.cpp", "runtime-m4/update/server.hpp"),
                             ("runtime-m4/update/s.cpp", "runtime-m4/sim/simulator.hpp"),
                             ("runtime-m4/port/x/machine.hpp", "runtime-m4/kernel/kernel.hpp"),
                             ("runtime-m4/port/x/machine.cpp", "runtime-m4/layers/step.hpp"),
                             ("runtime-m4/boards/board.hpp", "runtime-m4/kernel/time.hpp"),
                             ("runtime-m4/boards/common/main.cpp", "runtime-m4/boards/x/board.hpp"),
                             ("runtime-m4/extra.hpp", "runtime-m4/runtime.hpp"),
                             ("runtime-m4/shelf/a.hpp", "runtime-m4/runtime.hpp"),
                             # what belongs to one machine
                             ("runtime-m4/kernel/k.hpp", "runtime-m4/port/x/machine.hpp"),
                             ("runtime-m4/sim/s.cpp", "runtime-m4/port/x/machine.hpp"),
                             ("runtime-m4/port/x/a.hpp", "runtime-m4/port/y/core.hpp"),
                             ("runtime-m4/drivers/d.cpp", "runtime-m4/boards/x/i2c.hpp"),
                             ("runtime-m4/boards/x/b.cpp", "runtime-m4/boards/y/i2c.hpp"),
                             # what belongs to one chip
                             ("runtime-m4/boards/stm32l4/b.cpp", "runtime-m4/boards/x/wiring.hpp"),
                             ("runtime-m4/boards/common/main.cpp", "runtime-m4/boards/stm32l4/i2c.hpp"),
                             ("runtime-m4/drivers/d.cpp", "runtime-m4/boards/stm32l4/i2c.hpp")]:
            with self.subTest(name=name, target=target):
                self.assert_red("runtime folders", name, f'{HEAD}#include "{target}"\n')

    def test_right_arrows_in_the_runtime(self):
        for name, target in [("runtime-m4/port/port.hpp", "runtime-m4/port/x/machine.hpp"),
                             ("runtime-m4/port/x/machine.cpp", "runtime-m4/kernel/kernel.hpp"),
                             ("runtime-m4/port/x/machine.cpp", "runtime-m4/port/x/core.hpp"),
                             ("runtime-m4/boards/common/main.cpp", "runtime-m4/update/server.hpp"),
                             ("runtime-m4/boards/x/b.cpp", "runtime-m4/boards/x/i2c.hpp"),
                             ("runtime-m4/boards/x/b.cpp", "runtime-m4/boards/common/reset.hpp"),
                             ("runtime-m4/boards/x/b.cpp", "runtime-m4/port/x/core.hpp"),
                             ("runtime-m4/boards/x/wiring.hpp", "runtime-m4/boards/stm32l4/wires.hpp"),
                             ("runtime-m4/boards/stm32l4/b.cpp", "runtime-m4/boards/common/reset.hpp"),
                             ("runtime-m4/boards/stm32l4/b.cpp", "runtime-m4/port/x/core.hpp")]:
            with self.subTest(name=name, target=target):
                self.assertEqual(self.check({name: f'{HEAD}#include "{target}"\n'}), {})

    def test_wrong_arrows_in_the_compiler(self):
        for name, target in [("compiler/ir/a.hpp", "compiler/sema/names.hpp"),
                             ("compiler/optimize/a.cpp", "compiler/codegen/frame.hpp"),
                             ("compiler/codegen/a.cpp", "compiler/optimize/optimize.hpp"),
                             ("compiler/sema/a.cpp", "compiler/compiler.hpp"),
                             ("compiler/passes/a.cpp", "compiler/ir/program.hpp")]:
            with self.subTest(name=name, target=target):
                self.assert_red("compiler folders", name, f'{HEAD}#include "{target}"\n')

    def test_hosted_headers_on_the_board(self):
        for name in ["vm/a.cpp", "link/a.hpp", "runtime-m4/port/cortex-m4/a.cpp"]:
            with self.subTest(name=name):
                self.assert_red("freestanding", name, HEAD + "#include <vector>\n")

    def test_hardware_outside_the_machine(self):
        for line in ["volatile int x;", "int* p = (int*)0x40004000;", 'asm("nop");',
                     "auto scb = 0xE000'ED00u;"]:
            with self.subTest(line=line):
                self.assert_red("hardware", "runtime-m4/layers/a.cpp", f"{HEAD}{line}\n")

    def test_outputs_driven_past_the_guard(self):
        for name in ["runtime-m4/drivers/a.cpp", "runtime-m4/layers/a.cpp", "runtime-m4/boards/x/a.cpp",
                     "runtime-m4/update/a.hpp", "bench/firmware/a.cpp"]:
            for line in ["board_.pwm_write(3, 1500);", "device->pwm_write (pin, pulse);", "board_.ping(3, 40);", "board.ping(3, 40);",
                         "board_.let_go(0);", "board->take_back(0);", "board_.enable(36, true);", "board_.spi_open(0, 36);"]:
                with self.subTest(name=name, line=line):
                    self.assert_red("outputs", name, f"{HEAD}{line}\n")
        self.assertEqual(self.check({"runtime-m4/guard/a.cpp": f"{HEAD}board_.pwm_write(3, 1500);\n"}), {})

    def test_missing_head_comments(self):
        for name, text in [("vm/a.hpp", "#pragma once\n"), ("rsc/a.cpp", "int a;\n"),
                           ("scripts/go", "#!/bin/sh\nset -e\n"),
                           ("vm/b.cpp", '#include "vm/a.hpp"\n'),
                           ("scripts/python/a.py", "import sys\n")]:
            with self.subTest(name=name):
                self.assert_red("head comments", name, text)

    def test_long_files_and_functions(self):
        self.assert_red("file sizes", "vm/a.cpp", HEAD + "int a;\n" * 700)
        body = "  x();\n" * 39
        self.assert_red("function sizes", "rsc/a.cpp", f"{HEAD}void f() {{\n{body}}}\n")
        self.assert_red("function sizes", "rsc/b.hpp",
                        f"{HEAD}class A {{\n  void f() const {{\n  {body.replace('x', '  x')}  }}\n}};\n")
        self.assertEqual(self.check({"rsc/a.cpp": f"{HEAD}void f() {{\n{body[7:]}}}\n"}), {})

    def test_a_board_without_costs(self):
        self.assert_red("boards", "runtime-m4/boards/x/board.cmake", "# A board.\n")
        self.assertEqual(self.check({"runtime-m4/boards/x/board.cmake": "# A board.\n",
                                     "runtime-m4/boards/x/costs.def": HEAD}), {})

    def test_a_list_nobody_reads(self):
        self.assert_red("lists", "vm/a.def", HEAD)

    def test_unfinished_code(self):
        self.assert_red("left-overs", "vm/a.cpp", HEAD + "// " + "TO" + "DO: later\n")


if __name__ == "__main__":
    unittest.main()

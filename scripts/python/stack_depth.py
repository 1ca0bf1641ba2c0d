"""The deepest stack use of each thread of a firmware, computed from the linked code.

Every call path from the thread's entry is added up, whether or not a test ever takes it. CALLED_BY_POINTER lists the targets
of calls by pointer; a call that matches nothing there, and recursion, raise StackError. tests/e2e/test_stack_depth.py compares
the stacks with the result. `scripts/python/stack_depth.py ELF PATTERN` prints the deepest path from the function whose name
matches, with the bytes of each function on it.
"""

import re
import subprocess
import sys

# Caller and possible targets of calls by pointer: targets are functions whose address is in the image and whose name matches. The
# first line that matches the caller counts.
BOARD = r"boards::(\w+::)?Board::"
PANEL = r"boards::(PanelSignal<.*>|PanelOutput)::(begin|show|end)\("
OUTPUTS = BOARD + r"(pwm_write|pwm_read|pins|enable|show|sound|say|panel|wheels)\(|" + PANEL
TWO_BLOCKS = BOARD + r"i2c_read_two\("
INPUTS = BOARD + r"(i2c_(?!read_two)\w+|input|measure)\("
STORE = r"boards::(\w+::)?(Eeprom|Store|FlashStore<.*>|Flash)::"
RUNTIME = r"Runtime::(began|halt|hold_to_budgets|look_at_rules|obey|progress|resting|running|tend_outputs)\("
MODULE = r"^(state_bytes|robosync_no_scratch|cost|init|strength|\w+_process)\b"
CALLED_BY_POINTER = (
    (r"layers::(Trace::|report_text|ControlLayer::tell_)", r"update::TraceRing::"),
    (r"layers::ControlLayer::(start_driver|stop_driver|next_key)", r"drivers::\w+::start\("),
    (r"layers::ControlLayer::release", r"drivers::\w+::release\("),
    (r"layers::ControlLayer::(start_unit|attend)", r"drivers::\w+::(advance|release)\("),  # go_on(), put_at_rest()
    (r"layers::SensorLayer::serve_chip", r"layers::DriverSampler::(serve|lose)_chip"),
    (r"layers::SensorLayer::sample$", r"layers::DriverSampler::sample\("),
    (r"layers::SensorLayer::retire|layers::ProcessingLayer::note_stops", r"layers::DriverSampler::lose_chip"),
    (r"layers::SensorLayer::a(wait_sample|sks_ahead)", r"layers::DriverSampler::a(sks_ahead|sk|waits)\("),
    (r"layers::SensorLayer::", r"layers::DriverSampler::"),
    (r"layers::DriverSampler::", r"drivers::\w+::read\(|" + INPUTS + "|" + OUTPUTS),
    (r"layers::AlgorithmLayer::|algorithms::", MODULE),
    (r"guard::OutputGuard::(halt_chips|switch_chips?_off)", BOARD + r"enable\("),
    (r"guard::OutputGuard::(put|put_wheels|change_pin|turn|turn_virtual_wheels|shut|settle)$", BOARD + r"(pwm_(read|write)|wheels)\("),
    (r"guard::OutputGuard::(tell|say)$", BOARD + r"(say|panel)\(|" + PANEL),
    (r"guard::OutputGuard::(count_wheels|take_edges)$", BOARD + r"(edges_so_far|take_edges|wheels)\("),
    (r"guard::OutputGuard::measured_by", BOARD + r"pins\("),
    (r"guard::", OUTPUTS),
    (r"drivers::Device::show\(", BOARD + r"show\("),
    (r"drivers::Device::", r"guard::OutputGuard::|" + OUTPUTS),
    (r"drivers::(AxesChip|lsm6dsl|mpu6050)::", INPUTS + "|" + TWO_BLOCKS),
    (r"drivers::", INPUTS),
    (r"safety::Monitor::", RUNTIME + "|" + BOARD + "watchdog"),
    (r"vm::check_records", r"vm::.*check_of<"),
    (r"update::(Store|Keeper)", STORE),
    (r"update::Server::", BOARD + r"(link_|name|store|reset_reason|buses|pins|input)|" + STORE),
    (r"robosync::Runtime::|boards::", OUTPUTS + "|" + BOARD + r"(name|buses|pins|store)\(|" + STORE),
)
# This function's calls by pointer run on another stack.
ON_ANOTHER_STACK = "robosync_call_in_sandbox"
# Added for a thread that is preempted: what the core stacks, aligned to 8, and what PendSV_Handler saves
# (switch.S). Both are larger with FPU registers.
FRAMES = 4 + 32 + 36
FPU_FRAMES = 4 + 104 + 100
GUARD = 32  # port::kGuard, below the stack of a privileged thread
CALLS = re.compile(r"^(bl?|b(eq|ne|cs|cc|mi|pl|vs|vc|hi|ls|ge|lt|gt|le))(\.[nw])?$")
LAST_ACTS = 3  # most instructions between the end of a frame and a tail call's jump
REGISTERS = re.compile(r"([rsd])(\d+)-[rsd](\d+)")


class StackError(Exception):
    pass


def _listed(text):
    """The number of registers in a list such as {r4-r7, lr}."""
    parts = text[text.index("{") + 1:text.index("}")].split(",")
    return sum(int(m[3]) - int(m[2]) + 1 if (m := REGISTERS.search(part)) else 1 for part in parts)


def _pushed(operation, operands):
    """The bytes by which an instruction lowers the stack pointer."""
    if operation.startswith("vpush"):
        return (8 if "d" in operands else 4) * _listed(operands)
    if operation.startswith("push") or operation.startswith("stmdb") and operands.startswith("sp!"):
        return 4 * _listed(operands)
    if operation.startswith("sub") and (m := re.match(r"sp, (?:sp, )?#(\d+)", operands)):
        return int(m[1])
    if operation.startswith("str") and (m := re.search(r"\[sp, #-(\d+)\]!", operands)):
        return int(m[1])
    if operation.startswith(("sub", "mov")) and operands.startswith("sp,") and "#" not in operands:
        raise StackError(f"nobody knows by how much `{operation} {operands}` lowers the stack")
    return 0


def _lets_go(operation, operands):
    return operation.startswith(("pop", "vpop")) or "sp!" in operands and operation.startswith("ldmia") or \
        operation.startswith("add") and operands.startswith("sp, ") or re.search(r"\[sp\], #\d+", operands) is not None


class Function:
    def __init__(self, at, name):
        self.at = at
        self.name = name
        self.most = 0  # bytes of its own frame
        self.calls = []  # (function's address, None: by pointer; bytes of its own frame at that time)
        self.uses_fpu = False
        self._recently = 9  # instructions since the frame was released

    def add(self, operation, operands):
        self.most += _pushed(operation, operands)
        self.uses_fpu = self.uses_fpu or operation.startswith("v")
        self._recently = 0 if _lets_go(operation, operands) else self._recently + 1
        # A jump to another function right after the frame's end is a tail call: the frame no longer exists.
        stands = self.most if operation.startswith("bl") or self._recently > LAST_ACTS else 0
        if operation in ("blx", "bx") and operands != "lr":
            self.calls.append((None, stands))
        elif CALLS.match(operation) and (m := re.match(r"([0-9a-f]+) <", operands)):
            target = int(m[1], 16)
            if target != self.at or operation.startswith("bl"):  # a jump to its own beginning is a loop
                self.calls.append((target, stands))


class Firmware:
    def __init__(self, elf, tools="arm-none-eabi-"):
        self._functions, function = {}, None
        for line in self._objdump(tools, elf, "-d", "-C", "--no-show-raw-insn"):
            if m := re.match(r"([0-9a-f]{8}) <(.*)>:$", line):
                at = int(m[1], 16)
                function = self._functions[at] = Function(at, m[2])
            elif function and (m := re.match(r"\s+[0-9a-f]+:\s+(\S+)\s*(.*)$", line)):
                function.add(m[1], re.split("[;@]", m[2])[0].strip())
        words, is_loaded = set(), True
        for line in self._objdump(tools, elf, "-s"):
            if line.startswith("Contents of section "):
                is_loaded = not line.startswith("Contents of section .debug")  # its words may look like pointers
            elif is_loaded and (m := re.match(r" [0-9a-f]+ ((?:[0-9a-f]{8} ){1,4})", line)):
                words.update(int.from_bytes(bytes.fromhex(word), "little") for word in m[1].split())
        self._pointed_to = [at for at in self._functions if at | 1 in words]
        self._deepest = {}

    @staticmethod
    def _objdump(tools, elf, *options):
        return subprocess.run([tools + "objdump", *options, str(elf)], check=True, text=True,
                              stdout=subprocess.PIPE).stdout.splitlines()

    def entry(self, pattern):
        """The address of the only function whose name matches."""
        found = [at for at, function in self._functions.items() if re.search(pattern, function.name)]
        if len(found) != 1:
            raise StackError(f"{len(found)} functions are named {pattern}")
        return found[0]

    def own(self, name):
        """Bytes of this function's own frame."""
        return next(function.most for function in self._functions.values() if function.name == name)

    def deepest(self, at, way=()):
        """(bytes, whether the FPU is used, the names of the functions on the path), from this function on."""
        if at in way:
            raise StackError("recursion: " + " → ".join(self._functions[a].name for a in (*way, at)))
        if at not in self._deepest:
            function = self._functions[at]
            best, fpu = (function.most, ()), function.uses_fpu
            for callee, stands in function.calls:
                for target in self._targets(function, callee):
                    below, uses, names = self.deepest(target, (*way, at))
                    best, fpu = max(best, (stands + below, names)), fpu or uses
            self._deepest[at] = (best[0], fpu, (function.name, *best[1]))
        return self._deepest[at]

    def _targets(self, function, callee):
        """The targets of a call; a jump within the function has none."""
        if callee is not None:
            return [callee] if callee in self._functions else []
        if function.name == ON_ANOTHER_STACK:
            return []
        for caller, callees in CALLED_BY_POINTER:
            if re.search(caller, function.name.split("(")[0]):
                return [at for at in self._pointed_to if re.search(callees, self._functions[at].name)]
        raise StackError(f"{function.name} calls by pointer: CALLED_BY_POINTER does not say whom")


def main():
    firmware = Firmware(sys.argv[1])
    for pattern in sys.argv[2:]:
        deepest, uses_fpu, way = firmware.deepest(firmware.entry(pattern))
        print(f"{deepest} bytes{', with FPU registers' if uses_fpu else ''}")
        for name in way:
            print(f"  {firmware.own(name):5} {name}")


if __name__ == "__main__":
    main()

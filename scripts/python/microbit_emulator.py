"""Makes the emulator of the micro:bit V2: QEMU's machine `microbit`, which is the first micro:bit, with another core and clock.

usage: microbit_emulator.py QEMU TARGET

TARGET becomes a copy of the program QEMU (qemu-system-arm, x86-64) in which some numbers of that machine are replaced by others
of the same length. Its core is a Cortex-M4 instead of a Cortex-M0, at 64 MHz instead of 16. A page of its flash has 4 KB instead
of 1, and the register with which the nRF52833 erases a page in parts erases it completely in one step. The size of its memory is
a property that board.py sets at start. QEMU itself stays as it is. Each place must be found exactly once; otherwise nothing is
written.
"""

import re
import struct
import sys
from pathlib import Path

CORE, NEW_CORE = b"\0cortex-m0-arm-cpu\0", b"\0cortex-m4-arm-cpu\0"
# A clock's period in QEMU, in 2^-32 ns, is the second argument of a call: `movabs $period, %rsi`.
MOVE = b"\x48\xbe"
HZ, NEW_HZ = 16_000_000, 64_000_000
# Many machines have such a call. This machine's is in the function that names its memory some hundred bytes later.
MEMORY = b"\0nrf51.sram\0"
NEAR = 1024
LOAD_ADDRESS = b"\x48\x8d"  # `lea offset(%rip), register`; the next byte says which register
LOAD = 1  # a segment
# The handler of writes to the flash's controller: `lea -0x504(%rbp), %rax; cmp $0x10, %rax; ja …`, and a jump through a table of
# the registers from 0x504 on, with an entry for each byte.
FIRST_REGISTER = 0x504
REGISTERS = re.compile(rb"\x48\x8d\x85\xfc\xfa\xff\xff\x48\x83\xf8(\x10)\x77.\x48\x8d\x15(....)\x48\x63\x04\x82\x48\x01\xd0\xff\xe0", re.S)
ERASE, ERASE_PARTLY = 0x508, 0x518
# In the code that erases a page: the page of an address, its size in bytes, and its last eight bytes.
PAGE, NEW_PAGE = 1024, 4096
OF_A_PAGE = ((rb"\x48\x81\xe3", lambda page: -page), (rb"\x2d", lambda page: page), (rb"\xba", lambda page: page),
             (rb"\x48\xc7\x80", lambda page: page - 8), (rb"\x8d\x88", lambda page: page))
IT_IS_ERASED_IN = 128


class Unknown(ValueError):
    """The program is not built as expected."""


def load_clock(hz):
    return MOVE + struct.pack("<Q", (1_000_000_000 << 32) // hz)


def places(program, wanted):
    at = program.find(wanted)
    while at >= 0:
        yield at
        at = program.find(wanted, at + 1)


def only(found, what):
    found = list(found)
    if len(found) != 1:
        raise Unknown(f"{what} is there {len(found)} times, not once")
    return found[0]


def address_of(program, at):
    """The run-time address of that byte of the file."""
    headers, size, count = (*struct.unpack_from("<Q", program, 32), *struct.unpack_from("<HH", program, 54))
    for i in range(count):
        kind, _, offset, address, _, length = struct.unpack_from("<IIQQQQ", program, headers + i * size)
        if kind == LOAD and offset <= at < offset + length:
            return at - offset + address
    raise Unknown("a place of the file is not loaded")


def offset_of(program, address):
    """The place in the file of the byte at that run-time address."""
    headers, size, count = (*struct.unpack_from("<Q", program, 32), *struct.unpack_from("<HH", program, 54))
    for i in range(count):
        kind, _, offset, begin, _, length = struct.unpack_from("<IIQQQQ", program, headers + i * size)
        if kind == LOAD and begin <= address < begin + length:
            return address - begin + offset
    raise Unknown("an address is not loaded")


def loads_address(program, at, wanted):
    """Whether an instruction soon after `at` loads the address `wanted`."""
    for place in places(program[at:at + NEAR], LOAD_ADDRESS):
        end = at + place + len(LOAD_ADDRESS) + 1 + 4
        offset, = struct.unpack_from("<i", program, end - 4)
        if address_of(program, end) + offset == wanted:
            return True
    return False


def patch_flash(program, changed):
    found = only(REGISTERS.finditer(program), "the flash's controller")
    table = address_of(program, found.end(2)) + struct.unpack("<i", found[2])[0]

    def entry(register):
        return offset_of(program, table) + 4 * (register - FIRST_REGISTER)

    # The new entry overwrites what follows the table: a name for QEMU's complaints about other registers.
    erase = program[entry(ERASE):entry(ERASE) + 4]
    changed[entry(ERASE_PARTLY):entry(ERASE_PARTLY) + 4] = erase
    changed[found.start(1)] = ERASE_PARTLY - FIRST_REGISTER
    begin = offset_of(program, table + struct.unpack("<i", erase)[0])
    for before, number in OF_A_PAGE:
        wanted = before + re.escape(struct.pack("<i", number(PAGE)))
        place = only(re.finditer(wanted, program[begin:begin + IT_IS_ERASED_IN]), "the size of a page")
        changed[begin + place.end() - 4:begin + place.end()] = struct.pack("<i", number(NEW_PAGE))


def patched(program):
    if program[:5] != b"\x7fELF\x02" or struct.unpack_from("<H", program, 18) != (62,):
        raise Unknown("it is no program for x86-64")
    memory = address_of(program, only(places(program, MEMORY), "the name of its memory")) + 1
    core = only(places(program, CORE), "the name of its core")
    clock = only((at for at in places(program, load_clock(HZ)) if loads_address(program, at, memory)), "its clock")
    changed = bytearray(program)
    changed[core:core + len(CORE)] = NEW_CORE
    changed[clock:clock + len(load_clock(HZ))] = load_clock(NEW_HZ)
    patch_flash(program, changed)
    return bytes(changed)


def main(qemu, target):
    try:
        program = patched(Path(qemu).read_bytes())
    except Unknown as error:
        print(f"{qemu} cannot be made the micro:bit V2's emulator: {error}", file=sys.stderr)
        return 3
    new = Path(target + ".new")
    new.write_bytes(program)
    new.chmod(0o755)
    new.rename(target)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))

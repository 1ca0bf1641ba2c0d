#!/usr/bin/env bash
# Runs the kernel's tests on the emulated board. Ends with "N passed, N failed".
#
# usage: tests/runtime-m4/kernel/run_qemu.sh [ELF]     (default: build/m4/kernel-test.elf)
set -euo pipefail
built=$(dirname "$0")/../../../build/m4
elf=${1:-$built/kernel-test.elf}
[ -f "$elf" ] || { echo "run_qemu.sh: no $elf; build the m4 preset first" >&2; exit 3; }

# -icount: 32 virtual nanoseconds per instruction, about the speed of the board, and the same in every
# run. This holds only while the core does not wait for interrupts: QEMU then follows the host's
# clock and loses ticks. So the tests keep a thread of the lowest rank spinning.
status=0
timeout 120 qemu-system-arm -M "$(cat "$built/machine")" -nographic -monitor none -serial none \
  -icount shift=5 -semihosting-config enable=on,target=native \
  -device tmp105,address=0x48 -kernel "$elf" 2>&1 || status=$?
if [ $status -ne 0 ] && [ $status -ne 1 ]; then
  echo "run_qemu.sh: the board did not finish (timeout 120 s, exit status $status)" >&2
  echo "0 passed, 1 failed"
fi
exit $status

#!/usr/bin/env bash
# Runs the kernel's stress test on the emulated board (firmware/stress.cpp): compares every decision of the context
# switch with a naive policy, under random use and random interrupts. Ends with "N passed, N failed".
#
# usage: tests/runtime-m4/kernel/run_stress.sh [SECONDS]     of virtual time (default: 60; a minute takes some 20 s)
set -euo pipefail
built=$(dirname "$0")/../../../build/m4
elf=$built/kernel-stress.elf
seconds=${1:-60}
[ -f "$elf" ] || { echo "run_stress.sh: no $elf; build the m4 preset first" >&2; exit 3; }

# As in run_qemu.sh; with sleep=off the time in which all threads sleep is skipped, so that runs are repeatable.
status=0
timeout $((60 + seconds * 2)) qemu-system-arm -M "$(cat "$built/machine")" -nographic -monitor none -serial none \
  -icount shift=5,sleep=off -semihosting-config enable=on,target=native \
  -device loader,addr=0x21000000,data="$seconds",data-len=4 -kernel "$elf" 2>&1 || status=$?
[ $status -eq 0 ] || [ $status -eq 1 ] || echo "0 passed, 1 failed"
exit $status

# Functions shared by the scripts in this folder: report progress, install missing packages, build.
#
# Bash scripts source this. Afterwards the working directory is the top of the repository.
# Exit codes are those of rsc: 2 wrong usage, 3 something outside is missing.

set -euo pipefail
export INVOKED_FROM=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export PYTHONPATH=$PWD/scripts/python PYTHONDONTWRITEBYTECODE=1

say() { printf '\n== %s\n' "$*"; }
die() {
  printf '%s: %s\n' "${0##*/}" "$1" >&2
  exit "${2:-3}"
}

# Prints the head comment of the running script, for --help.
usage() { sed -n '2,/^\. /{/^\. /d;s/^# \{0,1\}//;p}' "scripts/${0##*/}"; }

# missing_packages [SECTION…]: prints the packages in these sections of packages.txt that are not installed, one a line. Default:
# all sections except [faces], [objects], [editor], [rates] and [fuzz].
missing_packages() {
  local package
  awk -v wanted=" $* " '/^\[/ { section = substr($1, 2, length($1) - 2); next }
       /^[^#]/ && (wanted == "  " ? section !~ /^(faces|objects|editor|rates|fuzz)$/ : index(wanted, " " section " "))' scripts/packages.txt |
    while read -r package; do
    dpkg-query -W -f='${db:Status-Abbrev}' "$package" 2>/dev/null | grep -q '^ii' || echo "$package"
  done
}

# install_missing [SECTION…]: installs the missing packages, as root or through sudo; without a terminal it asks for
# nothing.
install_missing() {
  command -v dpkg-query >/dev/null && command -v apt-get >/dev/null ||
    die "needs Debian 12 with apt-get; elsewhere, install what scripts/packages.txt lists"
  local missing
  missing=$(missing_packages "$@" | tr '\n' ' ')
  [ -n "$missing" ] || return 0

  local as_root=()
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null ||
      die "not root and no sudo; as root, run: apt-get install --no-install-recommends $missing"
    as_root=(sudo)
    [ -t 0 ] || as_root=(sudo -n)
  fi
  say "Installing what is missing: $missing"
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300)
  "${apt[@]}" update || die "apt-get update failed (no network, or not allowed)"
  # shellcheck disable=SC2086  # one argument a package
  "${apt[@]}" install -y --no-install-recommends $missing || die "could not install: $missing"
}

# build PRESET [TARGET…]: configures build/PRESET and builds all of it, or only the targets. Quiet unless it fails.
# The array `configuring` holds further arguments for cmake.
configuring=()
build() {
  local preset=$1 log=build/$1.log
  shift
  case "$preset" in
    host*) ;;
    *) signature_sources ;;
  esac
  say "Building $preset (CMake preset; ${*:+only $*; }log: $log)"
  mkdir -p build
  # One build at a time: several robots may be started in parallel, and each first checks whether there is something to build.
  exec {building}>"build/$preset.lock"
  flock "$building"
  if ! { cmake --preset "$preset" "${configuring[@]}" && cmake --build --preset "$preset" ${*:+--target "$@"}; } \
    >"$log" 2>&1; then
    tail -n 60 "$log" >&2
    die "the build of $preset failed" 1
  fi
  exec {building}>&-
}

# Builds rsc without its tests, so that their libraries are not needed. If the tests are already configured, they stay.
build_tool() {
  if ! grep -qs '^ROBOSYNC_TESTS:.*=ON' build/host/CMakeCache.txt; then configuring=(-D ROBOSYNC_TESTS=OFF); fi
  build host rsc
  configuring=()
}

# preset_of BOARD: sets `preset` to the preset that builds the board's firmware, `firmware` to the target, `made` to its folder.
preset='' firmware='' made=''
preset_of() {
  local reference of
  reference=$(sed -n '/"name": "m4"/,/"ROBOSYNC_BOARD"/s/.*"ROBOSYNC_BOARD": "\([^"]*\)".*/\1/p' CMakePresets.json)
  preset=$1 firmware=robosync_firmware
  [ "$1" != "$reference" ] || preset=m4
  made=build/$preset
  [ -f "stdlib/boards/$1.json" ] || die "no board '$1'; there are: $(cd stdlib/boards && echo *.json | sed 's/\.json//g')" 2
  of=$(sed -nE 's/.*"ROBOSYNC_BOARD": "([^"]*)", "ROBOSYNC_TWINS": "([^"]*;)?'"$1"'[;"].*/\1/p' CMakePresets.json)
  [ -z "$of" ] || preset=$of firmware=robosync_firmware_$1 made=build/$of/$1
}

# unpack_emulator: does the work of scripts/emulator. Sets `emulator` to the program, and makes build/qemu-microbit-v2; if that
# fails, a message says why.
unpack_emulator() {
  newer_emulator
  local maker=scripts/python/microbit_emulator.py copy=build/qemu-microbit-v2
  if [ "$copy" -nt "$emulator" ] && [ "$copy" -nt $maker ]; then return 0; fi
  rm -f "$copy"
  /usr/bin/python3 $maker "$emulator" "$copy" || true
}

# newer_emulator: the first part of that. Package and checksum come from
# https://deb.debian.org/debian/dists/bookworm-backports/main/binary-amd64/Packages.xz; the emulator uses the libraries of the
# installed qemu-system-arm.
emulator=
newer_emulator() {
  local version archive=build/qemu.deb
  local pool=pool/main/q/qemu/qemu-system-arm_10.0.2+ds-2+deb13u1~bpo12+1_amd64.deb
  local sum=edebbab09db3882c48ef9c00049c7c6a2d76d195cb88d830baadd1fb705bbc66
  version=$(qemu-system-arm --version | sed -n 's/.*version \([0-9.]*\).*/\1/p')
  if dpkg --compare-versions "$version" ge 9.2; then
    emulator=$(command -v qemu-system-arm)
    return
  fi
  emulator=$PWD/build/qemu/usr/bin/qemu-system-arm
  [ ! -x "$emulator" ] || return 0
  [ "$(dpkg --print-architecture)" = amd64 ] || die "needs QEMU 9.2 or newer; the one for Debian 12 is for amd64 only"
  say "Getting QEMU 10.0.2, beside the installed $version"
  mkdir -p build
  if from_mirror "$pool" "$sum" "$archive"; then
    dpkg-deb -x "$archive" build/qemu.new && rm -rf build/qemu && mv build/qemu.new build/qemu && rm "$archive"
    "$emulator" --version >/dev/null || die "QEMU 10.0.2 does not run here"
    return
  fi
  die "QEMU 10.0.2 could not be had: no mirror has ${pool##*/}"
}

# signature_sources: does the work of scripts/signatures: puts the sources into build/tinyssh. Path and checksum come from
# https://deb.debian.org/debian/dists/bookworm/main/source/Sources.xz. The archive is the upstream one, which Debian does not
# change, so it stays the same during the life of Debian 12.
signature_sources() {
  [ ! -d build/tinyssh ] || return 0
  say "Getting the source package tinyssh, for Ed25519 on the board"
  mkdir -p build
  local archive=build/tinyssh.tar.gz
  from_mirror pool/main/t/tinyssh/tinyssh_20230101.orig.tar.gz \
    74a434389dd05bf421feb6b6fab241f763b78222750d21100bd81d9ba626b28c "$archive" ||
    die "the source package tinyssh could not be had, with which a board verifies signatures: no mirror has it"
  rm -rf build/tinyssh.new
  mkdir build/tinyssh.new
  tar -xzf "$archive" -C build/tinyssh.new --strip-components 1
  mv build/tinyssh.new build/tinyssh
  rm "$archive"
}

# from_mirror PLACE SHA256 FILE: downloads that path of Debian's archive, trying this machine's mirrors first.
from_mirror() {
  local mirror log=$3.log
  for mirror in $(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 2>/dev/null | sort -u) \
    http://deb.debian.org/debian/; do
    if /usr/lib/apt/apt-helper download-file "${mirror%/}/$1" "$3" "SHA256:$2" >"$log" 2>&1; then
      rm "$log"
      return 0
    fi
  done
  cat "$log" >&2
  return 1
}

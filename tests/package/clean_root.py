"""A minimal Debian in a folder, made by mmdebstrap. The first one that is made stays in build/, packed, for the next."""

import functools
import os
import re
import shutil
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
KEPT = ROOT / "build/clean-root.tar"
QUICK = ["-o", "DPkg::Options::=--force-unsafe-io"]  # nobody needs this root after a power cut


class NoRoots(Exception):
    """Why this machine cannot make one."""


@functools.cache
def as_root():
    """What to write in front of a command that only root may run."""
    if os.geteuid() == 0:
        return ()
    if shutil.which("sudo") and subprocess.run(["sudo", "-n", "true"], check=False, stderr=subprocess.DEVNULL).returncode == 0:
        return ("sudo", "-n")
    raise NoRoots("only root may make it, and sudo asks for a password")


def make(*command, **options):
    done = subprocess.run([*as_root(), *map(str, command)], check=False, text=True, errors="replace", stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, **options)
    if done.returncode:
        raise NoRoots(f"{command[0]}: {done.stdout[-2000:]}")


def said(*command):
    return subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE).stdout


def settings_of_apt():
    """How this machine reaches its mirrors."""
    return re.findall(r"^Acquire::(?:Check|https?::|Retries).*", said("apt-config", "dump"), re.M)


def pack_root():
    """The release, the mirrors and apt's settings are those of this machine."""
    sources = said("apt-get", "indextargets", "--format", "deb $(REPO_URI) $(RELEASE) $(COMPONENT)",
                   "Created-By: Packages", "Origin: Debian")
    if not sources or not shutil.which("mmdebstrap"):
        raise NoRoots("it takes mmdebstrap and a Debian mirror")
    release = re.search(r"^VERSION_CODENAME=(\w+)", Path("/etc/os-release").read_text("utf-8"), re.M)[1]
    made = KEPT.with_suffix(".new.tar")
    make("mmdebstrap", "--variant=minbase", *(f"--aptopt={setting}" for setting in settings_of_apt()),
         "--dpkgopt=force-unsafe-io", release, made, "-", input=sources, timeout=600)
    make("mv", made, KEPT)


class CleanRoot:
    """To use in a `with` statement."""

    def __init__(self, folder):
        self.place = Path(folder) / "root"

    def __enter__(self):
        if not KEPT.exists():
            pack_root()
        self.place.mkdir()
        try:
            make("tar", "-xf", KEPT, "-C", self.place, "--numeric-owner")
            make("cp", "/etc/resolv.conf", self.place / "etc")
            make(*self.entering(), "true")
        except NoRoots:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        subprocess.run([*as_root(), "rm", "-rf", "--one-file-system", self.place], check=True)

    def entering(self):
        """Its /proc is unmounted, and its processes end, with the command."""
        return ["unshare", "--mount", "--pid", "--fork", "--kill-child", "sh", "-c",
                'mount -t proc proc "$0/proc" && exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive '
                'chroot "$0" "$@"', str(self.place)]

    def run(self, *command, user="root"):
        """Runs it there, in an empty folder of the user's. Returns the process, with its output as text."""
        there = ["runuser", "-u", user, "--", "sh", "-c", 'cd "$(mktemp -d)" && HOME=$PWD exec "$@"', "sh", *map(str, command)]
        return subprocess.run([*as_root(), *self.entering(), *there], check=False, text=True, timeout=300, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def files(self):
        """All of them but those of its users, and what apt and dpkg keep about themselves."""
        listed = self.run("find", "/", "-xdev", "(", "-path", "/tmp", "-o", "-path", "/proc", "-o", "-path", "/var/lib/apt", "-o", "-path",
                          "/var/cache", "-o", "-path", "/var/log", "-o", "-path", "/var/lib/dpkg", ")", "-prune", "-o", "-print")
        return set(listed.stdout.splitlines())

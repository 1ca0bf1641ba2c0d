"""Hits and false alarms of sound_events (scripts/rates), as a table.

All recordings of a kind are played in a row, with pauses in between, to a robot in `rsc run`. Each is as loud as the others in
its loudest 20 ms. A recording has an event if the robot names it between its beginning and a second after its end."""

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

import sounds
from sounds import BYTES, NOISES_DB

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT / "build/rates"
PAGE = ROOT / "docs/algorithms.md"
RATE = 8000
LONGEST_S = 20  # recordings are cut there
RAW = sounds.raw(RATE)
ROBOT = {
    "sensors": [{"name": "microphone", "type": "VIRTUAL", "device": "microphone"}],
    "actuators": [{"name": "voice", "type": "VIRTUAL", "device": "speaker"}],
    "algorithms": [{"name": "ear", "module": "sound_events", "input": "microphone"}],
}
PROGRAM = """WHEN ear EVENT IS clap
DO SAY "clap"
END
WHEN ear EVENT IS speech
DO SAY "speech"
END
"""


class Kind(NamedTuple):
    name: str
    package: str
    files: list


def recordings(package, suffixes):
    found = (path for path in (DATA / package).rglob("*") if path.suffix.lower() in suffixes)
    return sorted(found, key=lambda path: path.relative_to(DATA).as_posix())


def is_clap(path):
    return "clap" in path.name.lower()


def kinds():
    drums = recordings("hydrogen-drumkits", {".wav", ".flac"})
    samples = recordings("lmms-common", {".ogg"})
    claps = [path for path in drums + samples if is_clap(path)]
    others = [path for path in drums if not is_clap(path)]
    speech = recordings("asterisk-core-sounds-en-wav", {".wav"})
    return [Kind("claps", "hydrogen-drumkits, lmms-common", claps),
            Kind("other drums and percussion", "hydrogen-drumkits", others),
            Kind("a woman who speaks", "asterisk-core-sounds-en-wav", speech)]


def read(path):
    """The recording at 8,000 samples a second; None if sox cannot read it, or if it is silent."""
    said = subprocess.run(["sox", "-R", path, *RAW], capture_output=True, check=False)
    return None if said.returncode != 0 else sounds.as_loud(said.stdout[:LONGEST_S * RATE * BYTES], RATE)


def run(robot, program, sound, *options):
    """The events of the robot that hears the sound."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        sounds.write(folder / "sound.wav", sound, RATE)
        (folder / "robot.json").write_text(json.dumps(robot))
        (folder / "robot.rsl").write_text(program)
        (folder / "play.json").write_text(json.dumps(
            {"duration": f"{milliseconds(sound)}ms", "stimuli": [{"sound": "sound.wav", "sensor": "microphone"}]}))
        ran = subprocess.run([ROOT / "build/host/rsc", "run", folder / "robot.rsl", "--scenario", folder / "play.json",
                              "--format", "json", *options], capture_output=True, text=True, check=True)
    return [json.loads(line) for line in ran.stdout.splitlines()]


def milliseconds(sound):
    return round(sounds.seconds(sound, RATE) * 1000)


def heard(sound):
    """[(time in seconds, event)]: the events that the robot names."""
    return [(event["t_us"] / 1e6, event["word"]) for event in run(ROBOT, PROGRAM, sound)
            if event.get("event") == "command" and event.get("verb") == "SAY"]


def count(places, events, wanted):
    """The number of recordings that have that event."""
    times = [time for time, event in events if event == wanted]
    return sum(any(begin <= time <= end + 1 for time in times) for _, begin, end in places)


def rates(which):
    """Rows: kind, number of recordings, minutes, then for each noise: (claps, speech)."""
    rows = []
    for kind in kinds():
        sound, places = sounds.lay_out(kind.files[which::2], read, RATE)
        hiss = sounds.noise(len(sound), RATE)
        counts = []
        for below in NOISES_DB:
            events = heard(sounds.mixed(sound, hiss, below))
            counts.append((count(places, events, "clap"), count(places, events, "speech")))
        rows.append((kind, len(places), sounds.seconds(sound, RATE) / 60, counts))
    return rows


def table(rows):
    lines = sounds.head("recordings | taken for")
    for kind, total, minutes, counts in rows:
        for place, event in enumerate(("clap", "speech")):
            cells = " | ".join(f"{pair[place]} of {total}" for pair in counts)
            about = f"{total} × {kind.name}, {minutes:.0f} min ({kind.package})" if place == 0 else ""
            lines.append(f"| {about} | {event} | {cells} |")
    return "\n".join(lines)


def show(text, mark, page=PAGE):
    """Prints the table; with --write, also puts it into the page after its mark."""
    print(text)
    if "--write" in sys.argv:
        before, rest = page.read_text().split(f"{mark}\n", 1)
        after = rest.split("<!-- end -->", 1)[1]
        page.write_text(f"{before}{mark}\n{text}\n<!-- end -->{after}")


def half():
    return 0 if "--settings" in sys.argv else 1


def main():
    show(table(rates(half())), "<!-- scripts/rates -->")


if __name__ == "__main__":
    main()

"""Hits and false alarms of sound_events (scripts/rates), as a table.

All recordings of a kind are laid one behind the other, each as loud as the others in its loudest 20 ms, with pauses between, and
played to a robot in `rsc run`. A recording has an event when the robot names it between its begin and a second after its end."""

import json
import subprocess
import sys
import tempfile
import warnings
import wave
from pathlib import Path
from typing import NamedTuple

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # Debian 12's Python still has it
    import audioop

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT / "build/rates"
PAGE = ROOT / "docs/algorithms.md"
RATE, BYTES = 8000, 2
BLOCK = RATE // 50 * BYTES
PAUSE_S = 1.5
LOUDEST = 3277  # root of the mean square of the loudest block: 20 dB below the loudest tone there is
LONGEST_S = 20  # of a recording, which is cut there
RAW = ("-r", str(RATE), "-c", "1", "-b", "16", "-e", "signed", "-t", "raw", "-")  # how sox gives it
NOISES_DB = (40, 20, 10, 5)  # how far the noise is below that block; 40: a quiet room
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
    """The recording at 8,000 samples a second; None where sox cannot read it, or hears nothing."""
    said = subprocess.run(["sox", "-R", path, *RAW], capture_output=True, check=False)
    return None if said.returncode != 0 else as_loud(said.stdout[:LONGEST_S * RATE * BYTES])


def as_loud(sound):
    """As the others in its loudest block; None when nothing is heard."""
    loudest = max((audioop.rms(sound[at:at + BLOCK], BYTES) for at in range(0, len(sound) - BLOCK + 1, BLOCK)), default=0)
    return None if loudest == 0 else audioop.mul(sound, BYTES, LOUDEST / loudest)


def noise(length):
    """As much of it, the same every time, as loud as the loudest block of a recording."""
    sound = subprocess.run(["sox", "-R", "-n", *RAW, "synth", "20", "pinknoise", "gain", "-12"],
                           capture_output=True, check=True).stdout
    sound = audioop.mul(sound, BYTES, LOUDEST / audioop.rms(sound, BYTES))
    return (sound * (length // len(sound) + 1))[:length]


def lay_out(files):
    """(all of them behind each other, [(begin, end) in seconds])."""
    pause = bytes(int(PAUSE_S * RATE) * BYTES)
    sound, places = bytearray(2 * pause), []
    for path in files:
        recording = read(path)
        if recording is None:
            print(f"left out, no sound: {path.name}", file=sys.stderr)
            continue
        begin = len(sound)
        sound += recording + pause
        places.append((begin / BYTES / RATE, (begin + len(recording)) / BYTES / RATE))
    return bytes(sound), places


def run(robot, program, sound, *options):
    """The events of the robot that hears the sound."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        with wave.open(str(folder / "sound.wav"), "wb") as file:
            file.setparams((1, BYTES, RATE, 0, "NONE", ""))
            file.writeframes(sound)
        (folder / "robot.json").write_text(json.dumps(robot))
        (folder / "robot.rsl").write_text(program)
        (folder / "play.json").write_text(json.dumps(
            {"duration": f"{milliseconds(sound)}ms", "stimuli": [{"sound": "sound.wav", "sensor": "microphone"}]}))
        ran = subprocess.run([ROOT / "build/host/rsc", "run", folder / "robot.rsl", "--scenario", folder / "play.json",
                              "--format", "json", *options], capture_output=True, text=True, check=True)
    return [json.loads(line) for line in ran.stdout.splitlines()]


def milliseconds(sound):
    return round(len(sound) / BYTES / RATE * 1000)


def heard(sound):
    """[(time in seconds, event)] as the robot names them."""
    return [(event["t_us"] / 1e6, event["word"]) for event in run(ROBOT, PROGRAM, sound)
            if event.get("event") == "command" and event.get("verb") == "SAY"]


def count(places, events, wanted):
    """How many of the recordings have that event."""
    times = [time for time, event in events if event == wanted]
    return sum(any(begin <= time <= end + 1 for time in times) for begin, end in places)


def rates(which):
    """Rows: kind, of how many, then for each noise: (claps, speech)."""
    rows = []
    for kind in kinds():
        sound, places = lay_out(kind.files[which::2])
        hiss = noise(len(sound))
        counts = []
        for below in NOISES_DB:
            mixed = audioop.add(sound, audioop.mul(hiss, BYTES, 10 ** (-below / 20)), BYTES)
            events = heard(mixed)
            counts.append((count(places, events, "clap"), count(places, events, "speech")))
        rows.append((kind, len(places), len(sound) / BYTES / RATE / 60, counts))
    return rows


def title(below):
    return "in a quiet room" if below == NOISES_DB[0] else f"noise {below} dB below"


def table(rows):
    lines = ["| recordings | taken for | " + " | ".join(map(title, NOISES_DB)) + " |", "|---|---" + "|---" * len(NOISES_DB) + "|"]
    for kind, total, minutes, counts in rows:
        for place, event in enumerate(("clap", "speech")):
            cells = " | ".join(f"{pair[place]} of {total}" for pair in counts)
            about = f"{total} × {kind.name}, {minutes:.0f} min ({kind.package})" if place == 0 else ""
            lines.append(f"| {about} | {event} | {cells} |")
    return "\n".join(lines)


def show(text, mark):
    """Prints the table, and puts it into the page behind its mark where that is asked for."""
    print(text)
    if "--write" in sys.argv:
        before, rest = PAGE.read_text().split(f"{mark}\n", 1)
        after = rest.split("<!-- end -->", 1)[1]
        PAGE.write_text(f"{before}{mark}\n{text}\n<!-- end -->{after}")


def half():
    return 0 if "--settings" in sys.argv else 1


def main():
    show(table(rates(half())), "<!-- scripts/rates -->")


if __name__ == "__main__":
    main()
